//! Settings of an expansion, from options and the table `[expand]` of a job file; options have priority.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_program::{Dialect, ExpandOptions, OriginComments, OtherAxes, ReadOptions};

use crate::job::dialect_word::DialectWord;
use crate::job::expand_table::NumberedTable;
use crate::job::expansion::arguments::{ExpandFlags, ExpansionArgs};
use crate::job::job_file::JobFile;
use crate::job::values::NotAllowed;
use crate::ui::failure::{Answer, Failing};

/// Settings of an expansion.
pub(crate) struct ExpandSettings {
    pub(crate) options: ExpandOptions,
    /// Folders of subprograms beside that of the program.
    pub(crate) folders: Vec<PathBuf>,
    /// A job file asks for comments with the lines of flat blocks: programs of controls have them only then.
    pub(crate) comments_asked: bool,
    /// Description of the settings, for results.
    pub(crate) words: Vec<String>,
}

/// The settings where the program of a run is to be expanded; none where it is not. A program that is converted has a flat one, too.
pub(crate) fn wanted(
    job: Option<&JobFile>,
    flags: &ExpandFlags,
    is_converted: bool,
    reading: &ReadOptions,
) -> Answer<Option<ExpandSettings>> {
    if flags.expand || job.is_some_and(|j| j.job.expand.is_some()) {
        return settings(job, &flags.with, reading).map(Some);
    }
    // A program that is converted is written before it is compensated, too.
    let flat = flags.flat_program.is_some() && !is_converted;
    let flat = flat.then_some("--flat-program");
    if let Some(option) = flags.with.given().or(flat) {
        return Err(ErrorCode::Unused.failure(format!(
                "{option} says something about an expanded program, and this one is read as it stands; add --expand (in a job file: a table [expand]), or leave {option} out"
            ),
        ));
    }
    let by_job = |j: &JobFile| match &j.job.robot {
        Some(table) => table.get_ref().to.is_some(),
        None => false,
    };
    let unused = job
        .filter(|j| !is_converted && !by_job(j))
        .and_then(|j| Some((j, j.job.output.flat_program.as_ref()?)));
    match unused {
        Some((j, written)) => Err(j.error(
            written,
            "there is a flat program only where the program is expanded or converted",
            "add a table [expand] (of a program to convert: to under [robot]), or leave this line out",
        )),
        None => Ok(None),
    }
}

/// Settings of an expansion, from options and job file.
pub(crate) fn settings(
    job: Option<&JobFile>,
    args: &ExpansionArgs,
    reading: &ReadOptions,
) -> Answer<ExpandSettings> {
    let mut options = ExpandOptions::default();
    options.reading = reading.clone();
    // Missing tools are reported when the flat program is read.
    options.reading.tools = None;
    // The axes of rotary letters come from the model when the flat program is read.
    if options.reading.other_axes == OtherAxes::Refused {
        options.reading.other_axes = OtherAxes::Carried;
    }
    let table = job.and_then(|j| Some((j, j.job.expand.as_ref()?.get_ref())));
    let mut comments = !args.no_comments && !args.goes_on;
    let in_job = table.and_then(|(_, table)| table.dialect);
    let dialect = args.dialect.or(in_job).map(DialectWord::dialect);
    options.dialect = dialect.unwrap_or_default();
    let mut folders = folders(args)?;
    if let Some((j, table)) = table {
        comments = comments && table.comments.unwrap_or(true);
        options.tool_diameters_mm = of_table(j, table.tool_diameters_mm.as_ref(), diameter)?;
        options.parameters = of_table(j, table.parameters.as_ref(), any)?;
        for written in &table.subprograms {
            let folder = j.base().join(written.get_ref());
            if written.get_ref().trim().is_empty() || !folder.is_dir() {
                let help = "name a folder; paths count from the folder of the job file";
                return Err(j.error(written, &no_folder(&folder), help));
            }
            folders.push(folder);
        }
    }
    let diameters = of_options("--tool-diameter-mm", &args.tool_diameter_mm, diameter)?;
    options.tool_diameters_mm.extend(diameters);
    let parameters = of_options("--parameter", &args.parameter, any)?;
    options.parameters.extend(parameters);
    options.origin_comments = match comments {
        true => OriginComments::Written,
        false => OriginComments::Left,
    };
    let words = words(&options, &folders);
    let asked = table.is_some_and(|(_, table)| table.comments == Some(true));
    Ok(ExpandSettings {
        comments_asked: asked && comments,
        options,
        folders,
        words,
    })
}

