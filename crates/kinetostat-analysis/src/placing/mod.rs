//! Optimal placement of a part in a machine: minimises a figure of the whole program over the part's place and
//! rotation.
//!
//! A [`Space`] says where the part may lie (ranges of its place and of its turns, or a list of fixtures), a [`Question`] what counts
//! ([`Objective`]) and what must be kept clear of ([`Obstacle`]). [`place`] looks everywhere by a sequence that fills
//! the space evenly, refines the best distinct placements without derivatives, and checks every answer at all places of
//! the program. Numbers of threads change nothing of it.

mod answer;
mod evaluate;
mod refine;
mod search;
mod sensitivity;
mod space;
mod value;

pub use answer::{
    Candidate, Evaluated, Finding, MapPanel, Nowhere, Placed, Sensitivity, SideSensitivity,
};
pub use evaluate::{Obstacle, PartBox, Question};
pub use search::{Effort, place};
pub use space::{Fixture, Place, Range, Space, SpaceError, Variable};
pub use value::{Objective, Refusal, Value, Why};
