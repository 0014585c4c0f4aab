//! The program of a robot as a path that is divided, solved and corrected like one in G-code.
//!
//! [`of_program`] makes the path of a program of the moves of its motions ([`maker`]) unless [`motion_faults`] finds some
//! that cannot stand in one, [`axis_turns`] says how the tool stands
//! where the text states its axis alone, [`turned_by_correction`] refuses corrections by which it would be lost, [`correctable`] writes corrections of the path as pieces of motions and reads them again,
//! [`motion_faults`] says all that keeps a program from that,
//! and [`read_again`] with [`kept_lines`] checks what was read.

pub(crate) mod axis_angles;
pub(crate) mod axis_turns;
pub(crate) mod correctable;
pub(crate) mod fault;
pub(crate) mod header;
pub(crate) mod kept_lines;
pub(crate) mod maker;
pub(crate) mod motion_faults;
pub(crate) mod of_program;
pub(crate) mod path_warnings;
pub(crate) mod read_again;
pub(crate) mod tools;
pub(crate) mod turned_by_correction;
