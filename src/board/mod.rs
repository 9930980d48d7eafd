//! The only part that knows the hardware: an STM32F405RG, and what is soldered to it.
//!
//! | pin | what |
//! |---|---|
//! | PA9, PA10 | USART1: scalar sensor |
//! | PA2, PA3 | USART2: tow cable |
//! | PA4 to PA7 | SPI1: chip select, clock, MISO, MOSI of the ADS131M04; PC6: its DRDY |
//! | PB12 to PB15 | SPI2: chip select, clock, MISO, MOSI of the card |
//!
//! With the feature `emulation` three things differ, all below the traits that the rest is written against: the clock,
//! the fluxgate's SPI device (with its data-ready edge), and the card's block device. See `bridge`.

#[cfg(feature = "emulation")]
mod bridge;
#[cfg(not(feature = "emulation"))]
mod buses;
mod cable;
mod clock;
mod cost;
mod memory;
mod panic;

#[cfg(feature = "emulation")]
pub use bridge::{DataReady, FluxgateBus, LogCard, ScalarPort, data_ready as bridge_data_ready};
#[cfg(not(feature = "emulation"))]
pub use buses::{DataReady, FluxgateBus, LogCard, ScalarPort};
pub use cable::{CableRx, CableTx};
pub use clock::{Source, SpinDelay, Ticker, Watchdog, stamp_us};
pub use cost::{Meter, Preempting};
pub use memory::{most_stack_used, random, setup};
pub use panic::{last_words, reset_cause};

use defmt_rtt as _;
use stm32f4xx_hal::pac;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::serial::{Config, Serial};
use towmag::sensors::scalar::{ScalarFormat, ScalarSettings};

/// Baud rate of the tow cable.
const CABLE_BAUD: u32 = 115_200;

/// Everything on the board, ready for the tasks.
pub struct Board {
    pub scalar_port: ScalarPort,
    pub cable_tx: CableTx,
    pub cable_rx: CableRx,
    pub data_ready: DataReady,
    pub fluxgate_bus: FluxgateBus,
    pub card: LogCard,
    pub ticker: Ticker,
    pub watchdog: Watchdog,
    pub meter: Meter,
}

impl Board {
    /// Set up clocks, pins and peripherals.
    pub fn new(core: rtic::export::Peripherals, device: pac::Peripherals, scalar: &ScalarSettings) -> Self {
        memory::paint_stack();
        panic::note_reset_cause(&device.RCC);
        let mut rcc = device.RCC.freeze(clock::config());
        clock::start_stopwatch(device.TIM2, &mut rcc);
        let meter = Meter::start(core.SYST);
        let pins = device.GPIOA.split(&mut rcc);
        let scalar_config = Config::default().baudrate(scalar_baud(scalar).bps());
        let scalar_serial: Serial<pac::USART1> =
            Serial::new(device.USART1, (pins.pa9, pins.pa10), scalar_config, &mut rcc).expect("the baud rate fits");
        let cable_config = Config::default().baudrate(CABLE_BAUD.bps());
        let cable_serial: Serial<pac::USART2> =
            Serial::new(device.USART2, (pins.pa2, pins.pa3), cable_config, &mut rcc).expect("the baud rate fits");
        let (_, mut scalar_rx) = scalar_serial.split();
        let (cable_tx, mut cable_rx) = cable_serial.split();
        scalar_rx.listen();
        cable_rx.listen();
        #[cfg(feature = "emulation")]
        let (scalar_port, data_ready, fluxgate_bus, card) = {
            bridge::start_data_ready(device.TIM5, &mut rcc);
            (ScalarPort::new(scalar_rx), DataReady, FluxgateBus::open(), LogCard::open())
        };
        #[cfg(not(feature = "emulation"))]
        let (scalar_port, data_ready, fluxgate_bus, card) = {
            let pc = device.GPIOC.split(&mut rcc);
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
            ticker,
            watchdog,
            meter,
        }
    }
}

/// What the maker sets.
fn scalar_baud(scalar: &ScalarSettings) -> u32 {
    match scalar.format {
        ScalarFormat::G882 => 9_600,
        ScalarFormat::QtfmGen1 { .. } | ScalarFormat::QtfmGen2(_) => 115_200,
    }
}

/// Run the fluxgate's task though no conversion came.
pub fn poke_fluxgate() {
    rtic::pend(pac::Interrupt::EXTI9_5);
}
