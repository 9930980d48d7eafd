//! What the fuzzers found worth keeping, and the corpus, on every test run: the same functions, the kept inputs.
//!
//! A case that a fuzzer finds goes into `tests/corpora/TARGET/` of the repository and stays there. See `fuzz/README.md`.
#[path = "../../../fuzz/src/importer.rs"]
#[allow(unreachable_pub)] // public to the fuzzers
mod importer;

use std::path::Path;

/// The kept inputs of a target; of the corpus what is small, as a fuzzer would give it.
fn replay(target: &str, check: fn(&[u8])) {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut inputs = 0;
    for folder in [here.join("../tests/corpora").join(target), here.join("tests/corpus")] {
        for entry in std::fs::read_dir(folder).unwrap() {
            let bytes = std::fs::read(entry.unwrap().path()).unwrap();
            check(&bytes[..bytes.len().min(10_000)]);
            inputs += 1;
        }
    }
    assert!(inputs > 50, "{target}: {inputs} inputs");
}

macro_rules! corpora {
    ($($target:ident)*) => {$(
        #[test]
        fn $target() {
            replay(stringify!($target), importer::$target);
        }
    )*};
}

corpora!(import_text import_formats import_profile);
