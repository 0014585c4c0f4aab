//! A file whose holes are written out.

use std::ops::Range;

use kinetostat_program::Spindle;
use nalgebra::Vector3;

use crate::apt::flat::cycle::{Cycle, Hole, Part, Said, Wrong, said};
use crate::apt::lines::{Statement, all_numbers, arguments_of, statements_of};
use crate::apt::state::{spindle_of, unit_of};
use crate::apt::table::Dialect;
use crate::error::ProgramError;
use crate::flat_run::Written;
use crate::text::number::short;
use crate::text::source::{FlatText, SourceFile};

/// Writes the holes of an APT file (`CYCLE` and the GOTO behind it) as plain motions: by rapid over the hole and down to `RAPTO` or `CLEAR`,
/// at the cycle's feed to its depth along the tool's axis, and out again; between holes at `CLEAR`, `RTRCTO` or higher. DRILL, FACE and
/// CSINK come out by rapid, DEEP behind each `STEP` (DEEP2 behind `1STPECK` and each `SUBPECK`), BRKCHP draws back 1 mm (half a step at most), BORE and REAM come out at feed, TAP with
/// the spindle turned back: it must float in its holder. A file without holes comes back byte for byte.
///
/// ```
/// use kinetostat_formats::{SourceFile, expand_apt};
///
/// let text = "UNITS/MM\nFEDRAT/900,MMPM\nGOTO/0,0,20\nCYCLE/DRILL,DEPTH,10,MMPM,150,CLEAR,3\nGOTO/5,0,0\nCYCLE/OFF\nGOTO/9,0,0\n";
/// let flat = expand_apt(&[SourceFile::new("a.apt", text)]).unwrap();
/// let text = String::from_utf8(flat.file.bytes().to_vec()).unwrap();
/// assert_eq!(
///     text,
///     "UNITS/MM\nFEDRAT/900,MMPM\nGOTO/0,0,20\n\
///      RAPID\nGOTO/5.0,0.0,20.0\nRAPID\nGOTO/5.0,0.0,3.0\nFEDRAT/150,MMPM\nGOTO/5.0,0.0,-10.0\nRAPID\nGOTO/5.0,0.0,3.0\n\
///      FEDRAT/900,MMPM\nGOTO/9,0,0\n"
/// );
/// assert_eq!(flat.origins[3], (0, 5));
/// ```
///
/// # Errors
/// Cycles that are not followed, by line.
pub fn expand_apt(files: &[SourceFile]) -> Result<FlatText, Vec<ProgramError>> {
    let Some(file) = files.first() else {
        return Ok(FlatText::unchanged(&SourceFile::new("", ""), 0));
    };
    if let Some(other) = files.get(1) {
        let reason = "holes are written out in one file, and here is another one";
        let fault = ProgramError::at(other, 0..0, reason, "give the files one by one");
        return Err(vec![fault]);
    }
    let statements = statements_of(file.bytes());
    let mut run = Run {
        file,
        dialect: Dialect::of(file, &statements),
        unit_mm: unit_of(file, &statements).0.unwrap_or(1.0),
        written: Written::new(file),
        faults: Vec::new(),
        has_holes: false,
        rapid_waits: false,
        cycle: None,
        place: None,
        began: None,
        axis: Vector3::z(),
        states_axis: false,
        spindle: Spindle::default(),
        feed: None,
        feed_in_force: None,
    };
    let mut from = 0;
    for statement in &statements {
        run.copy(from..statement.lines.start);
        from = statement.lines.end;
        run.statement(statement);
        if run.written.is_full() {
            run.fault(
                statement,
                "the flat program is larger than 5 million lines, or 256 MiB",
                "divide it",
            );
            break;
        }
    }
    run.copy(from..file.bytes().len());
    if !run.faults.is_empty() {
        return Err(run.faults);
    }
    if !run.has_holes {
        return Ok(FlatText::unchanged(file, 0));
    }
    Ok(FlatText {
        file: SourceFile::new(file.name(), run.written.bytes),
        origins: run.written.origins,
        changed: true,
        findings: Vec::new(),
    })
}

struct Run<'f> {
    file: &'f SourceFile,
    dialect: Dialect,
    unit_mm: f64,
    written: Written,
    faults: Vec<ProgramError>,
    has_holes: bool,
    /// A RAPID in a cycle waits for the GOTO behind it.
    rapid_waits: bool,
    /// Active cycle; `Some(None)` if it is faulty, which was reported.
    cycle: Option<Option<Cycle>>,
    /// Tool position, in units of the file; `None` if unknown.
    place: Option<Vector3<f64>>,
    /// Tool position before the cycle.
    began: Option<Vector3<f64>>,
    axis: Vector3<f64>,
    /// The last GOTO stated it.
    states_axis: bool,
    spindle: Spindle,
    /// FEDRAT as the file states it, and as it is in force in what is written.
    feed: Option<String>,
    feed_in_force: Option<String>,
}

