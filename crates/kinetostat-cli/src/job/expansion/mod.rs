//! A program of a command, run once and written flat: the options and the table `[expand]` that say how, the files of its
//! subprograms, and which lines the flat ones came from.
//!
//! Takes the bytes of a program and what options and job file say of its expansion; gives the flat program with the files that
//! were read. The running itself is in the crate `kinetostat-program`.

pub(crate) mod advice;
pub(crate) mod arguments;
pub(crate) mod flat;
pub(crate) mod folders;
pub(crate) mod settings;
