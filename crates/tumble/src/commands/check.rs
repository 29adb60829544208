//! `tumble check`

use tumble_io::check;

use crate::cli::CheckArgs;
use crate::exit::{Exit, complain, deliver};
use crate::progress::Progress;

pub(crate) fn run(args: &CheckArgs) -> Exit {
    let progress = Progress::new(false);
    let read = check(&args.folder, &progress);
    progress.clear();
    let checked = match read {
        Ok(checked) => checked,
        Err(e) => {
            complain(&e);
            return Exit::of_reading(&e);
        }
    };
    let text = if args.json {
        match serde_json::to_string_pretty(&checked) {
            Ok(json) => json + "\n",
            Err(e) => {
                complain(e);
                return Exit::Failure;
            }
        }
    } else {
        tumble_report::check_table(&checked)
    };
    deliver(&text)
}
