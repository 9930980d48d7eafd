//! The page of a diagnosis in a real browser: the verdict in a sentence, every chart with its data, nothing from elsewhere.

use crate::report::demo_diagnosis as demo;

use std::path::Path;

use crate::report::browser::{browser, look, look_at};
use host_sim::diagnosis::{Diagnosis, Verdict};
use host_sim::report::{DiagnosisReport, render_diagnosis};
use host_sim::text::diagnosis as words;

const QUESTIONS: [(&str, &str); 13] = [
    ("headline", "document.querySelector('h1').textContent.replaceAll('\\u00a0', ' ')"),
    ("charts", "[...document.querySelectorAll('.chart')].map((chart) => chart.id).join(' ')"),
    ("lines", "[...document.querySelectorAll('#residual')].map((chart) => chart.data.length).join()"),
    (
        "rms",
        "[...document.querySelectorAll('#residual')].flatMap((chart) => chart.data.slice(0, 2)).map(({y}) => \
         Math.sqrt(y.reduce((sum, v) => sum + v * v, 0) / y.length).toFixed(2)).join(' ')",
    ),
    (
        "peak",
        "[...document.querySelectorAll('#spectrum-scalar')].map(({data: [{x, y}]}) => x[y.indexOf(Math.max(...y))]).join()",
    ),
    (
        "candidates",
        "(({x, y}) => y[0].replaceAll('<br>', ' ') + ' ' + x[0] + ' ' + x.length)(document.querySelector('#candidates').data[0])",
    ),
    (
        "bands",
        "[...document.querySelectorAll('#map-band')].map(({data: [{x, y}]}) => x.map((name, i) => name + '=' + y[i]).join(' ')).join()",
    ),
    (
        "colours",
        "new Set([...document.querySelectorAll('#map-band')].flatMap(({data: [trace]}) => trace.marker.color)).size",
    ),
    ("verdicts", "[...document.querySelectorAll('.methods .state')].map((cell) => cell.textContent).join(' | ')"),
    (
        "targets",
        "[...document.querySelectorAll('.found tbody tr')].map((row) => [...row.cells].map((cell) => \
         cell.textContent).join(' ')).join(' | ')",
    ),
    (
        "marks",
        "[...document.querySelectorAll('#residual')].flatMap((chart) => chart.data.filter(({name}) => name === 'target') \
         .map(({x}) => x.length + ' ' + chart.layout.shapes.filter(({yref}) => yref === 'paper').length)).join()",
    ),
    (
        "headline_lines",
        "((h1) => Math.round(h1.getBoundingClientRect().height / parseFloat(getComputedStyle(h1).lineHeight)))\
         (document.querySelector('h1'))",
    ),
    ("effects", "[...document.querySelectorAll('.effect dd')].map((value) => value.textContent).join(' | ')"),
];

fn report<'a>(diagnosis: &'a Diagnosis, recording: &str) -> DiagnosisReport<'a> {
    DiagnosisReport {
        title: format!("Diagnosis: {recording}"),
        recording: recording.into(),
        diagnosis,
        withheld: &[],
        untested: vec![("swell_induction", "depth_m")],
        warnings: vec!["Only 3.2 minutes of valid rows: weak effects do not show.".into()],
        facts: vec![("Rows".into(), "6,000".into())],
    }
}

/// Draws them, each as wide as is asked for, checks what every page must be, and returns what was seen.
fn draw<const PAGES: usize>(
    browser: &Path,
    name: &str,
    diagnoses: [(&Diagnosis, u32); PAGES],
) -> [impl Fn(&str) -> String + use<PAGES>; PAGES] {
    let pages = diagnoses.map(|(diagnosis, _)| render_diagnosis(&report(diagnosis, "leg_3.csv")).unwrap());
    let sized = std::array::from_fn(|at| (pages[at].as_str(), diagnoses[at].1));
    let all = look_at(browser, name, sized, &QUESTIONS);
    for ((diagnosis, width_px), seen) in diagnoses.into_iter().zip(&all) {
        let told = words::sentence(diagnosis);
        assert_eq!(seen("errors"), "none", "{told}");
        assert_eq!(seen("width"), width_px.to_string());
        assert_eq!(seen("headline"), told);
        assert_eq!(seen("drawn"), seen("charts").split(' ').count().to_string());
        assert_eq!(seen("overflow"), "none", "{told} at {width_px} px");
        assert_eq!((seen("loads"), seen("links")), ("0".into(), "0".into()), "{told}: something came from elsewhere");
    }
    all
}

