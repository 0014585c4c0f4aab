//! One grammar for the inputs of all commands.
//!
//! A model, a job and a program are given as positional arguments, in any order and recognised by their content, or by
//! `--model`, `--job` and `--program`; `-` is standard input. Here such words are put into the form that the command declares,
//! before they are parsed. A command therefore declares each input once.

use std::ffi::{OsStr, OsString};
use std::path::Path;

use clap::{Arg, Command};
use kinetostat_diagnostic::ErrorCode;

use crate::files::file_kind::FileKind;
use crate::files::standard_input;
use crate::ui::failure::{Answer, Failing};

/// Options whose file may be standard input, beside those for models, jobs and programs.
const OTHER_FILES: [&str; 13] = [
    "against",
    "dofs",
    "link-section",
    "loads",
    "loops",
    "map",
    "materials",
    "measured",
    "nodes",
    "pose",
    "template",
    "tool-table",
    "uncertain",
];

/// Options whose number of values is open: an input behind them ends their values.
const OPEN_OPTIONS: [&str; 2] = ["damping", "json"];

/// Inputs that have an option of their own name.
const INPUTS: [FileKind; 3] = [FileKind::Model, FileKind::Job, FileKind::Program];

/// An argument as it is written: a positional one, or an option with its values.
struct Part {
    /// The option as written, such as `--model`.
    option: Option<OsString>,
    values: Vec<OsString>,
    /// True if option and value are one word, as in `--model=arm.toml`.
    is_joined: bool,
}

impl Part {
    fn positional(word: OsString) -> Self {
        Self {
            option: None,
            values: vec![word],
            is_joined: false,
        }
    }

    /// Long name of the option.
    fn name(&self) -> Option<&str> {
        self.option.as_deref()?.to_str()?.strip_prefix("--")
    }

    fn words(mut self) -> Vec<OsString> {
        match self.option {
            Some(mut option) if self.is_joined => {
                option.push("=");
                option.push(&self.values[0]);
                vec![option]
            }
            Some(option) => {
                self.values.insert(0, option);
                self.values
            }
            None => self.values,
        }
    }
}

/// Inputs of a command, as it declares them.
struct Declared<'c> {
    command: &'c Command,
    /// Inputs that a positional argument takes.
    positional: Vec<FileKind>,
    /// Largest number of positional arguments.
    places: usize,
    is_required: bool,
    /// True if positional arguments are inputs or other files.
    reads_files: bool,
}

impl<'c> Declared<'c> {
    fn of(command: &'c Command) -> Self {
        let positionals: Vec<&Arg> = command.get_positionals().collect();
        let names = positionals.iter().flat_map(|argument| inputs_of(argument));
        Self {
            command,
            positional: names.collect(),
            places: positionals.len(),
            reads_files: positionals.iter().all(|argument| {
                let mut names = argument.get_value_names().into_iter().flatten();
                !inputs_of(argument).is_empty() || names.any(|name| name == "FILE")
            }),
            is_required: positionals
                .iter()
                .any(|argument| argument.is_required_set()),
        }
    }

    fn option(&self, name: &str) -> Option<&'c Arg> {
        let is_named = |a: &&Arg| a.get_long() == Some(name) && !a.is_positional();
        self.command.get_arguments().find(is_named)
    }

    /// True if the command declares an option for this input.
    fn has_option(&self, kind: FileKind) -> bool {
        self.option(kind.option()).is_some()
    }

    /// True of an input that the command takes as a positional argument only.
    fn is_only_positional(&self, kind: FileKind) -> bool {
        self.positional.contains(&kind) && !self.has_option(kind)
    }

    /// Divides the words behind the command's name into arguments, as clap does, but for an input behind one of the
    /// [`OPEN_OPTIONS`]; true if there is one.
    fn parts(&self, words: &[OsString]) -> (Vec<Part>, bool) {
        let (mut parts, mut has_ended_one) = (Vec::new(), false);
        let mut rest = words.iter().peekable();
        while let Some(word) = rest.next() {
            if word == "--" {
                parts.extend(rest.by_ref().cloned().map(Part::positional));
                break;
            }
            if !is_option(word) {
                parts.push(Part::positional(word.clone()));
                continue;
            }
            let text = word.to_string_lossy();
            let joined = text.split_once('=').filter(|_| text.starts_with("--"));
            if let (Some((option, value)), Some(_)) = (joined, word.to_str()) {
                parts.push(Part {
                    option: Some(option.into()),
                    values: vec![value.into()],
                    is_joined: true,
                });
                continue;
            }
            let argument = match text.strip_prefix("--") {
                Some(long) => self.option(long),
                None => {
                    let is_short =
                        |a: &&Arg| a.get_short().is_some_and(|s| text == format!("-{s}"));
                    self.command.get_arguments().find(is_short)
                }
            };
            let names_input = |kind: &FileKind| {
                self.is_only_positional(*kind) && text == format!("--{}", kind.option())
            };
            let most = match argument {
                Some(argument) => argument.get_num_args().map_or(0, |n| n.max_values()),
                None => usize::from(INPUTS.iter().any(names_input)),
            };
            let takes_hyphens = argument.is_some_and(Arg::is_allow_hyphen_values_set);
            let long = argument.and_then(Arg::get_long);
            let is_open = long.is_some_and(|long| OPEN_OPTIONS.contains(&long));
            // A word that stands twice is an input and, here, an output, which is refused with that reason.
            let is_once = |word: &OsStr| words.iter().filter(|other| *other == word).count() == 1;
            let is_input = |word: &OsStr| {
                is_open && !is_json(word) && is_once(word) && recognised(word).is_some()
            };
            let mut values = Vec::new();
            while values.len() < most
                && let Some(value) = rest.next_if(|w| takes_hyphens || !is_option(w))
            {
                if is_input(value) {
                    has_ended_one = true;
                    parts.push(Part::positional(value.clone()));
                    break;
                }
                values.push(value.clone());
            }
            parts.push(Part {
                option: Some(long.map_or_else(|| word.clone(), |long| format!("--{long}").into())),
                values,
                is_joined: false,
            });
        }
        (parts, has_ended_one)
    }
}

