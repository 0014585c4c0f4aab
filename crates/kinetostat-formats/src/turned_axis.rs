//! One rotary axis: where it stands, the words that turn it, and its counting (on over whole turns, or from 0 to 360 deg and then from 0
//! again: a modulo axis).
//!
//! Takes the words, gives an angle that counts on over whole turns; what a modulo axis shows of it is less by whole turns. Where it is
//! open how the axis counts, and a cut depends on it, the word is refused with both readings.

/// Angles below this are zero, deg.
pub(crate) const ZERO_DEG: f64 = 1e-9;

/// Turn of an axis by a word, deg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum AxisTurn {
    /// Absolute angle, direct.
    To(f64),
    /// Incremental angle.
    By(f64),
    /// Angle of one turn, the shorter way (DC; M126).
    Shorter(f64),
    /// Angle of one turn, upwards (ACP).
    Upwards(f64),
    /// Angle of one turn, downwards (ACN).
    Downwards(f64),
}

/// Reason and remedy of an axis fault.
pub(crate) type AxisFault = (String, String);

/// The words with which a language has tool centre point control, and states an angle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TipWords {
    /// `TRAORI`, `M128`.
    pub control: &'static str,
    /// `G0 `, `L `: what stands before the word of an axis at zero.
    pub rapid: &'static str,
    /// Text after the letter of an axis at zero.
    pub zero: &'static str,
    /// The word of a step, deg.
    pub step: fn(char, f64) -> String,
    /// Word that turns an axis of 0 to 360 deg to an angle.
    pub shorter: fn(char, f64) -> String,
}

/// Context of a turn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turning<'w> {
    pub words: &'w TipWords,
    /// Rapid traverse: the sense of the turn changes nothing in the part.
    pub rapid: bool,
}

/// Modal state of one axis, deg.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct StandingAxis {
    pub letter: char,
    pub at: Option<f64>,
    count: AxisCount,
    pub shown: CountShown,
    /// Whole turns that a modulo axis does not show, deg.
    wound: f64,
    /// An incremental word turned the axis out of 0 to 360 deg: the displayed angle is unknown.
    left: bool,
    /// The axis was moved to a machine position.
    pub sent: bool,
}

impl StandingAxis {
    /// State of an axis with the shown counting.
    pub(crate) fn new(letter: char, shown: CountShown) -> Self {
        Self {
            letter,
            count: shown.way_of_counting(),
            ..Self::default()
        }
    }

    /// Invalidates the position of the axis.
    pub(crate) fn be_anywhere(&mut self) {
        (self.at, self.wound) = (None, 0.0);
        (self.left, self.sent) = (false, false);
    }

    /// A word turns it; whether by half a turn, the shorter way.
    pub(crate) fn take_turn(
        &mut self,
        turn: AxisTurn,
        turning: Turning<'_>,
    ) -> Result<bool, AxisFault> {
        let mut halved = false;
        let at = match (turn, self.at) {
            (AxisTurn::To(to), _) => return self.turn_to(to, turning).map(|()| false),
            (AxisTurn::By(by), Some(at)) => at + by,
            (AxisTurn::By(_), None) => {
                let letter = self.letter;
                return Err((
                    format!("axis {letter} turns by an angle, and where it stands is not stated"),
                    format!("state it before by an absolute word ({letter}0)"),
                ));
            }
            (AxisTurn::Shorter(to) | AxisTurn::Upwards(to) | AxisTurn::Downwards(to), Some(at)) => {
                let up = match (self.of_one_turn(to)? - at).rem_euclid(360.0) {
                    // The axis is already there: the residue of rounding is no turn.
                    up if up > 360.0 - SAME_DEG => up - 360.0,
                    up => up,
                };
                halved = matches!(turn, AxisTurn::Shorter(_)) && (up - 180.0).abs() < ZERO_DEG;
                let by = match turn {
                    AxisTurn::Upwards(_) => up,
                    AxisTurn::Downwards(_) if up > SAME_DEG => up - 360.0,
                    AxisTurn::Shorter(_) if up > 180.0 => up - 360.0,
                    _ => up,
                };
                to + ((at + by - to) / 360.0).round() * 360.0
            }
            (AxisTurn::Shorter(to) | AxisTurn::Upwards(to) | AxisTurn::Downwards(to), None) => {
                self.of_one_turn(to)?
            }
        };
        match self.count {
            AxisCount::OneTurn => self.wound = turns_below(at),
            // A step on an axis that counts on is followed; that a shorter way crosses 0 is said of one that does not.
            AxisCount::On if matches!(turn, AxisTurn::By(_)) => {}
            AxisCount::On | AxisCount::Open => self.left = !is_in_one_turn(at),
        }
        (self.at, self.sent) = (Some(at), false);
        Ok(halved)
    }

