//! Help of a command that fits on a screen; `--help-all` explains every option.

use std::ffi::OsString;

use clap::{Arg, ArgAction, Command};

use crate::ui::layout::{self, WIDTH};

/// Largest number of lines of the help of a command.
const MOST_LINES: usize = 80;

/// Groups of options that are named only where a help is too long, the first ones first. Other groups follow.
const NAMED_FIRST: [&str; 19] = [
    "Limits",
    "Expansion",
    "Reading",
    "Robot programs",
    "Free turn",
    "Joint values",
    "Other language",
    "Spindle",
    "Fit",
    "Drilling and turning",
    "Damping",
    "Search",
    "Tolerances",
    "Material",
    "Outputs",
    "Placement",
    "Tool",
    "Stock",
    "Load",
];

/// Words with the short help for `--help` and `help`, and the long one for `--help-all`. The help of kinetostat itself
/// is a long one.
pub(crate) fn with_help_words(mut words: Vec<OsString>) -> Vec<OsString> {
    if words.get(1).is_some_and(|word| word == "help") && words.len() > 2 {
        words.remove(1);
        words.push("-h".into());
    }
    let first = words.get(1).and_then(|word| word.to_str());
    let of_a_command = first.is_some_and(|word| !word.starts_with('-'));
    for word in words.iter_mut().skip(1).take_while(|word| **word != "--") {
        if word == "--help" && of_a_command {
            *word = "-h".into();
        } else if word == "--help-all" {
            *word = "--help".into();
        }
    }
    words
}

/// The command line with helps of at most 80 lines: options beyond are named, and not explained.
pub(crate) fn with_short_help(command: Command) -> Command {
    let names: Vec<String> = command
        .get_subcommands()
        .map(|sub| sub.get_name().to_owned())
        .collect();
    names.into_iter().fold(command, |command, name| {
        command.mut_subcommand(name, |sub| shortened(with_short_help(sub)))
    })
}

fn shortened(command: Command) -> Command {
    let help = Arg::new("help").short('h').long("help");
    let help = help.action(ArgAction::Help);
    let help = help.help("Print help; --help-all explains every option");
    let mut explained = command.clone().disable_help_flag(true).arg(help);
    if let (Some(examples), Some(after)) = (examples(&command), command.get_after_help()) {
        explained = explained.after_help(format!("{examples}\n\n{after}"));
    }
    let mut named: Vec<String> = Vec::new();
    for next in in_order(&command) {
        if lines(&with_named(&explained, &named)) <= MOST_LINES {
            break;
        }
        named.extend(next);
    }
    with_named(&explained, &named)
}

/// The examples of a command, which stand in its long help.
fn examples(command: &Command) -> Option<String> {
    let long = command.get_after_long_help()?.to_string();
    let mut parts = long.split("\n\n");
    let found = parts.find(|part| part.starts_with("Examples:"));
    found.map(str::to_owned)
}

/// Options by the order in which they are only named: groups, then single options from the last one on.
fn in_order(command: &Command) -> Vec<Vec<String>> {
    let rank = |heading: &str| {
        let known = NAMED_FIRST.iter().position(|first| *first == heading);
        known.unwrap_or(NAMED_FIRST.len())
    };
    let ids = |options: Vec<&Arg>| options.iter().map(|o| o.get_id().to_string()).collect();
    let options = command.get_arguments();
    let options = options.filter(|o| o.get_long().is_some() && !o.is_hide_set());
    let (grouped, single): (Vec<&Arg>, Vec<&Arg>) =
        options.partition(|option| option.get_help_heading().is_some());
    let mut groups = by_heading(grouped);
    groups.sort_by_key(|(heading, _)| rank(heading));
    let groups = groups.into_iter().map(|(_, options)| ids(options));
    let single = single.into_iter().rev().map(|option| ids(vec![option]));
    groups.chain(single).collect()
}

/// Options by their headings, both in the order in which they are declared.
fn by_heading<'c>(options: impl IntoIterator<Item = &'c Arg>) -> Vec<(&'c str, Vec<&'c Arg>)> {
    let mut groups: Vec<(&str, Vec<&Arg>)> = Vec::new();
    for option in options {
        let heading = option.get_help_heading().unwrap_or("Others");
        match groups.iter_mut().find(|(known, _)| *known == heading) {
            Some((_, own)) => own.push(option),
            None => groups.push((heading, vec![option])),
        }
    }
    groups
}

/// The command with these options named below its help.
fn with_named(command: &Command, named: &[String]) -> Command {
    if named.is_empty() {
        return command.clone();
    }
    let is_named = |option: &Arg| named.iter().any(|own| option.get_id() == own.as_str());
    let groups = by_heading(command.get_arguments().filter(|option| is_named(option)));
    let mut text = "Further options, which --help-all explains:\n".to_owned();
    let width = groups.iter().map(|(heading, _)| heading.len()).max();
    for (heading, options) in &groups {
        let names = options.iter().filter_map(|option| option.get_long());
        let names: Vec<String> = names.map(|name| format!("--{name}")).collect();
        let width = width.unwrap_or(0);
        text.push_str(&layout::named(heading, width, &names.join(" ")));
    }
    if let Some(after) = command.get_after_help() {
        text.push_str(&format!("\n{after}"));
    }
    let command = command.clone();
    let command = command.mut_args(|argument| match is_named(&argument) {
        true => argument.hide_short_help(true),
        false => argument,
    });
    let long = command
        .get_after_long_help()
        .or(command.get_after_help())
        .cloned();
    let command = command.after_help(text);
    match long {
        Some(long) => command.after_long_help(long),
        None => command,
    }
}

fn lines(command: &Command) -> usize {
    let mut command = command.clone().term_width(WIDTH);
    command.render_help().to_string().lines().count()
}