/// Inputs that a positional argument takes, by the name of its value.
fn inputs_of(argument: &Arg) -> Vec<FileKind> {
    let names = argument.get_value_names().unwrap_or_default();
    let names = names.iter().flat_map(|name| name.split('|'));
    let kinds = names.filter_map(|name| match name {
        "MODEL" | "A" | "B" => Some(FileKind::Model),
        "JOB" => Some(FileKind::Job),
        "PROGRAM" => Some(FileKind::Program),
        _ => None,
    });
    kinds.collect()
}

/// A word with a hyphen in front that is neither a number nor standard input.
fn is_option(word: &OsStr) -> bool {
    let text = word.to_string_lossy();
    text.len() > 1 && text.starts_with('-') && text.parse::<f64>().is_err()
}

/// True of the name of a result.
fn is_json(word: &OsStr) -> bool {
    let ending = Path::new(word).extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("json"))
}

/// Kind of a model, a job or a program; `None` for any other word.
fn recognised(word: &OsStr) -> Option<FileKind> {
    let kind = match word.to_str() {
        Some(name) if kinetostat_model::preset_text(name).is_some() => Some(FileKind::Model),
        _ => FileKind::of_file(Path::new(word)),
    };
    kind.filter(|kind| INPUTS.contains(kind))
}

/// The words of the command line with each input where its command declares it.
pub(crate) fn in_place(command: &Command, words: Vec<OsString>) -> Answer<Vec<OsString>> {
    standard_input::request(false);
    // Help waits for no input.
    if words.iter().any(|word| word == "-h" || word == "--help") {
        return Ok(words);
    }
    let mut of = command;
    let mut begin = 1;
    while let Some(inner) = words.get(begin).and_then(|word| of.find_subcommand(word)) {
        of = inner;
        begin += 1;
    }
    let mut of = of.clone();
    of.build();
    let declared = Declared::of(&of);
    let (mut parts, has_ended_one) = declared.parts(&words[begin.min(words.len())..]);
    let has_standard_input = name_standard_input(&declared, &mut parts)?;
    let has_moved = !declared.positional.is_empty() && rearrange(&declared, &mut parts)?;
    if !has_standard_input && !has_moved && !has_ended_one {
        return Ok(words);
    }
    let (options, positional): (Vec<Part>, Vec<Part>) =
        parts.into_iter().partition(|part| part.option.is_some());
    let mut all = words[..begin].to_vec();
    all.extend(options.into_iter().flat_map(Part::words));
    if !positional.is_empty() {
        all.push("--".into());
        all.extend(positional.into_iter().flat_map(Part::words));
    }
    Ok(all)
}

/// Replaces `-` by the name of standard input where a file is read; true if there is one.
fn name_standard_input(declared: &Declared<'_>, parts: &mut [Part]) -> Answer<bool> {
    let is_file = |part: &&mut Part| match (part.name(), &part.option) {
        (Some(name), _) => {
            OTHER_FILES.contains(&name) || INPUTS.iter().any(|kind| kind.option() == name)
        }
        (None, option) => option.is_none() && declared.reads_files,
    };
    let files = parts.iter_mut().filter(is_file);
    let values = files.flat_map(|part| part.values.iter_mut());
    let mut all: Vec<&mut OsString> = values.filter(|value| *value == "-").collect();
    if all.len() > 1 {
        return Err(ErrorCode::Conflict.failure(
            "'-' is given for several inputs, and standard input can be read for one of them only: name a file for the others",
        ));
    }
    let is_read = !all.is_empty();
    for value in &mut all {
        **value = standard_input::NAME.into();
    }
    standard_input::request(is_read);
    Ok(is_read)
}

