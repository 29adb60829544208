//! What the operating system's refusals mean, and one thing to do about each.

use std::io::{Error, ErrorKind};
use std::path::Path;

/// A file that is not there, with names like it that are.
#[derive(Debug)]
struct NotThere {
    similar: Vec<String>,
}

impl std::fmt::Display for NotThere {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names: Vec<String> =
            self.similar.iter().map(|n| format!("`{}`", crate::error::visible(n))).collect();
        match names.as_slice() {
            [] => f.write_str("there is no such file; is the name right, with its ending?"),
            names => write!(f, "there is no such file; did you mean {}?", names.join(" or ")),
        }
    }
}

impl std::error::Error for NotThere {}

/// The refusal for a file that is not there, naming up to three of its folder that are like it. Other refusals stay
/// as they are.
pub(crate) fn with_similar_names(e: Error, path: &Path) -> Error {
    /// Similarity (Jaro-Winkler) from which a name is worth a proposal, as for keys.
    const SIMILAR: f64 = 0.75;
    /// Files of a folder that are looked at.
    const MOST: usize = 10_000;
    if e.kind() != ErrorKind::NotFound {
        return e;
    }
    let name = |p: &Path| p.file_name().map(|n| n.to_string_lossy().into_owned());
    let (Some(folder), Some(wanted)) = (path.parent(), name(path)) else { return e };
    let there =
        std::fs::read_dir(if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
    let wanted = wanted.to_lowercase();
    let mut found: Vec<(f64, String)> = there
        .into_iter()
        .flatten()
        .take(MOST)
        .filter_map(|entry| name(&entry.ok()?.path()))
        .map(|n| {
            let own = n.to_lowercase();
            // A forgotten or doubled ending is the likeliest slip of all.
            let ending = own.starts_with(&wanted) || wanted.starts_with(&own);
            (if ending { 1.0 } else { strsim::jaro_winkler(&own, &wanted) }, n)
        })
        .filter(|(similar, _)| *similar > SIMILAR)
        .collect();
    // The likest first; by name where they are alike, whatever order the folder has.
    found.sort_by(|a, b| b.0.total_cmp(&a.0).then_with(|| a.1.cmp(&b.1)));
    found.truncate(3);
    Error::new(
        ErrorKind::NotFound,
        NotThere { similar: found.into_iter().map(|(_, n)| n).collect() },
    )
}

/// [`advice`] on a refusal for a path; where there is no such file, with names in its folder that are like it.
#[must_use]
pub fn advice_at(e: Error, path: &Path) -> String {
    advice(&with_similar_names(e, path))
}

/// What a refusal of the operating system means and what to do about it.
#[must_use]
pub fn advice(e: &Error) -> String {
    let what = match e.kind() {
        ErrorKind::NotFound => match e.get_ref() {
            Some(own) if own.is::<NotThere>() => return own.to_string(),
            _ => "there is no such file or folder; is the name right?",
        },
        ErrorKind::PermissionDenied => {
            "access is denied; check who may read or write it, or use another place"
        }
        ErrorKind::IsADirectory => "it is a folder where a file should be; name a file in it",
        ErrorKind::NotADirectory => "a part of its path is a file and no folder; check the path",
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
            "no space is left; free some, or write to another disk"
        }
        ErrorKind::ReadOnlyFilesystem => {
            "it is on a disk that cannot be written; choose another place"
        }
        ErrorKind::FileTooLarge => {
            "the disk allows no file of that size; use another disk, or split the record"
        }
        ErrorKind::InvalidFilename => {
            "the name is not allowed on this disk; choose a shorter, plainer one"
        }
        ErrorKind::UnexpectedEof => {
            "it ends in the middle; copy it again from its source (an interrupted download or copy is common)"
        }
        ErrorKind::InvalidData | ErrorKind::InvalidInput => {
            return format!(
                "damaged, or not what its name says ({}); copy it again from its source",
                message(e)
            );
        }
        ErrorKind::TimedOut | ErrorKind::HostUnreachable | ErrorKind::NetworkUnreachable => {
            "the network disk does not answer; copy the file to a local disk"
        }
        _ => return format!("{}; try again, or copy it to another disk", message(e)),
    };
    what.to_owned()
}

/// The system's own words on one line, safe to print.
fn message(e: &Error) -> String {
    crate::error::visible(&e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_refusal_says_one_thing_to_do() {
        for kind in [
            ErrorKind::NotFound,
            ErrorKind::PermissionDenied,
            ErrorKind::IsADirectory,
            ErrorKind::NotADirectory,
            ErrorKind::StorageFull,
            ErrorKind::InvalidData,
            ErrorKind::UnexpectedEof,
            ErrorKind::Other,
        ] {
            let text = advice(&Error::new(kind, "the system's words"));
            assert!(text.contains("; ") && !text.contains("os error"), "{kind:?}: {text}");
        }
    }

    #[test]
    fn similar_names_are_proposed() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["run-1.csv.gz", "Run-2.csv", "notes.txt"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let missing = |name: &str| {
            let path = folder.path().join(name);
            advice(&with_similar_names(std::fs::read(&path).unwrap_err(), &path))
        };
        let text = missing("run-1.csv");
        assert!(text.contains("did you mean `run-1.csv.gz`"), "{text}");
        assert!(missing("photo").contains("is the name right"));
        assert!(missing("none/run-1.csv").contains("is the name right"));
    }
}
