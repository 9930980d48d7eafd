//! The page in a real browser: drawn, without an error, without the network, and not wider than a phone.

use crate::report::demo;

use crate::report::browser::{browser, look, look_at, look_at_widths};
use host_sim::detection::{Combination, Detection};
use host_sim::report::{Kind, Mark, ReportData, headline, render};

/// Time, spectrum, heading and three groups of coefficients: one element each.
const CHARTS: usize = 6;

/// What this page is asked beside what every page is.
const QUESTIONS: [(&str, &str); 4] = [
    (
        "axes",
        "[...document.querySelectorAll('.chart')].filter((chart) => chart.querySelector('.cartesianlayer .xtick')).length",
    ),
    ("lines", "document.querySelectorAll('#over-time .scatterlayer .trace').length"),
    ("bars", "document.querySelectorAll('#by-heading .point').length"),
    ("markers", "document.querySelectorAll('[id^=coefficients-] path.point').length"),
];

/// A page by its name, what it shows, and what was seen of it.
fn check(name: &str, data: &ReportData, width_px: u32, seen: impl Fn(&str) -> String) {
    let number = |key: &str| seen(key).parse::<usize>().unwrap();
    assert_eq!(seen("errors"), "none");
    assert_eq!(number("width"), width_px as usize);
    assert_eq!(number("drawn"), CHARTS);
    assert_eq!(number("axes"), CHARTS, "{name}: a chart has no axis");
    // The scalar, and two lines per method; the uncompensated residual is off, for it would dwarf them, and so is a method
    // that leaves more than twice as much as the best.
    let least_nt = data.methods.iter().map(|method| method.std_after_nt).fold(f64::INFINITY, f64::min);
    let quiet = data.methods.iter().filter(|method| method.std_after_nt <= 2.0 * least_nt).count();
    assert_eq!(number("lines"), 1 + 2 * quiet);
    assert!(number("bars") >= data.methods.len(), "{name}: no bars");
    assert_eq!(number("markers"), 18 * data.methods.len());
    assert_eq!(seen("overflow"), "none", "{name} at {width_px} px");
    assert_eq!((number("loads"), number("links")), (0, 0), "{name}: something came from elsewhere");
}

#[test]
fn page_is_drawn_whole_on_a_screen_and_on_a_phone() {
    let Some(browser) = browser() else { return };
    let [compare, replay, calibrate] = [(Kind::Compare, 26_000), (Kind::Replay, 3_000), (Kind::Calibrate, 9_000)]
        .map(|(kind, rows)| demo::report(kind, rows));
    let pages = [&compare, &replay, &calibrate].map(|data| render(data).unwrap());
    let shown = [(&pages[0], 390), (&pages[0], 1600), (&pages[1], 390), (&pages[2], 390)];
    let seen = look_at(&browser, "kinds", shown.map(|(page, width_px)| (page.as_str(), width_px)), &QUESTIONS);
    let told = [("compare", &compare), ("compare", &compare), ("replay", &replay), ("calibrate", &calibrate)];
    for (((name, data), (_, width_px)), seen) in told.into_iter().zip(shown).zip(seen) {
        check(name, data, width_px, seen);
    }
}

#[test]
fn what_eats_targets_does_not_wear_the_badge_and_time_is_of_the_clock() {
    let mut data = demo::report(Kind::Compare, 9_000);
    let quietest = data.methods.iter().map(|method| method.std_after_nt).fold(f64::INFINITY, f64::min);
    let rls = data.methods.iter().position(|method| method.name == "rls").unwrap();
    data.methods[rls].std_after_nt = 0.9 * quietest;
    let methods = vec![detection("rls", 1.0, 0.80), detection("adaptive", 1.1, 0.97)];
    data.targets = Some(Combination { calibration: "c".into(), recording: "r".into(), bound_nT: 0.4, methods });
    data.headline = headline(&data.methods, data.targets.as_ref());
    data.utc_offset_s = Some(1_780_300_900.0);
    data.marks = vec![Mark { time_s: 400.0, label: "no. 1 <wreck>".into() }];
    data.marks_note = Some("Contacts of the survey.".into());
    assert!(data.headline.starts_with("adaptive leaves") && data.headline.contains("97\u{a0}% of a target is kept"));
    assert!(data.headline.contains("from the third minute on"), "{}", data.headline);
    let page = render(&data).unwrap();
    assert!(page.contains("Figure of merit of adaptive"), "the demo rolls");
    let Some(browser) = browser() else { return };
    let questions = [
        ("best", "[...document.querySelectorAll('.methods .best th')].map((cell) => cell.innerText).join('; ')"),
        ("clock", "[...document.querySelectorAll('#over-time .xtick text')].map((text) => text.textContent).join(' ')"),
        ("mark", "document.querySelector('#over-time .annotation').textContent"),
        ("sectors", "document.querySelectorAll('.sectors tbody tr').length"),
    ];
    for (width_px, seen) in look_at_widths(&browser, "badge", &page, [360, 1500], &questions) {
        assert_eq!((seen("errors"), seen("overflow")), ("none".into(), "none".into()), "at {width_px} px");
        assert!(seen("best").starts_with("adaptive"), "{}", seen("best"));
        assert!(seen("clock").contains("08:0"), "{}", seen("clock"));
        assert!(seen("mark").contains("no. 1"), "{}", seen("mark"));
        assert!(seen("sectors").parse::<usize>().unwrap() >= 2);
    }
}

