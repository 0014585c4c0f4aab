//! Parts of the crate that its interface does not show, each by itself.

mod departure;
mod irregular;
mod numbers;
mod words;
