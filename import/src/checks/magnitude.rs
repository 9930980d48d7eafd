//! The fluxgate's magnitude against the scalar: units, one axis in another unit, columns in each other's place.

use towmag_recording::Column;

use super::statistics::{moments, usable};
use crate::draft::Draft;
use crate::field::{EARTH_NT, magnitudes};
use crate::finding::Finding;
use crate::source::FindingKind;
use crate::statistics::median;

/// Factors between units in use.
const FACTORS: [f64; 10] = [10.0, 100.0, 1e3, 1e5, 1e9, 0.1, 0.01, 1e-3, 1e-5, 1e-9];
/// The two sensors agree within this part where units, axes and places are right: a body's own field is below it.
const AGREES: f64 = 0.2;
/// So much better must another reading of the columns fit before it is called the right one.
const BETTER: f64 = 4.0;
/// An axis in another unit makes the square of the magnitude vary by more than this against that of the field; the flights'
/// fluxgates and the simulated ones by 0.003 to 0.065 where all is right, by 0.07 and more where an axis is not.
const VARIES: f64 = 0.03;
/// And by this part of it once its unit is right: 0.55 and less in the same recordings.
const STEADIER: f64 = 0.65;

/// What the file does not say of its magnetic units: `is_told` of scalar and fluxgate. The factor that is applied to the
/// fluxgate because it is sure, and what is said.
pub(crate) fn settle_units(draft: &mut Draft, is_told: [bool; 2]) -> (f64, Vec<Finding>) {
    let mut findings = Vec::new();
    let mut applied = 1.0;
    let size = |draft: &Draft| draft.flux().and_then(|axes| median(magnitudes(axes)));
    let scalar = draft.numbers(Column::Scalar).and_then(|scalar| median(scalar.to_vec()));
    let (Some(flux), false) = (size(draft), is_told[1]) else {
        findings.extend(size(draft).and_then(|flux| out_of_range("fluxgate", flux)));
        return (applied, findings);
    };
    match scalar {
        Some(scalar) if (scalar / flux - 1.0).abs() > AGREES => {
            let factor = FACTORS.into_iter().find(|factor| (scalar / (flux * factor) - 1.0).abs() <= AGREES);
            match factor {
                Some(factor) => {
                    multiply(draft, factor);
                    applied = factor;
                    let text = format!(
                        "the fluxgate reads {} of the scalar throughout: taken times {factor}",
                        fraction(1.0 / factor)
                    );
                    findings.push(Finding::new(FindingKind::Units, text).with("--units nT"));
                }
                None => {
                    let text = format!(
                        "the fluxgate's magnitude is {:.4} of the scalar: it is in no unit of the field, counts perhaps",
                        flux / scalar
                    );
                    let option = format!("--flux-factor {:.6}", scalar / flux);
                    findings.push(Finding::warning(FindingKind::Units, text).with(option));
                }
            }
        }
        Some(_) => {}
        None if !EARTH_NT.contains(&flux) => {
            if let Some(factor) = FACTORS.into_iter().find(|factor| EARTH_NT.contains(&(flux * factor))) {
                multiply(draft, factor);
                applied = factor;
                let text = format!("by its size the fluxgate is in another unit than nT: taken times {factor}");
                findings.push(Finding::new(FindingKind::Units, text).with("--units UNIT"));
            } else {
                findings.extend(out_of_range("fluxgate", flux));
            }
        }
        None => {}
    }
    (applied, findings)
}

fn out_of_range(sensor: &str, size_nt: f64) -> Option<Finding> {
    let text = format!("the {sensor} reads {size_nt:.1} nT, which is not the Earth's field: is its unit another?");
    (!EARTH_NT.contains(&size_nt)).then(|| Finding::warning(FindingKind::Units, text).with("--units UNIT"))
}

fn fraction(ratio: f64) -> String {
    if ratio < 1.0 { format!("1/{:.0}", 1.0 / ratio) } else { format!("{ratio:.0} times") }
}

fn multiply(draft: &mut Draft, factor: f64) {
    for axis in Column::FLUX {
        if let Some(numbers) = draft.column_mut(axis).and_then(crate::draft::DraftColumn::make) {
            numbers.iter_mut().for_each(|number| *number *= factor);
        }
    }
}

