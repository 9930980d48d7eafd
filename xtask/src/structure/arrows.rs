//! Which file uses names of which.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use super::mentions::Mentions;
use super::scope::{Scope, Target};
use super::source::SourceCrate;

/// A file that uses what another defines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Arrow {
    /// The file that uses.
    pub from: PathBuf,
    /// The file that defines.
    pub to: PathBuf,
    /// What is used, as it is called where it is used.
    pub names: BTreeSet<String>,
}

/// The arrows of a crate. A declaration of a module and a re-export are none: what they hand on belongs to the file that
/// defines it.
pub fn arrows(source: &SourceCrate) -> Vec<Arrow> {
    let scope = Scope::of(source);
    let mut found: BTreeMap<(PathBuf, PathBuf), BTreeSet<String>> = BTreeMap::new();
    for (number, module) in source.modules.iter().enumerate() {
        let imported = scope.imports(number).iter().filter(|import| !import.is_reexport && import.name.is_some());
        let used = imported.map(|import| import.path.clone()).chain(Mentions::of(module));
        for path in used {
            for target in scope.resolve(number, &path) {
                if let Target::File(file) = target
                    && file != module.file
                {
                    let names = found.entry((module.file.clone(), file.to_path_buf())).or_default();
                    names.insert(name(&path));
                }
            }
        }
    }
    found.into_iter().map(|((from, to), names)| Arrow { from, to, names }).collect()
}

/// The item that a path leads to: what stands before its own variants, methods and constants.
fn name(path: &[String]) -> String {
    let item = path.iter().find(|segment| segment.starts_with(char::is_uppercase)).or(path.last());
    item.cloned().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// `from -> to: names` of a crate whose files are given.
    fn of(files: &[(&str, &str)]) -> Vec<String> {
        let read = |path: &Path| {
            let found = files.iter().find(|(name, _)| Path::new(name) == path);
            found.map(|(_, text)| (*text).to_string())
        };
        let arrows = arrows(&SourceCrate::parse(Path::new("lib.rs"), &read));
        let shown = |arrow: &Arrow| {
            let names: Vec<&str> = arrow.names.iter().map(String::as_str).collect();
            format!("{} -> {}: {}", arrow.from.display(), arrow.to.display(), names.join(", "))
        };
        arrows.iter().map(shown).collect()
    }

    #[test]
    fn an_import_and_an_inline_path_are_arrows() {
        let files = [
            ("lib.rs", "mod a; mod b;"),
            ("a.rs", "use crate::b::One; fn f(_: super::b::Two) { super::b::three() }"),
            ("b.rs", "pub struct One; pub struct Two; pub fn three() {}"),
        ];
        assert_eq!(of(&files), ["a.rs -> b.rs: One, Two, three"]);
    }

    #[test]
    fn a_declaration_and_a_reexport_are_none() {
        let files = [("lib.rs", "mod a; pub use a::One; pub(crate) use a::*;"), ("a.rs", "pub struct One;")];
        assert_eq!(of(&files), [""; 0]);
        let used = [("lib.rs", "mod a; pub use a::One; fn f(_: One) {}"), ("a.rs", "pub struct One;")];
        assert_eq!(of(&used), ["lib.rs -> a.rs: One"]);
    }

    #[test]
    fn reexports_lead_to_the_file_that_defines() {
        let files = [
            ("lib.rs", "mod a; mod b;"),
            ("a/mod.rs", "mod inner; pub use self::inner::*; pub mod other { pub use super::inner::Two as Second; }"),
            ("a/inner.rs", "pub struct One; pub struct Two; impl One { pub const ZERO: u8 = 0; }"),
            ("b.rs", "use crate::a; use a::other::Second; const X: u8 = a::One::ZERO;"),
        ];
        assert_eq!(of(&files), ["b.rs -> a/inner.rs: One, Second"]);
    }

    #[test]
    fn groups_selves_and_new_names_are_followed() {
        let files = [
            ("lib.rs", "mod a; mod b;"),
            ("a.rs", "pub mod deep { pub fn f() {} } pub struct One;"),
            (
                "b.rs",
                "use super::{a::{self as first, deep::{self}, One as Uno}}; fn g(_: Uno) { deep::f(); first::deep::f() }",
            ),
        ];
        assert_eq!(of(&files), ["b.rs -> a.rs: One, Uno, f"]);
    }

    #[test]
    fn a_function_is_no_step_of_a_path() {
        let files = [
            ("lib.rs", "mod a; mod draw; fn draw() {}"),
            ("a.rs", "use super::draw::STRENGTHS;"),
            ("draw.rs", "pub const STRENGTHS: u8 = 1;"),
        ];
        assert_eq!(of(&files), ["a.rs -> draw.rs: STRENGTHS"]);
    }

    #[test]
    fn globs_count_where_a_name_of_them_is_used() {
        let files = [
            ("lib.rs", "mod a; mod b; mod c;"),
            ("a.rs", "use crate::b::*; fn f(_: One) {}"),
            ("b.rs", "pub struct One;"),
            ("c.rs", "use crate::b::*;"),
        ];
        assert_eq!(of(&files), ["a.rs -> b.rs: One"]);
    }

    #[test]
    fn tests_and_other_crates_are_left_out() {
        let files = [
            ("lib.rs", "mod a; mod b; #[cfg(test)] mod tests;"),
            (
                "a.rs",
                "use std::fmt::One; #[cfg(test)] mod tests { use crate::b::One; } #[cfg(test)] use crate::b::One as T;",
            ),
            ("b.rs", "pub struct One; fn f(_: ::a::One) {}"),
        ];
        assert_eq!(of(&files), [""; 0]);
    }

    #[test]
    fn reexports_in_a_circle_come_to_an_end() {
        let files = [
            ("lib.rs", "mod a; mod b;"),
            ("a.rs", "pub use crate::b::*;"),
            ("b.rs", "pub use crate::a::*; fn f(_: One) {}"),
        ];
        assert_eq!(of(&files), [""; 0]);
    }
}
