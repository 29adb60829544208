//! `tumble noise`

use std::path::Path;

use tumble_core::noise::{Deviation, Spacing, Times};
use tumble_io::noise::{NoiseDocument, NoiseFailure, NoiseSettings, Scale, TimeUnit, analyse};
use tumble_io::passport::Passport;
use tumble_io::{Catalogue, Existing, OutputError, OutputFolder, Proof, Written, compensator};

use crate::cli::{DeviationArg, NoiseArgs, TausArg, TimeUnitArg};
use crate::exit::{Exit, complain, deliver};
use crate::interrupt;
use crate::progress::Progress;

pub(crate) fn run(args: &NoiseArgs) -> Exit {
    let settings = match settings(args) {
        Ok(settings) => settings,
        Err(why) => {
            complain(why);
            return Exit::Usage;
        }
    };
    let progress = Progress::new(args.quiet);
    // As other programs do; the path is that of Unix.
    let file = if args.file.as_os_str() == "-" { Path::new("/dev/stdin") } else { &args.file };
    let found = analyse(file, &settings, &progress);
    progress.clear();
    let document = match found {
        Ok(document) => document,
        Err(e) => {
            complain(&e);
            return match &e {
                NoiseFailure::Read(r) => Exit::of_reading(r),
                _ => Exit::Usage,
            };
        }
    };
    let json = match document.to_json() {
        Ok(json) => json,
        Err(e) => {
            complain(e);
            return Exit::Failure;
        }
    };
    let text = match (args.quiet, args.json) {
        (true, _) => String::new(),
        (_, true) => json.clone(),
        _ => tumble_report::noise_table(&document),
    };
    match deliver(&text) {
        Exit::Ok => {}
        failed => return failed,
    }
    match write(args, &document, json) {
        Ok(()) => Exit::Ok,
        Err(e) => {
            complain(&e);
            Exit::of_writing(&e)
        }
    }
}

fn settings(args: &NoiseArgs) -> Result<NoiseSettings, String> {
    let times = match args.taus {
        TausArg::Octave => Times::Spaced(Spacing::Octave),
        TausArg::Decade => Times::Spaced(Spacing::Decade),
        TausArg::All => Times::All,
    };
    let deviations: Vec<Deviation> = args
        .deviation
        .iter()
        .map(|d| match d {
            DeviationArg::Allan => Deviation::Allan,
            DeviationArg::Modified => Deviation::Modified,
            DeviationArg::Hadamard => Deviation::Hadamard,
            DeviationArg::Total => Deviation::Total,
        })
        .collect();
    if times == Times::All && deviations.iter().any(|d| *d != Deviation::Allan) {
        return Err(
            "--taus all is for the overlapping Allan deviation; leave --deviation out, or \
                    take --taus octave"
                .into(),
        );
    }
    Ok(NoiseSettings {
        column: args.column.clone(),
        rate_hz: args.rate,
        time: args.time.clone(),
        time_unit: args.time_unit.map(|unit| match unit {
            TimeUnitArg::S => TimeUnit::Seconds,
            TimeUnitArg::Ms => TimeUnit::Milliseconds,
            TimeUnitArg::Us => TimeUnit::Microseconds,
            TimeUnitArg::Ns => TimeUnit::Nanoseconds,
            TimeUnitArg::Date => TimeUnit::Date,
        }),
        scale: scale(args)?,
        deviations,
        times,
        level: args.level,
    })
}

