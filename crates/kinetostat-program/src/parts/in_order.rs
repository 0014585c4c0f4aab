//! Parts that are worked on side by side and written one behind the other, and the state of the written program between two.

use std::collections::VecDeque;
use std::io::BufRead;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, OnceLock, PoisonError};

use crate::checking::Verification;
use crate::checking::verify::against_input;
use crate::error::{ProgramError, WriteError};
use crate::field::{CorrectionField, Monitor};
use crate::machine_program::MachineProgram;
use crate::parts::survey::{Lines, PartError, Survey};
use crate::parts::windows::Part;
use crate::path::moves::Path;
use crate::reading::interpreting::Interpreter;
use crate::reading::options::ReadOptions;
use crate::text::first_line;
use crate::text::program::{PartOfText, Program, Reader, ReaderState};
use crate::writing::options::WriteOptions;
use crate::writing::write::Divided;
use crate::writing::written::{Corrected, WriterState};

/// Parts that are worked on side by side and written one behind the other. The text of a part depends slightly on those before it:
/// on the modes in which they leave the controller, the feed rate in force and the last position. A part goes on as soon as the one
/// before it was written once. Should that be written again, with other pieces, the part is to be done anew: its bytes are those of
/// parts that are done one after the other.
///
/// ```
/// use kinetostat_program::*;
/// use nalgebra::Vector3;
/// use std::io::Cursor;
///
/// let text = "G21 G90\nG0 X0 Y0 Z5\nG1 Z0 F300\nX10\nX20\nX30 Y5\nM2\n";
/// let (reading, writing) = (ReadOptions::default(), WriteOptions::default());
/// let raised = |_: &Request| Ok(Vector3::new(0.0, 0.0, 0.25));
/// let survey = Survey::of(text.as_bytes(), &reading, PartLength { own: 3, beside: 1 })?;
/// let parts = Parts::of(&survey, &reading);
/// let order = PartsInOrder::from(0, WrittenSoFar::nothing(&survey, &reading));
/// let mut bytes = Vec::new();
/// for (index, part) in parts.in_order(Cursor::new(text)).enumerate() {
///     let (part, place) = (part?, order.place(index));
///     let program = GcodePart { part: &part, place: &place };
///     let written = program.write(&raised, &writing, &Unwatched)?;
///     program.verify(&written, &writing)?;
///     assert_eq!(place.wait_for_turn(), Standing::Next);
///     bytes.extend_from_slice(&written.bytes);
///     place.taken();
/// }
/// let path = interpret(&Program::read(bytes)?, &reading)?;
/// assert_eq!(path.moves.last().unwrap().end, Vector3::new(30.0, 5.0, 0.25));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct PartsInOrder<'o> {
    state: Mutex<State<'o>>,
    changed: Condvar,
}

/// Version of the written program before a part.
#[derive(Clone)]
struct Before<'o> {
    version: u64,
    written: Arc<WrittenSoFar<'o>>,
}

struct State<'o> {
    /// Parts that are taken.
    taken: usize,
    /// Written program before the next part to be taken, and before later ones as far as known. The first entry always exists.
    before: VecDeque<Before<'o>>,
    versions: u64,
    /// A part was written again: from then on a part waits until those before it are taken.
    waits: bool,
    ended: bool,
}

impl<'o> State<'o> {
    /// Written program before a part, if it is known and may be used.
    fn before(&self, part: usize) -> Option<&Before<'o>> {
        let ahead = part.checked_sub(self.taken)?;
        let may_be = ahead == 0 || !self.waits;
        self.before.get(ahead).filter(|_| may_be)
    }
}

/// State of a part that waited for its turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// The part is the next to be taken, as it was written.
    Next,
    /// The part would be next, but the program written before it has changed: it is to be done again.
    Again,
    /// No part is taken any more.
    Ended,
}

impl<'o> PartsInOrder<'o> {
    /// Continues after parts that are already taken and written.
    #[must_use]
    pub fn from(taken: usize, written: WrittenSoFar<'o>) -> Self {
        let first = Before {
            version: 0,
            written: Arc::new(written),
        };
        Self {
            state: Mutex::new(State {
                taken,
                before: VecDeque::from([first]),
                versions: 0,
                waits: false,
                ended: false,
            }),
            changed: Condvar::new(),
        }
    }

