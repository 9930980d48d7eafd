//! Effects that users write: the library's own linear and smooth ones, rewritten as files, are the same; what is wrong with a
//! file is said by the commands.

use std::path::{Path, PathBuf};

use crate::common::{of_repository, refused};
use host_sim::diagnosis::{DiagnoseSettings, Diagnosis, Prepared, diagnose};
use host_sim::effects::{Library, no_draw};
use host_sim::recording::Input;
use host_sim::simulator::scenario::{Scenario, Simulation};
use towmag_effect_file::EffectFile;

/// A file of `examples/effects`, the library's effect with the same values of its parameters, and how many nT one may be off the
/// other by a constant, which is no gap.
const REWRITTEN: [(&str, &str, f64); 16] = [
    (
        "own_heading_error",
        "heading_error:axis_azimuth_deg=28.64788975654116,axis_elevation_deg=40.10704565915763,cubic_nT=8,quartic_nT=4",
        0.0,
    ),
    ("own_fluxgate_bias", "fluxgate_bias:x_nT=20,y_nT=-15,z_nT=30", 0.0),
    ("own_fluxgate_scale", "fluxgate_scale:x_ppm=500,y_ppm=-400,z_ppm=-100", 0.0),
    ("own_fluxgate_nonorthogonality", "fluxgate_nonorthogonality:xy_mrad=1,xz_mrad=-0.8,yz_mrad=0.6", 0.0),
    ("own_fluxgate_temperature_drift", "fluxgate_temperature_drift:x_nT_per_K=2,y_nT_per_K=-1.5,z_nT_per_K=3", 0.0),
    ("own_fluxgate_nonlinearity", "fluxgate_nonlinearity:cubic_ppm=800", 0.0),
    ("own_permanent_step", "permanent_step:time_s=150,x_nT=3,y_nT=-4,z_nT=5", 0.0),
    ("own_permanent_temperature", "permanent_temperature:x_nT_per_K=1.5,y_nT_per_K=-1,z_nT_per_K=2", 0.0),
    ("own_tone", "mains_alias:frequency_hz=0.7,amplitude_nT=0.58309518948453,phase_rad=0.5404195002705842", 0.0),
    ("own_depth_gradient", "depth_gradient:gradient_nT_per_m=0.7", 100.0),
    ("own_lag", "scalar_lag:lag_s=0.05", 0.0),
    ("own_clock_drift", "clock_drift:rate_ppm=100", 0.0),
    ("own_load", "load_current:load=strobe,x_nT=3,y_nT=-4,z_nT=5", 0.0),
    ("own_swell", "swell_induction:gain_nT_per_m=1", 0.0),
    ("own_lowpass", "scalar_lowpass:time_constant_s=0.08", 0.0),
    ("own_window", "averaging_window:window_s=0.2", 0.0),
];

fn library_with(name: &str) -> Library {
    let path = of_repository(&format!("examples/effects/{name}.toml"));
    let text = std::fs::read_to_string(&path).unwrap();
    Library::default().with_file(EffectFile::parse(&text, name).unwrap()).unwrap()
}

/// A tow on a lake with a strobe.
fn simulation(duration_s: f64) -> Simulation {
    let text = std::fs::read_to_string(of_repository("scenarios/lake_tow.toml")).unwrap();
    let strobe = "\n[[current]]\nname = \"strobe\"\non_A = 1.0\nperiod_s = 7.3\nduty = 0.4\n";
    let scenario = Scenario { duration_s, ..Scenario::parse(&(text + strobe)).unwrap() };
    Simulation::new(&scenario, 11).unwrap()
}

#[test]
fn every_example_is_the_same_as_the_effect_that_it_rewrites() {
    let simulation = simulation(300.0);
    let signals = simulation.signals();
    for (name, built_in, constant_nt) in REWRITTEN {
        let library = library_with(name);
        let [own, other] = [name, built_in].map(|text| library.request(text).unwrap_or_else(|e| panic!("{e}")));
        let [own, other] =
            [own, other].map(|request| request.effect.change(signals, &request.parameters, &mut no_draw()));
        let flat = |change: &host_sim::effects::Change| match change.flux_nt.is_empty() {
            true => change.scalar_nt.clone(),
            false => change.flux_nt.as_flattened().to_vec(),
        };
        let off: Vec<f64> = flat(&own).iter().zip(flat(&other)).map(|(own, other)| own - other).collect();
        let (least, most) = off.iter().fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
        println!("{name:32} {:10.4} nT rms, off by {least:.1e} to {most:.1e} nT", own.rms_nt());
        assert!(own.rms_nt() > 1e-3 && off.len() >= signals.len(), "{name}");
        assert!(most - least < 1e-9 && most.abs() <= constant_nt + 1e-9, "{name}: {least} {most}");
    }
}

