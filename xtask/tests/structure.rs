//! The rules of the house, over the whole tree.
#![cfg(not(target_os = "none"))]

use std::collections::BTreeSet;
use std::sync::LazyLock;

use xtask::documents::{self, Pointer};
use xtask::repository;
use xtask::structure::functions::{self, Function, Shape};
use xtask::structure::strings::{self, Literal};
use xtask::structure::{self, SourceCrate};

/// What is read from all source files, once.
struct Tree {
    circles: Vec<String>,
    functions: Vec<Function>,
    literals: Vec<Literal>,
}

static TREE: LazyLock<Tree> = LazyLock::new(|| {
    let mut tree = Tree { circles: Vec::new(), functions: Vec::new(), literals: Vec::new() };
    for root in repository::crates() {
        let source = SourceCrate::parse(&root.path, &structure::on_disk);
        let circles = structure::circles(&structure::arrows(&source));
        tree.circles.extend(circles.iter().map(|circle| format!("{}: {circle}", root.name)));
        tree.functions.extend(functions::functions(&source));
        tree.literals.extend(strings::literals(&source));
    }
    tree
});

fn none(what: &str, found: &[String]) {
    assert!(found.is_empty(), "{what}: {}\n{}\n", found.len(), found.join("\n"));
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    none("circles among files", &TREE.circles);
}

/// The names of the effects, as the library's own files give them.
fn effect_names() -> BTreeSet<String> {
    let files = repository::files().into_iter();
    let of_effects = files.filter(|file| file.starts_with("host-sim/src/effects/") && file.ends_with(".rs"));
    let parsed = of_effects.map(|file| syn::parse_file(&repository::text(&file).expect("source is text")));
    let names = parsed.flat_map(|file| strings::effect_names(&file.expect("source can be parsed").items));
    names.collect()
}

#[test]
fn effects_are_named_by_themselves_alone() {
    let names = effect_names();
    assert!(names.len() >= 24, "the names of the effects were not found: {names:?}");
    let rooms = ["host-sim/src/effects/", "trial/", "xtask/"];
    let mut found = Vec::new();
    for literal in TREE.literals.iter().filter(|literal| !rooms.iter().any(|room| literal.file.starts_with(room))) {
        for name in names.iter().filter(|name| strings::has_word(&literal.value, name)) {
            found.push(format!("{}:{}: {name} in {:?}", literal.file, literal.line, literal.value));
        }
    }
    let words: Vec<&str> = names.iter().map(String::as_str).collect();
    found.extend(lines_with(&words, |file| file.starts_with("host-sim/src/") && !file.ends_with(".rs")));
    none("effects by name outside their files", &found);
}

#[test]
fn functions_of_the_diagnosis_are_short() {
    let is_in = |function: &&Function| function.file.starts_with("host-sim/src/diagnosis/");
    let diagnosis: Vec<&Function> = TREE.functions.iter().filter(is_in).collect();
    let shape = Shape::of(diagnosis.iter().copied());
    let mut long: Vec<&&Function> = diagnosis.iter().filter(|function| function.lines > 20).collect();
    long.sort_by_key(|function| std::cmp::Reverse(function.lines));
    let list: Vec<String> =
        long.iter().map(|function| format!("{:3} {} {}", function.lines, function.file, function.name)).collect();
    assert!(shape.count > 100, "the functions of the diagnosis were not found: {shape:?}");
    assert!(shape.p90 <= 20 && shape.longest <= 60, "{shape:?}, above 20:\n{}\n", list.join("\n"));
}

/// Lines of the repository's text files that hold one of the words, but for those of files that may.
fn lines_with(words: &[&str], is_searched: impl Fn(&str) -> bool) -> Vec<String> {
    let mut found = Vec::new();
    for file in repository::files().iter().filter(|file| is_searched(file)) {
        let text = repository::text(file).unwrap_or_default();
        let lines = text.lines().enumerate().filter(|(_, line)| words.iter().any(|word| line.contains(word)));
        found.extend(lines.map(|(index, line)| format!("{file}:{}: {}", index + 1, line.trim())));
    }
    found
}

#[test]
fn only_the_board_knows_of_the_emulation() {
    let found =
        lines_with(&["feature = \"emulation\""], |file| file.starts_with("src/") && !file.starts_with("src/board/"));
    none("the emulation outside the board", &found);
}