#[test]
fn explained_gap_is_drawn_on_a_screen_and_on_a_phone() {
    let diagnosis = demo::diagnosis(Verdict::Explained);
    assert_eq!(
        words::sentence(&diagnosis),
        "Explained by a delay of the scalar reading of 51 ms (48 to 54): 94 % of the scalar's gap of 0.400 nT rms."
    );
    let Some(browser) = browser() else { return };
    for seen in draw(&browser, "explained", [390, 1600].map(|width_px| (&diagnosis, width_px))) {
        let charts =
            "candidates map-band map-heading map-load map-temperature residual spectrum-scalar spectrum-fluxgate";
        assert_eq!(seen("charts"), charts);
        assert_eq!(seen("lines"), "3", "before and after of the scalar, before of the fluxgate");
        assert_eq!(seen("peak"), "0.3");
        assert_eq!(seen("candidates"), "Delay of the scalar reading 93 8");
        assert_eq!(seen("bands"), "0.1&lt;br&gt;to 0.25=25 0.25&lt;br&gt;to 0.5=70 2&lt;br&gt;to 5=5");
        assert_eq!(seen("colours"), "2", "what noise could do looks different");
        assert_eq!(seen("effects"), "93 % | 94 % (91 % to 96 %) | 51 ms (48 to 54)");
        let rms_nt: Vec<f64> = seen("rms").split(' ').map(|rms| rms.parse().unwrap()).collect();
        assert!((rms_nt[0] - 0.4).abs() < 0.02 && (rms_nt[1] - 0.05).abs() < 0.02, "{rms_nt:?}");
    }
}

#[test]
fn each_verdict_has_its_page() {
    let Some(browser) = browser() else { return };
    let shown = [Verdict::PartlyExplained, Verdict::Unknown, Verdict::NoGap].map(demo::diagnosis);
    let mismatch = demo::firmware_mismatch();
    let shown = [&shown[0], &shown[1], &shown[2], &mismatch].map(|diagnosis| (diagnosis, 390));
    let [partly, unknown, no_gap, firmware] = draw(&browser, "verdicts", shown);
    assert!(
        partly("headline").starts_with("Partly explained by a delay of the scalar reading of 51 ms (48 to 54): 94 %")
    );
    assert_eq!(partly("verdicts"), "partly explained | no gap");
    assert!(unknown("headline").ends_with("none of the 23 known effects causes it."));
    assert!(unknown("candidates").starts_with("Something that is not in the library 93"));
    assert_eq!((unknown("lines"), unknown("effects")), ("2".into(), String::new()));
    assert!(no_gap("headline").starts_with("No gap: "));
    assert_eq!((no_gap("verdicts"), no_gap("targets")), ("no gap | no gap".into(), String::new()));
    assert_eq!(no_gap("charts"), "candidates residual spectrum-scalar spectrum-fluxgate", "noise is not mapped");
    assert!(firmware("headline").contains("the firmware or its settings"));
    assert_eq!(firmware("charts"), "candidates map-stage", "nothing else is judged");
}

#[test]
fn targets_are_listed_and_marked() {
    let Some(browser) = browser() else { return };
    let with = |verdict, count| Diagnosis { targets: demo::targets(count), ..demo::diagnosis(verdict) };
    let shown = [(with(Verdict::NoGap, 2), 390), (with(Verdict::NoGap, 15), 1200), (with(Verdict::Unknown, 2), 1200)];
    let shown = shown.each_ref().map(|(diagnosis, width_px)| (diagnosis, *width_px));
    let [two, many, longest] = draw(&browser, "targets_listed", shown);
    assert!(two("headline").ends_with("Its 2 targets are listed below."));
    assert_eq!(two("targets"), "30.0 +1.00 2.1 99 % | 60.0 −2.00 2.1 99 %");
    assert_eq!(two("marks"), "2 2");
    assert_eq!((many("targets").split(" | ").count(), many("marks")), (12, "15 15".into()));
    assert!(many("targets").starts_with("120.0 −4.00"), "the largest, in time");
    assert_eq!(many("headline_lines"), "2");
    assert!(longest("headline").len() > 150 && longest("headline_lines") == "2", "{}", longest("headline"));
}

#[test]
fn names_are_escaped_and_nothing_points_outside() {
    let diagnosis = demo::diagnosis(Verdict::Unknown);
    let hostile = "</script><img src=https://example.com/x onerror=alert(1)>&\"'";
    let mut report = report(&diagnosis, hostile);
    report.warnings.push(hostile.into());
    report.facts.push((hostile.into(), hostile.into()));
    let withheld = [hostile.to_owned()];
    report.withheld = &withheld;
    let page = render_diagnosis(&report).unwrap();
    assert!(!page.contains("<img src=https") && page.contains("default-src 'none'"));
    let Some(browser) = browser() else { return };
    let seen = look(&browser, "hostile_diagnosis", &page, 390, &[]);
    assert_eq!((seen("errors"), seen("loads"), seen("links")), ("none".into(), "0".into(), "0".into()));
    assert_eq!(seen("overflow"), "none");
}
