//! `tumble certify`

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use tumble_core::assess::LeftOut;
use tumble_core::estimate::{EstimateOptions, Method, TermChoice, TermSet, Weights};
use tumble_io::passport::Passport;
use tumble_io::{
    Catalogue, CertifyError, CertifyOptions, Existing, OutputError, OutputFolder, Written,
    certify_watched,
};

use crate::cli::{CertifyArgs, MethodArg, WeightsArg};
use crate::exit::{Exit, complain};
use crate::interrupt;
use crate::progress::Progress;

pub(crate) fn run(args: &CertifyArgs) -> Exit {
    let options = match options(args) {
        Ok(options) => options,
        Err((why, exit)) => {
            complain(why);
            return exit;
        }
    };
    let several = args.folders.len() > 1;
    let mut taken = BTreeSet::new();
    let mut worst = Exit::Ok;
    let progress = Progress::new(args.quiet);
    for folder in &args.folders {
        let exit = match certify_watched(folder, &options, &progress) {
            Ok(passport) => {
                progress.clear();
                let out = args.out.as_ref().map(|out| {
                    if several {
                        out.join(subfolder(&passport, folder, &mut taken))
                    } else {
                        out.clone()
                    }
                });
                deliver(args, &passport, folder, out.as_deref(), several)
            }
            Err(e) => {
                progress.clear();
                // The file is named inside the folder; which folder, only several make unclear.
                complain(if several {
                    format!("{}: {e}", folder.display())
                } else {
                    e.to_string()
                });
                match &e {
                    CertifyError::Read(r) => Exit::of_reading(r),
                    CertifyError::Assess(_) | CertifyError::NotFinite => Exit::Usage,
                }
            }
        };
        worst = worst.worse(exit);
        if interrupt::interrupted() {
            return Exit::Interrupted;
        }
    }
    worst
}

fn options(args: &CertifyArgs) -> Result<CertifyOptions, (String, Exit)> {
    let usage = |why: &str| (why.to_owned(), Exit::Usage);
    let method = match args.method {
        MethodArg::Paper => Method::Paper,
        MethodArg::Exact => Method::Exact,
        MethodArg::Likelihood => Method::Likelihood,
    };
    let weights = match (args.method, args.weights) {
        (MethodArg::Paper, Some(WeightsArg::Angle | WeightsArg::Stated)) => {
            return Err(usage(
                "--method paper is unweighted by definition; leave --weights out, or use another method",
            ));
        }
        (MethodArg::Exact, Some(WeightsArg::Stated)) => {
            return Err(usage(
                "--weights stated is for --method likelihood; --method exact takes angle or equal",
            ));
        }
        (MethodArg::Paper, _) | (_, Some(WeightsArg::Equal)) => Weights::Equal,
        (_, Some(WeightsArg::Stated)) => Weights::Stated,
        (_, Some(WeightsArg::Angle) | None) => Weights::Angle,
    };
    let terms = match (args.method, args.terms) {
        (MethodArg::Paper, Some(TermChoice::Named(set))) if !set.is_empty() => {
            return Err(usage(
                "--method paper has no further terms by definition; leave --terms out, or use another method",
            ));
        }
        (MethodArg::Paper, Some(TermChoice::Auto)) => {
            return Err(usage(
                "--method paper has no further terms by definition; leave --terms out, or use another method",
            ));
        }
        (MethodArg::Paper, _) => TermChoice::Named(TermSet::EMPTY),
        (_, choice) => choice.unwrap_or_default(),
    };
    Ok(CertifyOptions {
        estimate: EstimateOptions {
            method,
            weights,
            level: args.level,
            monte_carlo_digits: args.monte_carlo,
            terms,
        },
        id: args.id.clone(),
        issued: args.issued.clone(),
        catalogue: args.catalogue.as_deref().map(Catalogue::read).transpose().map_err(|e| {
            let exit = Exit::of_reading(&e);
            (e.to_string(), exit)
        })?,
        left_out: args
            .leave_out
            .iter()
            .flat_map(|l| l.positions.iter().map(|n| LeftOut { run: l.run.clone(), position: *n }))
            .collect(),
    })
}

