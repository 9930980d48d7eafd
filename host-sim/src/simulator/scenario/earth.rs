//! The Earth's field of a scenario, and what changes it slowly.

use std::f64::consts::TAU;

use rand::RngExt;
use towmag_import::earth_model::{north_east_down_nt, total_nt};
use world_magnetic_model::time::{Date, Month};

use super::{Background, Field, TargetSpec};
use crate::effects::Draw;
use crate::simulator::Target;

/// Magnitude and direction of the field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Earth {
    pub(super) strength_nt: f64,
    /// Unit vector north, east, down.
    pub(super) direction: [f64; 3],
}

impl Field {
    /// The field at the place. The error says what is wrong with place or date.
    pub(super) fn resolve(&self) -> Result<Earth, String> {
        if let (Some(latitude_deg), Some(longitude_deg), Some(date)) =
            (self.latitude_deg, self.longitude_deg, &self.date)
        {
            return self.modelled(latitude_deg, longitude_deg, date);
        }
        let (sin_i, cos_i) = libm::sincos(self.inclination_deg.unwrap_or(0.0).to_radians());
        let (sin_d, cos_d) = libm::sincos(self.declination_deg.unwrap_or(0.0).to_radians());
        let direction = [cos_i * cos_d, cos_i * sin_d, sin_i];
        Ok(Earth { strength_nt: self.strength_nt.unwrap_or(50_000.0), direction })
    }

    fn modelled(&self, latitude_deg: f64, longitude_deg: f64, date: &str) -> Result<Earth, String> {
        let day = parse_date(date).ok_or_else(|| format!("field.date: \"{date}\" is no day, YYYY-MM-DD"))?;
        let north_east_down = north_east_down_nt([latitude_deg, longitude_deg], self.height_m, day)
            .map_err(|error| format!("field: {error}"))?;
        let length_nt = total_nt(north_east_down);
        let direction = north_east_down.map(|b| b / length_nt);
        Ok(Earth { strength_nt: self.strength_nt.unwrap_or(length_nt), direction })
    }
}

impl Field {
    /// Seconds since 1970-01-01 UTC of the first row. The error says what is wrong with date or time.
    pub(super) fn first_utc_s(&self) -> Result<f64, String> {
        let date = self.date.as_deref().unwrap_or_default();
        let day = parse_date(date).ok_or_else(|| format!("field.date: \"{date}\" is no day, YYYY-MM-DD"))?;
        let time = self.time.as_deref().unwrap_or("00:00:00");
        let of_day_s = parse_time(time).ok_or_else(|| format!("field.time: \"{time}\" is no time, hh:mm:ss"))?;
        // 1970-01-01 is Julian day 2,440,588.
        Ok(f64::from(day.to_julian_day() - 2_440_588) * 86_400.0 + f64::from(of_day_s))
    }
}

fn parse_time(text: &str) -> Option<u32> {
    let mut parts = text.split(':').map(|part| part.parse::<u32>().ok());
    let (hours, minutes, seconds) = (parts.next()??, parts.next()??, parts.next()??);
    (parts.next().is_none() && hours < 24 && minutes < 60 && seconds < 60)
        .then_some(3600 * hours + 60 * minutes + seconds)
}

fn parse_date(text: &str) -> Option<Date> {
    let mut parts = text.split('-').map(|part| part.parse::<u16>().ok());
    let (year, month, day) = (parts.next()??, parts.next()??, parts.next()??);
    let month = Month::try_from(u8::try_from(month).ok()?).ok()?;
    if parts.next().is_some() {
        return None;
    }
    Date::from_calendar_date(i32::from(year), month, u8::try_from(day).ok()?).ok()
}

/// Geology, diurnal change and targets as a function of time.
pub(super) struct Slow {
    /// Amplitude, turns per second times 2 pi, phase.
    sines: Vec<(f64, f64, f64)>,
    diurnal_nt_per_s: f64,
    targets: Vec<Target>,
}

/// Sines of the geology.
const SINES: usize = 12;
/// Longest period of the geology over the shortest.
const SPAN: f64 = 20.0;

impl Slow {
    pub(super) fn new(background: &Background, targets: &[TargetSpec], draw: &mut Draw) -> Self {
        let mut sines: Vec<_> = (0..SINES)
            .map(|k| {
                // Spread over the logarithm of the period, the amplitude rising with it, as rock does.
                let share = (k as f64 + draw.random::<f64>()) / SINES as f64;
                let period_s = background.geology_shortest_period_s * libm::pow(SPAN, share);
                (libm::sqrt(period_s), TAU / period_s, TAU * draw.random::<f64>())
            })
            .collect();
        let rms = sines.iter().map(|(a, _, _)| 0.5 * a * a).sum::<f64>().sqrt();
        sines.iter_mut().for_each(|(a, _, _)| *a *= background.geology_rms_nt / rms);
        let target = |t: &TargetSpec| Target { time_s: t.at_s, peak_nt: t.peak_nt, width_s: t.width_s };
        let diurnal_nt_per_s = background.diurnal_nt_per_h / 3600.0;
        Self { sines, diurnal_nt_per_s, targets: targets.iter().map(target).collect() }
    }

    /// What is added to the field, nT.
    pub(super) fn at(&self, time_s: f64) -> f64 {
        let geology: f64 = self.sines.iter().map(|(a, omega, phase)| a * libm::sin(omega * time_s + phase)).sum();
        let targets: f64 = self.targets.iter().map(|target| target.anomaly_nt(time_s)).sum();
        geology + self.diurnal_nt_per_s * time_s + targets
    }
}
