//! What a diagnosis says in its headline and on the terminal, over all that it may have to say.

use crate::report::demo_diagnosis as demo;

use std::sync::LazyLock;

use host_sim::diagnosis::{CandidateShare, Diagnosis, EffectFound, GapClosed, ParameterEstimate, Verdict};
use host_sim::effects::{Channel, Spec};
use host_sim::text::diagnosis::{is_likely, sentence, title, verdict};
use host_sim::text::diagnosis_terminal;

fn closed(fraction: f64, low: f64) -> GapClosed {
    GapClosed { fraction, ci95: [low, 0.99], held_out: true }
}

/// An effect with awkward numbers for all of its parameters.
fn effect(spec: &'static Spec, probability: f64, gap_closed: GapClosed) -> EffectFound {
    let estimate = |name: &str| ParameterEstimate {
        name: name.into(),
        value: Some(-36_053.4),
        ci95: Some([-36_053.5, -36_053.2]),
    };
    EffectFound {
        name: spec.name,
        probability,
        parameters: spec.parameters.iter().map(|parameter| estimate(parameter.name)).collect(),
        gap_closed,
        channel: if spec.channel == Channel::Scalar { "scalar" } else { "fluxgate" },
        ..demo::lag()
    }
}

/// A diagnosis to be changed, with what nothing here reads of it left out: tens of thousands are told.
fn base(verdict: Verdict) -> Diagnosis {
    static BASES: LazyLock<Vec<Diagnosis>> = LazyLock::new(|| {
        let all = [Verdict::NoGap, Verdict::Explained, Verdict::PartlyExplained, Verdict::Unknown];
        all.map(|verdict| Diagnosis { residuals: Vec::new(), ..demo::diagnosis(verdict) }).into()
    });
    BASES.iter().find(|base| base.verdict == verdict).unwrap().clone()
}

/// A gap of this size in both channels, in their noise, and these effects.
fn with(verdict: Verdict, effects: Vec<EffectFound>, excess: f64) -> Diagnosis {
    let mut diagnosis = base(verdict);
    for channel in &mut diagnosis.channels {
        channel.residual_rms_nT = channel.noise_floor_rms_nT * (1.0 + excess * excess).sqrt();
    }
    diagnosis.gap.residual_rms_nT = diagnosis.channels[0].residual_rms_nT;
    diagnosis.gap.excess_rms_nT = excess * diagnosis.gap.noise_floor_rms_nT;
    let share = |effect: &EffectFound| CandidateShare {
        name: effect.name,
        probability: effect.probability / effects.len() as f64,
        identifiable_fraction: None,
    };
    diagnosis.candidates = effects.iter().map(share).collect();
    diagnosis.effects = effects;
    diagnosis
}

/// What must hold of every headline.
fn check(diagnosis: &Diagnosis) -> String {
    let told = sentence(diagnosis);
    assert!(told.chars().count() <= 200, "{}: {told}", told.chars().count());
    let terminal = diagnosis_terminal::text(diagnosis);
    let lines: Vec<&str> = terminal.lines().take_while(|line| !line.is_empty()).collect();
    assert!(lines.len() <= 2 && lines.iter().all(|line| line.chars().count() <= 100), "{lines:?}");
    assert_eq!(lines.join(" "), told);
    let word = verdict(diagnosis.verdict);
    assert!(told.to_lowercase().starts_with(word), "{told}");
    let likely: Vec<&str> =
        diagnosis.effects.iter().filter(|effect| is_likely(effect)).map(|effect| effect.name).collect();
    for effect in diagnosis.effects.iter().filter(|effect| !likely.contains(&effect.name)) {
        assert!(!told.contains(title(&diagnosis.specs, effect.name)), "{told}");
    }
    told
}

/// Gaps over their noise: none, far below it, below it, and far above it.
const EXCESSES: [f64; 4] = [0.0, 0.05, 0.5, 80_000.0];

#[test]
fn every_headline_has_at_most_two_lines_and_its_verdict_first() {
    let specs = demo::diagnosis(Verdict::NoGap).specs;
    let pairs = || specs.iter().flat_map(|first| specs.iter().map(move |second| (first, second)));
    let surenesses = [(0.99, 0.993, 0.2), (0.99, 0.7, -43.0), (0.99, 0.2, 0.1), (0.3, 0.2, 0.1)];
    for ((first, second), excess) in pairs().flat_map(|pair| EXCESSES.map(|excess| (pair, excess))) {
        for (of_first, of_second, low) in surenesses {
            let share = closed(0.45, low);
            let both = vec![effect(first, of_first, share), effect(second, of_second, share)];
            check(&with(Verdict::Explained, both.clone(), excess));
            let mut partly = with(Verdict::PartlyExplained, both, excess);
            partly.candidates.push(CandidateShare { name: "unknown", probability: 0.998, identifiable_fraction: None });
            check(&partly);
        }
    }
}