/// Folders of subprograms that options name.
pub(crate) fn folders(args: &ExpansionArgs) -> Answer<Vec<PathBuf>> {
    match args.subprograms.iter().find(|folder| !folder.is_dir()) {
        Some(folder) => {
            Err(ErrorCode::FileNotRead.failure(format!("--subprograms: {}", no_folder(folder))))
        }
        None => Ok(args.subprograms.clone()),
    }
}

fn dialect_name(dialect: Dialect) -> &'static str {
    match dialect {
        Dialect::LinuxCnc => "LinuxCNC",
        Dialect::Fanuc => "Fanuc",
        _ => "",
    }
}

fn no_folder(folder: &Path) -> String {
    format!("'{}' is no folder", folder.display())
}

fn words(options: &ExpandOptions, folders: &[PathBuf]) -> Vec<String> {
    let listed = |values: &BTreeMap<u32, f64>, before: &str, unit: &str| {
        let each = values
            .iter()
            .map(|(number, value)| format!("{before}{number} = {value}{unit}"));
        each.collect::<Vec<_>>().join(", ")
    };
    // Paths are omitted: a report may be passed on.
    let names: Vec<String> = folders
        .iter()
        .filter_map(|folder| Some(folder.file_name()?.to_string_lossy().into_owned()))
        .collect();
    let mut words = Vec::new();
    for (what, text) in [
        ("folders of subprograms", names.join(", ")),
        (
            "diameters of tools",
            listed(&options.tool_diameters_mm, "T", " mm"),
        ),
        ("parameters", listed(&options.parameters, "#", "")),
        ("dialect", dialect_name(options.dialect).to_owned()),
    ] {
        if !text.is_empty() {
            words.push(format!("{what}: {text}"));
        }
    }
    words
}

/// Predicate for allowed values.
pub(super) type Allowed = fn(f64) -> Result<f64, NotAllowed>;

/// Diameters of tools: what would be larger is in another unit.
fn diameter(mm: f64) -> Result<f64, NotAllowed> {
    match (-1000.0..=1000.0).contains(&mm) {
        true => Ok(mm),
        false => Err(NotAllowed(
            "a tool is at most 1000 mm in diameter; a diameter below 0 puts it on the other side",
        )),
    }
}

/// Parameters: any number.
fn any(value: f64) -> Result<f64, NotAllowed> {
    match value.is_finite() {
        true => Ok(value),
        false => Err(NotAllowed("a finite number is needed")),
    }
}

/// The values of options by their numbers.
fn of_options(option: &str, words: &[String], allowed: Allowed) -> Answer<BTreeMap<u32, f64>> {
    let mut values = BTreeMap::new();
    for word in words {
        let refuse = |what: &str| {
            ErrorCode::Value.failure(format!(
                "{option} '{word}': {what}; write a number and its value, as in 3=6.5"
            ))
        };
        let (number, value) = word
            .split_once('=')
            .ok_or_else(|| refuse("there is no ="))?;
        let number: u32 = number
            .trim()
            .parse()
            .map_err(|_| refuse("before the = stands no whole number"))?;
        let value = value.trim().parse().ok().filter(|x: &f64| x.is_finite());
        let value = value.ok_or_else(|| refuse("behind the = stands no number"))?;
        let value = allowed(value).map_err(|NotAllowed(reason)| refuse(reason))?;
        if values.insert(number, value).is_some() {
            return Err(refuse("the number comes twice"));
        }
    }
    Ok(values)
}

/// The values of a table of a job by their numbers.
fn of_table(
    job: &JobFile,
    table: Option<&NumberedTable>,
    allowed: Allowed,
) -> Answer<BTreeMap<u32, f64>> {
    let mut values = BTreeMap::new();
    for (key, value) in table.into_iter().flat_map(|table| table.get_ref()) {
        let number: u32 = key.get_ref().trim().parse().map_err(|_| {
            let what = format!("'{}' is no whole number", key.get_ref());
            job.error(
                key,
                &what,
                "write a number and its value, as in  { 3 = 6.5 }",
            )
        })?;
        let number_value = allowed(*value.get_ref()).map_err(|NotAllowed(reason)| {
            let what = format!("the value {} is not allowed here", value.get_ref());
            job.error(value, &what, reason)
        })?;
        // 1 and 01 are one number.
        if values.insert(number, number_value).is_some() {
            let what = format!("the number {number} comes twice");
            return Err(job.error(key, &what, "keep one of the two"));
        }
    }
    Ok(values)
}
