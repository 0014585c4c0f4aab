//! Results as JSON, and with it on the screen.

use std::io::{self, Write};

use kinetostat_diagnostic::{Diagnostic, ErrorCode};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::ser::{Formatter, PrettyFormatter, Serializer};

use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::screen::{self, Stream};

/// A result as JSON with a final newline.
pub(crate) fn json<T: Serialize + JsonSchema>(value: &T) -> Answer<String> {
    let mut bytes = Vec::new();
    let mut serializer = Serializer::with_formatter(&mut bytes, UnsignedZero::default());
    value.serialize(&mut serializer).map_err(|error| {
        ErrorCode::Internal.failure(format!("the result cannot be written as JSON: {error}"))
    })?;
    bytes.push(b'\n');
    String::from_utf8(bytes).map_err(|error| {
        ErrorCode::Internal.failure(format!("the result cannot be written as JSON: {error}"))
    })
}

/// Methods of a [`Formatter`] that are those of the usual one.
macro_rules! as_usual {
    ($($method:ident($($first:ident: bool)?))*) => {$(
        fn $method<W: ?Sized + Write>(&mut self, writer: &mut W $(, $first: bool)?) -> io::Result<()> {
            self.0.$method(writer $(, $first)?)
        }
    )*};
}

/// Indented as usual; zero has no sign.
#[derive(Default)]
struct UnsignedZero(PrettyFormatter<'static>);

impl Formatter for UnsignedZero {
    fn write_f64<W: ?Sized + Write>(&mut self, writer: &mut W, value: f64) -> io::Result<()> {
        // -0 + 0 is +0; every other number stays as it is.
        self.0.write_f64(writer, value + 0.0)
    }

    as_usual! {
        begin_array() end_array() begin_array_value(first: bool) end_array_value()
        begin_object() end_object() begin_object_key(first: bool) begin_object_value() end_object_value()
    }
}

/// Errors of a command, as programs read them.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ErrorReport {
    schema: u32,
    kinetostat_version: &'static str,
    /// Exit code of the process.
    exit_code: u8,
    /// The faults, in the order in which the text names them.
    errors: Vec<Diagnostic>,
}

/// Prints a failure as JSON on the standard output, unless a result stands there.
pub(crate) fn print_errors(failure: &Failure) {
    if screen::has_printed() {
        return;
    }
    let report = ErrorReport {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        exit_code: failure.code() as u8,
        errors: failure.diagnostics(),
    };
    // Nothing can be done if even that cannot be written.
    let _ = json(&report).and_then(|text| screen::print_bytes(text.as_bytes()));
}

/// The text of an answer; with `as_json` the answer itself on the standard output, and the text beside it.
pub(crate) fn print_answer<T: Serialize + JsonSchema>(
    text: &str,
    answer: &T,
    as_json: bool,
) -> Answer<()> {
    if as_json {
        screen::print(Stream::Err, text)?;
        return screen::print_bytes(json(answer)?.as_bytes());
    }
    screen::print(Stream::Out, text)
}

#[cfg(test)]
mod tests {
    use super::json;

    #[test]
    fn zero_has_no_sign_and_the_form_is_the_usual_one() {
        let value = serde_json::json!({
            "a": [-0.0, 0.0, -1.5, 5e-324, f64::MAX], "b": {}, "c": [], "d": [{"e": -0.0, "f": null}], "g": -1
        });
        let text = json(&value).expect("JSON");
        assert!(!text.contains("-0.0"), "{text}");
        let usual = serde_json::to_string_pretty(&value).expect("JSON");
        assert_eq!(text, format!("{}\n", usual.replace("-0.0", "0.0")));
    }
}
