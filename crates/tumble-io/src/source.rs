//! An input file as a stream of text bytes: plain or gzip, bounded, digested.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;

use crate::digest::DigestingReader;
use crate::error::{Place, Problem, ReadError};

/// Largest size of an unpacked file. A run of 60 dwells of 30 s at 50 Hz has 1 MB; 4 GiB are 300 million rows.
const UNPACKED_LIMIT: u64 = 4 << 30;

/// First bytes put back before the rest.
type Rewound<R> = io::Chain<io::Cursor<Vec<u8>>, R>;

/// A file's text, unpacked where it is gzip.
pub(crate) enum Source {
    Plain(Rewound<DigestingReader<File>>),
    Gzip { decoder: Box<MultiGzDecoder<Rewound<DigestingReader<File>>>>, left: u64 },
}

impl Source {
    /// Opens a file and looks at its first bytes.
    pub(crate) fn open(path: &Path, shown_as: &str) -> Result<Self, ReadError> {
        let fail = |problem| ReadError { place: Place::file(shown_as), problem };
        let file = File::open(path).map_err(|e| fail(Problem::Io(e)))?;
        if file.metadata().map_err(|e| fail(Problem::Io(e)))?.is_dir() {
            return Err(fail(Problem::Format {
                seen: "a folder, not a file",
                remedy: "name a CSV file",
            }));
        }
        let mut reader = DigestingReader::new(file);
        let mut head = vec![0u8; 4];
        let mut got = 0;
        while got < head.len() {
            match reader.read(&mut head[got..]).map_err(|e| fail(Problem::Io(e)))? {
                0 => break,
                n => got += n,
            }
        }
        head.truncate(got);
        let kind = head.clone();
        let rewound = io::Cursor::new(head).chain(reader);
        match kind[..] {
            [0x1f, 0x8b, ..] => Ok(Self::Gzip {
                decoder: Box::new(MultiGzDecoder::new(rewound)),
                left: UNPACKED_LIMIT,
            }),
            [0x28, 0xb5, 0x2f, 0xfd] => Err(fail(Problem::Format {
                seen: "a zstd file",
                remedy: "unpack it, or pack it with gzip",
            })),
            [b'P', b'K', 3, 4] => Err(fail(Problem::Format {
                seen: "a zip archive or an Excel file",
                remedy: "save the sheet as CSV, or unpack the archive",
            })),
            [b'P', b'A', b'R', b'1'] => Err(fail(Problem::Format {
                seen: "a Parquet file",
                remedy: "convert it to CSV; Parquet is not read yet",
            })),
            [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => {
                Err(fail(Problem::Format { seen: "UTF-16 text", remedy: "save the file as UTF-8" }))
            }
            _ => Ok(Self::Plain(rewound)),
        }
    }

    /// Digest of the file as it is stored.
    pub(crate) fn finish(self) -> io::Result<String> {
        match self {
            Self::Plain(chain) => chain.into_inner().1.finish(),
            Self::Gzip { decoder, .. } => decoder.into_inner().into_inner().1.finish(),
        }
    }
}

/// The limit of unpacked bytes was reached.
#[derive(Debug)]
pub(crate) struct UnpackedLimit;

impl std::fmt::Display for UnpackedLimit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "unpacks to too much")
    }
}

impl std::error::Error for UnpackedLimit {}

impl Source {
    /// An error of reading as a problem of the input.
    pub(crate) fn problem(e: io::Error) -> Problem {
        match e.get_ref() {
            Some(inner) if inner.is::<UnpackedLimit>() => {
                Problem::TooLarge { limit: UNPACKED_LIMIT }
            }
            _ => Problem::Io(e),
        }
    }
}

impl Read for Source {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Plain(chain) => chain.read(buffer),
            Self::Gzip { decoder, left } => {
                let n = decoder.read(buffer)?;
                *left =
                    left.checked_sub(n as u64).ok_or_else(|| io::Error::other(UnpackedLimit))?;
                Ok(n)
            }
        }
    }
}
