//! CSV as people have it: delimiter by the header, byte-order mark, CRLF, comments, decimal comma beside `;`.
//!
//! One pass, bounded memory: a dwell becomes its histogram and block means as it is read. What is not
//! understood is refused with file, line, column and remedy; nothing is guessed.

mod averaged;
mod header;
mod lines;
mod number;
mod raw;
mod row;
mod run_file;
mod stream;

pub(crate) use run_file::{Dwell, RunFileOptions, read_run_file};
pub use stream::{CodeStream, CodeStreamError, Reading};
