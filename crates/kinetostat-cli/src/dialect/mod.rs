//! `kinetostat dialect`: the tables from which readers and writers of programs are made.
//!
//! It takes the name of a language and prints its table; the tables themselves are those of the crates that read.

pub(crate) mod arguments;
mod languages;
mod rows;

use serde::Serialize;

use crate::dialect::arguments::{DialectArgs, DialectCommand};
use crate::dialect::languages::{Language, languages};
use crate::dialect::rows::{Row, rows};
use crate::ui::failure::{Answer, Failure};
use crate::ui::json;
use crate::ui::layout::{listed, wrapped};
use crate::ui::screen::{self, Stream};

#[derive(Serialize)]
struct Table {
    schema: u32,
    kinetostat_version: &'static str,
    language: &'static str,
    endings: &'static [&'static str],
    words: Vec<Row>,
}

pub(crate) fn run(args: &DialectArgs) -> Answer<()> {
    let show = match &args.what {
        DialectCommand::List => return list(),
        DialectCommand::Show(show) => show,
    };
    let language = named(&show.name)?;
    let table = Table {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        language: language.name,
        endings: language.endings,
        words: rows(&language),
    };
    json::print_answer(&text(&language, &table), &table, show.json)
}

fn named(name: &str) -> Answer<Language> {
    let lower = name.to_lowercase();
    let found = languages().find(|language| language.name == lower);
    found.ok_or_else(|| {
        let names: Vec<&str> = languages().map(|language| language.name).collect();
        Failure::input(format!(
            "there is no language `{name}`; there are: {}",
            names.join(", ")
        ))
    })
}

fn list() -> Answer<()> {
    let row = |language: Language| {
        let endings: Vec<String> = language.endings.iter().map(|e| format!(".{e}")).collect();
        vec![
            language.name.to_owned(),
            language.title.to_owned(),
            endings.join(" "),
        ]
    };
    let all: Vec<Vec<String>> = languages().map(row).collect();
    screen::print(Stream::Out, &listed(&all, 0))
}

fn text(language: &Language, table: &Table) -> String {
    let mut text = wrapped(&format!("{}: {}", language.name, language.title), 0);
    text.push('\n');
    text.push_str(&wrapped(language.written, 2));
    if let Some(made) = language.made {
        let limits = made.limits_in_words();
        text.push_str(&wrapped(
            &format!("Converted from another language: {limits}."),
            2,
        ));
    }
    for (treatment, title) in [
        ("followed", "Followed"),
        ("carried", "Carried byte for byte"),
        ("refused", "Refused by line"),
    ] {
        let rows = table.words.iter().filter(|row| row.treatment == treatment);
        let rows: Vec<Vec<String>> = rows
            .map(|row| vec![row.word.clone(), row.description()])
            .collect();
        text.push_str(&format!("\n{title}\n"));
        text.push_str(&listed(&rows, 2));
    }
    text
}
