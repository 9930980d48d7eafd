//! A made recording as CSV.

use std::io::{self, Write};

use super::Recorded;
use super::navigation::Navigation;

/// Digits of a scalar reading in the body, which counts picotesla.
const PICOTESLA: usize = 3;

impl Recorded<'_> {
    /// Write header and rows, with the optional columns that the scenario has.
    pub fn write_csv(&self, out: &mut impl Write) -> io::Result<()> {
        let simulation = self.simulation;
        let (scenario, world) = (simulation.scenario(), simulation.signals().trajectory());
        let flags = !scenario.dropouts.is_empty() || scenario.dead_zone.is_some();
        let depth_m = world.depth_m.as_ref().filter(|_| scenario.columns.depth);
        write!(out, "time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT")?;
        write_if(out, flags, ",scalar_valid")?;
        write_if(out, depth_m.is_some(), ",depth_m")?;
        write_if(out, world.temperature_deg_c.is_some(), ",temperature_degC")?;
        write_if(out, scenario.columns.attitude, ",roll_deg,pitch_deg,heading_deg")?;
        world.currents_a.iter().try_for_each(|(load, _)| write!(out, ",current_{load}_A"))?;
        write_if(out, scenario.columns.line, ",line")?;
        let navigation = Navigation::new(simulation);
        navigation.write_names(out)?;
        writeln!(out)?;
        let sent = [&scenario.scalar, &scenario.fluxgate]
            .map(|sensor| Some(sensor.decimals.unwrap_or_else(|| digits(sensor.resolution_nt))));
        let [scalar_digits, flux_digits] = if self.is_sensed { [Some(PICOTESLA), None] } else { sent };
        for row in 0..simulation.signals().len() {
            let (scalar_nt, [x, y, z]) = (self.readings.scalar_nt[row], self.readings.flux_nt[row]);
            let time_s = to_thousandths(simulation.signals().recording_time_s(row));
            write!(out, "{time_s}")?;
            write_nt(out, scalar_nt, scalar_digits)?;
            [x, y, z].into_iter().try_for_each(|component_nt| write_nt(out, component_nt, flux_digits))?;
            write_if(out, flags, if simulation.valid()[row] && !scalar_nt.is_nan() { ",1" } else { ",0" })?;
            depth_m.map_or(Ok(()), |depth_m| write!(out, ",{}", to_thousandths(depth_m[row])))?;
            let temperature = world.temperature_deg_c.as_ref();
            temperature.map_or(Ok(()), |deg_c| write!(out, ",{}", to_thousandths(deg_c[row])))?;
            if scenario.columns.attitude {
                let attitude = simulation.attitude()[row];
                let heading_deg = attitude.heading.to_degrees().rem_euclid(360.0);
                write!(out, ",{:.3},{:.3},{heading_deg:.3}", attitude.roll.to_degrees(), attitude.pitch.to_degrees())?;
            }
            world.currents_a.iter().try_for_each(|(_, a)| write!(out, ",{}", to_thousandths(a[row])))?;
            write_if(out, scenario.columns.line, &format!(",{}", simulation.line()[row]))?;
            navigation.write_row(out, row)?;
            writeln!(out)?;
        }
        Ok(())
    }
}

/// A reading: nothing where there is none, with all digits of the body's `f32` where no others are asked for.
fn write_nt(out: &mut impl Write, nt: f64, digits: Option<usize>) -> io::Result<()> {
    match digits {
        _ if nt.is_nan() => write!(out, ","),
        Some(digits) => write!(out, ",{nt:.digits$}"),
        None => write!(out, ",{}", nt as f32),
    }
}

fn write_if(out: &mut impl Write, is_there: bool, text: &str) -> io::Result<()> {
    if is_there { out.write_all(text.as_bytes()) } else { Ok(()) }
}

fn to_thousandths(value: f64) -> f64 {
    // Adding zero turns -0 into 0.
    (value * 1000.0).round() / 1000.0 + 0.0
}

/// Decimal places that multiples of a step need, at most nine.
fn digits(step: f64) -> usize {
    let is_whole = |digits: &usize| {
        let scaled = step * 10_f64.powi(*digits as i32);
        (scaled - scaled.round()).abs() < 1e-6 * scaled
    };
    (0..9).find(is_whole).unwrap_or(9)
}

#[cfg(test)]
mod tests {
    use super::digits;

    #[test]
    fn a_step_has_the_digits_that_it_needs() {
        assert_eq!([1.0, 0.001, 3.05, 0.25, 20.0, 1e-6].map(digits), [0, 3, 2, 2, 0, 6]);
    }
}
