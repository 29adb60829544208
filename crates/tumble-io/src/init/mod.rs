//! `tumble init`: from somebody's files to a commented experiment.toml.
//!
//! It asks nothing. What the files show is taken from them; what they cannot show is assumed, said to be assumed, and
//! written so that the next step tells what is missing. Nothing but experiment.toml is written.

mod columns;
mod draft;
mod names;
mod refine;
mod roles;
mod survey;

use std::path::{Path, PathBuf};

use tumble_core::Angle;

use crate::error::{Place, Problem, ReadError};
use crate::folder::{EXPERIMENT_FILE, ExperimentFolder, read_described};
use crate::source::Watch;
use draft::{Draft, Kind, line, quoted};
use names::Named;
use survey::Survey;

/// What the user says beside the files.
#[derive(Debug, Clone, Default)]
pub struct InitFacts {
    /// Model of the sensor.
    pub model: Option<String>,
    /// Serial number.
    pub serial: Option<String>,
    /// Column that holds the readings, by its header.
    pub reading: Option<String>,
    /// Local gravity, m/s².
    pub gravity_m_s2: Option<f64>,
    /// Latitude, degrees, and height, m.
    pub site: Option<(f64, f64)>,
    /// m/s² per LSB.
    pub nominal_scale: Option<f64>,
    /// Random setting error of the table.
    pub angle_uncertainty: Option<Angle>,
}

/// What was assumed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Assumed {
    /// Key with its table.
    pub key: String,
    /// Value, as experiment.toml has it.
    pub value: String,
    /// Why.
    pub why: String,
}

/// An experiment.toml that is to be written.
#[derive(Debug)]
pub struct InitDraft {
    /// Folder of the files.
    pub folder: PathBuf,
    /// The text.
    pub toml: String,
    /// What was seen in the files.
    pub seen: Vec<Assumed>,
    /// What was assumed.
    pub assumed: Vec<Assumed>,
    /// What is missing before a passport can be had.
    pub missing: Vec<String>,
    /// The experiment as the text describes it, where it can be read.
    pub read: Result<ExperimentFolder, ReadError>,
}

/// Looks at files and drafts an experiment.toml for their folder.
///
/// **Errors** [`ReadError`] where the files lie in different folders, cannot be opened, or hold nothing that looks like
/// rows of numbers.
pub fn draft_experiment(
    files: &[PathBuf],
    facts: &InitFacts,
    watch: &dyn Watch,
) -> Result<InitDraft, ReadError> {
    let folder = common_folder(files)?;
    let mut surveys = Vec::new();
    for file in files {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        surveys.push(survey::survey(file, &name, watch)?);
    }
    let first = &surveys[0];
    if let Some(other) = surveys.iter().find(|s| !columns::alike(s, first)) {
        return Err(ReadError {
            place: Place::file(other.shown_as.as_str()),
            problem: Problem::Format {
                seen: "the file is written otherwise than the first one (separator, header or number of columns)",
                remedy: "run tumble init for files of one kind, and add the others to experiment.toml by hand",
            },
        });
    }
    let roles = roles::roles(first);
    let mut draft = Draft::default();
    let mut missing = Vec::new();
    columns::sensor(&mut draft, facts, first, &roles);
    columns::csv(&mut draft, &surveys, &roles);
    columns::times(first, &roles, &mut missing);
    columns::bench(&mut draft, facts, first, &roles, &mut missing);
    layout(&mut draft, &surveys, &roles);
    let read = refine::refine(&mut draft, &folder, facts, &surveys, &roles, &mut missing, watch);
    let listed = |kind: Kind| {
        let mut all: Vec<Assumed> = Vec::new();
        for (key, l) in draft.of(kind) {
            let new = Assumed { key, value: l.value.clone(), why: l.why.clone() };
            // Lines of several runs are often the same.
            if !all.contains(&new) {
                all.push(new);
            }
        }
        all
    };
    Ok(InitDraft {
        toml: draft.toml(),
        seen: listed(Kind::Seen),
        assumed: listed(Kind::Assumed),
        missing,
        read,
        folder,
    })
}

