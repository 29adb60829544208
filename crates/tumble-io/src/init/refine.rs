//! What only the readings themselves can tell: which column follows the angle, scale, sign and zero, unit of the dial.
//!
//! Past 500 lines: each question changes the one draft and reads it again. Comparisons of first looks belong into the core
//! when they grow.

use std::path::Path;

use tumble_core::{FirstLook, Position, STANDARD_GRAVITY_M_S2, first_look};

use super::InitFacts;
use super::columns::{has_gaps, map};
use super::draft::{Draft, Kind, quoted};
use super::read;
use super::roles::{Roles, angle_unit};
use super::survey::Survey;
use crate::catalogue::Catalogue;
use crate::csv::HeaderUnit;
use crate::error::{Place, Problem, ReadError};
use crate::folder::ExperimentFolder;
use crate::source::Watch;

/// Candidates for the reading that are tried.
const CANDIDATES: usize = 8;
/// Left-over, relative to half the spread of the dwells, from which another unit of the dial is tried.
const BAD_FIT: f64 = 0.003;
/// How many times better another reading of the file must fit before it is assumed.
const MUCH_BETTER: f64 = 5.0;
/// Logarithm of the ratio to a mode's scale factor up to which the unit is taken to be in that mode: modes differ by
/// factors of two.
const NEAR_MODE: f64 = 0.25;
/// Fewest codes in 1 g: averages that are smaller are no codes.
const FEWEST_CODES_IN_G: f64 = 20.0;
/// Word lengths of converters.
const WORDS: [u32; 9] = [8, 10, 12, 14, 16, 18, 20, 24, 32];

struct Refiner<'a> {
    draft: &'a mut Draft,
    folder: &'a Path,
    facts: &'a InitFacts,
    surveys: &'a [Survey],
    roles: &'a Roles,
    missing: &'a mut Vec<String>,
    watch: &'a dyn Watch,
}

/// Refines a draft by reading what it describes; gives the experiment as it is read in the end.
pub(super) fn refine(
    draft: &mut Draft,
    folder: &Path,
    facts: &InitFacts,
    surveys: &[Survey],
    roles: &Roles,
    missing: &mut Vec<String>,
    watch: &dyn Watch,
) -> Result<ExperimentFolder, ReadError> {
    Refiner { draft, folder, facts, surveys, roles, missing, watch }.run()
}

