//! The level that coefficients have over a circle of headings: it is taken off, so that the mean over a circle is that of the
//! reading.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use super::terms::{TERMS, UNIT_FIELD_NT, direction, magnitude};

/// Sectors of the heading.
const SECTORS: usize = 12;
/// A recording has a circle of headings when so many sectors have rows.
const LEAST_SECTORS: usize = 8;
/// A sector has rows from so many on, 2 s.
const LEAST_ROWS: f64 = 20.0;
/// Along the vertical the direction of the field varies less than across it by this factor, or there is no circle.
const LEAST_ROUND: f64 = 4.0;

/// And as far as this across it, as a standard deviation of the cosines: a body that only swings about one heading goes round
/// that, and tells nothing of the others.
const LEAST_ACROSS: f64 = 0.1;

/// The terms' mean over a circle of headings: that of the rows, every heading counted alike, where they have all headings; else
/// that of a level body whose z axis is down.
pub(crate) fn circle_mean(rows: &[([f64; 3], &[f64; TERMS])]) -> [f64; TERMS] {
    of_rows(rows).unwrap_or_else(|| of_level_body(rows.iter().map(|(flux_nt, _)| *flux_nt)))
}

/// From the rows themselves, whatever way up the fluxgate is.
fn of_rows(rows: &[([f64; 3], &[f64; TERMS])]) -> Option<[f64; TERMS]> {
    let directions: Vec<Vector3<f64>> = rows.iter().map(|(flux_nt, _)| direction(*flux_nt).into()).collect();
    let mean = directions.iter().sum::<Vector3<f64>>() / directions.len() as f64;
    let spread = directions.iter().map(|d| (d - mean) * (d - mean).transpose()).sum::<Matrix3<f64>>();
    let eigen = SymmetricEigen::new(spread);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let [first, second] = [order[1], order[2]].map(|k| eigen.eigenvectors.column(k).into_owned());
    let across = eigen.eigenvalues[order[1]];
    let is_narrow = across < LEAST_ACROSS * LEAST_ACROSS * directions.len() as f64;
    if is_narrow || across < LEAST_ROUND * eigen.eigenvalues[order[0]] {
        return None;
    }
    let places: Vec<[f64; 2]> = directions.iter().map(|d| [first, second].map(|axis| (d - mean).dot(&axis))).collect();
    let [x, y] = centre(&places)?;
    let sector = |place: &[f64; 2]| {
        let turn = (place[1] - y).atan2(place[0] - x) / std::f64::consts::TAU + 0.5;
        ((turn * SECTORS as f64) as usize).min(SECTORS - 1)
    };
    let mut sums = [([0.0; TERMS], 0.0); SECTORS];
    for (place, (_, terms)) in places.iter().zip(rows) {
        let (sum, count) = &mut sums[sector(place)];
        sum.iter_mut().zip(*terms).for_each(|(sum, term)| *sum += term);
        *count += 1.0;
    }
    let full: Vec<_> = sums.iter().filter(|(_, count)| *count >= LEAST_ROWS).collect();
    let mean_of = |term: usize| full.iter().map(|(sum, count)| sum[term] / count).sum::<f64>() / full.len() as f64;
    (full.len() >= LEAST_SECTORS).then(|| std::array::from_fn(mean_of))
}

/// Centre of the circle through places, by least squares (Kasa, A circle fitting procedure, IEEE Trans. Instrum. Meas. 25, 1976):
/// the mean of an arc is not it.
fn centre(places: &[[f64; 2]]) -> Option<[f64; 2]> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for [x, y] in places {
        let row = Vector3::new(2.0 * x, 2.0 * y, 1.0);
        normal += row * row.transpose();
        right += row * (x * x + y * y);
    }
    let solution = normal.cholesky()?.solve(&right);
    Some([solution.x, solution.y])
}

/// Of a body that keeps its mean inclination while it turns. Eddy currents have no mean.
fn of_level_body(flux_nt: impl Iterator<Item = [f64; 3]>) -> [f64; TERMS] {
    let (mut rows, mut field, mut down, mut down_square) = (0.0, 0.0, 0.0, 0.0);
    for flux_nt in flux_nt {
        let [_, _, z] = direction(flux_nt);
        rows += 1.0;
        field += magnitude(flux_nt) / UNIT_FIELD_NT;
        down += z;
        down_square += z * z;
    }
    let [field, down, down_square] = [field, down, down_square].map(|sum| if rows > 0.0 { sum / rows } else { 0.0 });
    let across = 0.5 * (1.0 - down_square);
    let mut mean = [0.0; TERMS];
    mean[2] = down;
    [mean[3], mean[6], mean[8]] = [field * across, field * across, field * down_square];
    mean
}

#[cfg(test)]
mod tests {
    use super::super::terms::of_stretch;
    use super::*;

    /// Slow turns, `degrees` wide, of a fluxgate that is mounted with these axes for forward, starboard and down.
    fn turned(degrees: f64, axes: [usize; 3]) -> Vec<[f64; 3]> {
        let flux = |row: usize| {
            let angle = (row as f64 * degrees / 3600.0).to_radians();
            let nt = [2e4 * angle.cos(), -2e4 * angle.sin(), 4.5e4 + 200.0 * (row as f64 * 0.3).sin()];
            axes.map(|axis| nt[axis])
        };
        (0..3600).map(flux).collect()
    }

    fn mean_of(flux_nt: &[[f64; 3]]) -> ([f64; TERMS], Vec<[f64; TERMS]>) {
        let time_s: Vec<f64> = (0..flux_nt.len()).map(|row| 0.1 * row as f64).collect();
        let field_nt = flux_nt.iter().map(|nt| magnitude(*nt)).sum::<f64>() / flux_nt.len() as f64;
        let terms = of_stretch(&time_s, flux_nt, 0..flux_nt.len(), field_nt);
        let rows: Vec<_> = flux_nt.iter().copied().zip(&terms).collect();
        (circle_mean(&rows), terms)
    }

    #[test]
    fn over_a_whole_circle_it_is_the_mean_of_the_rows_whatever_way_up() {
        for axes in [[0, 1, 2], [2, 0, 1]] {
            let (mean, terms) = mean_of(&turned(360.0, axes));
            for term in 0..9 {
                let over_circle = terms.iter().map(|row| row[term]).sum::<f64>() / terms.len() as f64;
                assert!((over_circle - mean[term]).abs() < 2e-3, "{axes:?} {term}: {over_circle} {}", mean[term]);
            }
        }
    }

    #[test]
    fn of_half_a_circle_it_is_that_of_the_whole() {
        let (half, _) = mean_of(&turned(170.0, [0, 1, 2]));
        let (_, whole) = mean_of(&turned(360.0, [0, 1, 2]));
        for term in 0..9 {
            let over_circle = whole.iter().map(|row| row[term]).sum::<f64>() / whole.len() as f64;
            assert!((over_circle - half[term]).abs() < 2e-3, "{term}: {over_circle} {}", half[term]);
        }
    }
}
