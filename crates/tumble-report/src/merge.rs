//! Findings of one kind in several places (mostly one a run) told once.

use tumble_io::passport::Finding;

use crate::words::one_line;

/// A finding with everywhere it was made.
pub(crate) struct Merged<'p> {
    /// The first of them.
    pub finding: &'p Finding,
    /// Place and what was observed there, in the order of the passport.
    seen: Vec<(&'p str, &'p str)>,
}

impl Merged<'_> {
    /// All places, in one line.
    pub fn places(&self) -> String {
        let places: Vec<&str> =
            self.seen.iter().map(|(place, _)| *place).filter(|p| !p.is_empty()).collect();
        one_line(&places.join(", "))
    }

    /// What was observed: once where it is the same everywhere, else place by place.
    pub fn observed(&self) -> Vec<String> {
        let first = self.finding.observed.as_str();
        if self.seen.iter().all(|(_, observed)| *observed == first) {
            return vec![one_line(first)];
        }
        self.seen
            .iter()
            .map(|(place, observed)| one_line(&format!("{place}: {observed}")))
            .collect()
    }
}

/// Findings that differ only in place and observation become one.
pub(crate) fn merged<'p>(findings: impl IntoIterator<Item = &'p Finding>) -> Vec<Merged<'p>> {
    let mut out: Vec<Merged<'p>> = Vec::new();
    let same = |a: &Finding, b: &Finding| {
        (&a.id, &a.severity, &a.title, &a.limit, &a.todo)
            == (&b.id, &b.severity, &b.title, &b.limit, &b.todo)
    };
    for f in findings {
        match out.iter_mut().find(|m| same(m.finding, f)) {
            Some(m) => m.seen.push((&f.place, &f.observed)),
            None => out.push(Merged { finding: f, seen: vec![(&f.place, &f.observed)] }),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(place: &str, observed: &str) -> Finding {
        Finding {
            id: "T0205".into(),
            severity: "warning".into(),
            title: "two parameters are hard to tell apart".into(),
            place: place.into(),
            observed: observed.into(),
            limit: "condition number 30".into(),
            todo: "use the whole range".into(),
        }
    }

    #[test]
    fn one_kind_in_several_places() {
        let same = [finding("run-1", "48"), finding("run-2", "48")];
        let m = merged(&same);
        assert_eq!((m.len(), m[0].places().as_str()), (1, "run-1, run-2"));
        assert_eq!(m[0].observed(), ["48"]);
        let different = [finding("run-1", "48"), finding("run-2", "51")];
        assert_eq!(merged(&different)[0].observed(), ["run-1: 48", "run-2: 51"]);
    }
}
