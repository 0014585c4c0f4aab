//! Internals for this crate's own tests, in `tests/reproduce/internal`. They are no part of the interface and may change
//! without notice.

use kinetostat::{Mechanism, Pose, Posture, model::LinkConvention};

use crate::orthoglide::bars::Barred;
use crate::orthoglide::machine::{Orthoglide, POINTS};
use crate::page::{formula, mathml};

pub use crate::orthoglide::machine::{cutting, target};

/// Q0 to Q4 of chapter 6 (m).
pub const CHAPTER_6_POINTS: [(&str, [f64; 3]); 5] = POINTS;

/// The machine of chapter 6.
///
/// # Panics
/// If it cannot be built.
#[must_use]
pub fn orthoglide() -> Mechanism {
    Orthoglide::default().build().expect("the machine")
}

/// Machine with two bars in the place of each parallelogram.
pub struct WithBars(Barred);

impl WithBars {
    /// Creates it at a target of the tool, each bar in one segment.
    ///
    /// # Panics
    /// If the target cannot be reached.
    #[must_use]
    pub fn new(target: &Pose, convention: LinkConvention) -> Self {
        Self(Barred::new(&Orthoglide::default(), target, convention, 1).expect("a machine"))
    }

    /// Commanded there.
    ///
    /// # Panics
    /// If the bars do not close there.
    #[must_use]
    pub fn posture(&self) -> Posture {
        self.0.posture().expect("a posture")
    }
}

/// A formula in plain characters, as HTML.
#[must_use]
pub fn formula_in_html(text: &str) -> String {
    formula::html(text)
}

/// Formula as MathML; `None` for other text.
#[must_use]
pub fn formula_in_mathml(text: &str) -> Option<String> {
    mathml::math(text)
}
