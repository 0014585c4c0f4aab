//! The command line: one variant per command, with the options of its folder.
//!
//! It takes the words of the command line, negative numbers among them made readable, and gives a [`Command`].

pub(crate) mod help;
pub(crate) mod inputs;

use std::ffi::OsString;

use clap::{Parser, Subcommand};

use crate::assemble::arguments::AssembleArgs;
use crate::chatter::arguments::ChatterArgs;
use crate::check::CheckArgs;
use crate::compare::arguments::CompareArgs;
use crate::compensate::arguments::CompensateArgs;
use crate::convert::arguments::ConvertArgs;
use crate::curve::arguments::CurveArgs;
use crate::deflect::arguments::DeflectArgs;
use crate::demo::DemoArgs;
use crate::dialect::DialectArgs;
use crate::engagement::arguments::EngagementArgs;
use crate::equilibria::arguments::EquilibriaArgs;
use crate::expand::ExpandArgs;
use crate::explain::ExplainArgs;
use crate::force::arguments::ForceArgs;
use crate::frf::arguments::FrfArgs;
use crate::identify::IdentifyArgs;
use crate::import::arguments::ImportArgs;
use crate::lobes::arguments::LobesArgs;
use crate::map::arguments::MapArgs;
use crate::mirror::arguments::MirrorArgs;
use crate::model::arguments::ModelArgs;
use crate::modes::arguments::ModesArgs;
use crate::options::EXIT_CODES;
use crate::placing::arguments::PlacingArgs;
use crate::plan_measurement::PlanMeasurementArgs;
use crate::reproduce::ReproduceArgs;
use crate::schema::SchemaArgs;
use crate::shares::arguments::SharesArgs;
use crate::shell::{CompletionsArgs, ManArgs};
use crate::start::StartArgs;
use crate::stiffness::arguments::StiffnessArgs;
use crate::tolerance::arguments::ToleranceArgs;
use crate::verify::arguments::VerifyArgs;
use crate::view::ViewArgs;

/// Elastostatics of robots that machine: how far a machine bends along a program, and a program
/// that cuts where it should.
#[derive(Debug, Parser)]
#[command(
    name = "kinetostat",
    version,
    max_term_width = 80,
    arg_required_else_help = true,
    subcommand_required = true,
    after_help = EXIT_CODES,
    after_long_help = concat!(
        "Examples:\n",
        "  kinetostat demo\n",
        "      a first look: mills a circle on a bending machine and opens no network\n",
        "  kinetostat start\n",
        "      your robot and your program: some questions, and the first result\n",
        "  kinetostat deflect job.toml\n",
        "      how far is the tool off along the program?\n",
        "  kinetostat compensate job.toml\n",
        "      write the program that cuts where it should\n",
        "  kinetostat curve three_link_z --direction -1 0 0 --displacement-mm 0 400\n",
        "      push a chain together: which force, and where does it buckle?\n",
        "  kinetostat force --list-materials\n",
        "      what can be cut: then the force of one cut, from tool, width, depth, feed\n",
        "  kinetostat engagement milling.toml --plot cut.svg\n",
        "      what does a program cut where, with which force and torque?\n",
        "  kinetostat check my_robot.toml\n",
        "      what does the model file say, in words?\n\n",
        "Inputs: a model, a job and a program are recognised by their content. Each is given\n",
        "as an argument or by --model, --job or --program; - reads standard input.\n\n",
        "Exit codes:\n",
        "  0    answered\n",
        "  1    wrong input: a file, a number or an option; the message says which\n",
        "  2    no answer: not converged, or a point that cannot be reached\n",
        "  3    compensated and written, but the tolerance is missed; the line is said. Of\n",
        "       verify: missed, or the program cuts otherwise than the original\n",
        "  4    compensated and written; the tolerance is kept only if the assumptions hold\n",
        "  130  stopped with Ctrl-C; nothing was written",
    )
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Demo(DemoArgs),
    Start(StartArgs),
    Compensate(Box<CompensateArgs>),
    Verify(Box<VerifyArgs>),
    Deflect(Box<DeflectArgs>),
    Stiffness(StiffnessArgs),
    View(Box<ViewArgs>),
    Shares(Box<SharesArgs>),
    Modes(Box<ModesArgs>),
    Frf(Box<FrfArgs>),
    Lobes(Box<LobesArgs>),
    Chatter(Box<ChatterArgs>),
    Compare(Box<CompareArgs>),
    Map(Box<MapArgs>),
    Mirror(Box<MirrorArgs>),
    Place(Box<PlacingArgs>),
    Tolerance(Box<ToleranceArgs>),
    Assemble(Box<AssembleArgs>),
    Curve(Box<CurveArgs>),
    Equilibria(Box<EquilibriaArgs>),
    Force(Box<ForceArgs>),
    Engagement(Box<EngagementArgs>),
    Expand(Box<ExpandArgs>),
    Convert(Box<ConvertArgs>),
    Dialect(DialectArgs),
    Check(CheckArgs),
    PlanMeasurement(Box<PlanMeasurementArgs>),
    Identify(Box<IdentifyArgs>),
    Import(Box<ImportArgs>),
    Reproduce(ReproduceArgs),
    Model(ModelArgs),
    Schema(SchemaArgs),
    Explain(ExplainArgs),
    Completions(CompletionsArgs),
    Man(ManArgs),
}

