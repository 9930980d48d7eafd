//! The firmware: tasks that move data between the sensors, the core, the log and the cable.
//!
//! | priority | task | bound to | moves |
//! |---|---|---|---|
//! | 5 | `scalar` | byte of the scalar sensor | bytes -> readings |
//! | 5 | `nmea` | byte of depth sensor, altimeter or GPS receiver | bytes -> reports of where the body is |
//! | 4 | `fluxgate` | data-ready of the converter | SPI frame -> conversion |
//! | 3 | `assemble` | timer, 25 Hz | readings and conversions -> epochs; feeds the watchdog |
//! | 3 | `cable` | byte to or from the ship | bytes to and from the tow cable |
//! | 2 | `compensate` | spawned | epoch -> output -> log queue and cable |
//! | 2 | `console` | spawned | lines from the ship -> commands -> answers; calibration, settings, clock |
//! | 1 | `storage` | spawned | log queue -> card; the only one that may wait |
//! | 0 | `idle` | | sleeps, and counts what an epoch costs |
//!
//! Queues are bounded, and what finds one full is counted. Nothing is allocated. What a task does is in the library, where
//! tests run it; what the hardware is like, and which interrupt runs which task, only `board` knows.
#![no_std]
#![no_main]
#![deny(unsafe_code)]
#![allow(unreachable_pub)] // RTIC makes traits of the shared resources that their types must be visible in

mod board;

#[rtic::app(device = crate::board::vectors, peripherals = true, dispatchers = [SOFTWARE_1, SOFTWARE_2])]
mod app {
    use crate::board::Hardware;
    use core::mem::MaybeUninit;
    use heapless::spsc::Consumer;
    use towmag::Pipeline;
    use towmag::acquire::{FluxgateInput, NmeaInput, ScalarInput};
    use towmag::assemble::Assembler;
    use towmag::body::{Firmware, build_pipeline};
    use towmag::compensate::Compensator;
    use towmag::connect::connect;
    use towmag::console::{Console, ConsoleContext, Inbox, receive};
    use towmag::hardware::{Board, LightOutput as _, Meter as _, SecondPulses as _, Ticker as _, Watchdog as _};
    use towmag::health::{Health, Task};
    use towmag::queues::Queues;
    use towmag::storage::Storage;
    use towmag::telemetry::CableSender;

    type System = <Hardware as Board>::System;

    const FIRMWARE: Firmware = Firmware { version: env!("CARGO_PKG_VERSION"), commit: env!("TOWMAG_COMMIT") };

    /// The one health of the body.
    static HEALTH: Health = Health::new();

    #[shared]
    struct Shared {
        sender: CableSender<<Hardware as Board>::CableTransmitter>,
        context: ConsoleContext<'static>,
    }

    #[local]
    struct Local {
        scalar_input: ScalarInput<'static, <Hardware as Board>::ScalarPort, System>,
        nmea_input: NmeaInput<'static, <Hardware as Board>::NmeaPort, System>,
        fluxgate_input:
            FluxgateInput<'static, <Hardware as Board>::FluxgateBus, <Hardware as Board>::DataReady, System>,
        assembler: Assembler<'static, System>,
        ticker: <Hardware as Board>::Ticker,
        watchdog: <Hardware as Board>::Watchdog,
        compensator: Compensator<'static, System>,
        second_pulses: <Hardware as Board>::SecondPulses,
        lights: <Hardware as Board>::LightOutput,
        housekeeping: <Hardware as Board>::HousekeepingInputs,
        to_ship: Consumer<'static, u8>,
        receiver: <Hardware as Board>::CableReceiver,
        from_ship: Inbox<'static>,
        system: System,
        console: Console<'static, <Hardware as Board>::SettingsFlash, <Hardware as Board>::SensorTransmitters, System>,
        storage: Storage<'static, <Hardware as Board>::Card, System>,
        meter: <Hardware as Board>::Meter,
    }