/// Prints and writes one passport.
fn deliver(
    args: &CertifyArgs,
    passport: &Passport,
    folder: &Path,
    out: Option<&Path>,
    several: bool,
) -> Exit {
    let verdict = verdict_exit(args, passport);
    let text = match (args.quiet, args.json, several) {
        (true, _, _) => Ok(String::new()),
        (_, true, true) => serde_json::to_string(passport)
            .map(|line| format!("{line}\n"))
            .map_err(|e| e.to_string()),
        (_, true, false) => passport.to_json().map_err(|e| e.to_string()),
        (_, false, true) => {
            Ok(format!("== {}\n{}\n", folder.display(), tumble_report::summary(passport)))
        }
        (_, false, false) => Ok(tumble_report::summary(passport)),
    };
    match text {
        Ok(text) if crate::exit::deliver(&text) == Exit::Ok => {}
        Ok(_) => return Exit::Failure,
        Err(e) => {
            complain(e);
            return Exit::Failure;
        }
    }
    let Some(out) = out else { return verdict };
    match write(passport, out, args) {
        Ok(written) => {
            if !args.quiet {
                tell(out, &written);
            }
            verdict
        }
        Err(e) => {
            complain(&e);
            Exit::of_writing(&e)
        }
    }
}

fn verdict_exit(args: &CertifyArgs, passport: &Passport) -> Exit {
    let warned = passport.findings.iter().any(|f| f.severity == "warning");
    match passport.verdict.as_str() {
        "accepted" if args.strict && warned => Exit::Warnings,
        "accepted" => Exit::Ok,
        "rejected" => Exit::Rejected,
        _ => Exit::Indeterminate,
    }
}

fn write(passport: &Passport, out: &Path, args: &CertifyArgs) -> Result<Written, OutputError> {
    let mut output = OutputFolder::default();
    let json = passport.to_json().map_err(|e| OutputError::Io {
        path: out.join("passport.json"),
        source: std::io::Error::other(e.to_string()),
    })?;
    output.add("passport.json", json);
    output.add("passport.html", tumble_report::html(passport));
    for figure in tumble_report::figures(passport) {
        output.add(format!("figures/{}.svg", figure.name), figure.svg);
    }
    let existing = if args.replace { Existing::Replace } else { Existing::Keep };
    interrupt::while_writing(|| output.write(out, existing, &interrupt::interrupted))
}

fn tell(out: &Path, written: &Written) {
    match written {
        Written::New => eprintln!("wrote {}", out.join("passport.html").display()),
        Written::Same => eprintln!("{} holds this result already", out.display()),
        Written::Replaced { kept } => {
            eprintln!(
                "wrote {}; the old result is in {}",
                out.join("passport.html").display(),
                kept.display()
            );
        }
    }
}

/// A name for a unit's folder: its serial, made safe; where two units share it, the experiment's folder is added.
fn subfolder(passport: &Passport, folder: &Path, taken: &mut BTreeSet<String>) -> PathBuf {
    let safe = |text: &str| -> String {
        let kept: String = text
            .chars()
            .map(|c| if c.is_alphanumeric() || matches!(c, '-' | '_' | '.') { c } else { '_' })
            .take(80)
            .collect();
        kept.trim_start_matches('.').to_owned()
    };
    let of_folder = safe(&folder.file_name().unwrap_or_default().to_string_lossy());
    let serial = safe(&passport.sensor.serial);
    let wanted = if serial.is_empty() { of_folder.clone() } else { serial };
    let name = if taken.contains(&wanted) { format!("{wanted}-{of_folder}") } else { wanted };
    let name = (1..)
        .map(|n| if n == 1 { name.clone() } else { format!("{name}-{n}") })
        .find(|n| !taken.contains(n))
        .unwrap_or(name);
    taken.insert(name.clone());
    PathBuf::from(name)
}
