//! The fluxgate is calibrated by turning the emulated body.

use super::{Run, emulate, has_text, image, logged_epochs, plain};
use host_sim::emulator::{Emulated, in_instructions};
use std::fmt::Write as _;
use towmag::estimate::Prior;
use towmag::fluxgate_calibration::FluxgateCalibration;
use towmag::log::EventKind;
use towmag::model::Coefficients;
use towmag::sensors::fluxgate::FluxgateSettings;
use towmag_virtual_body::turned_sensor::{Draw, TurnedSensor, Turning};

/// As the emulated body's settings have it, and as many digits as a recording.
const NT_PER_COUNT: f64 = 0.01;

fn recording(sensor: &TurnedSensor, settings: &FluxgateSettings) -> String {
    let draw = &mut Draw::new(31);
    let mut csv = String::from("time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT\n");
    for epoch in sensor.epochs(&Turning::tumbled(draw, 200), settings, true, draw) {
        let ([x, y, z], scalar_pt) = (epoch.flux_nt.unwrap(), epoch.scalar_pt.unwrap());
        let (time_s, scalar_nt) = (f64::from(epoch.tick) / 10.0, f64::from(scalar_pt) / 1e3);
        writeln!(csv, "{time_s:.1},{scalar_nt:.3},{x:.2},{y:.2},{z:.2}").unwrap();
    }
    csv
}

/// The emulated body's settings, a sensor that is off, and what is typed while it is turned.
fn turned(typed: &'static [&'static str]) -> Option<(FluxgateSettings, TurnedSensor, Emulated)> {
    let image = image()?;
    let settings = FluxgateSettings { nt_per_count: [NT_PER_COUNT; 3], ..FluxgateSettings::default() };
    let sensor = TurnedSensor::drawn(&mut Draw::new(30), 0);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("turned.csv");
    std::fs::write(&path, recording(&sensor, &settings)).unwrap();
    Some((settings, sensor, emulate(image, &Run { recording: path, typed, ..plain() })))
}

#[test]
fn an_epoch_of_it_costs_little() {
    let Some((.., emulated)) = turned(&["5:calibrate fluxgate"]) else { return };
    let calibrating = in_instructions(&emulated.figures)["instructions_per_epoch_mean"];
    println!("instructions of an epoch, `saddle-point`, while the fluxgate is calibrated: {calibrating}");
    assert!(calibrating < 100_000, "{calibrating}");
}

#[test]
fn the_body_finds_its_axes_as_the_core_does_and_starts_anew_with_them() {
    let typed = &["20:calibrate fluxgate", "1700:calibrate stop", "1740:calibrate accept yes"];
    let Some((settings, sensor, emulated)) = turned(typed) else { return };
    assert!(has_text(&emulated, "fluxgate less scalar: ") && has_text(&emulated, "coefficients zero"));
    let found = emulated.events.iter().find_map(|event| match &event.kind {
        EventKind::FluxgateCalibrated { axes, .. } => Some((event.tick, *axes)),
        _ => None,
    });
    let (tick, axes) = found.expect("the log holds the calibration");
    for (found_nt, true_nt) in axes.bias_nt.into_iter().zip(sensor.bias_nt) {
        assert!((found_nt - true_nt).abs() < 2.0, "{found_nt} {true_nt}");
    }
    let epochs = logged_epochs(&emulated);
    let same = (0..60).any(|first| {
        let mut calibration = FluxgateCalibration::new(&settings).unwrap();
        for epoch in epochs.iter().filter(|epoch| (first..=tick).contains(&epoch.tick)) {
            calibration.step(epoch);
        }
        // To the bit: the core in f64 too is the same on both.
        calibration.solve().is_ok_and(|result| result.settings.bias_nt == axes.bias_nt)
    });
    assert!(same, "no start gives the body's axes");
    assert_eq!(emulated.starts, 2);
    let stored = emulated.stored;
    let fluxgate = stored.settings.fluxgate;
    assert_eq!((fluxgate.bias_nt, fluxgate.nt_per_count), (axes.bias_nt, axes.nt_per_count));
    assert_eq!(fluxgate.body_from_sensor, axes.body_from_sensor);
    assert_eq!(stored.prior(), Prior { coefficients: Coefficients::ZERO, information: None, level: None });
}
