//! Output folders: written aside, swapped whole, never overwritten in silence.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// What to do when another result is there already.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// Refuse.
    Keep,
    /// Put the new one in its place and keep the old one beside it.
    Replace,
}

/// What happened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Written {
    /// The folder is new.
    New,
    /// The same result stood there already; nothing was touched.
    Same,
    /// The old folder now stands here.
    Replaced {
        /// The old folder.
        kept: PathBuf,
    },
}

/// A result that could not be written.
#[derive(Debug)]
pub enum OutputError {
    /// Another result is there.
    Occupied {
        /// The folder.
        folder: PathBuf,
        /// The first file that differs.
        file: String,
    },
    /// Stopped on request; nothing was left behind.
    Interrupted {
        /// The folder.
        folder: PathBuf,
    },
    /// The operating system refused.
    Io {
        /// What was written.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

impl std::fmt::Display for OutputError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Occupied { folder, file } => write!(
                f,
                "{} holds another result ({} differs); choose another folder, or use --replace, which keeps the old one beside it",
                folder.display(),
                crate::error::visible(file)
            ),
            Self::Interrupted { folder } => {
                write!(f, "interrupted; {} was not touched", folder.display())
            }
            Self::Io { path, source } => write!(f, "{}: {}", path.display(), crate::advice(source)),
        }
    }
}

impl std::error::Error for OutputError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io { source, .. } => Some(source),
            Self::Occupied { .. } | Self::Interrupted { .. } => None,
        }
    }
}

/// Files of an output folder, in memory until [`OutputFolder::write`].
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct OutputFolder {
    files: BTreeMap<String, Vec<u8>>,
}

impl OutputFolder {
    /// Adds a file; `name` may hold `/`.
    pub fn add(&mut self, name: impl Into<String>, bytes: impl Into<Vec<u8>>) {
        self.files.insert(name.into(), bytes.into());
    }

    /// Writes the folder beside its place and swaps it in whole. An interruption leaves the old state, and at
    /// most a folder whose name ends in `.tumble-new`; when `interrupted` says so between two files, not even that.
    pub fn write(
        &self,
        folder: &Path,
        existing: Existing,
        interrupted: &dyn Fn() -> bool,
    ) -> Result<Written, OutputError> {
        match (self.first_difference(folder)?, existing) {
            (Difference::Absent, _) => {
                let aside = self.write_files(folder, interrupted)?;
                rename(&aside, folder)?;
                Ok(Written::New)
            }
            (Difference::None, _) => Ok(Written::Same),
            (Difference::At(file), Existing::Keep) => {
                Err(OutputError::Occupied { folder: folder.to_path_buf(), file })
            }
            (Difference::At(_), Existing::Replace) => {
                let kept = free_name(folder);
                let aside = self.write_files(folder, interrupted)?;
                rename(folder, &kept)?;
                rename(&aside, folder)?;
                Ok(Written::Replaced { kept })
            }
        }
    }

    fn first_difference(&self, folder: &Path) -> Result<Difference, OutputError> {
        match fs::metadata(folder) {
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(Difference::Absent),
            Err(source) => return Err(OutputError::Io { path: folder.to_path_buf(), source }),
            Ok(m) if !m.is_dir() => return Ok(Difference::At(String::from("a file of that name"))),
            Ok(_) => {}
        }
        let mut there = Vec::new();
        list(folder, "", &mut there)
            .map_err(|source| OutputError::Io { path: folder.to_path_buf(), source })?;
        // An empty folder is a place prepared for the result.
        if there.is_empty() {
            let removed = fs::remove_dir(folder);
            return removed
                .map(|()| Difference::Absent)
                .map_err(|source| OutputError::Io { path: folder.to_path_buf(), source });
        }
        let foreign = there.iter().find(|f| !self.files.contains_key(*f)).cloned();
        let differs =
            self.files.iter().find_map(|(name, bytes)| match fs::read(folder.join(name)) {
                Ok(old) if old == *bytes => None,
                _ => Some(name.clone()),
            });
        Ok(differs.or(foreign).map_or(Difference::None, Difference::At))
    }

    /// Writes all files into a new folder beside the target.
    fn write_files(
        &self,
        folder: &Path,
        interrupted: &dyn Fn() -> bool,
    ) -> Result<PathBuf, OutputError> {
        let aside = beside(folder, &format!("{}.tumble-new", std::process::id()));
        let write = |path: &Path, bytes: &[u8]| {
            if let Some(parent) = path.parent() {
                fs::create_dir_all(parent)?;
            }
            let mut file = fs::File::create(path)?;
            io::Write::write_all(&mut file, bytes)?;
            file.sync_all()
        };
        for (name, bytes) in &self.files {
            if interrupted() {
                let _ = fs::remove_dir_all(&aside);
                return Err(OutputError::Interrupted { folder: folder.to_path_buf() });
            }
            let path = aside.join(name);
            if let Err(source) = write(&path, bytes) {
                // Best effort: the error that matters is the first one.
                let _ = fs::remove_dir_all(&aside);
                return Err(OutputError::Io { path, source });
            }
        }
        Ok(aside)
    }
}