    /// Turn of an axis of 0 to 360 deg by an absolute word, direct (AC) and by the shorter way (DC), if they differ.
    pub(crate) fn readings_of(&self, to: f64) -> Option<[f64; 2]> {
        let at = self.at.filter(|_| self.count == AxisCount::OneTurn)?;
        let on = to + self.wound - at;
        (on.abs() > 180.0 - ZERO_DEG).then(|| [on, on - 360.0_f64.copysign(on)])
    }

    /// An absolute word turns it.
    fn turn_to(&mut self, to: f64, turning: Turning<'_>) -> Result<(), AxisFault> {
        let letter = self.letter;
        let from = self.at.filter(|_| self.left);
        (self.sent, self.left) = (false, false);
        self.at = Some(to + self.wound);
        let beyond = !(0.0..360.0).contains(&to);
        self.shown.beyond |= beyond;
        if beyond && self.count == AxisCount::OneTurn {
            return Err((
                format!(
                    "axis {letter} is sent to {to} deg, and DC, ACP or ACN in this program turn it: such an axis counts from 0 to 360 deg"
                ),
                format!(
                    "write an angle from 0 to 359.999, or a step ({})",
                    (turning.words.step)(letter, 10.0)
                ),
            ));
        }
        let Some(from) = from.filter(|from| !turning.rapid && !is_in_one_turn(*from)) else {
            return Ok(());
        };
        self.shown.differs = true;
        let shown = from - turns_below(from);
        // Digits that the arithmetic leaves are none.
        let tidy = |angle: f64| (angle * 1e5).round() / 1e5 + 0.0;
        let (on, within) = (tidy(to - from), tidy(to - shown));
        let (from, shown) = (tidy(from), tidy(shown));
        let step = turning.words.step;
        Err((
            format!(
                "axis {letter} is sent to {to} deg, and how far it turns is open: it came to {from} deg by a step or the shorter way. If it counts on it turns by {on} deg, and if it counts from 0 to 360, it stands at {shown} and turns by {within} deg"
            ),
            format!(
                "write the turn that is meant as a step: {} or {}; or, on an axis that counts from 0 to 360, {}; or, on one that counts on, state {letter}{from} where it stands",
                step(letter, on),
                step(letter, within),
                (turning.words.shorter)(letter, to)
            ),
        ))
    }

    /// An angle of one turn.
    fn of_one_turn(&self, to: f64) -> Result<f64, AxisFault> {
        match (0.0..360.0).contains(&to) {
            true => Ok(to),
            false => Err((
                format!(
                    "axis {} is sent to {to} deg of one turn (DC, ACP, ACN)",
                    self.letter
                ),
                "write an angle from 0 to 359.999".to_owned(),
            )),
        }
    }
}

// Counting of a rotary axis: on over whole turns, or from 0 to 360 deg and then from 0 again (a modulo axis).
//
// A program does not state it. It shows in words that only one of the two takes: DC, ACP and ACN turn a modulo axis (SINUMERIK), an
// absolute angle outside 0 to 360 deg one that counts on. Where nothing shows it, both readings are to be right.

/// Angles nearer than this are one, deg.
pub(crate) const SAME_DEG: f64 = 1e-6;

/// Counting of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum AxisCount {
    /// The program does not show it.
    #[default]
    Open,
    /// The axis counts on over whole turns.
    On,
    /// The axis counts from 0 to 360 deg, and again from 0.
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

    /// Combines the evidence with that of another part of the program.
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
