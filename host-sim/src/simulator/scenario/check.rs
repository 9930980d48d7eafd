//! Ranges of a scenario's values.

use std::ops::RangeInclusive;

use super::range::within;
use super::{Current, Field, InterferenceSource, Interval, Motion, Scenario, Sensor, Tow};

/// At least some periods of the motion, at most a day.
const DURATION_S: RangeInclusive<f64> = 10.0..=86_400.0;
const STRENGTH_NT: RangeInclusive<f64> = 1_000.0..=100_000.0;
/// So that geology stays below 0.02 Hz.
const GEOLOGY_PERIOD_S: RangeInclusive<f64> = 50.0..=10_000.0;

impl Scenario {
    /// Whether every value is one that the simulation can take.
    pub fn check(&self) -> Result<(), String> {
        within("duration_s", self.duration_s, DURATION_S)?;
        within("first_time_s", self.first_time_s, -1e9..=1e12)?;
        self.field.check()?;
        within("background.geology_rms_nT", self.background.geology_rms_nt, 0.0..=10_000.0)?;
        let period_s = self.background.geology_shortest_period_s;
        within("background.geology_shortest_period_s", period_s, GEOLOGY_PERIOD_S)?;
        within("background.diurnal_nT_per_h", self.background.diurnal_nt_per_h, -1_000.0..=1_000.0)?;
        self.motion.check()?;
        self.interference.check("interference")?;
        self.scalar.check("scalar")?;
        self.fluxgate.check("fluxgate")?;
        if let Some(second) = &self.scalar2 {
            within("scalar2.ahead_m", second.ahead_m, -100.0..=100.0)?;
            second.interference.check("scalar2.interference")?;
            second.sensor.check("scalar2.sensor")?;
        }
        self.check_optional()?;
        if self.columns.depth && matches!(self.motion, Motion::LandCalibration { .. }) {
            return Err("columns.depth: a body on land has no depth: leave it out".into());
        }
        self.check_survey()
    }

    fn check_optional(&self) -> Result<(), String> {
        if let Some(zone) = &self.dead_zone {
            within("dead_zone.axis_azimuth_deg", zone.axis_azimuth_deg, -360.0..=360.0)?;
            within("dead_zone.axis_elevation_deg", zone.axis_elevation_deg, -90.0..=90.0)?;
            within("dead_zone.half_angle_deg", zone.half_angle_deg, 0.0..=90.0)?;
        }
        if let Some(temperature) = &self.temperature {
            within("temperature.first_degC", temperature.first_deg_c, -60.0..=90.0)?;
            within("temperature.final_degC", temperature.final_deg_c, -60.0..=90.0)?;
            within("temperature.time_constant_s", temperature.time_constant_s, 1.0..=1e6)?;
        }
        for target in &self.targets {
            within("target.at_s", target.at_s, -1e5..=1e5)?;
            within("target.peak_nT", target.peak_nt, -10_000.0..=10_000.0)?;
            within("target.width_s", target.width_s, 0.05..=1_000.0)?;
        }
        self.gaps.iter().try_for_each(|gap| gap.check("gap"))?;
        self.dropouts.iter().try_for_each(|dropout| dropout.check("dropout"))?;
        for (index, current) in self.currents.iter().enumerate() {
            current.check()?;
            if self.currents[..index].iter().any(|other| other.name == current.name) {
                return Err(format!("current: {} is there twice", current.name));
            }
        }
        Ok(())
    }
}

impl Field {
    fn check(&self) -> Result<(), String> {
        let place = [self.latitude_deg.is_some(), self.longitude_deg.is_some(), self.date.is_some()];
        let angles = [self.inclination_deg.is_some(), self.declination_deg.is_some()];
        let is_model = place == [true; 3] && angles == [false; 2];
        let is_given = place == [false; 3] && angles == [true; 2] && self.strength_nt.is_some();
        if !is_model && !is_given {
            return Err("field: give latitude_deg, longitude_deg and date (and strength_nT where it was measured), \
                        or else strength_nT, inclination_deg and declination_deg"
                .into());
        }
        within("field.latitude_deg", self.latitude_deg.unwrap_or(0.0), -90.0..=90.0)?;
        within("field.longitude_deg", self.longitude_deg.unwrap_or(0.0), -180.0..=180.0)?;
        within("field.height_m", self.height_m, -1_000.0..=100_000.0)?;
        within("field.strength_nT", self.strength_nt.unwrap_or(50_000.0), STRENGTH_NT)?;
        within("field.inclination_deg", self.inclination_deg.unwrap_or(0.0), -90.0..=90.0)?;
        within("field.declination_deg", self.declination_deg.unwrap_or(0.0), -180.0..=180.0)
    }
}

