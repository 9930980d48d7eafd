//! Diagnoses made by hand, one for each verdict, with series and spectra that look like those of a tow.

use host_sim::diagnosis::{
    CandidateShare, Cell, ChannelGap, ChannelResiduals, Diagnosis, EffectFound, Gap, GapClosed, ManoeuvreKind,
    NextManoeuvre, ParameterEstimate, RoundingFound, TargetFound, Unexplained, Verdict,
};

const ROWS: usize = 6_000;
const NOISE_NT: f64 = 0.05;

/// A diagnosis with this verdict.
pub(crate) fn diagnosis(verdict: Verdict) -> Diagnosis {
    let has_gap = verdict != Verdict::NoGap;
    let is_named = matches!(verdict, Verdict::Explained | Verdict::PartlyExplained);
    let before_nt = if has_gap { 0.4 } else { 0.0 };
    let after_nt = if verdict == Verdict::PartlyExplained { 0.1 } else { 0.0 };
    let rms = |excess_nt: f64| (excess_nt * excess_nt + NOISE_NT * NOISE_NT).sqrt();
    Diagnosis {
        verdict,
        gap: Gap {
            residual_rms_nT: rms(before_nt),
            noise_floor_rms_nT: NOISE_NT,
            excess_rms_nT: before_nt,
            p_value: if has_gap { 1e-30 } else { 0.4 },
            channel: "scalar",
        },
        cells: cells(has_gap),
        effects: if is_named { vec![lag()] } else { Vec::new() },
        candidates: candidates(verdict),
        next_manoeuvre: is_named.then(|| NextManoeuvre {
            separates: vec!["scalar_lag", "scalar_lowpass"],
            kind: ManoeuvreKind::Shake,
            repeats_event: false,
            is_enough: true,
            minutes: 2.0,
        }),
        unexplained: match verdict {
            Verdict::PartlyExplained | Verdict::Unknown => {
                vec![Unexplained { channel: "scalar", what: "bursts", p_value: 1e-8 }]
            }
            _ => Vec::new(),
        },
        description: None,
        targets: Vec::new(),
        rounding: Some(RoundingFound {
            scalar_nT: 0.01,
            flux_nT: 0.0916,
            noise_share: 0.011,
            scalar_noise_share: 0.003,
            flux_noise_share: 0.011,
        }),
        channels: vec![
            ChannelGap {
                channel: "scalar",
                residual_rms_nT: rms(before_nt),
                residual_after_rms_nT: rms(if is_named { after_nt } else { before_nt }),
                noise_floor_rms_nT: NOISE_NT,
                verdict,
            },
            ChannelGap {
                channel: "fluxgate",
                residual_rms_nT: 0.5,
                residual_after_rms_nT: 0.5,
                noise_floor_rms_nT: 0.5,
                verdict: Verdict::NoGap,
            },
        ],
        is_cut_short: false,
        bad_rows: Default::default(),
        consequence: None,
        simulation: None,
        provenance: None,
        exact_replay: Vec::new(),
        specs: host_sim::effects::Library::default().specs().collect(),
        residuals: vec![residuals("scalar", before_nt, after_nt, NOISE_NT), residuals("fluxgate", 0.0, 0.0, 0.5)],
    }
}

/// So many targets, ever larger, one in 30 s.
pub(crate) fn targets(count: usize) -> Vec<TargetFound> {
    let target = |k: usize| {
        let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        TargetFound { time_s: 30.0 * (k + 1) as f64, peak_nT: sign * (k + 1) as f64, width_s: 2.1, probability: 0.99 }
    };
    (0..count).map(target).collect()
}

/// What a diagnosis says of a log whose outputs are not those of a replay.
pub(crate) fn firmware_mismatch() -> Diagnosis {
    let mut diagnosis = diagnosis(Verdict::Explained);
    diagnosis.effects = vec![EffectFound {
        name: "firmware_mismatch",
        probability: 1.0,
        parameters: Vec::new(),
        channel: "firmware",
        indistinguishable_from: Vec::new(),
        ..lag()
    }];
    diagnosis.cells = vec![cell("stage", "band_pass", 0.0, 1.0), cell("stage", "estimator", 1.0, 0.0)];
    diagnosis.cells.iter_mut().for_each(|cell| cell.channel = "firmware");
    diagnosis.candidates =
        vec![CandidateShare { name: "firmware_mismatch", probability: 1.0, identifiable_fraction: None }];
    diagnosis.next_manoeuvre = None;
    diagnosis.residuals = Vec::new();
    diagnosis
}

