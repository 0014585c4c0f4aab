//! The page that shows a machine in three dimensions, and its server on this computer.
//!
//! ```text
//! page     the page as one file, alone or with results in it
//! server   routes: the page, and the JSON of an implementation of Answers
//! guard    who may ask: this computer, from this page, in bounded size and time; refused: the answer to others
//! ```
//!
//! No file is served and none is read: the page is part of the program, so that there is no path to climb out of.

mod guard;
mod page;
mod refused;
mod server;

pub use page::{PAGE, exported};
pub use refused::Refused;
pub use server::{Answers, ServeError, Server};
