//! A board in memory: time is what the test says, everything that comes in is queued, everything that goes out is kept.

use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::rc::Rc;

use embedded_hal::spi::{self, Operation, SpiDevice};
use embedded_hal_nb::nb;
use embedded_hal_nb::serial::{self, Read, Write};
use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx};
use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};
use towmag::body::UnixTime;
use towmag::hardware::{
    Board, CableTransmitter, CardSlot, DataReady, EpochCost, HousekeepingInputs, LastWords, LightOutput, Meter, Parts,
    SecondPulses, SensorPort, SensorTransmitters, Stamp, System, Ticker, Watchdog,
};
use towmag::health::{Health, Task};
use towmag::housekeeping::HousekeepingSample;
use towmag::lights::Lights;
use towmag::log::ResetCause;
use towmag::microcontroller::ClockCheck;
use towmag::store::{FlashSectors, SLOT_LEN, SettingsInFlash};

use super::disk::{Disk, DiskError};

const SECTOR_LEN: u32 = 4 * SLOT_LEN as u32;
pub const SECTORS: FlashSectors = FlashSectors { sectors: [0, SECTOR_LEN], sector_len: SECTOR_LEN };

/// What the test sees of the board, and sets.
pub struct Bench {
    pub now_us: Cell<u32>,
    /// The card that is in the slot, if there is one.
    pub card: RefCell<Option<Disk>>,
    /// Has every block ask for the signs of life that the watchdog wants.
    pub watch: Cell<Option<&'static Health>>,
    pub flash: RefCell<Vec<u8>>,
    pub flash_refuses: Cell<bool>,
    pub scalar_bytes: RefCell<VecDeque<u8>>,
    /// On the third UART; `None` is an error of the receiver.
    pub nmea_bytes: RefCell<VecDeque<Option<u8>>>,
    /// From the ship; `None` is an error of the receiver.
    pub from_ship: RefCell<VecDeque<Option<u8>>>,
    pub to_ship: RefCell<Vec<u8>>,
    /// Bytes that the transmitter takes before it is busy.
    pub room: Cell<usize>,
    pub listens: Cell<bool>,
    pub lights: Cell<Lights>,
    /// Leak contact and battery, as they are.
    pub housekeeping: Cell<HousekeepingSample>,
    pub fluxgate_wakes: Cell<u32>,
    pub restarts_by_fault: Cell<u32>,
    pub clock: Cell<ClockCheck>,
    /// A wire from TX to RX in place of this sensor.
    pub wire: Cell<Option<SensorPort>>,
    pub last_words: RefCell<Option<LastWords>>,
    /// Stamp of the latest pulse of a GPS receiver.
    pub second_pulse: Cell<Option<u32>>,
    pub kept_time: Cell<Option<UnixTime>>,
    /// Why the body is told that it has started.
    pub reset_cause: Cell<ResetCause>,
    pub restarts: Cell<u32>,
    pub sessions: Cell<u32>,
}

impl Bench {
    pub fn new() -> Rc<Self> {
        Rc::new(Self {
            now_us: Cell::new(1_000_000),
            card: RefCell::new(None),
            watch: Cell::new(None),
            flash: RefCell::new(vec![0xff; 2 * SECTOR_LEN as usize]),
            flash_refuses: Cell::new(false),
            scalar_bytes: RefCell::default(),
            nmea_bytes: RefCell::default(),
            from_ship: RefCell::default(),
            to_ship: RefCell::default(),
            room: Cell::new(usize::MAX),
            listens: Cell::new(false),
            lights: Cell::default(),
            housekeeping: Cell::default(),
            fluxgate_wakes: Cell::new(0),
            restarts_by_fault: Cell::new(0),
            clock: Cell::default(),
            wire: Cell::new(None),
            last_words: RefCell::default(),
            second_pulse: Cell::new(None),
            kept_time: Cell::new(None),
            reset_cause: Cell::new(ResetCause::PowerOn),
            restarts: Cell::new(0),
            sessions: Cell::new(0),
        })
    }
}

/// Everything on the board is the bench itself.
#[derive(Clone)]
pub struct OnBench(pub Rc<Bench>);

pub struct BenchBoard;

