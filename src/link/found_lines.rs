//! What a calibration found, line by line.

use super::found::{CalibrationSummary, Found};
use crate::fluxgate_calibration::FluxgateResult;
use crate::model::{TERM_NAMES, TERM_UNITS};
use core::fmt::Write;

/// 95 % of a normal distribution lie within this many standard deviations. What the model does not know is in none of them,
/// so that the answer does not speak of 95 %.
const STD_95: f64 = 1.96;

/// Line `number`, counted from 0; `None` after the last.
pub(super) fn put_found(line: &mut impl Write, found: &Found, number: usize) -> Option<core::fmt::Result> {
    match found {
        Found::Terms(summary) => put_terms(line, summary, number),
        Found::Fluxgate(result) => put_fluxgate(line, result, number),
    }
}

/// One line of the whole, then one per coefficient, then what to do.
fn put_terms(line: &mut impl Write, summary: &CalibrationSummary, number: usize) -> Option<core::fmt::Result> {
    let CalibrationSummary { improvement_ratio, condition_number, used_epochs, std_before_nt, rms_after_nt, .. } =
        *summary;
    let term = number.wrapping_sub(2);
    Some(match number {
        0 => write!(
            line,
            "improvement ratio {improvement_ratio:.2}: {std_before_nt:.3} nT before, {rms_after_nt:.3} nT after"
        ),
        1 => {
            // The formatting of a second type would be a kilobyte.
            let condition_number = f64::from(condition_number);
            write!(line, "condition number {condition_number:.0}, {used_epochs} epochs; coefficients +- 1.96 std:")
        }
        20 => line.write_str("keep it with calibrate accept yes, or calibrate discard yes"),
        _ => {
            let (name, unit) = (TERM_NAMES.get(term)?, TERM_UNITS.get(term)?);
            let value = summary.coefficients.to_paper_units().get(term).copied()?;
            let half_width = STD_95 * summary.std.get(term)?;
            write!(line, "{name}: {value:.3e} +- {half_width:.1e} {unit}")
        }
    })
}

/// One line of the whole, one per axis, the angles, then what to do.
fn put_fluxgate(line: &mut impl Write, result: &FluxgateResult, number: usize) -> Option<core::fmt::Result> {
    let FluxgateResult { used_epochs, rms_before_nt, rms_after_nt, angles_deg, .. } = *result;
    Some(match number {
        0 => write!(
            line,
            "fluxgate less scalar: {rms_before_nt:.2} nT rms before, {rms_after_nt:.2} nT after, {used_epochs} epochs; \
             +- 1.96 std:"
        ),
        1..=3 => put_axis(line, result, number - 1)?,
        4 => {
            let [xy, xz, yz] = angles_deg;
            let half_width = STD_95 * result.angle_std_deg.into_iter().fold(0.0, f64::max);
            write!(line, "angles: xy {xy:.4}, xz {xz:.4}, yz {yz:.4} +- {half_width:.1e} deg")
        }
        5 => line.write_str(
            "keep it with calibrate accept yes, which sets the coefficients to zero, or calibrate discard yes",
        ),
        _ => return None,
    })
}

fn put_axis(line: &mut impl Write, result: &FluxgateResult, axis: usize) -> Option<core::fmt::Result> {
    let name = ["x", "y", "z"].get(axis)?;
    let (bias_nt, bias_std_nt) = (result.settings.bias_nt.get(axis)?, result.bias_std_nt.get(axis)?);
    let (ratio, scale_std) = (result.scale_ratios.get(axis)?, result.scale_std.get(axis)?);
    let (bias_half, percent, scale_half) = (STD_95 * bias_std_nt, 100.0 * (ratio - 1.0), 196.0 * scale_std);
    Some(write!(
        line,
        "sensor {name}: offset {bias_nt:.2} +- {bias_half:.1e} nT, scale {percent:+.4} +- {scale_half:.1e} %"
    ))
}
