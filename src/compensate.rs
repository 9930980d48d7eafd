//! Epochs to outputs, and outputs to the log, the lights and the cable.

use crate::console::ConsoleContext;
use crate::epoch::{EPOCH_US, Output};
use crate::epoch_producer::{EpochNews, EpochProducer};
use crate::hardware::{HousekeepingInputs, System};
use crate::health::{ChipFigures, Health};
use crate::housekeeping::{Alarm, Housekeeper, HousekeepingNews, HousekeepingSettings};
use crate::lights::{Lights, Trouble, lights};
use crate::link::SessionState;
use crate::log::RecordProducer;
use crate::navigation::{NavigationReport, Navigator};
use crate::pipeline::Pipeline;
use crate::sensors::grid::MarkedEpoch;
use crate::sensors::scalar::ChannelSettings;
use heapless::spsc::Consumer;

/// The core between its queues.
pub struct Compensator<'a, S> {
    pipeline: &'a mut Pipeline,
    epochs: Consumer<'a, MarkedEpoch>,
    navigation: NavigationInput<'a>,
    housekeeping: HousekeepingInput,
    records: EpochProducer<'a>,
    health: &'a Health,
    system: S,
}

/// Where the body is, from its sensors.
pub struct NavigationInput<'a> {
    reports: Consumer<'a, NavigationReport>,
    channels: ChannelSettings,
    navigator: Navigator,
}

impl<'a> NavigationInput<'a> {
    /// Nothing is known yet.
    pub fn new(reports: Consumer<'a, NavigationReport>, channels: ChannelSettings) -> Self {
        Self { reports, channels, navigator: Navigator::default() }
    }

    /// What came up to the middle between an epoch and the next, and what came with the epoch itself. Epochs wait for their
    /// readings: what has come since belongs to one that is yet to come.
    fn join(&mut self, marked: &MarkedEpoch) {
        let until_us = marked.marks.instant_us.wrapping_add(EPOCH_US / 2);
        let is_due = |report: &NavigationReport| until_us.wrapping_sub(report.stamp_us) as i32 >= 0;
        while self.reports.peek().is_some_and(is_due) {
            self.reports.dequeue().iter().for_each(|report| self.navigator.take(report));
        }
        let [depth_m, altitude_m] = self.channels.metres(marked.marks.channels);
        self.navigator.take_channels(depth_m, altitude_m, marked.marks.instant_us);
    }
}

/// How the body itself is, from its inputs.
pub struct HousekeepingInput {
    housekeeper: Housekeeper,
    /// Of leak contact and battery, what the cable had no room for yet.
    untold: [Option<Alarm>; 2],
}

impl HousekeepingInput {
    /// Nothing is known yet.
    pub fn new(settings: HousekeepingSettings) -> Self {
        Self { housekeeper: Housekeeper::new(settings), untold: [None; 2] }
    }

    /// The sample of an epoch, where there is anything to sample, and what it comes to.
    fn join(&mut self, inputs: &mut impl HousekeepingInputs) -> Option<HousekeepingNews> {
        let is_fitted = self.housekeeper.is_fitted();
        let news = if is_fitted { self.housekeeper.step(inputs.sample()) } else { None }?;
        for (untold, alarm) in self.untold.iter_mut().zip([news.leak, news.battery]) {
            *untold = alarm.or(*untold);
        }
        Some(news)
    }

    /// Send what is new up the cable; an alarm again at every epoch until there is room for it.
    fn tell(&mut self, news: Option<&HousekeepingNews>, context: &mut ConsoleContext<'_>) {
        if let Some(&HousekeepingNews { housekeeping, .. }) = news {
            context.housekeeping = housekeeping;
            context.outbox.housekeeping(context.tick, housekeeping);
        }
        for untold in &mut self.untold {
            if untold.is_some_and(|alarm| context.outbox.alarm(&alarm)) {
                *untold = None;
            }
        }
    }
}

impl<'a, S: System> Compensator<'a, S> {
    /// The core, what it is fed from, what goes past it, and the queue of the log.
    pub fn new(
        pipeline: &'a mut Pipeline,
        epochs: Consumer<'a, MarkedEpoch>,
        navigation: NavigationInput<'a>,
        housekeeping: HousekeepingInput,
        records: RecordProducer<'a>,
        health: &'a Health,
        system: S,
    ) -> Self {
        let records = EpochProducer::new(records, health);
        Self { pipeline, epochs, navigation, housekeeping, records, health, system }
    }

    /// The next epoch and what the core makes of it; `None` when all are done.
    pub fn step(&mut self) -> Option<(MarkedEpoch, Output)> {
        let marked = self.epochs.dequeue()?;
        let output = self.pipeline.step(&marked.epoch);
        Some((marked, output))
    }

    /// Log an epoch and send it up the cable; the lights that it asks for.
    pub fn publish(
        &mut self,
        context: &mut ConsoleContext<'_>,
        (marked, output): &(MarkedEpoch, Output),
        inputs: &mut impl HousekeepingInputs,
    ) -> Lights {
        let tick = marked.epoch.tick;
        // Before the record of this epoch, which may be lost: that is told with the next.
        let faults = self.health.counts.faults();
        context.tick = tick;
        context.marks = (marked.marks.scalar, marked.marks.flux);
        context.session.step(&marked.epoch);
        let time = context.time_of_day.as_mut().map(|time| time.at(marked.marks.instant_us));
        self.system.keep_time(time);
        self.navigation.join(marked);
        let navigation = self.navigation.navigator.at(marked.marks.instant_us);
        let housekeeping = self.housekeeping.join(inputs);
        let news =
            EpochNews { time, navigation: self.navigation.navigator.news(), housekeeping: housekeeping.as_ref() };
        self.records.write(marked, *output, &news);
        let calibrates = matches!(context.session.state(), SessionState::Running { .. });
        let activity = self.health.activity(calibrates);
        context.outbox.epoch(marked, output, time, activity, &faults);
        context.outbox.navigation(tick, navigation);
        self.housekeeping.tell(housekeeping.as_ref(), context);
        if self.health.figures_are_due(tick) {
            let chip = ChipFigures {
                stack_bytes: self.system.most_stack_used(),
                ticks_of_known_loop: self.system.ticks_of_known_loop(),
            };
            context.outbox.figures(&self.health.figures(chip));
        }
        let trouble = if self.housekeeping.housekeeper.has_leak() { Trouble::Leak } else { self.health.trouble() };
        lights(tick, output.status, &marked.marks, activity, trouble)
    }
}
