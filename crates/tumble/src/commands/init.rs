//! `tumble init`

use std::path::Path;

use tumble_io::{Existing, InitFacts, draft_experiment, experiment_file, write_file};

use crate::cli::InitArgs;
use crate::exit::{Exit, complain, deliver};
use crate::interrupt;
use crate::progress::Progress;

pub(crate) fn run(args: &InitArgs) -> Exit {
    let facts = InitFacts {
        model: args.model.clone(),
        serial: args.serial.clone(),
        reading: args.reading.clone(),
        gravity_m_s2: args.gravity,
        site: args.latitude.zip(args.height),
        nominal_scale: args.scale,
        angle_uncertainty: args.scatter,
    };
    let progress = Progress::new(args.quiet);
    let drafted = draft_experiment(&args.files, &facts, &progress);
    progress.clear();
    let draft = match drafted {
        Ok(draft) => draft,
        Err(e) => {
            complain(&e);
            return Exit::of_reading(&e);
        }
    };
    if args.print {
        return deliver(&draft.toml);
    }
    let target = experiment_file(&draft.folder);
    let existing = if args.replace { Existing::Replace } else { Existing::Keep };
    let written = interrupt::while_writing(|| write_file(&target, draft.toml.as_bytes(), existing));
    let kept = match written {
        Ok(kept) => kept,
        Err(e) => {
            complain(&e);
            return Exit::of_writing(&e);
        }
    };
    if args.quiet {
        return Exit::Ok;
    }
    let printed = deliver(&tumble_report::init_summary(&draft));
    if let Some(kept) = kept {
        eprintln!("the old experiment.toml is now {}", kept.display());
    }
    let folder = shown(&draft.folder);
    eprintln!("wrote {}", target.display());
    if draft.read.is_ok() {
        eprintln!("next: tumble check {folder}, then tumble certify {folder}");
    } else {
        eprintln!("next: complete it, then tumble check {folder}");
    }
    printed
}

/// A folder as a command line takes it.
fn shown(folder: &Path) -> String {
    let text = folder.display().to_string();
    if text.contains(char::is_whitespace) { format!("'{text}'") } else { text }
}