/// Whatever makes both sensors agree where they do not: the scalar in the place of an axis, an axis in another unit.
pub(super) fn check(draft: &Draft) -> Option<Finding> {
    let pair = Pair::of(draft)?;
    let off = pair.off(1.0, None)?;
    pair.swapped(off).or_else(|| pair.axis_in_another_unit(off)).or_else(|| {
        let text = format!(
            "the fluxgate's magnitude is {:.0} % off the scalar: wrong columns, units or a fluxgate that needs its calibration",
            100.0 * off
        );
        (off > AGREES).then(|| Finding::warning(FindingKind::Units, text).with("--flux NAME"))
    })
}

/// Both sensors in the rows that have both.
struct Pair {
    scalar: Vec<f64>,
    flux: [Vec<f64>; 3],
}

impl Pair {
    fn of(draft: &Draft) -> Option<Self> {
        let (scalar, flux) = (draft.numbers(Column::Scalar)?, draft.flux()?);
        let rows = usable(draft, scalar, &flux);
        let of = |numbers: &[f64]| rows.iter().map(|&row| numbers[row]).collect::<Vec<f64>>();
        (rows.len() >= 20).then(|| Self { scalar: of(scalar), flux: flux.map(of) })
    }

    /// Square of the magnitude over that of the total field, with this axis times `factor`.
    fn ratios(&self, factor: f64, axis: Option<usize>) -> impl Iterator<Item = f64> + Clone {
        let factors: [f64; 3] = std::array::from_fn(|at| if Some(at) == axis { factor } else { 1.0 });
        (0..self.scalar.len()).map(move |row| {
            (0..3).map(|at| (factors[at] * self.flux[at][row]).powi(2)).sum::<f64>() / self.scalar[row].powi(2)
        })
    }

    /// How far both are apart, as part of the field: the median.
    fn off(&self, factor: f64, axis: Option<usize>) -> Option<f64> {
        median(self.ratios(factor, axis).map(|ratio| (ratio.sqrt() - 1.0).abs()).collect())
    }

    fn swapped(&self, off: f64) -> Option<Finding> {
        let exchanged = |axis: usize| {
            let mut other =
                Self { scalar: self.flux[axis].iter().map(|value| value.abs()).collect(), flux: self.flux.clone() };
            other.flux[axis].clone_from(&self.scalar);
            Some((axis, other.off(1.0, None)?))
        };
        let (axis, best) = (0..3).filter_map(exchanged).min_by(|a, b| a.1.total_cmp(&b.1))?;
        let name = Column::FLUX[axis].name();
        let text = format!(
            "scalar_nT and {name} seem to be in each other's place: exchanged, magnitude and total field agree"
        );
        let is_swapped = best < AGREES / 2.0 && best * BETTER < off;
        is_swapped.then(|| Finding::warning(FindingKind::Swapped, text).with("--scalar NAME --flux X,Y,Z"))
    }

    /// As the body turns, an axis of another unit shows in how much the magnitude varies, whatever its offset.
    fn axis_in_another_unit(&self, off: f64) -> Option<Finding> {
        let varies = |factor, axis| moments(self.ratios(factor, axis)).1;
        let now = varies(1.0, None);
        // An axis that is too large outweighs the field; without one, making an axis vanish would always steady the rest.
        let is_too_large = median(self.ratios(1.0, None).collect())?.sqrt() > 1.0 + AGREES;
        let factors = || FACTORS.into_iter().filter(|factor| (*factor < 1.0) == is_too_large);
        let tried = (0..3).flat_map(|axis| factors().map(move |factor| (axis, factor)));
        let tried = tried.map(|(axis, factor)| (axis, factor, varies(factor, Some(axis))));
        let (axis, factor, then) = tried.min_by(|a, b| a.2.total_cmp(&b.2))?;
        if now < VARIES && off < AGREES || then > STEADIER * now || self.off(factor, Some(axis))? > AGREES {
            return None;
        }
        let name = Column::FLUX[axis].name();
        let text =
            format!("{name} seems to be in another unit than the other axes: times {factor} all agree with the scalar");
        Some(Finding::warning(FindingKind::Units, text).with(format!("--profile with factor {factor} for {name}")))
    }
}
