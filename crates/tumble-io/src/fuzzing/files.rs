//! Whole files: run files, streams of codes, packed files.

use std::collections::BTreeMap;
use std::io::{Read, Write as _};

use tumble_core::{Quantizer, Readings};

use super::{Scratch, digit, said};
use crate::csv::{
    AngleUnit, CodeFormat, CodeStream, DecimalSign, Delimiter, Dialect, Discard, Dwell, Lines,
    Mapping, Missing, Reading, RunFileOptions, TimeUnit, read_lines,
};
use crate::error::ReadError;
use crate::source::Source;

/// Gives a few bytes at a time.
pub(super) struct Drip<'a> {
    rest: &'a [u8],
    step: usize,
}

impl<'a> Drip<'a> {
    pub(super) fn new(rest: &'a [u8]) -> Self {
        Self { rest, step: 0 }
    }
}

impl Read for Drip<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.step = self.step % 7 + 1;
        let n = self.step.min(buffer.len()).min(self.rest.len());
        let (now, rest) = self.rest.split_at(n);
        buffer[..n].copy_from_slice(now);
        self.rest = rest;
        Ok(n)
    }
}

/// `columns` of experiment.toml.
pub(super) fn mapping(text: &str) -> Mapping {
    toml::from_str::<BTreeMap<String, Mapping>>(&format!("columns = {text}"))
        .ok()
        .and_then(|mut table| table.remove("columns"))
        .unwrap_or_default()
}

/// How a file is read, by three bytes.
struct Way {
    dialect: Dialect,
    mapping: Mapping,
    rows: BTreeMap<String, String>,
    discard: Discard,
    quantizer: Quantizer,
    rate_hz: Option<f64>,
    fixed_angle_deg: Option<f64>,
}

impl Way {
    fn of([a, b, c]: [u8; 3]) -> Self {
        let mut n = u32::from_le_bytes([a, b, c, 0]);
        let delimiter = match digit(&mut n, 4) {
            0 => None,
            1 => Some(Delimiter::Byte(b';')),
            2 => Some(Delimiter::Byte(b'\t')),
            _ => Some(Delimiter::Blanks),
        };
        let decimal = [None, Some(DecimalSign::Point), Some(DecimalSign::CommaOrPoint)];
        let decimal = decimal[digit(&mut n, 3) as usize];
        let missing = [Missing::Refuse, Missing::Skip][digit(&mut n, 2) as usize];
        let hexadecimal = digit(&mut n, 2) == 1;
        let bits = [None, Some(16), Some(32)][digit(&mut n, 3) as usize];
        let time_unit = TimeUnit::ALL.get(digit(&mut n, 6) as usize).copied();
        let angle_unit = AngleUnit::ALL.get(digit(&mut n, 5) as usize).copied();
        let discards = [Discard::Seconds(0.0), Discard::Seconds(0.5), Discard::Detected];
        let discard = discards[digit(&mut n, 3) as usize];
        let lines = [(None, None), (Some(0), None), (Some(2), Some(4))];
        let (header_line, data_line) = lines[digit(&mut n, 3) as usize];
        let quantizer = [Quantizer::Floor, Quantizer::None][digit(&mut n, 2) as usize];
        let maps = ["{}", "{angle_deg = 1, code = 2, output = 2}", "{t_s = \"time\"}"];
        let mapping = mapping(maps[digit(&mut n, 3) as usize]);
        let rows = match digit(&mut n, 2) {
            0 => BTreeMap::new(),
            _ => BTreeMap::from([("sensor".to_owned(), "B".to_owned())]),
        };
        let fixed_angle_deg = (digit(&mut n, 2) == 1).then_some(-30.0);
        let comment = if digit(&mut n, 2) == 1 { b"%".to_vec() } else { Vec::new() };
        Self {
            dialect: Dialect {
                header_line,
                data_line,
                delimiter,
                decimal,
                comment,
                missing,
                codes: CodeFormat { hexadecimal, bits, offset: 0 },
                time_unit,
                angle_unit,
            },
            mapping,
            rows,
            discard,
            quantizer,
            rate_hz: (header_line != Some(2)).then_some(2.0),
            fixed_angle_deg,
        }
    }

