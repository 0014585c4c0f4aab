//! Help of a command that fits on a screen; `--help-all` explains every option.

use std::ffi::OsString;

use clap::{Arg, ArgAction, Command};

use crate::ui::layout::{self, WIDTH};

/// Most lines of the help of a command.
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
    let is_command = |word: &&OsString| word.to_str().is_some_and(|word| !word.starts_with('-'));
    if words.get(1).is_some_and(|word| word == "help") && words.len() > 2 {
        words.remove(1);
        words.push("-h".into());
    }
    let of_a_command = words.get(1).is_some_and(|word| is_command(&word));
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
    let options: Vec<&Arg> = command
        .get_arguments()
        .filter(|argument| argument.get_long().is_some() && !argument.is_hide_set())
        .collect();
    let rank = |heading: &str| {
        let known = NAMED_FIRST.iter().position(|first| *first == heading);
        known.unwrap_or(NAMED_FIRST.len())
    };
    let mut groups: Vec<(&str, Vec<String>)> = Vec::new();
    let mut single = Vec::new();
    for option in options {
        let id = option.get_id().to_string();
        let Some(heading) = option.get_help_heading() else {
            single.push(vec![id]);
            continue;
        };
        match groups.iter_mut().find(|(known, _)| *known == heading) {
            Some((_, ids)) => ids.push(id),
            None => groups.push((heading, vec![id])),
        }
    }
    groups.sort_by_key(|(heading, _)| rank(heading));
    let groups = groups.into_iter().map(|(_, ids)| ids);
    groups.chain(single.into_iter().rev()).collect()
}

/// The command with these options named below its help.
fn with_named(command: &Command, named: &[String]) -> Command {
    if named.is_empty() {
        return command.clone();
    }
    let mut groups: Vec<(String, Vec<String>)> = Vec::new();
    for option in command.get_arguments() {
        if !named.iter().any(|id| option.get_id() == id.as_str()) {
            continue;
        }
        let heading = option.get_help_heading().unwrap_or("Others").to_owned();
        let name = format!("--{}", option.get_long().unwrap_or_default());
        match groups.iter_mut().find(|(known, _)| *known == heading) {
            Some((_, names)) => names.push(name),
            None => groups.push((heading, vec![name])),
        }
    }
    let mut text = "Further options, which --help-all explains:\n".to_owned();
    let width = groups.iter().map(|(heading, _)| heading.len()).max();
    for (heading, names) in &groups {
        text.push_str(&layout::named(
            heading,
            width.unwrap_or(0),
            &names.join(" "),
        ));
    }
    if let Some(after) = command.get_after_help() {
        text.push_str(&format!("\n{after}"));
    }
    let is_named = |id: &str| named.iter().any(|own| own == id);
    let command = command.clone();
    let command = command.mut_args(|argument| match is_named(argument.get_id().as_str()) {
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