fn detection(method: &str, residual_over_bound: f64, kept: f64) -> Detection {
    Detection {
        method: method.into(),
        residual_nT: 0.4 * residual_over_bound,
        residual_over_bound,
        end_to_end_over_bound: 1.05 * residual_over_bound,
        kept,
        kept_strong: None,
        distortion: 0.032,
        detection: kept / residual_over_bound,
    }
}

#[test]
fn targets_have_a_table_for_each_pair_of_recordings() {
    let mut data = demo::report(Kind::Compare, 3_000);
    let combination = |bound_nt: f64| Combination {
        calibration: "box <1>_calibration.csv".into(),
        recording: "line_07 <North & South>_a_rather_long_name_of_a_survey.csv".into(),
        bound_nT: bound_nt,
        methods: vec![
            detection("fixed", 121.4, 1.0),
            detection("rls", 1.055, 0.864),
            detection("saddle-point", 1.057, 0.865),
            detection("adaptive", 1.006, 0.955),
        ],
    };
    data.detection = vec![combination(0.409), combination(3.117)];
    let page = render(&data).unwrap();
    assert!(page.contains("line_07 &#60;North &#38; South&#62;_a_rather"), "names are escaped");
    let Some(browser) = browser() else { return };
    let questions = [
        ("tables", "document.querySelectorAll('.targets').length"),
        (
            "best",
            "[...document.querySelectorAll('.targets .best th')].map((cell) => cell.firstChild.data.trim()).join(' ')",
        ),
        (
            "first",
            "[...document.querySelectorAll('.targets .best')[0].querySelectorAll('td')].map((cell) => cell.innerText).join(' | ')",
        ),
        (
            "shown",
            "[...document.querySelectorAll('.targets td')].every((cell) => cell.getBoundingClientRect().width > 20)",
        ),
    ];
    for (width_px, seen) in look_at_widths(&browser, "targets", &page, [390, 1600], &questions) {
        assert_eq!((seen("errors"), seen("overflow")), ("none".into(), "none".into()), "at {width_px} px");
        assert_eq!((seen("tables"), seen("shown")), ("2".into(), "true".into()));
        assert_eq!(seen("best"), "adaptive adaptive");
        assert_eq!(seen("first"), "1.01 | 1.06 | 96 | 3.2 | 0.95");
    }
}

#[test]
fn page_of_nothing_says_so_and_is_still_a_page() {
    let mut data = demo::report(Kind::Replay, 0);
    data.methods.clear();
    let page = render(&data).unwrap();
    assert!(page.contains("The heading is not known"));
    let Some(browser) = browser() else { return };
    let seen = look(&browser, "nothing", &page, 390, &[]);
    assert_eq!((seen("errors"), seen("drawn"), seen("overflow")), ("none".into(), "1".into(), "none".into()));
}

#[test]
fn text_from_the_data_is_escaped_and_nothing_points_outside() {
    let mut data = demo::report(Kind::Calibrate, 3_000);
    let hostile = "</script><img src=https://example.com/x onerror=alert(1)>&\"'";
    data.recording = hostile.into();
    data.title = hostile.into();
    data.headline = hostile.into();
    data.warnings.push(hostile.into());
    data.facts.push((hostile.into(), hostile.into()));
    data.methods[0].name = hostile.into();
    let page = render(&data).unwrap();
    assert!(!page.contains("<img src=https"));
    assert!(page.contains("default-src 'none'"));
    assert!(page.contains("fitted to this very recording") && !page.contains("strictly predictive"));
    if let Some(browser) = browser() {
        let seen = look(&browser, "hostile", &page, 390, &[]);
        assert_eq!((seen("errors"), seen("loads"), seen("links")), ("none".into(), "0".into(), "0".into()));
        assert_eq!(seen("overflow"), "none");
    }
}
