//! Tests of kinetostat-cutting, one binary.

mod stock_engagement;
mod stock_inputs;
mod stock_paths;
mod stock_round;
mod stock_support;
mod stock_volume;
