//! Counting of a rotary axis: on over whole turns, or from 0 to 360 deg and then from 0 again (a modulo axis).
//!
//! A program does not state it. It shows in words that only one of the two takes: DC, ACP and ACN turn a modulo axis (SINUMERIK), an
//! absolute angle outside 0 to 360 deg one that counts on. Where nothing shows it, both readings are to be right.

/// Angles nearer than this are one, deg.
pub(crate) const SAME_DEG: f64 = 1e-6;

/// Counting of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum AxisCount {
    /// The program does not show it.
    #[default]
    Open,
    /// On, over whole turns.
    On,
    /// From 0 to 360 deg, again and again.
    OneTurn,
}

/// Evidence in a program for the counting of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct CountShown {
    /// DC, ACP or ACN turns it.
    pub one_turn: bool,
    /// An absolute angle is outside 0 to 360 deg.
    pub beyond: bool,
    /// A word was refused because its two readings differ.
    pub differs: bool,
}

impl CountShown {
    /// Counting that these words imply.
    pub(crate) fn way_of_counting(self) -> AxisCount {
        match (self.one_turn, self.beyond) {
            (true, _) => AxisCount::OneTurn,
            (false, true) => AxisCount::On,
            (false, false) => AxisCount::Open,
        }
    }

    /// True if a reading with undetermined counting would differ.
    pub(crate) fn asks_again(self) -> bool {
        match self.way_of_counting() {
            AxisCount::OneTurn => true,
            AxisCount::On => self.differs,
            AxisCount::Open => false,
        }
    }

    /// With what another part of the program shows.
    pub(crate) fn joined_with(self, other: Self) -> Self {
        Self {
            one_turn: self.one_turn || other.one_turn,
            beyond: self.beyond || other.beyond,
            differs: self.differs || other.differs,
        }
    }
}

/// Evidence of two parts of a program, for all axes.
pub(crate) fn shown_by_both(one: &[CountShown], other: &[CountShown]) -> Vec<CountShown> {
    let all = 0..one.len().max(other.len());
    let at = |shown: &[CountShown], place: usize| shown.get(place).copied().unwrap_or_default();
    all.map(|place| at(one, place).joined_with(at(other, place)))
        .collect()
}

/// Whole turns below an angle, deg: what a modulo axis does not show of it.
pub(crate) fn turns_below(angle: f64) -> f64 {
    ((angle + SAME_DEG) / 360.0).floor() * 360.0
}

/// True if an angle is at least 0 and less than 360 deg.
pub(crate) fn is_in_one_turn(angle: f64) -> bool {
    turns_below(angle) == 0.0
}

/// Form of the end of a piece on an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum EndWord {
    /// Absolute angle.
    Angle,
    /// Shorter way to an angle of one turn (DC).
    Shorter,
    /// Incremental turn.
    Step,
}

impl AxisCount {
    /// Form of a piece between two angles, with so many decimals, that is correct for the axis.
    pub(crate) fn word_of_end(self, from: f64, to: f64, decimals: usize) -> EndWord {
        let digit = 0.1_f64.powi(i32::try_from(decimals).unwrap_or(9));
        let [from, to] = [from, to].map(|angle| (angle / digit).round() * digit);
        let stays = match self {
            Self::On => true,
            Self::Open => is_in_one_turn(from) && is_in_one_turn(to),
            Self::OneTurn => turns_below(from) == turns_below(to),
        };
        match self {
            _ if stays => EndWord::Angle,
            Self::OneTurn if (to - from).abs() < 179.0 => EndWord::Shorter,
            _ => EndWord::Step,
        }
    }
}
