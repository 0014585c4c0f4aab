//! A model looked at: limbs, frames, home, reach, and the assumptions of the method.
//!
//! It takes a model and perhaps a force and gives [`findings::Findings`] with stable names; the files named `text`
//! put them into words.

mod assumptions;
pub(crate) mod findings;
mod frames;
mod home;
mod home_text;
mod limbs;
mod reach;
pub(crate) mod text;
