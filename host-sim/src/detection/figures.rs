//! Residual, amplitude kept and distortion, from sums over two runs side by side.

use serde::Serialize;

/// An anomaly is strong whose peak is at least this multiple of the bound.
const STRONG: f64 = 10.0;

/// What a method leaves of the noise and of the anomalies. Residuals are strictly predictive.
#[derive(Clone, Debug, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct Detection {
    /// Name of the method.
    pub method: String,
    /// Standard deviation of the band-passed residual without anomalies, nT.
    pub residual_nT: f64,
    /// The same over that of the best 18 coefficients in hindsight, over the same rows.
    pub residual_over_bound: f64,
    /// Standard deviation of `compensated_nT` itself, band-passed, over the same bound.
    pub end_to_end_over_bound: f64,
    /// Projection of what the anomalies add to the residual on what they add to the band-passed scalar.
    pub kept: f64,
    /// The same over the strong anomalies alone, whose peaks are at least ten times the bound; none where there is none.
    pub kept_strong: Option<f64>,
    /// Root mean square of what is not that projection, over the highest peak.
    pub distortion: f64,
    /// Amplitude kept over the residual in units of the bound: what a detector's threshold sees.
    pub detection: f64,
}

/// Sums over the rows that count.
#[derive(Clone, Debug, Default)]
pub(super) struct Sums {
    rows: f64,
    residual: f64,
    residual_squares: f64,
    end_to_end: f64,
    end_to_end_squares: f64,
    anomaly_squares: f64,
    passed_squares: f64,
    product: f64,
    peak_nt: f64,
    /// Peak of each anomaly, nT, and the sums `anomaly_squares` and `product` around it.
    each: Vec<[f64; 3]>,
}

/// One row, nT: residual without anomalies, band-passed compensated reading, and what the anomalies add to the
/// band-passed scalar and to the residual.
pub(super) struct Sides {
    /// The anomaly that the row belongs to.
    pub(super) anomaly: Option<usize>,
    pub(super) residual_nt: f64,
    pub(super) end_to_end_nt: f64,
    pub(super) anomaly_nt: f64,
    pub(super) passed_nt: f64,
}

impl Sums {
    /// For anomalies of these peaks, nT.
    pub(super) fn new(peaks_nt: impl Iterator<Item = f64>) -> Self {
        Self { each: peaks_nt.map(|peak_nt| [peak_nt.abs(), 0.0, 0.0]).collect(), ..Self::default() }
    }

    pub(super) fn add(&mut self, sides: &Sides) {
        let Sides { residual_nt, end_to_end_nt, anomaly_nt, passed_nt, anomaly } = *sides;
        if let Some([_, squares, product]) = anomaly.and_then(|anomaly| self.each.get_mut(anomaly)) {
            *squares += anomaly_nt * anomaly_nt;
            *product += anomaly_nt * passed_nt;
        }
        self.rows += 1.0;
        self.residual += residual_nt;
        self.residual_squares += residual_nt * residual_nt;
        self.end_to_end += end_to_end_nt;
        self.end_to_end_squares += end_to_end_nt * end_to_end_nt;
        self.anomaly_squares += anomaly_nt * anomaly_nt;
        self.passed_squares += passed_nt * passed_nt;
        self.product += anomaly_nt * passed_nt;
        self.peak_nt = self.peak_nt.max(anomaly_nt.abs());
    }

    fn kept_strong(&self, bound_nt: f64) -> Option<f64> {
        let strong = || self.each.iter().filter(|[peak_nt, ..]| *peak_nt >= STRONG * bound_nt);
        let [squares, product] = [1, 2].map(|sum| strong().map(|each| each[sum]).sum::<f64>());
        (squares > 0.0).then(|| product / squares)
    }

    pub(super) fn finish(&self, method: &str, bound_nt: f64) -> Detection {
        let std = |sum: f64, squares: f64| (squares / self.rows - (sum / self.rows).powi(2)).max(0.0).sqrt();
        let residual_nt = std(self.residual, self.residual_squares);
        let kept = self.product / self.anomaly_squares;
        let rest = self.passed_squares - kept * self.product;
        Detection {
            method: method.into(),
            residual_nT: residual_nt,
            residual_over_bound: residual_nt / bound_nt,
            end_to_end_over_bound: std(self.end_to_end, self.end_to_end_squares) / bound_nt,
            kept,
            kept_strong: self.kept_strong(bound_nt),
            distortion: (rest.max(0.0) / self.rows).sqrt() / self.peak_nt,
            detection: kept / (residual_nt / bound_nt),
        }
    }
}
