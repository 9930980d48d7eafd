//! What each task works on: its parts of the board, and its ends of the queues.

use crate::acquire::{FluxgateInput, NmeaInput, ScalarInput};
use crate::assemble::{Assembler, AssemblerQueues};
use crate::body::{Built, Firmware, build, tell_clock};
use crate::compensate::{Compensator, HousekeepingInput, NavigationInput};
use crate::console::{Console, ConsoleContext, Inbox};
use crate::hardware::{Board, Parts};
use crate::health::Health;
use crate::log::{RecordConsumer, RecordProducer};
use crate::pipeline::Pipeline;
use crate::queues::Queues;
use crate::self_test::SelfTest;
use crate::storage::{Storage, StorageInput};
use crate::telemetry::{CableSender, Outbox};
use heapless::spsc::Consumer;

/// What each task works on, for any board.
#[expect(missing_docs, reason = "the types say it")]
pub struct Connected<B: Board> {
    pub scalar_input: ScalarInput<'static, B::ScalarPort, B::System>,
    pub nmea_input: NmeaInput<'static, B::NmeaPort, B::System>,
    pub fluxgate_input: FluxgateInput<'static, B::FluxgateBus, B::DataReady, B::System>,
    pub assembler: Assembler<'static, B::System>,
    pub compensator: Compensator<'static, B::System>,
    pub console: Console<'static, B::SettingsFlash, B::SensorTransmitters, B::System>,
    pub context: ConsoleContext<'static>,
    pub storage: Storage<'static, B::Card, B::System>,
    pub sender: CableSender<B::CableTransmitter>,
    pub to_ship: Consumer<'static, u8>,
    pub receiver: B::CableReceiver,
    pub from_ship: Inbox<'static>,
    pub second_pulses: B::SecondPulses,
    pub lights: B::LightOutput,
    pub housekeeping: B::HousekeepingInputs,
    pub ticker: B::Ticker,
    pub watchdog: B::Watchdog,
    pub meter: B::Meter,
    pub system: B::System,
}

/// Give each task its parts of the board and its ends of the queues.
#[inline(always)] // Else its result is copied, and the stack is deepest here, where the pipeline starts.
pub fn connect<B: Board>(
    parts: Parts<B>,
    pipeline: &'static mut Pipeline,
    queues: &'static mut Queues,
    firmware: &Firmware,
    health: &'static Health,
) -> Connected<B> {
    let (system, stored) = (parts.system, &parts.settings.stored);
    let Built { grid, parser, nmea } = build(&stored.settings);
    let (readings_in, readings) = queues.readings.split();
    let (reports_in, reports) = queues.navigation.split();
    let (conversions_in, conversions) = queues.conversions.split();
    let (epochs_in, epochs) = queues.epochs.split();
    let (records_in, records) = queues.records.split();
    let (outbox_in, to_ship) = queues.outbox.split();
    let (from_ship, inbox) = queues.inbox.split();
    let (mut notices_in, notices) = queues.notices.split();
    tell_clock(parts.clock.fault, health, &mut notices_in);
    let (bus, data_ready) = (parts.fluxgate_bus, parts.data_ready);
    let grid_queues = AssemblerQueues { readings, conversions, epochs: epochs_in };
    let navigation = NavigationInput::new(reports, stored.settings.channels);
    let self_test = SelfTest::new(parts.sensor_transmitters, parts.clock);
    let housekeeping = HousekeepingInput::new(stored.settings.housekeeping);
    let records_in = RecordProducer::new(records_in);
    let storage_input = StorageInput { records: RecordConsumer::new(records), notices };
    Connected {
        scalar_input: ScalarInput::new(parts.scalar_port, parser, readings_in, health, system.clone()),
        nmea_input: NmeaInput::new(parts.nmea_port, nmea, reports_in, health, system.clone()),
        fluxgate_input: FluxgateInput::new(bus, data_ready, conversions_in, health, system.clone()),
        assembler: Assembler::new(grid, grid_queues, health, system.clone()),
        compensator: Compensator::new(pipeline, epochs, navigation, housekeeping, records_in, health, system.clone()),
        context: ConsoleContext::new(Outbox::new(outbox_in, health), stored.settings.fluxgate, &system),
        storage: Storage::new(parts.card, storage_input, stored, firmware, health, system.clone()),
        console: Console::new(inbox, notices_in, parts.settings, self_test, firmware, health, system.clone()),
        sender: CableSender::new(parts.cable_transmitter),
        to_ship,
        receiver: parts.cable_receiver,
        from_ship: Inbox::new(from_ship),
        second_pulses: parts.second_pulses,
        lights: parts.lights,
        housekeeping: parts.housekeeping,
        ticker: parts.ticker,
        watchdog: parts.watchdog,
        meter: parts.meter,
        system,
    }
}