    /// The place of a part, for one way through it. Every part has its turn once those before it are taken: work on one that is
    /// not the next may not keep that from being done.
    #[must_use]
    pub fn place(&self, part: usize) -> PlaceInOrder<'_, 'o> {
        PlaceInOrder {
            order: self,
            part,
            used: OnceLock::new(),
        }
    }

    /// Parts that are taken.
    #[must_use]
    pub fn taken(&self) -> usize {
        self.lock().taken
    }

    /// Ends the order: no part is taken any more, and nobody waits any longer.
    pub fn end(&self) {
        self.lock().ended = true;
        self.changed.notify_all();
    }

    /// True if no part is taken any more.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.lock().ended
    }

    fn lock(&self) -> MutexGuard<'_, State<'o>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for what `found` looks for; `None` once no part is taken any more.
    fn wait<R>(&self, found: impl Fn(&State<'o>) -> Option<R>) -> Option<R> {
        let mut state = self.lock();
        loop {
            if state.ended {
                return None;
            }
            if let Some(found) = found(&state) {
                return Some(found);
            }
            let waited = self.changed.wait(state);
            state = waited.unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// The place of a part among the others, for one way through it.
pub struct PlaceInOrder<'p, 'o> {
    order: &'p PartsInOrder<'o>,
    part: usize,
    /// Program before the part: the same version however often the part is written.
    used: OnceLock<Before<'o>>,
}

impl<'o> PlaceInOrder<'_, 'o> {
    /// Waits for the written program before the part; `None` once no part is taken any more.
    pub(crate) fn before(&self) -> Option<Arc<WrittenSoFar<'o>>> {
        if let Some(used) = self.used.get() {
            return Some(used.written.clone());
        }
        let found = self.order.wait(|state| state.before(self.part).cloned())?;
        Some(self.used.get_or_init(|| found).written.clone())
    }

    /// Stores the written program after the part, as it was just written and read again.
    pub(crate) fn put_behind(&self, written: WrittenSoFar<'o>) {
        let mut state = self.order.lock();
        let ahead = self.part.wrapping_sub(state.taken);
        let current = state.before.get(ahead).map(|before| before.version);
        if current.is_none() || current != self.used.get().map(|used| used.version) {
            return;
        }
        state.waits |= state.before.len() > ahead + 1;
        state.before.truncate(ahead + 1);
        state.versions += 1;
        let version = state.versions;
        state.before.push_back(Before {
            version,
            written: Arc::new(written),
        });
        self.order.changed.notify_all();
    }

    /// Waits until all parts before this one are taken, and says whether it is to be taken as it is.
    #[must_use]
    pub fn wait_for_turn(&self) -> Standing {
        let version = self.order.wait(|state| {
            let comes = state.taken == self.part;
            comes.then(|| state.before.front().map(|before| before.version))
        });
        match (version, self.used.get()) {
            (None, _) => Standing::Ended,
            (Some(version), Some(used)) if version != Some(used.version) => Standing::Again,
            (Some(_), _) => Standing::Next,
        }
    }

    /// The part, whose turn it was, is in the result.
    pub fn taken(self) {
        let mut state = self.order.lock();
        state.taken += 1;
        // Nothing is written of a part that is only solved.
        if state.before.len() > 1 {
            state.before.pop_front();
        }
        self.order.changed.notify_all();
    }
}

/// A part of a program in G-code, to be written behind the parts before it.
pub struct GcodePart<'a, 'o> {
    /// The part.
    pub part: &'a Part,
    /// Place of the part among the others.
    pub place: &'a PlaceInOrder<'a, 'o>,
}

impl MachineProgram for GcodePart<'_, '_> {
    fn bytes(&self) -> &[u8] {
        self.part.program.own_bytes()
    }

    fn statement_count(&self) -> usize {
        self.part.program.block_count()
    }

    fn path(&self) -> &Path {
        &self.part.path
    }

    fn mark_line(&self) -> Option<usize> {
        let own = self.part.program.own_numbers();
        let found = self.part.program.mark_line();
        found.filter(|line| own.contains(line))
    }

    fn write(
        &self,
        field: &dyn CorrectionField,
        options: &WriteOptions,
        monitor: &dyn Monitor,
    ) -> Result<Corrected, WriteError> {
        let (program, path) = (&self.part.program, &self.part.path);
        let divided = Divided::of(program, path, field, options, monitor)?;
        let before = self.place.before().ok_or(WriteError::Cancelled)?;
        divided.emit(before.writer())
    }

    fn verify(
        &self,
        written: &Corrected,
        options: &WriteOptions,
    ) -> Result<Verification, WriteError> {
        let before = self.place.before().ok_or(WriteError::Cancelled)?;
        let again = before.read_again(written);
        let (output, output_path, behind) = again.map_err(|error| WriteError::Verification {
            line: 0,
            output_line: error.line,
            what: format!("it cannot be read again: {error}"),
        })?;
        self.place.put_behind(behind);
        let (input, input_path) = (&self.part.program, &self.part.path);
        against_input(input, input_path, &output, &output_path, written, options)
    }
}

/// State of a written program: the modal state of a controller that has run it so far, and that of its writer.
pub struct WrittenSoFar<'o> {
    survey: &'o Survey,
    reader: ReaderState,
    interpreter: Interpreter<'o>,
    writer: Option<WriterState>,
}