fn diagnosed(simulation: &Simulation, effect: &str, library: &Library, withheld: &[&str]) -> Diagnosis {
    let request = Library::default().request(effect).unwrap();
    let table = Prepared::of_simulation(simulation, &[request], "simulated", &library.columns()).unwrap();
    let withheld = withheld.iter().map(|name| name.to_string()).collect();
    let settings = DiagnoseSettings { library: library.clone(), withheld, ..DiagnoseSettings::default() };
    diagnose(&table, None, &settings).unwrap()
}

/// Verdict, the names with their probabilities, and the share of the gap that the first closes.
fn told(diagnosis: &Diagnosis) -> String {
    let named: Vec<String> =
        diagnosis.effects.iter().map(|effect| format!("{} {:.2}", effect.name, effect.probability)).collect();
    let closed = diagnosis.effects.first().map_or(f64::NAN, |effect| effect.gap_closed.fraction);
    format!("{:?} {} closes {closed:.3}", diagnosis.verdict, named.join(", "))
}

/// The same diagnosis of the library's effect by itself, and by the file with that effect withheld.
fn check_same_diagnosis(simulation: &Simulation, (name, effect): (&str, &str)) -> bool {
    let built_in = effect.split(':').next().unwrap();
    let library = library_with(name);
    let with = diagnosed(simulation, effect, &Library::default(), &[]);
    let without = diagnosed(simulation, effect, &library, &[built_in]);
    let names = |diagnosis: &Diagnosis, of: &'static str| -> Vec<&'static str> {
        diagnosis.effects.iter().map(|found| if found.name == of { "it" } else { found.name }).collect()
    };
    let own = library.spec(name).unwrap().name;
    let is_same = with.verdict == without.verdict
        && names(&with, Library::default().spec(built_in).unwrap().name) == names(&without, own);
    println!(
        "{name:32} {}\n    {:28} {} | {}",
        if is_same { "same" } else { "NOT THE SAME" },
        "",
        told(&with),
        told(&without)
    );
    is_same
}

#[test]
fn a_file_with_the_built_in_effect_withheld_gives_the_same_diagnosis() {
    let simulation = simulation(300.0);
    assert!(check_same_diagnosis(&simulation, ("own_depth_gradient", "depth_gradient:gradient_nT_per_m=0.7")));
    assert!(check_same_diagnosis(&simulation, ("own_lag", "scalar_lag:lag_s=0.05")));
}

/// All of them: `cargo test -p host-sim --test host effect_files -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes"]
fn every_file_with_its_effect_withheld_gives_the_same_diagnosis() {
    let simulation = simulation(480.0);
    let same = REWRITTEN.iter().filter(|(name, effect, _)| check_same_diagnosis(&simulation, (name, effect))).count();
    println!("{same} of {}", REWRITTEN.len());
    assert_eq!(same, REWRITTEN.len());
}

#[test]
fn the_commands_say_what_is_wrong_with_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_string()
    };
    let head = "channel = \"scalar\"\nkind = \"additive\"\n";
    let out = folder.path().join("rec.csv").to_str().unwrap().to_string();
    let scenario = of_repository("scenarios/land_calibration.toml").to_str().unwrap().to_string();
    let simulate = |effect: &str| refused(&["simulate", &scenario, "--effect-file", effect, "--out", &out]);
    let broken = file("broken.toml", &format!("name = \"a\"\n{head}formula = \"cx +\"\n"));
    assert!(simulate(&broken).contains("broken.toml: line 4: formula: the formula ends where a value is missing"));
    let taken = file("taken.toml", &format!("name = \"scalar_lag\"\n{head}formula = \"cx\"\n"));
    assert!(simulate(&taken).contains("the name scalar_lag is taken"));
    let column = file("column.toml", &format!("name = \"a\"\n{head}formula = \"winch_rpm * cx\"\n"));
    assert!(simulate(&column).contains("a needs winch_rpm, which the recording does not have"));
    let infinite = file("infinite.toml", &format!("name = \"a\"\n{head}formula = \"1 / t\"\n"));
    assert!(simulate(&infinite).contains("a has no finite value in row 1, at 0 s, with no parameter: 1 / t"));
    assert!(simulate("absent.toml").contains("absent.toml: cannot be read"));
}

