//! Epoch assembly: clocks that drift for hours, and readings that are missing, doubled, early, late or in bursts.

use proptest::prelude::*;
use towmag::sensors::fluxgate::FluxgateSettings;
use towmag::sensors::grid::{FluxMark, Grid, GridSettings, GridState, MarkedEpoch, RELOCK_READINGS, ScalarMark};
use towmag::sensors::scalar::{CHANNELS, Reading};

/// What happens at a time of the microcontroller's timer, in exact microseconds since the start.
#[derive(Clone, Copy, Debug)]
enum Event {
    /// First byte of a sentence, and the number that it reads.
    Scalar(i32),
    Flux([i32; 4]),
}

const SETTINGS: GridSettings = GridSettings {
    scalar_delay_us: 50_000,
    flux_delay_us: 6_000,
    latency_us: 40_000,
    tolerance_us: 20_000,
    conversions_per_epoch: 25,
};

/// A line of 18 bytes at 9600 baud.
const SENTENCE_US: u64 = 18_750;

fn grid() -> Grid {
    // One nanotesla per count, so that the field is the mean count.
    let fluxgate = FluxgateSettings { nt_per_count: [1.0; 3], ..FluxgateSettings::default() };
    SETTINGS.build(fluxgate.build().unwrap()).unwrap()
}

fn reading(scalar_pt: i32, first_byte_us: u64) -> Reading {
    Reading {
        scalar_pt,
        signal: Some(1200),
        counter: None,
        channels: [None; CHANNELS],
        valid: true,
        first_byte_us: first_byte_us as u32,
        last_byte_us: (first_byte_us + SENTENCE_US) as u32,
    }
}

struct Bench {
    grid: Grid,
    state: GridState,
    start_us: u64,
    epochs: Vec<MarkedEpoch>,
}

impl Bench {
    fn new(start_us: u32) -> Self {
        Self { grid: grid(), state: GridState::new(), start_us: start_us.into(), epochs: vec![] }
    }

    fn poll(&mut self, at_us: u64) {
        while let Some(epoch) = self.grid.poll(&mut self.state, (self.start_us + at_us) as u32) {
            self.epochs.push(epoch);
        }
    }

    fn scalar(&mut self, scalar_pt: i32, first_byte_us: u64) {
        self.poll(first_byte_us + SENTENCE_US);
        self.grid.push_scalar(&mut self.state, &reading(scalar_pt, self.start_us + first_byte_us));
    }

    fn flux(&mut self, counts: [i32; 4], ready_us: u64) {
        self.grid.push_flux(&mut self.state, counts, (self.start_us + ready_us) as u32);
        self.poll(ready_us);
    }

    fn run(&mut self, mut events: Vec<(u64, Event)>) {
        // A sentence is read when its last byte is in.
        events.sort_by_key(|(at_us, event)| at_us + if matches!(event, Event::Scalar(_)) { SENTENCE_US } else { 0 });
        for (at_us, event) in events {
            match event {
                Event::Scalar(scalar_pt) => self.scalar(scalar_pt, at_us),
                Event::Flux(counts) => self.flux(counts, at_us),
            }
        }
    }

    /// Epochs from the second lock on: those before the first reading are not of interest here.
    fn present(&self) -> impl Iterator<Item = &MarkedEpoch> {
        self.epochs.iter().skip_while(|epoch| epoch.marks.scalar != ScalarMark::Present)
    }
}

/// A small generator of jitter, uniform in +-1.
fn jitter(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
}

/// Both sensors, the scalar one reading `50,000,000 + n`, the vector the true time in units of 100 us.
fn both(seconds: u32, scalar_ppm: f64, flux_ppm: f64, jitter_us: f64) -> Vec<(u64, Event)> {
    let mut seed = 1;
    let mut events = Vec::new();
    for n in 0..seconds * 10 {
        let instant_us = 200_000.0 + f64::from(n) * 100_000.0 * (1.0 + scalar_ppm * 1e-6);
        let first_byte_us = instant_us + f64::from(SETTINGS.scalar_delay_us) + jitter_us * jitter(&mut seed);
        events.push((first_byte_us as u64, Event::Scalar(50_000_000 + n as i32)));
    }
    for n in 0..seconds * 250 + 200 {
        let instant_us = 1_300.0 + f64::from(n) * 4_000.0 * (1.0 + flux_ppm * 1e-6);
        let ready_us = instant_us + f64::from(SETTINGS.flux_delay_us);
        events.push((ready_us as u64, Event::Flux([(instant_us / 100.0) as i32 % 8_000_000; 4])));
    }
    events
}