/// The folder that all files lie in.
fn common_folder(files: &[PathBuf]) -> Result<PathBuf, ReadError> {
    let of = |file: &PathBuf| -> PathBuf {
        match file.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_path_buf(),
            _ => PathBuf::from("."),
        }
    };
    let Some(first) = files.first() else {
        let what = "no files were given; name the CSV files of one sensor";
        return Err(ReadError { place: Place::file(""), problem: Problem::Empty { what } });
    };
    let folder = of(first);
    match files.iter().find(|f| of(f) != folder) {
        Some(other) => Err(ReadError {
            place: Place::file(other.display().to_string()),
            problem: Problem::Format {
                seen: "lies in another folder than the first file",
                remedy: "put the files of one sensor into one folder; experiment.toml is written there",
            },
        }),
        None => Ok(folder),
    }
}

/// Reads what the draft describes.
fn read(draft: &Draft, folder: &Path, watch: &dyn Watch) -> Result<ExperimentFolder, ReadError> {
    read_described(folder, draft.toml().as_bytes(), None, watch)
}

/// Files as runs, as one file an angle, as up and down, or as continuous records.
fn layout(draft: &mut Draft, surveys: &[Survey], roles: &roles::Roles) {
    let stems: Vec<&str> = surveys.iter().map(|s| stem(&s.shown_as)).collect();
    let mut named: Vec<(&Survey, Option<Named>)> =
        surveys.iter().zip(names::named(&stems)).collect();
    if roles.angle.is_some() {
        for s in surveys {
            draft.runs.push(vec![line("file", quoted(&s.shown_as), "", Kind::Seen)]);
        }
        return;
    }
    let upright = |wanted: Named| {
        let found: Vec<&Survey> =
            named.iter().filter(|(_, n)| *n == Some(wanted)).map(|(s, _)| *s).collect();
        found
    };
    let (ups, downs) = (upright(Named::Up), upright(Named::Down));
    if let ([up], [down]) = (&ups[..], &downs[..]) {
        draft.set("scale", "up", quoted(&up.shown_as), "by its name", Kind::Seen);
        draft.set("scale", "down", quoted(&down.shown_as), "by its name", Kind::Seen);
        named.retain(|(_, n)| !matches!(n, Some(Named::Up | Named::Down)));
    }
    let angles: Vec<(String, f64)> = named
        .iter()
        .filter_map(|(s, n)| match n {
            Some(Named::Angle(a)) => Some((s.shown_as.clone(), *a)),
            _ => None,
        })
        .collect();
    let counted = angles.len() > 2
        && (0..).zip(&angles).all(|(i, (_, a))| (*a - f64::from(i)).abs() < 1.5)
        && angles.windows(2).all(|w| w[1].1 - w[0].1 == 1.0)
        && angles[0].1 >= 0.0;
    // One file alone is a record of many positions; a number in its name is anything.
    if angles.len() == named.len() && surveys.len() > 1 && !angles.is_empty() && !counted {
        let mut sorted = angles;
        sorted.sort_by(|a, b| a.1.total_cmp(&b.1));
        let list: Vec<String> = sorted
            .iter()
            .map(|(f, a)| format!("    {{file = {}, angle_deg = {a:?}}},", quoted(f)))
            .collect();
        let value = format!("[\n{}\n]", list.join("\n"));
        let why = "one file an angle, by the names; their order is by angle: put them in the order of measurement";
        draft.runs.push(vec![line("files", value, why, Kind::Assumed)]);
    } else {
        for (s, _) in named {
            draft.runs.push(vec![
                line("file", quoted(&s.shown_as), "", Kind::Seen),
                line(
                    "angles_deg",
                    "[]",
                    "no column of angles: the record is cut where the sensor stood still",
                    Kind::Seen,
                ),
            ]);
        }
    }
}

/// A file's name without its endings.
fn stem(name: &str) -> &str {
    let mut stem = name;
    for ending in [".gz", ".zst", ".csv", ".txt", ".tsv", ".dat", ".log", ".asc"] {
        if stem.len() > ending.len() && stem.to_lowercase().ends_with(ending) {
            stem = &stem[..stem.len() - ending.len()];
        }
    }
    stem
}

/// Where the text would be written.
#[must_use]
pub fn experiment_file(folder: &Path) -> PathBuf {
    folder.join(EXPERIMENT_FILE)
}
