//! What is fuzzed of the effects that users write: any text as a file, and any text as a formula. Each function takes any bytes
//! and panics when a promise is broken. The fuzzer and the test of the kept corpus call the same function.

use towmag_effect_file::{EffectFile, MOST_INPUTS, MOST_NAMES, MOST_PARAMETERS};

/// A file: refused with a line that it has and a reason of one line, or an effect within its bounds that has a value. Then the
/// same bytes as the formula of a file that is otherwise good, which a fuzzer hardly meets by chance.
pub fn effect_file(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    check(&text);
    let formula: String = text.chars().filter(|c| !matches!(c, '\'' | '\n' | '\r')).collect();
    let parameter = |name: &str| format!("[parameters.{name}]\nlow = -2.0\nhigh = 3.0\ndefault = 0.5\n");
    let slow = "[inputs.slow]\nof = \"cx\"\nfilter = \"mean\"\ntime_s = \"a\"\n";
    let head = "name = \"fuzzed\"\nchannel = \"scalar\"\nkind = \"additive\"\n";
    check(&format!("{head}formula = '{formula}'\n{}{}{slow}", parameter("a"), parameter("b")));
}

fn check(text: &str) {
    let file = match EffectFile::parse(text, "fuzzed.toml") {
        Ok(file) => file,
        Err(error) => {
            assert!(error.line >= 1 && error.line <= text.matches('\n').count() + 1, "{error}");
            assert!(!error.reason.is_empty() && !error.reason.contains(char::is_control), "{error:?}");
            return;
        }
    };
    assert!(file.parameters.len() <= MOST_PARAMETERS && file.inputs.len() <= MOST_INPUTS);
    assert!(file.parameters.iter().all(|p| p.low <= p.default && p.default <= p.high));
    for formula in &file.formulas {
        assert!(formula.sources.len() <= MOST_NAMES);
        // It may have none, but it must come to an end.
        formula.eval(&vec![0.5; formula.sources.len()]);
        formula.eval(&vec![-1e9; formula.sources.len()]);
    }
    assert!(file.columns().iter().all(|column| !column.is_empty()));
}
