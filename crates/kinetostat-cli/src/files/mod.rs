//! Files that a command reads and writes.
//!
//! It takes paths and gives bytes, models and refusals in words; outputs are written beside their targets and put
//! in place together, or not at all ([`outputs`], [`journal`]). It knows nothing of what is in them.

pub(crate) mod answer_files;
pub(crate) mod csv_text;
pub(crate) mod file_kind;
pub(crate) mod file_names;
pub(crate) mod hash;
pub(crate) mod held_folder;
pub(crate) mod input_files;
pub(crate) mod journal;
pub(crate) mod made_folder;
pub(crate) mod origin;
pub(crate) mod outputs;
pub(crate) mod paths;
pub(crate) mod standard_input;
pub(crate) mod table_text;
