//! Exact stability of a regenerative cut: multipliers of the monodromy operator, and the depths between which it is stable.
//!
//! `legendre` has the points of a stretch of the period, split where teeth come and go, and solves one mode on it; `states` has the modes;
//! `period` puts modes and stretches together, and says how many points they take; `operator` is the monodromy operator at a depth;
//! `eigenvalues` finds its largest multiplier; `scan` looks along the depth; `swinging` selects the modes that contribute, and `counted`
//! checks them. Source: `dynamics.md` section 10 [D 8].

mod counted;
mod eigenvalues;
mod legendre;
mod multiplier;
mod operator;
mod period;
mod regeneration;
mod scan;
mod states;
mod swinging;

pub(crate) use eigenvalues::{by_qr, eigenvalues};
pub(crate) use legendre::Chebyshev;
pub use multiplier::{Crossing, Instability, Multiplier, SpeedStability};
pub use regeneration::Regeneration;
pub use swinging::{LeftOut, Swinging};
