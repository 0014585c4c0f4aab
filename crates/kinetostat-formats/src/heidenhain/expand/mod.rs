//! Programs that repeat, jump, count or drill by cycles: run once and written flat.
//!
//! From the files ([`program`]), the values of Q parameters ([`values`], [`expression`]) and the blocks of drilling cycles ([`hole`])
//! to the [`run`]: its [`steps`] go through the blocks, [`jumps`] say where it goes on, [`parameters`] what a block says,
//! [`cycles`] and [`path_block`] what is drilled, [`corners`] what is rounded, [`aside`] and [`centre_line`] where the tool goes beside a contour (RL, RR). The way in is [`flat`].

pub(crate) mod aside;
pub(crate) mod centre_line;
pub(crate) mod corners;
pub(crate) mod cycles;
pub(crate) mod expression;
pub(crate) mod flat;
pub(crate) mod hole;
pub(crate) mod jumps;
pub(crate) mod parameters;
pub(crate) mod path_block;
pub(crate) mod program;
pub(crate) mod run;
pub(crate) mod steps;
pub(crate) mod values;
