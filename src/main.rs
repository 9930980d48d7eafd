//! The firmware: tasks that move data between the sensors, the core, the log and the cable.
//!
//! | priority | task | bound to | moves |
//! |---|---|---|---|
//! | 5 | `scalar` | USART1 | bytes of the scalar sensor -> readings |
//! | 4 | `fluxgate` | data-ready of the converter | SPI frame -> conversion |
//! | 3 | `assemble` | TIM4, 25 Hz | readings and conversions -> epochs; feeds the watchdog |
//! | 3 | `cable` | USART2 | bytes to and from the tow cable |
//! | 2 | `compensate` | spawned | epoch -> output -> log queue and cable |
//! | 2 | `console` | spawned | lines from the ship -> commands -> answers; calibration, settings, clock |
//! | 1 | `storage` | spawned | log queue -> card; the only one that may wait |
//! | 0 | `idle` | | sleeps, and counts what an epoch costs |
//!
//! Queues are bounded, and what finds one full is counted. Nothing is allocated. What the hardware is like, only
//! `board` knows.
#![no_std]
#![no_main]
#![deny(unsafe_code)]
#![allow(unreachable_pub)] // RTIC makes traits of the shared resources that their types must be visible in

mod board;
mod console;
mod journal;
mod status;
mod storage;
mod telemetry;

#[rtic::app(device = stm32f4xx_hal::pac, peripherals = true, dispatchers = [UART4, UART5])]
mod app {
    use crate::board::{
        self, Board, CableRx, CableTx, DataReady, FluxgateBus, Lamps, LogCard, ScalarPort, Source, Ticker,
    };
    use crate::console::{Console, Desk, InboxQueue, NoticeQueue};
    use crate::journal::Journal;
    use crate::status::{Count, STATUS, Task};
    use crate::storage::Storage;
    use crate::telemetry::{DriverFaults, Outbox, OutboxQueue};
    use core::mem::MaybeUninit;
    use heapless::spsc::{Consumer, Producer, Queue};
    use towmag::Pipeline;
    use towmag::body::{Clock, Conversion, Converter};
    use towmag::lights::lights;
    use towmag::link::{CalibrationSession, SessionState};
    use towmag::log::{Drain, Feeder, RecordQueue};
    use towmag::sensors::grid::{Grid, GridState, MarkedEpoch};
    use towmag::sensors::scalar::{Reading, ScalarReader};

    const READINGS: usize = 8;
    const CONVERSIONS: usize = 64;
    const EPOCHS: usize = 32;

    #[shared]
    struct Shared {
        cable_tx: CableTx,
        faults: DriverFaults,
        desk: Desk<'static>,
    }

    #[local]
    struct Local {
        reader: ScalarReader<ScalarPort>,
        readings_in: Producer<'static, Reading>,
        data_ready: DataReady,
        converter: Converter<FluxgateBus>,
        conversions_in: Producer<'static, Conversion>,
        assembler: Assembler,
        ticker: Ticker,
        watchdog: board::Watchdog,
        epochs_in: Producer<'static, MarkedEpoch>,
        compensator: Compensator,
        outbox_out: Consumer<'static, u8>,
        cable_rx: CableRx,
        inbox_in: Producer<'static, Option<u8>>,
        console: Console<'static>,
        storage: Storage<LogCard>,
        drain: Drain<'static>,
        meter: board::Meter,
    }

    /// What `assemble` holds.
    pub struct Assembler {
        grid: Grid,
        state: GridState,
        readings: Consumer<'static, Reading>,
        conversions: Consumer<'static, Conversion>,
    }

    /// What `compensate` holds.
    pub struct Compensator {
        pipeline: &'static mut Pipeline,
        journal: Journal<'static>,
        lamps: Lamps,
        epochs: Consumer<'static, MarkedEpoch>,
    }

