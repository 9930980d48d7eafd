//! Results appear as a whole or not at all.

use host_sim::output::{OutputDir, OutputError, OutputFile};
use std::fs;
use std::io::Write;
use std::path::Path;

/// Everything below a directory, with the contents of the files.
fn tree(root: &Path) -> Vec<(String, Option<String>)> {
    let mut found = Vec::new();
    let mut directories = vec![root.to_path_buf()];
    while let Some(directory) = directories.pop() {
        for entry in fs::read_dir(directory).unwrap() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(root).unwrap().display().to_string();
            found.push((name, path.is_file().then(|| fs::read_to_string(&path).unwrap())));
            if path.is_dir() && !path.is_symlink() {
                directories.push(path);
            }
        }
    }
    found.sort();
    found
}

fn files<const N: usize>(files: [(&str, Option<&str>); N]) -> Vec<(String, Option<String>)> {
    files.map(|(name, contents)| (name.into(), contents.map(Into::into))).into()
}

/// The list of the files of a result.
const LIST: &str = "# Files of this folder that host-sim has written, and will replace when it is told to write here.\n\
                    summary.json\ntable.csv\n";

/// A result of two files, not yet committed.
fn staged(path: &Path, text: &str) -> OutputDir {
    let output = OutputDir::create(path).unwrap();
    let mut table = output.create_file("table.csv").unwrap();
    writeln!(table, "{text}").unwrap();
    table.finish().unwrap();
    output.write("summary.json", text).unwrap();
    output
}

#[test]
fn a_new_directory_appears_at_the_commit_with_its_parents() {
    let root = tempfile::tempdir().unwrap();
    let target = root.path().join("a/b/out");
    let output = staged(&target, "new");
    assert!(!target.exists());
    output.commit("summary.json").unwrap();
    let there = [("a", None), ("a/b", None), ("a/b/out", None)];
    let [a, b, out] = there;
    let summary = ("a/b/out/summary.json", Some("new"));
    let list = ("a/b/out/.host-sim", Some(LIST));
    assert_eq!(tree(root.path()), files([a, b, out, list, summary, ("a/b/out/table.csv", Some("new\n"))]));
}

#[test]
fn without_a_commit_nothing_is_left_behind() {
    let root = tempfile::tempdir().unwrap();
    let output = staged(&root.path().join("a/b/out"), "new");
    let open = output.create_file("open.csv").unwrap();
    drop(output);
    drop(open);
    let file = OutputFile::create(root.path().join("c/d/rec.csv")).unwrap();
    drop(file);
    assert_eq!(tree(root.path()), []);
}

#[test]
fn parents_that_others_use_meanwhile_stay() {
    let root = tempfile::tempdir().unwrap();
    let output = staged(&root.path().join("a/b/out"), "new");
    fs::write(root.path().join("a/theirs"), "x").unwrap();
    drop(output);
    assert_eq!(tree(root.path()), files([("a", None), ("a/theirs", Some("x"))]));
}

#[test]
fn an_existing_result_stays_whole_until_it_is_replaced() {
    let root = tempfile::tempdir().unwrap();
    let target = root.path().join("out");
    staged(&target, "old").commit("summary.json").unwrap();
    fs::write(target.join("notes.txt"), "mine").unwrap();
    let old = tree(root.path());

    let output = staged(&target, "new");
    assert_eq!(tree(&target).len(), 4, "nothing is staged among the user's files");
    drop(output);
    assert_eq!(tree(root.path()), old);

    staged(&target, "new").commit("summary.json").unwrap();
    let new = [
        (".host-sim", Some(LIST)),
        ("notes.txt", Some("mine")),
        ("summary.json", Some("new")),
        ("table.csv", Some("new\n")),
    ];
    assert_eq!(tree(&target), files(new));
    assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1);
}

#[test]
fn a_result_with_an_unfinished_or_missing_file_is_not_committed() {
    let root = tempfile::tempdir().unwrap();
    let target = root.path().join("out");
    staged(&target, "old").commit("summary.json").unwrap();
    let old = tree(root.path());

    let output = staged(&target, "new");
    let _open = output.create_file("gap.csv").unwrap();
    let error = output.commit("summary.json").unwrap_err();
    assert!(matches!(&error, OutputError::Unfinished { path } if path.ends_with("out/gap.csv")), "{error}");
    let error = staged(&target, "new").commit("diagnosis.json").unwrap_err();
    assert!(matches!(&error, OutputError::Unfinished { path } if path.ends_with("out/diagnosis.json")), "{error}");
    assert_eq!(tree(root.path()), old);
}

#[test]
fn a_directory_in_the_way_is_found_before_anything_is_moved() {
    let root = tempfile::tempdir().unwrap();
    let target = root.path().join("out");
    staged(&target, "old").commit("summary.json").unwrap();
    fs::remove_file(target.join("table.csv")).unwrap();
    fs::create_dir(target.join("table.csv")).unwrap();
    let old = tree(root.path());
    let error = staged(&target, "new").commit("summary.json").unwrap_err();
    assert!(matches!(error, OutputError::NotAFile { .. }), "{error}");
    assert_eq!(tree(root.path()), old);
}

