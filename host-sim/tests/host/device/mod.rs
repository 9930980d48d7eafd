//! A log as the body writes it, on a card in memory.

pub(crate) mod memory_card;

use host_sim::simulator::sample_survey;
use towmag::estimate::Prior;
use towmag::housekeeping::Housekeeping;
use towmag::log::{EpochRecord, Event, EventKind, Header, InformationPart, Loss, Record, ResetCause, SectorWriter};
use towmag::model::Coefficients;
use towmag::navigation::Navigation;
use towmag::{Epoch, Method, Output, Pipeline, Settings};

pub(crate) use memory_card::Card;

/// What the clock shows at a tick.
pub(crate) fn unix_ms(tick: u32) -> u64 {
    1_700_000_000_000 + u64::from(tick) * 100
}

/// What a depth sensor tells once a second from tick 1000 to 1100.
pub(crate) fn depth_m(tick: u32) -> f32 {
    (tick / 10) as f32 * 0.1
}

/// What is told of leak and battery once a second from tick 2000 to 2100: a leak in the middle.
pub(crate) fn housekeeping(tick: u32) -> Option<Housekeeping> {
    let is_told = (2000..=2100).contains(&tick) && tick.is_multiple_of(10);
    let has_leak = Some((2050..2080).contains(&tick));
    is_told.then_some(Housekeeping { battery_v: Some(tick as f32 * 0.005), has_leak })
}

/// Two sessions of a survey, the second after a reset with a loss in it and with a clock that is set late.
pub(crate) fn card() -> Card {
    card_of(Method::SaddlePoint, &Coefficients::ZERO.into(), |output| output)
}

/// The same with a method, with what the body started from, and with something done to its outputs.
pub(crate) fn card_of(method: Method, prior: &Prior, done: impl Fn(Output) -> Output) -> Card {
    card_that(true, method, prior, done)
}

/// The same by a body that tells the information that it starts from, or by an older one that does not.
pub(crate) fn card_that(tells: bool, method: Method, prior: &Prior, done: impl Fn(Output) -> Output) -> Card {
    let settings = Settings { method, ..Settings::default() };
    let mut card = Card::new(1, 800);
    for (session, ticks) in [(7_u32, 0..3000_u32), (8, 3100..6000)] {
        let mut log = SectorWriter::resume(card, session);
        let header = Header {
            firmware_version: "test".try_into().unwrap(),
            build_hash: [0xAB; 32],
            settings,
            coefficients: prior.coefficients,
            start_tick: ticks.start,
            start_unix_ms: (session == 7).then(|| unix_ms(ticks.start)),
        };
        log.append(&Record::Header(header)).unwrap();
        let [information, level] = [&prior.information, &prior.level]
            .map(|known| known.iter().filter(|_| tells).flat_map(InformationPart::all));
        let known = information.map(EventKind::Information).chain(level.map(EventKind::Level));
        for kind in known {
            log.append(&Record::Event(Event { tick: ticks.start, kind })).unwrap();
        }
        let started = Event { tick: ticks.start, kind: EventKind::Reset(ResetCause::Watchdog) };
        log.append(&Record::Event(started)).unwrap();
        let mut pipeline = Pipeline::new(&settings, *prior).unwrap();
        for sample in sample_survey().samples().filter(|sample| ticks.contains(&sample.epoch.tick)) {
            let Epoch { tick, .. } = sample.epoch;
            if (5000..5010).contains(&tick) {
                continue;
            }
            if tick == 5010 {
                log.append(&Record::Loss(Loss { first_tick: 5000, epochs: 10, others: 0 })).unwrap();
            }
            if (1000..=1100).contains(&tick) && tick.is_multiple_of(10) {
                let navigation = Navigation { depth_m: Some(depth_m(tick)), ..Navigation::default() };
                log.append(&Record::Event(Event { tick, kind: EventKind::Navigation(navigation) })).unwrap();
            }
            if let Some(housekeeping) = housekeeping(tick) {
                log.append(&Record::Event(Event { tick, kind: EventKind::Housekeeping(housekeeping) })).unwrap();
            }
            if tick == 4000 {
                log.append(&Record::Event(Event { tick, kind: EventKind::TimeSet { unix_ms: unix_ms(tick) } }))
                    .unwrap();
            }
            let output = done(pipeline.step(&sample.epoch));
            let record = EpochRecord { epoch: sample.epoch, output, battery_a: Some(0.5), faults: None };
            log.append(&Record::Epoch(record)).unwrap();
        }
        log.flush().unwrap();
        card = log.into_device();
    }
    card
}
