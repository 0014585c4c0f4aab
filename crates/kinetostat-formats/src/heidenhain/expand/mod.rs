//! Programs that repeat, jump, count or drill by cycles: run once and written flat.
//!
//! From the values of Q parameters ([`values`]) and the blocks of drilling cycles ([`hole`]) to the files and their [`run`]:
//! [`flat`] is the way in and goes through the blocks, [`jumps`] say where it goes on, [`cycles`] and [`path_block`] what is drilled,
//! [`corners`] what is rounded, [`aside`] and [`centre_line`] where the tool goes beside a contour (RL, RR).

pub(crate) mod aside;
pub(crate) mod centre_line;
pub(crate) mod corners;
pub(crate) mod cycles;
pub(crate) mod flat;
pub(crate) mod hole;
pub(crate) mod jumps;
pub(crate) mod path_block;
pub(crate) mod run;
pub(crate) mod values;
