//! The rigid motion that brings measured points onto the path.
//!
//! 1. **Starts.** No motion, where the points lie about where the path is; the motion that brings points at shares of the way
//!    through them to the same shares of the path (points measured in order); the motions that bring principal axes onto those
//!    of the path; and, of points that lie elsewhere, all places of the path with the distances of three of them. Each is followed, and
//!    they compete by the root mean square of nine in ten distances, so that a fit of half of the points is none. Which is
//!    taken, and when none is: [`candidates`].
//! 2. **Closest points** (Besl and McKay 1992): every point goes with its foot on the path, the motion of all of them is found
//!    in closed form by quaternions (Horn 1987, which has no reflections and for points on a line turns no more than needed).
//! 3. **Distance from the path**: near the end the points may slide along the path (point-to-line distance, Chen and Medioni
//!    1992), by Gauss-Newton steps: quadratic where the points lie on the path. What the shape does not determine (an eigenvalue
//!    of the normal equations below 1e-6 of the largest, with turns as ways at the points' mean distance from their middle) is
//!    not moved.
//! 4. **Outliers**: a point beyond the window (how far the tool may be from its path) counts nothing in a step if it is farther than
//!    six standard deviations, too, taken from the distance that nine of ten points keep below (Rayleigh: 2.146 of one direction's
//!    deviation). When all others have come to rest, points within the window that are as far and that no neighbour bears out
//!    count nothing either. Others do: deviations are smooth, and a part of the path that lies off is no outlier.
//!
//! What it brings to nothing is not corrected: a shift or turn of the whole part is part of the registration. Points measured
//! in the frame of the program are not to be registered.

mod candidates;
mod closest;
mod motion;
mod search;
mod starts;

pub use candidates::ToldBy;
pub use closest::RegistrationOptions;
pub(crate) use closest::of_the_same_size;
pub use motion::{FreeMotion, Motion};
pub use search::{Registration, register};