/// Writes one file aside and moves it into its place. Another content is refused, or moved to a free name, which is given.
pub fn write_file(
    path: &Path,
    bytes: &[u8],
    existing: Existing,
) -> Result<Option<PathBuf>, OutputError> {
    let io = |source| OutputError::Io { path: path.to_path_buf(), source };
    let there = match fs::read(path) {
        Ok(old) if old == bytes => return Ok(None),
        Ok(_) => true,
        Err(e) if e.kind() == io::ErrorKind::NotFound => false,
        Err(e) => return Err(io(e)),
    };
    if there && existing == Existing::Keep {
        let folder = path.parent().unwrap_or(path).to_path_buf();
        let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        return Err(OutputError::Occupied { folder, file });
    }
    let aside = beside(path, &format!("{}.tumble-new", std::process::id()));
    let write = || {
        let mut file = fs::File::create(&aside)?;
        io::Write::write_all(&mut file, bytes)?;
        file.sync_all()
    };
    if let Err(e) = write() {
        // Best effort: the error that matters is the first one.
        let _ = fs::remove_file(&aside);
        return Err(io(e));
    }
    let kept = there.then(|| free_name(path));
    if let Some(kept) = &kept {
        rename(path, kept)?;
    }
    rename(&aside, path)?;
    Ok(kept)
}

enum Difference {
    Absent,
    None,
    At(String),
}

fn rename(from: &Path, to: &Path) -> Result<(), OutputError> {
    fs::rename(from, to).map_err(|source| OutputError::Io { path: to.to_path_buf(), source })
}

/// `out` → `out.SUFFIX`, in the same parent.
fn beside(folder: &Path, suffix: &str) -> PathBuf {
    let mut name = folder.file_name().unwrap_or_default().to_os_string();
    name.push(".");
    name.push(suffix);
    folder.with_file_name(name)
}

/// First name `out.old-1`, `out.old-2`, … that is free.
fn free_name(folder: &Path) -> PathBuf {
    (1..).map(|n| beside(folder, &format!("old-{n}"))).find(|p| !p.exists()).unwrap_or_default()
}

fn list(folder: &Path, prefix: &str, into: &mut Vec<String>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            list(&entry.path(), &format!("{name}/"), into)?;
        } else {
            into.push(name);
        }
    }
    into.sort();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(text: &str) -> OutputFolder {
        let mut o = OutputFolder::default();
        o.add("a.txt", text);
        o.add("deep/b.txt", "b");
        o
    }

    #[test]
    fn another_result_is_never_overwritten_in_silence() {
        let dir = tempfile::tempdir().unwrap();
        let out = dir.path().join("out");
        assert_eq!(one("1").write(&out, Existing::Keep, &|| false).unwrap(), Written::New);
        assert_eq!(one("1").write(&out, Existing::Keep, &|| false).unwrap(), Written::Same);
        let refused = one("2").write(&out, Existing::Keep, &|| false).unwrap_err();
        assert!(refused.to_string().contains("--replace"), "{refused}");
        assert_eq!(fs::read(out.join("a.txt")).unwrap(), b"1");
        let kept = dir.path().join("out.old-1");
        assert_eq!(
            one("2").write(&out, Existing::Replace, &|| false).unwrap(),
            Written::Replaced { kept: kept.clone() }
        );
        assert_eq!(fs::read(out.join("a.txt")).unwrap(), b"2");
        assert_eq!(fs::read(kept.join("a.txt")).unwrap(), b"1");
    }

    #[test]
    fn an_interruption_leaves_nothing_behind() {
        let dir = tempfile::tempdir().unwrap();
        let stopped = one("1").write(&dir.path().join("out"), Existing::Keep, &|| true);
        assert!(matches!(stopped, Err(OutputError::Interrupted { .. })));
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_folder_with_other_files_is_occupied() {
        let dir = tempfile::tempdir().unwrap();
        let out = dir.path().join("out");
        fs::create_dir(&out).unwrap();
        fs::write(out.join("thesis.doc"), "mine").unwrap();
        assert!(one("1").write(&out, Existing::Keep, &|| false).is_err());
        assert_eq!(fs::read(out.join("thesis.doc")).unwrap(), b"mine");
    }
}
