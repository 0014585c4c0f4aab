//! Parts of the crate that its interface does not show, each by itself.

mod formula;
mod machine;
mod mathml;
mod rounding;
