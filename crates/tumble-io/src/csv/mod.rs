//! CSV as people have it: delimiter by the header, byte-order mark, CRLF, comments, decimal comma beside `;`.
//!
//! One pass, bounded memory: a dwell becomes its histogram and block means as it is read. What is not
//! understood is refused with file, line, column and remedy; nothing is guessed.

mod averaged;
mod clock;
mod continuous;
mod dial;
mod dialect;
mod header;
mod lines;
mod number;
mod raw;
mod roles;
mod row;
mod run_file;
mod sketch;
mod stream;

pub use clock::TimeUnit;
pub(crate) use clock::date_s;
pub(crate) use dial::{AngleUnit, dms};
pub(crate) use dialect::{Delimiter, Dialect, Missing};
pub(crate) use header::{Columns, KNOWN, Mapping, decoded};
pub(crate) use lines::Lines;
pub(crate) use number::{CodeFormat, DecimalSign, integer, real, says_missing, trimmed};
pub(crate) use roles::{HeaderUnit, Role, role, split_unit};
pub(crate) use row::{FieldBuffer, Row};
pub(crate) use run_file::{Discard, Dwell, RunFileOptions, read_lines, read_run_file};
pub(crate) use sketch::{Sketch, sketch_file};
pub use stream::{CodeStream, CodeStreamError, Reading};
