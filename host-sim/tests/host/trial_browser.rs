//! The page of a trial in a real browser: figures asked for beside those measured, every chart, nothing from elsewhere.

use crate::report::browser::{browser, look, look_at_widths};
use host_sim::report::render_trial;
use towmag_trial::{
    Bin, Calibration, OnBin, OnScore, Promise, Rate, Score, Several, Shrink, TargetScore, Trial, TrialOptions,
    WithheldScore,
};

const QUESTIONS: [(&str, &str); 6] = [
    ("headline", "document.querySelector('h1').textContent"),
    ("charts", "[...document.querySelectorAll('.chart')].map((chart) => chart.id).join(' ')"),
    ("states", "[...document.querySelectorAll('.state')].map((state) => state.textContent).join(' ')"),
    ("bars", "document.querySelector('#strengths').data.map(({y}) => y.join(',')).join(' ')"),
    (
        "matrix",
        "[...document.querySelectorAll('.matrix tbody td[class]')].filter((cell) => cell.style.length).map((cell) => \
         cell.className + cell.textContent).join(' ')",
    ),
    ("list", "[...document.querySelectorAll('.long')].map((cell) => cell.textContent).join(' | ')"),
];

fn trial() -> Trial {
    let options = TrialOptions { seed: 7, ..TrialOptions::default() };
    let sha256 = "0123456789abcdef".repeat(4);
    Trial {
        schema: 1,
        options,
        version: None,
        answers_sha256: sha256,
        score: None,
        on: None,
        untouched: None,
        results: Vec::new(),
    }
}

fn score() -> Score {
    let rate = Rate::new;
    let bin = |strength: f64, hits: usize| Bin {
        strength,
        detected: rate(20, 20),
        right_or_in_set: rate(hits, 20),
        alone_right: rate(hits - 1, 20),
        wrong_and_claimed: rate(0, 20),
    };
    let said = |all: &[(&str, usize)]| all.iter().map(|(name, count)| (name.to_string(), *count)).collect();
    Score {
        drivers: None,
        false_alarms: rate(9, 30),
        false_alarms_by_targets: [("with targets".into(), rate(9, 30))].into(),
        false_alarms_by_noise: [("pink".into(), rate(9, 30))].into(),
        false_alarms_by_motion: [("sea".into(), rate(9, 30))].into(),
        false_alarms_by_recorder: [("padded".into(), rate(9, 30))].into(),
        singles: vec![bin(1.0, 15), bin(3.0, 18), bin(10.0, 20)],
        wrong_and_claimed: rate(1, 60),
        false_names: rate(2, 100),
        several: vec![Several { what: "Two effects, strength 1".into(), all: rate(0, 0), one: rate(0, 0) }],
        foreign_explained: rate(0, 10),
        foreign_named: rate(1, 10),
        foreign_noticed_from_3: rate(10, 10),
        foreign_identifiable_noticed_from_3: rate(9, 9),
        foreign_noticed_at_1: rate(3, 5),
        intervals_cover: rate(95, 100),
        intervals_cover_by_effect: [("scalar_lag".into(), rate(95, 100))].into(),
        targets: TargetScore { large_listed: rate(99, 100), small_listed: rate(4, 10), invented: 12, hours: 10.0 },
        shrink: Shrink {
            of: 20,
            median_ratio: Some(1.02),
            cover: rate(19, 20),
            cover_by_effect: [("scalar_lag".into(), rate(19, 20))].into(),
        },
        calibration: Calibration {
            expected_error: 0.02,
            bins: vec![Promise { promised: 0.6, came: rate(6, 10) }, Promise { promised: 0.99, came: rate(10, 10) }],
        },
        confusion: [
            ("none".into(), said(&[("none", 21), ("scalar_lag", 9)])),
            ("scalar_lag".into(), said(&[("scalar_lag", 3), ("eddy_lag + scalar_lag", 1)])),
            ("hysteresis".into(), said(&[("unknown", 2)])),
            ("eddy_lag + scalar_lag".into(), said(&[("scalar_lag + unknown", 2)])),
        ]
        .into(),
        withheld: Some(WithheldScore {
            name: "mains_alias".into(),
            noticed: rate(3, 4),
            explained_by_others: rate(0, 4),
            named_when_back: rate(4, 4),
            explained_when_back: rate(4, 4),
            median_gap_closed: Some(0.97),
        }),
    }
}

#[test]
fn a_trial_is_drawn_on_a_screen_and_on_a_phone() {
    let Some(browser) = browser() else { return };
    let page = render_trial(&Trial { score: Some(score()), ..trial() }).unwrap();
    for (width_px, seen) in look_at_widths(&browser, "trial", &page, [390, 1600], &QUESTIONS) {
        assert_eq!((seen("errors"), seen("overflow")), ("none".into(), "none".into()), "{width_px} px");
        assert_eq!((seen("loads"), seen("links")), ("0".into(), "0".into()));
        assert_eq!((seen("charts"), seen("drawn")), ("strengths reliability".into(), "2".into()));
        assert_eq!(
            seen("headline"),
            "The diagnosis reaches 10 of the 17 figures that it is held to; 5 are missed, 2 are open: so few recordings \
             cannot tell."
        );
        assert!(
            seen("states").starts_with("missed missed missed missed missed reached open reached"),
            "{}",
            seen("states")
        );
        assert_eq!(seen("bars"), "75,90,100 70,85,95");
        assert_eq!(seen("matrix"), "right2 wrong9 right21 right3 wrong1");
        assert_eq!(seen("list"), "scalar lag + unknown (2 times) | scalar lag (9 times) | eddy lag + scalar lag");
    }
}

#[test]
fn a_trial_on_a_recording_says_what_that_one_shows_already_and_nothing_leaves_the_page() {
    let hostile = "</script><img src=https://example.com/x onerror=alert(1)>";
    let on = OnScore {
        untouched: format!("The scalar differs. {hostile}"),
        untouched_effects: vec!["scalar_lag".into()],
        scalar_residual_rms_nt: 0.4,
        fluxgate_residual_rms_nt: 5.0,
        named: vec![OnBin { strength: 3.0, named: Rate::new(9, 10) }],
        named_from_3: Rate::new(9, 10),
        others_named: Rate::new(2, 10),
        targets_listed: Rate::new(20, 20),
        missed: vec![hostile.into()],
    };
    let mut trial = Trial { on: Some(on), ..trial() };
    trial.options.on = Some(format!("folder/{}", hostile.replace('/', "|")).into());
    let page = render_trial(&trial).unwrap();
    assert!(!page.contains("<img src=https"));
    let Some(browser) = browser() else { return };
    let seen = look(&browser, "trial_on", &page, 390, &QUESTIONS[..3]);
    assert_eq!((seen("errors"), seen("overflow")), ("none".into(), "none".into()));
    assert_eq!((seen("loads"), seen("links"), seen("charts")), ("0".into(), "0".into(), "strengths".into()));
    assert_eq!(seen("headline"), "Of 10 effects of strength 3 and more that were put into the recording, 9 are named.");
    assert_eq!(seen("states"), "reached open reached");
}