/// Negative numbers as in `-5e-12` and `-.5` in plain digits: the reader of the command line takes them
/// for options. The value stays the same to the last bit.
pub(crate) fn plain_numbers(words: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut options_ended = false;
    words
        .map(|word| {
            options_ended |= word == "--";
            let plain = word
                .to_str()
                .filter(|w| !options_ended && looks_negative(w))
                .and_then(|w| w.parse::<f64>().ok())
                .filter(|value| value.is_finite());
            // Written in full by Rust: the shortest digits that give the same number again.
            plain.map_or(word, |value| format!("{value}").into())
        })
        .collect()
}

/// `-inf` or `-nan` where a number belongs, and the option before it: the reader of the command line would take it
/// for an option `-i` or `-n`.
pub(crate) fn no_number(words: &[OsString]) -> Option<String> {
    let words = words.iter().map(|w| w.to_str().unwrap_or_default());
    let mut option = "";
    for word in words.take_while(|w| *w != "--") {
        if word.starts_with("--") {
            option = word;
        }
        let lower = word.to_lowercase();
        if matches!(lower.as_str(), "-inf" | "-infinity" | "-nan") {
            let place = match option {
                "" => String::new(),
                option => format!("{option}: "),
            };
            return Some(format!(
                "{place}'{word}' is no finite number; write one as in -12.5"
            ));
        }
    }
    None
}

