//! Decides if a program needs to be expanded, and expands it.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::Range;

use crate::error::ProgramError;
use crate::flat_run::{MOST_STEPS, RefusedRun, Runs, with_corners};
use crate::model::stated_value::told_of_values;
use crate::options::ReadOptions;
use crate::siemens::block::{Block, What};
use crate::siemens::called::{program_name, whole_file};
use crate::siemens::flat::corners::written_out;
use crate::siemens::flat::runner::Runner;
use crate::siemens::flat::structure::Unit;
use crate::text::source::{FlatText, SourceFile};

/// Words that say what runs.
const FLOW: [&str; 28] = [
    "IF", "ELSE", "ENDIF", "WHILE", "ENDWHILE", "FOR", "ENDFOR", "REPEAT", "REPEATB", "UNTIL",
    "LOOP", "ENDLOOP", "GOTO", "GOTOF", "GOTOB", "GOTOC", "GOTOS", "CASE", "CALL", "PCALL",
    "MCALL", "CYCLE81", "CYCLE82", "CYCLE83", "HOLES1", "HOLES2", "L", "P",
];

/// Runs a SINUMERIK program once and writes it flat: without jumps, loops, subprograms, variables, the drilling cycles CYCLE81,
/// CYCLE82 and CYCLE83, rows and circles of holes (HOLES1, HOLES2), and corners between two lines that are rounded or broken (RND, CHF, CHR). The program is the first file that ends in `.mpf`, or the first; the others are its subprograms, by their
/// names. What needs none of that comes back byte for byte.
///
/// Expressions become numbers with up to nine decimals; frames (TRANS, ROT) and all else stay as they are. At most 5 million
/// blocks and 20 million steps are run.
///
/// ```
/// use kinetostat_formats::{SourceFile, expand_siemens};
///
/// let main = "G0 X0 Y0 Z10\nF100\nMCALL CYCLE81(10,0,2,-5)\nX20\nMCALL\nPART(3)\nM30\n";
/// let part = "PROC PART(REAL DEPTH)\nG1 Z=-DEPTH\nG0 Z10\nRET\n";
/// let files = [SourceFile::new("MAIN.MPF", main), SourceFile::new("PART.SPF", part)];
/// let flat = expand_siemens(&files).unwrap();
/// let text = String::from_utf8(flat.file.bytes().to_vec()).unwrap();
/// assert_eq!(text, "G0 X0 Y0 Z10\nF100\nX20\nG0 Z=AC(2)\nG1 G9 Z=AC(-5)\nG0 Z=AC(10)\nG1 Z=-3\nG0 Z10\nM30\n");
/// assert_eq!(flat.origins[6], (1, 2));
/// ```
///
/// # Errors
/// What cannot be run, in the order of files and lines. Behind a line that is refused the run goes on, unless what runs, or a value,
/// depends on it.
pub fn expand_siemens(files: &[SourceFile]) -> Result<FlatText, Vec<ProgramError>> {
    run_within(files, &ReadOptions::default(), MOST_STEPS).map_err(|refused| refused.faults)
}

/// Expands a program with a limit of the executed lines.
pub fn expand_within(files: &[SourceFile], most_steps: u64) -> Result<FlatText, Vec<ProgramError>> {
    run_within(files, &ReadOptions::default(), most_steps).map_err(|refused| refused.faults)
}

/// Expands a program; a refused program is returned with the part that was written.
pub(crate) fn run_or_refused(
    files: &[SourceFile],
    options: &ReadOptions,
) -> Result<FlatText, RefusedRun> {
    run_within(files, options, MOST_STEPS)
}

fn run_within(
    files: &[SourceFile],
    options: &ReadOptions,
    most_steps: u64,
) -> Result<FlatText, RefusedRun> {
    let is_main = |file: &&SourceFile| file.name().to_ascii_lowercase().ends_with(".mpf");
    let main = files.iter().position(|file| is_main(&file)).unwrap_or(0);
    let Some(file) = files.get(main) else {
        return Ok(FlatText::unchanged(&SourceFile::new("", ""), 0));
    };
    let (mut names, mut faults) = (BTreeMap::new(), Vec::new());
    for (index, other) in files.iter().enumerate().filter(|(index, _)| *index != main) {
        match names.entry(program_name(other.name())) {
            Entry::Vacant(free) => {
                free.insert(index);
            }
            Entry::Occupied(held) => faults.push(ProgramError::named_alike(
                other,
                begin_of(other),
                &files[*held.get()],
                begin_of(&files[*held.get()]),
            )),
        }
    }
    if !faults.is_empty() {
        return Err(faults.into());
    }
    if !files.iter().all(|file| whole_file(file, &mut faults)) {
        return Err(faults.into());
    }
    if !needs(file, &names) {
        let mut flat = FlatText::unchanged(file, main);
        // The text after the last line end is a line, too.
        flat.origins = (1..=file.line_count()).map(|line| (main, line)).collect();
        return with_corners(flat, faults, |flat| written_out(flat, files));
    }
    let units = files.iter();
    let units: Vec<Unit> = units.map(|file| Unit::of(file, &mut faults)).collect();
    if !faults.is_empty() && !units.iter().all(|unit| unit.runs) {
        return Err(faults.into());
    }
    let mut runner = Runner::new(files, &units, names, main, options);
    runner.run(most_steps);
    let mut findings = runner.doubts.into_findings();
    findings.extend(told_of_values(&options.values, file.bytes()));
    let written = runner.written;
    written.into_flat(file, faults, findings, |flat| written_out(flat, files))
}

/// The first line of a subprogram that says something: PROC, as a rule.
fn begin_of(file: &SourceFile) -> Range<usize> {
    let mut lines = (1..=file.line_count()).map(|line| file.range_of(line));
    let says = |line: &Range<usize>| {
        let text = file.part(line).trim_ascii_start();
        !matches!(text.first(), None | Some(b';' | b'%'))
    };
    lines.find(says).unwrap_or(0..0)
}

/// True if the control flow of a program is not linear.
fn needs(file: &SourceFile, names: &BTreeMap<Vec<u8>, usize>) -> bool {
    (1..=file.line_count()).any(|line| {
        let Ok((block, _)) = Block::of(file.bytes(), file.range_of(line)) else {
            return false;
        };
        block.items.iter().any(|item| {
            let name = String::from_utf8_lossy(file.part(&item.name)).to_ascii_uppercase();
            let digits = name.strip_prefix('L').unwrap_or("-");
            let numbered = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
            let calls = !matches!(item.what, What::Value { .. })
                && (names.contains_key(name.as_bytes()) || numbered);
            calls || FLOW.contains(&name.as_str())
        })
    })
}
