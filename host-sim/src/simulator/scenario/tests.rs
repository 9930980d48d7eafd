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

const SURVEY: &str = include_str!("../../../../scenarios/survey_tow.toml");

/// Without noise and interference, and the rest as it is.
fn clean(text: &str) -> Simulation {
    let mut scenario = Scenario::parse(text).unwrap();
    scenario.interference = InterferenceSource { coefficients: Some([0.0; 18]), uncompensated_std_nt: None };
    (scenario.scalar.noise_rms_nt, scenario.fluxgate.noise_rms_nt) = (0.0, 0.0);
    Simulation::new(&scenario, scenario.seed).unwrap()
}

#[test]
fn the_lines_of_the_survey_lie_side_by_side() {
    let simulation = played(SURVEY, 4);
    let track = simulation.track();
    let on_line = |name: &str| {
        let row = simulation.line().iter().position(|line| line == name).unwrap();
        let (place_m, course) = (track.place_m[row + 500], track.course[row + 500]);
        let (sin, cos) = (35.0_f64.to_radians().sin(), 35.0_f64.to_radians().cos());
        (course.to_degrees().rem_euclid(360.0), place_m[1] * cos - place_m[0] * sin)
    };
    let lines = ["leg1", "leg2", "leg3", "leg4", "leg5", "leg6"].map(on_line);
    for (k, pair) in lines.windows(2).enumerate() {
        assert!((lines[k].0 - if k % 2 == 0 { 35.0 } else { 215.0 }).abs() < 1e-6, "{lines:?}");
        assert!((20.0..35.0).contains(&(pair[1].1 - pair[0].1)), "{lines:?}");
    }
}

#[test]
fn both_sensors_see_the_iron() {
    let (with, without) = (clean(SURVEY), clean(SURVEY.split("[[dipole]]").next().unwrap()));
    let earth = with.scenario().field.resolve().unwrap();
    let (with_rows, without_rows) = (with.signals().rows(), without.signals().rows());
    let [with_nt, without_nt] = [&with, &without].map(|simulation| simulation.signals().scalar_at_rows_nt());
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let mut largest_nt: f64 = 0.0;
    for row in 0..with.signals().len() {
        let place_m = with.track().place_m[row];
        let iron_nt = with.track().dipoles.iter().fold([0.0; 3], |sum: [f64; 3], dipole| {
            let field_nt = dipole.field_nt(place_m);
            std::array::from_fn(|i| sum[i] + field_nt[i])
        });
        let anomaly_nt = with_nt[row] - without_nt[row];
        // What is across the Earth's field adds its square over twice the field.
        let across_nt = dot(iron_nt, iron_nt) / (2.0 * earth.strength_nt);
        assert!((anomaly_nt - dot(iron_nt, earth.direction)).abs() < across_nt + 0.01, "{row}");
        let [x, y, z] = with_rows.flux_nt[row];
        assert!((libm::sqrt(x * x + y * y + z * z) - with_nt[row]).abs() < 1e-6);
        let change: [f64; 3] = std::array::from_fn(|i| with_rows.flux_nt[row][i] - without_rows.flux_nt[row][i]);
        assert!((dot(change, change).sqrt() - dot(iron_nt, iron_nt).sqrt()).abs() < 0.02, "{row}");
        largest_nt = largest_nt.max(anomaly_nt.abs());
    }
    assert!((5.0..500.0).contains(&largest_nt), "{largest_nt}");
}

#[test]
fn iron_lies_where_it_is_said_to_and_leaves_the_body_as_it_is() {
    let simulation = played(SURVEY, 4);
    let track = simulation.track();
    let row = 900;
    let dipole = track.dipoles[0];
    let apart: [f64; 3] = std::array::from_fn(|i| dipole.place_m[i] - track.place_m[row][i]);
    let (sin, cos) = track.course[row].sin_cos();
    let (ahead, right) = (cos * apart[0] + sin * apart[1], cos * apart[1] - sin * apart[0]);
    assert!(ahead.abs() < 1e-9 && (right - 1.5).abs() < 1e-9 && (apart[2] - 3.2).abs() < 1e-9, "{apart:?}");
    assert!((dipole.moment_am2.iter().map(|m| m * m).sum::<f64>().sqrt() - 6.0).abs() < 1e-9);
    let [latitude_deg, longitude_deg] = track.degrees([dipole.place_m[0], dipole.place_m[1]]).unwrap();
    let by_place = format!(
        "{}[[dipole]]\nmoment_Am2 = [0.0, 0.0, 1.0]\nlatitude_deg = {latitude_deg:.9}\nlongitude_deg = \
         {longitude_deg:.9}\ndepth_m = {:.6}\n",
        SURVEY.split("[[dipole]]").next().unwrap(),
        dipole.place_m[2]
    );
    let other = played(&by_place, 4);
    let off = (0..3).map(|i| (other.track().dipoles[0].place_m[i] - dipole.place_m[i]).abs());
    assert!(off.fold(0.0, f64::max) < 1e-3);
    let coefficients = |simulation: &Simulation| *simulation.signals().coefficients();
    assert_eq!(coefficients(&simulation), coefficients(&other), "the body");
}

