//! The whole way from bytes and frames to epochs, as the firmware goes it.

use towmag::sensors::fluxgate::FluxgateSettings;
use towmag::sensors::grid::{GridSettings, GridState, ScalarMark};
use towmag::sensors::scalar::ScalarSettings;

#[test]
fn bytes_and_conversions_become_epochs() {
    let mut parser = ScalarSettings::G882.build().unwrap();
    let fluxgate = FluxgateSettings { nt_per_count: [0.01; 3], ..FluxgateSettings::default() };
    let grid = GridSettings::default().build(fluxgate.build().unwrap()).unwrap();
    let mut state = GridState::new();
    let mut epochs = vec![];
    // Ten seconds across the wrap of the timer in steps of one byte at 9600 baud; every 25th line is cut.
    let start_us = u32::MAX - 5_000_000;
    let mut ready_us = 1_700;
    for step in 0..9_600_u32 {
        let after_us = (u64::from(step) * 10_000_000 / 9_600) as u32;
        let now_us = start_us.wrapping_add(after_us);
        while ready_us <= after_us {
            grid.push_flux(&mut state, [2_000_000, 0, 4_000_000, 1_000_000], start_us.wrapping_add(ready_us));
            ready_us += 4_000;
        }
        let (line, at) = (step / 96, (step % 96) as usize);
        let signal = if line == 50 { 10 } else { 1249 };
        let text = format!("$ 498{:02}.131,{signal:04}\r\n", line);
        let text = if line % 25 == 10 { &text[..9] } else { &text[..] };
        if let Some(byte) = text.as_bytes().get(at)
            && let Some(reading) = parser.push(*byte, now_us)
        {
            grid.push_scalar(&mut state, &reading);
        }
        while let Some(epoch) = grid.poll(&mut state, now_us) {
            epochs.push(epoch);
        }
    }
    let first = epochs.iter().position(|epoch| epoch.marks.relocked).unwrap();
    let epochs = &epochs[first..first + 95];
    for (line, marked) in (0..).zip(epochs) {
        let expected = (line % 25 != 10 && line != 50).then_some(49_800_131 + line * 1_000);
        assert_eq!(marked.epoch.scalar_pt, expected, "{line} {marked:?}");
        assert_eq!(marked.marks.scalar == ScalarMark::Invalid, line == 50);
    }
    let vectors = epochs.iter().filter_map(|epoch| epoch.epoch.flux_nt);
    // The first window began before the first conversion.
    assert_eq!(vectors.clone().count(), 94);
    assert!(vectors.into_iter().all(|vector| vector == [20_000.0, 0.0, 40_000.0]));
    assert!(epochs.iter().filter_map(|epoch| epoch.marks.current_a).all(|current_a| (current_a - 1.0).abs() < 1e-6));
    assert_eq!((parser.faults().cut_lines, parser.faults().signal_out_of_limits), (4, 1));
}
