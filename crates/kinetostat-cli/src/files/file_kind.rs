//! Kinds of files that are told apart by what is in them: a job, a model or a program in the place of another is named as such.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::language_of;
use toml::de::{DeTable, DeValue};

use crate::ui::failure::{Answer, Failing};

/// Bytes that are looked at of a large file.
const LOOKED_AT: u64 = 1 << 20;

/// Lines of a program that are looked at.
const LINES: usize = 100;

/// Kind of a file by its content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FileKind {
    Job,
    Model,
    Program,
}

impl FileKind {
    /// The kind of a file; `None` where its content says none.
    pub(crate) fn of(path: &Path, bytes: &[u8]) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy();
        let text = String::from_utf8_lossy(bytes);
        if let Ok(tree) = DeTable::parse(&text) {
            let has = |key: &str| tree.get_ref().keys().any(|k| k.get_ref() == key);
            return match (
                has("mechanism") || has("platform"),
                has("program") || has("model"),
            ) {
                (true, _) => Some(Self::Model),
                (false, true) => Some(Self::Job),
                (false, false) => None,
            };
        }
        let is_toml = name.to_ascii_lowercase().ends_with(".toml");
        let is_program =
            language_of(&name, bytes).is_some() || text.lines().take(LINES).any(is_block);
        (!is_toml && is_program).then_some(Self::Program)
    }

    /// The kind of a file on disk; `None` of one that cannot be read.
    pub(crate) fn of_file(path: &Path) -> Option<Self> {
        let bytes = beginning(path).filter(|_| path.is_file())?;
        Self::of(path, &bytes)
    }

    fn words(self) -> &'static str {
        match self {
            Self::Job => "a job file",
            Self::Model => "a model",
            Self::Program => "a program",
        }
    }

    /// Remedy if this kind was given for another one.
    fn advice(self, needed: Self, path: &Path, named: Option<&str>) -> String {
        let path = path.display();
        match (self, needed) {
            (Self::Program, Self::Job) => format!(
                "name it in a job file (program = \"{path}\"), or give it as --program {path} with --model MODEL"
            ),
            (Self::Model, Self::Job) => format!(
                "name it in a job file (model = \"{path}\"), or give it as --model {path} with --program FILE"
            ),
            (Self::Job, _) => match named {
                Some(named) => format!("give the one that it names, '{named}'"),
                None => "it names none: write its path".to_owned(),
            },
            (Self::Program, _) => {
                "give a preset (`kinetostat model list`) or a model file, and the program as --program where the command has it".to_owned()
            }
            (Self::Model, _) => "give it as --model where the command has that".to_owned(),
        }
    }
}

/// A block of G-code: a letter with a number behind it.
fn is_block(line: &str) -> bool {
    let line = line.trim_start_matches(['/', ' ', '\t']);
    let mut letters = line.chars();
    let address = letters
        .next()
        .is_some_and(|c| "GMNTXYZFSO".contains(c.to_ascii_uppercase()));
    address
        && letters
            .next()
            .is_some_and(|c| c.is_ascii_digit() || matches!(c, '-' | '.'))
}

/// Refuses a file of another kind than the one that is needed.
pub(crate) fn refuse_other_kind(path: &Path, bytes: &[u8], needed: FileKind) -> Answer<()> {
    let Some(kind) = FileKind::of(path, bytes).filter(|kind| *kind != needed) else {
        return Ok(());
    };
    let text = String::from_utf8_lossy(bytes);
    let tree = DeTable::parse(&text).ok();
    let key = match needed {
        FileKind::Model => "model",
        _ => "program",
    };
    let named = tree.as_ref().and_then(|tree| {
        let mut all = tree.get_ref().iter();
        let (_, value) = all.find(|(k, _)| k.get_ref() == key)?;
        match value.get_ref() {
            DeValue::String(named) => Some(named.to_string()),
            _ => None,
        }
    });
    Err(ErrorCode::FileForm.failure(format!(
        "'{}' is {}, and {} is needed here: {}",
        path.display(),
        kind.words(),
        needed.words(),
        kind.advice(needed, path, named.as_deref())
    )))
}

/// The beginning of a file, if it can be read.
pub(crate) fn beginning(path: &Path) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = File::open(path)
        .ok()?
        .take(LOOKED_AT)
        .read_to_end(&mut bytes);
    read.ok().map(|_| bytes)
}
