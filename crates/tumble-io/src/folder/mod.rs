//! An experiment folder as the core's [`Experiment`].
//!
//! Past 500 lines: runs and the up/down pair share the reader and its checks of paths; the pair is the next to move out.

mod settings;
mod spec;
mod systematics;

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use std::thread;

use tumble_core::assess::LeftOut;
use tumble_core::{
    Angle, Bench, Experiment, Finding, FindingKind, Output, PairUse, Position, Readings, Record,
    Run, Seat, Sensor, VerticalPair,
};

use crate::catalogue::{CATALOGUE_FILE, Catalogue, UserCatalogue};
use crate::csv::{Dialect, Discard, Dwell, Mapping, RunFileOptions, read_run_file};
use crate::error::{Place, Problem, ReadError, first_of, nearest};
use crate::experiment_file::{
    self, BenchTable, CsvTable, DiscardValue, ExperimentFile, Orientation, RunTable, ScaleTable,
};
use crate::source::{DOCUMENT_LIMIT, Watch, read_document};
use settings::{bench, dialect, discard, mapping, missing, output, targets};
pub(crate) use settings::{bench as bench_of_table, value};
use systematics::systematics;
pub(crate) use systematics::{ConverterKeys, systematics_of_tables};

/// Name of the file that makes a folder an experiment.
pub(crate) const EXPERIMENT_FILE: &str = "experiment.toml";

/// Most runs of an experiment: three power-ups a day for a year.
const MOST_RUNS: usize = 1000;

/// One input with its digest.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileDigest {
    /// Path relative to the folder, with `/`.
    pub file: String,
    /// SHA-256 of the file as it is stored, hexadecimal.
    pub sha256: String,
}

/// An experiment as read, with what the passport wants to know about its files.
#[derive(Debug, Clone, PartialEq)]
pub struct ExperimentFolder {
    /// What was measured.
    pub experiment: Experiment,
    /// Number of the certificate, from the folder.
    pub id: Option<String>,
    /// Day of issue, from the folder.
    pub issued: Option<String>,
    /// All inputs, in the order of experiment.toml.
    pub inputs: Vec<FileDigest>,
    /// What was noticed while reading.
    pub findings: Vec<Finding>,
    /// Operators and notes by run.
    pub remarks: Vec<RunRemark>,
    /// Positions that the folder leaves out of the adjustment.
    pub left_out: Vec<LeftOut>,
}

/// What people wrote about a run.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RunRemark {
    /// Who measured.
    pub operator: Option<String>,
    /// Anything else.
    pub note: Option<String>,
}

/// Reads an experiment folder: `experiment.toml` and the files that it names.
///
/// **Errors** [`ReadError`] with file, line, column and remedy for everything that is not understood. Degenerate
/// data are no error here.
pub fn read_experiment(folder: &Path, watch: &dyn Watch) -> Result<ExperimentFolder, ReadError> {
    read_experiment_with(folder, None, watch)
}

/// The same, with a catalogue over the folder's own and the built-in one.
pub fn read_experiment_with(
    folder: &Path,
    catalogue: Option<&UserCatalogue>,
    watch: &dyn Watch,
) -> Result<ExperimentFolder, ReadError> {
    let toml_path = folder.join(EXPERIMENT_FILE);
    let read = read_document(&toml_path, EXPERIMENT_FILE, DOCUMENT_LIMIT);
    let bytes = read.map_err(|e| match &e.problem {
        Problem::Io(io)
            if matches!(
                io.kind(),
                std::io::ErrorKind::NotFound | std::io::ErrorKind::NotADirectory
            ) =>
        {
            ReadError {
                place: Place::file(folder.display().to_string()),
                problem: Problem::NoExperiment { folder: folder.to_path_buf() },
            }
        }
        _ => e,
    })?;
    read_described(folder, &bytes, catalogue, watch)
}

