//! zstd text: frame after frame, checksums compared, windows bounded.

use std::io::{self, BufRead, BufReader, Read};

use ruzstd::decoding::errors::{FrameDecoderError, ReadFrameHeaderError};
use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};

/// Largest window that is given room: what `zstd --ultra -22` uses.
const WINDOW_LIMIT: u64 = 128 << 20;

/// Blocks that may give nothing. A largest window that is filled line by line has a million of them; two gigabytes of
/// zeros behind the mark of a zstd file are seven hundred millions.
const MOST_BLOCKS: u32 = 1 << 22;

/// Unpacks a stream of zstd frames.
pub(crate) struct ZstReader<R> {
    decoder: FrameDecoder,
    source: BufReader<R>,
    in_frame: bool,
}

impl<R: Read> ZstReader<R> {
    pub(crate) fn new(source: R) -> Self {
        let mut decoder = FrameDecoder::new();
        decoder.set_max_window_size(WINDOW_LIMIT);
        Self { decoder, source: BufReader::new(source), in_frame: false }
    }

    pub(crate) fn get_ref(&self) -> &R {
        self.source.get_ref()
    }

    pub(crate) fn into_inner(self) -> R {
        self.source.into_inner()
    }

    /// Goes to the next frame; `false` at the end of the stream.
    fn next_frame(&mut self) -> io::Result<bool> {
        while !self.source.fill_buf()?.is_empty() {
            match self.decoder.reset(&mut self.source) {
                Ok(()) => {
                    self.in_frame = true;
                    return Ok(true);
                }
                Err(FrameDecoderError::ReadFrameHeaderError(ReadFrameHeaderError::SkipFrame {
                    length,
                    ..
                })) => {
                    io::copy(&mut (&mut self.source).take(u64::from(length)), &mut io::sink())?;
                }
                Err(e) => return Err(broken(e)),
            }
        }
        Ok(false)
    }
}

fn broken(e: impl std::fmt::Display) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, e.to_string())
}

impl<R: Read> Read for ZstReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            if !self.in_frame && !self.next_frame()? {
                return Ok(0);
            }
            let mut blocks = 0;
            while self.decoder.can_collect() == 0 && !self.decoder.is_finished() {
                blocks += 1;
                if blocks > MOST_BLOCKS {
                    return Err(broken("millions of blocks with nothing in them"));
                }
                self.decoder
                    .decode_blocks(&mut self.source, BlockDecodingStrategy::UptoBlocks(1))
                    .map_err(broken)?;
            }
            let n = self.decoder.read(buffer)?;
            if n > 0 || buffer.is_empty() {
                return Ok(n);
            }
            let stated = self.decoder.get_checksum_from_data();
            if stated.is_some() && stated != self.decoder.get_calculated_checksum() {
                return Err(broken("its checksum is another one"));
            }
            self.in_frame = false;
        }
    }
}
