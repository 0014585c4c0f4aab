//! Cutting forces along a program, from the cut.
//!
//! Takes the motion of a program with its feeds and spindle words, tools with their materials, and where the tool is in the
//! material: the same everywhere, by lines, or from a stock that the program itself cuts. Gives force, moment, torque and power
//! at stations along the path, and what no such cut should be. Forces that were measured are laid along the path in their place
//! ([`crate::MeasuredForces`]): a log over time by the time that each move takes. Knows no machine: the load that comes of it is
//! [`crate::CuttingLoad::FromCut`].

pub(crate) mod clock;
pub(crate) mod finding;
pub(crate) mod force;
pub(crate) mod forces;
pub(crate) mod limits;
pub(crate) mod measured;
pub(crate) mod measured_stations;
pub(crate) mod profile;
pub(crate) mod question;
pub(crate) mod removal;
pub(crate) mod station;
pub(crate) mod walk;
