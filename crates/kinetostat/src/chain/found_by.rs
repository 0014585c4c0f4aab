//! Method by which an equilibrium was found, which tells if a load that grows from rest leads to it.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Method by which an equilibrium was found. Where several equilibria exist, it tells which of them this is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum FoundBy {
    /// Newton's iteration from the commanded posture, or from the state that was given.
    #[default]
    Directly,
    /// Newton's iteration from a posture slightly out of line, as a straight or flat one has no linear answer.
    OutOfLine,
    /// The load grew from rest in steps.
    GrowingLoad,
    /// Newton's iteration from another start, far from the commanded posture.
    OtherStart,
    /// A curve of equilibria was followed to it.
    Continuation,
    /// Damped steps, as limbs do not hold the platforms in all directions.
    Relaxation,
}

impl FoundBy {
    /// Returns the method, unless the equilibrium was found directly.
    ///
    /// ```
    /// use kinetostat::chain::FoundBy;
    ///
    /// assert_eq!(FoundBy::Directly.unless_directly(), None);
    /// assert_eq!(FoundBy::OtherStart.unless_directly(), Some(FoundBy::OtherStart));
    /// ```
    #[must_use]
    pub fn unless_directly(self) -> Option<Self> {
        (self != Self::Directly).then_some(self)
    }

    /// The equilibrium may lie on another branch than the one to which a load leads that grows from rest.
    #[must_use]
    pub fn may_be_another_branch(self) -> bool {
        matches!(self, Self::OutOfLine | Self::OtherStart)
    }

    /// Explains the method, in a sentence without its full stop.
    #[must_use]
    pub fn sentence(self) -> &'static str {
        match self {
            Self::Directly => "the equilibrium was found directly from the commanded posture",
            Self::OutOfLine => {
                "the equilibrium was found from a posture slightly out of line: of shapes that mirror each other it is one"
            }
            Self::GrowingLoad => {
                "the equilibrium was found with a load that grew from rest in steps: it is the one to which that load leads"
            }
            Self::OtherStart => {
                "the equilibrium was found from another start, after a load that grows from rest was lost: it may lie on another branch than the one to which that load leads"
            }
            Self::Continuation => "the equilibrium was found along a curve of equilibria",
            Self::Relaxation => {
                "the machine is under-constrained, and the equilibrium is the nearest one on the way from the commanded posture: there may be others farther away"
            }
        }
    }
}
