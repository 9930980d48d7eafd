//! Files that are refused, each with line and reason; and any text at all, which must do no harm.

use proptest::prelude::*;
use towmag_effect_file::{EffectFile, LARGEST_FILE};

const GOOD: &str = r#"name = "pump_moment"
title = "the pump's current as a moment"
channel = "scalar"
kind = "additive"
formula = "g * current_pump_A * cx + h * slow_cx"

[parameters.g]
unit = "nT/A"
low = -50.0
high = 50.0
default = 5.0

[parameters.h]
low = -1
high = 1
default = 0

[inputs.slow_cx]
of = "cx"
filter = "lowpass"
time_s = 20.0
"#;

fn error(text: &str) -> String {
    EffectFile::parse(text, "my.toml").unwrap_err().to_string()
}

#[test]
fn what_is_wrong_is_said_with_file_line_and_reason() {
    assert_eq!(EffectFile::parse(GOOD, "my.toml").unwrap().columns(), ["current_pump_A"]);
    for (from, to, message) in [
        ("name = \"pump_moment\"", "name = \"Pump\"", "my.toml: line 1: the name \"Pump\" is not made of a-z"),
        ("the pump's", "\\u001b[2J", "line 2: the title"),
        ("scalar", "vector", "line 3: unknown variant `vector`, expected `scalar` or `fluxgate`"),
        ("additive", "variance", "line 4: unknown variant"),
        ("g * current_pump_A * cx", "g * * cx", "line 5: formula: there is no value before *, at character 5 of"),
        ("g * current_pump_A * cx", "g * scalar_nT", "line 5: formula: \"scalar_nT\" is the reading itself"),
        ("g * current_pump_A * cx + h", "g", "line 5: the parameter h is in no formula"),
        ("\"g * current_pump_A * cx + h * slow_cx\"", "[\"g\", \"h\", \"g\"]", "line 5: formula: of the scalar"),
        ("channel = \"scalar\"", "channel = \"fluxgate\"", "line 5: formula: of the fluxgate it is three strings"),
        ("parameters.g", "parameters.cx", "line 7: the name cx has a meaning of its own"),
        ("low = -50.0", "low = 50.0", "line 7: g: low must be below high"),
        ("high = 50.0", "high = inf", "line 7: g: low must be below high"),
        ("default = 5.0", "default = 51.0", "line 7: g: default must be between"),
        ("default = 5.0", "", "line 7: missing field `default`"),
        ("default = 5.0", "defualt = 5.0", "line 11: unknown field `defualt`"),
        ("inputs.slow_cx", "inputs.g", "line 18: g is a parameter already"),
        ("of = \"cx\"", "of = \"slow_cx\"", "line 18: slow_cx is made of slow_cx, which must stand above it"),
        ("of = \"cx\"", "of = \"g\"", "line 18: slow_cx is made of the parameter g"),
        ("\"lowpass\"", "\"rate\"", "line 18: slow_cx: this filter has no time_s"),
        ("time_s = 20.0", "", "line 18: slow_cx: time_s is missing"),
        ("time_s = 20.0", "time_s = 20.0\nwidth = 0.1", "line 18: slow_cx: this filter has no width"),
        ("\"lowpass\"", "\"play\"", "line 18: slow_cx: width is missing"),
        ("\"lowpass\"", "\"play\"\nwidth = 0.1", "line 18: slow_cx: this filter has no time_s"),
        ("\"lowpass\"\ntime_s = 20.0", "\"play\"\nwidth = -0.1", "line 18: slow_cx: width must be a finite number"),
        ("\"lowpass\"\ntime_s = 20.0", "\"hold\"", "line 18: slow_cx: width is missing"),
        ("of = \"cx\"", "of = \"cx\"\nformula = \"cx\"", "line 18: slow_cx: it is made either `of` a variable or of"),
        ("of = \"cx\"\n", "", "line 18: slow_cx: it is made either `of` a variable or of"),
        ("of = \"cx\"", "formula = \"cx +\"", "line 18: slow_cx: formula: "),
        ("of = \"cx\"", "formula = \"g * cx\"", "line 18: slow_cx is made of the parameter g"),
        ("of = \"cx\"", "formula = \"cx + slow_cx\"", "line 18: slow_cx is made of slow_cx, which must stand above"),
        ("time_s = 20.0", "time_s = -1", "line 18: slow_cx: time_s must not be below 0"),
        ("time_s = 20.0", "time_s = \"tau\"", "line 18: slow_cx: time_s: there is no parameter \"tau\""),
        ("time_s = 20.0", "time_s = nan", "line 18: slow_cx: time_s must be at most"),
        ("[parameters.g]", "[parameters.g", "line 7: "),
    ] {
        let text = GOOD.replacen(from, to, 1);
        assert_ne!(text, GOOD, "{from}");
        assert!(error(&text).contains(message), "{to}: {}", error(&text));
    }
    assert!(error(&format!("{GOOD}#{}", "x".repeat(LARGEST_FILE))).contains("larger than"));
    assert!(error("").contains("line 1: missing field `name`"));
}

