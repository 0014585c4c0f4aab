//! Assignment of measured points to places of the path.
//!
//! Both rules look no farther than a window: the tool leaves its path by no more. Places within it belong to one stretch where
//! the path between them is no longer than four windows; stretches that come by a second time are others: the neighbouring
//! line of a zigzag, the end of a contour beside its start, the pass before.
//!
//! - **Nearest** ([`Alignment::Nearest`]): the nearest place of the only stretch within the window. A point with several is
//!   not given to any of them: it is named and left out. A `line` in the measurement tells them apart.
//! - **Along the arc length** ([`Alignment::ArcLength`]): points in the order in which the tool went. Of all ways through the
//!   stretches along which no foot goes back by more than a window, that with the least sum of `(d / window)^2` and
//!   `((way along the path - way between the points) / (way between the points + window))^2`, the latter 4 at most (a
//!   rapid between passes was not measured). Found as the shortest way through a graph (Viterbi 1967), not point by point.
//!
//! A deviation is measured from its foot and is that part of it which is across the path: how far the tool has come along it
//! is not seen.

mod choose;

pub(crate) use choose::align;
pub use choose::{AlignedPoint, Alignment, LeftOut};
