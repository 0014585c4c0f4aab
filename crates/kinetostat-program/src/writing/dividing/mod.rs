//! Division of a block so that straight pieces follow the corrected curve.
//!
//! The corrected curve of a move is `point(s) + c(s)`, `s` the share of its length. A piece from `a`
//! to `b` is good if `c` differs from the straight line between `c(a)` and `c(b)` by no more than the
//! tolerance; the whole vector is compared, so the bound holds along the path too.
//!
//! The field says where `c` or its slope may jump ([`Structure::breaks`](crate::Structure::breaks)): those places are ends of
//! stretches before anything else ([`beginning`]). Arcs that become straight pieces are divided by their chords as well; for those
//! to which arcs are fitted ([`crate::writing::fitting`]) the correction is only found out, and how far it bends matters little. A
//! stretch ([`stretch`]) is then evaluated in its middle, where the correction changes along it at a place that follows no pattern
//! too, and in the quarters where that does not decide it. It is good if
//!
//! - the polynomial through these values stays within the tolerance ([`crate::writing::departure`], a bound and
//!   no sample);
//! - the error of that polynomial is below a tenth of the tolerance: nothing for a field of third
//!   degree, Hermite's remainder for a smooth one;
//! - at the irregular place the polynomial agrees with the field.
//!
//! Otherwise it is halved ([`divide`]). Neighbouring pieces are joined again where the same bound allows it
//! ([`crate::writing::merge`]). All blocks are divided together, in rounds, so that the field is evaluated
//! in large batches.

pub(crate) mod beginning;
pub(crate) mod divide;
pub(crate) mod stretch;
