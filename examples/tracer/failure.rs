//! What the user is told when a file is at fault.

use std::fmt;
use std::path::{Path, PathBuf};

/// A file and what is wrong with it, printed as one line.
#[derive(Debug)]
pub(crate) struct Failure {
    /// The file, as the user named it.
    file: PathBuf,
    /// What is wrong with it.
    reason: String,
}

impl Failure {
    /// Blames `file`.
    pub(crate) fn new(file: &Path, reason: impl fmt::Display) -> Self {
        Self { file: file.to_owned(), reason: reason.to_string() }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.file.display(), self.reason)
    }
}

impl std::error::Error for Failure {}
