//! `kinetostat dialect`: the tables from which readers and writers of programs are made.
//!
//! It takes the name of a language and prints its table; the tables themselves are those of the crates that read.

use clap::{Args, Subcommand};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{
    Language as Format, MakeLanguage, StatementRow, Treatment as OfStatement,
};
use kinetostat_program::{CODES, MOMENTS, Moment, Placed, Treatment as OfCode};
use schemars::JsonSchema;
use serde::Serialize;

use crate::ui::failure::{Answer, Failing};
use crate::ui::json;
use crate::ui::layout::{listed, wrapped};
use crate::ui::result_form::ResultForm;
use crate::ui::screen::{self, Stream};

#[derive(Serialize, JsonSchema)]
struct Table {
    schema: u32,
    kinetostat_version: &'static str,
    language: &'static str,
    endings: &'static [&'static str],
    words: Vec<Row>,
}

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<Table>("the words of a language")];

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
        ErrorCode::UnknownName.failure(format!(
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

/// A word of a language.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Row {
    pub(crate) word: String,
    #[serde(skip_serializing_if = "str::is_empty")]
    pub(crate) meaning: &'static str,
    /// `followed`, `carried` or `refused`.
    pub(crate) treatment: &'static str,
    #[serde(skip_serializing_if = "str::is_empty")]
    pub(crate) reason: &'static str,
    #[serde(skip_serializing_if = "str::is_empty")]
    pub(crate) remedy: &'static str,
    /// Piece that carries it when its block is divided: `first` or `last` piece.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) piece: Option<&'static str>,
    #[serde(skip_serializing_if = "str::is_empty")]
    pub(crate) source: &'static str,
}

impl Row {
    /// Meaning, reason and remedy in one sentence.
    pub(crate) fn description(&self) -> String {
        let mut parts: Vec<String> = Vec::new();
        for part in [self.meaning, self.reason, self.remedy] {
            if !part.is_empty() {
                parts.push(part.to_owned());
            }
        }
        if let Some(piece) = self.piece {
            parts.push(format!("in the {piece} piece of a divided block"));
        }
        parts.join("; ")
    }
}

fn treatment(
    refused: Option<(&'static str, &'static str)>,
    followed: bool,
) -> (&'static str, &'static str, &'static str) {
    match (refused, followed) {
        (Some((reason, remedy)), _) => ("refused", reason, remedy),
        (None, true) => ("followed", "", ""),
        (None, false) => ("carried", "", ""),
    }
}

/// All words of a language.
fn rows(language: &Language) -> Vec<Row> {
    match language.words {
        Words::Codes => codes(),
        Words::Statements(all) => {
            let rows = all.iter().map(|row| {
                let refused = match row.treatment {
                    OfStatement::Refused { reason, remedy } => Some((reason, remedy)),
                    _ => None,
                };
                let followed = row.treatment == OfStatement::Understood;
                let (treatment, reason, remedy) = treatment(refused, followed);
                Row {
                    word: row.name.to_owned(),
                    meaning: "",
                    treatment,
                    reason,
                    remedy,
                    piece: None,
                    source: row.source,
                }
            });
            rows.collect()
        }
    }
}

/// Words beside codes and coordinates.
const WORDS: [(&str, &str, &str); 4] = [
    ("F", "feed, in the feed mode in force", "followed"),
    ("S", "spindle speed", "followed"),
    ("T", "number of a tool", "followed"),
    ("N", "number of the block", "carried"),
];

/// M codes of which spindle and tool are known along the path; the others beside motions are carried.
const SPINDLE_AND_TOOL: std::ops::RangeInclusive<u32> = 3..=6;

fn codes() -> Vec<Row> {
    let of_word = |(word, meaning, treatment): (&str, _, _)| Row {
        word: word.to_owned(),
        meaning,
        treatment,
        reason: "",
        remedy: "",
        piece: None,
        source: "",
    };
    let mut all: Vec<Row> = WORDS.into_iter().map(of_word).collect();
    for code in CODES {
        let refused = match code.treatment {
            OfCode::Refused { reason, remedy } => Some((reason, remedy)),
            _ => None,
        };
        let followed = code.treatment == OfCode::Understood;
        let (treatment, reason, remedy) = treatment(refused, followed);
        for tenths in code.tenths {
            let word = match tenths % 10 {
                0 => format!("{}{}", code.letter, tenths / 10),
                part => format!("{}{}.{part}", code.letter, tenths / 10),
            };
            let moment = MOMENTS
                .iter()
                .find(|moment| code.letter == 'M' && 10 * moment.code == *tenths);
            all.push(Row {
                word,
                meaning: code.meaning,
                treatment,
                reason,
                remedy,
                piece: moment.and_then(piece_of),
                source: "",
            });
        }
    }
    for moment in MOMENTS {
        let word = format!("M{}", moment.code);
        if all.iter().any(|row| row.word == word) {
            continue;
        }
        all.push(Row {
            piece: piece_of(moment),
            ..of_word(match SPINDLE_AND_TOOL.contains(&moment.code) {
                true => (&word, moment.meaning, "followed"),
                false => (&word, moment.meaning, "carried"),
            })
        });
    }
    all
}

/// Returns the piece that carries a code when its block is divided.
fn piece_of(moment: &Moment) -> Option<&'static str> {
    match moment.placed {
        Placed::First => Some("first"),
        Placed::Last => Some("last"),
        Placed::Refused => None,
    }
}

/// Source of a language's table of statements.
#[derive(Clone, Copy)]
pub(crate) enum Words {
    /// Codes of G-code, with when they act.
    Codes,
    /// Statements of a robot's language.
    Statements(&'static [StatementRow]),
}

/// A language of programs.
pub(crate) struct Language {
    /// Name in options.
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    pub(crate) endings: &'static [&'static str],
    /// Description of the output.
    pub(crate) written: &'static str,
    /// Target language of conversions to it, if there are any.
    pub(crate) made: Option<MakeLanguage>,
    pub(crate) words: Words,
}

const GCODE: Language = Language {
    name: "gcode",
    title: "G-code as LinuxCNC and most controllers read it",
    endings: &["ngc", "nc", "gcode", "tap", "..."],
    written: "Written: numbers in place, further blocks behind the first; 4 decimals in mm (5 in inches) or as --decimals says; lines of at most 250 bytes. A code beside a motion that is divided goes where controllers act on it (see the book).",
    made: Some(MakeLanguage::Gcode),
    words: Words::Codes,
};

/// All of them.
fn languages() -> impl Iterator<Item = Language> {
    let others = Format::ALL.into_iter().map(|language| Language {
        name: language.word(),
        title: language.title(),
        endings: language.endings(),
        written: language.written(),
        made: MakeLanguage::of(Some(language)),
        words: Words::Statements(language.statements()),
    });
    std::iter::once(GCODE).chain(others)
}

/// What is done with every word of a language of programs: the tables that readers and writers are made from
#[derive(Debug, Args)]
#[command(arg_required_else_help = true, subcommand_required = true)]
pub(crate) struct DialectArgs {
    #[command(subcommand)]
    pub(crate) what: DialectCommand,
}

#[derive(Debug, Subcommand)]
pub(crate) enum DialectCommand {
    /// The languages that are read
    List,
    /// Every word of a language: followed, carried byte for byte, or refused and why
    Show(ShowArgs),
}

#[derive(Debug, Args)]
pub(crate) struct ShowArgs {
    /// Name of a language, as `dialect list` has it
    #[arg(value_name = "NAME")]
    pub(crate) name: String,
    /// Print the table as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