/// A winch that turns now and then, for some seconds without a rhythm, at 10 rpm.
fn winch_rpm(row: i64) -> f64 {
    let moment = (row.max(0) as u64 / 41).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let is_on = (moment ^ (moment >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 63;
    10.0 * is_on as f64 + 0.1 * row.rem_euclid(7) as f64
}

/// A recording with a column `winch_rpm`, and what `added` says of the row and the direction of its fluxgate in the scalar.
fn with_winch(folder: &Path, simulation: &Simulation, added: impl Fn(i64, [f64; 3]) -> f64) -> PathBuf {
    let mut csv = Vec::new();
    simulation.record(&[]).write_csv(&mut csv).unwrap();
    let lines = String::from_utf8(csv).unwrap();
    let with = |(line_number, line): (usize, &str)| {
        if line_number == 0 {
            return format!("{line},winch_rpm");
        }
        let row = line_number as i64 - 1;
        let mut fields: Vec<String> = line.split(',').map(String::from).collect();
        let flux: Vec<f64> = fields[2..5].iter().map(|field| field.parse().unwrap()).collect();
        let length = flux.iter().map(|nt| nt * nt).sum::<f64>().sqrt();
        let nt = fields[1].parse::<f64>().unwrap() + added(row, [0, 1, 2].map(|i| flux[i] / length));
        fields[1] = format!("{nt:.3}");
        format!("{},{}", fields.join(","), winch_rpm(row))
    };
    let path = folder.join("rec.csv");
    std::fs::write(&path, lines.lines().enumerate().map(with).collect::<Vec<_>>().join("\n") + "\n").unwrap();
    path
}

fn diagnosed_file(path: &Path, library: &Library) -> Result<Diagnosis, host_sim::error::HostError> {
    let input = Input::new(path, false).ready().unwrap();
    let table = Prepared::read_with(&input, &library.columns()).unwrap();
    diagnose(&table, None, &DiagnoseSettings { library: library.clone(), ..DiagnoseSettings::default() })
}

#[test]
fn a_column_of_the_recording_drives_an_effect_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let text = "name = \"winch\"\nchannel = \"scalar\"\nkind = \"additive\"\nformula = \"g * winch_rpm\"\n\
                [parameters.g]\nlow = -1.0\nhigh = 1.0\ndefault = 0.1\n";
    let library = Library::default().with_file(EffectFile::parse(text, "winch.toml").unwrap()).unwrap();
    let path = with_winch(folder.path(), &simulation(240.0), |row, _| 0.1 * winch_rpm(row));
    let diagnosis = diagnosed_file(&path, &library).unwrap();
    let names: Vec<&str> = diagnosis.effects.iter().map(|effect| effect.name).collect();
    assert_eq!(names, ["winch"], "{}", told(&diagnosis));
    let gain = diagnosis.effects[0].parameters[0].value.unwrap();
    assert!((gain - 0.1).abs() < 0.01, "{gain}");
    // A recording without it.
    let bare = text.replace("winch_rpm", "pump_rpm");
    let library = Library::default().with_file(EffectFile::parse(&bare, "winch.toml").unwrap()).unwrap();
    let error = diagnosed_file(&path, &library).unwrap_err().to_string();
    assert!(error.contains("winch needs pump_rpm, which the recording does not have"), "{error}");
}

#[test]
fn a_suspected_column_is_named_with_its_form_and_its_delay() {
    let folder = tempfile::tempdir().unwrap();
    let simulation = simulation(300.0);
    let library = host_sim::command::with_regressors(Library::default(), &["winch_rpm".into()]).unwrap();
    // 1.3 s after the column, whatever the attitude; then as a moment across, at once.
    let additive = with_winch(folder.path(), &simulation, |row, _| 0.2 * winch_rpm(row - 13));
    let diagnosis = diagnosed_file(&additive, &library).unwrap();
    let found = &diagnosis.effects[0];
    assert_eq!(
        (found.name, found.regressor.as_deref()),
        ("regressor:winch_rpm", Some("winch_rpm")),
        "{}",
        told(&diagnosis)
    );
    let value = |name: &str| found.parameters.iter().find(|parameter| parameter.name == name).unwrap().value.unwrap();
    assert!((value("gain_nT_per_unit") - 0.2).abs() < 0.02 && (value("delay_s") - 1.3).abs() < 0.1, "{found:?}");
    let moment = with_winch(folder.path(), &simulation, |row, c| 0.5 * winch_rpm(row) * c[1]);
    let diagnosis = diagnosed_file(&moment, &library).unwrap();
    let found = &diagnosis.effects[0];
    assert_eq!(found.name, "regressor_moment:winch_rpm", "{}", told(&diagnosis));
    let value = |name: &str| found.parameters.iter().find(|parameter| parameter.name == name).unwrap().value.unwrap();
    assert!((value("y_nT_per_unit") - 0.5).abs() < 0.1 && value("delay_s").abs() < 0.1, "{found:?}");
    // A column that has nothing to do with it is not named.
    let nothing = with_winch(folder.path(), &simulation, |_, _| 0.0);
    let diagnosis = diagnosed_file(&nothing, &library).unwrap();
    assert!(diagnosis.effects.is_empty(), "{}", told(&diagnosis));
    // What is asked for must be there, and be no reading.
    for (column, why) in [("scalar_nT", "is what the diagnosis is to explain"), ("pump_rpm", "no such column")] {
        let out = folder.path().join("out");
        let arguments = ["diagnose", additive.to_str().unwrap(), "--regressor", column, "--out", out.to_str().unwrap()];
        assert!(refused(&arguments).contains(why));
    }
}
