//! Exit codes of the contract.

use std::process::ExitCode;

use tumble_io::{OutputError, Problem, ReadError};

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Exit {
    /// Accepted, or done.
    Ok,
    /// The calibration was rejected.
    Rejected,
    /// Usage, or input that cannot be read.
    Usage,
    /// Accepted with warnings, under `--strict`.
    Warnings,
    /// Indeterminate.
    Indeterminate,
    /// I/O or internal failure.
    Failure,
    /// Ctrl-C.
    Interrupted,
}

impl Exit {
    /// The number of the contract.
    pub(crate) fn code(self) -> u8 {
        match self {
            Self::Ok => 0,
            Self::Rejected => 1,
            Self::Usage => 2,
            Self::Warnings => 3,
            Self::Indeterminate => 4,
            Self::Failure => 5,
            Self::Interrupted => 130,
        }
    }

    /// Input that is missing or wrong is usage; input that breaks while it is read is a failure.
    pub(crate) fn of_reading(error: &ReadError) -> Self {
        use std::io::ErrorKind::{
            InvalidData, InvalidFilename, InvalidInput, IsADirectory, NotADirectory, NotFound,
            PermissionDenied, UnexpectedEof,
        };
        match &error.problem {
            Problem::Io(e)
                if !matches!(
                    e.kind(),
                    NotFound
                        | PermissionDenied
                        | InvalidData
                        | InvalidFilename
                        | InvalidInput
                        | IsADirectory
                        | NotADirectory
                        | UnexpectedEof
                ) =>
            {
                Self::Failure
            }
            _ => Self::Usage,
        }
    }

    /// What cannot be written: a place that is taken is usage, everything else a failure.
    pub(crate) fn of_writing(error: &OutputError) -> Self {
        match error {
            OutputError::Occupied { .. } => Self::Usage,
            OutputError::Interrupted { .. } => Self::Interrupted,
            OutputError::Io { .. } => Self::Failure,
        }
    }

    /// The graver of two ends, for several experiments in one call.
    pub(crate) fn worse(self, other: Self) -> Self {
        let gravity = |e: Self| match e {
            Self::Ok => 0,
            Self::Warnings => 1,
            Self::Indeterminate => 2,
            Self::Rejected => 3,
            Self::Usage => 4,
            Self::Failure => 5,
            Self::Interrupted => 6,
        };
        if gravity(other) > gravity(self) { other } else { self }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit.code())
    }
}

/// Prints what went wrong, on standard error.
pub(crate) fn complain(message: impl std::fmt::Display) {
    eprintln!("tumble: {message}");
}

/// Prints data on standard output. A reader that closed early (`| head`) has what it wanted.
pub(crate) fn deliver(text: &str) -> Exit {
    use std::io::Write as _;
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
            complain(format!("standard output: {}", tumble_io::advice(&e)));
            Exit::Failure
        }
        _ => Exit::Ok,
    }
}