    fn options<'a>(&'a self, angles_deg: Option<&'a [f64]>) -> RunFileOptions<'a> {
        RunFileOptions {
            mapping: &self.mapping,
            rows: &self.rows,
            dialect: &self.dialect,
            fixed_angle_deg: self.fixed_angle_deg.filter(|_| angles_deg.is_none()),
            angles_deg,
            discard: self.discard,
            rate_hz: self.rate_hz,
            quantizer: self.quantizer,
            unit: "V",
            watch: &(),
        }
    }
}

type Read1 = Result<(Vec<Dwell>, Vec<String>), ReadError>;

fn read_from(reader: impl Read, options: &RunFileOptions<'_>) -> Read1 {
    let mut lines = Lines::new(reader, "run.csv").with_comment(&options.dialect.comment);
    read_lines(&mut lines, options)
}

/// Read whole and read in drops: the same dwells, or the same refusal.
fn read_twice(text: &[u8], options: &RunFileOptions<'_>) {
    let whole = read_from(text, options);
    let dripped = read_from(Drip::new(text), options);
    match (&whole, &dripped) {
        (Ok(a), Ok(b)) => {
            assert_eq!(a, b);
            assert!(!a.0.is_empty());
            a.0.iter().for_each(sound);
        }
        (Err(a), Err(b)) => assert_eq!(said(a), said(b)),
        _ => panic!("whole: {whole:?}, in drops: {dripped:?}"),
    }
}

/// What every dwell keeps to.
fn sound(dwell: &Dwell) {
    let samples = dwell.readings.samples();
    assert!(samples > 0);
    assert!(dwell.readings.mean().is_some_and(f64::is_finite));
    assert!(dwell.readings.std().is_none_or(|s| s.is_finite() && s >= 0.0));
    assert!(dwell.temperature_degc.is_none_or(f64::is_finite));
    let record = &dwell.record;
    if !matches!(dwell.readings, Readings::Averaged { .. }) {
        let [start, end] = record.left_out;
        assert!(samples + start + end <= record.rows, "{samples} samples of {record:?}");
        assert!(record.closing_repeats <= samples);
    }
    if let Some(dial) = &record.dial {
        assert!((dial.value * dial.unit_deg).is_finite());
    }
    if let Some(timing) = &record.timing {
        assert!(timing.rate_hz().is_none_or(|r| r > 0.0), "{timing:?}");
        assert!(timing.typical_step_s().is_none_or(|s| s > 0.0), "{timing:?}");
        let _ = timing.missing();
    }
}

/// Raw run files; the first three bytes say how they are written.
pub fn run_file_raw(data: &[u8]) {
    let [a, b, c, text @ ..] = data else { return };
    read_twice(text, &Way::of([*a, *b, *c]).options(None));
}

/// Averaged run files: the first byte chooses a header, the next how the rest is written.
pub fn run_file_averaged(data: &[u8]) {
    let [which, how, rows @ ..] = data else { return };
    let mut which = u32::from(*which);
    let header = match digit(&mut which, 4) {
        0 => "angle_deg,mean_code,samples,std_code\n",
        1 => "angle_deg;mean_code;samples\n",
        2 => "sensor\tangle_deg\tmean_code\tsamples\ttemperature_degc\n",
        _ => "",
    };
    let mut way = Way::of([*how, 0, 0]);
    if digit(&mut which, 8) != 7 {
        way.discard = Discard::Seconds(0.0);
    }
    read_twice(&[header.as_bytes(), rows].concat(), &way.options(None));
}

/// Continuous records, written out or made of one byte a sample; the first byte counts the angles.
pub fn continuous_record(data: &[u8]) {
    let [angles, how, rest @ ..] = data else { return };
    let angles: Vec<f64> = (0..angles % 16)
        .map(|i| if i % 5 == 4 { f64::NAN } else { 10.0 * f64::from(i) - 40.0 })
        .collect();
    let mut how = u32::from(*how);
    let made = digit(&mut how, 2) == 1;
    let scale = [1, 100, 1 << 20, 1 << 23][digit(&mut how, 4) as usize];
    let way = Way::of([0, digit(&mut how, 32) as u8, 0]);
    let text = if made {
        let mut text = b"t_s,code\n".to_vec();
        for (i, b) in rest.iter().enumerate() {
            let code = i64::from(*b as i8) * scale;
            // Writing into memory cannot fail.
            let _ = writeln!(text, "{}.{:02},{code}", i / 50, i % 50 * 2);
        }
        text
    } else {
        rest.to_vec()
    };
    read_twice(&text, &way.options(Some(&angles)));
}

