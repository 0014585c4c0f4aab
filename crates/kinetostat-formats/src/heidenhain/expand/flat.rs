//! A program run once and written flat.

use crate::error::ProgramError;
use crate::flat_run::{BlockId, MOST_STEPS, RefusedRun, Runs, Written, with_corners};
use crate::heidenhain::blocks::is_numbered;
use crate::heidenhain::expand::aside::led_aside;
use crate::heidenhain::expand::corners::written_out;
use crate::heidenhain::expand::run::{Program, Run};
use crate::heidenhain::expand::values::Values;
use crate::model::stated_value::told_of_values;
use crate::options::ReadOptions;
use crate::text::source::{FlatText, SourceFile};

/// Runs a Heidenhain program once and writes it flat: labels that are called and repeated, other programs (given behind the first
/// one), jumps and Q parameters, drilling by cycles 200, 201, 203 and 1, corners that are rounded (RND, between two lines or a line and an
/// arc about a pole) or broken (CHF, between two lines, whose number is how much it takes of each), contours with RL or RR whose tool has its radius in `TOOL DEF` (outside
/// corners become arcs, inside corners end where the tool touches both sides). Each line says where it is from. A program
/// without anything of that comes back byte for byte.
///
/// Coordinates that parameters say are written with 4 decimals in mm (5 in inches), as the control resolves them. Holes become
/// `L` blocks along the tool's axis, their dwell cycle 9; the feed of before is stated again behind them. Other cycles that are
/// called are refused, or stay as written with [`crate::UnknownTargets::LeftAsWritten`]. Parameters that the machine alone knows (`FN 18`)
/// have the values of [`ReadOptions::values`].
///
/// ```
/// use kinetostat_formats::{ReadOptions, SourceFile, expand_heidenhain};
///
/// let text = "0 BEGIN PGM A MM\n1 LBL 1\n2 L IX+10 F300\n3 CALL LBL 1 REP 2/2\n4 END PGM A MM\n";
/// let flat = expand_heidenhain(vec![SourceFile::new("a.h", text)], &ReadOptions::default()).unwrap();
/// let expected = "0 BEGIN PGM A MM\n1 L IX+10 F300\n2 L IX+10 F300\n3 L IX+10 F300\n4 END PGM A MM\n";
/// assert_eq!(String::from_utf8_lossy(flat.file.bytes()), expected);
/// assert_eq!(flat.origins[3], (0, 3));
/// ```
///
/// # Errors
/// What cannot be followed, by file and line. Behind a line that is refused the run goes on, unless what runs, or a value, depends on it.
pub fn expand_heidenhain(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<FlatText, Vec<ProgramError>> {
    expand_within(files, options, MOST_STEPS)
}

/// Expands a program with a limit of the executed blocks.
///
/// # Errors
/// The same errors as without the limit.
pub fn expand_within(
    files: Vec<SourceFile>,
    options: &ReadOptions,
    most_steps: u64,
) -> Result<FlatText, Vec<ProgramError>> {
    run_within(&files, options, most_steps).map_err(|refused| refused.faults)
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
    let out = |flat| {
        let flat = written_out(flat, files, options)?;
        led_aside(flat, files, options)
    };
    let programs: Vec<Program<'_>> = files.iter().map(Program::of).collect();
    let Some(main) = programs.first() else {
        let none = SourceFile::new("", "");
        let fault = ProgramError::at(&none, 0..0, "no file is given", "give a program");
        return Err(vec![fault].into());
    };
    let equal: Vec<ProgramError> = main.equal_labels().collect();
    if !equal.is_empty() {
        return Err(equal.into());
    }
    if !main.needs(options.slash_blocks) {
        return with_corners(FlatText::unchanged(main.file, 0), Vec::new(), out);
    }
    let parameters = Values::of(options)
        .map_err(|(reason, remedy)| vec![ProgramError::at(main.file, 0..0, reason, remedy)])?;
    let findings = told_of_values(&options.values, main.file.bytes());
    let mut run = Run {
        options,
        files,
        programs: &programs,
        unit_mm: main.unit_mm(),
        number: is_numbered(main.file.bytes()).then_some(0),
        parameters,
        frames: Vec::new(),
        written: Written::new(main.file),
        at: Some(BlockId { file: 0, block: 0 }),
        cycle: None,
        pecking: [None; 6],
        axis: "Z",
        rapid_out: false,
        modal: false,
        feed: None,
        feed_lost: false,
        cycle_refused: false,
    };
    run.begin();
    run.run(most_steps);
    run.written.into_flat(main.file, Vec::new(), findings, out)
}
