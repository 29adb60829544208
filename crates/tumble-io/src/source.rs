//! An input file as a stream of text bytes: plain, gzip or zstd, bounded, digested, watched.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use flate2::read::MultiGzDecoder;

use crate::digest::DigestingReader;
use crate::error::{Place, Problem, ReadError};
use crate::zst::ZstReader;

/// Largest size of an unpacked file. A run of 60 dwells of 30 s at 50 Hz has 1 MB; 4 GiB are 300 million rows.
const UNPACKED_LIMIT: u64 = 4 << 30;
/// Unpacked bytes from which the ratio of packing is looked at.
const RATIO_FROM: u64 = 64 << 20;
/// Records of a converter pack five to thirty times; a record of one row repeated, two hundred times.
const RATIO_LIMIT: u64 = 500;

/// Longest experiment.toml. A run has some hundred bytes.
pub(crate) const DOCUMENT_LIMIT: u64 = 4 << 20;

/// A document as a whole: a regular file, and no longer than a limit.
pub(crate) fn read_document(path: &Path, shown_as: &str, limit: u64) -> Result<Vec<u8>, ReadError> {
    let fail = |problem| ReadError { place: Place::file(shown_as), problem };
    let length = regular(path, "name a folder with an experiment.toml").map_err(fail)?;
    let mut bytes = Vec::new();
    if length <= limit {
        // It may have grown since.
        let file = File::open(path).map_err(|e| fail(Problem::Io(e)))?;
        file.take(limit + 1).read_to_end(&mut bytes).map_err(|e| fail(Problem::Io(e)))?;
    }
    if length > limit || bytes.len() as u64 > limit {
        return Err(fail(Problem::TooLong { limit }));
    }
    Ok(bytes)
}

/// Length of a regular file. It is looked at before it is opened: to open a pipe is to wait for its writer.
fn regular(path: &Path, remedy: &'static str) -> Result<u64, Problem> {
    let kind = std::fs::metadata(path).map_err(Problem::Io)?;
    if kind.is_file() {
        return Ok(kind.len());
    }
    let seen = if kind.is_dir() { "a folder, not a file" } else { "no regular file" };
    Err(Problem::Format { seen, remedy })
}

/// Told how far the reading of files has come.
pub trait Watch: Sync + std::fmt::Debug {
    /// `done` of `total` stored bytes of a file were read; of a pipe the total is zero.
    fn progress(&self, file: &str, done: u64, total: u64);
}

/// Nobody watches.
impl Watch for () {
    fn progress(&self, _: &str, _: u64, _: u64) {}
}

/// First bytes put back before the rest.
type Input = io::Chain<io::Cursor<Vec<u8>>, DigestingReader<io::Take<File>>>;

enum Packing {
    Plain(Input),
    Gzip(Box<MultiGzDecoder<Input>>),
    Zst(Box<ZstReader<Input>>),
}

/// A file's text, unpacked where it is packed.
pub(crate) struct Source<'w> {
    packing: Packing,
    path: PathBuf,
    shown_as: String,
    /// Stored bytes when it was opened. No more are read, whatever is added meanwhile.
    length: u64,
    /// When it was written to last, at that time.
    written: Option<SystemTime>,
    /// A pipe: without a length, and nothing to compare with at the end.
    pipe: bool,
    unpacked: u64,
    watch: &'w dyn Watch,
}

impl Source<'static> {
    /// Opens a file and looks at its first bytes.
    pub(crate) fn open(path: &Path, shown_as: &str) -> Result<Self, ReadError> {
        let fail = |problem| ReadError { place: Place::file(shown_as), problem };
        regular(path, "name a CSV file").map_err(fail)?;
        Self::opened(path, shown_as, false)
    }

    /// The same, or a pipe, which is read as it comes.
    pub(crate) fn open_or_pipe(path: &Path, shown_as: &str) -> Result<Self, ReadError> {
        let fail = |problem| ReadError { place: Place::file(shown_as), problem };
        let kind = std::fs::metadata(path).map_err(|e| fail(Problem::Io(e)))?;
        if kind.is_file() || kind.is_dir() {
            return Self::open(path, shown_as);
        }
        Self::opened(path, shown_as, true)
    }

    fn opened(path: &Path, shown_as: &str, pipe: bool) -> Result<Self, ReadError> {
        let fail = |problem| ReadError { place: Place::file(shown_as), problem };
        let file = File::open(path).map_err(|e| fail(Problem::Io(e)))?;
        let opened = file.metadata().map_err(|e| fail(Problem::Io(e)))?;
        let (length, written) = match pipe {
            true => (u64::MAX, None),
            false => (opened.len(), opened.modified().ok()),
        };
        let mut reader = DigestingReader::new(file.take(length));
        let mut head = vec![0u8; 4];
        let mut got = 0;
        while got < head.len() {
            match reader.read(&mut head[got..]).map_err(|e| fail(Problem::Io(e)))? {
                0 => break,
                n => got += n,
            }
        }
        head.truncate(got);
        let refused = match head[..] {
            [b'P', b'K', 3, 4] => Some((
                "a zip archive or an Excel file",
                "save the sheet as CSV, or unpack the archive",
            )),
            [0xd0, 0xcf, 0x11, 0xe0] => Some(("an old Excel file", "save the sheet as CSV")),
            [b'P', b'A', b'R', b'1'] => {
                Some(("a Parquet file", "convert it to CSV; Parquet is not read yet"))
            }
            [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Some((
                "UTF-16 text",
                "save the file as UTF-8 (a spreadsheet's `CSV UTF-8`, not its `Unicode text`)",
            )),
            _ => None,
        };
        if let Some((seen, remedy)) = refused {
            return Err(fail(Problem::Format { seen, remedy }));
        }
        let kind = head.clone();
        let input = io::Cursor::new(head).chain(reader);
        let packing = match kind[..] {
            [0x1f, 0x8b, ..] => Packing::Gzip(Box::new(MultiGzDecoder::new(input))),
            // A zstd frame, or a frame to skip in front of one.
            [0x28, 0xb5, 0x2f, 0xfd] | [0x50..=0x5f, 0x2a, 0x4d, 0x18] => {
                Packing::Zst(Box::new(ZstReader::new(input)))
            }
            _ => Packing::Plain(input),
        };
        Ok(Self {
            packing,
            path: path.to_path_buf(),
            shown_as: shown_as.to_owned(),
            length,
            written,
            pipe,
            unpacked: 0,
            watch: &(),
        })
    }
}