    #[init(local = [
        readings: Queue<Reading, READINGS> = Queue::new(),
        conversions: Queue<Conversion, CONVERSIONS> = Queue::new(),
        epochs: Queue<MarkedEpoch, EPOCHS> = Queue::new(),
        records: RecordQueue = RecordQueue::new(),
        outgoing: OutboxQueue = OutboxQueue::new(),
        inbox: InboxQueue = InboxQueue::new(),
        notices: NoticeQueue = NoticeQueue::new(),
        pipeline: MaybeUninit<Option<Pipeline>> = MaybeUninit::uninit(),
    ])]
    fn init(cx: init::Context) -> (Shared, Local) {
        let board = Board::new(cx.core, cx.device);
        let stored = board.keeper.stored;
        let pipeline = crate::storage::build_pipeline(cx.local.pipeline, &stored);
        let built = crate::storage::build(&stored.settings);
        let (readings_in, readings) = cx.local.readings.split();
        let (conversions_in, conversions) = cx.local.conversions.split();
        let (epochs_in, epochs) = cx.local.epochs.split();
        let (records_in, records) = cx.local.records.split();
        let (outgoing_in, outbox_out) = cx.local.outgoing.split();
        let (inbox_in, inbox) = cx.local.inbox.split();
        let (notices_in, notices) = cx.local.notices.split();
        let console = Console::new(inbox, notices_in, board.keeper);
        let assembler = Assembler { grid: built.grid, state: GridState::new(), readings, conversions };
        let journal = Journal::new(Feeder::new(records_in));
        let compensator = Compensator { pipeline, journal, lamps: board.lamps, epochs };
        let clock = board::time().map(|unix_ms| Clock::set(unix_ms, board::stamp_us(Source::Other)));
        let desk = Desk { session: CalibrationSession::new(), clock, outbox: Outbox::new(outgoing_in), tick: 0 };
        let shared = Shared { cable_tx: board.cable_tx, faults: DriverFaults::default(), desk };
        let local = Local {
            reader: ScalarReader::new(board.scalar_port, built.parser),
            readings_in,
            data_ready: board.data_ready,
            converter: Converter::new(board.fluxgate_bus),
            conversions_in,
            assembler,
            ticker: board.ticker,
            watchdog: board.watchdog,
            epochs_in,
            compensator,
            outbox_out,
            cable_rx: board.cable_rx,
            inbox_in,
            console,
            storage: Storage::new(board.card, &stored, notices),
            drain: Drain::new(records),
            meter: board.meter,
        };
        (shared, local)
    }

    #[task(binds = USART1, priority = 5, local = [reader, readings_in], shared = [faults])]
    fn scalar(mut cx: scalar::Context) {
        let cost = board::Preempting::begin();
        let now_us = board::stamp_us(Source::ScalarByte);
        while let Some(reading) = cx.local.reader.poll(now_us) {
            Count::ReadingsLost.unless(cx.local.readings_in.enqueue(reading).is_ok());
        }
        let faults = *cx.local.reader.faults();
        STATUS.set(Count::UartOverruns, faults.overruns);
        cx.shared.faults.lock(|all| all.scalar = faults);
        cost.end();
    }

    #[cfg(feature = "emulation")]
    #[task(binds = TIM5, priority = 4)]
    fn data_ready_edge(_: data_ready_edge::Context) {
        board::bridge_data_ready();
    }

    #[task(binds = EXTI9_5, priority = 4, local = [data_ready, converter, conversions_in], shared = [faults])]
    fn fluxgate(mut cx: fluxgate::Context) {
        let mut delay = board::SpinDelay;
        let converter = cx.local.converter;
        match cx.local.data_ready.take() {
            Some(ready_us) => {
                if let Some(conversion) = converter.fetch(ready_us, &mut delay) {
                    STATUS.conversion_came();
                    Count::ConversionsLost.unless(cx.local.conversions_in.enqueue(conversion).is_ok());
                }
            }
            // Nothing is ready: `assemble` has missed the converter, which may have no set-up.
            None => _ = converter.set_up(board::stamp_us(Source::SetUp), &mut delay),
        }
        let faults = *converter.faults();
        STATUS.set(Count::FluxgateCrcErrors, faults.crc);
        cx.shared.faults.lock(|all| all.converter = faults);
    }

    #[task(binds = TIM4, priority = 3, local = [assembler, ticker, watchdog, epochs_in], shared = [faults])]
    fn assemble(mut cx: assemble::Context) {
        cx.local.ticker.acknowledge();
        let now_us = board::stamp_us(Source::Poll);
        let Assembler { grid, state, readings, conversions } = cx.local.assembler;
        while let Some(reading) = readings.dequeue() {
            grid.push_scalar(state, &reading);
        }
        while let Some(Conversion { counts, ready_us }) = conversions.dequeue() {
            grid.push_flux(state, counts, ready_us);
        }
        while let Some(epoch) = grid.poll(state, now_us) {
            STATUS.epoch_made();
            Count::EpochsLost.unless(cx.local.epochs_in.enqueue(epoch).is_ok());
            let counters = *state.counters();
            cx.shared.faults.lock(|all| all.grid = counters);
        }
        // Refused while it still runs: then it finds the epoch itself, or is spawned the next time.
        _ = compensate::spawn();
        _ = console::spawn();
        _ = storage::spawn();
        if STATUS.converter_is_silent() {
            board::poke_fluxgate();
        }
        STATUS.ran(Task::Assemble);
        cx.local.watchdog.feed_if(STATUS.all_ran());
    }

    #[task(priority = 2, local = [compensator], shared = [cable_tx, faults, desk])]
    async fn compensate(mut cx: compensate::Context) {
        let Compensator { pipeline, journal, lamps, epochs } = cx.local.compensator;
        while let Some(marked) = epochs.dequeue() {
            let output = pipeline.step(&marked.epoch);
            let program = STATUS.program_faults();
            let faults = cx.shared.faults.lock(|drivers| drivers.all(&program));
            cx.shared.desk.lock(|desk| {
                desk.tick = marked.epoch.tick;
                desk.session.step(&marked.epoch);
                let unix_ms = desk.clock.as_mut().map(|clock| clock.unix_ms(marked.marks.instant_us));
                journal.write(&marked, output, unix_ms);
                let calibrates = matches!(desk.session.state(), SessionState::Running { .. });
                let activity = STATUS.activity(calibrates);
                lamps.show(lights(marked.epoch.tick, output.status, &marked.marks, activity, board::faults() > 0));
                desk.outbox.epoch(&marked, &output, unix_ms, activity, &faults);
                if STATUS.is_due(marked.epoch.tick) {
                    desk.outbox.figures(&STATUS);
                }
            });
            cx.shared.cable_tx.lock(CableTx::wake);
        }
        STATUS.ran(Task::Compensate);
    }

    #[task(priority = 2, local = [console], shared = [cable_tx, faults, desk])]
    async fn console(mut cx: console::Context) {
        let program = STATUS.program_faults();
        let faults = cx.shared.faults.lock(|drivers| drivers.all(&program));
        let console = cx.local.console;
        let answers = cx.shared.desk.lock(|desk| {
            console.run(desk, &faults);
            !desk.outbox.is_empty()
        });
        if answers {
            cx.shared.cable_tx.lock(CableTx::wake);
        }
    }

    #[task(binds = USART2, priority = 3, local = [cable_rx, inbox_in, outbox_out], shared = [cable_tx])]
    fn cable(mut cx: cable::Context) {
        let inbox = cx.local.inbox_in;
        cx.local.cable_rx.drain(|byte| Count::CableOverruns.unless(inbox.enqueue(byte).is_ok()));
        let outgoing = cx.local.outbox_out;
        cx.shared.cable_tx.lock(|tx| tx.send(|| outgoing.dequeue()));
    }

    #[task(priority = 1, local = [storage, drain])]
    async fn storage(cx: storage::Context) {
        cx.local.storage.write(cx.local.drain, board::stamp_us(Source::Other));
        STATUS.ran(Task::Storage);
    }

    #[idle(local = [meter])]
    fn idle(cx: idle::Context) -> ! {
        loop {
            cx.local.meter.sleep(STATUS.epochs());
        }
    }
}