/// Reads a folder as a text describes it that stands in it or is to stand there.
pub(crate) fn read_described(
    folder: &Path,
    bytes: &[u8],
    catalogue: Option<&UserCatalogue>,
    watch: &dyn Watch,
) -> Result<ExperimentFolder, ReadError> {
    let text = std::str::from_utf8(bytes).map_err(|_| ReadError {
        place: Place::file(EXPERIMENT_FILE),
        problem: Problem::Format { seen: "not UTF-8 text", remedy: "save the file as UTF-8" },
    })?;
    let file = experiment_file::parse(text, EXPERIMENT_FILE)?;
    read_parsed(folder, &file, bytes, catalogue, watch)
        .map_err(|e| experiment_file::located(e, text, EXPERIMENT_FILE))
}

fn read_parsed(
    folder: &Path,
    file: &ExperimentFile,
    bytes: &[u8],
    catalogue: Option<&UserCatalogue>,
    watch: &dyn Watch,
) -> Result<ExperimentFolder, ReadError> {
    if let Some(format) = file.format.filter(|f| *f != 1) {
        return Err(value("format", format, "1: this is a file of a newer version"));
    }
    let issued = file.issued.as_ref().map(experiment_file::date_text);
    if let Some(day) = issued.as_ref().filter(|d| !crate::is_iso_date(d)) {
        return Err(value("issued", day, "a day as YYYY-MM-DD, for instance 2026-11-23"));
    }
    let output = output(&file.output)?;
    let bench = Bench { systematics: systematics(file)?, ..bench(&file.bench)? };
    let specification = spec::specification(&file.spec)?;
    let names = run_names(&file.run)?;
    let mut inputs =
        vec![FileDigest { file: EXPERIMENT_FILE.into(), sha256: crate::digest::sha256(bytes) }];
    let mut findings = Vec::new();

    let dialect = dialect(&file.csv, &file.bench)?;
    let reader = Reader {
        folder,
        output: &output,
        bench: &bench,
        table: &file.bench,
        csv: &file.csv,
        dialect: &dialect,
        watch,
    };
    let own = reader.catalogue()?;
    let over: Vec<&UserCatalogue> = own.iter().chain(catalogue).collect();
    inputs.extend(over.iter().map(|c| c.input.clone()));
    let kind = over
        .iter()
        .fold(Catalogue::builtin().clone(), |all, user| all.with(&user.catalogue))
        .find(&file.sensor.model)
        .map(|e| e.sensor_type.clone());
    let vertical = match &file.scale {
        Some(scale) => Some(reader.vertical(scale, &names, &mut inputs, &mut findings)?),
        None => None,
    };
    let mut runs = Vec::new();
    for result in reader.runs(&file.run, &names) {
        let (run, digests, found) = result?;
        runs.push(run);
        inputs.extend(digests);
        findings.extend(found);
    }
    if runs.is_empty() && vertical.is_none() {
        return Err(ReadError {
            place: Place::file(EXPERIMENT_FILE),
            problem: Problem::MissingKey {
                key: "[[run]]",
                example: "[[run]] with file = \"run-1.csv\", or [scale] with up and down",
            },
        });
    }
    Ok(ExperimentFolder {
        experiment: Experiment {
            sensor: Sensor {
                model: file.sensor.model.clone(),
                serial: file.sensor.serial.clone(),
                axis: file.sensor.axis.clone(),
                kind,
            },
            output,
            bench,
            vertical,
            runs,
            targets: targets(file)?,
            specification,
        },
        id: file.id.clone(),
        issued,
        inputs,
        findings,
        remarks: file
            .run
            .iter()
            .map(|r| RunRemark { operator: r.operator.clone(), note: r.note.clone() })
            .collect(),
        left_out: left_out(&file.run, &names),
    })
}

