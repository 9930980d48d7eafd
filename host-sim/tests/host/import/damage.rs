//! What can be wrong with a recording: axes, units, rate, lag, places, readings that stand still.

use towmag_import::Options;
use towmag_import::profile::parse_axes;

use super::copies::Copy;

const FLUX: [&str; 3] = ["flux_x_nT", "flux_y_nT", "flux_z_nT"];

/// A damaged copy, and what must be said of it.
pub(crate) struct Damaged {
    pub(crate) copy: Copy,
    /// One of these kinds.
    kinds: &'static [&'static str],
    /// What a finding's option must begin with, where that option alone mends it.
    pub(crate) option: Option<&'static str>,
}

impl Damaged {
    /// What was said instead, if none of the kinds was.
    pub(crate) fn missed(&self) -> Option<String> {
        let report = self.copy.imported(&Options::default()).report;
        let kind = |kind| serde_json::to_value(kind).unwrap().as_str().unwrap_or_default().to_string();
        // That something is wrong is not yet what.
        let is_named = report.findings.iter().any(|finding| {
            self.kinds.contains(&kind(finding.kind).as_str()) && !finding.text.contains("wrong columns, units or")
        });
        let told: Vec<&str> = report.findings.iter().map(|finding| finding.text.as_str()).collect();
        (!is_named).then(|| format!("{}: no {:?} in {told:?}", self.copy.name, self.kinds))
    }

    /// What still differs from the original when the option that was named is given.
    pub(crate) fn left_after_option(&self, original: &Copy) -> Option<String> {
        let report = self.copy.imported(&Options::default()).report;
        let wanted = self.option?;
        let named = report
            .findings
            .iter()
            .filter_map(|finding| finding.option.as_deref())
            .find(|option| option.starts_with(wanted));
        let Some(value) = named.and_then(|option| option.split_once(' ')).map(|(_, value)| value) else {
            return Some(format!("no option {wanted}: {:?}", report.lines()));
        };
        let mut options = Options::default();
        match wanted {
            "--axes" => options.profile.axes = Some(parse_axes(value).unwrap()),
            _ => options.profile.scalar_lag_s = Some(value.parse().unwrap()),
        }
        let mended = self.copy.imported(&options);
        let warnings: Vec<_> = mended.report.findings.iter().filter(|finding| finding.is_warning).collect();
        if !warnings.is_empty() {
            return Some(format!("still {warnings:?}"));
        }
        let mut csv = Vec::new();
        mended.write_csv(&mut csv).unwrap();
        let mended = Copy::read(&self.copy.name, &csv);
        let off = |name: &str| {
            let pairs = mended.column(name).iter().zip(original.column(name)).skip(30).take(3000);
            pairs.map(|(mended, original)| (mended - original).abs()).filter(|off| off.is_finite()).fold(0.0, f64::max)
        };
        let same = wanted != "--axes" || FLUX.iter().all(|axis| off(axis) < 1e-3);
        (!same).then(|| format!("{value} gives other axes"))
    }
}

/// All that can be seen on a recording.
pub(crate) fn of(original: &Copy) -> Vec<Damaged> {
    let mut damaged = units(original);
    damaged.extend(times(original));
    damaged.extend(places(original));
    if original.has("heading_deg") {
        damaged.extend(axes(original));
    }
    damaged
}

fn with(original: &Copy, what: &str, kinds: &'static [&'static str], change: impl FnOnce(&mut Copy)) -> Damaged {
    let mut copy = Copy { name: format!("{}, {what}", original.name), ..original.clone() };
    change(&mut copy);
    Damaged { copy, kinds, option: None }
}

fn times_factor(copy: &mut Copy, columns: &[&str], factor: f64) {
    for name in columns {
        copy.column_mut(name).iter_mut().for_each(|value| *value *= factor);
    }
}

/// Names that do not tell the unit, as a file has it whose unit is not nT.
fn untold(copy: &mut Copy) {
    for (name, _) in &mut copy.columns {
        *name = name.trim_end_matches("_nT").to_string();
    }
}

