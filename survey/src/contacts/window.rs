//! A window of the field about a place, in means over a few rows, with the covariance of the noise there: generalised least
//! squares.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Matrix3, Vector3};

use super::bands::BANDS;
use super::covariance::Covariance;
use super::dipole::Dipole;
use super::levelled::RATE_HZ;
use super::noise::Noise;
use super::sight::Sight;
use super::stretch::Stretch;
use super::way::{Spot, Way};

/// Means an interval of one distance over speed: the profiles are smooth at that scale.
const MEANS_A_DISTANCE: f64 = 10.0;
/// Half the window in distances: the profiles have 1 / 150 of their peaks there, and the background is told from them inside.
const HALF_DISTANCES: f64 = 5.0;
/// And in rows at least.
const HALF_ROWS: f64 = 40.0;
/// No more means than this.
const MOST_MEANS: usize = 400;
/// Share of its length that is left of a column that others already hold.
const LEAST_LEFT: f64 = 1e-9;

/// All that windows are cut from.
pub(super) struct Source<'a> {
    pub(super) noise: &'a Noise,
    /// Whether the noise is taken to be the same at all times: near a strong contact that is not fitted well yet it seems loud, and a
    /// fit in loud noise stays as it is.
    pub(super) is_even: bool,
    /// By how much the noise of each row of the recording is known to be louder, nT^2.
    pub(super) louder_nt2: Option<&'a [f64]>,
    pub(super) way: &'a Way,
    pub(super) stretch_index: usize,
    pub(super) stretch: &'a Stretch,
}

/// A window.
pub(super) struct Window<'a> {
    pub(super) way: &'a Way,
    /// First cell of each mean, and cells a mean.
    pub(super) starts: Vec<usize>,
    pub(super) cells: usize,
    /// Rows of the recording that belong to each mean.
    pub(super) rows: Vec<Vec<usize>>,
    /// The two points of each mean whose mean is that over the interval (Gauss).
    spots: Vec<[Spot; 2]>,
    factor: Cholesky<f64, Dyn>,
    /// Whitened columns that every fit has, orthonormal.
    basis: Vec<DVector<f64>>,
    /// Whitened values less those columns.
    pub(super) z: DVector<f64>,
}

/// A dipole of some place and distance, with the amplitudes that fit best.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub(super) dipole: Dipole,
    pub(super) glrt: f64,
    /// Products of the whitened profiles: the inverse of the covariance of the amplitudes.
    pub(super) gram: Matrix3<f64>,
}

impl<'a> Window<'a> {
    /// About a cell, for a distance over speed in s, of some values, a cell of the stretch each. The level, the slope and what
    /// the neighbours may change by are free. `None` where too little is known.
    pub(super) fn about(
        source: &Source<'a>,
        values: &[f64],
        (cell, distance_s, least_half): (usize, f64, f64),
        neighbours: &[Dipole],
    ) -> Option<Self> {
        let distance_rows = distance_s * RATE_HZ;
        let half = (HALF_DISTANCES * distance_rows).max(HALF_ROWS).max(least_half) as usize;
        let cells = ((distance_rows / MEANS_A_DISTANCE) as usize).max(2 * half / MOST_MEANS + 1);
        let starts = starts(source.stretch, cell, half, cells);
        let first = *starts.first()?;
        let places: Vec<usize> = starts.iter().map(|start| (start - first) / cells).collect();
        let powers = if source.is_even { [1.0; BANDS] } else { source.noise.powers_at(source.stretch_index, cell) };
        let covariance = Covariance::of(|hz| source.noise.density(&powers, hz)).of_means(cells);
        let rows: Vec<Vec<usize>> = starts
            .iter()
            .map(|start| source.stretch.rows[*start..start + cells].iter().flatten().copied().collect())
            .collect();
        let factor = match source.louder_nt2 {
            Some(louder_nt2) => covariance.factor_beside(&places, &of_means(louder_nt2, &rows)),
            None => covariance.factor(&places),
        }?;
        let gauss = |rows: &Vec<usize>| gauss(rows.iter().map(|row| source.way.at[*row])).map(|at| source.way.spot(at));
        let spots = rows.iter().map(gauss).collect();
        // Of the rows that the spots are of: with a line over one that was not read it would be that of another place.
        let mean = |(start, rows): (&usize, &Vec<usize>)| {
            let read = (*start..start + cells).filter(|cell| source.stretch.rows[*cell].is_some());
            read.map(|cell| values[cell]).sum::<f64>() / rows.len() as f64
        };
        let raw = DVector::from_iterator(starts.len(), starts.iter().zip(&rows).map(mean));
        let mut window =
            Self { way: source.way, starts, cells, rows, spots, factor, basis: Vec::new(), z: DVector::zeros(0) };
        let middle = 0.5 * (places.len() - 1) as f64;
        let mut columns = vec![vec![1.0; places.len()], places.iter().map(|p| *p as f64 - middle).collect()];
        let middles = window.middles();
        columns.extend(neighbours.iter().flat_map(|dipole| dipole.columns(source.way, &middles)));
        for column in columns {
            window.add(column);
        }
        window.z = window.whitened(DMatrix::from_column_slice(raw.len(), 1, raw.as_slice())).column(0).into_owned();
        (window.starts.len() > window.basis.len() + 8).then_some(window)
    }

