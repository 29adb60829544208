//! Some runs backwards in sign among others that are not.

use crate::{Finding, FindingKind, Run};

/// Where some runs are reversed and others are not, the dial counts as it should: each reversed run is told what it
/// needs itself.
pub fn some_runs_reversed(findings: &mut [Finding], runs: &[Run]) {
    let reversed: Vec<&str> = findings
        .iter()
        .filter(|f| f.kind == FindingKind::SignReversed)
        .map(|f| f.place.as_str())
        .collect();
    let against = |name: &str| reversed.contains(&name);
    if reversed.is_empty() || runs.iter().all(|r| against(&r.name)) {
        return;
    }
    let direction = |run: &Run| {
        run.positions.iter().find_map(|p| p.record.dial.as_ref()).map(|d| d.direction.signum())
    };
    let of_others = runs.iter().find(|r| !against(&r.name)).and_then(direction);
    let remedies: Vec<(String, String)> = runs
        .iter()
        .filter(|r| against(&r.name))
        .map(|r| {
            let is_turned = direction(r).zip(of_others).is_some_and(|(a, b)| a != b);
            let remedy = if is_turned {
                "the other runs are not reversed: take orientation = \"reversed\" out of its [[run]], or correct the sign of the angles in its file"
            } else {
                "the other runs are not reversed: if the body was turned by 180°, set orientation = \"reversed\" in its [[run]]; if its angles are typed with the other sign, correct them in its file"
            };
            (r.name.clone(), remedy.to_owned())
        })
        .collect();
    for f in findings.iter_mut().filter(|f| f.kind == FindingKind::SignReversed) {
        if let Some((_, remedy)) = remedies.iter().find(|(name, _)| *name == f.place) {
            f.remedy.clone_from(remedy);
        }
    }
}