fn units(original: &Copy) -> Vec<Damaged> {
    let units: &[&str] = &["units"];
    let untold_flux = |factor: f64| {
        with(original, &format!("fluxgate times {factor}"), units, |copy| {
            times_factor(copy, &FLUX, factor);
            untold(copy);
        })
    };
    vec![
        untold_flux(1e-3),
        untold_flux(0.1),
        with(original, "fluxgate times 0.1, called nT", units, |copy| times_factor(copy, &FLUX, 0.1)),
        with(original, "x times 0.1", units, |copy| times_factor(copy, &FLUX[..1], 0.1)),
        with(original, "z times 0.001", units, |copy| times_factor(copy, &FLUX[2..], 1e-3)),
    ]
}

/// Rows from here to there of a column, as another copy of the same recording has them.
fn moved(copy: &mut Copy, name: &str, rows: usize) {
    let column = copy.column_mut(name);
    let first = column[0];
    column.splice(0..0, std::iter::repeat_n(first, rows));
    let len = column.len() - rows;
    column.truncate(len);
}

fn times(original: &Copy) -> Vec<Damaged> {
    let late = |rows: usize| Damaged {
        option: Some("--scalar-lag"),
        ..with(original, &format!("scalar {rows} rows late"), &["lag"], |copy| moved(copy, "scalar_nT", rows))
    };
    let early =
        with(original, "scalar 5 rows early", &["lag"], |copy| FLUX.iter().for_each(|axis| moved(copy, axis, 5)));
    let every_second = with(original, "every second row", &["rate"], |copy| {
        for (_, column) in &mut copy.columns {
            let kept = column.iter().step_by(2).copied().collect();
            *column = kept;
        }
    });
    let doubled = with(original, "20 Hz", &["rate"], |copy| {
        for (_, column) in &mut copy.columns {
            let between = |pair: &[f64]| [pair[0], (pair[0] + pair[1]) / 2.0];
            *column = column.windows(2).flat_map(between).collect();
        }
    });
    // A tenth of a second does not show on the flights, whose sensors have lags of their own of up to 0.08 s.
    let shortest = if original.has("heading_deg") { 1 } else { 3 };
    vec![late(shortest), late(4), early, every_second, doubled]
}

fn places(original: &Copy) -> Vec<Damaged> {
    let exchanged = with(original, "scalar and z exchanged", &["swapped"], |copy| {
        let (scalar, z) = (copy.column("scalar_nT").to_vec(), copy.column("flux_z_nT").to_vec());
        *copy.column_mut("scalar_nT") = z.iter().map(|z| z.abs()).collect();
        *copy.column_mut("flux_z_nT") = scalar;
    });
    let stuck = |name: &'static str| {
        with(original, &format!("{name} stands still for 40 s"), &["stuck"], |copy| {
            let column = copy.column_mut(name);
            let value = column[1000];
            column[1000..1400].fill(value);
        })
    };
    vec![exchanged, stuck("scalar_nT"), stuck("flux_y_nT")]
}

fn axes(original: &Copy) -> Vec<Damaged> {
    let turned = |name: &str, kinds, axes: [(usize, f64); 3]| Damaged {
        option: Some("--axes"),
        ..with(original, name, kinds, |copy| {
            let flux = FLUX.map(|axis| copy.column(axis).to_vec());
            for (target, (of, sign)) in FLUX.iter().zip(axes) {
                *copy.column_mut(target) = flux[of].iter().map(|value| sign * value).collect();
            }
        })
    };
    let (axes, handedness): (&[&str], &[&str]) = (&["axes"], &["handedness"]);
    vec![
        turned("x is port, y forward", axes, [(1, -1.0), (0, 1.0), (2, 1.0)]),
        turned("x backward, y port", axes, [(0, -1.0), (1, -1.0), (2, 1.0)]),
        turned("y is down, z port", axes, [(0, 1.0), (2, 1.0), (1, -1.0)]),
        turned("axes moved on by one", axes, [(1, 1.0), (2, 1.0), (0, 1.0)]),
        turned("x starboard, y forward, z down", handedness, [(1, 1.0), (0, 1.0), (2, 1.0)]),
        turned("z up", handedness, [(0, 1.0), (1, 1.0), (2, -1.0)]),
        turned("y port", handedness, [(0, 1.0), (1, -1.0), (2, 1.0)]),
    ]
}
