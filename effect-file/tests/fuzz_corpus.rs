//! Every kept input of the fuzzer, with every `cargo test`.
//!
//! A case that it finds goes into `tests/corpora/effect_file/` of the repository and stays there. See `fuzz/README.md`.

use std::path::Path;

#[allow(unreachable_pub)] // public to the fuzzers
#[path = "../../fuzz/src/effect_file.rs"]
mod effect_file;

#[test]
fn the_kept_corpus() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    for folder in ["../tests/corpora/effect_file", "../examples/effects"] {
        let files: Vec<_> = std::fs::read_dir(here.join(folder)).unwrap().map(|entry| entry.unwrap().path()).collect();
        assert!(files.len() >= 4, "{folder}");
        for file in files {
            effect_file::effect_file(&std::fs::read(&file).unwrap());
        }
    }
}
