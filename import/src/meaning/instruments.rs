//! What the columns of real instruments become: their titles, with made-up values below them.

use std::collections::BTreeMap;

use super::{assign, times};
use crate::open::{File, Input, open, table};
use crate::options::Options;
use crate::profile::{Profile, TimeProfile};

/// Rows below these titles. `{t}` stands for 0.0, 0.1, ... s, `{ms}` for the same in milliseconds, `{c}` for a time of day, `{b}`
/// for a field that changes a little, `{x}` and `{z}` for its parts.
fn text(titles: &str, row: &str) -> String {
    let rows = (0..60).map(|at| {
        let time_s = f64::from(at) * 0.1;
        let field = 50_000.0 + (time_s * 0.7).sin() * 30.0;
        row.replace("{t}", &format!("{time_s:.1}"))
            .replace("{ms}", &format!("{:.0}", time_s * 1e3))
            .replace("{c}", &format!("13:37:{:06.3}", time_s + 20.0))
            .replace("{b}", &format!("{field:.3}"))
            .replace("{x}", &format!("{:.3}", field * 0.6))
            .replace("{z}", &format!("{:.3}", field * 0.8))
    });
    let head = if titles.is_empty() { Vec::new() } else { vec![titles.to_string()] };
    head.into_iter().chain(rows).map(|line| line + "\n").collect()
}

/// The columns of the recording, with the names of those that they come from.
fn meant(text: &str, options: &Options) -> BTreeMap<String, String> {
    let input = Input::File(File { name: "a.csv".into(), bytes: text.into() });
    let opened = open(vec![input], options).unwrap();
    let (table, _) = table(&opened[0].source, None).unwrap();
    let times = times("a.csv", table, &options.profile.time).unwrap();
    let meaning = assign("a.csv", table, &times.used, options).unwrap();
    let named = meaning.columns.iter().map(|(target, from)| (target.clone(), table.columns[from.at].name.clone()));
    named.chain([("time_s".to_string(), times.profile.columns.join(" + "))]).collect()
}

/// That these and no other columns come out.
fn assert_meant(titles: &str, row: &str, wanted: &[(&str, &str)]) {
    let found = meant(&text(titles, row), &Options::default());
    let wanted: BTreeMap<String, String> =
        wanted.iter().map(|(target, from)| (target.to_string(), from.to_string())).collect();
    assert_eq!(found, wanted, "{titles}");
}

#[test]
fn mag_arrow() {
    let titles = "Counter,Date,Time,Latitude,Longitude,Mag, MagValid,CompassX, CompassY, CompassZ, GyroscopeX, GyroscopeY, \
                  GyroscopeZ, AccelerometerX, AccelerometerY, AccelerometerZ,ImuTemperature,Track,Hdop,Altitude,SpeedOverGround";
    let row = "7,2020/09/28,{c},56.862286,24.113613,{b},1,,,,,,,,,,,252.3,0.79,8.37,0.29";
    let wanted = [
        ("time_s", "Date + Time"),
        ("latitude_deg", "Latitude"),
        ("longitude_deg", "Longitude"),
        ("scalar_nT", "Mag"),
        ("scalar_valid", "MagValid"),
    ];
    assert_meant(titles, row, &wanted);
}

#[test]
fn mag_drone() {
    let titles =
        "Timestamp [ms];B1x [nT];B1y [nT];B1z [nT];B2x [nT];B2y [nT];B2z [nT];AccX [g];AccY [g];AccZ [g];Temp [Deg]";
    let row = "{ms};{x};0.5;{z};{x};0.5;{z};0.01;0.02;0.98;20.5";
    let found = meant(&text(titles, row), &Options::default());
    let of = |target: &str| found.get(target).map(String::as_str);
    assert_eq!(["flux_x_nT", "flux_y_nT", "flux_z_nT"].map(of), ["B1x", "B1y", "B1z"].map(Some));
    assert_eq!((of("time_s"), of("scalar_nT")), (Some("Timestamp"), None));
}

