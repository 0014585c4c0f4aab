//! Options for writing a corrected program.

use serde::Serialize;

use crate::error::WriteError;

/// Output for corrected arcs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Arcs {
    /// Arcs again, as few as follow the corrected curve within the tolerances, and straight pieces where no arc does.
    #[default]
    Fit,
    /// Straight pieces.
    Lines,
}

/// Forms in which the language of a program can write a corrected arc.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Circles {
    /// Straight motions.
    #[default]
    Straight,
    /// Circles through a place between their ends, which may lean.
    ThroughPlace,
    /// Arcs about a stated centre in the plane of the arc, which may rise evenly.
    AboutAxis,
}

/// Options for writing a corrected program.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct WriteOptions {
    /// Maximum distance of straight pieces from the corrected curve because the correction varies, in mm. Default
    /// 0.0005.
    pub tolerance_mm: f64,
    /// Output for arcs, if the language has any that follow: in G-code those about the axis of the plane, in RAPID, KRL, FANUC TP
    /// and SINUMERIK programs circles through places, in Heidenhain programs arcs and helices about centres. APT programs get
    /// straight pieces in any case.
    pub arcs: Arcs,
    /// Smallest jump of the correction (between blocks, where the load turns with the direction of
    /// motion, or inside one) that gets a step of its own, in mm; a smaller jump is taken up along the
    /// piece that follows. `None`, the default, is `tolerance_mm`.
    pub corner_step_mm: Option<f64>,
    /// Distance from the tool's tip, in mm, at which a correction of the orientation is held to these tolerances: where a turn
    /// of the tool varies, a point so far from the tip is within `tolerance_mm`. Default 50.
    pub turn_lever_mm: f64,
    /// Chord error of an arc, in mm; an arc that is fitted may leave the corrected curve by this and `tolerance_mm`
    /// together, as chords do, also where one arc of a block ends and the next begins. Default 0.0004.
    pub chord_tolerance_mm: f64,
    /// A stretch this short (in mm) over which the correction still varies by more than the
    /// tolerance is taken for a jump: the tool steps there. Default 0.001.
    pub smallest_piece_mm: f64,
    /// Maximum feed of a piece over the programmed one, at least 1. More would be needed to keep the speed along the
    /// part where the tool's own path is much longer; there the part is cut more slowly instead. Default 1.2.
    pub max_feed_factor: f64,
    /// Length against the direction of motion from which on a step or a piece is warned of, in mm.
    /// Default 0.05.
    pub backward_step_mm: f64,
    /// Digits after the point in millimetres, one more in inches; `None` is 4 (and 5).
    pub decimals: Option<u8>,
    /// Shortest block that the controller is to get, in mm: pieces, arcs as well, are shared out where that keeps them longer, and
    /// the lines with shorter ones are named. `None`, the default, sets no limit.
    pub min_block_mm: Option<f64>,
    /// Block rate of the controller per second: a limit like `min_block_mm`, with the length that the programmed feed covers
    /// in the time of one block.
    pub max_blocks_per_s: Option<f64>,
    /// Lines of text for the header below the mark; `None` writes no header (and no mark).
    pub header: Option<Vec<String>>,
    /// Longest line written, in bytes without its ending. Default 250.
    pub max_line_bytes: usize,
    /// Largest number of pieces in all. Default ten million.
    pub max_pieces: usize,
    /// True if a program that is marked as compensated may be compensated once more.
    pub again: bool,
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self {
            tolerance_mm: 0.0005,
            arcs: Arcs::Fit,
            corner_step_mm: None,
            turn_lever_mm: 50.0,
            chord_tolerance_mm: 0.0004,
            smallest_piece_mm: 0.001,
            max_feed_factor: 1.2,
            backward_step_mm: 0.05,
            decimals: None,
            min_block_mm: None,
            max_blocks_per_s: None,
            header: Some(Vec::new()),
            max_line_bytes: 250,
            max_pieces: 10_000_000,
            again: false,
        }
    }
}

impl WriteOptions {
    pub(crate) fn check(&self) -> Result<(), WriteError> {
        let lengths = [
            ("tolerance_mm", self.tolerance_mm),
            ("corner_step_mm", self.smallest_step_mm()),
            ("chord_tolerance_mm", self.chord_tolerance_mm),
            ("smallest_piece_mm", self.smallest_piece_mm),
            ("backward_step_mm", self.backward_step_mm),
        ];
        for (name, value) in lengths {
            if !(1e-6..=10.0).contains(&value) {
                return Err(WriteError::Option {
                    name,
                    found: value.to_string(),
                    allowed: "0.000001 to 10 mm are allowed",
                });
            }
        }
        if !(0.001..=10_000.0).contains(&self.turn_lever_mm) {
            return Err(WriteError::Option {
                name: "turn_lever_mm",
                found: self.turn_lever_mm.to_string(),
                allowed: "0.001 to 10000 mm are allowed",
            });
        }
        if !(1.0..=1000.0).contains(&self.max_feed_factor) {
            return Err(WriteError::Option {
                name: "max_feed_factor",
                found: self.max_feed_factor.to_string(),
                allowed: "1 to 1000 are allowed",
            });
        }
        if let Some(decimals) = self.decimals
            && !(3..=8).contains(&decimals)
        {
            return Err(WriteError::Option {
                name: "decimals",
                found: decimals.to_string(),
                allowed: "3 to 8 digits are allowed",
            });
        }
        if let Some(shortest) = self.min_block_mm
            && !(1e-6..=1000.0).contains(&shortest)
        {
            return Err(WriteError::Option {
                name: "min_block_mm",
                found: shortest.to_string(),
                allowed: "0.000001 to 1000 mm are allowed",
            });
        }
        if let Some(most) = self.max_blocks_per_s
            && !(most > 0.0 && most.is_finite())
        {
            return Err(WriteError::Option {
                name: "max_blocks_per_s",
                found: most.to_string(),
                allowed: "a number above zero is allowed",
            });
        }
        if !(80..=65_000).contains(&self.max_line_bytes) {
            return Err(WriteError::Option {
                name: "max_line_bytes",
                found: self.max_line_bytes.to_string(),
                allowed: "80 to 65000 bytes are allowed",
            });
        }
        Ok(())
    }

    pub(crate) fn smallest_step_mm(&self) -> f64 {
        self.corner_step_mm.unwrap_or(self.tolerance_mm)
    }

    /// The last digit that is written, in mm, of words in a unit of so many mm.
    ///
    /// ```
    /// use kinetostat_program::WriteOptions;
    ///
    /// let writing = WriteOptions::default(); // four decimals, one more in inches
    /// assert!((writing.last_digit_mm(1.0) - 1e-4).abs() < 1e-12);
    /// assert!((writing.last_digit_mm(25.4) - 25.4e-5).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn last_digit_mm(&self, mm_per_unit: f64) -> f64 {
        mm_per_unit * 10_f64.powi(-(self.decimals_for(mm_per_unit) as i32))
    }

    /// Half of the last digit that is written, in mm: what is smaller cannot be written.
    pub(crate) fn half_digit_mm(&self, mm_per_unit: f64) -> f64 {
        0.5 * self.last_digit_mm(mm_per_unit)
    }

    /// Digits after the point of coordinate words in a unit of this size.
    pub(crate) fn decimals_for(&self, mm_per_unit: f64) -> usize {
        usize::from(self.decimals.unwrap_or(4)) + usize::from(mm_per_unit > 1.0)
    }
}