impl Run<'_> {
    fn fault(&mut self, statement: &Statement, reason: impl Into<String>, remedy: &str) {
        let span = statement.span.clone();
        let fault = ProgramError::at(self.file, span, reason.into(), remedy);
        self.faults.push(fault);
    }

    fn copy(&mut self, part: Range<usize>) {
        self.written.copy(self.file, 0, &part);
    }

    fn line(&mut self, text: &str, from: &Statement) {
        // The last line of a file may have no end.
        if self.written.bytes.last().is_some_and(|byte| *byte != b'\n') {
            self.written
                .bytes
                .extend_from_slice(self.file.line_ending());
        }
        let line = self.file.line_of(from.span.start);
        self.written.line(text.as_bytes(), 0, line);
    }

    fn take_feed(&mut self, feed: Option<String>, from: &Statement) {
        if let Some(feed) = feed.filter(|feed| Some(feed) != self.feed_in_force.as_ref()) {
            self.line(&feed, from);
            self.feed_in_force = Some(feed);
        }
    }

    fn statement(&mut self, statement: &Statement) {
        let word = self.file.part(&statement.word).to_ascii_uppercase();
        let in_cycle = self.cycle.is_some();
        match word.as_slice() {
            _ if statement.assigns => {}
            b"CYCLE" => return self.cycle(statement),
            b"FEDRAT" => {
                let text = self.file.part(&statement.span);
                let feed = String::from_utf8_lossy(text).into_owned();
                self.feed = Some(feed.clone());
                self.feed_in_force = Some(feed);
            }
            b"SPINDL" => self.spindle = spindle_of(self.file, statement, self.spindle),
            b"RAPID" if in_cycle => {
                self.rapid_waits = true;
                return;
            }
            b"GOTO" | b"FROM" => {
                let place = self.goto(statement);
                if in_cycle && word == b"GOTO" {
                    return self.hole(statement, place);
                }
                self.place = place;
            }
            b"GODLTA" | b"GOHOME" if in_cycle => self.fault(
                statement,
                "it moves the tool while a cycle is in force",
                "write CYCLE/OFF before it",
            ),
            b"TLAXIS" => {
                let numbers = self.numbers(statement);
                if let Some([x, y, z]) = numbers.as_deref() {
                    self.turn(Vector3::new(*x, *y, *z));
                }
            }
            b"GODLTA" | b"GOHOME" | b"TLON" | b"MSYS" | b"LOAD" | b"LOADTL" | b"TOOLNO"
            | b"TOOL PATH" => {
                self.place = None;
            }
            _ => {}
        }
        self.copy(statement.lines.clone());
    }

    fn numbers(&self, statement: &Statement) -> Option<Vec<f64>> {
        let numbers = all_numbers(&arguments_of(self.file.bytes(), &statement.arguments))?;
        Some(numbers.iter().map(|number| number.value).collect())
    }

    fn turn(&mut self, axis: Vector3<f64>) {
        if let Some(axis) = axis.try_normalize(1e-6) {
            self.axis = axis;
        }
    }

    /// The place of a GOTO; none where its numbers are not those of one.
    fn goto(&mut self, statement: &Statement) -> Option<Vector3<f64>> {
        let numbers = self.numbers(statement)?;
        self.states_axis = numbers.len() == 6;
        match numbers.as_slice() {
            [x, y, z] => Some(Vector3::new(*x, *y, *z)),
            [x, y, z, i, j, k] => {
                self.turn(Vector3::new(*i, *j, *k));
                Some(Vector3::new(*x, *y, *z))
            }
            _ => None,
        }
    }

    fn cycle(&mut self, statement: &Statement) {
        match said(self.file, statement, self.dialect) {
            Said::Off => {
                if self.cycle.take().is_none() {
                    // No cycle was active.
                    self.copy(statement.lines.clone());
                }
                self.take_feed(self.feed.clone(), statement);
                if std::mem::take(&mut self.rapid_waits) {
                    self.line("RAPID", statement);
                }
            }
            Said::On(cycle) => {
                if self.cycle.is_none() {
                    self.began = self.place;
                }
                let cycle = cycle.map_err(|(reason, remedy)| self.fault(statement, reason, remedy));
                self.cycle = Some(cycle.ok());
            }
        }
    }

    fn hole(&mut self, statement: &Statement, place: Option<Vector3<f64>>) {
        self.has_holes = true;
        self.rapid_waits = false;
        let Some(Some(cycle)) = self.cycle.clone() else {
            return;
        };
        let done = self.written(statement, place, &cycle);
        if let Err((reason, remedy)) = done {
            self.fault(statement, reason, remedy);
            self.place = None;
        }
    }

    fn written(
        &mut self,
        statement: &Statement,
        place: Option<Vector3<f64>>,
        cycle: &Cycle,
    ) -> Result<(), Wrong> {
        let at = place.ok_or((
            "the place of the hole is not three or six numbers".to_owned(),
            "let the CAM system write points: GOTO/x,y,z or GOTO/x,y,z,i,j,k",
        ))?;
        let hole = Hole {
            at,
            axis: self.axis,
            unit_mm: self.unit_mm,
        };
        for part in hole.parts(cycle, self.place, self.began, &self.spindle)? {
            match part {
                Part::Text(text) => self.line(&text, statement),
                Part::Rapid(to) if self.place.is_some_and(|from| (to - from).amax() < SAME) => {}
                Part::Rapid(to) => {
                    self.line("RAPID", statement);
                    self.go(to, statement);
                }
                Part::Feed(to) => {
                    let feed = cycle.feed.clone().or_else(|| self.feed.clone());
                    self.take_feed(feed, statement);
                    self.go(to, statement);
                }
            }
        }
        Ok(())
    }

    fn go(&mut self, to: Vector3<f64>, from: &Statement) {
        let mut text = format!("GOTO/{},{},{}", number(to.x), number(to.y), number(to.z));
        if self.states_axis {
            let [i, j, k] = [self.axis.x, self.axis.y, self.axis.z].map(number);
            text += &format!(",{i},{j},{k}");
        }
        self.line(&text, from);
        self.place = Some(to);
    }
}

/// Places nearer than this are one, in units of the file.
const SAME: f64 = 1e-9;

/// A number with a point, and up to seven decimals.
fn number(value: f64) -> String {
    let text = short(value, 7);
    match text.contains('.') {
        true => text,
        false => format!("{text}.0"),
    }
}