impl Refiner<'_> {
    fn survey(&self) -> &Survey {
        &self.surveys[0]
    }

    fn run(&mut self) -> Result<ExperimentFolder, ReadError> {
        let chosen = self.choose_reading()?;
        self.describe_reading(chosen);
        if self.list_dwells() {
            return read(self.draft, self.folder, self.watch);
        }
        if let Ok(experiment) = read(self.draft, self.folder, self.watch) {
            self.follow(&experiment, chosen);
        }
        read(self.draft, self.folder, self.watch)
    }

    /// The column of the readings: the one asked for, the only one, or the one that follows the angle.
    fn choose_reading(&mut self) -> Result<Option<usize>, ReadError> {
        if let Some(wanted) = &self.facts.reading {
            let names = &self.survey().sketch.names;
            let by_name = names.iter().position(|n| n.to_lowercase() == wanted.to_lowercase());
            let by_number = || {
                wanted
                    .parse::<usize>()
                    .ok()
                    .and_then(|n| n.checked_sub(1))
                    .filter(|i| *i < names.len())
            };
            return by_name.or_else(by_number).map(Some).ok_or_else(|| ReadError {
                place: Place::line(
                    self.survey().shown_as.as_str(),
                    self.survey().sketch.header_line.max(1),
                ),
                problem: Problem::Columns {
                    seen: names.clone(),
                    what: format!("no column `{wanted}`"),
                    remedy: "name the column of the readings as the header does, or by its number"
                        .into(),
                },
            });
        }
        if self.roles.mean.is_some() {
            return Ok(self.roles.mean);
        }
        let candidates = self.roles.readings.clone();
        match candidates[..] {
            [] => Err(ReadError {
                place: Place::file(self.survey().shown_as.as_str()),
                problem: Problem::Columns {
                    seen: self.survey().sketch.names.clone(),
                    what: "no column of readings was found".into(),
                    remedy: "name it: tumble init --reading \"Your Header\" …".into(),
                },
            }),
            [one] => Ok(Some(one)),
            _ => Ok(Some(self.most_responsive(&candidates))),
        }
    }

    /// The candidate whose reading of 1 g along the sine of the angle is largest.
    fn most_responsive(&mut self, candidates: &[usize]) -> usize {
        let mut best: Option<(f64, usize)> = None;
        for i in candidates.iter().take(CANDIDATES) {
            self.describe_reading(Some(*i));
            let look = read(self.draft, self.folder, self.watch).ok().and_then(|e| look(&e));
            let Some(look) = look else { continue };
            let response = look.amplitude * look.along_sine().abs();
            let follows = look.relative_rms().is_none_or(|r| r < 0.2);
            if follows && best.is_none_or(|b| response > b.0 * 1.01) {
                best = Some((response, *i));
            }
        }
        best.map_or(candidates[0], |b| b.1)
    }

    /// `[output]` and `columns` for a choice of the reading.
    fn describe_reading(&mut self, chosen: Option<usize>) {
        let Some(index) = chosen else { return };
        map(self.draft, &self.surveys[0], self.roles, Some(index));
        let survey = &self.surveys[0];
        let column = &survey.columns[index];
        let averaged = self.roles.mean == Some(index);
        let unit = column.unit.and_then(HeaderUnit::of_readings);
        for key in ["code_format", "code_bits", "missing"] {
            self.draft.remove("csv", key);
        }
        self.draft.remove("output", "unit");
        if unit.is_none() && (averaged || !column.is_real()) {
            let why = "not seen in these codes; `floor` would shift the bias by half an LSB";
            self.draft.set("output", "quantizer", quoted("round"), why, Kind::Assumed);
        } else {
            self.draft.set("output", "quantizer", quoted("none"), "real numbers", Kind::Seen);
            let (unit, kind) = match unit {
                Some(unit) => (unit, Kind::Seen),
                None => ("V", Kind::Assumed),
            };
            self.draft.set("output", "unit", quoted(unit), "unit of the readings", kind);
        }
        if self.facts.nominal_scale.is_none() {
            // Stands in until the readings have been looked at.
            let why = "stands in until the readings have angles: write the data sheet's value, m/s² per LSB (or per unit)";
            self.draft.set("output", "nominal_scale", "1.0", why, Kind::Assumed);
        }
        if column.is_hexadecimal() {
            let bits =
                WORDS.into_iter().find(|b| *b as usize >= 4 * column.hex_digits).unwrap_or(32);
            self.draft.set("csv", "code_format", quoted("hex"), "", Kind::Seen);
            let why = format!("words of {} hexadecimal digits, with a sign", column.hex_digits);
            self.draft.set("csv", "code_bits", bits, why, Kind::Assumed);
        }
        if has_gaps(self.surveys, index) {
            self.draft.set(
                "csv",
                "missing",
                quoted("skip"),
                "rows without a reading are left out",
                Kind::Assumed,
            );
        }
        if self.roles.readings.len() > 1 && !averaged {
            let others: Vec<String> = self
                .roles
                .readings
                .iter()
                .filter(|i| **i != index)
                .map(|i| survey.columns[*i].name.clone())
                .collect();
            let axis = axis_of(&column.name);
            let why = format!(
                "readings of column `{}`; the others are {}",
                column.name,
                others.iter().take(6).cloned().collect::<Vec<_>>().join(", ")
            );
            self.draft.set("sensor", "axis", quoted(&axis), why, Kind::Assumed);
        } else {
            self.draft.set("sensor", "axis", quoted(&axis_of(&column.name)), "", Kind::Seen);
        }
    }

    /// Lists the dwells of continuous records, each for its angle to be filled in; `false` where there are none.
    fn list_dwells(&mut self) -> bool {
        let mut dwells = 0;
        for i in 0..self.draft.runs.len() {
            // Each file has its own dwells, and is read alone to find them.
            let mut alone = self.draft.clone();
            alone.runs = vec![self.draft.runs[i].clone()];
            let error = read(&alone, self.folder, self.watch).map_err(|e| e.problem);
            let Err(Problem::AnglesOfDwells { found, .. }) = error else { continue };
            let run = &mut self.draft.runs[i];
            let Some(angles) = run.iter_mut().find(|l| l.key == "angles_deg") else { continue };
            let list: Vec<String> = found.iter().map(|f| format!("    nan, # {f}")).collect();
            angles.value = format!("[\n{}\n]", list.join("\n"));
            angles.why =
                "the sensor stood still here; write the dial's angle in place of each nan".into();
            dwells += found.len();
        }
        if dwells > 0 {
            let dwells =
                if dwells == 1 { "1 dwell was".into() } else { format!("{dwells} dwells were") };
            self.missing.push(format!(
                "the angles: the files name none. {dwells} found; write the dial's angle of each into angles_deg"
            ));
        }
        dwells > 0
    }

    /// Scale, sign, zero and unit of the dial.
    fn follow(&mut self, experiment: &ExperimentFolder, chosen: Option<usize>) {
        self.rate(experiment);
        let Some(mut seen) = look(experiment) else { return };
        if let Some(better) = self.try_words(&seen, chosen) {
            seen = better;
        }
        if let Some(better) = self.try_units_of_the_dial(&seen, experiment) {
            seen = better;
        }
        self.middle_of_the_range(&seen, chosen);
        self.sign_and_zero(&seen);
        if let Some(better) = self.try_truncation(&seen, chosen) {
            seen = better;
        }
        self.scale(&seen, chosen);
        self.ends(experiment);
        if let Ok(again) = read(self.draft, self.folder, self.watch) {
            self.range(&again);
        }
    }

    fn rate(&mut self, experiment: &ExperimentFolder) {
        let rates: Vec<f64> = positions(experiment)
            .into_iter()
            .filter_map(|p| p.record.timing.as_ref().and_then(tumble_core::Timing::typical_step_s))
            .filter(|s| *s > 0.0)
            .map(|s| 1.0 / s)
            .collect();
        if let Some(rate) = rates.first() {
            self.draft.set(
                "output",
                "rate_hz",
                format!("{:?}", rounded(*rate, 4)),
                "by the times",
                Kind::Seen,
            );
        }
    }

    /// Tries one more line, and keeps it where the dwells follow the angles much better.
    fn try_line(
        &mut self,
        table: &'static str,
        key: &'static str,
        value: String,
        why: String,
        seen: &FirstLook,
    ) -> Option<FirstLook> {
        let before = self.draft.clone();
        self.draft.set(table, key, value, why, Kind::Assumed);
        let tried = read(self.draft, self.folder, self.watch).ok().and_then(|e| look(&e));
        // In readings, not relative to 1 g: small angles in a wrong unit make 1 g of any size.
        let better = tried.filter(|t| {
            let (old, new) = (seen.residual_rms, t.residual_rms);
            old.zip(new).is_some_and(|(old, new)| new * MUCH_BETTER < old)
        });
        if better.is_none() {
            *self.draft = before;
        }
        better
    }

    /// Signed words that were written without their sign; hexadecimal words that have none.
    fn try_words(&mut self, seen: &FirstLook, chosen: Option<usize>) -> Option<FirstLook> {
        let column = &self.surveys[0].columns[chosen?];
        if column.is_hexadecimal() {
            let before = self.draft.clone();
            self.draft.remove("csv", "code_bits");
            let why = "words without a sign: with one the readings would not follow the angles";
            let tried = self.try_line("csv", "code_format", quoted("hex"), why.into(), seen);
            if tried.is_none() {
                *self.draft = before;
            }
            return tried;
        }
        if !column.is_codes() || column.is_hexadecimal() || column.least < 0.0 {
            return None;
        }
        let index = chosen?;
        let largest = self.surveys.iter().map(|s| s.columns[index].largest).fold(0.0, f64::max);
        let bits = WORDS.into_iter().find(|b| largest < 2f64.powi(*b as i32))?;
        let why = format!("codes jump by 2^{bits}: signed words written without their sign");
        self.try_line("csv", "code_bits", bits.to_string(), why, seen)
    }

    /// A converter that cuts toward zero jumps by one LSB where its codes change their sign; rounding and flooring do not.
    fn try_truncation(&mut self, seen: &FirstLook, chosen: Option<usize>) -> Option<FirstLook> {
        let column = &self.surveys[0].columns[chosen?];
        if !column.is_codes() || column.least >= 0.0 || column.largest <= 0.0 {
            return None;
        }
        let before = self.draft.clone();
        let why = "the readings jump by one LSB where the codes change their sign: cut toward zero";
        self.draft.set("output", "quantizer", quoted("truncate"), why, Kind::Seen);
        let tried = read(self.draft, self.folder, self.watch).ok().and_then(|e| look(&e));
        let better = tried.filter(|t| {
            let rms = |l: &FirstLook| l.residual_rms.filter(|r| *r > 0.0);
            let gain = rms(seen).zip(rms(t)).map(|(old, new)| (old / new).ln());
            // Logarithm of the likelihood ratio; 7 is chance once in five thousand.
            gain.is_some_and(|g| g * t.residuals.len() as f64 > 7.0)
        });
        if better.is_none() {
            *self.draft = before;
        }
        better
    }

    fn try_units_of_the_dial(
        &mut self,
        seen: &FirstLook,
        experiment: &ExperimentFolder,
    ) -> Option<FirstLook> {
        let column = &self.surveys[0].columns[self.roles.angle?];
        let means: Vec<f64> =
            positions(experiment).into_iter().filter_map(|p| p.readings.mean()).collect();
        let spread = means.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            - means.iter().copied().fold(f64::INFINITY, f64::min);
        let fits = seen.residual_rms.is_none_or(|r| r < BAD_FIT * 0.5 * spread);
        if angle_unit(column).is_some() || fits {
            return None;
        }
        for (unit, limit) in [("rad", 6.3), ("gon", 400.0)] {
            if column.largest.max(-column.least) <= limit {
                let why = format!("the readings follow the sine of the angles only in {unit}");
                let better = self.try_line("bench", "angle_unit", quoted(unit), why, seen);
                if better.is_some() {
                    return better;
                }
            }
        }
        None
    }

    fn sign_and_zero(&mut self, seen: &FirstLook) {
        if self.roles.angle.is_none() {
            if seen.along_sine() < 0.0 {
                self.exchange_up_and_down();
            }
            return;
        }
        let phase = seen.phase.deg();
        let quarter = (phase / 90.0).round();
        match quarter as i32 {
            0 => {}
            2 | -2 => {
                let why = "the readings fall where the dial rises: it counts the other way, or the sensor is turned round";
                self.draft.set("bench", "angle_sign", "-1", why, Kind::Assumed);
            }
            q => {
                // A dial that reads 0 with the axis up counts down from there, one that reads 0 with the axis down up.
                let why = "the readings follow the cosine of the dial: its zero is where the axis stands upright";
                let (sign, zero) = if q > 0 { ("-1", 90.0) } else { ("1", 90.0) };
                if sign == "-1" {
                    self.draft.set("bench", "angle_sign", sign, why, Kind::Assumed);
                }
                self.draft.set("bench", "angle_zero_deg", format!("{zero:?}"), why, Kind::Assumed);
            }
        }
    }

    /// Up must read more than down.
    fn exchange_up_and_down(&mut self) {
        let of = |draft: &Draft, key: &str| {
            draft
                .of(Kind::Seen)
                .find(|(name, _)| *name == format!("[scale] {key}"))
                .map(|(_, l)| l.value.clone())
        };
        if let (Some(up), Some(down)) = (of(self.draft, "up"), of(self.draft, "down")) {
            let why = "the readings of `up` are below those of `down`: either the names are exchanged, or the sensor reads the \
                       pull of gravity, -g with its axis up; Tumble's readings are +g with the axis up";
            self.draft.set("scale", "up", down, why, Kind::Assumed);
            self.draft.set("scale", "down", up, why, Kind::Assumed);
        }
    }

    fn scale(&mut self, seen: &FirstLook, chosen: Option<usize>) {
        if let Some(scale) = self.facts.nominal_scale {
            self.draft.set(
                "output",
                "nominal_scale",
                format!("{scale:?}"),
                "m/s² per LSB",
                Kind::Said,
            );
            return;
        }
        let column = chosen.map(|i| &self.surveys[0].columns[i]);
        let header = column.and_then(|c| c.unit).and_then(HeaderUnit::of_readings);
        // Averages have decimals, whatever they are of; no converter has twenty codes in 1 g.
        let averaged = self.roles.mean.is_some() && seen.amplitude >= FEWEST_CODES_IN_G;
        let real = column.is_some_and(|c| !c.is_codes()) && !averaged;
        let (unit, seen_in_header) = match header {
            Some(unit) => (unit, true),
            None if real => (unit_by_size(seen), false),
            None => ("LSB", false),
        };
        if real || header.is_some() {
            self.draft.set("output", "quantizer", quoted("none"), "real numbers", Kind::Seen);
            let kind = if seen_in_header { Kind::Seen } else { Kind::Assumed };
            let why =
                if seen_in_header { "by the header" } else { "by the size of the readings at 1 g" };
            self.draft.set("output", "unit", quoted(unit), why, kind);
        }
        let exact = match unit {
            "g" => Some(STANDARD_GRAVITY_M_S2),
            "mg" => Some(STANDARD_GRAVITY_M_S2 * 1e-3),
            "m/s2" => Some(1.0),
            _ => None,
        };
        if exact.is_none()
            && let Some((scale, why)) = self.scale_of_type(unit, seen)
        {
            self.draft.set("output", "nominal_scale", format!("{scale:?}"), why, Kind::Seen);
            return;
        }
        match exact {
            Some(scale) => {
                let why = format!("m/s² per {unit}");
                self.draft.set("output", "nominal_scale", format!("{scale:?}"), why, Kind::Seen);
            }
            None => {
                let scale = rounded(seen.scale_m_s2(STANDARD_GRAVITY_M_S2), 3);
                let why = format!(
                    "m/s² per {unit}, fitted to these very readings: the scale error tells nothing until the data sheet's value stands here"
                );
                self.draft.set("output", "nominal_scale", format!("{scale:?}"), why, Kind::Assumed);
                self.missing.push(format!(
                    "the nominal scale factor: give --scale (m/s² per {unit}) from the data sheet; {scale:?} was fitted, so the scale error is near zero by construction"
                ));
            }
        }
    }

    /// The data sheet's scale factor, where the model names an entry with a mode near what is seen.
    fn scale_of_type(&self, unit: &str, seen: &FirstLook) -> Option<(f64, String)> {
        let entry = Catalogue::builtin().find(self.facts.model.as_deref()?)?;
        let fitted = seen.scale_m_s2(STANDARD_GRAVITY_M_S2);
        let (scale, mode) = entry
            .modes()
            .iter()
            .filter_map(|m| m.nominal_scale_m_s2_per(unit).map(|scale| (scale, m)))
            .min_by(|a, b| (a.0 / fitted).ln().abs().total_cmp(&(b.0 / fitted).ln().abs()))?;
        let near = (scale / fitted).ln().abs() < NEAR_MODE;
        let why = format!(
            "m/s² per {unit}: {} {} of {}, {} ({})",
            mode.sensitivity,
            mode.unit.name(),
            entry.model(),
            mode.name,
            mode.mark.words()
        );
        near.then(|| (rounded(scale, 7), why))
    }

    /// A converter that counts from the middle of its range: no negative code, and 0 g reads half of a word.
    fn middle_of_the_range(&mut self, seen: &FirstLook, chosen: Option<usize>) {
        let Some(column) = chosen.map(|i| &self.surveys[0].columns[i]) else { return };
        if column.is_real() || column.least < 0.0 || self.draft.has("csv", "code_bits") {
            return;
        }
        let middle = WORDS.into_iter().take(8).map(|b| 2f64.powi(b as i32 - 1)).find(|m| {
            (seen.offset - m).abs() < 0.25 * seen.amplitude && seen.offset > seen.amplitude
        });
        if let Some(middle) = middle {
            let why = "no code is negative and 0 g reads half of a word: offset binary, counted from the middle";
            self.draft.set("csv", "code_offset", format!("{middle:.0}"), why, Kind::Assumed);
        }
    }

    /// A converter that stands at the end of its word: whole dwells of one code `2ⁿ − 1` or `−2ⁿ`.
    fn ends(&mut self, experiment: &ExperimentFolder) {
        let clipped: Vec<i64> = positions(experiment)
            .iter()
            .filter(|p| p.readings.samples() >= 8)
            .filter_map(|p| p.readings.only_code().map(|c| i64::from(c.0)))
            .collect();
        let is_end = |n: i64| n >= 128 && n.count_ones() == 1;
        let why = "dwells of this one code: the converter stands at its end there";
        if let Some(top) = clipped.iter().max().filter(|c| is_end(**c + 1)) {
            self.draft.set("output", "max_code", top, why, Kind::Assumed);
        }
        if let Some(bottom) = clipped.iter().min().filter(|c| is_end(-**c)) {
            self.draft.set("output", "min_code", bottom, why, Kind::Assumed);
        }
    }

    /// Whether ±90° stand on the table like all others.
    fn range(&mut self, experiment: &ExperimentFolder) {
        if self.roles.angle.is_none() && !self.draft.runs.iter().flatten().any(|l| l.key == "files")
        {
            return;
        }
        let angles: Vec<f64> = positions(experiment).iter().map(|p| p.angle.deg()).collect();
        let upright = |a: f64| (a.abs() - 90.0).abs() < 1e-6;
        if !angles.iter().any(|a| upright(*a)) {
            return;
        }
        let others = angles.iter().copied().filter(|a| !upright(*a));
        let widest = others.fold(0.0f64, |w, a| w.max(a.abs()));
        if widest <= 1e-6 {
            let why =
                "only −90°, 0° and 90°: a cube or angle plate, all faces set against one surface";
            self.draft.set("bench", "angle_range_deg", "[-90.0, 90.0]", why, Kind::Assumed);
        } else if widest >= 70.0 {
            let why = "a dial that reaches ±90°";
            self.draft.set("bench", "angle_range_deg", "[-90.0, 90.0]", why, Kind::Assumed);
        }
    }
}

