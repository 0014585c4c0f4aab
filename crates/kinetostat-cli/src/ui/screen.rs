//! The only module that prints. Results go to the standard output, everything about them to the
//! standard error; with `--json` the text for people goes there too.

use std::io::{ErrorKind, IsTerminal, Write};

use clap::error::ErrorKind as ClapKind;
use kinetostat_machining::number as formatter;
use kinetostat_model::shortened;

use crate::ui::failure::{Answer, Failure, safe};

/// Width of all text for people.
pub(crate) const WIDTH: usize = 80;

/// Where the text for people goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stream {
    Out,
    Err,
}

/// Prints text as it is.
pub(crate) fn print(stream: Stream, text: &str) -> Answer<()> {
    let result = match stream {
        Stream::Out => write(&mut anstream::stdout().lock(), text.as_bytes()),
        Stream::Err => write(&mut anstream::stderr().lock(), text.as_bytes()),
    };
    told(result)
}

/// Prints bytes to the standard output without looking at them.
pub(crate) fn print_bytes(bytes: &[u8]) -> Answer<()> {
    told(write(&mut std::io::stdout().lock(), bytes))
}

fn write(to: &mut dyn Write, bytes: &[u8]) -> std::io::Result<()> {
    to.write_all(bytes)?;
    to.flush()
}

fn told(result: std::io::Result<()>) -> Answer<()> {
    match result {
        // The reader has seen enough (`| head`): that is no failure.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(Failure::input(format!(
            "the standard output cannot be written: {}",
            crate::files::output::in_words(&error)
        ))),
        Ok(()) => Ok(()),
    }
}

/// Tells why the command ends. Nothing can be done if even that fails.
pub(crate) fn complain(failure: &Failure) {
    let mut to = anstream::stderr().lock();
    let text = match &failure.styled {
        // anstream takes the colours out where the terminal has none.
        Some(styled) => format!("{styled}\n"),
        None => format!("\u{1b}[1;31merror\u{1b}[0m: {}\n", failure.plain),
    };
    let _ = write(&mut to, text.as_bytes());
}

/// Tells what is wrong with a command line, in the words of its reader; a word of kilobytes is cut.
pub(crate) fn complain_of_line(error: &clap::Error) {
    let asked_for = matches!(
        error.kind(),
        ClapKind::DisplayHelp
            | ClapKind::DisplayVersion
            | ClapKind::DisplayHelpOnMissingArgumentOrSubcommand
    );
    let whole = error.render().to_string();
    let text = shortened(&safe(&whole));
    let _ = match asked_for || text == whole {
        true => error.print(),
        false => write(&mut anstream::stderr().lock(), text.as_bytes()),
    };
}

/// Whether a person watches the standard error.
pub(crate) fn watched() -> bool {
    std::io::stderr().is_terminal()
}

/// Text in lines of at most [`WIDTH`] characters, each indented.
pub(crate) fn wrapped(text: &str, indent: usize) -> String {
    let mut out = String::new();
    let (first, rest) = (" ".repeat(indent), " ".repeat(indent));
    wrap_into(&mut out, text, &first, &rest);
    out
}

/// A list entry: `- text`, with the following lines indented.
pub(crate) fn item(text: &str) -> String {
    let mut out = String::new();
    wrap_into(&mut out, text, "  - ", "    ");
    out
}

fn wrap_into(out: &mut String, text: &str, first: &str, rest: &str) {
    let text = safe(text);
    let mut line = first.to_owned();
    let mut empty = true;
    for word in text.split_whitespace() {
        let long = line.chars().count() + 1 + word.chars().count() > WIDTH;
        if !empty && long {
            out.push_str(&line);
            out.push('\n');
            line = rest.to_owned();
            empty = true;
        }
        if !empty {
            line.push(' ');
        }
        line.push_str(word);
        empty = false;
    }
    out.push_str(&line);
    out.push('\n');
}

/// Rows in columns: the first aligned left, the others right, two spaces between them.
pub(crate) fn columns(rows: &[Vec<String>], indent: usize) -> String {
    aligned(rows, indent, |column| column > 0)
}

/// Rows of text in columns, all aligned left; the last column may be long.
pub(crate) fn listed(rows: &[Vec<String>], indent: usize) -> String {
    aligned(rows, indent, |_| false)
}

fn aligned(rows: &[Vec<String>], indent: usize, right: impl Fn(usize) -> bool) -> String {
    let rows: Vec<Vec<String>> = rows
        .iter()
        .map(|row| row.iter().map(|cell| safe(cell)).collect())
        .collect();
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width: Vec<usize> = (0..count)
        .map(|column| {
            rows.iter()
                .filter_map(|row| row.get(column))
                .map(|cell| cell.chars().count())
                .max()
                .unwrap_or(0)
        })
        .collect();
    let mut out = String::new();
    for row in &rows {
        let mut line = " ".repeat(indent);
        for (column, cell) in row.iter().enumerate() {
            let gap = " ".repeat(width[column] - cell.chars().count());
            if column > 0 {
                line.push_str("  ");
            }
            if right(column) {
                line.push_str(&gap);
                line.push_str(cell);
            } else {
                line.push_str(cell);
                line.push_str(&gap);
            }
        }
        out.push_str(line.trim_end());
        out.push('\n');
    }
    out
}

/// A number with `digits` significant digits, for tables: the one formatter of all commands and of the
/// report, in engineering notation where plain notation would be long.
pub(crate) fn number(value: f64, digits: i32) -> String {
    let digits = usize::try_from(digits).unwrap_or(1);
    formatter::significant(value, digits, formatter::Rounding::Nearest)
}

/// A number with fixed decimals, for components beside each other; never `-0.000`.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    formatter::fixed(value, decimals)
}

/// Components of a load in brackets, at four decimals, small ones with three digits; what is rounding beside the
/// largest is zero.
pub(crate) fn load_triple(v: [f64; 3]) -> String {
    let most = v.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    triple(v, |x| match x.abs() <= 1e-12 * most {
        true => "0".to_owned(),
        false if x.abs() < 0.01 => formatter::short(x),
        false => formatter::without_zeros(&fixed(x, 4)).to_owned(),
    })
}

/// Three components in brackets.
pub(crate) fn triple(v: [f64; 3], shown: impl Fn(f64) -> String) -> String {
    format!("({}, {}, {})", shown(v[0]), shown(v[1]), shown(v[2]))
}
