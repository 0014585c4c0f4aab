//! Modal state of the rotary axes of a machine, as far as a program states it, and the motions that it allows.
//!
//! Takes the words of SINUMERIK (A, B, C with AC, IC, DC, ACP, ACN) and Heidenhain (A, IA, ...) programs, gives angles that count on over
//! whole turns. The laws are those of G43.4: with tool centre point control a cut needs all angles; without it X, Y and Z are
//! places of the slides, and a cut is where the program says only with all axes at zero.

use crate::model::program::AxesStated;
use crate::turned_axis::{
    AxisFault, AxisTurn, CountShown, StandingAxis, TipWords, Turning, ZERO_DEG,
};

/// Modal state of the rotary axes.
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
    /// State of axes with the shown counting.
    pub(crate) fn of_letters(letters: &[char], shown: &[CountShown]) -> Self {
        let axis = |(place, letter): (usize, &char)| {
            StandingAxis::new(*letter, shown.get(place).copied().unwrap_or_default())
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

    /// Evidence of the words so far for the counting of the axes.
    pub(crate) fn shown_counts(&self) -> Vec<CountShown> {
        self.axes.iter().map(|axis| axis.shown).collect()
    }

    /// A word turns an axis.
    pub(crate) fn turn_axis(
        &mut self,
        place: usize,
        turn: AxisTurn,
        turning: Turning<'_>,
    ) -> Result<(), AxisFault> {
        self.leave_direction();
        let Some(axis) = self.axes.get_mut(place) else {
            return Ok(());
        };
        self.any = true;
        if axis.take_turn(turn, turning)? {
            self.halved = Some(axis.letter);
        }
        Ok(())
    }

    /// Turn of an axis by an absolute word, direct and by the shorter way, if they differ.
    pub(crate) fn readings_of(&self, place: usize, to: f64) -> Option<[f64; 2]> {
        self.axes.get(place)?.readings_of(to)
    }

    /// A word of SINUMERIK turns an axis that counts from 0 to 360 deg.
    pub(crate) fn show_one_turn(&mut self, place: usize) {
        if let Some(axis) = self.axes.get_mut(place) {
            axis.shown.one_turn = true;
        }
    }

    /// A word turns an axis: the others stand where a direction of before has brought them.
    fn leave_direction(&mut self) {
        if std::mem::take(&mut self.by_direction) {
            self.any = true;
            for axis in &mut self.axes {
                axis.sent = true;
            }
        }
    }

    /// An axis is sent to a place of the machine: where it stands is not known.
    pub(crate) fn send_axis(&mut self, place: usize) {
        self.leave_direction();
        if let Some(axis) = self.axes.get_mut(place) {
            axis.be_anywhere();
            axis.sent = true;
        }
    }

    /// A direction of the tool says how the axes stand.
    pub(crate) fn take_direction_instead(&mut self) {
        for axis in &mut self.axes {
            axis.be_anywhere();
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

    /// True if an axis is known to turn in the block.
    pub(crate) fn is_turning(&self) -> bool {
        let both = self.axes.iter().zip(&self.before);
        let mut both = both.filter_map(|(axis, before)| axis.at.zip(*before));
        both.any(|(now, before)| now != before)
    }

    /// True if the block ends at another point of the part than its coordinates state; `tip` if they are those of the tool tip.
    pub(crate) fn loses_place(&self, tip: bool) -> bool {
        let now = self.angles_now();
        match tip {
            true => self.any && !self.by_direction && now.contains(&None),
            false => Self::leaning(&now)
                .or(Self::leaning(&self.before))
                .is_some(),
        }
    }

    /// Reason why a block cannot cut, reported once while the angles stay.
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
                        "axis {letter} was sent to a place of the machine, or turned with a direction of the tool, and tool centre point control is off: where the tip is in the part is not known"
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

    /// Rotary axis data of a motion; `None` if a direction defines the orientation.
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
