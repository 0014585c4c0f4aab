//! The sections of a file and its instructions.

use std::collections::BTreeSet;

use crate::ls::found::Reader;
use crate::ls::lines::Layout;
use crate::ls::motion::End;
use crate::ls::positions::{Held, Positions};
use crate::ls::program::Program;
use crate::ls::step::{Step, positions_read, step_of};
use crate::text::source::SourceFile;

const MOST_BYTES: usize = 1 << 28;

impl Reader<'_> {
    pub(super) fn layout_of(&mut self, file: &SourceFile) -> Layout {
        if file.bytes().len() > MOST_BYTES {
            self.fault(file, 0..0, "the file is larger than 256 MiB", "divide it");
            return Layout::default();
        }
        let layout = Layout::of(file.bytes());
        if !layout.has_instructions {
            self.fault(
                file,
                0..0,
                "there is no section /MN in the file",
                "give a TP program as the controller prints it (.ls)",
            );
        } else if !layout.has_end {
            let end = file.bytes().len();
            self.fault(
                file,
                end..end,
                "the file ends before its section /END: a part of it may be lost",
                "give the whole file",
            );
        }
        layout
    }

    /// The instructions of a file; positions that are read besides motions keep their values.
    pub(super) fn program_of(
        &mut self,
        file: &SourceFile,
        index: usize,
        layout: &Layout,
        positions: &Positions,
    ) -> Program {
        if let Some(stated) = &layout.line_count
            && stated.value != layout.lines.len() as f64
        {
            let (line, count) = (file.line_of(stated.span.start), layout.lines.len());
            let message = format!("LINE_COUNT says {}, there are {count} lines", stated.value);
            self.finding(index, line, message);
        }
        let mut steps = Vec::with_capacity(layout.lines.len());
        let mut kept = BTreeSet::new();
        let mut all_kept = false;
        for line in &layout.lines {
            let step = step_of(file.bytes(), &line.text);
            match &step {
                Step::Motion(motion) => {
                    let via = motion.via.iter().map(|(_, via)| via);
                    let mut ends = via.chain([&motion.target]);
                    all_kept |= ends.any(|end| matches!(end, End::Computed(..)));
                }
                _ => match positions_read(file.bytes(), &line.text) {
                    Some(numbers) => kept.extend(numbers),
                    None => all_kept = true,
                },
            }
            steps.push(step);
        }
        for (number, position) in &positions.all {
            if let (Held::Pose(declaration), true) =
                (&position.held, all_kept || kept.contains(number))
            {
                self.declarations[*declaration].keeps_value = true;
            }
        }
        let program = Program::of(steps);
        for (at, reason, remedy) in &program.faults {
            self.fault(file, layout.lines[*at].whole.clone(), *reason, *remedy);
        }
        program
    }
}
