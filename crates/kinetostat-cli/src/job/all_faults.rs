//! All faults of a job file in one run: what is wrong is taken out of the file and the rest is read
//! again, until nothing is left to say.

use std::ops::Range;
use std::path::Path;

use kinetostat_diagnostic::{TomlFault, TomlFaultKind};
use kinetostat_model::exact;
use serde_spanned::Spanned;
use toml::de::{DeTable, DeValue};

use crate::files::input_files::InputFiles;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::format::Job;
use crate::job::job_file::JobFile;
use crate::job::machine::machine_setup;
use crate::job::of_model::give_of_model;
use crate::job::program;
use crate::job::setting::setting;
use crate::job::source::Source;
use crate::job::toml_tree::{holds, table_of, take};
use crate::ui::failure::{Answer, Code, Failure};

/// Upper limit of the faults that are searched.
const MOST: usize = 100;

/// The query of a run along a program: enough to read everything that its job file says.
pub(crate) struct RunQuery<'a> {
    pub(crate) job: Option<&'a Path>,
    pub(crate) model: Option<&'a str>,
    pub(crate) program: &'a ProgramArgs,
    pub(crate) writing: WritingFlags<'a>,
}

/// The failure of a run, or all faults of its job file if there are more.
pub(crate) fn with_all_others(files: &InputFiles, query: &RunQuery<'_>, first: Failure) -> Failure {
    match query.job {
        Some(path) if first.code() == Code::WrongInput => {
            all(files, path, query, &first).unwrap_or(first)
        }
        _ => first,
    }
}

fn all(files: &InputFiles, path: &Path, query: &RunQuery<'_>, first: &Failure) -> Option<Failure> {
    let text = files.job(path).ok()?;
    let name = path.display().to_string();
    let source = Source {
        file: &name,
        text: &text,
    };
    let mut tree = DeTable::parse(&text).ok()?;
    let mut found = Vec::new();
    let mut taken = Vec::new();
    // Faults of form: unknown keys, words for numbers, NaN.
    for span in source.not_finite(&tree) {
        add(&mut found, source.not_finite_number(span.clone()));
        take(tree.get_mut(), span, &mut taken);
    }
    let mut put = Vec::new();
    // Each turn takes something out or puts something in that was not there before; the bound is for what nobody thought of.
    for _ in 0..10 * MOST {
        let Err(error) = read(&tree) else { break };
        if !put_right(&source, &mut tree, &error, &mut found, &mut taken, &mut put) {
            break;
        }
    }
    // Faults of meaning: each part of the question as far as it can be read.
    if let Ok(job) = read(&tree)
        && let Err(failure) = Job::version(source, &job)
    {
        add(&mut found, failure);
    }
    let parts: [Part<'_>; 3] = [
        &|job| setting(files, Some(job), query.program, &query.writing).map(drop),
        &|job| {
            let mut inputs = Vec::new();
            machine_setup(
                files,
                Some(job),
                query.model,
                query.program,
                None,
                &mut inputs,
            )
            .map(drop)
        },
        &|job| {
            // A model that cannot be read leaves tool, placement and load to check, without masses, for this machine has no weight.
            let mut job = job.clone();
            job.job.deviation.clear();
            let tool = &mut job.job.tool;
            (tool.mass_kg, tool.centre_of_mass_mm, tool.inertia_kg_m2) = (None, None, None);
            for tool in &mut job.job.tools {
                let tool = tool.get_mut();
                (tool.mass_kg, tool.centre_of_mass_mm, tool.inertia_kg_m2) = (None, None, None);
            }
            let mut inputs = Vec::new();
            machine_setup(
                files,
                Some(&job),
                Some("orthoglide"),
                query.program,
                None,
                &mut inputs,
            )
            .map(drop)
        },
    ];
    for part in parts {
        for _ in 0..MOST {
            let Ok(job) = read(&tree) else {
                break;
            };
            let job = JobFile {
                path: path.to_owned(),
                text: text.clone(),
                job,
                left_out: taken.iter().map(|(key, _)| key.clone()).collect(),
                is_searched: true,
            };
            let Err(failure) = part(&job) else { break };
            if failure.code() != Code::WrongInput {
                break;
            }
            let Some(span) = failure.place.clone() else {
                add(&mut found, failure);
                break;
            };
            if !follows(&span, &taken) {
                add(&mut found, failure);
            }
            if !take(tree.get_mut(), span, &mut taken) {
                break;
            }
        }
    }
    // The program's own faults, where everything that says how to read it is right; those that were found are not looked for again.
    if !first.is_of_program
        && let Ok(job) = JobFile::read(files, path)
        && let Ok(mut setting) = setting(files, Some(&job), query.program, &query.writing)
        && let Err(failure) =
            give_of_model(&mut setting, files, Some(&job), query.model, query.program)
                .and_then(|()| program::read_program(&setting).map(drop))
    {
        add(&mut found, failure);
    }
    add(&mut found, first.clone());
    // Sorted by place in the file; faults without a line come last.
    found.sort_by_key(|f| f.place.as_ref().map_or(usize::MAX, |span| span.start));
    Some(Failure::together(found))
}

