//! x
#![cfg(not(target_os = "none"))]
use towmag_virtual_chip::board::Board;
use towmag_virtual_chip::chip::Chip;
use towmag_virtual_chip::image::Image;
use towmag_virtual_chip::peripherals::flash::Cells;

#[test]
fn boots() {
    let image = Image::load();
    let mut chip = Chip::power_on(&image, Board::default(), Cells::default());
    let begin = std::time::Instant::now();
    for _ in 0..20 {
        chip.run(0.1);
        let words = chip.memory(image.symbol_like("RETAINED"), 300);
        println!("{}", String::from_utf8_lossy(&words));
        let m = chip.machine();
        println!("{:.3} s at {:#x} {:?} sent {} resets {:x?} lights {:?} wall {:?}", m.now_fs as f64 * 1e-15, m.last_block, chip.bus().clocks.map(|c| c.core_hz), chip.bus().usarts[1].sent.len(), chip.resets, chip.bus().lights(), begin.elapsed());
    }
}
