//! What is left, drawn over what drives it: means of parts with equally many rows, each with its 95 % band.

use crate::diagnosis::evidence::interval::TWO_SIGMA;
use crate::diagnosis::result::{CurvePoint, DriverForm, Shape};
use crate::diagnosis::shapes::expression::Expr;
use crate::diagnosis::shapes::scene::Scene;

/// Parts of the driver's range.
const PARTS: usize = 24;
/// Rows that are as good as one: neighbours are alike.
const ROWS_ALIKE: f64 = 10.0;

/// The residual (its size, where only that follows the driver) and the fitted course, over an input.
pub(super) fn shape(
    over: &Expr,
    form: DriverForm,
    course: &[Option<f64>],
    left_nt: &[Option<f64>],
    scene: &Scene,
) -> Option<Shape> {
    let driver = over.evaluate(scene)?;
    let mut rows: Vec<(f64, f64, f64)> = (0..driver.len())
        .filter_map(|row| Some((driver[row], left_nt[row]?, course.get(row).copied().flatten().unwrap_or(0.0))))
        .collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    if rows.len() < 10 * PARTS {
        return None;
    }
    let mean_course = rows.iter().map(|row| row.2).sum::<f64>() / rows.len() as f64;
    let point = |part: usize| {
        let own = &rows[part * rows.len() / PARTS..(part + 1) * rows.len() / PARTS];
        let n = own.len() as f64;
        let of = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / n;
        let mean = of(&mut own.iter().map(|row| row.1));
        let square = of(&mut own.iter().map(|row| (row.1 - mean).powi(2)));
        let alike = (n / ROWS_ALIKE).max(1.0);
        let (value, half) = match form {
            DriverForm::Variance => (square.sqrt(), TWO_SIGMA * square.sqrt() / (2.0 * alike).sqrt()),
            _ => (mean, TWO_SIGMA * (square / alike).sqrt()),
        };
        CurvePoint {
            driver: of(&mut own.iter().map(|row| row.0)),
            left_nt: value,
            band_nt: [value - half, value + half],
            fitted_nt: of(&mut own.iter().map(|row| row.2)) - mean_course,
        }
    };
    Some(Shape { over: label(over), points: (0..PARTS).map(point).collect() })
}

fn label(over: &Expr) -> String {
    match over.name().as_str() {
        "t" => "time since the first row, s".into(),
        "depth" => "depth, m".into(),
        "temperature" => "temperature, degC".into(),
        "cx" => "direction of the field along the body, forward".into(),
        "heading_deg" => "heading, degrees".into(),
        "roll_deg" => "roll, degrees".into(),
        "pitch_deg" => "pitch, degrees".into(),
        other if other.starts_with("cx_") => "direction of the field along the body, forward, as it was before".into(),
        other if other.starts_with("(s") => "reading without its background, nT".into(),
        other if other.starts_with("(cx") => "rate of turning, 1/s".into(),
        other => other.replace('_', " "),
    }
}
