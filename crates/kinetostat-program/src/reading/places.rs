//! Tool position, axis by axis, as far as the program states it, and shifts of the coordinates that only the machine knows.
//!
//! An axis is unknown until the program states it by an absolute word, or the options do. It becomes unknown
//! again where the program sends it to a place of the machine or changes the length of the tool. Its
//! number goes on then: increments add to it, and what counts is the difference of two programs that make the same
//! moves.

use nalgebra::Vector3;

use crate::path::moves::OffsetChange;

/// Reason for which an axis is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Cause {
    /// G43, G43.1, G43.2, G49.
    ToolLength,
    /// G28, G30, G53.
    Machine,
    /// Rotary axes at an angle, without tool centre point control.
    Rotary,
}

/// Place and knowledge of the three axes.
#[derive(Debug, Clone, Default)]
pub(crate) struct Places {
    /// Position in mm, part frame.
    pub position: Vector3<f64>,
    pub known: [bool; 3],
    /// Axes that were known at some time.
    pub stated: [bool; 3],
    /// Cause and line by which a known axis became unknown.
    lost: [Option<(Cause, usize)>; 3],
    /// True after a line that could not be read: it may have moved the axis.
    pub unsure: [bool; 3],
    /// The last line that turned a rotary axis.
    pub turned_on: usize,
}

impl Places {
    pub fn new(start: Option<Vector3<f64>>) -> Self {
        Self {
            position: start.unwrap_or_default(),
            known: [start.is_some(); 3],
            stated: [start.is_some(); 3],
            ..Self::default()
        }
    }

    /// An axis is known from here on.
    pub fn state(&mut self, axis: usize) {
        self.known[axis] = true;
        self.stated[axis] = true;
        self.lost[axis] = None;
        self.unsure[axis] = false;
    }

    /// An axis is unknown from here on.
    pub fn lose(&mut self, axis: usize, cause: Cause, line: usize) {
        if self.known[axis] {
            self.known[axis] = false;
            self.lost[axis] = Some((cause, line));
        }
    }

    /// The first axis that was known and is so no more, why, and since which line.
    pub fn first_lost(&self) -> Option<(usize, Cause, usize)> {
        (0..3).find_map(|axis| self.lost[axis].map(|(cause, line)| (axis, cause, line)))
    }

    /// Axes that were known and are so no more, with the causes.
    pub fn all_lost(&self) -> impl Iterator<Item = (usize, Cause)> + '_ {
        (0..3).filter_map(|axis| self.lost[axis].map(|(cause, _)| (axis, cause)))
    }

    /// Text of the reason for which a known axis became unknown; `None` if it never was known or still is.
    pub fn why_lost(&self, axis: usize) -> Option<String> {
        let (cause, line) = self.lost[axis]?;
        Some(match cause {
            Cause::ToolLength => format!("line {line} changed the tool length"),
            Cause::Machine => format!("line {line} sent the tool to a place of the machine"),
            Cause::Rotary => format!("line {line} turned a rotary axis"),
        })
    }

    /// A line could not be read: no place is sure, and none is asked for.
    pub fn doubt(&mut self) {
        self.unsure = [true; 3];
        self.stated = [true; 3];
        self.take_as_known();
    }

    /// Treats lost axes as known again, to continue after a fault.
    pub fn take_as_known(&mut self) {
        self.known = self.stated;
        self.lost = [None; 3];
    }
}

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