/// Runs are named by `name`, else after their file, else by their number; names are unique.
fn run_names(runs: &[RunTable]) -> Result<Vec<String>, ReadError> {
    if runs.len() > MOST_RUNS {
        let given = format!("{} tables", runs.len());
        return Err(value(
            "[[run]]",
            given,
            &format!("at most {MOST_RUNS} runs in one experiment"),
        ));
    }
    let names: Vec<String> = runs
        .iter()
        .enumerate()
        .map(|(i, r)| match (&r.name, &r.file) {
            (Some(name), _) => name.clone(),
            (None, Some(file)) => stem(file),
            (None, None) => format!("run-{}", i + 1),
        })
        .collect();
    let mut seen = BTreeSet::new();
    if let Some(twice) = names.iter().find(|name| !seen.insert(*name)) {
        return Err(ReadError {
            place: Place::file(EXPERIMENT_FILE),
            problem: Problem::RunName { name: twice.clone(), known: names.clone() },
        });
    }
    Ok(names)
}

/// `data/run-1.csv.gz` → `run-1`.
fn stem(file: &str) -> String {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    name.trim_end_matches(".gz")
        .trim_end_matches(".zst")
        .trim_end_matches(".csv")
        .trim_end_matches(".txt")
        .to_owned()
}

/// What the runs leave out, by name.
fn left_out(tables: &[RunTable], names: &[String]) -> Vec<LeftOut> {
    let of = |(table, run): (&RunTable, &String)| -> Vec<LeftOut> {
        table.leave_out.iter().map(|n| LeftOut { run: run.clone(), position: *n }).collect()
    };
    tables.iter().zip(names).flat_map(of).collect()
}

type ReadRun = Result<(Run, Vec<FileDigest>, Vec<Finding>), ReadError>;

struct Reader<'a> {
    folder: &'a Path,
    output: &'a Output,
    bench: &'a Bench,
    table: &'a BenchTable,
    csv: &'a CsvTable,
    dialect: &'a Dialect,
    watch: &'a dyn Watch,
}

/// What a table of runs or of the up/down pair says about its files.
struct Asked<'a> {
    mapping: Mapping,
    rows: std::collections::BTreeMap<String, String>,
    discard: Discard,
    angles_deg: Option<&'a [f64]>,
}

