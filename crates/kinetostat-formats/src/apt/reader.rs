//! The reader of APT and CLDATA, with the effect of each statement.

use crate::apt::file_reader::{Found, POINTS, Reader};
use crate::apt::lines::{Argument, Statement, arguments_of, statements_of};
use crate::apt::state::{State, feed_of, spindle_of, system_of, unit_of};
use crate::apt::table::{Dialect, row};
use crate::error::ProgramError;
use crate::model::Language;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::options::{CutterCompensation, ReadOptions};
use crate::table::Treatment;
use crate::text::source::SourceFile;

const MOST_BYTES: usize = 1 << 28;

/// Reads APT and CLDATA (`.apt`, `.cls`, `.aptsource`), each file for itself, as SOLIDWORKS CAM, Siemens NX, CATIA and others
/// write them.
///
/// Places are those of `GOTO`, in mm; the tool's axis is the last one that was stated, and the turn about it is free: the
/// orientation turns Z into the axis by the shortest way. Arcs are [`MotionKind::Arc`](crate::MotionKind::Arc). The work object is `MSYS` in the
/// part's axes; where the part is, the options say (`PART`), and where the tool is (`TOOL:5`). Holes of cycles, ends that
/// only geometry states and helices of several turns are refused, or stay as written with
/// [`crate::UnknownTargets::LeftAsWritten`].
///
/// ```
/// use kinetostat_formats::{MotionKind, ReadOptions, SourceFile, read_apt};
///
/// let text = "PARTNO/1\nUNIT/MM\nTRNTYP/WORLD,0,0,0\nRAPID/\nGOTO/10.,0,25.\nFEDRAT/600.,MMPM\nGOTO/10.,0,-2.5\n\
///     CIRCLE/0,0,-2.5,0,0,1.\nGOTO/0,10.,-2.5\n";
/// let program = read_apt(vec![SourceFile::new("part.apt", text)], &ReadOptions::default()).unwrap();
/// assert_eq!(program.motions[1].speed.mm_per_s, Some(10.0));
/// let MotionKind::Arc { angle_rad, .. } = program.motions[2].kind else { panic!() };
/// assert!((angle_rad.to_degrees() - 90.0).abs() < 1e-9);
/// ```
///
/// # Errors
/// All that is refused, in the order of files and lines.
pub fn read_apt(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    parse_apt(files, options).without_faults()
}

/// Reads APT files; the motions that could be read are returned beside the errors.
pub(crate) fn parse_apt(files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
    let frames = options.frames.iter();
    let mut program = Found {
        options,
        frames: frames
            .map(|(name, frame)| (name.to_ascii_uppercase(), *frame))
            .collect(),
        faults: Vec::new(),
        findings: Vec::new(),
        motions: Vec::new(),
    };
    for (index, file) in files.iter().enumerate() {
        if let Some(fault) = ProgramError::too_large(file, MOST_BYTES) {
            program.faults.push(fault);
            continue;
        }
        let statements = statements_of(file.bytes());
        let dialect = Dialect::of(file, &statements);
        let (unit, others) = unit_of(file, &statements);
        let mut reader = Reader {
            program: &mut program,
            file,
            index,
            dialect,
            unit_mm: unit.unwrap_or(1.0),
            state: State::new(),
        };
        let written_by = match unit {
            Some(_) => format!("written by {}", dialect.name()),
            None => format!(
                "written by {}; no unit is stated: taken as mm",
                dialect.name()
            ),
        };
        reader.finding(&(0..0), written_by);
        for span in others {
            reader.fault(
                &span,
                "the unit is not known, or another one than before",
                "state MM or INCH once",
            );
        }
        for statement in &statements {
            reader.statement(statement);
        }
        reader.end_circle();
        reader.raw_text(&statements);
    }
    let Found {
        motions,
        findings,
        faults,
        ..
    } = program;
    Parsed::of(Language::Apt, files, motions, findings, faults)
}

