//! How a scalar sensor is added, walked once with one that the firmware does not have: its file, and nothing else. It
//! sends `%`, the field in units of a setting, `/`, a signal: `%5000012/77`.

use host_sim::wire::{Wires, through_sensors};
use towmag::sensors::scalar::{
    CHANNELS, Decoded, Defect, Fields, Format, FormatParameter, Framing, Marker, ScalarSettings, Scale, Sensor, Value,
};

/// All that the file of a sensor exports.
static FORMAT: Format = Format {
    name: "percent",
    title: "A sensor of this test",
    tag: 200,
    baud: 19_200,
    weakest_signal: 10,
    strongest_signal: 100,
    parameters: &[FormatParameter { name: "percent_counts_per_nt", default: Value::Number(100.0) }],
    framing: Framing { start: b'%', other_lines: b"~" },
    check: |values| Scale::counts(values.number(0)),
    decode: |sensor: &Sensor, text: &[u8]| -> Result<Decoded, Defect> {
        let mut fields = Fields::new(text);
        let scalar_pt = sensor.scale.read(&mut fields)?;
        fields.expect(b'/')?;
        let signal = Some(fields.number()?);
        fields.end()?;
        Ok(Decoded { scalar_pt, signal, counter: None, channels: [None; CHANNELS], marker: Marker::Valid })
    },
    encode: |sensor, scalar_pt, out| {
        out.write_str("%")?;
        sensor.scale.write(scalar_pt, out)?;
        out.write_str("/77\r\n")
    },
};

#[test]
fn its_bytes_become_readings() {
    let mut parser = ScalarSettings::of(&FORMAT).build().unwrap();
    let bytes = b"~started\r\n%5000012/77\r\n%5000012/7\r\n%5000012\r\n";
    let readings: Vec<_> = bytes.iter().filter_map(|&byte| parser.push(byte, 0)).collect();
    let seen: Vec<_> = readings.iter().map(|reading| (reading.scalar_pt, reading.signal, reading.valid)).collect();
    assert_eq!(seen, [(50_000_120, Some(77), true), (50_000_120, Some(7), false)]);
    let faults = parser.faults();
    assert_eq!((faults.signal_out_of_limits, faults.cut_lines, faults.rubbish_bytes), (1, 1, 0));
}

#[test]
fn its_setting_is_checked_and_used() {
    let mut settings = ScalarSettings::of(&FORMAT);
    *settings.format.value_mut("percent_counts_per_nt").unwrap() = Value::Number(1_000.0);
    assert_eq!(settings.format.build().unwrap().encode(50_000_120).unwrap(), "%50000120/77\r\n");
    *settings.format.value_mut("percent_counts_per_nt").unwrap() = Value::Number(0.5);
    assert!(settings.build().is_err());
    assert_eq!(settings.format.value("counts_per_nt"), None);
}

/// Over the wires, at its own baud rate, into the body's drivers and its grid.
#[test]
fn its_sentences_become_epochs() {
    let mut csv = String::from("time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT\n");
    for row in 0..50 {
        csv += &format!("{}.{},{}.12,20000,0,40000\n", row / 10, row % 10, 50_000 + row);
    }
    let wires = Wires { scalar: ScalarSettings::of(&FORMAT), faults: Vec::new() };
    let sensed = through_sensors(csv.as_bytes(), &wires).unwrap();
    let scalars: Vec<_> = sensed.epochs.iter().map(|epoch| epoch.and_then(|epoch| epoch.scalar_pt)).collect();
    let expected: Vec<_> = (0..50).map(|row| Some(50_000_120 + row * 1_000)).collect();
    assert_eq!(scalars[5..], expected[5..]);
    assert!(sensed.faults.is_empty(), "{:?}", sensed.faults);
}
