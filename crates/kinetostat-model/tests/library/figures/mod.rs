//! What the library is measured by.

mod agreement;
mod arms;
mod gravity;
mod postures;
mod unstable;
