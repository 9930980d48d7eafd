//! The page of a survey: the answer first, small, drawn without the network, readable on a phone.

use crate::report::demo_survey;

use crate::report::browser::{browser, look_at, look_at_widths};
use host_sim::report::{SurveyReport, render_survey};
use towmag_survey::Survey;

/// 2026-06-01 08:01:40 UTC.
const BEGAN_UTC_S: f64 = 1_780_300_900.0;

/// What a page may weigh.
const LARGEST_BYTES: usize = 1_500_000;

fn page(survey: &Survey, utc_offset_s: &[Option<f64>]) -> String {
    let facts = [("Recording".to_string(), "2 files, 36 min".to_string())];
    render_survey(&SurveyReport { survey, utc_offset_s, warnings: &[], facts: &facts }).unwrap()
}

fn demo() -> String {
    page(&demo_survey::survey(true), &[Some(BEGAN_UTC_S), None])
}

const QUESTIONS: [(&str, &str); 8] = [
    ("rows", "document.querySelectorAll('table.contacts tbody tr').length"),
    ("pins", "document.querySelectorAll('.pin').length"),
    ("cards", "document.querySelectorAll('.card .plot path.fit').length"),
    ("marks", "document.querySelectorAll('.mark').length"),
    ("first", "document.querySelector('table.contacts tbody th a').textContent"),
    ("folds", "document.querySelector('h1').getBoundingClientRect().bottom < 420"),
    (
        "reached",
        "[...document.querySelectorAll('.pin, .no[href], .mark')].every((link) => document.querySelector(link.getAttribute('href')))",
    ),
    (
        "read",
        "(() => { const plot = document.querySelector('.plot.anomaly'); plot.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight'})); return plot.querySelector('output').textContent; })()",
    ),
];

#[test]
fn survey_is_drawn_whole_on_screens_and_on_a_phone() {
    let page = demo();
    assert!(!page.contains("Plotly"), "the large chart library has no place here");
    let Some(browser) = browser() else { return };
    for (width_px, seen) in look_at_widths(&browser, "survey", &page, [360, 620, 1024, 1200, 1500], &QUESTIONS) {
        assert_eq!((seen("errors"), seen("overflow")), ("none".into(), "none".into()), "at {width_px} px");
        assert_eq!((seen("loads"), seen("links")), ("0".into(), "0".into()));
        assert_eq!([seen("rows"), seen("pins"), seen("cards"), seen("marks")], ["8", "8", "8", "8"].map(String::from));
        // Eight profiles, and four charts of each recording.
        assert_eq!(seen("drawn"), "16");
        assert_eq!((seen("reached"), seen("folds")), ("true".into(), "true".into()));
        let read = seen("read");
        assert!(read.starts_with("08:14:") && read.ends_with(" nT"), "{read}");
    }
}

#[test]
fn what_to_dive_for_comes_first() {
    let survey = demo_survey::survey(true);
    let page = demo();
    let heaviest =
        survey.contacts.iter().max_by(|a, b| a.moment_am2.unwrap().low.total_cmp(&b.moment_am2.unwrap().low));
    let number = heaviest.unwrap().number;
    assert!(
        page.contains(&format!("8 contacts. Dive for no.\u{a0}{number} first: 54°\u{a0}10.")),
        "the answer is the headline"
    );
    assert!(page.contains("<span>08:05</span>") && page.contains("2026-06-01 UTC"), "clock time where it is known");
    assert!(page.contains("&#60;north &#38; south&#62;"), "names are escaped");
    // The one that may be nothing is the last, and says so.
    let unsure = survey.contacts.iter().find(|contact| contact.false_alarm_probability > 0.01).unwrap();
    let last = page.rfind("<tr><th scope=\"row\"><a class=\"no").unwrap();
    assert!(
        page[last..]
            .starts_with(&format!("<tr><th scope=\"row\"><a class=\"no unsure\" href=\"#contact-{}\"", unsure.number))
    );
}

#[test]
fn an_hour_with_sixty_contacts_stays_small() {
    let survey = demo_survey::long_survey();
    assert!(survey.tows[0].time_s.len() > 36_000);
    let page = page(&survey, &[Some(BEGAN_UTC_S)]);
    assert!(page.len() < LARGEST_BYTES, "{} bytes", page.len());
    println!("{} bytes", page.len());
}

#[test]
fn survey_without_a_track_or_contacts_is_still_a_page() {
    let untracked = page(&demo_survey::survey(false), &[]);
    assert!(
        !untracked.contains("<h2>Map") && !untracked.contains("of iron</") && untracked.contains("<th>Time, s</th>")
    );
    let mut nothing = demo_survey::survey(true);
    nothing.contacts.clear();
    let page_of_nothing = page(&nothing, &[]);
    assert!(
        page_of_nothing.contains("No contact. Of iron of 0.19 to 1.9\u{a0}kg and more"),
        "what would have been found is said"
    );
    let empty = page(&Survey { tows: Vec::new(), contacts: Vec::new(), smallest_moment_am2: None, ..nothing }, &[]);
    assert!(empty.contains("No contact."));
    let Some(browser) = browser() else { return };
    let pages = [&untracked, &page_of_nothing, &empty].map(|page| (page.as_str(), 360));
    for (name, seen) in ["untracked", "no_contact", "empty"].into_iter().zip(look_at(&browser, "bare", pages, &[])) {
        assert_eq!((seen("errors"), seen("overflow")), ("none".into(), "none".into()), "{name}");
    }
}