impl Reader<'_> {
    /// A file inside the folder; links that lead out count as outside.
    fn inside(&self, file: &str) -> Result<PathBuf, ReadError> {
        let outside = || ReadError {
            place: Place::file(EXPERIMENT_FILE),
            problem: Problem::OutsideFolder { path: file.to_owned() },
        };
        if file.contains(char::is_control) {
            // "data\run-1.csv" is legal TOML with a carriage return in it.
            let expected =
                "a path with / between folders: between \" \" a backslash makes control characters";
            return Err(value("file", crate::error::visible(file), expected));
        }
        let relative = Path::new(file);
        let plain =
            relative.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
        if !plain || file.is_empty() || file.contains('\\') {
            return Err(outside());
        }
        let path = self.folder.join(relative);
        let io = |e| ReadError { place: Place::file(file), problem: Problem::Io(e) };
        let real = path.canonicalize().map_err(|e| {
            if path.symlink_metadata().is_ok_and(|m| m.is_symlink()) {
                let (seen, remedy) =
                    ("a link that leads nowhere", "copy the file itself into the folder");
                let problem = Problem::Format { seen, remedy };
                return ReadError { place: Place::file(file), problem };
            }
            match e.kind() {
                std::io::ErrorKind::NotFound => ReadError {
                    place: Place::file(EXPERIMENT_FILE),
                    problem: Problem::NoFile { path: file.to_owned(), nearest: neighbour(&path) },
                },
                _ => io(e),
            }
        })?;
        let root = self.folder.canonicalize().map_err(io)?;
        if real.starts_with(root) { Ok(path) } else { Err(outside()) }
    }

    /// The folder's own catalogue, where there is one.
    fn catalogue(&self) -> Result<Option<UserCatalogue>, ReadError> {
        if self.folder.join(CATALOGUE_FILE).symlink_metadata().is_err() {
            return Ok(None);
        }
        let path = self.inside(CATALOGUE_FILE)?;
        Catalogue::read_as(&path, CATALOGUE_FILE, CATALOGUE_FILE).map(Some)
    }

    /// Runs in parallel, combined in the order of experiment.toml.
    fn runs(&self, tables: &[RunTable], names: &[String]) -> Vec<ReadRun> {
        let workers =
            thread::available_parallelism().map_or(1, |n| n.get()).min(tables.len().max(1));
        let mut results: Vec<Option<ReadRun>> = tables.iter().map(|_| None).collect();
        thread::scope(|scope| {
            let handles: Vec<_> = (0..workers)
                .map(|w| {
                    scope.spawn(move || {
                        (w..tables.len())
                            .step_by(workers)
                            .map(|i| (i, self.run(&tables[i], &names[i])))
                            .collect::<Vec<_>>()
                    })
                })
                .collect();
            for handle in handles {
                match handle.join() {
                    Ok(done) => done.into_iter().for_each(|(i, r)| results[i] = Some(r)),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            }
        });
        results.into_iter().flatten().collect()
    }

    fn run(&self, table: &RunTable, name: &str) -> ReadRun {
        let mut positions = Vec::new();
        let mut digests = Vec::new();
        let mut findings = Vec::new();
        let files: Vec<(&str, Option<f64>)> = match (&table.file, &table.files[..]) {
            (Some(file), []) => vec![(file, None)],
            (None, [_, ..]) => {
                table.files.iter().map(|f| (f.file.as_str(), Some(f.angle_deg))).collect()
            }
            (None, []) => return Err(missing("[[run]] file", "file = \"run-1.csv\"")),
            (Some(_), _) => {
                return Err(value("[[run]] files", "given beside file", "one of the two"));
            }
        };
        let asked = self.asked(
            &table.columns,
            &table.rows,
            table.discard_s.as_ref(),
            table.angles_deg.as_deref(),
        )?;
        if asked.angles_deg.is_some_and(|a| !a.is_empty() && a.iter().all(|a| a.is_nan())) {
            return Err(value(
                "[[run]] angles_deg",
                "nan throughout",
                "the dial's angle of each dwell, for instance [-30.0, 0.0, 30.0]",
            ));
        }
        if asked.angles_deg.is_some() && files.len() != 1 {
            return Err(value("[[run]] angles_deg", "given beside files", "one of the two"));
        }
        if let Some(angle) = files.iter().filter_map(|f| f.1).find(|a| !a.is_finite()) {
            return Err(value("[[run]] files angle_deg", angle, "the dial's angle in degrees"));
        }
        if let Some(t) = table.temperature_degc.filter(|t| !t.is_finite()) {
            return Err(value("[[run]] temperature_degc", t, "a temperature in °C"));
        }
        for (file, fixed_angle_deg) in files {
            let options = self.options(&asked, fixed_angle_deg);
            let read = read_run_file(&self.inside(file)?, file, &options)?;
            digests.push(FileDigest { file: file.to_owned(), sha256: read.sha256 });
            if !read.ignored.is_empty() {
                findings.push(ignored_columns(file, &read.ignored));
            }
            if asked.angles_deg.is_some() {
                findings.push(cut_out(file, &read.dwells));
            }
            for (i, dwell) in read.dwells.into_iter().enumerate() {
                positions.push(self.position(dwell, file, i, table));
            }
        }
        if let Some(n) = table.leave_out.iter().find(|n| !(1..=positions.len()).contains(*n)) {
            let expected =
                format!("positions of {name}: 1 to {}, in measured order", positions.len());
            return Err(value("[[run]] leave_out", n, &expected));
        }
        let mounting = table.mounting.clone().unwrap_or_else(|| "A".into());
        let run = Run {
            name: name.to_owned(),
            mounting,
            // Turned by 180°, what belongs to the seat changes its sign against what belongs to the table.
            orientation: match table.orientation {
                Orientation::Normal => tumble_core::Orientation::Normal,
                Orientation::Reversed => tumble_core::Orientation::Reversed,
            },
            positions,
            date: table.date.as_ref().map(experiment_file::date_text),
        };
        Ok((run, digests, findings))
    }

    /// What one table asks for, put over what `[csv]` says for all files.
    fn asked<'b>(
        &self,
        columns: &Mapping,
        rows: &std::collections::BTreeMap<String, String>,
        discarded: Option<&DiscardValue>,
        angles_deg: Option<&'b [f64]>,
    ) -> Result<Asked<'b>, ReadError> {
        if let Some(infinite) = angles_deg.into_iter().flatten().find(|a| a.is_infinite()) {
            return Err(value(
                "[[run]] angles_deg",
                infinite,
                "angles, or nan for a dwell that does not count",
            ));
        }
        let mut all_rows = self.csv.rows.clone();
        all_rows.extend(rows.clone());
        Ok(Asked {
            mapping: mapping(&self.csv.columns, columns)?,
            rows: all_rows,
            discard: discard(discarded)?,
            angles_deg,
        })
    }

    fn options<'b>(
        &'b self,
        asked: &'b Asked<'_>,
        fixed_angle_deg: Option<f64>,
    ) -> RunFileOptions<'b> {
        RunFileOptions {
            mapping: &asked.mapping,
            rows: &asked.rows,
            dialect: self.dialect,
            fixed_angle_deg,
            angles_deg: asked.angles_deg,
            discard: asked.discard,
            rate_hz: self.output.rate_hz,
            quantizer: self.output.quantizer,
            unit: &self.output.unit,
            watch: self.watch,
        }
    }

    /// A dwell at its angle: the dial's zero and sign, then the run's orientation.
    fn position(&self, dwell: Dwell, file: &str, index: usize, table: &RunTable) -> Position {
        let zero = self.table.angle_zero_deg.unwrap_or(0.0);
        let sign = self.table.angle_sign.unwrap_or(1.0);
        let turned = match table.orientation {
            Orientation::Normal => 1.0,
            Orientation::Reversed => -1.0,
        };
        let mut record = dwell.record;
        let dial_deg = record.dial.as_ref().map_or(0.0, |d| d.value * d.unit_deg);
        if let Some(dial) = &mut record.dial {
            dial.direction = turned * sign;
        }
        // 330° and −30° are one angle; the table's range and ±90° are told in the second.
        let angle_deg = half_turn(turned * sign * (dial_deg - zero));
        let angle = Angle::from_deg(angle_deg);
        Position {
            angle,
            seat: self.bench.seat(angle),
            readings: dwell.readings,
            temperature_degc: dwell.temperature_degc.or(table.temperature_degc),
            place: format!(
                "{file}, line {}, dwell {} ({}°)",
                record.line.unwrap_or(1),
                index + 1,
                tidy(dial_deg)
            ),
            record,
        }
    }

    fn vertical(
        &self,
        scale: &ScaleTable,
        names: &[String],
        inputs: &mut Vec<FileDigest>,
        findings: &mut Vec<Finding>,
    ) -> Result<VerticalPair, ReadError> {
        if let Some(run) = scale.run.as_ref().filter(|r| !names.contains(r)) {
            return Err(ReadError {
                place: Place::file(EXPERIMENT_FILE),
                problem: Problem::RunName { name: run.clone(), known: names.to_vec() },
            });
        }
        let alone = match (scale.joint, &scale.run) {
            (Some(true), Some(_)) => {
                let expected = "run or joint = true, not both: a pair enters once";
                return Err(value("[scale] joint", "given beside run", expected));
            }
            (Some(true), None) => PairUse::JointAdjustment,
            _ => PairUse::NominalScale,
        };
        let asked = self.asked(&scale.columns, &scale.rows, scale.discard_s.as_ref(), None)?;
        let mut dwell = |seat: Seat| {
            let (key, file, mean, samples, std) = match seat {
                Seat::Down => (
                    "[scale] down",
                    &scale.down,
                    scale.down_mean_code,
                    scale.down_samples,
                    scale.down_std_code,
                ),
                _ => (
                    "[scale] up",
                    &scale.up,
                    scale.up_mean_code,
                    scale.up_samples,
                    scale.up_std_code,
                ),
            };
            let (readings, temperature_degc, place, record) = match (file, mean) {
                (Some(file), None) => {
                    let angle = if seat == Seat::Down { -90.0 } else { 90.0 };
                    let options = self.options(&asked, Some(angle));
                    let read = read_run_file(&self.inside(file)?, file, &options)?;
                    inputs.push(FileDigest { file: file.clone(), sha256: read.sha256 });
                    if !read.ignored.is_empty() {
                        findings.push(ignored_columns(file, &read.ignored));
                    }
                    let mut dwells = read.dwells.into_iter();
                    match (dwells.next(), dwells.next()) {
                        (Some(d), None) => (d.readings, d.temperature_degc, file.clone(), d.record),
                        _ => return Err(value(key, file, "a file with one dwell")),
                    }
                }
                (None, Some(mean)) if mean.is_finite() => {
                    let readings =
                        Readings::Averaged { mean, samples: samples.unwrap_or(1).max(1), std };
                    (readings, None, key.to_owned(), Record::default())
                }
                (None, None) => {
                    return Err(missing(
                        "[scale] up and down",
                        "up = \"up.csv\" and down = \"down.csv\", or up_mean_code and down_mean_code",
                    ));
                }
                (_, Some(mean)) => return Err(value(key, mean, "a file or a mean code, not both")),
            };
            let angle = Angle::from_deg(if seat == Seat::Down { -90.0 } else { 90.0 });
            Ok(Position { angle, seat, readings, temperature_degc, place, record })
        };
        let (up, down) = (dwell(Seat::Up)?, dwell(Seat::Down)?);
        Ok(VerticalPair { up, down, run: scale.run.clone(), alone })
    }
}

