//! A run of TP programs: their data, the programs that run, the motions so far, and the flat lines that it writes.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::Isometry3;

use crate::error::ProgramError;
use crate::flat_run::Written;
use crate::interpreter::value::{Datum, StatedValues};
use crate::ls::lines::Layout;
use crate::ls::motion::End;
use crate::ls::positions::{Held, Positions};
use crate::ls::program::Program;
use crate::ls::step::Step;
use crate::model::motion::{Motion, Runs, mark_repeated};
use crate::model::parsed::unreached_motions;
use crate::model::program::{ENDLESS, OutsideCall, RanStatement};
use crate::model::site::{Declaration, OffsetAxes};
use crate::options::ReadOptions;
use crate::text::Name;
use crate::text::source::{Finding, SourceFile};

/// The programs of the files.
pub(super) struct Files<'p> {
    pub files: &'p [SourceFile],
    pub layouts: &'p [Layout],
    pub programs: &'p [Program],
    pub positions: &'p [Positions],
    /// Programs by their names in capitals.
    pub names: BTreeMap<Vec<u8>, usize>,
}

/// The number of a frame or tool in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum InForce {
    /// No statement sets the number.
    Unset,
    Known(u32),
    /// Only the controller knows it.
    Computed,
}

impl InForce {
    pub(super) fn known(self) -> Option<u32> {
        match self {
            Self::Known(number) => Some(number),
            _ => None,
        }
    }
}

/// Modal state: the frame, the tool, and the registers by which motions are offset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Modal {
    pub frame: InForce,
    pub tool: InForce,
    /// Offset registers in axes of the work object, and of the tool.
    pub conditions: [Option<u32>; 2],
}

impl Modal {
    pub(super) const UNSET: Self = Self {
        frame: InForce::Unset,
        tool: InForce::Unset,
        conditions: [None, None],
    };
}

/// The index of an offset's axes among the conditions.
pub(super) fn index_of_axes(axes: OffsetAxes) -> usize {
    match axes {
        OffsetAxes::WorkObject => 0,
        OffsetAxes::Tool => 1,
    }
}

/// Continuation of a run after a step.
pub(super) enum Flow {
    Next,
    To(usize),
    /// Returns to the line after the call.
    Returns,
    /// End of all programs.
    Ends,
}

/// State of a run as it jumped back.
pub(super) struct Pass {
    pub decided: usize,
    pub values: BTreeMap<Name, Datum>,
    pub modal: Modal,
    pub motions: usize,
    pub beside: usize,
    /// Bytes and lines of the flat program.
    pub flat: [usize; 2],
}

/// A call that runs.
pub(super) struct RunningCall {
    pub program: usize,
    pub arguments: Vec<Datum>,
    /// Loops that run, by FOR: the counter and the last value.
    pub counters: BTreeMap<usize, (Name, f64)>,
    /// State at each backward jump, by its step.
    pub passes: BTreeMap<usize, Pass>,
}

impl RunningCall {
    pub(super) fn of(program: usize, arguments: Vec<Datum>) -> Self {
        Self {
            program,
            arguments,
            counters: BTreeMap::new(),
            passes: BTreeMap::new(),
        }
    }
}

