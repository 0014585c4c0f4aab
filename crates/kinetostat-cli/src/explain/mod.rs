//! `kinetostat explain`: the meaning of the codes of errors and warnings.
//!
//! The texts are the documentation of the codes, as their JSON schemas have it.

use clap::Args;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::WarningCode;
use schemars::{JsonSchema, Schema, schema_for};
use serde_json::Value;

use crate::options::EXIT_CODES;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::layout::{listed, wrapped};
use crate::ui::screen::{self, Stream};
use crate::ui::spelling::nearest;

pub(crate) fn run(args: &ExplainArgs) -> Answer<()> {
    let (errors, warnings) = (codes::<ErrorCode>(), codes::<WarningCode>());
    let Some(code) = &args.code else {
        let mut text = "Errors\n".to_owned();
        text.push_str(&listed(&rows(&errors), 2));
        text.push_str("\nWarnings\n");
        text.push_str(&listed(&rows(&warnings), 2));
        return screen::print(Stream::Out, &text);
    };
    let kinds = [("error", &errors), ("warning", &warnings)];
    let mut found = kinds.iter().flat_map(|(kind, list)| {
        let own = list.iter().filter(|(word, _)| word == code);
        own.map(move |(word, text)| format!("{kind} {word}\n{}", paragraphs(text)))
    });
    match found.next() {
        Some(text) => screen::print(Stream::Out, &text),
        None => Err(unknown(code, errors.iter().chain(&warnings))),
    }
}

fn unknown<'c>(code: &str, known: impl Iterator<Item = &'c (String, String)>) -> Failure {
    let known: Vec<&str> = known.map(|(word, _)| word.as_str()).collect();
    let near = match nearest(code, &known) {
        Some(near) => format!("did you mean '{near}'? "),
        None => String::new(),
    };
    ErrorCode::UnknownName.failure(format!(
        "there is no code '{code}'; {near}`kinetostat explain` lists all codes"
    ))
}

/// Codes with the first paragraph of their texts.
fn rows(codes: &[(String, String)]) -> Vec<Vec<String>> {
    let first = |text: &str| text.split("\n\n").next().map(str::to_owned);
    codes
        .iter()
        .map(|(word, text)| vec![word.clone(), first(text).unwrap_or_default()])
        .collect()
}

fn paragraphs(text: &str) -> String {
    text.split("\n\n").map(|part| wrapped(part, 2)).collect()
}

/// All values of an enumeration of codes, each with its documentation.
fn codes<C: JsonSchema>() -> Vec<(String, String)> {
    let schema: Schema = schema_for!(C);
    let all = schema.get("oneOf").and_then(Value::as_array);
    let text = |of: &Value, key: &str| of.get(key).and_then(Value::as_str).map(str::to_owned);
    let code = |of: &Value| Some((text(of, "const")?, text(of, "description")?));
    all.into_iter().flatten().filter_map(code).collect()
}

/// The meaning of a code of an error or a warning, and what to do
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct ExplainArgs {
    /// The code, as in the JSON of a result or of an error; without it all are listed
    #[arg(value_name = "CODE")]
    pub(crate) code: Option<String>,
}

#[cfg(test)]
mod tests {
    use super::{ErrorCode, WarningCode, codes};

    #[test]
    fn every_code_has_a_text_that_ends() {
        let (errors, warnings) = (codes::<ErrorCode>(), codes::<WarningCode>());
        assert!(errors.len() >= 25 && warnings.len() >= 60);
        for (word, text) in errors.iter().chain(&warnings) {
            assert!(text.trim_end().ends_with('.'), "{word}: {text}");
        }
    }
}
