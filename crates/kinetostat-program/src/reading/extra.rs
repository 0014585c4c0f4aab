//! The axes that are not X, Y, Z: carried along, and shared out when a block is split.

use crate::path::moves::{ExtraAxis, ExtraMode};
use crate::reading::block::Block;

/// Positions of the extra axes, in program coordinates and the units in force.
#[derive(Debug, Clone, Default)]
pub(crate) struct ExtraAxes {
    /// Positions in the order of [`ExtraAxes::LETTERS`]; `None` until the program states them.
    places: [Option<f64>; 7],
    incremental: bool,
    /// Extruder mode of M82 and M83, once given.
    extruder_relative: Option<bool>,
    /// Extruder mode of a firmware whose G90 and G91 set the extruder as well (Marlin).
    extruder_relative_by_last_word: bool,
    /// Origins of A, B and C of the program, deg of the machine.
    origin_deg: [f64; 3],
    /// True for each of A, B and C that was sent to a machine place other than zero (G53), and not back.
    elsewhere: [bool; 3],
}

/// Origins of A, B and C in the work coordinate systems, deg of the machine.
pub(crate) type RotaryOrigins = [[f64; 3]; 9];

impl ExtraAxes {
    pub const LETTERS: &'static [u8; 7] = b"ABCEUVW";
    const EXTRUDER: usize = 3;

    pub fn set_distance_mode(&mut self, incremental: bool) {
        self.incremental = incremental;
        self.extruder_relative_by_last_word = incremental;
    }

    /// M82 (820) or M83 (830).
    pub fn set_extruder_mode(&mut self, code: Option<u32>) {
        if let Some(code) = code {
            self.extruder_relative = Some(code == 830);
            self.extruder_relative_by_last_word = code == 830;
        }
    }

    /// Position of an axis, in program coordinates.
    pub fn place(&self, letter: char) -> Option<f64> {
        let index = Self::LETTERS
            .iter()
            .position(|own| char::from(*own) == letter)?;
        self.places[index]
    }

    /// Angle of a rotary axis of the machine, in its own degrees.
    pub fn angle_deg(&self, letter: char) -> Option<f64> {
        Some(self.place(letter)? + self.origin_deg(letter))
    }

    /// A rotary axis was turned to an angle, in its own degrees.
    pub fn turn_to(&mut self, letter: char, angle_deg: f64) {
        if let Some(index) = Self::rotary_index(letter as u8) {
            self.places[index] = Some(angle_deg - self.origin_deg[index]);
        }
    }

    /// Origin of the words of a rotary axis, in its own degrees.
    pub fn origin_deg(&self, letter: char) -> f64 {
        Self::rotary_index(letter as u8).map_or(0.0, |index| self.origin_deg[index])
    }

    /// Index of A, B or C.
    pub fn rotary_index(letter: u8) -> Option<usize> {
        Self::LETTERS[..3].iter().position(|own| *own == letter)
    }

    /// A, B and C of the program count from elsewhere: the axes stand where they are.
    pub fn count_from(&mut self, origin_deg: [f64; 3]) {
        for (index, origin) in origin_deg.into_iter().enumerate() {
            if let Some(place) = &mut self.places[index] {
                *place -= origin - self.origin_deg[index];
            }
        }
        self.origin_deg = origin_deg;
    }

    /// Angles keep their numbers, lengths do not.
    pub fn change_units(&mut self, factor: f64) {
        for place in self.places[Self::EXTRUDER..].iter_mut().flatten() {
            *place *= factor;
        }
    }

    /// G92 with words of extra axes.
    pub fn set_here(&mut self, block: &Block<'_>) {
        for (place, letter) in self.places.iter_mut().zip(Self::LETTERS) {
            if let Some(value) = block.value(*letter) {
                *place = Some(value);
            }
        }
    }

    /// G28, G30 and G53 leave the axes that they name, and all but the extruder where they name none, at
    /// places of the machine.
    pub fn forget(&mut self, block: &Block<'_>, all: bool) {
        for (index, letter) in Self::LETTERS.iter().enumerate() {
            if block.value(*letter).is_some() || all && index != Self::EXTRUDER {
                self.places[index] = None;
                if let Some(elsewhere) = self.elsewhere.get_mut(index) {
                    let at_zero = block.value(*letter) == Some(0.0);
                    *elsewhere = block.codes.machine == Some(530) && !at_zero;
                }
            }
        }
    }

    /// True if a rotary axis was sent to a machine place that is not its zero.
    pub fn is_elsewhere(&self, letter: char) -> bool {
        Self::rotary_index(letter as u8).is_some_and(|index| self.elsewhere[index])
    }

    fn mode(&self, index: usize) -> ExtraMode {
        let relative = match self.extruder_relative {
            Some(relative) if index == Self::EXTRUDER => {
                if relative != self.extruder_relative_by_last_word {
                    return ExtraMode::Disputed;
                }
                relative
            }
            _ => self.incremental,
        };
        if relative {
            ExtraMode::Incremental
        } else {
            ExtraMode::Absolute
        }
    }

    /// The extra axes' part in the move of a block, in the order of its words.
    pub fn read(&mut self, block: &Block<'_>, incremental: bool) -> Vec<ExtraAxis> {
        debug_assert_eq!(incremental, self.incremental);
        let mut moved = Vec::new();
        for word in block.words {
            let Some(index) = Self::LETTERS
                .iter()
                .position(|letter| *letter == word.letter)
            else {
                continue;
            };
            let Some(value) = block.value(word.letter) else {
                continue;
            };
            let mode = self.mode(index);
            let start = self.places[index];
            if let (Some(elsewhere), ExtraMode::Absolute) = (self.elsewhere.get_mut(index), mode) {
                *elsewhere = false;
            }
            self.places[index] = match mode {
                ExtraMode::Absolute => Some(value),
                ExtraMode::Incremental => start.map(|start| start + value),
                ExtraMode::Disputed => None,
            };
            moved.push(ExtraAxis {
                letter: char::from(word.letter),
                word: value,
                start,
                mode,
            });
        }
        moved
    }
}
