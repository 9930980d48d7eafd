//! The repository on disk: where it is, its files, its crates.

use std::path::{Path, PathBuf};

use cargo_metadata::{MetadataCommand, TargetKind};

/// The folder that holds all crates.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the repository")
}

/// Every file that `.gitignore` does not name, relative to the root and sorted; written with `/`.
pub fn files() -> Vec<String> {
    let walk = ignore::WalkBuilder::new(root()).hidden(false).require_git(false).parents(false).build();
    let is_file = |entry: &ignore::DirEntry| entry.file_type().is_some_and(|kind| !kind.is_dir());
    let entries = walk.map(|entry| entry.expect("the repository can be read")).filter(is_file);
    let mut files: Vec<String> = entries.map(|entry| relative(entry.path())).collect();
    // A worktree has a file `.git`, a clone a folder.
    files.retain(|file| file != ".git" && !file.starts_with(".git/"));
    files.sort();
    files
}

/// A path of the repository, relative to its root and written with `/`.
pub fn relative(path: &Path) -> String {
    let inside = path.strip_prefix(root()).unwrap_or(path);
    inside.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
}

/// Text of a file of the repository; `None` where it is not text.
pub fn text(file: &str) -> Option<String> {
    String::from_utf8(std::fs::read(root().join(file)).ok()?).ok()
}

/// Where cargo puts what it builds.
pub fn target_folder() -> PathBuf {
    let metadata = MetadataCommand::new().manifest_path(root().join("Cargo.toml")).no_deps().exec();
    metadata.expect("cargo describes the workspace").target_directory.into_std_path_buf()
}

/// A crate: a library or a program.
#[derive(Clone, Debug)]
pub struct CrateRoot {
    /// As cargo names it, with its package: `towmag` or `towmag (bin firmware)`.
    pub name: String,
    /// Its first file.
    pub path: PathBuf,
}

/// All crates of the workspace and of `fuzz/`, which is a workspace of its own; tests and benches are none.
pub fn crates() -> Vec<CrateRoot> {
    ["Cargo.toml", "fuzz/Cargo.toml"].iter().flat_map(|manifest| crates_of(&root().join(manifest))).collect()
}

fn crates_of(manifest: &Path) -> Vec<CrateRoot> {
    let metadata = MetadataCommand::new().manifest_path(manifest).no_deps().exec().expect("cargo describes the crates");
    let mut crates = Vec::new();
    for package in &metadata.packages {
        for target in &package.targets {
            let name = match target.kind.first() {
                Some(TargetKind::Lib) => package.name.to_string(),
                Some(TargetKind::Bin) => format!("{} (bin {})", package.name, target.name),
                _ => continue,
            };
            crates.push(CrateRoot { name, path: target.src_path.clone().into_std_path_buf() });
        }
    }
    crates
}
