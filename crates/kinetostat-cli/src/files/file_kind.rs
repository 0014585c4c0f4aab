//! Kinds of files by their content: a file of one kind in the place of another is named as such.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{language_of, odd_program};
use toml::de::{DeTable, DeValue};

use crate::files::standard_input;
use crate::ui::failure::{Answer, Failing};

/// Bytes that are looked at of a large file.
const LOOKED_AT: u64 = 1 << 20;

/// Lines of a program that are looked at.
const LINES: usize = 100;

/// Keys and tables by which a job is recognised.
const JOB_KEYS: [&str; 6] = ["program", "model", "placement", "load", "stock", "output"];

/// Kind of a file by its content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FileKind {
    Job,
    Model,
    Program,
    /// A robot in URDF, or a macro of it.
    Urdf,
    /// Another text in XML.
    Xml,
    /// A table with the names of its columns: measured points, corrections, loads.
    Table,
    /// A table in Parquet that is no program.
    Parquet,
}

impl FileKind {
    /// The kind of a file; `None` where its content says none.
    pub(crate) fn of(path: &Path, bytes: &[u8]) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy();
        let text = String::from_utf8_lossy(bytes);
        if is_xml(bytes) {
            // Programs of VAL3 are XML as well.
            return Some(match language_of(&name, bytes) {
                Some(_) => Self::Program,
                None if text.contains("<robot") => Self::Urdf,
                None => Self::Xml,
            });
        }
        if let Ok(tree) = DeTable::parse(&text) {
            let keys = tree.get_ref().keys();
            return Self::of_keys(&keys.map(|key| &**key.get_ref()).collect::<Vec<_>>());
        }
        let is_toml = name.to_ascii_lowercase().ends_with(".toml");
        if (is_toml || standard_input::is(path))
            && let Some(kind) = Self::of_keys(&keys_of_faulty(&text))
        {
            return Some(kind);
        }
        let mut lines = text.lines();
        let columns = lines.find(|line| !line.trim().is_empty()).and_then(columns);
        let is_program = language_of(&name, bytes).is_some()
            || odd_program(&name, bytes).is_some()
            || text.lines().take(LINES).any(is_block);
        match columns {
            _ if is_toml => None,
            Some(names) if !are_poses(&names) => Some(Self::Table),
            _ if is_program => Some(Self::Program),
            Some(_) => Some(Self::Table),
            None => bytes.starts_with(b"PAR1").then_some(Self::Parquet),
        }
    }

    /// The kind of a TOML file by its keys and tables.
    fn of_keys(keys: &[&str]) -> Option<Self> {
        let has = |key: &&str| keys.contains(key);
        match has(&"mechanism") || has(&"platform") {
            true => Some(Self::Model),
            false => JOB_KEYS.iter().any(has).then_some(Self::Job),
        }
    }

    /// The kind of a file on disk; `None` of one that cannot be read.
    pub(crate) fn of_file(path: &Path) -> Option<Self> {
        // A pipe can be read only once, and is left to who reads it as a whole.
        let is_kept = path.is_file() || standard_input::is(path);
        let bytes = is_kept.then(|| beginning(path)).flatten()?;
        Self::of(path, &bytes)
    }

    fn words(self) -> &'static str {
        match self {
            Self::Job => "a job file",
            Self::Model => "a model",
            Self::Program => "a program",
            Self::Urdf => "a robot in URDF",
            Self::Xml => "a file in XML",
            Self::Table => "a table (CSV)",
            Self::Parquet => "a table (Parquet)",
        }
    }

    /// Name of the option for an input of this kind; empty for a kind without an option.
    pub(crate) fn option(self) -> &'static str {
        match self {
            Self::Job => "job",
            Self::Model => "model",
            Self::Program => "program",
            Self::Urdf | Self::Xml | Self::Table | Self::Parquet => "",
        }
    }

    /// Remedy if this kind was given for another one.
    fn advice(self, needed: Self, path: &Path, named: Option<&str>) -> String {
        let path = match standard_input::is(path) {
            true => "-".to_owned(),
            false => path.display().to_string(),
        };
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
            (Self::Program, _) => format!(
                "give a preset (`kinetostat model list`) or a model file. `kinetostat compensate --model MODEL --program {path}` takes the program"
            ),
            (Self::Urdf, _) => format!(
                "`kinetostat import urdf {path} --out model.toml` writes a model of it (expand a xacro file first)"
            ),
            (Self::Xml, _) => {
                "no command reads it, but robots in URDF (`kinetostat import urdf`)".to_owned()
            }
            (Self::Table, _) => format!(
                "`kinetostat mirror PROGRAM --measured {path}` takes measured points, `kinetostat compensate --map {path} --program FILE` takes corrections"
            ),
            (Self::Parquet, _) => format!(
                "a list of poses is a program: `kinetostat compensate --model MODEL --program {path}` takes it if its name ends in .parquet"
            ),
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

/// Names of the tables and keys of a TOML file with a fault in its syntax.
fn keys_of_faulty(text: &str) -> Vec<&str> {
    let lines = text.lines().map(str::trim_start);
    let entries = lines.filter(|line| line.starts_with('[') || line.contains('='));
    let names = entries.map(|line| {
        let line = line.trim_start_matches(['[', ' ']);
        let end = line.find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        end.map_or(line, |end| &line[..end])
    });
    names.collect()
}

/// True of a text in XML.
pub(crate) fn is_xml(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let bytes = bytes.trim_ascii_start();
    bytes.first() == Some(&b'<')
        && bytes
            .get(1)
            .is_some_and(|b| b"?!".contains(b) || b.is_ascii_alphabetic())
}

/// Names of the columns of a table, if this is its first line: words without spaces between commas, semicolons or tabs.
fn columns(line: &str) -> Option<Vec<String>> {
    let names = line.split([',', ';', '\t']).map(str::trim);
    let names: Vec<String> = names.map(str::to_ascii_lowercase).collect();
    let is_name = |name: &String| {
        name.starts_with(|c: char| c.is_ascii_alphabetic())
            && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    (names.len() > 1 && names.iter().all(is_name)).then_some(names)
}

/// True of the columns of a list of poses, which is a program.
fn are_poses(names: &[String]) -> bool {
    let has = |start: &str| names.iter().any(|name| name.starts_with(start));
    (has("x") || has("joint")) && !has("dx")
}

/// Refuses a file of another kind than the one that is needed.
pub(crate) fn refuse_other_kind(path: &Path, bytes: &[u8], needed: FileKind) -> Answer<()> {
    // Poses and points in a table are a program where one is needed.
    let fits = |kind: FileKind| {
        let is_table = matches!(kind, FileKind::Table | FileKind::Parquet);
        kind == needed || is_table && needed == FileKind::Program
    };
    let Some(kind) = FileKind::of(path, bytes).filter(|kind| !fits(*kind)) else {
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
    if standard_input::is(path) {
        return standard_input::beginning(LOOKED_AT).ok();
    }
    let mut bytes = Vec::new();
    let read = File::open(path)
        .ok()?
        .take(LOOKED_AT)
        .read_to_end(&mut bytes);
    read.ok().map(|_| bytes)
}
