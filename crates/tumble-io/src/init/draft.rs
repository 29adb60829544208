//! The experiment.toml that is to be written: line by line, each with why it is so.

use std::fmt::Write as _;

use crate::error::printable;

/// Tables in the order in which they are written, with what stands under their names.
const TABLES: [(&str, &str); 6] = [
    ("", ""),
    ("sensor", "free texts; the model may name an entry of `tumble catalogue`"),
    ("output", ""),
    ("bench", ""),
    ("csv", "how the files are written"),
    ("scale", "axis up and axis down"),
];

/// Columns of the file. Longer comments stand above their line.
const WIDEST: usize = 96;

/// One line.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    pub(super) table: &'static str,
    pub(super) key: &'static str,
    /// As TOML writes it.
    pub(super) value: String,
    /// Why, for people.
    pub(super) why: String,
    pub(super) kind: Kind,
}

/// What a line is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Seen in the files.
    Seen,
    /// Assumed: it may be wrong, and is said to be assumed.
    Assumed,
    /// Said by the user.
    Said,
    /// An example that the user may switch on.
    Example,
}

/// All lines, and the runs.
#[derive(Debug, Clone, Default)]
pub(super) struct Draft {
    lines: Vec<Line>,
    /// Tables `[[run]]`, each with its lines.
    pub(super) runs: Vec<Vec<Line>>,
}

pub(super) fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

pub(super) fn line(
    key: &'static str,
    value: impl ToString,
    why: impl Into<String>,
    kind: Kind,
) -> Line {
    Line { table: "", key, value: value.to_string(), why: why.into(), kind }
}

impl Draft {
    /// Sets a line; a line of that key is replaced.
    pub(super) fn set(
        &mut self,
        table: &'static str,
        key: &'static str,
        value: impl ToString,
        why: impl Into<String>,
        kind: Kind,
    ) {
        let new = Line { table, ..line(key, value, why, kind) };
        match self.lines.iter_mut().find(|l| l.table == table && l.key == key) {
            Some(old) => *old = new,
            None => self.lines.push(new),
        }
    }

    pub(super) fn has(&self, table: &str, key: &str) -> bool {
        self.lines.iter().any(|l| l.table == table && l.key == key)
    }

    pub(super) fn remove(&mut self, table: &'static str, key: &'static str) {
        self.lines.retain(|l| l.table != table || l.key != key);
    }

    /// Lines of a kind, with the name that a reader of the file finds them under.
    pub(super) fn of(&self, kind: Kind) -> impl Iterator<Item = (String, &Line)> {
        let named = |l: &Line| match l.table {
            "" => l.key.to_owned(),
            table => format!("[{table}] {}", l.key),
        };
        let runs = self.runs.iter().flatten().map(|l| (format!("[[run]] {}", l.key), l));
        let all = self.lines.iter().map(move |l| (named(l), l)).chain(runs);
        all.filter(move |(_, l)| l.kind == kind)
    }

    /// The file.
    pub(super) fn toml(&self) -> String {
        let mut out = String::from(
            "# Written by `tumble init` after a look at the files. What is marked `assumed` may be wrong:\n\
             # look through it, then run `tumble check` and `tumble certify` on this folder.\n",
        );
        for (table, about) in TABLES {
            let lines: Vec<&Line> = self.lines.iter().filter(|l| l.table == table).collect();
            if lines.is_empty() {
                continue;
            }
            if !table.is_empty() {
                let about = if about.is_empty() { String::new() } else { format!("   # {about}") };
                let _ = writeln!(out, "\n[{table}]{about}");
            }
            lines.iter().for_each(|l| write_line(&mut out, l));
        }
        for run in &self.runs {
            out.push_str("\n[[run]]\n");
            run.iter().for_each(|l| write_line(&mut out, l));
        }
        out
    }
}

fn write_line(out: &mut String, l: &Line) {
    let mark = match l.kind {
        Kind::Assumed => "assumed: ",
        _ => "",
    };
    let off = if l.kind == Kind::Example { "# " } else { "" };
    let text = format!("{off}{} = {}", l.key, l.value);
    // Texts of the files stand in it, and a comment may hold no control characters.
    let why = printable(&l.why);
    let beside = format!("{text:<36} # {mark}{why}");
    // Writing into a String cannot fail.
    let _ = if why.is_empty() {
        writeln!(out, "{text}")
    } else if text.contains('\n') || beside.chars().count() > WIDEST {
        write_comment(out, &format!("{mark}{why}"));
        writeln!(out, "{text}")
    } else {
        writeln!(out, "{beside}")
    };
}

/// A comment in lines of its own.
fn write_comment(out: &mut String, text: &str) {
    let mut width = 0;
    for word in text.split_whitespace() {
        let length = word.chars().count() + 1;
        if width == 0 || width + length > WIDEST {
            out.push_str(if width == 0 { "#" } else { "\n#" });
            width = 1;
        }
        out.push(' ');
        out.push_str(word);
        width += length;
    }
    out.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_replaced_and_written_in_order() {
        let mut d = Draft::default();
        d.set("bench", "gravity", "9.81", "", Kind::Said);
        d.set("output", "quantizer", quoted("round"), "cannot be seen", Kind::Assumed);
        d.set("bench", "gravity", "9.82", "", Kind::Said);
        d.runs.push(vec![line("file", quoted("a.csv"), "", Kind::Seen)]);
        let text = d.toml();
        assert!(text.contains("[output]\nquantizer = \"round\""), "{text}");
        assert!(text.contains("# assumed: cannot be seen"), "{text}");
        assert!(!text.contains("9.81") && text.ends_with("[[run]]\nfile = \"a.csv\"\n"), "{text}");
        d.set("output", "rate_hz", "50.0", "why ".repeat(40), Kind::Assumed);
        assert!(d.toml().lines().all(|l| l.chars().count() <= WIDEST), "{}", d.toml());
        assert!(d.toml().contains("why\nrate_hz = 50.0\n"), "{}", d.toml());
        d.remove("output", "rate_hz");
        assert_eq!(d.of(Kind::Assumed).map(|(n, _)| n).collect::<Vec<_>>(), ["[output] quantizer"]);
    }
}
