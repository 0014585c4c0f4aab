//! Parts of the crate that its interface does not show, each by itself.

mod envelope;
mod text;
