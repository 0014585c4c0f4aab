//! Coordinates that the program shifts, scales, mirrors or turns: G52, G50 and G51, G50.1 and G51.1, G68 and G69 (Fanuc).
//!
//! Takes blocks of plain words; gives blocks whose places are those of the machine's own coordinates. In parallel with the flat
//! program the blocks are run as they are programmed: that run knows the modes and the programmed places. Source: Fanuc,
//! Operator's Manual B-63534EN, sections 7.3 (G52), 14.6 (G68) and 14.8 (G51); Haas, Mill Operator's Manual, G50 to G52, G68,
//! G69.

pub(crate) mod map;
pub(crate) mod stage;