/// Gives each input the form that the command declares: an option becomes a positional argument, or the reverse. True if
/// something changed.
fn rearrange(declared: &Declared<'_>, parts: &mut [Part]) -> Answer<bool> {
    let mut has_moved = false;
    for kind in INPUTS {
        let moves = declared.is_only_positional(kind);
        for part in parts
            .iter_mut()
            .filter(|p| moves && p.name() == Some(kind.option()))
        {
            has_moved = true;
            part.option = None;
        }
    }
    let mut given = parts.iter().filter(|part| part.option.is_none()).count();
    let has_options = INPUTS.iter().any(|kind| declared.has_option(*kind));
    for part in parts
        .iter_mut()
        .filter(|p| has_options && p.option.is_none())
    {
        // A lone file of another kind is left where it is needed: the command says what it is.
        if given <= declared.places && declared.is_required {
            break;
        }
        let kind = part.values.first().and_then(|word| recognised(word));
        let Some(kind) = kind.filter(|kind| declared.has_option(*kind)) else {
            continue;
        };
        part.option = Some(format!("--{}", kind.option()).into());
        part.is_joined = true;
        given -= 1;
        has_moved = true;
    }
    for kind in INPUTS {
        let named = parts.iter().filter(|p| p.name() == Some(kind.option()));
        refuse_several(kind.option(), 1, named)?;
    }
    // A word behind a misspelt option may be its value.
    let is_unknown = |part: &Part| {
        part.option.is_some() && part.name().and_then(|name| declared.option(name)).is_none()
    };
    let positional = || parts.iter().filter(|part| part.option.is_none());
    let is_too_many = positional().count() > declared.places;
    if is_too_many && !parts.iter().any(is_unknown) {
        refuse_missing(positional())?;
        let mut words = positional().flat_map(|part| &part.values);
        if has_moved || words.all(|word| recognised(word).is_some()) {
            let all = declared.positional.iter().map(|kind| kind.option());
            let mut all: Vec<&str> = all.collect();
            all.dedup();
            refuse_several(&all.join(" or "), declared.places, positional())?;
        }
    }
    Ok(has_moved)
}

/// Refuses the path of an input where there is no file.
fn refuse_missing<'p>(mut given: impl Iterator<Item = &'p Part>) -> Answer<()> {
    let is_missing = |word: &&OsString| {
        let is_path = word.to_string_lossy().contains(['.', '/', '\\']);
        let is_number = word.to_string_lossy().parse::<f64>().is_ok();
        is_path && !is_number && recognised(word).is_none() && !Path::new(word).exists()
    };
    match given.find_map(|part| part.values.iter().find(is_missing)) {
        Some(word) => {
            Err(ErrorCode::FileNotRead.failure(format!("'{}' does not exist", word.display())))
        }
        None => Ok(()),
    }
}

fn refuse_several<'p>(
    what: &str,
    most: usize,
    given: impl Iterator<Item = &'p Part>,
) -> Answer<()> {
    let quoted = given.flat_map(|part| &part.values);
    let number = if most == 1 { "one" } else { "two" };
    let quoted: Vec<String> = quoted.map(|word| format!("'{}'", word.display())).collect();
    let plural = if most == 1 { "" } else { "s" };
    match quoted.len() > most {
        true => Err(ErrorCode::Conflict.failure(format!(
            "{} are given, and the command takes {number} {what}{plural}: leave the others out",
            quoted.join(" and ")
        ))),
        false => Ok(()),
    }
}

/// The command line whose helps name the options that are the same as a positional argument.
pub(crate) fn with_spellings(command: Command) -> Command {
    let names = command
        .get_subcommands()
        .map(|sub| sub.get_name().to_owned());
    let names: Vec<String> = names.collect();
    names.into_iter().fold(command, |command, name| {
        command.mut_subcommand(name, |sub| {
            let options: Vec<String> = sub
                .get_opts()
                .filter_map(|o| Some(o.get_long()?.to_owned()))
                .collect();
            let sub = sub.mut_args(|argument| with_spelling(argument, &options));
            with_spellings(sub)
        })
    })
}

fn with_spelling(argument: Arg, options: &[String]) -> Arg {
    let kinds = match argument.is_positional() {
        true => inputs_of(&argument),
        false => Vec::new(),
    };
    let kinds = kinds
        .into_iter()
        .filter(|kind| !options.iter().any(|o| o == kind.option()));
    let names: Vec<String> = kinds.map(|kind| format!("--{}", kind.option())).collect();
    match argument.get_help().filter(|_| !names.is_empty()) {
        Some(help) => {
            let help = format!("{help} (or {})", names.join(", "));
            argument.help(help)
        }
        None => argument,
    }
}