/// Names the lines at which the dwells of a continuous record begin.
fn cut_out(file: &str, dwells: &[Dwell]) -> Finding {
    const SHOWN: usize = 12;
    let lines: Vec<String> =
        dwells.iter().filter_map(|d| d.record.line).take(SHOWN).map(|l| l.to_string()).collect();
    let more = if dwells.len() > SHOWN { ", …" } else { "" };
    Finding {
        kind: FindingKind::DwellsCutOut,
        place: file.to_owned(),
        observed: format!("{} dwells, from lines {}{more} on", dwells.len(), lines.join(", ")),
        limit: "block means within 5 of their standard deviations of the dwell's level".into(),
        remedy: "look at the dwells with tumble check: each must be one position".into(),
    }
}

/// A file in the folder of a path whose name is much like the path's.
fn neighbour(path: &Path) -> Option<String> {
    let wanted = path.file_name()?.to_string_lossy().into_owned();
    let mut names: Vec<String> = std::fs::read_dir(path.parent()?)
        .ok()?
        .filter_map(|entry| Some(entry.ok()?.file_name().to_string_lossy().into_owned()))
        .filter(|name| name != EXPERIMENT_FILE)
        .collect();
    names.sort();
    nearest(&wanted, &names)
}

/// An angle between −180° (exclusive) and 180°.
fn half_turn(deg: f64) -> f64 {
    if deg > -180.0 && deg <= 180.0 {
        return deg;
    }
    let turned = deg.rem_euclid(360.0);
    if turned > 180.0 { turned - 360.0 } else { turned }
}

/// Degrees for people: minutes and gon make endless decimals.
fn tidy(deg: f64) -> f64 {
    (deg * 1e6).round() / 1e6
}

fn ignored_columns(file: &str, columns: &[String]) -> Finding {
    Finding {
        kind: FindingKind::IgnoredColumns,
        place: file.to_owned(),
        observed: first_of(columns),
        limit: "angle_deg, code, t_s, temperature_degc, position".into(),
        remedy: "if one of them holds something that matters, name it in `columns` of its [[run]]"
            .into(),
    }
}
