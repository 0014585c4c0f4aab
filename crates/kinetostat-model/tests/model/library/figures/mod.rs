//! What the library is measured by.

mod agreement;
mod arms;
mod closed_forms;
mod gravity;
mod internal;
mod postures;
mod unstable;
