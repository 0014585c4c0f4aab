//! Where the rotary axes of a machine stand, as far as the words of a program say it, and what it may do there.
//!
//! Takes the words of SINUMERIK (A, B, C with AC, IC, DC, ACP, ACN) and Heidenhain (A, IA, ...) programs, gives angles that count on over
//! whole turns. The laws are those of G43.4: with tool centre point control a cut needs all angles; without it X, Y and Z are
//! places of the slides, and a cut is where the program says only with all axes at zero.

use crate::axis_count::{AxisCount, CountShown, SAME_DEG, is_in_one_turn, turns_below};
use crate::model::stated_axes::AxesStated;

/// Angles below this are zero, deg.
const ZERO_DEG: f64 = 1e-9;

/// How a word turns an axis, deg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum AxisTurn {
    /// To an angle, straight on.
    To(f64),
    /// By an angle.
    By(f64),
    /// To an angle of one turn, the shorter way (DC; M126).
    Shorter(f64),
    /// To an angle of one turn, upwards (ACP).
    Upwards(f64),
    /// To an angle of one turn, downwards (ACN).
    Downwards(f64),
}

/// What is wrong, and what to do.
pub(crate) type AxisFault = (String, String);

/// The words with which a language has tool centre point control, and states an angle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TipWords {
    /// `TRAORI`, `M128`.
    pub control: &'static str,
    /// `G0 `, `L `: what stands before the word of an axis at zero.
    pub rapid: &'static str,
    /// What stands behind the letter of an axis at zero.
    pub zero: &'static str,
    /// The word of a step, deg.
    pub step: fn(char, f64) -> String,
    /// What turns an axis of 0 to 360 deg to an angle.
    pub shorter: fn(char, f64) -> String,
}

/// What else is to be known of a turn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turning<'w> {
    pub words: &'w TipWords,
    /// In rapid traverse: which way round the axis goes there, changes nothing in the part.
    pub rapid: bool,
}

#[derive(Debug, Clone, PartialEq)]
struct StandingAxis {
    letter: char,
    at: Option<f64>,
    count: AxisCount,
    shown: CountShown,
    /// Whole turns that a modulo axis does not show, deg.
    wound: f64,
    /// It came out of 0 to 360 deg by no absolute word: which angle the control shows, is open.
    left: bool,
    /// It was sent to a place of the machine.
    sent: bool,
}

impl StandingAxis {
    /// A word turns it; whether by half a turn, the shorter way.
    fn turn(&mut self, turn: AxisTurn, turning: Turning<'_>) -> Result<bool, AxisFault> {
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
                    // It stands there: what the arithmetic leaves is no turn.
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

/// Where the rotary axes stand.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Standing {
    axes: Vec<StandingAxis>,
    before: Vec<Option<f64>>,
    /// A word stated an angle.
    any: bool,
    /// A direction of the tool says since then how they stand.
    by_direction: bool,
    /// An axis turns by half a turn in the block, the shorter way.
    halved: Option<char>,
    /// The fault of these angles that was reported.
    reported: Option<String>,
}

impl Standing {
    /// Of axes that count as it is shown of them.
    pub(crate) fn of_letters(letters: &[char], shown: &[CountShown]) -> Self {
        let axis = |(place, letter): (usize, &char)| StandingAxis {
            letter: *letter,
            at: None,
            count: shown
                .get(place)
                .map_or(AxisCount::Open, |shown| shown.count()),
            shown: CountShown::default(),
            wound: 0.0,
            left: false,
            sent: false,
        };
        let axes: Vec<StandingAxis> = letters.iter().enumerate().map(axis).collect();
        Self {
            before: vec![None; axes.len()],
            axes,
            ..Self::default()
        }
    }

    /// The place of a letter among the axes.
    pub(crate) fn place_of_letter(&self, letter: u8) -> Option<usize> {
        let mut axes = self.axes.iter();
        axes.position(|axis| axis.letter == char::from(letter))
    }

    /// A block begins.
    pub(crate) fn begin_block(&mut self) {
        self.before = self.axes.iter().map(|axis| axis.at).collect();
        self.halved = None;
    }

    /// What the words so far show of how the axes count.
    pub(crate) fn shown(&self) -> Vec<CountShown> {
        self.axes.iter().map(|axis| axis.shown).collect()
    }

    /// A word turns an axis.
    pub(crate) fn turn_axis(
        &mut self,
        place: usize,
        turn: AxisTurn,
        turning: Turning<'_>,
    ) -> Result<(), AxisFault> {
        let Some(axis) = self.axes.get_mut(place) else {
            return Ok(());
        };
        self.any = true;
        if self.by_direction {
            // The other axes stand where the direction has brought them.
            self.by_direction = false;
        }
        if axis.turn(turn, turning)? {
            self.halved = Some(axis.letter);
        }
        Ok(())
    }

