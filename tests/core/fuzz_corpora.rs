//! What the fuzzers found worth keeping, on every test run: the same functions, the kept inputs.
//!
//! A case that a fuzzer finds goes into `tests/corpora/TARGET/` and stays there. See `fuzz/README.md`.

#[path = "../../fuzz/src/targets.rs"]
#[allow(unreachable_pub)] // public to the fuzzers
mod targets;

fn replay(target: &str, check: fn(&[u8])) {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpora").join(target);
    let mut inputs = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        check(&std::fs::read(entry.unwrap().path()).unwrap());
        inputs += 1;
    }
    assert!(inputs > 0, "{target}: nothing kept");
}

macro_rules! corpora {
    ($($target:ident)*) => {$(
        #[test]
        fn $target() {
            replay(stringify!($target), targets::$target);
        }
    )*};
}

corpora!(scalar nmea adc_frame log console telemetry settings);
