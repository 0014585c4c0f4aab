//! Tests of the dynamics: one binary, its subjects as modules.
#![allow(clippy::unwrap_used, missing_docs)]

mod arms;
mod beams;
mod circulatory;
mod common;
mod derivatives;
mod knee;
mod massless;
mod orthoglide;
mod platforms;
mod reduction;
mod responses;
mod swept;