#[test]
fn an_input_may_be_made_of_a_formula_of_columns_and_of_inputs_above() {
    let slanted =
        "[inputs.slanted]\nformula = \"0.6 * slow_cx + 0.8 * current_winch_A\"\nfilter = \"play\"\nwidth = 0.1\n";
    let text = format!("{GOOD}{slanted}").replacen("slow_cx\"\n", "slow_cx * slanted\"\n", 1);
    let file = EffectFile::parse(&text, "my.toml").unwrap();
    assert_eq!(file.columns(), ["current_pump_A", "current_winch_A"]);
    assert_eq!((file.inputs[0].of.alone().is_some(), file.inputs[1].of.alone()), (true, None));
    assert_eq!(file.inputs[1].of.eval(&[2.0, -1.0]), 0.6 * 2.0 - 0.8);
}

#[test]
fn as_many_parameters_as_a_file_may_have() {
    let with = |count: usize| {
        let sum: Vec<String> = (0..count).map(|k| format!("p{k}*cx^{}", k % 5)).collect();
        let tables = (0..count).map(|k| format!("[parameters.p{k}]\nlow = -1\nhigh = 1\ndefault = 0\n"));
        let formula = sum.join(" + ");
        let head = format!("name = \"many\"\nchannel = \"scalar\"\nkind = \"additive\"\nformula = \"{formula}\"\n");
        EffectFile::parse(&(head + &tables.collect::<String>()), "many.toml")
    };
    let most = with(16).unwrap();
    assert!(most.parameters.iter().enumerate().all(|(k, p)| p.is_linear && p.name == format!("p{k}")));
    assert!(with(17).unwrap_err().to_string().contains("more than 16 parameters"));
}

#[test]
fn how_a_formula_depends_on_its_parameters_is_found() {
    let of = |kind: &str, formula: &str| {
        let parameter = |name: &str| match formula.contains(name) {
            true => format!("[parameters.{name}]\nlow = 0.5\nhigh = 900.0\ndefault = 1.0\n"),
            false => String::new(),
        };
        let parameters: String = ["aa", "bb", "kk"].map(parameter).concat();
        let text =
            format!("name = \"x\"\nchannel = \"scalar\"\nkind = \"{kind}\"\nformula = \"{formula}\"\n{parameters}");
        let file = EffectFile::parse(&text, "x.toml").unwrap();
        let letter = |p: &towmag_effect_file::Parameter| match (p.is_linear, p.is_stepped) {
            (true, _) => 'l',
            (_, true) => 's',
            _ => 'n',
        };
        file.parameters.iter().map(letter).collect::<String>()
    };
    assert_eq!(of("additive", "aa*cx + bb*cy^2"), "ll");
    assert_eq!(of("multiplicative", "1e-6*aa*temperature"), "l");
    // Each alone, but not both together: one of them is held.
    assert_eq!(of("additive", "aa*bb*cx"), "ln");
    assert_eq!(of("additive", "aa*sin(2*pi*kk*t) + bb*cos(2*pi*kk*t)"), "lln");
    assert_eq!(of("additive", "aa*cx + 1"), "n");
    assert_eq!(of("additive", "abs(aa)*cx"), "n");
    assert_eq!(of("additive", "min(aa, 800)*cx"), "n");
    assert_eq!(of("additive", "aa*(time_s >= kk)*cx"), "ls");
    assert_eq!(of("additive", "aa*floor(kk)*cx"), "ls");
    assert_eq!(of("additive", "aa*tanh(dcy/kk)"), "ln");
    assert_eq!(of("delay", "aa + bb*t"), "nn");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_bytes_are_taken_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let _ = EffectFile::parse(&String::from_utf8_lossy(&bytes), "any.toml");
    }

    /// A good file with a stretch of it replaced is refused with a line that it has, or evaluated without a panic.
    #[test]
    fn a_damaged_file_is_taken_or_refused(from in 0..400_usize, len in 0..40_usize, with in "[ -~\\n]{0,12}") {
        let end = (from + len).min(GOOD.len());
        let text = format!("{}{with}{}", &GOOD[..from.min(GOOD.len())], &GOOD[end.max(from.min(GOOD.len()))..]);
        match EffectFile::parse(&text, "any.toml") {
            Ok(file) => {
                for formula in &file.formulas {
                    formula.eval(&vec![0.5; formula.sources.len()]);
                }
            }
            Err(error) => prop_assert!(error.line >= 1 && error.line <= text.lines().count() + 1),
        }
    }
}
