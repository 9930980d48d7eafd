//! The board as an emulator has it: QEMU's machine `netduinoplus2`, an STM32F405 without clocks, SPI and SD.
//!
//! What it lacks is bridged to its host by semihosting: the fluxgate's SPI device with its data-ready edge (`fluxgate`,
//! `data_ready`; the protocol is in `protocol`), what keeps data (`storage`), and the end of a life (`system`). Everything
//! above the traits of [`towmag::hardware`] is the program for the real board.

mod cost;
mod data_ready;
mod fluxgate;
mod host;
mod housekeeping;
mod nmea_port;
mod protocol;
mod scalar_port;
mod storage;
mod system;

pub use system::restart;

use super::chip::cost::Meter;
use super::chip::lights::LightPins;
use super::chip::reset_cause::{note_reset_cause, reset_cause};
use super::chip::serial::{self, CableTransmitter, SensorTransmitters};
use super::chip::timers::{Ticker, now_us, start_stopwatch};
use super::chip::vectors::{hand_on, name_vectors, run_task};
use super::chip::watchdog::Watchdog;
use super::chip::{SETTINGS, retained_ram, stack};
use cost::Preempting;
use data_ready::DataReady;
use fluxgate::FluxgateBus;
use housekeeping::HousekeepingInputs;
use nmea_port::NmeaPort;
use scalar_port::ScalarPort;
use stm32f4xx_hal::pac::{self, interrupt};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc;
use stm32f4xx_hal::serial::Rx;
use storage::{LogCard, SettingsFlash};
use system::System;
use towmag::hardware::{Board, Parts, SecondPulses};
use towmag::microcontroller::ClockCheck;
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
    EXTI9_5 to FLUXGATE,
    TIM4 to ASSEMBLE,
    USART2 to CABLE,
    UART4 to SOFTWARE_1,
    UART5 to SOFTWARE_2,
);

/// Comes into the waits for the host: what it costs is not a part of them.
#[interrupt]
fn USART1() {
    let cost = Preempting::begin();
    run_task!(SCALAR);
    cost.end();
}

/// The same of the other sensor whose bytes the waits are for.
#[interrupt]
fn USART3() {
    let cost = Preempting::begin();
    run_task!(NMEA);
    cost.end();
}

/// QEMU's timers run at 1 GHz whatever the clock registers say.
const TIMER_MHZ: u16 = 1_000;

/// QEMU has no model of the PLL: waiting for its lock would never end.
fn clocks() -> rcc::Config {
    rcc::Config::hsi()
}

/// QEMU's timers capture nothing.
pub struct NoPulses;

impl SecondPulses for NoPulses {
    fn take(&mut self) -> Option<u32> {
        None
    }
}

/// The emulated board.
pub struct Hardware;

impl Board for Hardware {
    type Peripherals = (rtic::export::Peripherals, pac::Peripherals);
    type ScalarPort = ScalarPort;
    type NmeaPort = NmeaPort;
    type SensorTransmitters = SensorTransmitters;
    type CableTransmitter = CableTransmitter;
    type CableReceiver = Rx<pac::USART2>;
    type DataReady = DataReady;
    type SecondPulses = NoPulses;
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
        retained_ram::begin(reset_cause(), storage::load_retained);
        let settings = SettingsInFlash::open(SettingsFlash::open(), SETTINGS);
        let mut rcc = device.RCC.freeze(clocks());
        // A timer of QEMU 7.2 adds the time of its last beginning to every period, unless that seems to be the
        // emulation's own: so the stopwatch counts from there, and the others from what it shows. Not yet divided, it
        // counts nanoseconds.
        let first_us = device.TIM2.cnt().read().bits() / 1_000;
        start_stopwatch(device.TIM2, &mut rcc, TIMER_MHZ, first_us);
        let meter = Meter::start(core.SYST, cost::waited);
        cost::count_known_loop();
        let (pa, pb, pc) = (device.GPIOA.split(&mut rcc), device.GPIOB.split(&mut rcc), device.GPIOC.split(&mut rcc));
        let BodySettings { scalar_baud, cable_baud, nmea: NmeaSettings { baud, .. }, .. } = settings.stored.settings;
        let (scalar, scalar_rx) = serial::scalar(device.USART1, (pa.pa9, pa.pa10), scalar_baud, &mut rcc);
        let (nmea, nmea_rx) = serial::nmea(device.USART3, (pb.pb10, pb.pb11), baud, &mut rcc);
        let (cable_transmitter, cable_receiver) = serial::cable(device.USART2, (pa.pa2, pa.pa3), cable_baud, &mut rcc);
        let data_ready =
            DataReady::start(device.TIM5, &mut rcc, TIMER_MHZ, settings.stored.settings.grid.conversions_per_epoch);
        Parts {
            scalar_port: ScalarPort(scalar_rx),
            nmea_port: NmeaPort(nmea_rx),
            sensor_transmitters: SensorTransmitters { scalar, nmea },
            cable_transmitter,
            cable_receiver,
            data_ready,
            second_pulses: NoPulses,
            fluxgate_bus: FluxgateBus::open(),
            card: LogCard::open(),
            settings,
            lights: LightPins {
                green: pc.pc0.into_push_pull_output().erase(),
                yellow: pc.pc1.into_push_pull_output().erase(),
                red: pc.pc2.into_push_pull_output().erase(),
            },
            housekeeping: HousekeepingInputs,
            ticker: Ticker::start(device.TIM4, &mut rcc, TIMER_MHZ, now_us() as u16),
            // Which the emulator has no model of: nothing starts it.
            watchdog: Watchdog(device.IWDG),
            meter,
            system: System::new(),
            clock: ClockCheck::default(),
        }
    }
}
