//! A generator of programs that knows where each of them goes, and a reader of programs that shares
//! no code with the crate. Both are deliberately plain.

mod arcs;
pub mod generator;
mod motions;
pub mod operations;
pub mod plain_reader;
mod run;
pub mod truth;

/// Origins of G54 and G55 in mm.
pub const WORK: [[f64; 3]; 2] = [[0.0, 0.0, 0.0], [12.345, -7.5, 3.25]];
pub const START: [f64; 3] = [1.0, 2.0, 3.0];
/// The machine's zero in the part frame, its two reference points in machine coordinates, and the lengths of its
/// tools, in mm: what the reader may be told or not, and the machine knows.
pub const MACHINE_ZERO: [f64; 3] = [-210.5, 133.25, 310.0];
pub const REFERENCES: [[f64; 3]; 2] = [[12.5, -3.0, 7.75], [-40.0, 25.5, -1.5]];
pub const LENGTHS: [f64; 3] = [0.0, 61.25, 87.5];
