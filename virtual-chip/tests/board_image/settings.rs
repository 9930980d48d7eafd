//! Settings in the chip's own flash.

use crate::Scenario;
use crate::bench::{Body, SMALL_FILES, sensors};
use towmag_virtual_chip::board::Board;
use towmag_virtual_chip::chip::End;
use towmag_virtual_chip::peripherals::flash::Cells;

pub(crate) static KEPT: Scenario = Scenario::new(kept);
pub(crate) static CUT_WHILE_PROGRAMMING: Scenario = Scenario::new(cut_while_programming);
pub(crate) static CUT_WHILE_ERASING: Scenario = Scenario::new(cut_while_erasing);

#[test]
fn what_is_saved_outlives_a_reset_and_the_power() {
    Scenario::force(&KEPT);
}

#[test]
fn a_power_cut_while_an_image_is_programmed_leaves_the_one_before() {
    Scenario::force(&CUT_WHILE_PROGRAMMING);
}

#[test]
fn a_power_cut_while_a_sector_is_erased_leaves_a_body_that_starts() {
    Scenario::force(&CUT_WHILE_ERASING);
}

fn kept() {
    let mut body = Body::start(sensors(), SMALL_FILES.clone());
    body.live(2.0);
    assert_eq!(body.answer("set lambda1 0.002"), ["lambda1 = 0.002"]);
    assert_eq!(body.answer("save"), ["saved: holds from the next start, log at once"]);
    assert_eq!(body.answer("reset yes"), ["starting anew"]);
    body.live(2.0);
    assert_eq!(body.answer("get lambda1"), ["lambda1 = 0.002"]);
    assert_eq!(body.answer("set lambda1 0.003"), ["lambda1 = 0.003"]);
    let (board, cells) = body.off();
    let mut body = Body::start(board, cells);
    body.live(2.0);
    assert_eq!(body.answer("get lambda1"), ["lambda1 = 0.002"], "what was not saved is gone");
    assert_eq!(body.answer("status")[3], "settings: intact");
}

fn cut_while_programming() {
    for operations in [1, 2, 40, 150] {
        let mut body = Body::start(Board::default(), SMALL_FILES.clone());
        body.live(1.0);
        body.answer("set lambda1 0.002");
        body.chip.bus_mut().flash.cut_after = Some(operations);
        body.send("save\r");
        assert_eq!(body.live(5.0), End::PowerCut);
        let (board, cells) = body.off();
        let mut body = Body::start(board, cells);
        body.live(2.0);
        assert_eq!(body.answer("get lambda1"), ["lambda1 = 0.001"], "after {operations} operations");
        assert_eq!(body.answer("get log_file_h"), ["log_file_h = 1"]);
        // The next image finds its place behind the torn one.
        body.answer("set lambda1 0.004");
        assert_eq!(body.answer("save"), ["saved: holds from the next start, log at once"]);
    }
}

/// The first image of a new chip begins with an erasure.
fn cut_while_erasing() {
    let mut body = Body::start(Board::default(), Cells::default());
    body.live(1.0);
    body.answer("set lambda1 0.002");
    body.chip.bus_mut().flash.cut_after = Some(1);
    body.send("save\r");
    assert_eq!(body.live(5.0), End::PowerCut);
    let (board, cells) = body.off();
    let mut body = Body::start(board, cells);
    body.live(2.0);
    assert_eq!(body.answer("get lambda1"), ["lambda1 = 0.001"]);
    body.answer("set lambda1 0.002");
    assert_eq!(body.answer("save"), ["saved: holds from the next start, log at once"]);
}
