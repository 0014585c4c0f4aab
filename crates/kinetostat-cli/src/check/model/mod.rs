//! A model looked at: limbs, frames, home, reach, and the assumptions of the method.

mod assumptions;
pub(crate) mod findings;
mod frames;
mod home;
mod home_text;
mod limbs;
mod reach;
pub(crate) mod text;
