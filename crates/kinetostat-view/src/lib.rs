//! The page that shows a machine in three dimensions, and its server on this computer.
//!
//! ```text
//! page     the page as one file, alone or with results in it
//! answers  what the page asks; refused: that it gets no answer
//! server   routes: the page, and the JSON of an implementation of Answers
//! guard    who may ask: this computer, from this page, in bounded size and time; problem: the answer to others
//! ```
//!
//! Without the feature `server` there are only the page and its results, as reports hold them.
//!
//! No file is served and none is read: the page is part of the program, so that there is no path to climb out of.

mod answers;
#[cfg(feature = "server")]
mod guard;
mod page;
#[cfg(feature = "server")]
mod problem;
mod refused;
#[cfg(feature = "server")]
mod server;

pub use answers::{Answers, OPEN};
pub use page::{PAGE, exported};
pub use refused::Refused;
#[cfg(feature = "server")]
pub use server::{ServeError, Server};
