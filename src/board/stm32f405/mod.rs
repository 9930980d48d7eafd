//! The body's board: an STM32F405RG with a crystal of 8 MHz, and what is soldered to it.
//!
//! | pin | what |
//! |---|---|
//! | PA9, PA10 | USART1: scalar sensor |
//! | PB10, PB11 | USART3: depth sensor, altimeter or GPS receiver |
//! | PA2, PA3 | USART2: tow cable |
//! | PA4 to PA7 | SPI1: chip select, clock, MISO, MOSI of the ADS131M04; PC6: its DRDY |
//! | PC0, PC1, PC2 | green, yellow and red light, on when high |
//! | PC3 | leak contact, wet when low |
//! | PC4 | battery voltage, by a divider |
//! | PB12 to PB15 | SPI2: chip select, clock, MISO, MOSI of the card |
//!
//! TIM2 is the free-running timer, TIM4 calls `assemble`, TIM5 measures the crystal at the start and is for the
//! card's delays afterwards.

mod buses;
mod clock;
mod data_ready;
mod early;
mod flash;
mod housekeeping;
mod second_pulses;
mod supply;
mod system;

pub use system::restart;

use super::chip::cost::Meter;
use super::chip::lights::LightPins;
use super::chip::reset_cause::{note_reset_cause, reset_cause};
use super::chip::serial::{self, CableTransmitter, SensorTransmitters};
use super::chip::timers::{Ticker, start_stopwatch};
use super::chip::vectors::{hand_on, name_vectors};
use super::chip::watchdog::Watchdog;
use super::chip::{SETTINGS, retained_ram, stack};
use buses::{FluxgateBus, LogCard};
use data_ready::DataReady;
use flash::SettingsFlash;
use housekeeping::HousekeepingInputs;
use second_pulses::SecondPulses;
use stm32f4xx_hal::pac::{self, interrupt};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::serial::Rx;
use system::System;
use towmag::hardware::{Board, Parts};
use towmag::sensors::nmea::NmeaSettings;
use towmag::store::{BodySettings, SettingsInFlash};

name_vectors!(
    USART1 as SCALAR,
    USART3 as NMEA,
    EXTI9_5 as FLUXGATE,
    TIM4 as ASSEMBLE,
    USART2 as CABLE,
    UART4 as SOFTWARE_1,
    UART5 as SOFTWARE_2,
);

hand_on!(
    USART1 to SCALAR,
    USART3 to NMEA,
    EXTI9_5 to FLUXGATE,
    TIM4 to ASSEMBLE,
    USART2 to CABLE,
    UART4 to SOFTWARE_1,
    UART5 to SOFTWARE_2,
);

/// This board.
pub struct Hardware;

impl Board for Hardware {
    type Peripherals = (rtic::export::Peripherals, pac::Peripherals);
    type ScalarPort = Rx<pac::USART1>;
    type NmeaPort = Rx<pac::USART3>;
    type SensorTransmitters = SensorTransmitters;
    type CableTransmitter = CableTransmitter;
    type CableReceiver = Rx<pac::USART2>;
    type DataReady = DataReady;
    type SecondPulses = SecondPulses;
    type FluxgateBus = FluxgateBus;
    type Card = LogCard;
    type SettingsFlash = SettingsFlash;
    type LightOutput = LightPins;
    type HousekeepingInputs = HousekeepingInputs;
    type Ticker = Ticker;
    type Watchdog = Watchdog;
    type Meter = Meter;
    type System = System;

    fn start((core, device): Self::Peripherals) -> Parts<Self> {
        stack::paint_stack();
        note_reset_cause(&device.RCC);
        // A reset leaves this memory alone.
        retained_ram::begin(reset_cause(), |_| ());
        supply::hold_below_2v7(&device.FLASH, &device.PWR, &device.RCC);
        let settings = SettingsInFlash::open(SettingsFlash::new(device.FLASH), SETTINGS);
        let (mut rcc, clock) = clock::start(device.RCC, &device.TIM5);
        let timer_mhz = clock::timer_mhz(clock.fault);
        start_stopwatch(device.TIM2, &mut rcc, timer_mhz, 0);
        let meter = Meter::start(core.SYST, || 0);
        let (pa, pb, pc) = (device.GPIOA.split(&mut rcc), device.GPIOB.split(&mut rcc), device.GPIOC.split(&mut rcc));
        let BodySettings { scalar_baud, cable_baud, nmea: NmeaSettings { baud, .. }, .. } = settings.stored.settings;
        let (scalar, scalar_port) = serial::scalar(device.USART1, (pa.pa9, pa.pa10), scalar_baud, &mut rcc);
        let (nmea, nmea_port) = serial::nmea(device.USART3, (pb.pb10, pb.pb11), baud, &mut rcc);
        let (cable_transmitter, cable_receiver) = serial::cable(device.USART2, (pa.pa2, pa.pa3), cable_baud, &mut rcc);
        Parts {
            scalar_port,
            nmea_port,
            sensor_transmitters: SensorTransmitters { scalar, nmea },
            cable_transmitter,
            cable_receiver,
            lights: LightPins {
                green: pc.pc0.into_push_pull_output().erase(),
                yellow: pc.pc1.into_push_pull_output().erase(),
                red: pc.pc2.into_push_pull_output().erase(),
            },
            housekeeping: HousekeepingInputs::start(pc.pc3, pc.pc4, device.ADC1, &device.ADC_COMMON, &mut rcc),
            second_pulses: SecondPulses::start(pa.pa0),
            data_ready: DataReady::new(pc.pc6, device.SYSCFG, device.EXTI, &mut rcc),
            fluxgate_bus: buses::fluxgate(device.SPI1, (pa.pa5, pa.pa6, pa.pa7), pa.pa4, &mut rcc),
            card: buses::card(device.SPI2, (pb.pb13, pb.pb14, pb.pb15), pb.pb12, device.TIM5, &mut rcc),
            settings,
            ticker: Ticker::start(device.TIM4, &mut rcc, timer_mhz, 0),
            watchdog: Watchdog(device.IWDG),
            meter,
            system: System::new(),
            clock,
        }
    }
}