/// The scale, by whichever way it was given.
fn scale(args: &NoiseArgs) -> Result<Option<Scale>, String> {
    if let Some(m_s2_per_unit) = args.scale {
        return Ok(Some(Scale { m_s2_per_unit, source: "as given".into() }));
    }
    if let Some(path) = &args.passport {
        let name = path.display();
        let passport = Passport::read(path).map_err(|e| format!("{name}: {e}"))?;
        let of_unit = compensator(&passport, Proof::Waived).map_err(|e| format!("{name}: {e}"))?;
        let source = format!("scale factor of {name}");
        // A scale factor may be negative; deviations do not know signs.
        return Ok(Some(Scale {
            m_s2_per_unit: of_unit.coefficients.scale_factor_m_s2_per_lsb.abs(),
            source,
        }));
    }
    let Some(model) = &args.sensor else { return Ok(None) };
    of_type(model, args.mode.as_deref()).map(Some)
}

/// The nominal scale of a type of the catalogue.
fn of_type(model: &str, mode: Option<&str>) -> Result<Scale, String> {
    let catalogue = Catalogue::builtin();
    let Some(entry) = catalogue.find(model) else {
        return Err(format!(
            "no sensor `{model}` in the catalogue{}; `tumble catalogue` lists them, or give --scale",
            match catalogue.nearest(model)[..] {
                [] => String::new(),
                [first, ..] => format!(" (is it {first}?)"),
            }
        ));
    };
    let digital: Vec<(&str, f64)> = entry
        .modes()
        .iter()
        .filter_map(|m| m.nominal_scale_m_s2_per_lsb().map(|s| (m.name.as_str(), s)))
        .collect();
    if digital.is_empty() {
        return Err(format!(
            "{} is analogue: its scale depends on the converter; give --scale, m/s² per LSB",
            entry.model()
        ));
    }
    let chosen = match (mode, &digital[..]) {
        (Some(mode), _) => named_mode(mode, &digital),
        (None, [one]) => Some(*one),
        (None, _) => None,
    };
    let Some((name, m_s2_per_unit)) = chosen else {
        let names: Vec<String> =
            digital.iter().map(|(name, _)| format!("--mode '{name}'")).collect();
        let what = match mode {
            Some(mode) => format!("{} has no one mode `{mode}`; give", entry.model()),
            None => format!("say which mode of {}:", entry.model()),
        };
        return Err(format!("{what} {}", names.join(" or ")));
    };
    Ok(Scale { m_s2_per_unit, source: format!("nominal scale of {} at {name}", entry.model()) })
}

/// The mode of that name, or the only one that begins so, whatever the case, blanks and the sign of `±`.
fn named_mode<'m>(wanted: &str, modes: &[(&'m str, f64)]) -> Option<(&'m str, f64)> {
    let plain = |text: &str| -> String {
        let text = text.to_lowercase().replace("+-", "");
        text.chars().filter(|c| !c.is_whitespace() && !matches!(c, '±' | '+')).collect()
    };
    let wanted = plain(wanted);
    if wanted.is_empty() {
        return None;
    }
    if let Some(exact) = modes.iter().find(|(name, _)| plain(name) == wanted) {
        return Some(*exact);
    }
    let mut begin = modes.iter().filter(|(name, _)| plain(name).starts_with(&wanted));
    begin.next().filter(|_| begin.next().is_none()).copied()
}

fn write(args: &NoiseArgs, document: &NoiseDocument, json: String) -> Result<(), OutputError> {
    let Some(out) = &args.out else { return Ok(()) };
    let mut output = OutputFolder::default();
    output.add("noise.json", json);
    output.add("noise.html", tumble_report::noise_page(document));
    if let Some(figure) = tumble_report::noise_figure(document) {
        output.add("noise.svg", figure.svg);
    }
    let existing = if args.replace { Existing::Replace } else { Existing::Keep };
    let written =
        interrupt::while_writing(|| output.write(out, existing, &interrupt::interrupted))?;
    if !args.quiet {
        match written {
            Written::New => eprintln!("wrote {}", out.join("noise.html").display()),
            Written::Same => eprintln!("{} holds this result already", out.display()),
            Written::Replaced { kept } => eprintln!(
                "wrote {}; the old result is in {}",
                out.join("noise.html").display(),
                kept.display()
            ),
        }
    }
    Ok(())
}