#[test]
fn the_columns_of_a_survey_are_written() {
    let text = SURVEY.replacen("[columns]", "[ship]\ncable_out_m = 20.0\n[columns]", 1);
    let simulation = played(&text, 4);
    let table = csv(&simulation, &[]);
    let mut lines = table.lines();
    let header = lines.next().unwrap();
    assert!(
        header.ends_with(",line,latitude_deg,longitude_deg,altitude_m,speed_m_per_s,utc_s,cable_out_m"),
        "{header}"
    );
    let fields: Vec<&str> = lines.nth(1000).unwrap().rsplit(',').collect();
    let [cable, utc, speed, altitude] = [0, 1, 2, 3].map(|k| fields[k].parse::<f64>().unwrap());
    let depth_m = simulation.track().place_m[1000][2];
    // 2026-06-20 08:30 UTC: 20,624 days and 30,600 s.
    assert_eq!((cable, utc, speed), (20.0, 20_624.0 * 86_400.0 + 30_600.0 + 100.0, 2.0));
    assert!((altitude - (7.0 - depth_m)).abs() < 0.000_6);
    let (ship_m, body_m) = (simulation.ship_m().unwrap()[1000], simulation.track().place_m[1000]);
    let ahead_m = libm::hypot(ship_m[0] - body_m[0], ship_m[1] - body_m[1]);
    assert!((libm::hypot(ahead_m, depth_m) - 20.0).abs() < 0.03, "{ahead_m}");
}

#[test]
fn a_second_sensor_passes_the_same_iron_later() {
    let more = "[scalar2]\nahead_m = -3.0\n[scalar2.interference]\nuncompensated_std_nT = 0.0\n\
                [scalar2.sensor]\nnoise_rms_nT = 0.0\nresolution_nT = 0.001\n";
    let simulation = clean(&SURVEY.replacen("[columns]", &format!("{more}[columns]"), 1));
    let (first_nt, second_nt) = (&simulation.signals().rows().field_nt, simulation.second_nt().unwrap());
    // 3 m behind at 2 m/s: 15 rows, but for the yaw (2 degrees rms of 3 m) and the depth meanwhile.
    let highest = |nt: &[f64]| (700..1100).max_by(|&a, &b| nt[a].total_cmp(&nt[b])).unwrap();
    assert!(highest(&second_nt).abs_diff(highest(first_nt) + 15) <= 1);
    assert!((second_nt[1500] - first_nt[1485]).abs() < 1.0);
    assert!(csv(&simulation, &[]).lines().next().unwrap().ends_with(",scalar2_nT"));
}

#[test]
fn what_a_survey_lacks_is_said() {
    let error = |from: &str, to: &str| Scenario::parse(&SURVEY.replacen(from, to, 1)).unwrap_err();
    assert!(error("speed_m_per_s = 2.0\n", "").starts_with("motion.speed_m_per_s: is needed for [[dipole]]"));
    assert!(error("[bottom]\ndepth_m = 7.0", "").starts_with("bottom.depth_m: is needed"));
    assert!(error("inclination_deg = 20.0\n", "").starts_with("dipole: give moment_Am2 as three"));
    assert!(error("at_s = 90.0\n", "").starts_with("dipole: give at_s, offset_m and below_m, or latitude"));
    assert!(error("08:30:00", "25:30:00").starts_with("field.time: \"25:30:00\" is no time"));
    assert!(error("offset_m = 1.5\nbelow_m = 3.2", "offset_m = 0.0\nbelow_m = 0.0").contains("outside 0.3"));
}