/// All readings of a stream, up to the first that is none.
fn stream_of(reader: impl Read, whole_codes: bool) -> (Vec<Reading>, Option<String>) {
    let mut readings = Vec::new();
    let mut stream = match CodeStream::new(reader, "standard input", whole_codes) {
        Ok(stream) => stream,
        Err(e) => return (readings, Some(said(&e))),
    };
    loop {
        match stream.next_reading() {
            Ok(Some(reading)) => readings.push(reading),
            Ok(None) => return (readings, None),
            Err(e) => return (readings, Some(said(&e))),
        }
    }
}

/// Streams of codes: whole and in drops the same; numbers come out as numbers.
pub fn code_stream(data: &[u8]) {
    for whole_codes in [true, false] {
        let whole = stream_of(data, whole_codes);
        assert_eq!(whole, stream_of(Drip::new(data), whole_codes));
        for reading in &whole.0 {
            assert!(reading.value.is_finite());
            assert!(!whole_codes || reading.value.fract() == 0.0);
            // Both are written into CSV as they came.
            let texts = [Some(&reading.text), reading.time.as_ref()];
            let plain = |t: &String| !t.contains([',', ';', '\n', '\r', '"']);
            assert!(texts.into_iter().flatten().all(plain), "{reading:?}");
        }
    }
}

/// Length and digest of what a file unpacks to, and what ended it.
fn unpacked(scratch: &Scratch, name: &str, chunk: usize) -> (u64, u64, Result<String, String>) {
    let mut source = match Source::open(&scratch.path().join(name), name) {
        Ok(source) => source,
        Err(e) => return (0, 0, Err(said(&e))),
    };
    let mut buffer = vec![0; chunk];
    let (mut length, mut sum) = (0u64, 0u64);
    let failed = loop {
        match source.read(&mut buffer) {
            Ok(0) => break None,
            Ok(n) => {
                length += n as u64;
                for b in &buffer[..n] {
                    sum = sum.wrapping_mul(0x0100_0000_01b3).wrapping_add(u64::from(*b));
                }
            }
            Err(e) => break Some(Source::problem(e)),
        }
    };
    match failed {
        // How much came before depends on the pieces that were asked for.
        Some(problem) => (0, 0, Err(said(&problem))),
        None => (length, sum, source.finish().map_err(|e| said(&Source::problem(e)))),
    }
}

fn unpacked_twice(name: &str, bytes: &[u8]) -> (u64, u64, Result<String, String>) {
    let scratch = Scratch::new();
    scratch.write(name, bytes);
    let large = unpacked(&scratch, name, 1 << 16);
    assert_eq!(large, unpacked(&scratch, name, 997));
    large
}

/// gzip: pieces of any size give the same; what is packed here comes back.
pub fn gz_source(data: &[u8]) {
    let _ = unpacked_twice("run.csv.gz", data);
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    if encoder.write_all(data).is_ok()
        && let Ok(packed) = encoder.finish()
    {
        let (length, _, end) = unpacked_twice("run.csv.gz", &packed);
        assert!(end.is_ok(), "{end:?}");
        assert_eq!(length, data.len() as u64);
    }
}

/// zstd: pieces of any size give the same; what is packed here comes back.
pub fn zst_source(data: &[u8]) {
    let _ = unpacked_twice("run.csv.zst", data);
    let level = ruzstd::encoding::CompressionLevel::Fastest;
    let packed = ruzstd::encoding::compress_to_vec(data, level);
    let (length, _, end) = unpacked_twice("run.csv.zst", &packed);
    assert!(end.is_ok(), "{end:?}");
    assert_eq!(length, data.len() as u64);
}
