//! The first power-up with everything connected.

use crate::Scenario;
use crate::bench::{Body, FIRST_PT, SMALL_FILES, STEP_PT, sensors_and};
use std::sync::LazyLock;
use towmag_virtual_body::fat::fat16;
use towmag_virtual_body::log::recover_file;
use towmag::log::Record;
use towmag::sensors::grid::{FluxMark, ScalarMark};

pub static EVERYTHING_CONNECTED: Scenario = Scenario::new(everything_connected);

#[test]
fn every_epoch_reaches_the_ship_and_the_card() {
    LazyLock::force(&EVERYTHING_CONNECTED);
}

fn everything_connected() {
    let mut body = Body::start(sensors_and(fat16(16_000)), SMALL_FILES.clone());
    body.live(30.0);
    let telemetry = body.received().telemetry;
    println!("{} {:?} {:?}", telemetry.len(), telemetry.first(), telemetry.last());
    println!("{:?}", body.answer("status"));
    println!("{:?}", body.answer("reset yes"));
    let card = body.chip.bus().card.as_ref().unwrap();
    let log = recover_file(&card.disk, "TOWMAG01.BIN").unwrap();
    println!("{} {:?} {:x?}", log.epochs.len(), log.survey, body.chip.resets);
    println!("{:?}", log.items.iter().take(5).collect::<Vec<_>>());
}