#[test]
fn headlines_without_an_effect_have_at_most_two_lines() {
    for (excess, targets) in EXCESSES.into_iter().flat_map(|excess| [0, 1, 150].map(|targets| (excess, targets))) {
        for verdict in [Verdict::NoGap, Verdict::Unknown] {
            let mut diagnosis = with(verdict, Vec::new(), excess);
            diagnosis.targets = demo::targets(targets);
            assert_eq!(check(&diagnosis).contains("target"), targets > 0);
        }
    }
}

#[test]
fn shares_are_told_where_they_are_sure_and_the_gap_is_above_the_noise() {
    let [scalar, other] = ["averaging_window", "eddy_lag"].map(spec);
    let told = |shares: [GapClosed; 2], excess: f64| {
        let effects = vec![effect(scalar, 0.99, shares[0]), effect(other, 0.97, shares[1])];
        check(&with(Verdict::Explained, effects, excess))
    };
    let sure = told([closed(0.6, 0.5), closed(0.3, 0.2)], 8.0);
    assert!(sure.ends_with(": 60 % and 30 % of the scalar's gap of 0.400 nT rms."), "{sure}");
    let beyond_the_whole = told([closed(1.0, 0.9), closed(0.9, 0.8)], 8.0);
    assert!(beyond_the_whole.ends_with(", probability 99 % and 97 %. The scalar's gap is 0.400 nT rms."));
}

fn spec(name: &str) -> &'static Spec {
    demo::diagnosis(Verdict::NoGap).specs.into_iter().find(|spec| spec.name == name).unwrap()
}

#[test]
fn a_gap_below_the_noise_is_said_to_be_so_and_has_no_shares() {
    let lag = |share| vec![effect(spec("dead_zone"), 0.99, share)];
    let below = check(&with(Verdict::Explained, lag(closed(0.997, 0.9)), 0.5));
    assert!(
        below.ends_with("probability 99 %. The scalar's gap is 0.0250 nT rms, below its noise of 0.0500."),
        "{below}"
    );
    let far_below = check(&with(Verdict::Explained, lag(closed(0.997, 0.9)), 0.01));
    assert!(far_below.ends_with("probability 99 %. The scalar's gap is far below its noise of 0.0500 nT rms."));
    assert!(!below.contains("over 99 %") && !far_below.contains("over 99 %"));
    let unsure = check(&with(Verdict::Explained, lag(closed(0.79, -43.0)), 8.0));
    assert!(unsure.contains("probability 99 %") && !unsure.contains("79 %"), "{unsure}");
}

#[test]
fn what_is_not_likely_is_no_cause() {
    let rivals = ["averaging_window", "eddy_lag"].map(|name| effect(spec(name), 0.45, closed(0.6, 0.5)));
    let told = check(&with(Verdict::Explained, rivals.to_vec(), 8.0));
    assert!(told.starts_with("Explained, but by what is not settled"), "{told}");
    let one = vec![rivals[0].clone(), effect(spec("eddy_lag"), 0.9, closed(0.6, 0.5))];
    let diagnosis = with(Verdict::Explained, one, 8.0);
    assert!(check(&diagnosis).starts_with("Explained by slow eddy currents"));
    let terminal = diagnosis_terminal::text(&diagnosis);
    assert!(terminal.contains("probability 45 %: less likely than not"), "{terminal}");
    assert!(terminal.contains("as main cause    22 %"), "{terminal}");
}

#[test]
fn many_loads_with_long_names_keep_to_two_lines() {
    let load = |k: usize| EffectFound {
        load: Some(format!("winch_{k}_{}", "x".repeat(150))),
        ..effect(spec("load_current"), 0.9, closed(0.2, 0.1))
    };
    let mut diagnosis = with(Verdict::PartlyExplained, (0..5).map(load).collect(), 8.0);
    diagnosis.candidates.push(CandidateShare { name: "unknown", probability: 0.62, identifiable_fraction: None });
    let told = check(&diagnosis);
    assert!(told.contains("the current of a load") && told.contains("3 more below"), "{told}");
    assert!(told.ends_with("Main cause likely unknown (62 %)."), "{told}");
}

#[test]
fn targets_stand_in_a_table_with_its_columns_right_aligned() {
    let mut diagnosis = demo::diagnosis(Verdict::NoGap);
    diagnosis.targets = demo::targets(14);
    diagnosis.targets[13].time_s = 1_780_300_900.25;
    let text = diagnosis_terminal::text(&diagnosis);
    let lines: Vec<&str> = text.lines().skip_while(|line| !line.starts_with("Targets")).take(15).collect();
    let width = |line: &str| line.chars().count();
    assert!(lines[1].ends_with("Time, s  Peak, nT  Width, s  Probability"), "{text}");
    assert!(lines[1..14].iter().all(|line| width(line) == width(lines[1])), "{text}");
    assert_eq!(lines[13].split_whitespace().next(), Some("1780300900.2"));
    assert_eq!(lines[14].trim(), "and 2 more, smaller, in diagnosis.json");
    assert!(text.lines().any(|line| line.starts_with("scalar magnetometer") && line.ends_with("  no gap")), "{text}");
}

#[test]
fn firmware_that_differs_is_told_in_two_lines() {
    assert!(sentence(&demo::firmware_mismatch()).chars().count() <= 200);
}
