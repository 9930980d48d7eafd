//! Where a result comes from: which program made it, told what, of which bytes.
//!
//! A result of last year that cannot be made again is worth little. So each one holds what is needed to make it again, and to
//! see whether two results were made of the same file. It holds no time and no folder: the same work gives the same bytes.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use serde::Serialize;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use towmag::Settings;

use crate::message::file_name;
use crate::recording::{Input, RecordingError};

/// What a result was made by, and of.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Provenance {
    /// Name of the program.
    pub program: &'static str,
    /// Its version.
    pub version: &'static str,
    /// The commit that its source was built at, with a `+` where the source had been changed since; `None` outside a clone.
    pub commit: Option<&'static str>,
    /// The command.
    pub command: &'static str,
    /// What it was told, defaults too, by the names of its options.
    pub options: Value,
    /// The files that it read.
    pub inputs: Vec<InputBytes>,
}

/// A file that was read.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InputBytes {
    /// What it was read as.
    pub role: &'static str,
    /// Its name without folders.
    pub file: String,
    /// Its length.
    pub bytes: u64,
    /// SHA-256 of it as it is stored, hexadecimal.
    pub sha256: String,
}

impl Provenance {
    /// Of a command of this program.
    pub(crate) fn new(command: &'static str, options: Value, inputs: Vec<InputBytes>) -> Self {
        let commit = Some(env!("TOWMAG_COMMIT")).filter(|commit| !commit.is_empty());
        Self { program: "host-sim", version: env!("CARGO_PKG_VERSION"), commit, command, options, inputs }
    }
}

impl InputBytes {
    /// Of a file.
    pub(crate) fn of_file(role: &'static str, path: &Path) -> Result<Self, RecordingError> {
        Self::read(role, file_name(path), path)
    }

    /// Of a file that may not be there.
    pub(crate) fn of_files(files: &[(&'static str, Option<&Path>)]) -> Result<Vec<Self>, RecordingError> {
        let given = files.iter().filter_map(|(role, path)| Some((role, (*path)?)));
        given.map(|(role, path)| Self::of_file(role, path)).collect()
    }

    /// Of a recording that is ready to be read: the file that was named, or what came through a pipe, unpacked if it was packed.
    pub(crate) fn of_recording(role: &'static str, input: &Input) -> Result<Self, RecordingError> {
        let named = input.named().filter(|path| path.is_file());
        Self::read(role, input.file_name(), named.unwrap_or_else(|| input.path()))
    }

    /// Of bytes that are no file.
    pub(crate) fn of_bytes(role: &'static str, file: String, bytes: &[u8]) -> Self {
        Self { role, file, bytes: bytes.len() as u64, sha256: hexadecimal(&Sha256::digest(bytes)) }
    }

    fn read(role: &'static str, file: String, path: &Path) -> Result<Self, RecordingError> {
        let (bytes, sha256) =
            hashed(path).map_err(|source| RecordingError::Io { path: path.display().to_string(), source })?;
        Ok(Self { role, file, bytes, sha256 })
    }
}

/// Length and hash of a file, however large.
fn hashed(path: &Path) -> io::Result<(u64, String)> {
    let (mut source, mut hash, mut bytes) = (File::open(path)?, Sha256::new(), 0);
    let mut buffer = vec![0; 1 << 16];
    loop {
        match source.read(&mut buffer)? {
            0 => return Ok((bytes, hexadecimal(&hash.finalize()))),
            read => {
                hash.update(&buffer[..read]);
                bytes += read as u64;
            }
        }
    }
}

/// What the estimators were told, by the names of the command line.
pub(crate) fn estimator_options(settings: &Settings) -> Value {
    json!({
        "lambda1": settings.penalty.lambda1,
        "lambda2": settings.penalty.lambda2,
        "forgetting": settings.forgetting,
        "dual_step": settings.dual_step,
        "band_low_hz": settings.band_pass.low_hz,
        "band_high_hz": settings.band_pass.high_hz,
        "band_order": settings.band_pass.order,
    })
}

fn hexadecimal(digest: &[u8]) -> String {
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// FIPS 180-2, appendix B.1.
    const OF_ABC: &str = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

    #[test]
    fn a_file_and_its_bytes_have_one_hash_wherever_they_are() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("abc.csv");
        std::fs::write(&path, "abc").unwrap();
        let [of_file, of_bytes] =
            [InputBytes::of_file("file", &path).unwrap(), InputBytes::of_bytes("file", "abc.csv".into(), b"abc")];
        assert_eq!((of_file.sha256.as_str(), of_file.bytes, &of_file), (OF_ABC, 3, &of_bytes));
        let lost = InputBytes::of_files(&[("base", None), ("file", Some(&folder.path().join("nowhere.csv")))]);
        assert!(lost.unwrap_err().to_string().contains("nowhere.csv"));
    }

    #[test]
    fn a_commit_is_forty_digits_or_unknown() {
        let commit = Provenance::new("replay", json!({}), Vec::new()).commit;
        let digits =
            commit.map_or(40, |commit| commit.trim_end_matches('+').bytes().filter(u8::is_ascii_hexdigit).count());
        assert_eq!(digits, 40, "{commit:?}");
    }
}