impl<'o> WrittenSoFar<'o> {
    /// State before anything is written.
    #[must_use]
    pub fn nothing(survey: &'o Survey, reading: &'o ReadOptions) -> Self {
        Self {
            survey,
            reader: ReaderState::default(),
            interpreter: Interpreter::new(reading),
            writer: None,
        }
    }

    /// Continues after these written lines, with this state of the writer: from what an interrupted run has left.
    ///
    /// # Errors
    /// They cannot be read.
    pub fn go_on(&mut self, written: impl BufRead, writer: WriterState) -> Result<(), PartError> {
        let mut lines = Lines::new(written);
        let mut line = Vec::new();
        let mut reader = Reader::following(&self.reader);
        let mut count = 0;
        loop {
            line.clear();
            if !lines.next(&mut line)? {
                break;
            }
            reader.next_line(&line)?;
            self.interpreter.run_line(reader.program(), count)?;
            count += 1;
            if count == 4096 {
                self.interpreter.pass_moves(|_, _| ());
                reader.keep_nothing();
                count = 0;
            }
        }
        self.reader = reader.state();
        self.interpreter = self.interpreter.following();
        self.writer = Some(writer);
        Ok(())
    }

    /// State of the writer; `None` before the first part.
    #[must_use]
    pub fn writer(&self) -> Option<&WriterState> {
        self.writer.as_ref()
    }

    /// Lines of the written program so far.
    #[must_use]
    pub fn lines(&self) -> usize {
        self.reader.lines
    }

    /// Reads the text of a part again after all that was written before, and returns the state of the written program after it.
    pub(crate) fn read_again(
        &self,
        written: &Corrected,
    ) -> Result<(Program, Path, Self), ProgramError> {
        let bytes = written.bytes.as_slice();
        let mut reader = Reader::following(&self.reader);
        let mut interpreter = self.interpreter.following();
        let (mut start, mut index) = (0, 0);
        while start < bytes.len() {
            let (length, ending) = first_line(&bytes[start..]);
            let next = start + length + ending.len();
            reader.next_line(&bytes[start..next])?;
            interpreter.run_line(reader.program(), index)?;
            (start, index) = (next, index + 1);
        }
        let behind = Self {
            survey: self.survey,
            reader: reader.state(),
            interpreter: interpreter.following(),
            writer: written.writer.as_deref().cloned(),
        };
        let mut program = reader.into_program();
        let before = self.reader.lines;
        program.set_part(PartOfText {
            core: before + 1..before + index + 1,
            usual_ending: self.survey.usual_ending.clone(),
            repeats_motion: false,
        });
        let path = interpreter.finish_part(&program, self.survey.stated)?;
        Ok((program, path, behind))
    }
}