/// A minus and a digit, or a point.
fn looks_negative(word: &str) -> bool {
    let after = word.strip_prefix('-').and_then(|w| w.chars().next());
    after.is_some_and(|c| c.is_ascii_digit() || c == '.')
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;
    use clap::builder::ValueParser;
    use std::ffi::OsString;

    use crate::options::{number, small, whole};

    use super::*;

    /// Every option of every command that takes numbers, with the words that lead to it.
    fn options_of_numbers(
        command: &clap::Command,
        path: &[String],
        found: &mut Vec<(Vec<String>, String, usize)>,
    ) {
        let numbers = [
            ValueParser::from(number).type_id(),
            ValueParser::from(whole).type_id(),
            ValueParser::from(small).type_id(),
        ];
        for argument in command.get_arguments() {
            if numbers.contains(&argument.get_value_parser().type_id()) {
                let name = argument.get_long().expect("numbers are options");
                let count = argument.get_num_args().expect("built").min_values();
                found.push((path.to_vec(), format!("--{name}"), count));
            }
        }
        for inner in command.get_subcommands() {
            let mut path = path.to_vec();
            path.push(inner.get_name().to_owned());
            options_of_numbers(inner, &path, found);
        }
    }

    #[test]
    fn negative_numbers_of_all_kinds_are_numbers_for_every_option() {
        let mut command = Cli::command();
        command.build();
        let mut options = Vec::new();
        options_of_numbers(&command, &["kinetostat".to_owned()], &mut options);
        assert!(options.len() >= 50, "{}", options.len());
        let number = ValueParser::from(number).type_id();
        let real = |(path, name, _): &&(Vec<String>, String, usize)| {
            let mut of = &command;
            for word in &path[1..] {
                of = of.find_subcommand(word).expect("a command");
            }
            let mut all = of.get_arguments();
            let own = all.find(|a| a.get_long().is_some_and(|long| name[2..] == *long));
            own.is_some_and(|a| a.get_value_parser().type_id() == number)
        };
        for (path, name, count) in options.iter().filter(real) {
            for written in ["-5e-12", "-1.5E+3", "-2e3", "-.5", "-0", "-1e-320", "-7.25"] {
                let mut words = path.clone();
                words.push(name.clone());
                words.extend(std::iter::repeat_n(written.to_owned(), *count));
                let words = plain_numbers(words.into_iter().map(OsString::from));
                // Other required arguments are missing in this trial, so only a faulty number is an error here.
                if let Err(error) = Cli::try_parse_from(words) {
                    use clap::error::ErrorKind as Kind;
                    assert!(
                        matches!(
                            error.kind(),
                            Kind::MissingRequiredArgument | Kind::ArgumentConflict
                        ),
                        "{name} {written} of {path:?}: {error}"
                    );
                }
            }
        }
    }

    #[test]
    fn what_is_no_number_is_no_option() {
        let said = |line: &str| no_number(&line.split(' ').map(OsString::from).collect::<Vec<_>>());
        for word in ["-inf", "-Infinity", "-nan", "-NaN"] {
            let found = said(&format!("kinetostat deflect m --at 1 {word} 0 --json")).unwrap();
            assert!(
                found.starts_with(&format!("--at: '{word}' is no finite number")),
                "{found}"
            );
            assert!(said(&format!("kinetostat check -- {word}")).is_none());
        }
        assert!(said("kinetostat deflect m --at 1 -5e-12 0 -h").is_none());
    }

    #[test]
    fn a_wrong_number_is_said_with_its_option() {
        let mut command = Cli::command();
        command.build();
        let mut options = Vec::new();
        options_of_numbers(&command, &["kinetostat".to_owned()], &mut options);
        assert!(options.len() >= 60, "{}", options.len());
        for (path, name, count) in &options {
            let refused = |values: &[&str]| {
                let mut words = path.clone();
                words.push(name.clone());
                words.extend(values.iter().map(|&value| value.to_owned()));
                let words = plain_numbers(words.into_iter().map(OsString::from));
                let error = Cli::try_parse_from(words).expect_err("a wrong value");
                let said = error.to_string();
                let first = said.lines().next().unwrap_or_default();
                assert!(first.contains(name), "{path:?} {name} {values:?}: {said}");
            };
            for wrong in [
                "text", "nan", "inf", "1e400", "-1e400", "1,5", "0x10", "5mm", "",
            ] {
                for at in 0..(*count).max(1) {
                    let mut values = vec!["1"; (*count).max(1)];
                    values[at] = wrong;
                    refused(&values);
                }
            }
            // Too few; a value that may be left out is none too few.
            if *count > 0 {
                refused(&vec!["1"; count - 1]);
            }
        }
    }

    /// Options whose text holds numbers: the test `numbers_inside_texts_are_refused_with_their_option` has
    /// them all.
    #[test]
    fn the_options_with_numbers_inside_their_text_are_known() {
        fn texts(command: &clap::Command, found: &mut std::collections::BTreeSet<String>) {
            for argument in command.get_arguments() {
                let names = argument.get_value_names().unwrap_or_default();
                let long = argument.get_long().unwrap_or_default();
                // A call has a word, and a value that is set may be any text.
                let is_text = ["call", "set"].contains(&long);
                if names.iter().any(|name| name.contains('=')) && !is_text {
                    found.insert(long.to_owned());
                }
            }
            for inner in command.get_subcommands() {
                texts(inner, found);
            }
        }
        let mut found = std::collections::BTreeSet::new();
        texts(&Cli::command(), &mut found);
        let known = [
            "axes",
            "controller",
            "grow",
            "home",
            "joints",
            "limit",
            "load",
            "parameter",
            "part-orientation",
            "pendant",
            "rotation",
            "section",
            "tool-diameter-mm",
            "tool-orientation",
            "viscous",
            "work",
            "work-offset",
        ];
        assert_eq!(found, known.map(String::from).into());
    }

    #[test]
    fn plain_numbers_keep_their_value_and_words_stay() {
        let reported = |word: &str| {
            let words = plain_numbers(["k".into(), word.into()].into_iter());
            words[1].to_str().expect("text").to_owned()
        };
        for written in [
            "-5e-12",
            "-1.7976931348623157e308",
            "-5e-324",
            "-0.1e1",
            "-123.456e-7",
        ] {
            let plain = reported(written);
            let [a, b]: [f64; 2] = [written, &plain].map(|t| t.parse().expect("a number"));
            assert_eq!(a.to_bits(), b.to_bits(), "{written}");
            assert!(!plain.contains(['e', 'E']), "{plain}");
        }
        for word in [
            "-e", "--at", "-1e999", "-inf", "5e3", "--e5", "-5", "file-1e5",
        ] {
            assert_eq!(reported(word), word);
        }
        let after = plain_numbers(["--".into(), "-1e3".into()].into_iter());
        assert_eq!(after[1], "-1e3");
    }
}
