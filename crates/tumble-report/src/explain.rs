//! Findings explained: terminal text and the page of all of them.

use std::fmt::Write as _;

use tumble_core::FindingKind;

use crate::standing::{GROUPS, severity_word};
use crate::words::{capitalized, wrapped};

const WIDTH: usize = 80;
/// Column at which explanations start in the terminal.
const TEXTS: usize = 12;
/// Width of a line of the page, as in the other documents.
const PAGE_WIDTH: usize = 118;

/// Kinds explained for the terminal: plain text, at most 80 columns.
#[must_use]
pub fn explanations(kinds: &[FindingKind]) -> String {
    let texts: Vec<String> = kinds.iter().map(|k| one(*k)).collect();
    texts.join("\n")
}

fn one(kind: FindingKind) -> String {
    let e = kind.explanation();
    let head = format!("{}  {}  ", kind.id(), severity_word(kind.severity().name()));
    let mut out = wrapped(&head, kind.title(), head.chars().count(), WIDTH);
    out.push('\n');
    for (name, text) in [
        ("Seen", e.means.as_str()),
        ("Matters", &e.why),
        ("To do", &e.todo),
        ("Verdict", kind.consequence()),
        ("Source", &e.source),
    ] {
        out.push_str(&wrapped(&format!("  {name:<width$}", width = TEXTS - 2), text, TEXTS, WIDTH));
    }
    out
}

/// Every kind in one line: id, severity, title; at most 80 columns.
#[must_use]
pub fn explanation_list() -> String {
    let mut out = String::new();
    for kind in FindingKind::ALL {
        // Writing into a String cannot fail.
        let word = severity_word(kind.severity().name());
        let _ = writeln!(out, "{}  {word:<7}  {}", kind.id(), kind.title());
    }
    out.push_str("\n`tumble explain T0205` tells what one means, why it matters and what to do.\n");
    out
}

/// The page of all kinds in Markdown: `docs/findings.md`, byte for byte.
#[must_use]
pub fn explanation_page() -> String {
    let mut out = String::from(
        "<!-- Written by `tumble explain --markdown`: change crates/tumble-core/src/explanation, not this file. -->\n\
         # Findings\n\n",
    );
    out.push_str(&wrapped(
        "",
        "A finding is something worth knowing about an experiment that was judged. Each has a stable id, a severity, a \
         place, what was seen, what it was held against, and what to do. The verdict follows from the severities and \
         from nothing else. `tumble explain T0205` prints one of the explanations below; `tumble explain` lists them \
         all.",
        0,
        PAGE_WIDTH,
    ));
    out.push('\n');
    out.push_str("| severity | what it does to the verdict |\n|---|---|\n");
    for group in GROUPS {
        let _ = writeln!(out, "| {} | {} |", group.word, effect(group.severity));
    }
    out.push('\n');
    out.push_str(&wrapped(
        "",
        "Sources: *method* is the method of Tumble after Uspensky and Khatsko, by the numbers of its sections as the \
         comments in the code quote them; paths are those of this repository.",
        0,
        PAGE_WIDTH,
    ));
    out.push_str("\n| id | severity | finding |\n|---|---|---|\n");
    for kind in FindingKind::ALL {
        let (id, title) = (kind.id(), kind.title());
        let word = severity_word(kind.severity().name());
        let _ = writeln!(out, "| [{id}](#{}) | {word} | {title} |", anchor(*kind));
    }
    for kind in FindingKind::ALL {
        section(&mut out, *kind);
    }
    out
}

fn section(out: &mut String, kind: FindingKind) {
    let e = kind.explanation();
    let word = severity_word(kind.severity().name());
    let _ = writeln!(out, "\n## {} {}\n\n*{}*\n", kind.id(), kind.title(), capitalized(word));
    for (name, text) in [
        ("Seen", e.means.as_str()),
        ("Why it matters", &e.why),
        ("What to do", &e.todo),
        ("Verdict", kind.consequence()),
        ("Source", &e.source),
    ] {
        out.push_str(&wrapped(&format!("* **{name}.** "), &markdown(text), 2, PAGE_WIDTH));
    }
}

/// Tables of experiment.toml become code, for brackets are links in Markdown; other signs that mean something there
/// are escaped outside of code.
fn markdown(text: &str) -> String {
    let (mut code, mut depth) = (false, 0);
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '`' => code = !code,
            '[' if !code => {
                if depth == 0 {
                    out.push('`');
                }
                depth += 1;
            }
            '*' | '<' | '>' | '_' if !code && depth == 0 => out.push('\\'),
            _ => {}
        }
        out.push(c);
        if c == ']' && depth > 0 {
            depth -= 1;
            if depth == 0 {
                out.push('`');
            }
        }
    }
    out
}

/// The anchor that renderers of Markdown make of a heading.
fn anchor(kind: FindingKind) -> String {
    let heading = format!("{} {}", kind.id(), kind.title()).to_lowercase();
    heading
        .chars()
        .filter_map(|c| match c {
            ' ' => Some('-'),
            c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c),
            _ => None,
        })
        .collect()
}

fn effect(severity: &str) -> &'static str {
    // The first kind of each severity has its plain consequence; want of runs says its own in its section.
    FindingKind::ALL
        .iter()
        .find(|k| k.severity().name() == severity)
        .map_or("", |k| k.consequence())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eighty_columns_and_plain_text() {
        let text = explanations(FindingKind::ALL) + &explanation_list();
        for line in text.lines() {
            assert!(line.chars().count() <= WIDTH, "{line}");
            assert!(!line.chars().any(char::is_control), "no colour, no other signs: {line:?}");
        }
        // Id, severity in a word, title: nothing hangs on a colour.
        assert!(text.contains("T0205  warning  two parameters are hard to tell apart"), "{text}");
        for head in ["  Seen      ", "  Matters   ", "  To do     ", "  Verdict   ", "  Source    "]
        {
            assert_eq!(text.matches(head).count(), FindingKind::ALL.len(), "{head}");
        }
    }

    #[test]
    fn one_line_a_kind() {
        let list = explanation_list();
        let lines = list.lines().filter(|l| l.starts_with('T')).count();
        assert_eq!(lines, FindingKind::ALL.len());
    }

    #[test]
    fn the_page_links_to_every_section() {
        let page = explanation_page();
        for kind in FindingKind::ALL {
            assert!(page.contains(&format!("(#{})", anchor(*kind))), "{}", kind.id());
            assert!(page.contains(&format!("\n## {} {}\n", kind.id(), kind.title())));
        }
        assert_eq!(
            markdown("[bench], [[run]] and `[x] *` * y"),
            "`[bench]`, `[[run]]` and `[x] *` \\* y"
        );
        assert_eq!(
            anchor(FindingKind::DwellDrifts),
            "t0122-a-dwell-drifts-table-or-sensor-had-not-settled"
        );
    }
}
