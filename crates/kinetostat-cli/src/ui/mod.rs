//! User interface of the command: the screen, text at 80 columns, numbers, progress, Ctrl-C and exit codes.
//!
//! It takes text, figures and errors of the libraries, and is the only folder that prints. It knows no command,
//! no file format and no machine; everything else may use it.

pub(crate) mod background;
pub(crate) mod csv_cell;
pub(crate) mod csv_table;
pub(crate) mod failure;
pub(crate) mod fault_list;
pub(crate) mod given;
pub(crate) mod host;
pub(crate) mod json;
pub(crate) mod language;
pub(crate) mod layout;
pub(crate) mod numbers;
pub(crate) mod progress;
pub(crate) mod result_form;
pub(crate) mod safe_text;
pub(crate) mod screen;
pub(crate) mod spelling;
pub(crate) mod system_error;
pub(crate) mod threads;
pub(crate) mod warnings;
