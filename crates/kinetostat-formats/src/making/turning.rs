//! Spindle rotation of a program, as far as its blocks state it.

use kinetostat_program::{SpeedMode, Spindle, SpindleChange, SpindleRotation};

/// Known state of the spindle.
#[derive(Default)]
pub(crate) struct Turning {
    spindle: Spindle,
    /// A switch of the machine, or another master spindle, leaves it open which way it turns.
    is_open: bool,
    changes: Vec<SpindleChange>,
    /// The state was unknown somewhere: then no changes are reported.
    was_open: bool,
}

impl Turning {
    /// Spindle state; `None` if rotation or sense are unknown.
    pub(crate) fn now(&self) -> Option<Spindle> {
        (!self.is_open).then_some(self.spindle)
    }

    /// Takes down how it turns on a line.
    pub(crate) fn note(&mut self, line: usize) {
        let spindle = self.spindle;
        self.was_open |= self.is_open;
        let last = self.changes.last().map(|change| change.spindle);
        if last.unwrap_or_default() != spindle {
            self.changes.push(SpindleChange { line, spindle });
        }
    }

    /// Changes of the rotation, if it is known throughout.
    pub(crate) fn changes(self) -> Vec<SpindleChange> {
        match self.was_open {
            true => Vec::new(),
            false => self.changes,
        }
    }

    pub(crate) fn turn(&mut self, rotation: SpindleRotation) {
        self.spindle.rotation = rotation;
        self.is_open = false;
    }

    /// A speed; none where the program does not say it as a number.
    pub(crate) fn speed(&mut self, speed: Option<f64>) {
        self.spindle.speed = speed;
    }

    /// Sets the mode of the spindle speed; a speed of another mode becomes unknown.
    pub(crate) fn count(&mut self, mode: SpeedMode) {
        if self.spindle.mode != mode {
            self.spindle.mode = mode;
            self.spindle.speed = None;
        }
    }

    pub(crate) fn forget(&mut self) {
        self.spindle.speed = None;
        self.is_open = true;
    }
}