impl Motion {
    fn check(&self) -> Result<(), String> {
        match self {
            Self::LandCalibration { headings, leg_s, turn_s, rocking_period_s, shake_rms_deg, shake_s, .. } => {
                if ![4, 8].contains(headings) {
                    return Err(format!("motion.headings: {headings} is neither 4 nor 8"));
                }
                within("motion.leg_s", *leg_s, 10.0..=10_000.0)?;
                within("motion.turn_s", *turn_s, 2.0..=10_000.0)?;
                within("motion.rocking_period_s", *rocking_period_s, 1.0..=30.0)?;
                within("motion.shake_rms_deg", *shake_rms_deg, 0.0..=15.0)?;
                within("motion.shake_s", *shake_s, 0.0..=0.8 * leg_s)?;
            }
            Self::LakeTow { tow, longest_period_s, shortest_period_s, depth_rms_m, .. } => {
                tow.check()?;
                within("motion.shortest_period_s", *shortest_period_s, 0.8..=100.0)?;
                within("motion.longest_period_s", *longest_period_s, *shortest_period_s..=200.0)?;
                within("motion.depth_rms_m", *depth_rms_m, 0.0..=100.0)?;
            }
            Self::SeaTow { tow, significant_height_m, peak_period_s, wave_from_deg, heave_per_wave, .. } => {
                tow.check()?;
                within("motion.significant_height_m", *significant_height_m, 0.01..=20.0)?;
                within("motion.peak_period_s", *peak_period_s, 2.5..=25.0)?;
                within("motion.wave_from_deg", *wave_from_deg, -360.0..=360.0)?;
                within("motion.heave_per_wave", *heave_per_wave, 0.0..=3.0)?;
            }
        }
        within("motion.speed_m_per_s", self.speed_m_per_s().unwrap_or(0.0), 0.0..=10.0)?;
        self.axes_rms_deg().into_iter().try_for_each(|(key, rms_deg)| within(key, rms_deg, 0.0..=30.0))
    }

    fn axes_rms_deg(&self) -> [(&'static str, f64); 3] {
        let (Self::LandCalibration { roll_rms_deg, pitch_rms_deg, yaw_rms_deg, .. }
        | Self::LakeTow { tow: Tow { roll_rms_deg, pitch_rms_deg, yaw_rms_deg, .. }, .. }
        | Self::SeaTow { tow: Tow { roll_rms_deg, pitch_rms_deg, yaw_rms_deg, .. }, .. }) = self;
        [
            ("motion.roll_rms_deg", *roll_rms_deg),
            ("motion.pitch_rms_deg", *pitch_rms_deg),
            ("motion.yaw_rms_deg", *yaw_rms_deg),
        ]
    }
}

impl Tow {
    fn check(&self) -> Result<(), String> {
        within("motion.tow.first_heading_deg", self.first_heading_deg, -360.0..=360.0)?;
        within("motion.tow.leg_s", self.leg_s, 10.0..=100_000.0)?;
        within("motion.tow.turn_s", self.turn_s, 2.0..=10_000.0)?;
        within("motion.tow.turn_deg", self.turn_deg, -360.0..=360.0)?;
        within("motion.tow.depth_m", self.depth_m, 0.0..=12_000.0)
    }
}

impl InterferenceSource {
    fn check(&self, table: &str) -> Result<(), String> {
        if self.coefficients.is_none() && self.uncompensated_std_nt.is_none() {
            return Err(format!("{table}: give coefficients (18 numbers), uncompensated_std_nT, or both"));
        }
        for value in self.coefficients.iter().flatten() {
            within(&format!("{table}.coefficients"), *value, -1e5..=1e5)?;
        }
        let std_nt = self.uncompensated_std_nt.unwrap_or(1.0);
        within(&format!("{table}.uncompensated_std_nT"), std_nt, 0.0..=10_000.0)
    }
}

impl Sensor {
    fn check(&self, table: &str) -> Result<(), String> {
        within(&format!("{table}.noise_rms_nT"), self.noise_rms_nt, 0.0..=10_000.0)?;
        within(&format!("{table}.noise_correlation"), self.noise_correlation, 0.0..=0.999)?;
        within(&format!("{table}.resolution_nT"), self.resolution_nt, 1e-6..=1_000.0)?;
        within(&format!("{table}.decimals"), self.decimals.unwrap_or_default() as f64, 0.0..=9.0)
    }
}

impl Interval {
    fn check(&self, table: &str) -> Result<(), String> {
        within(&format!("{table}.begin_s"), self.begin_s, 0.0..=1e5)?;
        within(&format!("{table}.length_s"), self.length_s, 0.1..=1e5)
    }
}

impl Current {
    fn check(&self) -> Result<(), String> {
        let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if self.name.is_empty() || !self.name.chars().all(is_plain) {
            return Err("current.name: letters, digits and _ only: it becomes a column's name".into());
        }
        within("current.on_A", self.on_a, -1_000.0..=1_000.0)?;
        within("current.off_A", self.off_a, -1_000.0..=1_000.0)?;
        within("current.period_s", self.period_s, 0.2..=1e5)?;
        within("current.duty", self.duty, 0.0..=1.0)?;
        within("current.phase", self.phase, -1.0..=1.0)
    }
}
