//! Springs at the end of a chain while its coordinates are eliminated.

use crate::linalg::saddle::RANK_TOLERANCE;

/// A spring at the end of a chain while its coordinates are eliminated, and what may be lost.
#[derive(Clone, Copy)]
pub struct EndSpring {
    /// Share of the chain's own stiffness.
    pub share: f64,
    /// The share of the largest compliance that the smallest one counts as.
    pub least: f64,
    /// Pivots below this share of what they come from are lost (of forms that are not symmetric).
    pub pivot: f64,
    /// A residual larger than this share of what is scaled shows that a pivot was too small.
    pub lost: f64,
}

impl EndSpring {
    /// A share of the chain's own stiffness in all directions that yield.
    const fn as_stiff(share: f64) -> Self {
        Self {
            share,
            least: 1e-7,
            pivot: 10.0 * RANK_TOLERANCE,
            lost: 1e-8,
        }
    }

    /// Soft along what hardly yields: where that is worlds stiffer than all the rest, the rest would
    /// drown in it. Good enough for a step of Newton's method, whose residual is checked.
    const fn soft(share: f64, least: f64) -> Self {
        Self {
            share,
            least,
            pivot: 1e-3 * RANK_TOLERANCE,
            lost: 1e-5,
        }
    }
}

/// Springs at the end that are tried one after the other.
pub const END_SPRINGS: [EndSpring; 3] = [
    EndSpring::as_stiff(1.0),
    EndSpring::as_stiff(0.17),
    EndSpring::as_stiff(5.3),
];

/// End springs for a step of Newton's method, whatever the ratio of the stiffnesses.
pub(crate) const STEP_SPRINGS: [EndSpring; 5] = [
    END_SPRINGS[0],
    END_SPRINGS[1],
    END_SPRINGS[2],
    EndSpring::soft(1.0, 1e-2),
    EndSpring::soft(0.03, 1e-3),
];
