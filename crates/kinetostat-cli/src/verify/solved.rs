//! The machine along the program that is verified, and what that has otherwise than its original.

use kinetostat::Directions;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::Template;
use kinetostat_machining::{Assumption, Condition, RunError, Verified, verify_program};

use crate::job::machine::MachineSetup;
use crate::job::program::{ReadProgram, read_program};
use crate::job::reading::work_offset;
use crate::job::setting::Setting;
use crate::program::aim::Aim;
use crate::program::solve::{forces_of, with_task};
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::progress::Progress;
use crate::ui::threads::in_threads;
use crate::verify::answer::source_of;
use crate::verify::compared::{Original, compared};
use crate::verify::ending::{ends_in_cut, is_cut};
use crate::verify::marks::Marks;
use crate::verify::other_language::words_of_cell;
use crate::verify::other_word::OtherWord;

/// The machine along the second program.
pub(crate) struct Solved {
    pub(crate) found: Verified,
    /// Lines of cuts of the original that it leaves out.
    pub(crate) uncut: Vec<usize>,
    pub(crate) other_words: Vec<OtherWord>,
    pub(crate) corrected: Directions,
    /// Rounding of the digits of a program written from the original.
    pub(crate) rounding_mm: f64,
    pub(crate) forces_from_cut: bool,
}

/// Both programs as they were read.
struct Both<'r> {
    original: &'r Setting,
    read: &'r ReadProgram<'r>,
    verified: &'r Setting,
    other: &'r ReadProgram<'r>,
}

/// The machine along the second program, and what it leaves out and has otherwise.
pub(crate) fn solved(
    machine: &MachineSetup,
    original: &Setting,
    verified: &Setting,
    template: Option<&Template>,
    threads: Option<usize>,
) -> Answer<Solved> {
    let read = read_program(original)?;
    let other = read_program(verified)?;
    if !other.path().moves.iter().any(is_cut) {
        return Err(verified.within(ErrorCode::ProgramUnsuited.failure("the program has no move at feed that begins at a place it states, so that there is nothing to verify: name the program that was compensated, and the original as --against",
        )));
    }
    let progress = Progress::new();
    let forces = forces_of(machine, original, read.path(), &progress)?;
    let aim = Aim::Compensate;
    let found = with_task(aim, machine, original, &read, forces.as_ref(), |task| {
        in_threads(threads, || {
            verify_program(task, other.path(), &verified.program, &progress)
        })
    })??;
    progress.finish();
    let both = Both {
        original,
        read: &read,
        verified,
        other: &other,
    };
    let mut found = found.map_err(|error| both.failure(error))?;
    if let Some(assumed) = both.calls() {
        found.run.result.assume(assumed);
    }
    let cuts = read.path().moves.iter().filter(|m| m.is_known_feed());
    let left_out = |line: &usize| {
        let mut all = found.matched.uncut.iter();
        all.any(|uncut| (uncut.lines[0]..=uncut.lines[1]).contains(line))
    };
    let uncut = cuts.map(|m| m.line).filter(left_out).collect();
    let mut other_words = both.other_conditions(&mut found, forces.is_some());
    other_words.extend(match both.in_one_form() {
        true => both.marked(&found.matched.cuts, &|word| both.is_stated(word)),
        false => words_of_cell(machine, verified, read.path(), &other, template)?,
    });
    let shift_mm = found.run.result.summary.max_position_error_before_mm;
    other_words.extend(ends_in_cut(read.path(), other.path(), shift_mm));
    Ok(Solved {
        found,
        uncut,
        other_words,
        corrected: read.corrected(),
        rounding_mm: original.rounding_mm(read.path()),
        forces_from_cut: forces.is_some(),
    })
}

impl Both<'_> {
    /// True if both programs are in G-code, or neither is.
    fn in_one_form(&self) -> bool {
        self.read.gcode().is_some() == self.other.gcode().is_some()
    }

    /// Assumption that calls do not move the tool: of the original, or of the program verified if it makes others.
    fn calls(&self) -> Option<Assumption> {
        let robots = [self.read, self.other].map(ReadProgram::robot);
        let names = robots.map(|robot| {
            let calls = robot.map_or_else(Vec::new, |robot| robot.program.calls_taken_to_stay());
            calls.into_iter().map(|(name, _)| name).collect::<Vec<_>>()
        });
        let is_new = |name: &&str| !names[0].contains(name);
        let makes_others = names[1].iter().any(is_new);
        robots[usize::from(makes_others)]?.assumed_of_calls()
    }

    /// Origin of a line of the original, as text; empty if there is none.
    fn source(&self, line: usize) -> String {
        let flat = self.original.flat.as_ref();
        source_of(flat.filter(|_| self.original.robot.is_none()), line)
    }

    /// True if a frame of G-code has a stated origin.
    fn is_stated(&self, frame: &str) -> bool {
        let offsets = &self.original.reading.work_offsets_mm;
        work_offset(frame).is_some_and(|index| offsets[index].is_some())
    }

    /// Marks that differ; `cuts` are moves that both make, of the program verified and of the original.
    fn marked(&self, cuts: &[[usize; 2]], is_stated: &dyn Fn(&str) -> bool) -> Vec<OtherWord> {
        let both = [self.other, self.read].map(Marks::of);
        let source = &|line| self.source(line);
        compared(&both, cuts, &Original { is_stated, source })
    }

    /// Feeds and spindles that differ along the path.
    fn other_conditions(&self, found: &mut Verified, forces_from_cut: bool) -> Vec<OtherWord> {
        let conditions = &mut found.matched.conditions;
        if self.read.gcode().is_some() && self.other.robot().is_some() {
            // A robot has no words for the spindle of G-code: those of its cell are compared.
            conditions.retain(|other| other.condition == Condition::Feed);
        }
        let source = |line: usize| self.source(line);
        let all = conditions.iter();
        all.map(|other| OtherWord::of_condition(other, forces_from_cut, &source))
            .collect()
    }

    /// A run that ended: a program that goes elsewhere is another one, unless its frames and tools send it there.
    fn failure(&self, error: RunError) -> Failure {
        // This error has a line of the verified program; all others have one of the original.
        let RunError::Elsewhere { .. } = error else {
            return self.original.within(Failure::from(error));
        };
        let words = match self.in_one_form() {
            true => self.marked(&[], &|_| false),
            false => Vec::new(),
        };
        let faults = words.iter().filter_map(OtherWord::fault_text);
        let mut faults: Vec<String> = faults.collect();
        self.verified.within(match faults.is_empty() {
            true => Failure::from(error),
            false => {
                faults.push(error.to_string());
                ErrorCode::ToleranceMissed.failure(faults.join("\n"))
            }
        })
    }
}
