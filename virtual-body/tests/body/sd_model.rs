//! The model of the card is as strict as a card: without what the body does around the driver, it does not answer.

use embedded_hal::spi::{ErrorType, Operation, SpiBus, SpiDevice};
use embedded_sdmmc::{BlockDevice, SdCard as Driver};
use std::convert::Infallible;
use std::rc::Rc;
use towmag::sd_card::{CardBus, Speed};
use towmag_virtual_body::disk::Disk;
use towmag_virtual_body::fat::fat16;
use towmag_virtual_body::sd::{Capacity, SdCard, VirtualBus, VirtualDelay, VirtualSelect, World};

/// The driver's bus with nothing around it; chip select is low all the time.
struct Bare(VirtualBus);

impl ErrorType for Bare {
    type Error = Infallible;
}

impl SpiDevice for Bare {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        operations.iter_mut().try_for_each(|operation| match operation {
            Operation::Read(bytes) => self.0.read(bytes),
            Operation::Write(bytes) => self.0.write(bytes),
            Operation::Transfer(read, write) => self.0.transfer(read, write),
            Operation::TransferInPlace(bytes) => self.0.transfer_in_place(bytes),
            Operation::DelayNs(_) => Ok(()),
        })
    }
}

/// The driver alone on a card, after so many bytes of clocks with chip select high.
fn driver(disk: Disk, capacity: Capacity, clocks: usize, start: Speed) -> Driver<Bare, VirtualDelay> {
    use embedded_hal::digital::OutputPin;
    let world = World::new(Some(SdCard::new(disk, capacity)));
    let (mut bus, mut select) = (VirtualBus(world.clone()), VirtualSelect(world.clone()));
    bus.set_speed(start);
    _ = bus.write(&vec![0xff; clocks]);
    _ = select.set_low();
    Driver::new(Bare(bus), VirtualDelay(Rc::clone(&world)))
}

/// Whether it reads a block.
fn reads(clocks: usize, start: Speed) -> bool {
    let driver = driver(fat16(4_100), Capacity::High, clocks, start);
    driver.read(&mut [embedded_sdmmc::Block::new()], embedded_sdmmc::BlockIdx(0)).is_ok()
}

#[test]
fn a_card_wants_74_clocks_and_a_slow_start() {
    assert!(reads(10, Speed::Start));
    assert!(!reads(9, Speed::Start), "72 clocks");
    assert!(!reads(0, Speed::Start));
    assert!(!reads(10, Speed::Data), "10.5 MHz");
}

#[test]
fn a_card_tells_its_size_as_well_as_it_can() {
    for (capacity, blocks, told) in [
        (Capacity::High, 8_192, 8_192),
        (Capacity::High, 9_000, 8_192),
        (Capacity::Standard, 9_002, 9_000),
        (Capacity::Standard, 60_001, 60_000),
    ] {
        let driver = driver(Disk::new(blocks), capacity, 10, Speed::Start);
        assert_eq!(driver.num_blocks().unwrap().0, told, "{capacity:?} of {blocks}");
    }
}
