//! Scenarios as a whole.

use super::*;
use crate::effects::Request;

const LAND: &str = include_str!("../../../../scenarios/land_calibration.toml");
const LAKE: &str = include_str!("../../../../scenarios/lake_tow.toml");
const SEA: &str = include_str!("../../../../scenarios/sea_tow.toml");

fn played(text: &str, seed: u64) -> Simulation {
    Simulation::new(&Scenario::parse(text).unwrap(), seed).unwrap()
}

fn csv(simulation: &Simulation, effects: &[&str]) -> String {
    let requests: Vec<Request> = effects.iter().map(|text| text.parse().unwrap()).collect();
    let mut out = Vec::new();
    simulation.record(&requests).write_csv(&mut out).unwrap();
    String::from_utf8(out).unwrap()
}

/// Shorter, for what does not need the whole.
fn short(text: &str) -> String {
    let line = text.lines().find(|line| line.starts_with("duration_s")).unwrap();
    text.replace(line, "duration_s = 120.0")
}

#[test]
fn the_presets_have_the_field_and_the_std_of_the_paper() {
    for (text, field_nt, std_nt) in [(LAND, 52_295.0, 65.09), (LAKE, 52_379.0, 14.07), (SEA, 48_573.0, 3.936)] {
        let simulation = played(text, Scenario::parse(text).unwrap().seed);
        let rows = simulation.signals().rows();
        let mean_nt = rows.field_nt.iter().sum::<f64>() / rows.field_nt.len() as f64;
        assert!((mean_nt - field_nt).abs() < 25.0, "{mean_nt}");
        let found_nt = band_passed_std_nt(simulation.record(&[]).readings.scalar_nt.iter().copied());
        assert!((found_nt / std_nt - 1.0).abs() < 0.01, "{found_nt} {std_nt}");
    }
}

#[test]
fn the_motion_is_as_large_as_asked() {
    let simulation = played(SEA, 3);
    let rms_deg = |of: fn(&crate::simulator::Attitude) -> f64| {
        let squares = simulation.attitude().iter().map(|attitude| of(attitude).to_degrees().powi(2));
        (squares.sum::<f64>() / simulation.attitude().len() as f64).sqrt()
    };
    // Scaled over the margins too: a few percent.
    assert!((rms_deg(|a| a.roll) / 2.0 - 1.0).abs() < 0.05 && (rms_deg(|a| a.pitch) / 1.2 - 1.0).abs() < 0.05);
    let depth_m = simulation.signals().trajectory().depth_m.as_ref().unwrap();
    let square_m2 = depth_m.iter().map(|m| (m - 12.0).powi(2)).sum::<f64>() / depth_m.len() as f64;
    // Significant height 0.8 m, a quarter of it the standard deviation, 0.4 of that the heave.
    assert!((square_m2.sqrt() / (0.8 / 4.0 * 0.4) - 1.0).abs() < 0.1, "{}", square_m2.sqrt());
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_does_not() {
    for text in [LAND, LAKE, SEA] {
        let text = short(text);
        let effects = ["sample_jitter:sigma_s=0.01", "stale_sample:probability=0.01"];
        let one = csv(&played(&text, 7), &effects);
        assert_eq!(one, csv(&played(&text, 7), &effects));
        assert_ne!(one, csv(&played(&text, 8), &effects));
    }
}

#[test]
fn effects_add_and_leave_the_noise_as_it_is() {
    let simulation = played(&short(LAKE), 7);
    let record = |effects: &[&str]| {
        let requests: Vec<Request> = effects.iter().map(|text| text.parse().unwrap()).collect();
        simulation.record(&requests).readings.scalar_nt
    };
    let (lag, gradient) = ("scalar_lag:lag_s=0.1", "depth_gradient:gradient_nT_per_m=3");
    let (none, one, other, both) = (record(&[]), record(&[lag]), record(&[gradient]), record(&[lag, gradient]));
    for row in 0..none.len() {
        let sum_nt = one[row] + other[row] - none[row];
        // Each is rounded to 0.001 nT.
        assert!((both[row] - sum_nt).abs() < 0.0021, "{row}");
    }
}

#[test]
fn gaps_dropouts_and_columns_are_as_asked() {
    let more = "[dead_zone]\naxis_azimuth_deg = 0\naxis_elevation_deg = 90\nhalf_angle_deg = 1\n\
                [[gap]]\nbegin_s = 30\nlength_s = 2\n[[dropout]]\nbegin_s = 50\nlength_s = 1\n\
                [[current]]\nname = \"pump\"\non_A = 1.5\nperiod_s = 20\nduty = 0.25\n\
                [[target]]\nat_s = 60\npeak_nT = 500\nwidth_s = 2\n";
    let text = format!("first_time_s = 58000.5\n{}{more}", short(LAKE));
    let table = csv(&played(&text, 7), &[]);
    let mut lines = table.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert!(table.starts_with("time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT,scalar_valid,depth_m,temperature_degC,"));
    let column = |name: &str| header.iter().position(|column| *column == name).unwrap();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 1200 - 20);
    assert_eq!((rows[0][0], rows[299][0], rows[300][0]), ("58000.5", "58030.4", "58032.5"));
    let invalid = rows.iter().filter(|row| row[column("scalar_valid")] == "0").count();
    assert_eq!(invalid, 10, "the field is never within a degree of the vertical");
    let on = rows.iter().filter(|row| row[column("current_pump_A")] == "1.5").count();
    assert_eq!(on, 6 * 50);
    let scalar_nt = |row: usize| rows[row][1].parse::<f64>().unwrap();
    assert!(scalar_nt(580) - scalar_nt(540) > 300.0, "the target");
}