/// A file's text as a stream, unpacked where it is gzip or zstd.
///
/// A pipe is read as it comes.
///
/// **Errors** [`ReadError`] where it cannot be opened, or is no text.
pub fn open_text(path: &Path) -> Result<Box<dyn Read>, ReadError> {
    let shown_as = path.display().to_string();
    let fail = |e| ReadError { place: Place::file(shown_as.as_str()), problem: Problem::Io(e) };
    let kind = std::fs::metadata(path).map_err(fail)?;
    if kind.is_file() || kind.is_dir() {
        return Ok(Box::new(Source::open(path, &shown_as)?));
    }
    Ok(Box::new(File::open(path).map_err(fail)?))
}

impl<'w> Source<'w> {
    /// The same, telling how far it has come.
    pub(crate) fn watched<'v>(self, watch: &'v dyn Watch) -> Source<'v> {
        Source { watch, ..self }
    }

    fn digesting(&self) -> &DigestingReader<io::Take<File>> {
        match &self.packing {
            Packing::Plain(input) => input.get_ref().1,
            Packing::Gzip(decoder) => decoder.get_ref().get_ref().1,
            Packing::Zst(decoder) => decoder.get_ref().get_ref().1,
        }
    }

    /// Whether the file was written to since it was opened.
    pub(crate) fn changed(&self) -> bool {
        !self.pipe
            && std::fs::metadata(&self.path).is_ok_and(|now| {
                now.len() != self.length
                    || (self.written.is_some() && now.modified().ok() != self.written)
            })
    }

    /// Digest of the file as it is stored.
    ///
    /// **Errors** where the file was changed while it was read: what was read is then no record of anything.
    pub(crate) fn finish(self) -> io::Result<String> {
        let changed = self.changed();
        let (length, input) = (
            (!self.pipe).then_some(self.length),
            match self.packing {
                Packing::Plain(input) => input,
                Packing::Gzip(decoder) => decoder.into_inner(),
                Packing::Zst(decoder) => decoder.into_inner(),
            },
        );
        let (digest, read) = input.into_inner().1.finish()?;
        if changed || length.is_some_and(|length| read != length) {
            return Err(io::Error::other(Stop::Changed));
        }
        Ok(digest)
    }

    /// An error of reading as a problem of the input.
    pub(crate) fn problem(e: io::Error) -> Problem {
        match e.get_ref().and_then(|inner| inner.downcast_ref::<Stop>()) {
            Some(Stop::TooLarge) => Problem::TooLarge { limit: UNPACKED_LIMIT },
            Some(Stop::TooDense) => Problem::TooDense { limit: RATIO_LIMIT },
            Some(Stop::Changed) => Problem::Changed,
            Some(Stop::Damaged(packing, message)) => {
                Problem::Damaged { packing, message: message.clone() }
            }
            None => Problem::Io(e),
        }
    }
}

/// Why reading was stopped.
#[derive(Debug, Clone)]
enum Stop {
    TooLarge,
    TooDense,
    Changed,
    /// What packs it, and what the decoder says.
    Damaged(&'static str, String),
}

/// What a decoder says of its input, apart from what the operating system says.
fn damaged(packing: &'static str) -> impl Fn(io::Error) -> io::Error {
    use io::ErrorKind::{InvalidData, InvalidInput, UnexpectedEof};
    move |e| match e.kind() {
        InvalidData | InvalidInput | UnexpectedEof => {
            io::Error::new(e.kind(), Stop::Damaged(packing, e.to_string()))
        }
        _ => e,
    }
}

impl std::fmt::Display for Stop {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("reading was stopped")
    }
}

impl std::error::Error for Stop {}

impl Read for Source<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = match &mut self.packing {
            Packing::Plain(input) => input.read(buffer)?,
            Packing::Gzip(decoder) => decoder.read(buffer).map_err(damaged("gzip"))?,
            Packing::Zst(decoder) => decoder.read(buffer).map_err(damaged("zstd"))?,
        };
        let stored = self.digesting().taken();
        let length = if self.pipe { 0 } else { self.length };
        self.watch.progress(&self.shown_as, stored, length);
        if !matches!(self.packing, Packing::Plain(_)) {
            self.unpacked += n as u64;
            if self.unpacked > UNPACKED_LIMIT {
                return Err(io::Error::other(Stop::TooLarge));
            }
            if self.unpacked > RATIO_FROM && self.unpacked / RATIO_LIMIT > stored {
                return Err(io::Error::other(Stop::TooDense));
            }
        }
        Ok(n)
    }
}
