//! `tumble completions`

use crate::cli::{CompletionsArgs, definition};
use crate::exit::{Exit, deliver};

pub(crate) fn run(args: &CompletionsArgs) -> Exit {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut definition(), "tumble", &mut script);
    deliver(&String::from_utf8_lossy(&script))
}
