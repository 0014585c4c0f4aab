//! Figures without a derivative: the largest or least of several that are equal here.
//!
//! The share of the way to buckling is that of the limb, and of its shape, which is nearest to it; the stiffness against a force is that
//! of the softest direction. Where two of them are equal, a number that changes one and not the other changes the figure in another way
//! to each side, as `|x|` at zero. The difference of the two slopes is what `(f(h) + f(-h) - 2 f(0)) / h` tends to for small steps.

use crate::sensitivity::values::Values;

/// Figures without a derivative by a number: both one-sided derivatives differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sharp {
    /// Two limbs, or two shapes of a limb, are equally near to buckling.
    pub share_to_buckling: bool,
    /// Two directions are equally soft.
    pub stiffness_against_force: bool,
}

/// The figures at a step to either side.
pub(crate) struct Sides {
    pub step: f64,
    pub plus: Values,
    pub minus: Values,
}

/// Threshold of the difference of the slopes over a step relative to the figure: above rounding.
const OF_FIGURE: f64 = 1e-7;
/// Threshold of the difference of the slopes relative to the derivative.
const OF_DERIVATIVE: f64 = 1e-5;

impl Sharp {
    /// True if any of them has no derivative.
    #[must_use]
    pub fn any(&self) -> bool {
        self.share_to_buckling || self.stiffness_against_force
    }

    /// Detects kinks from the figures now and at steps `h`, `h / 2` and `h / 4`, with the derivatives by central
    /// differences.
    pub(crate) fn of(now: &Values, sides: &[Sides; 3], derivatives: &Values) -> Self {
        let is_sharp = |of: fn(&Values) -> f64| {
            let middle = of(now);
            let [a, b, c] = sides
                .each_ref()
                .map(|s| (of(&s.plus) + of(&s.minus) - 2.0 * middle) / s.step);
            // Removes the terms of first and third order in the step, which smooth figures have.
            let slopes = ((a - 10.0 * b + 16.0 * c) / 7.0).abs();
            slopes * sides[0].step > OF_FIGURE * middle.abs()
                && slopes > OF_DERIVATIVE * of(derivatives).abs()
        };
        Self {
            share_to_buckling: is_sharp(|v| v.share_to_buckling.unwrap_or(0.0)),
            stiffness_against_force: is_sharp(|v| v.stiffness_against_force),
        }
    }
}