    /// A word of SINUMERIK turns an axis that counts from 0 to 360 deg.
    pub(crate) fn show_one_turn(&mut self, place: usize) {
        if let Some(axis) = self.axes.get_mut(place) {
            axis.shown.one_turn = true;
        }
    }

    /// An axis is sent to a place of the machine: where it stands is not known.
    pub(crate) fn send_axis(&mut self, place: usize) {
        if let Some(axis) = self.axes.get_mut(place) {
            (axis.at, axis.wound, axis.left, axis.sent) = (None, 0.0, false, true);
        }
    }

    /// A direction of the tool says how the axes stand.
    pub(crate) fn take_direction_instead(&mut self) {
        for axis in &mut self.axes {
            (axis.at, axis.wound, axis.left, axis.sent) = (None, 0.0, false, false);
        }
        self.by_direction = true;
    }

    fn leaning(angles: &[Option<f64>]) -> Option<(usize, f64)> {
        let mut all = angles.iter().enumerate();
        all.find_map(|(place, angle)| Some((place, angle.filter(|a| a.abs() > ZERO_DEG)?)))
    }

    fn angles_now(&self) -> Vec<Option<f64>> {
        self.axes.iter().map(|axis| axis.at).collect()
    }

    /// Whether an axis turns in the block, as far as it is known.
    pub(crate) fn is_turning(&self) -> bool {
        let both = self.axes.iter().zip(&self.before);
        let mut both = both.filter_map(|(axis, before)| axis.at.zip(*before));
        both.any(|(now, before)| now != before)
    }

    /// Whether the block does not end, in the part, where its places say; `tip` where they are those of the tool's tip.
    pub(crate) fn loses_place(&self, tip: bool) -> bool {
        let now = self.angles_now();
        match tip {
            true => self.any && !self.by_direction && now.contains(&None),
            false => Self::leaning(&now)
                .or(Self::leaning(&self.before))
                .is_some(),
        }
    }

    /// Why a block cannot cut, once for angles that stay.
    pub(crate) fn no_cut(&mut self, tip: bool, words: &TipWords) -> Option<AxisFault> {
        let found = self.why_no_cut(tip, words);
        let reason = found.as_ref().map(|(reason, _)| reason.clone());
        let again = reason.is_some() && reason == self.reported;
        self.reported = reason;
        found.filter(|_| !again)
    }

    /// The last cut was refused.
    pub(crate) fn is_refused(&self) -> bool {
        self.reported.is_some()
    }

    fn why_no_cut(&self, tip: bool, words: &TipWords) -> Option<AxisFault> {
        let TipWords {
            control,
            rapid,
            zero,
            ..
        } = words;
        let now = self.angles_now();
        if !tip {
            if let Some(axis) = self.axes.iter().find(|axis| axis.sent) {
                let letter = axis.letter;
                return Some((
                    format!(
                        "axis {letter} was sent to a place of the machine, and tool centre point control is off: where the tip is in the part is not known"
                    ),
                    format!(
                        "turn it back with an absolute word ({rapid}{letter}{zero}) before the cut, or let the CAM system write places of the tool's tip in the part ({control})"
                    ),
                ));
            }
            let (place, angle) = Self::leaning(&now).or(Self::leaning(&self.before))?;
            return Some((
                format!(
                    "axis {} stands at {angle} deg, and tool centre point control is off: X, Y and Z are places of the machine's slides",
                    self.axes[place].letter
                ),
                format!(
                    "let the CAM system write places of the tool's tip in the part ({control})"
                ),
            ));
        }
        if let Some(letter) = self.halved {
            return Some((
                format!(
                    "axis {letter} turns by half a turn, and which way is the shorter one is open"
                ),
                "let the CAM system write an angle between".to_owned(),
            ));
        }
        if !self.any || self.by_direction {
            return None;
        }
        let all = [&now, &self.before];
        let open = all
            .iter()
            .find_map(|angles| angles.iter().position(Option::is_none))?;
        let letter = self.axes[open].letter;
        Some((
            format!("where axis {letter} stands is not stated before this block cuts"),
            format!("state it with a rapid and an absolute word ({rapid}{letter}{zero}) before it"),
        ))
    }

    /// What is noted of a motion; nothing where a direction says how the tool stands.
    pub(crate) fn of_motion(&self, tip: bool) -> Option<AxesStated> {
        if self.axes.is_empty() || self.by_direction {
            return None;
        }
        let now: Option<Vec<f64>> = self.angles_now().into_iter().collect();
        Some(match now.filter(|_| tip) {
            Some(end) => {
                let start = self.before.iter().zip(&end);
                AxesStated::Angles {
                    start: start.map(|(start, end)| start.unwrap_or(*end)).collect(),
                    end,
                }
            }
            None => AxesStated::Open,
        })
    }
}