/// All positions of an experiment.
fn positions(folder: &ExperimentFolder) -> Vec<&Position> {
    let pair = folder.experiment.vertical.iter().flat_map(|p| [&p.up, &p.down]);
    folder.experiment.runs.iter().flat_map(|r| &r.positions).chain(pair).collect()
}

/// A look at the first run, or at the up/down pair.
fn look(folder: &ExperimentFolder) -> Option<FirstLook> {
    let quantizer = folder.experiment.output.quantizer;
    let run: Vec<&Position> = match folder.experiment.runs.first() {
        Some(run) => run.positions.iter().collect(),
        None => positions(folder),
    };
    first_look(&run, quantizer)
}

/// `acc_x` → `X`.
fn axis_of(name: &str) -> String {
    let last = name.split(|c: char| !c.is_alphanumeric()).find(|w| w.len() == 1).or_else(|| {
        let lower = name.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
        let axis = lower.len() >= 2 && lower.len() <= 6;
        axis.then(|| &lower[lower.len() - lower.chars().last().map_or(0, char::len_utf8)..])
    });
    last.map(str::to_uppercase)
        .filter(|a| ["X", "Y", "Z"].contains(&a.as_str()))
        .unwrap_or_default()
}

/// Unit of real readings by their size at 1 g.
fn unit_by_size(seen: &FirstLook) -> &'static str {
    match seen.amplitude {
        a if (0.8..1.25).contains(&a) && seen.offset.abs() < 0.5 => "g",
        a if (8.0..12.0).contains(&a) => "m/s2",
        a if (800.0..1250.0).contains(&a) => "mg",
        _ => "V",
    }
}

/// A number to so many significant digits.
fn rounded(value: f64, digits: i32) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let decimals = (digits - 1 - value.abs().log10().floor() as i32).max(0) as usize;
    format!("{value:.decimals$}").parse().unwrap_or(value)
}
