//! The explanations of findings as JSON.

use serde::Serialize;
use tumble_core::FindingKind;

/// One kind of finding on the wire; names as in the passport's findings where they mean the same.
#[derive(Serialize)]
struct Explained {
    id: &'static str,
    severity: &'static str,
    title: &'static str,
    means: String,
    why: String,
    todo: String,
    verdict: &'static str,
    source: String,
}

/// Kinds with their explanations, a JSON list with a final newline.
///
/// **Errors** none that data can cause: all texts are valid.
pub fn explained_json(kinds: &[FindingKind]) -> Result<String, serde_json::Error> {
    let all: Vec<Explained> = kinds
        .iter()
        .map(|kind| {
            let e = kind.explanation();
            Explained {
                id: kind.id(),
                severity: kind.severity().name(),
                title: kind.title(),
                means: e.means,
                why: e.why,
                todo: e.todo,
                verdict: kind.consequence(),
                source: e.source,
            }
        })
        .collect();
    serde_json::to_string_pretty(&all).map(|text| text + "\n")
}