/// Without the events of the scalar sensor from `from_s` to `to_s`.
fn without_scalar(events: &mut Vec<(u64, Event)>, from_s: f64, to_s: f64) {
    let lost = |at_us: u64| (from_s..to_s).contains(&(at_us as f64 / 1e6));
    events.retain(|(at_us, event)| matches!(event, Event::Flux(_)) || !lost(*at_us));
}

#[test]
fn drift_for_hours_loses_doubles_and_moves_nothing() {
    for (scalar_ppm, flux_ppm) in [(100.0, 0.0), (-100.0, 0.0), (100.0, -100.0), (0.0, 0.0)] {
        // Three hours, so that the timer wraps twice; 1 ms of jitter.
        let mut bench = Bench::new(u32::MAX - 5_000_000);
        bench.run(both(3 * 3_600, scalar_ppm, flux_ppm, 1_000.0));
        let counters = *bench.state.counters();
        let dropped = counters.scalar_off_time + counters.scalar_late + counters.scalar_duplicates;
        assert_eq!((dropped, counters.relocks, counters.skipped), (0, 1, 1), "{scalar_ppm} {counters:?}");
        let mut expected = 50_000_000;
        let mut tick = bench.present().next().unwrap().epoch.tick;
        for MarkedEpoch { epoch, marks } in bench.present().take(3 * 36_000 - 40) {
            assert_eq!((epoch.scalar_pt, epoch.tick), (Some(expected), tick), "{marks:?}");
            assert_eq!(marks.flux, FluxMark::Present);
            // The grid lies where the reading was made, and the vector's mean belongs to there.
            let true_us = 200_000.0 + f64::from(expected - 50_000_000) * 100_000.0 * (1.0 + scalar_ppm * 1e-6);
            let settled = expected > 50_000_300;
            let off_us = marks.instant_us.wrapping_sub((bench.start_us + true_us as u64) as u32) as i32;
            assert!(!settled || off_us.abs() < 700, "{off_us} us at {expected}");
            let vector_us = f64::from(epoch.flux_nt.unwrap()[0]) * 100.0;
            let vector_off_us = vector_us - (true_us + f64::from(off_us)) % 800_000_000.0;
            // The ramp starts anew every 800 s: not there.
            let at_fold = true_us % 800_000_000.0 < 100_000.0 || true_us % 800_000_000.0 > 799_900_000.0;
            assert!(at_fold || vector_off_us.abs() < 150.0, "{vector_off_us} us at {expected}");
            (expected, tick) = (expected + 1, tick + 1);
        }
        assert!((f64::from(bench.state.scalar_clock_ppm()) - scalar_ppm).abs() < 10.0);
    }
}

#[test]
fn missing_sentences_are_missing_epochs() {
    let mut bench = Bench::new(0);
    let mut events = both(120, 50.0, 0.0, 500.0);
    without_scalar(&mut events, 60.0, 60.1);
    without_scalar(&mut events, 80.0, 90.0);
    bench.run(events);
    let mut numbered = bench.present().map(|MarkedEpoch { epoch, marks }| (epoch.tick, epoch.scalar_pt, marks));
    let (first, ..) = numbered.next().unwrap();
    let mut missing = 0;
    for (tick, scalar_pt, marks) in numbered.by_ref().take(1_150) {
        match scalar_pt {
            Some(scalar_pt) => assert_eq!(scalar_pt - 50_000_000, (tick - first) as i32),
            None => {
                assert_eq!((marks.scalar, marks.raw_scalar_pt), (ScalarMark::Missing, None));
                missing += 1;
            }
        }
        assert_eq!(marks.flux, FluxMark::Present);
    }
    assert_eq!((missing, bench.state.counters().relocks), (101, 1));
}

#[test]
fn missing_conversions_are_missing_vectors() {
    let mut bench = Bench::new(0);
    let mut events = both(60, 0.0, 0.0, 0.0);
    let lost = |at_us: u64| (30_000_000..30_001_000).contains(&(at_us / 4_000 * 4_000));
    events.retain(|(at_us, event)| matches!(event, Event::Scalar(_)) || !lost(*at_us));
    bench.run(events);
    let missing: Vec<_> = bench.present().take(550).filter(|epoch| epoch.marks.flux != FluxMark::Present).collect();
    assert!((1..=2).contains(&missing.len()), "{missing:?}");
    for MarkedEpoch { epoch, marks } in missing {
        assert_eq!((epoch.flux_nt, marks.current_a, marks.flux), (None, None, FluxMark::Missing));
        assert!(epoch.scalar_pt.is_some());
    }
}