impl Board for BenchBoard {
    type Peripherals = Rc<Bench>;
    type ScalarPort = ScalarPort;
    type NmeaPort = NmeaPort;
    type SensorTransmitters = OnBench;
    type CableTransmitter = OnBench;
    type CableReceiver = OnBench;
    type DataReady = OnBench;
    type FluxgateBus = OnBench;
    type Card = OnBench;
    type SettingsFlash = OnBench;
    type LightOutput = OnBench;
    type HousekeepingInputs = OnBench;
    type SecondPulses = OnBench;
    type Ticker = OnBench;
    type Watchdog = OnBench;
    type Meter = OnBench;
    type System = OnBench;

    fn start(bench: Rc<Bench>) -> Parts<Self> {
        let part = OnBench(bench);
        Parts {
            scalar_port: ScalarPort(part.clone()),
            nmea_port: NmeaPort(part.clone()),
            sensor_transmitters: part.clone(),
            cable_transmitter: part.clone(),
            cable_receiver: part.clone(),
            data_ready: part.clone(),
            second_pulses: part.clone(),
            fluxgate_bus: part.clone(),
            card: part.clone(),
            settings: SettingsInFlash::open(part.clone(), SECTORS),
            lights: part.clone(),
            housekeeping: part.clone(),
            ticker: part.clone(),
            watchdog: part.clone(),
            meter: part.clone(),
            clock: part.0.clock.get(),
            system: part,
        }
    }
}

impl System for OnBench {
    fn now_us(&self) -> u32 {
        self.0.now_us.get()
    }

    fn stamp_us(&self, _: Stamp) -> u32 {
        self.now_us()
    }

    fn random(&self, _: u32) -> u32 {
        self.0.sessions.set(self.0.sessions.get() + 1);
        self.0.sessions.get()
    }

    fn wake_fluxgate(&self) {
        self.0.fluxgate_wakes.set(self.0.fluxgate_wakes.get() + 1);
    }

    fn reset_cause(&self) -> ResetCause {
        self.0.reset_cause.get()
    }

    fn restarts_by_fault(&self) -> u32 {
        self.0.restarts_by_fault.get()
    }

    fn last_words(&self) -> Option<LastWords> {
        self.0.last_words.take()
    }

    fn keep_time(&self, time: Option<UnixTime>) {
        self.0.kept_time.set(time);
    }

    fn kept_time(&self) -> Option<UnixTime> {
        self.0.kept_time.take()
    }

    fn restart(&self) {
        self.0.restarts.set(self.0.restarts.get() + 1);
    }

    fn most_stack_used(&self) -> u32 {
        12_345
    }

    fn ticks_of_known_loop(&self) -> u32 {
        100_000
    }
}

/// The scalar sensor's UART.
pub struct ScalarPort(OnBench);

impl serial::ErrorType for ScalarPort {
    type Error = serial::ErrorKind;
}

impl Read<u8> for ScalarPort {
    fn read(&mut self) -> nb::Result<u8, serial::ErrorKind> {
        self.0.0.scalar_bytes.borrow_mut().pop_front().ok_or(nb::Error::WouldBlock)
    }
}

/// The third UART.
pub struct NmeaPort(OnBench);

impl serial::ErrorType for NmeaPort {
    type Error = serial::ErrorKind;
}

impl Read<u8> for NmeaPort {
    fn read(&mut self) -> nb::Result<u8, serial::ErrorKind> {
        let byte = self.0.0.nmea_bytes.borrow_mut().pop_front().ok_or(nb::Error::WouldBlock)?;
        byte.ok_or(nb::Error::Other(serial::ErrorKind::FrameFormat))
    }
}

impl serial::ErrorType for OnBench {
    type Error = serial::ErrorKind;
}

impl Read<u8> for OnBench {
    fn read(&mut self) -> nb::Result<u8, serial::ErrorKind> {
        let byte = self.0.from_ship.borrow_mut().pop_front().ok_or(nb::Error::WouldBlock)?;
        byte.ok_or(nb::Error::Other(serial::ErrorKind::Overrun))
    }
}

