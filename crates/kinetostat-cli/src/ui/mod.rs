//! How the command speaks: text at 80 columns, exit codes, progress and Ctrl-C. It knows nothing of
//! machines or files.

pub(crate) mod background;
pub(crate) mod failure;
pub(crate) mod progress;
pub(crate) mod screen;