    /// The middle of each mean.
    pub(super) fn middles(&self) -> Vec<Spot> {
        (0..self.spots.len()).map(|mean| self.spot(mean)).collect()
    }

    /// Makes a column one of those that every fit has.
    fn add(&mut self, column: Vec<f64>) {
        let before = DMatrix::from_vec(column.len(), 1, column);
        let length = self.factor.l_dirty().solve_lower_triangular(&before).map_or(0.0, |x| x.norm());
        let white = self.whitened(before).column(0).into_owned();
        if white.norm() > LEAST_LEFT * length {
            self.basis.push(white.normalize());
        }
    }

    /// Columns whitened, less what every fit has.
    pub(super) fn whitened(&self, mut columns: DMatrix<f64>) -> DMatrix<f64> {
        // Its diagonal is positive, so this cannot fail.
        self.factor.l_dirty().solve_lower_triangular_mut(&mut columns);
        for own in &self.basis {
            for mut column in columns.column_iter_mut() {
                let share = own.dot(&column);
                column.axpy(-share, own, 1.0);
            }
        }
        columns
    }

    /// The whitened profiles.
    fn profiles(&self, dipole: &Dipole) -> DMatrix<f64> {
        let sight = Sight::of(self.way, dipole);
        let mut columns = DMatrix::zeros(self.spots.len(), 3);
        for (row, spots) in self.spots.iter().enumerate() {
            let [a, b] = spots.each_ref().map(|spot| sight.profiles(spot));
            (0..3).for_each(|k| columns[(row, k)] = 0.5 * (a[k] + b[k]));
        }
        self.whitened(columns)
    }

    /// What a dipole leaves of the whitened values.
    pub(super) fn left(&self, fitted: &Fitted) -> DVector<f64> {
        &self.z - self.profiles(&fitted.dipole) * DVector::from_column_slice(&fitted.dipole.amplitudes_nt)
    }

    /// The middle of a mean.
    pub(super) fn spot(&self, mean: usize) -> Spot {
        let [a, b] = &self.spots[mean];
        self.way.spot(0.5 * (a.at + b.at))
    }

    /// The best dipole at a place of the way, a distance and a side.
    pub(super) fn at(&self, at: f64, distance: f64, side_rad: f64) -> Option<Fitted> {
        let white = self.profiles(&Dipole { at, distance, side_rad, amplitudes_nt: [0.0; 3] });
        let gram: Matrix3<f64> = white.fixed_columns::<3>(0).tr_mul(&white.fixed_columns::<3>(0));
        let q: Vector3<f64> = white.fixed_columns::<3>(0).tr_mul(&self.z);
        let amplitudes = gram.cholesky()?.solve(&q);
        let dipole = Dipole { at, distance, side_rad, amplitudes_nt: amplitudes.into() };
        Some(Fitted { dipole, glrt: q.dot(&amplitudes), gram })
    }
}

/// Variances of means of these rows, of which each is independent, nT^2.
fn of_means(variance_nt2: &[f64], rows: &[Vec<usize>]) -> Vec<f64> {
    let of = |rows: &Vec<usize>| rows.iter().map(|row| variance_nt2[*row]).sum::<f64>() / (rows.len() as f64).powi(2);
    rows.iter().map(of).collect()
}

/// First cells of the means of which more than half is known.
fn starts(stretch: &Stretch, cell: usize, half: usize, cells: usize) -> Vec<usize> {
    let is_known = |start: &usize| {
        let known = stretch.rows[*start..start + cells].iter().flatten().count();
        2 * known > cells
    };
    let last = (cell + half).min(stretch.rows.len());
    (cell.saturating_sub(half)..(last + 1).saturating_sub(cells)).step_by(cells).filter(is_known).collect()
}

/// The two points of an even interval whose mean is that over it, of a polynomial up to the third degree.
fn gauss(ways: impl Iterator<Item = f64>) -> [f64; 2] {
    let ways: Vec<f64> = ways.collect();
    let count = ways.len() as f64;
    let mean = ways.iter().sum::<f64>() / count;
    let spread = (ways.iter().map(|way| (way - mean).powi(2)).sum::<f64>() / count).sqrt();
    [mean - spread, mean + spread]
}