#[test]
fn mag_nav() {
    let titles = "line,year,doy,tt,lat,lon,baro,mag_1_c,mag_1_lag,mag_1_uc,mag_2_uc,flux_a_x,flux_a_y,flux_a_z,flux_b_x,\
                  flux_b_y,flux_b_z,ins_pitch,ins_roll,ins_yaw,diurnal,igrf,cur_strb";
    let row = "1002.20,2020,172,{t},45.1,-76.2,400,{b},{b},{b},{b},{x},0.5,{z},{x},0.5,{z},1.5,2.5,90,-3,50000,1.5";
    let found = meant(&text(titles, row), &Options::default());
    for (target, from) in [
        ("time_s", "doy + tt"),
        ("scalar_nT", "mag_1_uc"),
        ("scalar2_nT", "mag_2_uc"),
        ("flux_x_nT", "flux_a_x"),
        ("flux_z_nT", "flux_a_z"),
        ("pitch_deg", "ins_pitch"),
        ("roll_deg", "ins_roll"),
        ("heading_deg", "ins_yaw"),
        ("latitude_deg", "lat"),
        ("longitude_deg", "lon"),
        ("line", "line"),
        ("current_strb_A", "cur_strb"),
    ] {
        assert_eq!(found.get(target).map(String::as_str), Some(from), "{target}");
    }
}

#[test]
fn sea_spy() {
    let titles = "Reading_Date,Reading_Time,Magnetic_Field,Signal_Strength,Depth,Altitude,Leak";
    let wanted = [
        ("time_s", "Reading_Date + Reading_Time"),
        ("scalar_nT", "Magnetic_Field"),
        ("scalar_signal", "Signal_Strength"),
        ("depth_m", "Depth"),
        ("altitude_m", "Altitude"),
        ("leak", "Leak"),
    ];
    assert_meant(titles, "2020-09-28,{c},{b},180,12.5,6.5,0", &wanted);
}

#[test]
fn mag_nimbus() {
    let wanted = [
        ("time_s", "Date + Time"),
        ("scalar_nT", "TMI"),
        ("flux_x_nT", "Bx"),
        ("flux_y_nT", "By"),
        ("flux_z_nT", "Bz"),
        ("latitude_deg", "Latitude"),
        ("longitude_deg", "Longitude"),
    ];
    let row = "2024-05-17,{c},56.86,24.11,{b},{x},0.5,{z}";
    assert_meant("Date,Time,Latitude,Longitude,TMI,Bx,By,Bz", row, &wanted);
}

#[test]
fn gsmp() {
    let wanted = [("time_s", "mm/dd/yyyy + hh:mm:ss"), ("scalar_nT", "nT")];
    assert_meant("mm/dd/yyyy hh:mm:ss nT sq", "09/28/2020 {c} {b} 99", &wanted);
}

#[test]
fn mag_map_2000() {
    let wanted = [("time_s", "DATE + TIME"), ("scalar_nT", "READING_1"), ("line", "LINE")];
    assert_meant("X Y READING_1 TIME DATE LINE MARK", "1.5 2.5 {b} {c} 09/28/20 1 0", &wanted);
    let wanted = [("time_s", "DATE + TIME"), ("scalar_nT", "READING_1"), ("scalar2_nT", "READING_2"), ("line", "LINE")];
    assert_meant("X Y READING_1 READING_2 VRT_GRAD TIME DATE LINE", "1.5 2.5 {b} {b} 0.5 {c} 09/28/20 1", &wanted);
}

#[test]
fn a_counter_by_itself_needs_the_rate() {
    let lines = text("", "$ {b},1249");
    let time = TimeProfile { rate_hz: Some(10.0), ..TimeProfile::default() };
    let found = meant(&lines, &Options { profile: Profile { time, ..Profile::default() }, ..Options::default() });
    let of = |target: &str| found.get(target).map(String::as_str);
    assert_eq!((of("scalar_nT"), of("scalar_signal")), (Some("scalar"), Some("signal")));
}

#[test]
fn values_that_are_none_of_the_earths_are_no_sensor() {
    assert_meant("time,field,X,Y,Z,accX,accY,accZ", "{t},3.5,1.5,2.5,3.5,0.1,0.2,0.98", &[("time_s", "time")]);
}
