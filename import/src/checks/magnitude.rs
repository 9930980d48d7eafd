//! The fluxgate's magnitude against the scalar: units, one axis in another unit, columns in each other's place.

use towmag_recording::Column;

use super::{median, usable};
use crate::draft::Draft;
use crate::finding::Finding;
use crate::source::FindingKind;

/// The Earth's field with what stands near it, nT.
const EARTH_NT: std::ops::RangeInclusive<f64> = 15_000.0..=90_000.0;
/// Factors between units in use.
const FACTORS: [f64; 10] = [10.0, 100.0, 1e3, 1e5, 1e9, 0.1, 0.01, 1e-3, 1e-5, 1e-9];
/// The two sensors agree within this part where units, axes and places are right: a body's own field is below it.
const AGREES: f64 = 0.2;
/// So much better must another reading of the columns fit before it is called the right one.
const BETTER: f64 = 4.0;

/// What the file does not say of its magnetic units: `is_told` of scalar and fluxgate. The factor that is applied to the
/// fluxgate because it is sure, and what is said.
pub(crate) fn settle_units(draft: &mut Draft, is_told: [bool; 2]) -> (f64, Vec<Finding>) {
    let mut findings = Vec::new();
    let mut applied = 1.0;
    let size = |draft: &Draft| draft.flux().and_then(|axes| median(sizes(axes)));
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
                        "the fluxgate's magnitude is {:.4} of the scalar: it is not in a unit of the field that this program knows; \
                         if that ratio is its scale, divide by it (factor in the profile)",
                        flux / scalar
                    );
                    findings.push(Finding::warning(FindingKind::Units, text).with("--profile"));
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

fn sizes(axes: [&[f64]; 3]) -> Vec<f64> {
    let [x, y, z] = axes;
    x.iter().zip(y).zip(z).map(|((x, y), z)| (x * x + y * y + z * z).sqrt()).collect()
}

/// One axis in another unit, or the scalar in the place of an axis: whatever makes both sensors agree where they do not.
pub(super) fn check(draft: &Draft) -> Option<Finding> {
    let (scalar, flux) = (draft.numbers(Column::Scalar)?, draft.flux()?);
    let rows = usable(draft, scalar, &flux);
    if rows.len() < 20 {
        return None;
    }
    let off = |scalar: &[f64], axes: [&[f64]; 3], factors: [f64; 3]| {
        median(
            rows.iter()
                .map(|&row| {
                    let size = (0..3).map(|axis| (axes[axis][row] * factors[axis]).powi(2)).sum::<f64>().sqrt();
                    (size / scalar[row].abs() - 1.0).abs()
                })
                .collect(),
        )
    };
    let now = off(scalar, flux, [1.0; 3])?;
    if now < 0.04 {
        return None;
    }
    let mut best: Option<(f64, Finding)> = None;
    let mut try_one = |off: Option<f64>, finding: Finding| {
        if let Some(off) = off.filter(|off| *off * BETTER < now && *off < 0.04)
            && best.as_ref().is_none_or(|(lowest, _)| off < *lowest)
        {
            best = Some((off, finding));
        }
    };
    for axis in 0..3 {
        let name = Column::FLUX[axis].name();
        for factor in FACTORS {
            let mut factors = [1.0; 3];
            factors[axis] = factor;
            let text = format!(
                "{name} seems to be in another unit than the other axes: times {factor} all agree with the scalar"
            );
            let finding = Finding::warning(FindingKind::Units, text).with(format!("--profile, columns.{name}.factor"));
            try_one(off(scalar, flux, factors), finding);
        }
        let mut axes = flux;
        axes[axis] = scalar;
        let text = format!(
            "scalar_nT and {name} seem to be in each other's place: exchanged, magnitude and total field agree"
        );
        let finding = Finding::warning(FindingKind::Swapped, text).with("--scalar NAME --flux X,Y,Z");
        try_one(off(flux[axis], axes, [1.0; 3]), finding);
    }
    let disagree = || {
        let text = format!(
            "the fluxgate's magnitude is {:.0} % off the scalar: wrong columns, units or a fluxgate that needs its calibration",
            100.0 * now
        );
        Finding::warning(FindingKind::Units, text).with("--flux NAME")
    };
    best.map(|(_, finding)| finding).or_else(|| (now > AGREES).then(disagree))
}
