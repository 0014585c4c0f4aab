//! From a machining program and a robot model to deflections, corrections and a checked result.