impl Reader<'_, '_> {
    pub fn statement(&mut self, statement: &Statement) {
        let span = &statement.span;
        let word = self.file.part(&statement.word).to_ascii_uppercase();
        if statement.assigns {
            // Geometry and numbers move nothing; what drives along them is refused.
            return;
        }
        let is_motion = matches!(
            &word[..],
            b"GOTO" | b"PAINT" | b"FEDRAT" | b"SPINDL" | b"COOLNT" | b"PPRINT"
        );
        if !is_motion {
            self.end_circle();
        }
        let understood = word == b"CYCLE"
            || row(&word).is_some_and(|row| row.treatment == Treatment::Understood);
        if understood
            && !statement.slash
            && !statement.arguments.is_empty()
            && !matches!(&word[..], b"TLON" | b"SPINDL")
        {
            let remedy = "write it as WORD/arguments";
            self.state.place = None;
            return self.fault(span, "no slash stands behind the word", remedy);
        }
        match &word[..] {
            b"GOTO" => self.goto(statement),
            b"GODLTA" => self.step(statement),
            b"GOHOME" => self.home(statement),
            b"FROM" => self.from(statement),
            b"RAPID" => self.state.rapid = Some(span.clone()),
            b"FEDRAT" => match feed_of(self.file, statement, self.unit_mm) {
                Some(feed) => (self.state.feed, self.state.mm_per_turn) = feed,
                None => self.fault(span, "the feed has no number", "state it: FEDRAT/600,MMPM"),
            },
            b"SPINDL" => self.state.spindle = spindle_of(self.file, statement, self.state.spindle),
            b"CIRCLE" => self.circle(statement),
            b"FINI" | b"END" if statement.arguments.is_empty() => self.state.has_ended = true,
            b"TLON" => {
                let reason = "the end of the arc is where it meets a line, which is not computed";
                self.unknown(statement, reason);
            }
            b"CYCLE" => {
                let first = self.first_word(statement);
                self.state.in_cycle = !matches!(&first[..], b"OFF" | b"INIT");
            }
            b"CUTCOM" | b"TLCOMP" => self.compensation(statement),
            b"TLAXIS" => match self.numbers(statement) {
                Some(numbers) => self.axis(span, &numbers),
                None => self.fault(span, "the axis is not three numbers", POINTS),
            },
            b"MSYS" => {
                let numbers = self.numbers(statement).unwrap_or_default();
                let values: Vec<f64> = numbers.iter().map(|number| number.value).collect();
                match system_of(&values, self.unit_mm) {
                    Some(system) => {
                        self.state.system = Some(system);
                        // The following positions are in other axes.
                        self.state.place = None;
                    }
                    None => self.fault(
                        span,
                        "MSYS is not an origin and two axes at right angles",
                        "state nine numbers",
                    ),
                }
            }
            b"TRNTYP" if self.first_word(statement) != b"WORLD" => self.fault(
                span,
                "the places that follow are in other axes than the part's",
                "let the CAM system write them in the part's axes (TRNTYP/WORLD)",
            ),
            b"LOAD" | b"LOADTL" | b"TOOLNO" | b"TOOL PATH" => self.tool(statement, &word),
            // To zero, where all other turns are refused, it turns nothing.
            b"ROTABL" if self.is_at_zero(statement) => {}
            b"UNIT" | b"UNITS"
                if (self.program.motions.last()).is_some_and(|last| last.file == self.index) =>
            {
                self.fault(
                    span,
                    "the unit is stated behind a motion",
                    "state it before",
                );
            }
            _ => match row(&word).map(|row| row.treatment) {
                Some(Treatment::Refused { reason, remedy }) => self.fault(span, reason, remedy),
                Some(_) => {}
                None if word.starts_with(b"CSI_") => {}
                None => self.fault(
                    span,
                    "the word is not known, and may move the tool",
                    "take the statement out, or make it a comment ($$)",
                ),
            },
        }
    }

    /// Whether all numbers of a statement are zero, and there are some.
    fn is_at_zero(&self, statement: &Statement) -> bool {
        let arguments = arguments_of(self.file.bytes(), &statement.arguments);
        let mut numbers = arguments.iter().filter_map(Argument::number).peekable();
        numbers.peek().is_some() && numbers.all(|number| number.value == 0.0)
    }

    fn compensation(&mut self, statement: &Statement) {
        let on = self.first_word(statement) != b"OFF";
        if on && self.program.options.cutter_compensation == CutterCompensation::Refused {
            self.fault(
                &statement.span,
                "the controller moves the path aside by the tool's radius",
                "if the places are those of the tool's centre, say so (cutter_compensation = \"centre_path\" under [robot] in a job file)",
            );
        }
    }

    fn tool(&mut self, statement: &Statement, word: &[u8]) {
        let arguments = arguments_of(self.file.bytes(), &statement.arguments);
        let last = arguments.last();
        let number = arguments.iter().find_map(Argument::number);
        let name = match (word, last, number) {
            (b"TOOL PATH", Some(Argument::Word(name)), _) => {
                String::from_utf8_lossy(self.file.part(name)).into_owned()
            }
            (_, _, Some(number)) => format!("{}", number.value),
            _ => return,
        };
        self.state.tool = format!("TOOL:{name}");
    }
}
