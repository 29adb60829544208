//! `tumble compensate`

use std::io::{self, Read, Write};

use tumble_core::{Compensator, Quantizer};
use tumble_io::passport::Passport;
use tumble_io::{
    CodeStream, CompensationRefused, Proof, ReadError, advice, compensator, open_text,
};

use crate::cli::CompensateArgs;
use crate::exit::{Exit, complain};

pub(crate) fn run(args: &CompensateArgs) -> Exit {
    let compensator = match load(args) {
        Ok(c) => c,
        Err((message, exit)) => {
            complain(message);
            return exit;
        }
    };
    let (reader, name): (Box<dyn Read>, String) = match &args.input {
        Some(path) => match open_text(path) {
            Ok(text) => (Box::new(text), path.display().to_string()),
            Err(e) => {
                complain(&e);
                return Exit::of_reading(&e);
            }
        },
        None => (Box::new(io::stdin().lock()), "standard input".into()),
    };
    let mut out = io::BufWriter::with_capacity(1 << 16, io::stdout().lock());
    match stream(reader, &name, &compensator, args.temperature, &mut out) {
        Ok(counts) => {
            if !args.quiet {
                counts.tell();
            }
            Exit::Ok
        }
        Err(StreamError::Read(e)) => {
            // What was compensated before the bad line is right and stays.
            let _ = out.flush();
            complain(e);
            Exit::Usage
        }
        Err(StreamError::NoTemperature) => {
            complain(format!(
                "{}: the passport has terms on temperature, and the readings have none; give a column \
                 `temperature_degc`, or one temperature for all with --temperature 21.5",
                args.passport.display()
            ));
            Exit::Usage
        }
        Err(StreamError::Write(e)) if e.kind() == io::ErrorKind::BrokenPipe => Exit::Ok,
        Err(StreamError::Write(e)) => {
            complain(format!("standard output: {}", advice(&e)));
            Exit::Failure
        }
    }
}

fn load(args: &CompensateArgs) -> Result<Compensator, (String, Exit)> {
    let name = args.passport.display();
    let passport =
        Passport::read(&args.passport).map_err(|e| (format!("{name}: {e}"), Exit::Usage))?;
    let proof = if args.unproven { Proof::Waived } else { Proof::Required };
    compensator(&passport, proof).map_err(|e| {
        let exit = match e {
            CompensationRefused::Rejected { .. } => Exit::Rejected,
            CompensationRefused::Indeterminate { .. } | CompensationRefused::Unproven => {
                Exit::Indeterminate
            }
            CompensationRefused::Unknown { .. }
            | CompensationRefused::Impossible { .. }
            | CompensationRefused::Inconsistent { .. } => Exit::Usage,
        };
        (format!("{name}: {e}"), exit)
    })
}

enum StreamError {
    Read(ReadError),
    Write(io::Error),
    NoTemperature,
}

/// What is worth saying when the stream has ended.
#[derive(Default)]
struct Counts {
    readings: u64,
    outside: u64,
    at_the_end: u64,
}

impl Counts {
    fn tell(&self) {
        if self.outside > 0 {
            eprintln!(
                "{} of {} readings lie outside the calibrated range: their uncertainty is extrapolated",
                self.outside, self.readings
            );
        }
        if self.at_the_end > 0 {
            eprintln!(
                "{} of {} readings stand at the converter's end and have no acceleration",
                self.at_the_end, self.readings
            );
        }
    }
}

fn stream(
    reader: impl Read,
    name: &str,
    compensator: &Compensator,
    temperature_degc: Option<f64>,
    out: &mut impl Write,
) -> Result<Counts, StreamError> {
    let whole_codes = compensator.quantizer != Quantizer::None;
    let mut codes = CodeStream::new(reader, name, whole_codes).map_err(StreamError::Read)?;
    let timed = codes.has_time();
    if compensator.needs_temperature() && !codes.has_temperature() && temperature_degc.is_none() {
        return Err(StreamError::NoTemperature);
    }
    let mut counts = Counts::default();
    let header = if timed { "t_s," } else { "" };
    let column = if whole_codes { "code" } else { "output" };
    writeln!(out, "{header}{column},acceleration_m_s2,u_calibration_m_s2,u_reading_m_s2")
        .map_err(StreamError::Write)?;
    while let Some(reading) = codes.next_reading().map_err(StreamError::Read)? {
        counts.readings += 1;
        let time = reading.time.map(|t| t + ",").unwrap_or_default();
        let compensated = match reading.temperature_degc.or(temperature_degc) {
            Some(t) => compensator.compensate_at(reading.value, t),
            None => compensator.compensate(reading.value),
        };
        match compensated {
            Some(c) => {
                counts.outside += u64::from(!c.inside_range);
                writeln!(
                    out,
                    "{time}{},{:.9},{:.3e},{:.3e}",
                    reading.text, c.acceleration_m_s2, c.u_calibration_m_s2, c.u_reading_m_s2
                )
            }
            None => {
                counts.at_the_end += 1;
                writeln!(out, "{time}{},,,", reading.text)
            }
        }
        .map_err(StreamError::Write)?;
    }
    out.flush().map_err(StreamError::Write)?;
    Ok(counts)
}
