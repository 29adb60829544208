//! One file a command.

pub(crate) mod certify;
pub(crate) mod check;
pub(crate) mod compensate;
pub(crate) mod init;
pub(crate) mod simulate;

use std::io::Write as _;

use crate::exit::{Exit, complain};

/// Prints data on standard output. A reader that closed early (`| head`) has what it wanted.
pub(crate) fn print(text: &str) -> Exit {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Ok(()) => Exit::Ok,
        Err(e) if e.kind() == std::io::ErrorKind::BrokenPipe => Exit::Ok,
        Err(e) => {
            complain(e);
            Exit::Failure
        }
    }
}