impl Write<u8> for OnBench {
    fn write(&mut self, byte: u8) -> nb::Result<(), serial::ErrorKind> {
        let room = self.0.room.get().checked_sub(1).ok_or(nb::Error::WouldBlock)?;
        self.0.room.set(room);
        self.0.to_ship.borrow_mut().push(byte);
        Ok(())
    }

    fn flush(&mut self) -> nb::Result<(), serial::ErrorKind> {
        Ok(())
    }
}

impl CableTransmitter for OnBench {
    fn listen(&mut self) {
        self.0.listens.set(true);
    }

    fn unlisten(&mut self) {
        self.0.listens.set(false);
    }

    fn wake(&mut self) {
        self.listen();
    }
}

impl DataReady for OnBench {
    fn take(&mut self) -> Option<u32> {
        None
    }
}

impl SensorTransmitters for OnBench {
    fn send(&mut self, port: SensorPort, byte: u8) {
        match self.0.wire.get().filter(|wired| *wired == port) {
            Some(SensorPort::Scalar) => self.0.scalar_bytes.borrow_mut().push_back(byte),
            Some(SensorPort::Nmea) => self.0.nmea_bytes.borrow_mut().push_back(Some(byte)),
            None => {}
        }
    }
}

/// No converter is plugged in.
impl spi::ErrorType for OnBench {
    type Error = spi::ErrorKind;
}

impl SpiDevice for OnBench {
    fn transaction(&mut self, _: &mut [Operation<'_, u8>]) -> Result<(), spi::ErrorKind> {
        Err(spi::ErrorKind::Other)
    }
}

impl OnBench {
    fn with_card<T>(&self, work: impl FnOnce(&Disk) -> Result<T, DiskError>) -> Result<T, DiskError> {
        work(self.0.card.borrow().as_ref().ok_or(DiskError::Off)?)
    }

    fn assert_alive(&self) {
        let Some(health) = self.0.watch.get() else { return };
        health.tasks.ran(Task::Assemble);
        health.tasks.ran(Task::Compensate);
        assert!(health.tasks.all_ran(), "the watchdog would take the storage for dead");
    }
}

impl BlockDevice for OnBench {
    type Error = DiskError;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), DiskError> {
        self.assert_alive();
        self.with_card(|disk| disk.read(blocks, start))
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), DiskError> {
        self.assert_alive();
        self.with_card(|disk| disk.write(blocks, start))
    }

    fn num_blocks(&self) -> Result<BlockCount, DiskError> {
        self.with_card(|disk| disk.num_blocks())
    }
}

impl CardSlot for OnBench {
    fn look_again(&self) {}
}

/// The flash refuses.
#[derive(Debug)]
pub struct Refused;

impl NorFlashError for Refused {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl ErrorType for OnBench {
    type Error = Refused;
}

impl ReadNorFlash for OnBench {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Refused> {
        let start = offset as usize;
        bytes.copy_from_slice(&self.0.flash.borrow()[start..start + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.0.flash.borrow().len()
    }
}

impl NorFlash for OnBench {
    const WRITE_SIZE: usize = 1;
    const ERASE_SIZE: usize = SECTOR_LEN as usize;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Refused> {
        self.0.flash.borrow_mut()[from as usize..to as usize].fill(0xff);
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Refused> {
        if self.0.flash_refuses.get() {
            return Err(Refused);
        }
        let mut flash = self.0.flash.borrow_mut();
        flash[offset as usize..].iter_mut().zip(bytes).for_each(|(cell, byte)| *cell &= byte);
        Ok(())
    }
}

impl LightOutput for OnBench {
    fn show(&mut self, lights: Lights) {
        self.0.lights.set(lights);
    }
}

impl HousekeepingInputs for OnBench {
    fn sample(&mut self) -> HousekeepingSample {
        self.0.housekeeping.get()
    }
}

impl SecondPulses for OnBench {
    fn take(&mut self) -> Option<u32> {
        self.0.second_pulse.take()
    }
}

impl Ticker for OnBench {
    fn acknowledge(&mut self) {}
}

impl Watchdog for OnBench {
    fn feed(&mut self) {}
}

impl Meter for OnBench {
    fn sleep(&mut self, _: u32, tell: impl FnOnce(EpochCost)) {
        tell(EpochCost { mean: 40_000, worst: 50_000 });
    }
}
