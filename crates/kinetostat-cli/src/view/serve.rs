//! The page from a server on this computer.

use std::sync::Arc;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_view::{ServeError, Server};

use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::host;
use crate::ui::screen::{self, Stream};
use crate::view::served::Served;

impl From<ServeError> for Failure {
    fn from(error: ServeError) -> Self {
        ErrorCode::Value.failure(format!("{error}; give another --port, or none"))
    }
}

/// Serves the page until the process ends; `words` say what it shows, `state` is what it shows first.
pub(super) fn serve(
    port: Option<usize>,
    opens_browser: bool,
    served: Served,
    words: &str,
    state: &str,
) -> Answer<()> {
    if host::current().is_some() {
        return Err(ErrorCode::NotBuiltIn.failure(
            "view serves its page from the command line only: kinetostat view; or write it as a file (export)",
        ));
    }
    let port = u16::try_from(port.unwrap_or(0))
        .map_err(|_| ErrorCode::Value.failure("--port: 0 to 65535"))?;
    let server = Server::listen(port)?;
    let url = match state {
        "" => server.url(),
        _ => format!("{}#state={state}", server.url()),
    };
    screen::print(Stream::Out, &format!("{words}: {url}\nCtrl-C ends it.\n"))?;
    if opens_browser && open::that_detached(&url).is_err() {
        screen::print(
            Stream::Err,
            "no browser could be opened: open the address above in one\n",
        )?;
    }
    Ok(server.serve(Arc::new(served))?)
}

/// A text as part of an address.
pub(super) fn in_url(text: &str) -> String {
    let byte = |b: u8| match b.is_ascii_alphanumeric() || b"-_.~,:".contains(&b) {
        true => char::from(b).to_string(),
        false => format!("%{b:02X}"),
    };
    text.bytes().map(byte).collect()
}
