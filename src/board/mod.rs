//! The only part that knows the hardware: an STM32F405RG, and what is soldered to it.
//!
//! | pin | what |
//! |---|---|
//! | PA9, PA10 | USART1: scalar sensor |
//! | PA2, PA3 | USART2: tow cable |
//! | PA4 to PA7 | SPI1: chip select, clock, MISO, MOSI of the ADS131M04; PC6: its DRDY |
//! | PC0, PC1, PC2 | green, yellow and red light, on when high |
//! | PB12 to PB15 | SPI2: chip select, clock, MISO, MOSI of the card |
//!
//! With the feature `emulation` some things differ, all below the traits that the rest is written against: the clock, the
//! fluxgate's SPI device (with its data-ready edge), and what keeps data: card, flash for the settings, and the memory that
//! outlives a reset. See `bridge`.

#[cfg(feature = "emulation")]
mod bridge;
#[cfg(not(feature = "emulation"))]
mod buses;
mod cable;
mod clock;
mod cost;
#[cfg(not(feature = "emulation"))]
mod flash;
mod kept;
mod lamps;
mod memory;
mod panic;

#[cfg(feature = "emulation")]
pub use bridge::{DataReady, FluxgateBus, LogCard, ScalarPort, SettingsFlash, data_ready as bridge_data_ready};
#[cfg(not(feature = "emulation"))]
pub use buses::{DataReady, FluxgateBus, LogCard, ScalarPort};
pub use cable::{CableRx, CableTx};
pub use clock::{Source, SpinDelay, Ticker, Watchdog, stamp_us};
pub use cost::{Meter, Preempting, ticks_of_known_loop};
#[cfg(not(feature = "emulation"))]
pub use flash::SettingsFlash;
pub use kept::{faults, last_words, leave_time, restart, time};
pub use lamps::Lamps;
pub use memory::{most_stack_used, random};
pub use panic::reset_cause;

use defmt_rtt as _;
use stm32f4xx_hal::pac;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::serial::{Config, Serial};
use towmag::store::{BodySettings, Condition, Region, SettingsStore, Stored};

/// Baud rate of the tow cable.
const CABLE_BAUD: u32 = 115_200;

/// The two last sectors of the flash, which the linker leaves alone (`memory.x`).
pub const SETTINGS: Region = Region { sectors: [0xC_0000, 0xE_0000], sector_len: 0x2_0000 };

/// The settings, and where they lie.
pub struct Keeper {
    pub flash: SettingsFlash,
    /// `None` when the flash is not what it must be: nothing can be stored then.
    pub store: Option<SettingsStore>,
    pub stored: Stored,
    pub condition: Condition,
}

impl Keeper {
    fn open(mut flash: SettingsFlash) -> Self {
        match SettingsStore::open(&mut flash, SETTINGS) {
            Ok((store, opened)) => {
                let stored = opened.stored.unwrap_or_default();
                Self { flash, store: Some(store), stored, condition: opened.condition }
            }
            Err(_) => Self { flash, store: None, stored: Stored::default(), condition: Condition::Lost },
        }
    }
}

/// Everything on the board, ready for the tasks.
pub struct Board {
    pub scalar_port: ScalarPort,
    pub cable_tx: CableTx,
    pub cable_rx: CableRx,
    pub data_ready: DataReady,
    pub fluxgate_bus: FluxgateBus,
    pub card: LogCard,
    pub keeper: Keeper,
    pub lamps: Lamps,
    pub ticker: Ticker,
    pub watchdog: Watchdog,
    pub meter: Meter,
}

impl Board {
    /// Set up clocks, pins and peripherals.
    pub fn new(core: rtic::export::Peripherals, device: pac::Peripherals) -> Self {
        memory::paint_stack();
        panic::note_reset_cause(&device.RCC);
        kept::begin(reset_cause());
        #[cfg(feature = "emulation")]
        let keeper = Keeper::open(SettingsFlash::open());
        #[cfg(not(feature = "emulation"))]
        let keeper = Keeper::open(SettingsFlash::new(device.FLASH));
        let BodySettings { scalar_baud, .. } = keeper.stored.settings;
        let mut rcc = device.RCC.freeze(clock::config());
        clock::start_stopwatch(device.TIM2, &mut rcc);
        let meter = Meter::start(core.SYST);
        let pins = device.GPIOA.split(&mut rcc);
        let scalar_config = Config::default().baudrate(scalar_baud.bps());
        let scalar_serial: Serial<pac::USART1> =
            Serial::new(device.USART1, (pins.pa9, pins.pa10), scalar_config, &mut rcc).expect("the baud rate fits");
        let cable_config = Config::default().baudrate(CABLE_BAUD.bps());
        let cable_serial: Serial<pac::USART2> =
            Serial::new(device.USART2, (pins.pa2, pins.pa3), cable_config, &mut rcc).expect("the baud rate fits");
        let pc = device.GPIOC.split(&mut rcc);
        let lamps = Lamps::new((pc.pc0, pc.pc1, pc.pc2));
        let (_, mut scalar_rx) = scalar_serial.split();
        let (cable_tx, mut cable_rx) = cable_serial.split();
        scalar_rx.listen();
        cable_rx.listen();
        #[cfg(feature = "emulation")]
        let (scalar_port, data_ready, fluxgate_bus, card) = {
            bridge::start_data_ready(device.TIM5, &mut rcc, keeper.stored.settings.grid.conversions_per_epoch);
            (ScalarPort::new(scalar_rx), DataReady, FluxgateBus::open(), LogCard::open())
        };
        #[cfg(not(feature = "emulation"))]
        let (scalar_port, data_ready, fluxgate_bus, card) = {
            let pb = device.GPIOB.split(&mut rcc);
            let data_ready = DataReady::new(pc.pc6, device.SYSCFG, device.EXTI, &mut rcc);
            let fluxgate = buses::fluxgate(device.SPI1, (pins.pa5, pins.pa6, pins.pa7), pins.pa4, &mut rcc);
            let card = buses::card(device.SPI2, (pb.pb13, pb.pb14, pb.pb15), pb.pb12, device.TIM5, &mut rcc);
            (scalar_rx, data_ready, fluxgate, card)
        };
        let ticker = Ticker::start(device.TIM4, &mut rcc);
        let watchdog = Watchdog::start(device.IWDG);
        defmt::info!("towmag {=str}, commit {=str}", env!("CARGO_PKG_VERSION"), env!("TOWMAG_COMMIT"));
        Self {
            scalar_port,
            cable_tx: CableTx::new(cable_tx),
            cable_rx: CableRx::new(cable_rx),
            data_ready,
            fluxgate_bus,
            card,
            keeper,
            lamps,
            ticker,
            watchdog,
            meter,
        }
    }
}

/// Run the fluxgate's task though no conversion came.
pub fn poke_fluxgate() {
    rtic::pend(pac::Interrupt::EXTI9_5);
}
