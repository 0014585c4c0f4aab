//! The run goes on behind lines that are refused, to find them all.

use crate::refused_run::Behind;
use crate::siemens::block::Item;
use crate::siemens::flat::control::Control;
use crate::siemens::flat::print::End;
use crate::siemens::flat::run::{MOST_BLOCKS, MOST_BYTES};
use crate::siemens::flat::runner::{MOST_LEVELS, Runner};

impl Runner<'_> {
    /// What stands behind a line that is refused.
    pub(super) fn behind(&self, unit: usize, line: usize) -> Behind {
        let is_full = self.origins.len() > MOST_BLOCKS || self.output.len() > MOST_BYTES;
        if is_full || self.levels.len() >= MOST_LEVELS {
            return Behind::Nothing;
        }
        let runs = self.levels.last().map(|level| (level.unit, level.line));
        let Some(at) = self.units[unit].lines.get(line) else {
            return Behind::Depends;
        };
        let items = &at.block.items;
        let assigns = |item: &Item| self.is_assignment(&item.name, &item.what);
        let is_same = runs == Some((unit, line))
            && matches!(at.control, Control::None)
            && !items.iter().any(assigns)
            && matches!(self.end(items), Ok(End::No));
        match is_same {
            true => Behind::Same,
            false => Behind::Depends,
        }
    }

    /// Goes to the next line; the refused one is written as it stands.
    pub(super) fn go_on(&mut self, unit: usize, line: usize, written: usize) {
        if self.origins.len() == written
            && let Some(at) = self.units[unit].lines.get(line)
        {
            let text = self.file().part(&at.block.line).to_vec();
            self.write_line(&text);
        }
        self.arrive(line + 1, false);
    }
}
