//! The only module that prints. Results go to the standard output, everything about them to the
//! standard error; with `--json` the text for people goes there too.

use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use clap::error::ErrorKind as ClapKind;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_model::shortened;

use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::host;
pub(crate) use crate::ui::host::Stream;
use crate::ui::safe_text::safe;

/// True once something stands on the standard output.
static HAS_PRINTED: AtomicBool = AtomicBool::new(false);

/// True if the command has printed something on the standard output.
pub(crate) fn has_printed() -> bool {
    match host::current() {
        Some(host) => host.has_printed(),
        None => HAS_PRINTED.load(Ordering::Relaxed),
    }
}

/// Prints text without a line break after it. That the reader has closed the pipe is no failure.
pub(crate) fn print(stream: Stream, text: &str) -> Answer<()> {
    if let Some(host) = host::current() {
        host.take(
            stream,
            anstream::adapter::strip_str(text).to_string().as_bytes(),
        );
        return Ok(());
    }
    let result = match stream {
        Stream::Out => {
            HAS_PRINTED.store(true, Ordering::Relaxed);
            write(&mut anstream::stdout().lock(), text.as_bytes())
        }
        Stream::Err => write(&mut anstream::stderr().lock(), text.as_bytes()),
    };
    unless_closed(result)
}

/// Prints bytes to the standard output without looking at them.
pub(crate) fn print_bytes(bytes: &[u8]) -> Answer<()> {
    if let Some(host) = host::current() {
        host.take(Stream::Out, bytes);
        return Ok(());
    }
    HAS_PRINTED.store(true, Ordering::Relaxed);
    unless_closed(write(&mut std::io::stdout().lock(), bytes))
}

fn write(to: &mut dyn Write, bytes: &[u8]) -> std::io::Result<()> {
    to.write_all(bytes)?;
    to.flush()
}

fn unless_closed(result: std::io::Result<()>) -> Answer<()> {
    match result {
        // The reader has seen enough (`| head`): that is no failure.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(ErrorCode::Output.failure(format!(
            "the standard output cannot be written: {}",
            crate::ui::system_error::description(&error)
        ))),
        Ok(()) => Ok(()),
    }
}

/// Tells why the command ends. Nothing can be done if even that fails.
pub(crate) fn complain(failure: &Failure) {
    if let Some(host) = host::current() {
        host.take(
            Stream::Err,
            format!("error: {}\n", failure.plain).as_bytes(),
        );
        return;
    }
    let mut to = anstream::stderr().lock();
    let text = match &failure.styled {
        // anstream takes the colours out where the terminal has none.
        Some(styled) => format!("{styled}\n"),
        None => format!("\u{1b}[1;31merror\u{1b}[0m: {}\n", failure.plain),
    };
    let _ = write(&mut to, text.as_bytes());
}

/// Tells what is wrong with a command line, in the words of its reader; a word of kilobytes is cut.
pub(crate) fn complain_of_line(error: &clap::Error) {
    let requested = matches!(
        error.kind(),
        ClapKind::DisplayHelp
            | ClapKind::DisplayVersion
            | ClapKind::DisplayHelpOnMissingArgumentOrSubcommand
    );
    let whole = error.render().to_string();
    let text = shortened(&safe(&whole));
    if let Some(host) = host::current() {
        let stream = if error.use_stderr() {
            Stream::Err
        } else {
            Stream::Out
        };
        host.take(stream, if requested { &whole } else { &text }.as_bytes());
        return;
    }
    let _ = match requested || text == whole {
        true => error.print(),
        false => write(&mut anstream::stderr().lock(), text.as_bytes()),
    };
}

/// True if a person watches the standard error.
pub(crate) fn watched() -> bool {
    host::current().is_none() && std::io::stderr().is_terminal()
}