/// A run of programs.
pub(super) struct Run<'o, 'p> {
    pub reader: Reader<'o>,
    pub all: &'p Files<'p>,
    pub stated: StatedValues<'o>,
    /// Frames that the caller states, by names in capitals (`UF:2`).
    pub frames: BTreeMap<String, Isometry3<f64>>,
    /// Frames and tools to which the programs give values.
    pub given: BTreeSet<Name>,
    /// Motions, by program and step, where a frame or tool is not known.
    pub unknown: BTreeMap<Name, Vec<(usize, usize)>>,
    /// Registers, outputs, frames: what is not here is not known.
    pub values: BTreeMap<Name, Datum>,
    pub calls: Vec<RunningCall>,
    pub modal: Modal,
    pub runs: Runs,
    /// The motion at whose end the tool is.
    pub here: Option<usize>,
    pub motions: Vec<Motion>,
    pub outside_calls: Vec<OutsideCall>,
    /// Registers of which is said that they are taken to hold X, Y, Z, W, P, R.
    pub taken: BTreeSet<u32>,
    /// Declarations of the files; those behind them are of position registers.
    pub taught: usize,
    /// Motions that ran, by program and step.
    pub ran: Vec<Vec<bool>>,
    pub repeated_motions: usize,
    /// Statements beside the motions that ran.
    pub ran_beside: Vec<RanStatement>,
    /// Lines that ran, where the program is to be written flat.
    pub flat: Option<FlatLines>,
    pub statements: usize,
    /// Conditions whose values are known, so far.
    pub decided: usize,
    /// Places of faults and findings that were noted: a statement in a loop has one.
    pub noted: BTreeSet<(usize, usize, &'static str)>,
}

impl<'o, 'p> Run<'o, 'p> {
    pub(super) fn new(
        reader: Reader<'o>,
        all: &'p Files<'p>,
        outside_calls: Vec<OutsideCall>,
    ) -> Self {
        let frames = reader.options.frames.iter();
        Self {
            stated: StatedValues::of(reader.options),
            frames: frames
                .map(|(name, frame)| (name.to_ascii_uppercase(), *frame))
                .collect(),
            given: BTreeSet::new(),
            unknown: BTreeMap::new(),
            values: BTreeMap::new(),
            calls: Vec::new(),
            modal: Modal::UNSET,
            runs: Runs::Once,
            here: None,
            motions: Vec::new(),
            outside_calls,
            ran: (all.programs.iter())
                .map(|program| vec![false; program.steps.len()])
                .collect(),
            taken: BTreeSet::new(),
            taught: reader.declarations.len(),
            repeated_motions: 0,
            ran_beside: Vec::new(),
            flat: None,
            statements: 0,
            decided: 0,
            noted: BTreeSet::new(),
            reader,
            all,
        }
    }

    /// Runs the first program, then each that nothing calls as one of its own.
    pub(super) fn whole(mut self) -> Self {
        let called = self.called_by_name();
        for program in 0..self.all.programs.len() {
            if program > 0 && called.contains(&program) {
                continue;
            }
            self.here = None;
            self.modal = Modal::UNSET;
            self.values.clear();
            if program > 0 {
                self.runs = Runs::Elsewhere;
            }
            self.call(program, Vec::new());
        }
        self.reader.findings.extend(self.stated.findings());
        self.refuse_open_frames();
        self.say_of_unreached();
        if self.repeated_motions > 0 {
            mark_repeated(&mut self.motions);
        }
        self
    }

    /// A frame or tool to which the programs give a value, and not on all ways to a motion that uses it.
    fn refuse_open_frames(&mut self) {
        for (name, motions) in std::mem::take(&mut self.unknown) {
            for (program, at) in motions.into_iter().filter(|_| self.given.contains(&name)) {
                if self.noted.insert((program, at, "frame")) {
                    let name = String::from_utf8_lossy(name.letters());
                    let reason = format!("which value {name} has here, the run decides");
                    let remedy = "give it its value before, or state it under [robot.frames]";
                    let span = self.all.layouts[program].lines[at].whole.clone();
                    (self.reader).fault(&self.all.files[program], span, reason, remedy);
                }
            }
        }
    }

    /// Programs that another one calls.
    pub(super) fn called_by_name(&self) -> BTreeSet<usize> {
        let all = self.all.programs.iter().zip(self.all.files);
        all.flat_map(|(program, file)| {
            program.steps.iter().filter_map(|step| match step.action() {
                Step::Call(call) => self.all.named(file.part(call.name.as_ref()?)),
                _ => None,
            })
        })
        .collect()
    }

    /// Motions that the run does not come to stay, and so do their positions.
    fn say_of_unreached(&mut self) {
        for (index, program) in self.all.programs.iter().enumerate() {
            let file = &self.all.files[index];
            let mut lines = Vec::new();
            for (at, step) in program.steps.iter().enumerate() {
                let Step::Motion(text) = step else { continue };
                if self.ran[index][at] {
                    continue;
                }
                let start = self.all.layouts[index].lines[at].whole.start;
                lines.push(file.line_of(start));
                let via = text.via.iter().map(|(_, via)| via);
                for end in via.chain([&text.target]) {
                    if let End::Position(number, _) = end
                        && let Some(position) = self.all.positions[index].all.get(number)
                        && let Held::Pose(declaration) = position.held
                    {
                        self.reader.declarations[declaration].keeps_value = true;
                    }
                }
            }
            (self.reader.findings).extend(unreached_motions(index, lines));
        }
    }

