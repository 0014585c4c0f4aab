//! The kinetostat command.
fn main() {}
