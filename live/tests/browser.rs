//! The page in a real browser, in real time. Its pictures are in `live_page` in the build's folder of temporary files.
#![cfg(not(target_os = "none"))]

mod common;

use std::time::Duration;

use common::browser::{Browser, Tab};
use common::demo::{contact, host, lamps, now_s, sample, server};
use towmag_live::{Feed, Lamp, Lamps, Level, Mark, Order, Server, Update};

/// Minutes that are there when the page is opened.
const BEFORE: u32 = 11 * 600;

fn fed(server: &Server) -> (Feed, f64) {
    let (feed, start_s) = (server.feed(), now_s() - 0.1 * f64::from(BEFORE));
    feed.send(Update::Lamps(lamps()));
    for tick in 0..BEFORE {
        feed.send(Update::Sample(sample(start_s, tick)));
        // A queue has its end.
        if tick % 1_000 == 999 {
            std::thread::sleep(Duration::from_millis(60));
        }
    }
    assert_eq!(feed.lost(), 0);
    (feed, start_s)
}

/// What is wider than the page, if anything.
const OVERFLOW: &str = "[...document.querySelectorAll('body *')].filter((e) => e.getBoundingClientRect().right > innerWidth + 0.5 && !e.closest('.canvas')).map((e) => e.tagName + '.' + e.className + '#' + e.id).join(' ') || (document.documentElement.scrollWidth > innerWidth ? 'page' : 'none')";

/// Buttons that a wet glove misses: a fingertip is 14 mm, which is 53 of the pixels of CSS.
const SMALL: &str = "[...document.querySelectorAll('button')].filter((e) => e.offsetParent && (e.getBoundingClientRect().height < 53 || e.getBoundingClientRect().width < 46)).map((e) => e.id + e.textContent).join(' ') || 'none'";

fn is_right(browser: &mut Browser, tab: &Tab) {
    assert_eq!(browser.ask(tab, OVERFLOW), "none");
    assert_eq!(browser.ask(tab, SMALL), "none");
    assert_eq!(browser.errors, Vec::<String>::new());
}

#[test]
fn strips_are_drawn_on_every_screen() {
    let Some(mut browser) = Browser::start() else { return };
    let server = server(|_| {});
    let (feed, start_s) = fed(&server);
    feed.send(contact(1, start_s + 240.0));
    feed.send(Update::Mark(Mark { time_s: start_s + 400.0, label: "buoy".into() }));
    let address = format!("http://{}/", host(&server));
    for (name, width_px, height_px, is_phone) in [
        ("desk", 1440, 900, false),
        ("tablet", 1024, 768, false),
        ("upright", 800, 1200, false),
        ("phone", 390, 844, true),
    ] {
        let tab = browser.open(&address, width_px, height_px, is_phone);
        browser.until(&tab, "towmag.store.time.length > 1000 && towmag.screen.drawn > 1");
        browser.press(&tab, "a");
        std::thread::sleep(Duration::from_millis(200));
        browser.picture(&tab, name);
        is_right(&mut browser, &tab);
    }
}