#[test]
fn the_world_magnetic_model_gives_its_published_values() {
    // WMM2025 at 914.4 m, 80 N, 135.218 E on 15 January 2029: F 59,020.67 nT, D -26.41 degrees.
    let field = Field {
        latitude_deg: Some(80.0),
        longitude_deg: Some(2.36_f64.to_degrees()),
        height_m: 914.4,
        date: Some("2029-01-15".into()),
        ..Field::default()
    };
    let earth = field.resolve().unwrap();
    assert!((earth.strength_nt - 59_020.67).abs() < 0.1, "{}", earth.strength_nt);
    let declination_deg = earth.direction[1].atan2(earth.direction[0]).to_degrees();
    assert!((declination_deg + 26.41).abs() < 0.01, "{declination_deg}");
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let error = |from: &str, to: &str| Scenario::parse(&LAKE.replacen(from, to, 1)).unwrap_err();
    assert!(error("seed = 2", "sed = 2").starts_with("line 3: unknown field `sed`"));
    assert!(error("latitude_deg = 39.1", "").starts_with("field: give latitude_deg, longitude_deg and date"));
    assert_eq!(error("strength_nT = 52379.0", "strength_nT = 5"), "field.strength_nT: 5 is outside 1000 to 100000");
    assert_eq!(error("leg_s = 200.0", "leg_s = nan"), "motion.tow.leg_s: NaN is outside 10 to 100000");
    assert!(error("uncompensated_std_nT = 14.07", "").starts_with("interference: give coefficients"));
    assert!(error("lake_tow", "pond_tow").contains("unknown variant `pond_tow`"));
    let impossible = LAKE.replacen("2026-06-20", "2026-02-30", 1);
    let error = Simulation::new(&Scenario::parse(&impossible).unwrap(), 1).unwrap_err();
    assert_eq!(error, "field.date: \"2026-02-30\" is no day, YYYY-MM-DD");
}

/// Bits of the made recordings: another machine, another release and another optimisation give these.
#[test]
fn the_bytes_are_those_that_they_have_always_been() {
    let effects = [
        "scalar_lowpass:time_constant_s=0.1",
        "sample_jitter:sigma_s=0.01",
        "dead_zone:half_angle_deg=40,noise_nT=1,axis_elevation_deg=80",
    ];
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let sums = [LAND, LAKE, SEA].map(|text| crc.checksum(csv(&played(&short(text), 7), &effects).as_bytes()));
    assert_eq!(sums.map(|sum| format!("{sum:08x}")), ["2a65ece7", "c92ce593", "f8ba7c89"]);
}
