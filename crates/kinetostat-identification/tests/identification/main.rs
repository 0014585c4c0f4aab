//! Tests of the identification against the reference values.

mod active_set;
mod bodies;
mod candidates;
mod compensator;
mod cone;
mod design;
mod design_refusals;
mod fanuc;
mod generator;
mod geometry;
mod joints;
mod link_problem;
mod links;
mod machines;
mod regressors;
mod support;
mod tables;
mod work;
