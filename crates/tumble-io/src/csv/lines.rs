//! Lines of a stream in a buffer that is used again.

use std::io::Read;

use crate::error::{Place, Problem, ReadError};
use crate::source::Source;

/// Longest line. Data rows have tens of bytes.
const LONGEST_LINE: usize = 1 << 20;
const CHUNK: usize = 1 << 17;

/// Lines without their ends; comments and blank lines are left out.
pub(crate) struct Lines<R> {
    reader: R,
    shown_as: String,
    buffer: Vec<u8>,
    start: usize,
    end: usize,
    /// Where the line that was read last begins.
    line_start: usize,
    number: u64,
    at_end: bool,
    /// Beside `#`: what comments begin with.
    comment: Vec<u8>,
}

impl<R: Read> Lines<R> {
    pub(crate) fn new(reader: R, shown_as: &str) -> Self {
        Self {
            reader,
            shown_as: shown_as.to_owned(),
            buffer: vec![0; CHUNK],
            start: 0,
            end: 0,
            line_start: 0,
            number: 0,
            at_end: false,
            comment: Vec::new(),
        }
    }

    /// Lines that begin so are comments, too.
    pub(crate) fn with_comment(mut self, comment: &[u8]) -> Self {
        self.comment = comment.to_vec();
        self
    }

    /// The line of a number, whatever it holds; `None` where the file ends before it.
    pub(crate) fn line(&mut self, wanted: u64) -> Result<Option<&[u8]>, ReadError> {
        while self.number + 1 < wanted {
            if self.advance()?.is_none() {
                return Ok(None);
            }
        }
        Ok(self.advance()?.map(|(from, to)| &self.buffer[from..to]))
    }

    /// Leaves out all lines before a number.
    pub(crate) fn skip_to(&mut self, first: u64) -> Result<(), ReadError> {
        while self.number + 1 < first && self.advance()?.is_some() {}
        Ok(())
    }

    pub(crate) fn shown_as(&self) -> &str {
        &self.shown_as
    }

    pub(crate) fn into_inner(self) -> R {
        self.reader
    }

    /// The next line that is neither blank nor a comment, with its number.
    pub(crate) fn next_data(&mut self) -> Result<Option<(u64, &[u8])>, ReadError> {
        loop {
            let Some((from, to)) = self.advance()? else { return Ok(None) };
            // Nearly every line begins with a digit or a sign: one look decides.
            let line = &self.buffer[from..to];
            let data = match line.first() {
                Some(b'#') | None => false,
                Some(b) if b.is_ascii_whitespace() => self.is_data(line.trim_ascii_start()),
                Some(_) => self.comment.is_empty() || self.is_data(line),
            };
            if data {
                return Ok(Some((self.number, &self.buffer[from..to])));
            }
        }
    }

    /// Whether a line that begins without blanks is neither empty nor a comment.
    fn is_data(&self, line: &[u8]) -> bool {
        let own = !self.comment.is_empty() && line.starts_with(&self.comment);
        !(line.is_empty() || line[0] == b'#' || own)
    }

    /// The line that was read last will be read again.
    pub(crate) fn put_back(&mut self) {
        self.start = self.line_start;
        self.number -= 1;
    }

    /// Finds the next line in the buffer, reading on as needed.
    #[inline]
    fn advance(&mut self) -> Result<Option<(usize, usize)>, ReadError> {
        let mut searched = self.start;
        loop {
            if let Some(i) = memchr::memchr(b'\n', &self.buffer[searched..self.end]) {
                let (from, newline) = (self.start, searched + i);
                self.start = newline + 1;
                return Ok(Some(self.finish_line(from, newline)));
            }
            searched = self.end;
            if self.at_end {
                if self.start == self.end {
                    return Ok(None);
                }
                let (from, to) = (self.start, self.end);
                self.start = to;
                return Ok(Some(self.finish_line(from, to)));
            }
            searched -= self.start;
            self.fill()?;
            searched += self.start;
        }
    }

    /// Counts the line and takes off a carriage return, and on the first line a byte-order mark.
    #[inline]
    fn finish_line(&mut self, mut from: usize, mut to: usize) -> (usize, usize) {
        self.number += 1;
        self.line_start = from;
        if to > from && self.buffer[to - 1] == b'\r' {
            to -= 1;
        }
        if self.number == 1 && self.buffer[from..to].starts_with(b"\xef\xbb\xbf") {
            from += 3;
        }
        (from, to)
    }

    fn fill(&mut self) -> Result<(), ReadError> {
        // A long line that comes in small pieces stays where it is.
        if self.start > 0 {
            self.buffer.copy_within(self.start..self.end, 0);
        }
        (self.start, self.end) = (0, self.end - self.start);
        let here = |problem| ReadError {
            place: Place::line(self.shown_as.as_str(), self.number + 1),
            problem,
        };
        if self.end >= LONGEST_LINE {
            return Err(here(Problem::LineTooLong { limit: LONGEST_LINE }));
        }
        if self.end == self.buffer.len() {
            self.buffer.resize(self.buffer.len() * 2, 0);
        }
        let n = loop {
            match self.reader.read(&mut self.buffer[self.end..]) {
                Err(e) if e.kind() == std::io::ErrorKind::Interrupted => {}
                other => break other.map_err(|e| here(Source::problem(e)))?,
            }
        };
        self.end += n;
        self.at_end = n == 0;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives one byte at a time.
    struct Drip<'a>(&'a [u8]);
    impl Read for Drip<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            let n = usize::from(!self.0.is_empty() && !buffer.is_empty());
            buffer[..n].copy_from_slice(&self.0[..n]);
            self.0 = &self.0[n..];
            Ok(n)
        }
    }

    fn all(reader: impl Read) -> Vec<(u64, String)> {
        let mut lines = Lines::new(reader, "x");
        let mut out = Vec::new();
        while let Some((number, line)) = lines.next_data().unwrap() {
            out.push((number, String::from_utf8(line.to_vec()).unwrap()));
        }
        out
    }

    #[test]
    fn ends_marks_comments_and_blank_lines() {
        let text = b"\xef\xbb\xbfa,b\r\n# note\r\n\r\n1,2\n  # moved\n3,4";
        let expected = vec![(1, "a,b".into()), (4, "1,2".into()), (6, "3,4".into())];
        assert_eq!(all(&text[..]), expected);
        assert_eq!(all(Drip(text)), expected);
        assert!(all(&b""[..]).is_empty());
        let mut marked = Lines::new(&b"% a\n 1\n  % b\n"[..], "x").with_comment(b"%");
        assert_eq!(marked.next_data().unwrap(), Some((2, &b" 1"[..])));
        assert!(marked.next_data().unwrap().is_none());
    }

    #[test]
    fn endless_lines_are_refused() {
        let mut lines = Lines::new(std::io::repeat(b'x'), "x");
        let error = lines.next_data().unwrap_err();
        assert!(matches!(error.problem, Problem::LineTooLong { .. }), "{error}");
    }
}
