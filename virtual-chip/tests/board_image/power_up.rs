//! The first power-up with everything connected, from the crystal to the log on the card.

use crate::Scenario;
use crate::bench::{Body, COUNTS, FIRST_PT, SMALL_FILES, STEP_PT, epochs, events, sensors, sensors_and};
use towmag::log::{EventKind, ResetCause};
use towmag::sensors::fluxgate::FluxgateSettings;
use towmag::sensors::grid::{FluxMark, ScalarMark};
use towmag_virtual_body::fat::fat16;
use towmag_virtual_chip::board::Board;
use towmag_virtual_chip::peripherals::flash::Cells;
use towmag_virtual_chip::peripherals::rcc::SOFTWARE;

pub(crate) static EVERYTHING: Scenario = Scenario::new(everything);
pub(crate) static FIRST_START: Scenario = Scenario::new(first_start);
pub(crate) static LOW_SUPPLY: Scenario = Scenario::new(low_supply);

#[test]
fn every_epoch_reaches_the_ship_and_the_card() {
    Scenario::force(&EVERYTHING);
}

#[test]
fn the_brown_out_level_is_set_by_the_first_start_only() {
    Scenario::force(&FIRST_START);
}

#[test]
fn the_brown_out_level_is_not_set_while_the_supply_is_low() {
    Scenario::force(&LOW_SUPPLY);
}

/// The formatted card has no file for the log yet: the body makes it.
fn everything() {
    let mut body = Body::start(sensors_and(fat16(16_000)), SMALL_FILES.clone());
    body.live(30.0);
    let telemetry = body.received().telemetry;
    assert!((294..=300).contains(&telemetry.len()), "{} epochs in 30 s", telemetry.len());
    let first_pt = telemetry[0].raw_scalar_pt.unwrap();
    assert!((first_pt - FIRST_PT) / STEP_PT < 8, "the first epoch is {first_pt} pT");
    for (seen, tick) in telemetry.iter().zip(1..) {
        assert_eq!((seen.tick, seen.raw_scalar_pt), (tick, Some(first_pt + (tick as i32 - 1) * STEP_PT)));
        assert_eq!((seen.quality.scalar, seen.quality.flux == FluxMark::Present), (ScalarMark::Present, tick > 1));
    }
    assert!(telemetry.last().unwrap().activity.logging);
    assert!(body.baud_error().abs() < 0.02);

    assert_eq!(body.chip.bus().usarts.iter().map(|uart| uart.overwritten).sum::<u32>(), 0);

    let status = body.answer("status");
    assert_eq!(status[2..4], ["log: on, room for 0 h", "settings: intact"]);
    assert_eq!(body.answer("reset yes"), ["starting anew"]);
    assert_eq!(body.chip.resets, [SOFTWARE]);
    body.live(10.0);

    let disk = body.disk();
    let logged = epochs(disk);
    let nt_per_count = FluxgateSettings::default().nt_per_count[0] as f32;
    for (seen, record) in telemetry.iter().zip(&logged) {
        assert_eq!((record.epoch.tick, record.epoch.scalar_pt), (seen.tick, seen.raw_scalar_pt));
        let flux_nt = record.epoch.flux_nt.map(|flux_nt| flux_nt.map(|nt| (nt / nt_per_count).round() as i32));
        assert_eq!(flux_nt, (seen.tick > 1).then_some([COUNTS[0], COUNTS[1], COUNTS[2]]));
    }
    assert!(logged.len() > telemetry.len());
    let resets = [ResetCause::PowerOn, ResetCause::Software].map(EventKind::Reset);
    let told = events(disk);
    assert!(resets.iter().all(|reset| told.contains(reset)), "{told:?}");
}

/// What a chip has as it is delivered, and with the level set: FLASH_OPTCR, bits 3 and 2.
fn level(cells: &Cells) -> u32 {
    cells.options >> 2 & 0b11
}

fn first_start() {
    let mut body = Body::start(sensors(), Cells::default());
    assert_eq!(level(&body.cells()), 0b11);
    body.live(2.0);
    assert!(!body.received().telemetry.is_empty());
    let cells = body.cells();
    assert_eq!((level(&cells), cells.option_programmings), (0, 1));
    assert_eq!(cells.options & !0b1100, Cells::default().options & !0b1100);
    let (board, cells) = body.off();
    let mut body = Body::start(board, cells);
    body.live(2.0);
    assert!(!body.received().telemetry.is_empty());
    assert_eq!(body.cells().option_programmings, 1);
}

fn low_supply() {
    let mut body = Body::start(Board { supply_mv: 2_850, ..sensors() }, Cells::default());
    body.live(2.0);
    assert!(!body.received().telemetry.is_empty());
    assert_eq!((level(&body.cells()), body.cells().option_programmings), (0b11, 0));
}