#[test]
fn no_file_knows_the_machine_that_it_was_written_on() {
    // In two parts each, so that this file does not hold them.
    let words = [
        concat!("/wo", "rk/"),
        concat!("/tmp", "/"),
        concat!("/ho", "me/"),
        concat!("/ro", "ot/"),
        concat!("C:", "\\"),
    ];
    none("words of a local machine", &lines_with(&words, |_| true));
    let sources = |line: &str| {
        line.starts_with("source = ") && !line.contains("registry+https://github.com/rust-lang/crates.io-index")
    };
    let locks: Vec<String> = repository::files().into_iter().filter(|file| file.ends_with("Cargo.lock")).collect();
    let foreign = locks.iter().flat_map(|lock| {
        let text = repository::text(lock).unwrap_or_default();
        text.lines().filter(|line| sources(line)).map(|line| format!("{lock}: {line}")).collect::<Vec<_>>()
    });
    none("packages from elsewhere than crates.io", &foreign.collect::<Vec<_>>());
}

fn pages() -> Vec<String> {
    repository::files().into_iter().filter(|file| file.ends_with(".md")).collect()
}

#[test]
fn pages_point_at_nothing_beside_the_repository() {
    none("pointers beside the repository", &lines_with(&["../shared", "shared/data"], |file| file.ends_with(".md")));
}

#[test]
fn links_of_pages_lead_to_files() {
    let files = repository::files();
    let mut dead = Vec::new();
    for page in pages() {
        for pointer in documents::pointers(&repository::text(&page).expect("a page is text")) {
            let Pointer::Link(link) = pointer else { continue };
            match documents::target(&page, &link) {
                Some(Ok(path)) if documents::exists(&files, &path) => {}
                None => {}
                _ => dead.push(format!("{page}: {link}")),
            }
        }
    }
    none("dead links", &dead);
}

/// Paths that pages name as code: `src/pipeline.rs`, `host-sim/src/effects/`; source files also by their name alone.
#[test]
fn files_that_pages_name_are_there() {
    let files = repository::files();
    let rooms: BTreeSet<&str> = files.iter().filter_map(|file| file.split_once('/')).map(|(room, _)| room).collect();
    let is_path = |code: &str| {
        code.split_once('/').is_some_and(|(room, _)| rooms.contains(room))
            && !code.contains([' ', '*', '<'])
            && !code.contains("NAME")
    };
    let is_source = |code: &str| code.ends_with(".rs") && !code.contains([' ', '*', '<', '/']);
    let mut missing = Vec::new();
    for page in pages() {
        for pointer in documents::pointers(&repository::text(&page).expect("a page is text")) {
            let Pointer::Code(code) = pointer else { continue };
            let beside_page = documents::target(&page, &code).and_then(Result::ok);
            let is_there =
                documents::exists(&files, &code) || beside_page.is_some_and(|path| documents::exists(&files, &path));
            let has_name = files.iter().any(|file| file.ends_with(&format!("/{code}")));
            if is_path(&code) && !is_there || is_source(&code) && !has_name {
                missing.push(format!("{page}: {code}"));
            }
        }
    }
    none("files that are not there", &missing);
}

/// The README repeats some figures: each number of its table of results stands in `docs/measured.md`, too.
#[test]
fn figures_of_the_readme_are_measured() {
    let [readme, measured] =
        ["README.md", "docs/measured.md"].map(|page| repository::text(page).expect("a page is text"));
    let (_, results) = readme.split_once("\n## What it reaches\n").expect("the README has results");
    let rows: Vec<&str> =
        results.lines().take_while(|line| !line.starts_with("## ")).filter(|line| line.starts_with("| ")).collect();
    let cells = rows.iter().filter_map(|row| row.trim_end_matches([' ', '|']).rsplit('|').next());
    let numbers: Vec<&str> = cells.flat_map(|cell| cell.split([' ', ';'])).filter(|word| is_figure(word)).collect();
    assert!(numbers.len() >= 8, "no figures were found: {rows:?}");
    let known: BTreeSet<&str> =
        measured.split([' ', '\n', '*', ';']).map(|word| word.trim_end_matches([',', '.'])).collect();
    let others: Vec<String> =
        numbers.into_iter().filter(|number| !known.contains(number)).map(str::to_string).collect();
    none("figures of the README that docs/measured.md has not", &others);
}

fn is_figure(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_digit()) && word.chars().all(|c| c.is_ascii_digit() || matches!(c, '.' | ','))
}