pub(crate) fn lag() -> EffectFound {
    EffectFound {
        name: "scalar_lag",
        probability: 0.93,
        parameters: vec![ParameterEstimate { name: "lag_s".into(), value: Some(0.051), ci95: Some([0.048, 0.054]) }],
        gap_closed: GapClosed { fraction: 0.94, ci95: [0.91, 0.96], held_out: true },
        confirmed: None,
        indistinguishable_from: vec!["scalar_lowpass"],
        load: None,
        regressor: None,
        column: None,
        channel: "scalar",
        is_noise_without_edge: false,
        strength: 40.0,
    }
}

fn candidates(verdict: Verdict) -> Vec<CandidateShare> {
    let share = |name, probability, fraction| CandidateShare { name, probability, identifiable_fraction: fraction };
    let likely = match verdict {
        Verdict::NoGap => "none",
        Verdict::Unknown => "unknown",
        _ => "scalar_lag",
    };
    let effects = ["scalar_lag", "scalar_lowpass", "heading_error", "dead_zone", "mains_alias", "second_order"];
    let mut all: Vec<_> = effects.iter().map(|name| share(*name, 0.01, Some(0.3))).collect();
    all[2].identifiable_fraction = Some(0.001);
    all.extend([share("none", 0.01, None), share("unknown", 0.01, None)]);
    all.iter_mut().filter(|candidate| candidate.name == likely).for_each(|candidate| candidate.probability = 0.93);
    all.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    all
}

fn cell(by: &'static str, cell: &str, excess_share: f64, p_value: f64) -> Cell {
    Cell { by, cell: cell.into(), channel: "scalar", excess_share, p_value }
}

fn cells(has_gap: bool) -> Vec<Cell> {
    let p = if has_gap { 1e-20 } else { 0.5 };
    let mut cells = vec![
        cell("band", "0.25-0.5 Hz", 0.7, p),
        cell("band", "0.1-0.25 Hz", 0.25, p),
        cell("band", "2-5 Hz", 0.05, 0.3),
        cell("temperature", "-2.500-1.250 degC", 0.6, p),
        cell("temperature", "1.250-3.000 degC", 0.4, p),
        cell("load", "pump </script> & co on", 0.8, p),
        cell("load", "pump </script> & co off", 0.2, 0.4),
    ];
    cells.extend(["N", "E", "S", "W"].map(|heading| cell("heading", heading, 0.25, p)));
    cells
}

/// Uniform in -1 to 1, the same on every run.
fn noise(state: &mut u32) -> f64 {
    *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    f64::from(*state) / f64::from(u32::MAX) * 2.0 - 1.0
}

fn residuals(channel: &'static str, before_nt: f64, after_nt: f64, noise_nt: f64) -> ChannelResiduals {
    let mut state = 1;
    let time_s: Vec<f64> = (0..ROWS).map(|row| row as f64 * 0.1).collect();
    let scatter: Vec<f64> = (0..ROWS).map(|_| 1.7 * noise_nt * noise(&mut state)).collect();
    let with = |rms_nt: f64| -> Vec<f64> {
        time_s.iter().zip(&scatter).map(|(time_s, noise)| noise + 1.4 * rms_nt * (1.9 * time_s).sin()).collect()
    };
    let spectrum = |rms_nt: f64| -> Vec<[f64; 2]> {
        let swell = |hz: f64| rms_nt * rms_nt * 8.0 * (-((hz - 0.3) / 0.05).powi(2)).exp();
        (1..250).map(|k| 0.02 * f64::from(k)).map(|hz| [hz, noise_nt * noise_nt / 5.0 + swell(hz)]).collect()
    };
    ChannelResiduals {
        channel,
        rows: (0..ROWS).collect(),
        before_nt: with(before_nt),
        after_nt: with(after_nt),
        spectrum_before: spectrum(before_nt),
        spectrum_after: spectrum(after_nt),
        spectrum_noise: spectrum(0.0),
        time_s,
    }
}
