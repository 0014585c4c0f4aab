//! Programs in the language of a robot: which it is, what the job file and options say of them, and reading them.
//!
//! [`source`] finds the files (those that it calls: [`called_files`], parts of a divided one: [`parts`], [`divided`]), [`read_program`] reads them once ([`read_once`]) and
//! makes their path, [`frames`] are the tool and the work object that the program states, for the machine of the run,
//! [`configuration`] compares the arm's with that of the run, [`joint_arm`] gives a table of joint values its arm
//! ([`row_limits`]: rows that this arm does not reach).

pub(crate) mod called_files;
pub(crate) mod configuration;
pub(crate) mod divided;
pub(crate) mod first_place;
mod folder;
pub(crate) mod frame_distance;
pub(crate) mod frames;
pub(crate) mod joint_arm;
pub(crate) mod machine;
pub(crate) mod parts;
pub(crate) mod read_once;
pub(crate) mod read_program;
pub(crate) mod settings;
pub(crate) mod source;
pub(crate) mod system_frames;
