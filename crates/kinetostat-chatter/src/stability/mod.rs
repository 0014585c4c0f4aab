//! Exact stability of a regenerative cut: multipliers of the monodromy operator, and the depths between which it is stable.
//!
//! `collocation` has the points of a stretch of the period, split where teeth come and go; `states` has the modes, `legendre` solves one on it,
//! `resolution` says how many points; `cutting` puts the modes together, `period` the stretches; `operator` is the monodromy operator at a depth; `krylov` finds
//! its largest multiplier, with `followed` and `eigenvalues`; `scan` looks along the depth, which `along` goes, for `limits`; `swinging` says which modes count,
//! `counted` sees to it that they do. Source: `dynamics.md` section 10 [D 8].

mod along;
mod collocation;
mod counted;
mod eigenvalues;
mod krylov;
mod legendre;
mod limits;
mod multiplier;
mod operator;
mod period;
mod regeneration;
mod resolution;
mod scan;
mod states;
mod swinging;

pub use limits::{Crossing, SpeedStability};
pub use multiplier::{Instability, Multiplier};
pub use regeneration::Regeneration;
pub use swinging::{LeftOut, Swinging};

pub(crate) use collocation::Chebyshev;
pub(crate) use eigenvalues::{by_qr, eigenvalues};