    /// The program that runs.
    pub(super) fn program(&self) -> usize {
        self.calls.last().map_or(0, |called| called.program)
    }

    /// The file of the program that runs.
    pub(super) fn file(&self) -> &'p SourceFile {
        &self.all.files[self.program()]
    }

    /// The line of a step of the program that runs, from 1.
    pub(super) fn line(&self, at: usize) -> usize {
        let start = self.all.layouts[self.program()].lines[at].whole.start;
        self.file().line_of(start)
    }

    /// Notes that a statement beside the motions ran, by its step.
    pub(super) fn log(&mut self, at: usize) {
        let program = self.program();
        self.ran_beside.push(RanStatement {
            file: program,
            span: self.all.layouts[program].lines[at].text.clone(),
            motions: self.motions.len(),
            text: None,
        });
    }

    /// Notes a loop without an end, behind so many motions and statements.
    pub(super) fn log_endless(&mut self, at: usize, motions: usize, beside: usize) {
        self.ran_beside.truncate(beside);
        self.log(at);
        if let Some(last) = self.ran_beside.last_mut() {
            (last.motions, last.text) = (motions, Some(ENDLESS.into()));
        }
    }

    /// Notes a fault of a step once.
    pub(super) fn fault(&mut self, at: usize, reason: impl Into<String>, remedy: &str) {
        let program = self.program();
        if self.noted.insert((program, at, "fault")) {
            let span = self.all.layouts[program].lines[at].whole.clone();
            self.reader.fault(self.file(), span, reason, remedy);
        }
    }

    /// Notes a finding of a step once.
    pub(super) fn find(&mut self, at: usize, message: impl Into<String>) {
        let program = self.program();
        if self.noted.insert((program, at, "finding")) {
            let line = self.line(at);
            self.reader.finding(program, line, message);
        }
    }
}

/// Lines of a flat program, as they are written.
#[derive(Default)]
pub(super) struct FlatLines {
    pub written: Written,
    /// Lines of programs that are written.
    pub count: usize,
    /// They are not those of the first program in its order.
    pub is_changed: bool,
    /// New numbers of positions of called programs, by program and own number.
    pub positions: BTreeMap<(usize, u32), u32>,
}

impl FlatLines {
    pub(super) fn is_full(&self) -> bool {
        self.written.is_full()
    }

    /// Bytes and lines so far.
    pub(super) fn extent(&self) -> [usize; 2] {
        [self.written.bytes.len(), self.written.origins.len()]
    }

    /// Takes back what was written behind an extent.
    pub(super) fn cut(&mut self, [bytes, lines]: [usize; 2]) {
        self.written.bytes.truncate(bytes);
        self.written.origins.truncate(lines);
    }

    pub(super) fn line(&mut self, text: &[u8], file: usize, line: usize) {
        // The writer numbers the lines.
        self.written
            .line(&[b"   1:", text, b";"].concat(), file, line);
    }
}

/// Results of the programs so far.
pub(super) struct Reader<'o> {
    pub options: &'o ReadOptions,
    pub faults: Vec<ProgramError>,
    pub findings: Vec<Finding>,
    pub declarations: Vec<Declaration>,
}

impl Reader<'_> {
    pub(super) fn fault(
        &mut self,
        file: &SourceFile,
        span: std::ops::Range<usize>,
        reason: impl Into<String>,
        remedy: impl Into<String>,
    ) {
        self.faults
            .push(ProgramError::at(file, span, reason, remedy));
    }

    pub(super) fn finding(&mut self, file: usize, line: usize, message: impl Into<String>) {
        self.findings.push(Finding {
            file,
            line,
            message: message.into(),
        });
    }
}
