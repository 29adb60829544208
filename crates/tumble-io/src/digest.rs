//! SHA-256 of what was read, while it is read.

use std::io::{self, Read};

use sha2::{Digest, Sha256};

/// Passes bytes on and digests them.
pub(crate) struct DigestingReader<R> {
    inner: R,
    hasher: Sha256,
    taken: u64,
}

impl<R: Read> DigestingReader<R> {
    pub(crate) fn new(inner: R) -> Self {
        Self { inner, hasher: Sha256::new(), taken: 0 }
    }

    /// Bytes that were read.
    pub(crate) fn taken(&self) -> u64 {
        self.taken
    }

    /// Reads what is left and gives digest and length of the whole input.
    pub(crate) fn finish(mut self) -> io::Result<(String, u64)> {
        let mut rest = [0u8; 1 << 12];
        while self.read(&mut rest)? > 0 {}
        Ok((hex(&self.hasher.finalize()), self.taken))
    }
}

impl<R: Read> Read for DigestingReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.inner.read(buffer)?;
        self.hasher.update(&buffer[..n]);
        self.taken += n as u64;
        Ok(n)
    }
}

/// Digest of bytes in memory.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digests_of_fips_180() {
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256(b"abc"), abc);
        let mut reader = DigestingReader::new(&b"abc"[..]);
        let mut one = [0u8; 1];
        reader.read_exact(&mut one).unwrap();
        assert_eq!(reader.finish().unwrap(), (abc.to_owned(), 3));
    }
}
