//! The ranges of six turning joints: which of their values that are whole turns apart are inside their limits.

use std::f64::consts::{PI, TAU};

use kinetostat::number::larger;

use crate::free_turn::serial::Joints;

/// Values of a joint that are whole turns apart are tried so far from the middle of its range, rad.
const MOST_TURNS: f64 = 3.0 * TAU;

/// Limits of six turning joints, and how far they are kept from them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointRanges {
    /// rad; a joint without limits turns on and on.
    pub limits: [Option<(f64, f64)>; 6],
    /// rad.
    pub margin: f64,
}

impl JointRanges {
    /// Limits of a joint less what is kept from them, rad.
    fn range(&self, joint: usize) -> (f64, f64) {
        self.limits[joint].map_or((f64::NEG_INFINITY, f64::INFINITY), |(low, high)| {
            (low + self.margin, high - self.margin)
        })
    }

    /// A joint without limits turns on and on.
    pub fn is_free(&self, joint: usize) -> bool {
        self.limits[joint].is_none()
    }

    /// Values of a joint, rad: those inside its limits that are whole turns apart, or the one within half a turn of zero.
    fn values_of(&self, joint: usize, angle: f64) -> impl Iterator<Item = f64> + use<> {
        let (low, high) = match self.is_free(joint) {
            true => (-PI, PI),
            false => self.range(joint),
        };
        // A joint of a very large range is restricted to the turns around its middle.
        let middle = 0.5 * (low + high);
        let (low, high) = (low.max(middle - MOST_TURNS), high.min(middle + MOST_TURNS));
        let first = angle + TAU * ((low - angle) / TAU).ceil();
        let free = self.is_free(joint);
        (0..)
            .map(move |turn| first + TAU * f64::from(turn))
            .take_while(move |value| *value <= high)
            .take(match free {
                true => 1,
                false => usize::MAX,
            })
    }

    /// All combinations of whole turns.
    pub fn on_turns(&self, joints: &Joints, mut each: impl FnMut(Joints)) {
        let values: Vec<Vec<f64>> = (0..6)
            .map(|joint| self.values_of(joint, joints[joint]).collect())
            .collect();
        let count: usize = values.iter().map(Vec::len).product();
        for number in 0..count {
            let mut rest = number;
            let mut on = *joints;
            for joint in 0..6 {
                on[joint] = values[joint][rest % values[joint].len()];
                rest /= values[joint].len();
            }
            each(on);
        }
    }

    /// Share of half its range by which the joint nearest to a limit is off the middle.
    pub fn share_of_range(&self, joints: &Joints) -> f64 {
        let limits = self.limits.iter().zip(joints);
        let shares = limits.filter_map(|(limits, angle)| {
            let (low, high) = (*limits)?;
            Some((angle - 0.5 * (low + high)).abs() / (0.5 * (high - low)))
        });
        shares.fold(0.0, larger)
    }

    /// The joint nearest to a limit and how far it is from it, rad.
    pub fn nearest_limit(&self, joints: &Joints) -> Option<(usize, f64)> {
        let limits = self.limits.iter().zip(joints).enumerate();
        let far = limits.filter_map(|(joint, (limits, angle))| {
            let (low, high) = (*limits)?;
            Some((joint, (angle - low).min(high - angle)))
        });
        far.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// True if a joint can be at an angle, or whole turns from it.
    pub fn reaches(&self, joint: usize, angle: f64) -> bool {
        self.values_of(joint, angle).next().is_some()
    }

    /// The first joint that is outside its range.
    pub fn left_by(&self, joints: &Joints) -> Option<usize> {
        (0..6).find(|joint| {
            let (low, high) = self.range(*joint);
            !(low..=high).contains(&joints[*joint])
        })
    }
}
