//! Exact stability of a regenerative cut: multipliers of the monodromy operator, and the depths between which it is stable.
//!
//! `collocation` has the points of a stretch of the period, split where teeth come and go; `states` has the modes, `legendre` solves one on it,
//! `resolution` says how many points; `cutting` puts the modes together, `period` the stretches; `operator` is the monodromy operator at a depth; `krylov` finds
//! its largest multiplier, with `followed` and `eigenvalues`; `scan` looks along the depth, which `along` goes, for `limits`; `swinging` says which modes count,
//! `counted` sees to it that they do. Source: `dynamics.md` section 10 [D 8].

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
