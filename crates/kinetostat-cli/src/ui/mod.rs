//! How the command speaks: text at 80 columns, exit codes, progress and Ctrl-C. It knows nothing of
//! machines or files.

pub(crate) mod background;
pub(crate) mod csv_cell;
pub(crate) mod failure;
pub(crate) mod fault_list;
pub(crate) mod json;
pub(crate) mod layout;
pub(crate) mod numbers;
pub(crate) mod progress;
pub(crate) mod safe_text;
pub(crate) mod screen;
pub(crate) mod spelling;
pub(crate) mod system_error;
pub(crate) mod threads;
pub(crate) mod warnings;