#[test]
fn a_target_that_appears_meanwhile_is_filled_and_not_replaced() {
    let root = tempfile::tempdir().unwrap();
    let target = root.path().join("out");
    let output = staged(&target, "new");
    fs::create_dir(&target).unwrap();
    fs::write(target.join("theirs"), "x").unwrap();
    output.commit("summary.json").unwrap();
    assert_eq!(tree(&target).len(), 4);
}

#[test]
fn a_file_that_somebody_else_has_put_there_stays() {
    let root = tempfile::tempdir().unwrap();
    let target = root.path().join("out");
    fs::create_dir(&target).unwrap();
    let output = staged(&target, "new");
    fs::write(target.join("table.csv"), "theirs").unwrap();
    let early = OutputDir::check(&target, &["summary.json", "table.csv"]).unwrap_err();
    let late = OutputDir::create(&target).unwrap().create_file("table.csv").unwrap_err();
    for error in [early, late, output.commit("summary.json").unwrap_err()] {
        assert!(matches!(&error, OutputError::Foreign { path, .. } if path.ends_with("out/table.csv")), "{error}");
        assert!(error.is_bad_usage() && error.to_string().contains("is no result of host-sim"), "{error}");
    }
    assert_eq!(tree(root.path()), files([("out", None), ("out/table.csv", Some("theirs"))]));
}

#[test]
fn what_is_no_directory_or_no_file_is_refused_at_once() {
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("file");
    fs::write(&file, "x").unwrap();
    let errors = [
        OutputDir::create(&file).unwrap_err(),
        OutputDir::create(file.join("out")).unwrap_err(),
        OutputDir::create("").unwrap_err(),
        OutputFile::create(root.path()).unwrap_err(),
        OutputFile::create(root.path().join("none/..")).unwrap_err(),
    ];
    for error in errors {
        assert!(error.is_bad_usage() && error.to_string().lines().count() == 1, "{error}");
    }
    assert_eq!(tree(root.path()), files([("file", Some("x"))]));
}

#[test]
fn a_single_file_is_replaced_in_one_step_or_not_at_all() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("a/rec.csv");
    for text in ["old", "new"] {
        let before = tree(root.path());
        let mut file = OutputFile::create(&path).unwrap();
        file.write_all(b"half").unwrap();
        file.flush().unwrap();
        drop(file);
        assert_eq!(tree(root.path()), before);

        let mut file = OutputFile::create(&path).unwrap();
        file.write_all(text.as_bytes()).unwrap();
        file.commit().unwrap();
        assert_eq!(tree(root.path()), files([("a", None), ("a/rec.csv", Some(text))]));
    }
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::{PermissionsExt, symlink};

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).unwrap().permissions().mode()
    }

    #[test]
    fn results_are_as_readable_as_other_files() {
        let root = tempfile::tempdir().unwrap();
        let [directory, file] = ["directory", "file"].map(|name| root.path().join(name));
        fs::create_dir(&directory).unwrap();
        fs::write(&file, "").unwrap();
        let [out, single] = ["out", "single"].map(|name| root.path().join(name));
        staged(&out, "new").commit("summary.json").unwrap();
        OutputFile::create(&single).unwrap().commit().unwrap();
        assert_eq!(mode(&out), mode(&directory));
        assert_eq!([mode(&single), mode(&out.join("table.csv"))], [mode(&file); 2]);
    }

    #[test]
    fn symbolic_links_survive_and_devices_are_left_alone() {
        let root = tempfile::tempdir().unwrap();
        let [disk, link] = ["disk", "link"].map(|name| root.path().join(name));
        fs::create_dir(&disk).unwrap();
        symlink(&disk, &link).unwrap();
        staged(&link, "new").commit("summary.json").unwrap();
        assert!(link.is_symlink() && disk.join("summary.json").is_file());
        assert!(matches!(OutputFile::create("/dev/null"), Err(OutputError::NotAFile { .. })));
    }

    #[test]
    fn a_full_disk_is_reported_with_the_name_of_the_file() {
        let Ok(full) = fs::metadata("/dev/full") else { return };
        assert!(!full.is_file());
        let root = tempfile::tempdir().unwrap();
        // The staging directory is the only thing in there: make its next file a device that is always full.
        let output = OutputDir::create(root.path().join("out")).unwrap();
        let staging = fs::read_dir(root.path()).unwrap().next().unwrap().unwrap().path();
        symlink("/dev/full", staging.join("table.csv.unfinished")).unwrap();
        let error = output.write("table.csv", vec![b'x'; 1 << 20]).unwrap_err().to_string();
        assert!(
            error.contains("out/table.csv: cannot be written: ") && error.matches("table.csv").count() == 1,
            "{error}"
        );
    }
}
