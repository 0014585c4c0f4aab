//! Shifts of the coordinates that only the machine knows.

use crate::path::position_offset::OffsetChange;

/// Axes whose coordinates are shifted by an amount that is not in the program.
///
/// A first `G92 X0` says where the tool stands, and the program's coordinates count from there. When it is taken away
/// they count from the machine's work offset again, and how far apart the two are only the machine knows. The same is
/// true of an offset from before the program that G92.3 brings back.
#[derive(Clone, Copy, Default)]
pub(crate) struct Shifts {
    pub now: [bool; 3],
    /// Shift without G92.
    bare: [bool; 3],
    /// Shift after G92.3; `None` while that brings back an offset from before the program.
    saved: Option<[bool; 3]>,
    /// Line of the last change.
    pub line: usize,
    /// G92 or G92.1 was met, and none that suspends or resumes it after that.
    stated: [bool; 3],
}

impl Shifts {
    /// True if the program has stated the shift of an axis by G92: it has been cleared, or set where the tool was known.
    pub fn is_sure(&self, axis: usize) -> bool {
        self.stated[axis] && !self.bare[axis] && !self.now[axis]
    }

    /// `stated`: axes whose coordinates were used, in the offset in force.
    pub fn apply(&mut self, change: &OffsetChange, stated: &[bool; 3], line: usize) {
        self.line = line;
        for axis in 0..3 {
            self.stated[axis] = match change {
                OffsetChange::Here { coordinates_mm, .. } => {
                    self.stated[axis] || coordinates_mm[axis].is_some()
                }
                OffsetChange::Clear => true,
                OffsetChange::Suspend | OffsetChange::Resume => false,
            };
        }
        match change {
            OffsetChange::Here {
                coordinates_mm,
                establishes,
                ..
            } => {
                for axis in 0..3 {
                    self.bare[axis] |= establishes[axis];
                    self.now[axis] &= coordinates_mm[axis].is_none();
                }
                self.saved = Some(self.now);
            }
            OffsetChange::Clear => {
                self.now = self.bare;
                self.saved = Some(self.bare);
            }
            OffsetChange::Suspend => self.now = self.bare,
            OffsetChange::Resume => {
                self.now = self.saved.unwrap_or_else(|| {
                    for axis in 0..3 {
                        self.bare[axis] |= !stated[axis];
                    }
                    *stated
                });
            }
        }
    }
}