#[test]
fn doubled_sentences_are_dropped() {
    let mut bench = Bench::new(0);
    let mut events = both(60, 0.0, 0.0, 0.0);
    // 12 ms after the 300th a second one, and before the 400th one that is further from the epoch than the true one.
    events.push((30_250_000 + 12_000, Event::Scalar(1_111_111)));
    events.push((40_250_000 - 19_000, Event::Scalar(2_222_222)));
    bench.run(events);
    assert_eq!(bench.state.counters().scalar_duplicates, 2);
    let mut doubled = 0;
    for (n, MarkedEpoch { epoch, marks }) in (0..).zip(bench.present().take(550)) {
        assert_eq!(epoch.scalar_pt, Some(50_000_000 + n));
        doubled += i32::from(marks.duplicates);
    }
    assert_eq!(doubled, 2);
}

#[test]
fn faster_sensors_stay_locked() {
    for readings_per_epoch in [2, 3, 4] {
        let mut bench = Bench::new(0);
        let mut events = both(300, 50.0, 0.0, 300.0);
        let firsts: Vec<_> = events.iter().filter(|(_, event)| matches!(event, Event::Scalar(_))).copied().collect();
        for (at_us, _) in firsts {
            let between = (1..readings_per_epoch).map(|n| (at_us + n * 100_000 / readings_per_epoch, Event::Scalar(1)));
            events.extend(between);
        }
        bench.run(events);
        assert_eq!(bench.state.counters().relocks, 1);
        for (n, MarkedEpoch { epoch, .. }) in (0..).zip(bench.present().take(2_990)) {
            assert_eq!(epoch.scalar_pt, Some(50_000_000 + n), "{readings_per_epoch}");
        }
        let ppm = bench.state.scalar_clock_ppm();
        assert!((ppm - 50.0).abs() < 10.0, "{readings_per_epoch}: {ppm}");
    }
}

#[test]
fn a_burst_after_a_stall_is_not_believed() {
    // The line stalls for 2 s, then all its sentences come at once; from there on all is well again.
    let mut bench = Bench::new(0);
    let mut events = both(60, 20.0, 0.0, 200.0);
    for (at_us, event) in &mut events {
        if matches!(event, Event::Scalar(_)) && (30_000_000..32_030_000).contains(at_us) {
            *at_us = 32_030_000 + (*at_us - 30_000_000) / 1_000;
        }
    }
    bench.run(events);
    let mut wrong = 0;
    let first = bench.present().next().unwrap().epoch.tick;
    for MarkedEpoch { epoch, .. } in bench.present().take(550) {
        if let Some(scalar_pt) = epoch.scalar_pt {
            // The one of the burst that falls onto an epoch is as old as the stall.
            wrong += i32::from(scalar_pt - 50_000_000 != (epoch.tick - first) as i32);
        }
    }
    let counters = bench.state.counters();
    assert!(wrong <= 1, "{wrong}");
    assert_eq!(counters.relocks, 1, "{counters:?}");
    assert_eq!(counters.scalar_off_time + counters.scalar_duplicates + counters.scalar_late, 20, "{counters:?}");
}

#[test]
fn another_phase_is_followed_after_a_gap() {
    let mut bench = Bench::new(0);
    let mut events = both(60, 0.0, 0.0, 0.0);
    for (at_us, event) in &mut events {
        if matches!(event, Event::Scalar(_)) && *at_us > 30_000_000 {
            *at_us += 43_000;
        }
    }
    bench.run(events);
    let epochs: Vec<_> = bench.present().take(550).collect();
    let off_time = epochs.iter().filter(|epoch| epoch.marks.scalar == ScalarMark::OffTime).count();
    assert!((usize::from(RELOCK_READINGS) - 2..=usize::from(RELOCK_READINGS)).contains(&off_time), "{off_time}");
    let at = epochs.iter().rposition(|epoch| epoch.marks.relocked).unwrap();
    assert!(at > 250);
    assert_eq!(epochs[at].epoch.tick - epochs[at - 1].epoch.tick, 2, "the core must see a gap");
    assert!(epochs[at..].iter().all(|epoch| epoch.epoch.scalar_pt.is_some()));
    assert_eq!(bench.state.counters().relocks, 2);
}

#[test]
fn invalid_readings_are_kept_from_the_core() {
    let mut bench = Bench::new(0);
    bench.scalar(50_000_000, 250_000);
    bench.poll(300_000);
    let invalid = Reading { valid: false, ..reading(50_000_001, 350_000) };
    bench.grid.push_scalar(&mut bench.state, &invalid);
    bench.poll(1_000_000);
    let MarkedEpoch { epoch, marks } = bench.epochs.iter().find(|e| e.marks.scalar == ScalarMark::Invalid).unwrap();
    assert_eq!((epoch.scalar_pt, marks.raw_scalar_pt, marks.signal), (None, Some(50_000_001), Some(1200)));
    assert_eq!(bench.state.counters().scalar_invalid, 1);
}

