//! What the library is measured by.

mod agreement;
mod postures;
