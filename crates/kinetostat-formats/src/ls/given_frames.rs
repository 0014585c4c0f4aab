//! Frames and tools to which the programs give values: `UTOOL[9]=PR[9]`.

use crate::ls::flow::Flow;
use crate::ls::found::Reader;
use crate::ls::lines::Layout;
use crate::ls::program::Program;
use crate::ls::registers::{Given, Place};
use crate::ls::step::{FRAME_DATA, Step};
use crate::text::source::SourceFile;

impl Reader<'_> {
    /// Notes them, and refuses values that neither the text nor the caller says.
    pub(super) fn given_frames(
        &mut self,
        files: &[SourceFile],
        layouts: &[Layout],
        (programs, flow): (&[Program], &Flow<'_>),
    ) {
        for (index, program) in programs.iter().enumerate() {
            for (at, step) in program.steps.iter().enumerate() {
                let step = match step {
                    Step::Perhaps(step) => step,
                    step => step,
                };
                let Step::Give(given @ Given::Whole(to, _)) = step else {
                    continue;
                };
                let (letters, number) = match to {
                    Place::Frame(number) => ("UF", number),
                    Place::Tool(number) => ("UT", number),
                    Place::Register(_) | Place::Position(_) => continue,
                };
                let before = flow.before[index][at];
                let mut registers = flow.registers(before).clone();
                registers.give(given, &program.positions);
                let is_stated = self
                    .ends
                    .frames
                    .contains_key(&format!("{letters}:{number}"));
                // What is not reached gives nothing.
                if before.is_none() || is_stated {
                    continue;
                }
                match registers.pose(*to) {
                    Some(_) => {
                        self.ends.given.insert(*to);
                    }
                    None => {
                        let (reason, remedy) = FRAME_DATA;
                        let span = layouts[index].lines[at].whole.clone();
                        self.fault(&files[index], span, reason, remedy);
                    }
                }
            }
        }
    }
}
