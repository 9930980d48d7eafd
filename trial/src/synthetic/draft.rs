//! One world of one recording, and the streams of chance that it is made of.

use rand::RngExt;

use crate::limits::LEAST_MINUTES;
use crate::options::TrialOptions;
use crate::random::{self, Random};
use crate::world::target::{self, Dipole};
use crate::world::{Recorder, World};

/// Share of the recordings with targets.
const WITH_TARGETS: f64 = 2.0 / 3.0;
/// Share of the short recordings, and where they end and the long ones do, minutes.
const SHORT: f64 = 0.8;
const SHORT_MINUTES: f64 = 12.0;
const LONG_MINUTES: f64 = 60.0;

/// What a stream of chance is for. The recording and its world come before it.
#[derive(Clone, Copy)]
pub(super) enum For {
    Answer,
    World,
    Motion,
    /// A second motion, which the diagnosis has not seen.
    OtherMotion,
    Noise,
    OtherNoise,
    Columns,
    Recorder,
    Effect(usize),
    Targets,
    /// Those on the second course.
    OtherTargets,
    /// How the targets of either course are passed.
    Passes,
    Length,
    /// The clock of a simulation of the same track.
    Simulation,
    /// What an attitude sensor has wrong.
    Tilt,
}

impl For {
    fn number(self) -> u64 {
        match self {
            Self::Answer => 0,
            Self::World => 1,
            Self::Motion => 2,
            Self::OtherMotion => 3,
            Self::Noise => 4,
            Self::OtherNoise => 5,
            Self::Columns => 6,
            Self::Recorder => 7,
            Self::Effect(slot) => 8 + slot as u64,
            Self::Targets => 32,
            Self::OtherTargets => 33,
            Self::Length => 34,
            Self::Simulation => 35,
            Self::Tilt => 36,
            Self::Passes => 37,
        }
    }
}

/// World `number` of recording `index`.
#[derive(Clone, Copy)]
pub(super) struct Draft<'a> {
    pub(super) options: &'a TrialOptions,
    pub(super) index: usize,
    pub(super) number: u32,
}

impl Draft<'_> {
    pub(super) fn stream(&self, purpose: For) -> Random {
        let number = ((self.index as u64) << 24) | (u64::from(self.number) << 8) | purpose.number();
        random::stream(self.options.seed, number)
    }

    /// How long the recording is, whichever world it is from: as asked for, or mostly short.
    pub(super) fn minutes(&self) -> f64 {
        self.options.minutes.unwrap_or_else(|| {
            let mut draw = Draft { number: 0, ..*self }.stream(For::Length);
            let is_short = draw.random_bool(SHORT);
            let range = if is_short { [LEAST_MINUTES, SHORT_MINUTES] } else { [SHORT_MINUTES, LONG_MINUTES] };
            (600.0 * random::log_uniform(range, &mut draw)).round() / 600.0
        })
    }

    /// The world without targets, moving as one of the streams has it.
    pub(super) fn world(&self, motion: For) -> World {
        let rows = (600.0 * self.minutes()).round() as usize;
        World::draw(rows, self.options.setting, &mut self.stream(For::World), &mut self.stream(motion))
    }

    /// The targets of a course, if the recording has any.
    pub(super) fn dipoles(&self, world: &World, course: For) -> Vec<Dipole> {
        let is_drawn = self.stream(For::Targets).random_bool(WITH_TARGETS);
        let mut draw = self.stream(course);
        _ = draw.random_bool(WITH_TARGETS);
        if !self.options.targets.unwrap_or(is_drawn) {
            return Vec::new();
        }
        let dipoles = target::draw(world, &mut draw);
        if !self.options.rough_passes {
            return dipoles;
        }
        target::passed_roughly(world, dipoles, &mut self.stream(For::Passes))
    }

    pub(super) fn recorder(&self, world: &World) -> Recorder {
        let TrialOptions { recorder, setting, .. } = *self.options;
        Recorder::draw(recorder, setting, world, &mut self.stream(For::Recorder))
    }
}
