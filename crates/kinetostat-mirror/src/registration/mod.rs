//! The rigid motion that brings measured points onto the path.
//!
//! 1. **Starts.** No motion; the motion that brings points at shares of the way through them to the same shares of the path
//!    (points measured in order); the motions that bring principal axes onto those of the path. Each is followed, and the
//!    first of them is taken to which no other is clearly nearer. Points plainly in another frame start in their order.
//! 2. **Closest points** (Besl and McKay 1992): every point goes with its foot on the path, the motion of all of them is found
//!    in closed form by quaternions (Horn 1987, which has no reflections and for points on a line turns no more than needed).
//! 3. **Distance from the path**: near the end the points may slide along the path (point-to-line distance, Chen and Medioni
//!    1992), by Gauss-Newton steps: quadratic where the points lie on the path. What the shape does not determine (an eigenvalue
//!    of the normal equations below 1e-6 of the largest, with turns as ways at the points' mean distance from their middle) is
//!    not moved.
//! 4. **Outliers**: a point counts nothing in a step if it is farther from the path than six standard deviations, taken
//!    from the median distance (Rayleigh: median = 1.177 of one direction's deviation).
//!
//! What it brings to nothing is not corrected: a shift or turn of the whole part is part of the registration. Points measured
//! in the frame of the program are not to be registered.

mod closest;
mod free;
mod horn;
mod motion;
mod search;
mod starts;
mod step;

pub use motion::{FreeMotion, Motion};
pub use search::{Registration, RegistrationOptions, register};