#[test]
fn late_readings_are_counted() {
    let mut bench = Bench::new(0);
    bench.run(both(5, 0.0, 0.0, 0.0));
    bench.poll(5_400_000);
    bench.grid.push_scalar(&mut bench.state, &reading(1, 4_950_000));
    assert_eq!(bench.state.counters().scalar_late, 1);
}

#[test]
fn epochs_run_without_the_scalar_sensor() {
    let mut bench = Bench::new(77);
    let mut events = both(30, 0.0, 0.0, 0.0);
    without_scalar(&mut events, 0.0, 1e9);
    bench.run(events);
    assert!(bench.epochs.len() > 290);
    assert!(bench.epochs.windows(2).all(|two| two[1].epoch.tick == two[0].epoch.tick + 1));
    let vectors = bench.epochs.iter().filter(|epoch| epoch.epoch.flux_nt.is_some()).count();
    assert!(bench.epochs.len() - vectors <= 2); // the first windows are not full
    assert_eq!(bench.state.counters().scalar_missing as usize, bench.epochs.len());
}

#[test]
fn a_long_silence_leaves_ticks_out() {
    let mut bench = Bench::new(0);
    bench.run(both(5, 0.0, 0.0, 0.0));
    bench.poll(600_000_000);
    assert!(bench.epochs.len() < 100, "{}", bench.epochs.len());
    let last = bench.epochs.last().unwrap();
    assert!((5_990..=6_000).contains(&last.epoch.tick), "{last:?}");
    assert!(bench.state.counters().skipped > 5_900);
}

#[test]
fn timing_settings_are_checked() {
    let fluxgate = FluxgateSettings::default().build().unwrap();
    for wrong in [
        GridSettings { scalar_delay_us: 400_001, ..SETTINGS },
        GridSettings { flux_delay_us: 100_001, ..SETTINGS },
        GridSettings { latency_us: 0, ..SETTINGS },
        GridSettings { tolerance_us: 50_000, ..SETTINGS },
        GridSettings { conversions_per_epoch: 24, ..SETTINGS },
    ] {
        assert!(wrong.build(fluxgate).is_err(), "{wrong:?}");
    }
    assert!(GridSettings::default().build(fluxgate).is_ok());
}

#[test]
fn longest_delays_still_find_their_vectors() {
    let settings = GridSettings {
        scalar_delay_us: 400_000,
        latency_us: 200_000,
        tolerance_us: 45_000,
        flux_delay_us: 0,
        conversions_per_epoch: 25,
    };
    let fluxgate = FluxgateSettings::default().build().unwrap();
    let (grid, mut state) = (settings.build(fluxgate).unwrap(), GridState::new());
    let mut present = 0;
    for n in 0..2_500_u32 {
        grid.push_flux(&mut state, [n as i32; 4], n * 4_000);
        if n % 25 == 0 && n > 100 {
            grid.push_scalar(&mut state, &reading(50_000_000, u64::from(n) * 4_000));
        }
        if n % 12 == 0 {
            while let Some(marked) = grid.poll(&mut state, n * 4_000) {
                present += i32::from(marked.epoch.scalar_pt.is_some() && marked.epoch.flux_nt.is_some());
            }
        }
    }
    assert!(present > 85, "{present}");
}

proptest! {
    /// Any calls in any order: no panic, ticks only forward, no more readings out than in.
    #[test]
    fn any_calls_do_no_harm(calls in proptest::collection::vec((0..4_u8, any::<u32>(), any::<bool>()), 0..400)) {
        let (grid, mut state) = (grid(), GridState::new());
        let (mut now_us, mut given, mut taken) = (0_u32, 0, 0);
        let mut last_tick: Option<u32> = None;
        for (call, step, near) in calls {
            now_us = now_us.wrapping_add(if near { step % 150_000 } else { step });
            match call {
                0 => grid.push_flux(&mut state, [step as i32 >> 8; 4], now_us),
                1 => {
                    grid.push_scalar(&mut state, &reading(50_000_000, now_us.into()));
                    given += 1;
                }
                _ => {
                    while let Some(MarkedEpoch { epoch, .. }) = grid.poll(&mut state, now_us) {
                        taken += i32::from(epoch.scalar_pt.is_some());
                        prop_assert!(last_tick.is_none_or(|last| epoch.tick.wrapping_sub(last) as i32 > 0));
                        last_tick = Some(epoch.tick);
                    }
                }
            }
        }
        prop_assert!(taken <= given);
    }
}
