//! The effects that users write, as the commands are given them.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use towmag_effect_file::{EffectFile, LARGEST_FILE};
use towmag_trial::OwnEffect;

use crate::effects::{Library, Regressor, Request, RequestError};
use crate::error::HostError;
use crate::recording::Column;

/// The library of this program with the effects of some files.
///
/// # Errors
///
/// When a file cannot be read, is no effect, or has the name of another one.
pub fn library_with(files: &[PathBuf]) -> Result<Library, HostError> {
    let taken = |error: RequestError| HostError::Usage(error.to_string());
    let with = |library: Library, path: &PathBuf| library.with_file(read(path)?).map_err(taken);
    files.iter().try_fold(Library::default(), with)
}

/// What `--effect` asks for, and each effect of a file that no `--effect` names, with the values that the file gives.
///
/// # Errors
///
/// When there is no such effect or parameter, or a value is out of its range.
pub fn requests(library: &Library, effects: &[String]) -> Result<Vec<Request>, HostError> {
    let mut requests = effects.iter().map(|text| library.request(text)).collect::<Result<Vec<_>, _>>()?;
    let files = library.iter().filter(|effect| effect.defaults().is_some());
    for effect in files {
        if !requests.iter().any(|request| request.effect.spec().name == effect.spec().name) {
            requests.push(library.request(effect.spec().name)?);
        }
    }
    Ok(requests)
}

/// The same with columns of the recording, each in every form in which it may act.
///
/// # Errors
///
/// When a column is named twice, or is what the diagnosis is to explain.
pub fn with_regressors(library: Library, columns: &[String]) -> Result<Library, HostError> {
    for (index, name) in columns.iter().enumerate() {
        let refused = |why: &str| Err(HostError::Usage(format!("--regressor {name}: {why}")));
        match Column::named(name) {
            Some(column) if Column::REQUIRED.contains(&column) => {
                return refused("is what the diagnosis is to explain: name another column");
            }
            _ if columns[..index].contains(name) => return refused("is there twice"),
            _ => {}
        }
    }
    let with = |library: Library, name: &String| Regressor::forms(name).into_iter().fold(library, Library::with);
    Ok(columns.iter().fold(library, with))
}

/// The effects of some files for a trial.
///
/// # Errors
///
/// As of [`library_with`], and when one needs what no recording of a trial has.
pub fn own_effects(files: &[PathBuf]) -> Result<Vec<OwnEffect>, HostError> {
    library_with(files)?;
    let own = |path: &PathBuf| Ok(OwnEffect::read(&path.display().to_string(), text_of(path)?)?);
    files.iter().map(own).collect()
}

fn read(path: &Path) -> Result<EffectFile, HostError> {
    let parsed = EffectFile::parse(&text_of(path)?, &path.display().to_string());
    parsed.map_err(|error| HostError::Usage(error.to_string()))
}

/// The text of a file, of which no more is read than it may be long.
fn text_of(path: &Path) -> Result<String, HostError> {
    let file = path.display().to_string();
    let unreadable = |error: std::io::Error| HostError::Usage(format!("{file}: cannot be read: {error}"));
    let mut text = String::new();
    let most = LARGEST_FILE as u64 + 1;
    File::open(path).map_err(unreadable)?.take(most).read_to_string(&mut text).map_err(unreadable)?;
    Ok(text)
}
