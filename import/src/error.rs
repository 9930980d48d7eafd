//! Why a file could not be imported.

/// Why a file could not be imported: always with what to do about it.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// A place in a file is at fault.
    #[error("{file}:{line}: {what}")]
    At {
        /// As the user named it.
        file: String,
        /// From 1.
        line: u64,
        /// What is wrong, and what is expected.
        what: String,
    },
    /// A file as a whole is at fault, or lacks what is needed.
    #[error("{file}: {what}")]
    File {
        /// As the user named it.
        file: String,
        /// What is wrong, and the option or the program that mends it.
        what: String,
    },
    /// An option is at fault.
    #[error("{0}")]
    Usage(String),
    /// The file cannot be read.
    #[error("{file}: cannot be read: {source}")]
    Io {
        /// As the user named it.
        file: String,
        /// The system's own words.
        source: std::io::Error,
    },
}

impl ImportError {
    /// A file as a whole is at fault.
    pub fn file(file: &str, what: impl Into<String>) -> Self {
        Self::File { file: file.into(), what: what.into() }
    }

    /// A line of a file is at fault.
    pub fn at(file: &str, line: u64, what: impl Into<String>) -> Self {
        Self::At { file: file.into(), line, what: what.into() }
    }
}
