//! `tumble explain`

use tumble_core::FindingKind;

use crate::cli::ExplainArgs;
use crate::exit::{Exit, complain, deliver};

pub(crate) fn run(args: &ExplainArgs) -> Exit {
    if args.markdown {
        return deliver(&tumble_report::explanation_page());
    }
    let mut kinds = Vec::new();
    for id in &args.ids {
        match FindingKind::from_id(id) {
            Some(kind) => kinds.push(kind),
            None => {
                complain(unknown(id));
                return Exit::Usage;
            }
        }
    }
    match (args.json, kinds.as_slice()) {
        (true, some) => {
            let json =
                tumble_io::explained_json(if some.is_empty() { FindingKind::ALL } else { some });
            match json {
                Ok(text) => deliver(&text),
                Err(e) => {
                    complain(e);
                    Exit::Failure
                }
            }
        }
        (false, []) => deliver(&tumble_report::explanation_list()),
        (false, some) => deliver(&tumble_report::explanations(some)),
    }
}

fn unknown(id: &str) -> String {
    let near: Vec<String> = FindingKind::nearest(id)
        .into_iter()
        .map(|k| format!("\n  {}  {}", k.id(), k.title()))
        .collect();
    let shown: String =
        id.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).take(40).collect();
    let near =
        if near.is_empty() { String::new() } else { format!("; near it are{}", near.concat()) };
    format!("no finding has the id `{shown}`{near}\n`tumble explain` without an id lists all")
}