    #[init(local = [
        queues: Queues = Queues::new(),
        pipeline: MaybeUninit<Option<Pipeline>> = MaybeUninit::uninit(),
    ])]
    fn init(cx: init::Context) -> (Shared, Local) {
        let parts = Hardware::start((cx.core, cx.device));
        defmt::info!("towmag {=str}, commit {=str}", FIRMWARE.version, FIRMWARE.commit);
        let stored = &parts.settings.stored;
        HEALTH.begin(&parts.system, &stored.settings);
        let pipeline = build_pipeline(cx.local.pipeline, stored);
        let ready = connect(parts, pipeline, cx.local.queues, &FIRMWARE, &HEALTH);
        let shared = Shared { sender: ready.sender, context: ready.context };
        let local = Local {
            scalar_input: ready.scalar_input,
            nmea_input: ready.nmea_input,
            fluxgate_input: ready.fluxgate_input,
            assembler: ready.assembler,
            ticker: ready.ticker,
            watchdog: ready.watchdog,
            compensator: ready.compensator,
            second_pulses: ready.second_pulses,
            lights: ready.lights,
            housekeeping: ready.housekeeping,
            to_ship: ready.to_ship,
            receiver: ready.receiver,
            from_ship: ready.from_ship,
            system: ready.system,
            console: ready.console,
            storage: ready.storage,
            meter: ready.meter,
        };
        (shared, local)
    }

    #[task(binds = SCALAR, priority = 5, local = [scalar_input])]
    fn scalar(cx: scalar::Context) {
        cx.local.scalar_input.run();
    }

    #[task(binds = FLUXGATE, priority = 4, local = [fluxgate_input])]
    fn fluxgate(cx: fluxgate::Context) {
        cx.local.fluxgate_input.run();
    }

    #[task(binds = ASSEMBLE, priority = 3, local = [assembler, ticker, watchdog])]
    fn assemble(cx: assemble::Context) {
        cx.local.ticker.acknowledge();
        cx.local.assembler.run();
        // Refused while it still runs: then it finds the epoch itself, or is spawned the next time.
        _ = compensate::spawn();
        _ = console::spawn();
        _ = storage::spawn();
        if HEALTH.tasks.all_ran() {
            cx.local.watchdog.feed();
        }
    }

    #[task(priority = 2, local = [compensator, second_pulses, lights, housekeeping], shared = [sender, context])]
    async fn compensate(mut cx: compensate::Context) {
        let compensator = cx.local.compensator;
        if let Some(stamp_us) = cx.local.second_pulses.take() {
            cx.shared.context.lock(|context| context.pulse(stamp_us));
        }
        while let Some(epoch) = compensator.step() {
            let housekeeping = &mut *cx.local.housekeeping;
            let lights = cx.shared.context.lock(|context| compensator.publish(context, &epoch, housekeeping));
            cx.local.lights.show(lights);
            cx.shared.sender.lock(CableSender::wake);
        }
        HEALTH.tasks.ran(Task::Compensate);
    }

    #[task(priority = 2, local = [console], shared = [sender, context])]
    async fn console(mut cx: console::Context) {
        let console = cx.local.console;
        let answers = cx.shared.context.lock(|context| {
            console.run(context);
            !context.outbox.is_empty()
        });
        if answers {
            cx.shared.sender.lock(CableSender::wake);
        }
    }

    // Above the converter, whose set-up takes the time of several bytes.
    #[task(binds = NMEA, priority = 5, local = [nmea_input])]
    fn nmea(cx: nmea::Context) {
        cx.local.nmea_input.run();
    }

    #[task(binds = CABLE, priority = 3, local = [receiver, from_ship, to_ship, system], shared = [sender])]
    fn cable(mut cx: cable::Context) {
        receive(cx.local.receiver, cx.local.from_ship, &HEALTH, cx.local.system);
        let to_ship = cx.local.to_ship;
        cx.shared.sender.lock(|sender| sender.send(|| to_ship.dequeue()));
    }

    #[task(priority = 1, local = [storage])]
    async fn storage(cx: storage::Context) {
        cx.local.storage.run();
    }

    #[idle(local = [meter])]
    fn idle(cx: idle::Context) -> ! {
        loop {
            cx.local.meter.sleep(HEALTH.tasks.epochs(), |cost| HEALTH.set_cost(cost));
        }
    }
}