fn read(tree: &Spanned<DeTable<'_>>) -> Result<Job, toml::de::Error> {
    exact(toml::de::Deserializer::from(tree.clone()))
}

/// True if a place contains a key that was removed with a message of its own: further faults there are consequences.
fn follows(place: &Range<usize>, taken: &[(String, Range<usize>)]) -> bool {
    taken.iter().any(|(_, span)| holds(place, span))
}

fn add(found: &mut Vec<Failure>, failure: Failure) {
    // A message of several faults holds those that were found before.
    if !found
        .iter()
        .any(|known| failure.plain.contains(&known.plain))
    {
        found.push(failure);
    }
}

/// Notes what the reader does not accept and takes it out, or puts in what is missing; false where
/// that leads nowhere.
fn put_right(
    source: &Source<'_>,
    tree: &mut Spanned<DeTable<'_>>,
    error: &toml::de::Error,
    found: &mut Vec<Failure>,
    taken: &mut Places,
    put: &mut Places,
) -> bool {
    let fault = TomlFault::of(error);
    let span = fault.span.clone();
    // A placeholder that was not accepted is no number: its whole table is removed.
    let behind_the_text = source.text.len() + 1;
    if let Some(own) = span.start.checked_sub(behind_the_text) {
        return match put.get(own).cloned() {
            Some((_, table)) if !table.is_empty() => take(tree.get_mut(), table, taken),
            _ => false,
        };
    }
    let missing = match &fault.kind {
        TomlFaultKind::MissingKey(key) => Some(key.clone()),
        _ => None,
    };
    // A key that was removed with a message of its own is not missing; under a header it lies beside the table's place.
    let was_there = match &missing {
        Some(missing) => taken.iter().any(|(key, place)| {
            let under_header = || {
                taken
                    .iter()
                    .any(|(key, table)| key.is_empty() && *table == span)
            };
            key == missing && (span.is_empty() || holds(&span, place) || under_header())
        }),
        None => follows(&span, taken),
    };
    if !was_there {
        let before = found.len();
        add(found, source.content(fault));
        if found.len() == before || before >= MOST {
            return false;
        }
    }
    if let Some(key) = missing {
        let own = (key.clone(), span.clone());
        if put.contains(&own) {
            return take(tree.get_mut(), span, taken);
        }
        // Version 1, and any number for a number, at a place that no text has.
        let Ok(value) = DeValue::parse("1") else {
            return false;
        };
        let place = behind_the_text + put.len();
        let value = Spanned::new(place..place + 1, value.into_inner());
        put.push(own);
        let key = Spanned::new(span.clone(), key.into());
        let at = table_of(tree.get_mut(), &span);
        let table = match at {
            Some(table) => table,
            None => tree.get_mut(),
        };
        return table.insert(key, value).is_none();
    }
    take(tree.get_mut(), span, taken)
}

/// Keys with the places of what belongs to them.
type Places = Vec<(String, Range<usize>)>;

/// Reads a part of the question from a job.
type Part<'a> = &'a dyn Fn(&JobFile) -> Answer<()>;
