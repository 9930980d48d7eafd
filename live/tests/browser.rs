//! The page in a real browser, in real time. Its pictures are in `live_page` in the build's folder of temporary files.
#![cfg(not(target_os = "none"))]

mod common;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
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

/// Goes on with the tow, ten epochs a second, until it is dropped.
struct Tow {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Tow {
    fn begin(feed: Feed, start_s: f64) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let thread = std::thread::spawn(move || {
            let mut tick = BEFORE;
            while !stopped.load(Ordering::Relaxed) {
                feed.send(Update::Sample(sample(start_s, tick)));
                tick += 1;
                let rest_s = start_s + 0.1 * f64::from(tick) - now_s();
                std::thread::sleep(Duration::from_secs_f64(rest_s.max(0.0)));
            }
        });
        Self { stop, thread: Some(thread) }
    }
}

impl Drop for Tow {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        _ = self.thread.take().map(JoinHandle::join);
    }
}

/// What is wider than the page, if anything.
const OVERFLOW: &str = "[...document.querySelectorAll('body *')].filter((e) => e.getBoundingClientRect().right > innerWidth + 0.5 && !e.closest('.canvas')).map((e) => e.tagName + '.' + e.className + '#' + e.id).join(' ') || (document.documentElement.scrollWidth > innerWidth ? 'page' : 'none')";

/// Whether the last strip ends above the buttons.
const ALL_SEEN: &str = "document.querySelector('.strip:last-child').getBoundingClientRect().bottom <= document.querySelector('#bars').getBoundingClientRect().top";

/// Buttons that a wet glove misses: a fingertip is 14 mm, which is 53 of the pixels of CSS.
const SMALL: &str = "[...document.querySelectorAll('button')].filter((e) => e.offsetParent && (e.getBoundingClientRect().height < 53 || e.getBoundingClientRect().width < 46)).map((e) => e.id + e.textContent).join(' ') || 'none'";

fn is_right(browser: &mut Browser, tab: &Tab, width_px: u32) {
    // A phone makes its page wider where something does not fit.
    assert_eq!(browser.ask(tab, "innerWidth"), width_px);
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
    let _tow = Tow::begin(feed.clone(), start_s);
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
        browser.until(
            &tab,
            "document.querySelector('#link').textContent.includes('s behind') && !document.querySelector('.sounding')",
        );
        // Everything that is given is on it, and not as an empty chart.
        browser.until(&tab, "towmag.strips.filter((s) => s.plot && s.plot.data[0].length > 1000).length === 5");
        assert_eq!(browser.ask(&tab, "document.querySelectorAll('.lamp.good').length"), 7);
        assert_eq!(browser.ask(&tab, "document.querySelector('#marks li').textContent.endsWith(' buoy')"), true);
        assert!(inked(&mut browser, &tab) > 2_000);
        if width_px >= 1000 {
            assert_eq!(browser.ask(&tab, ALL_SEEN), true, "{name}");
        }
        is_right(&mut browser, &tab, width_px);
        browser.picture(&tab, name);
    }
}

/// Points of the first strip that are not paper.
fn inked(browser: &mut Browser, tab: &Tab) -> u64 {
    let expression = "(() => { const c = document.querySelector('.strip canvas'); const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let n = 0; for (let k = 3; k < d.length; k += 4) n += d[k] > 100; return n; })()";
    browser.ask(tab, expression).as_u64().unwrap()
}

#[test]
fn alarms_sound_until_somebody_has_seen_them() {
    let Some(mut browser) = Browser::start() else { return };
    let mut server = server(|_| {});
    let orders = server.orders().unwrap();
    let (feed, start_s) = fed(&server);
    let _tow = Tow::begin(feed.clone(), start_s);
    let tab = browser.open(&format!("http://{}/", host(&server)), 1024, 768, false);
    assert_eq!(browser.ask(&tab, "document.querySelector('#sound').textContent"), "Tap for sound");
    browser.click(&tab, "#title");
    browser.until(&tab, "towmag.alarms.isReady()");
    feed.send(Update::Lamps(Lamps { sensor: Lamp::new(Level::Bad, "no scalar"), ..lamps() }));
    browser.until(&tab, "document.querySelector('.alarm.sounding')?.textContent.includes('Sensor: no scalar')");
    browser.until(&tab, "towmag.alarms.beeps >= 2");
    is_right(&mut browser, &tab, 1024);
    assert_eq!(browser.ask(&tab, ALL_SEEN), true);
    browser.picture(&tab, "alarm");
    browser.click(&tab, ".alarm button");
    browser.until(&tab, "document.querySelector('.alarm.seen') && !towmag.alarms.isSounding()");
    assert_eq!(
        orders.recv_timeout(Duration::from_secs(5)).unwrap(),
        Order::Note("alarm seen: Sensor: no scalar".into())
    );
    feed.send(Update::Lamps(lamps()));
    browser.until(&tab, "!document.querySelector('.alarm')");
    // A target, seen by the key.
    feed.send(contact(7, now_s()));
    browser.until(
        &tab,
        "document.querySelector('.alarm.sounding') && document.querySelector('#contacts').textContent.includes('T7')",
    );
    browser.press(&tab, "a");
    browser.until(&tab, "!document.querySelector('.alarm')");
    assert_eq!(browser.errors, Vec::<String>::new());
}

#[test]
fn the_page_comes_back_after_the_server_and_fills_its_gap() {
    let Some(mut browser) = Browser::start() else { return };
    let (first, start_s) = (server(|_| {}), now_s() - 0.1 * f64::from(BEFORE));
    let address = first.address();
    fed(&first);
    let tab = browser.open(&format!("http://{}/", host(&first)), 800, 600, false);
    browser.until(&tab, "towmag.store.time.length > 1000");
    drop(first);
    browser.until(&tab, "document.querySelector('#link').textContent.startsWith('NO CONNECTION')");
    // No lamp is green that nobody has heard of, and who sleeps is woken.
    browser.until(&tab, "!document.querySelector('.lamp.good') && document.querySelector('#lamps').textContent.includes('was: logging')");
    browser.until(&tab, "document.querySelector('.alarm.sounding')?.textContent.includes('nothing here is new')");
    browser.picture(&tab, "lost");
    browser.click(&tab, ".alarm button");
    browser.until(&tab, "!towmag.alarms.isSounding()");
    let second = server(|options| options.address = address);
    let feed = second.feed();
    // It was away for five seconds, and has heard the last four of them.
    (BEFORE + 10..BEFORE + 50).for_each(|tick| feed.send(Update::Sample(sample(start_s, tick))));
    browser.until(&tab, "document.querySelector('#link').className === '' && !document.querySelector('#alarms').textContent.includes('nothing here is new')");
    browser.until(&tab, &format!("towmag.store.last > {}", start_s + 0.1 * f64::from(BEFORE + 48)));
    let gaps =
        "(() => { const t = towmag.store.time; return t.slice(1).filter((time, k) => time - t[k] > 0.8).length; })()";
    assert_eq!(browser.ask(&tab, gaps), 1, "what was before is still there, and only what nobody heard is missing");
    assert!(browser.ask(&tab, "towmag.store.time.length").as_u64().unwrap() > 1_000);
    // And a connection alone that is lost: nothing is missing.
    browser.ask(&tab, "void towmag.link.socket.close()");
    (BEFORE + 50..BEFORE + 80).for_each(|tick| feed.send(Update::Sample(sample(start_s, tick))));
    browser.until(&tab, &format!("towmag.store.last > {}", start_s + 0.1 * f64::from(BEFORE + 78)));
    assert_eq!(browser.ask(&tab, gaps), 1);
    // The browser itself tells of the refused connections.
    browser.errors.retain(|error| !error.contains("WebSocket connection to"));
    assert_eq!(browser.errors, Vec::<String>::new());
}

/// What of a picture is not black or red: night eyes see it.
const DAYLIGHT: &str = "(async () => { const image = new Image(); image.src = 'data:image/png;base64,' + PICTURE; await image.decode(); const c = document.createElement('canvas'); [c.width, c.height] = [image.width, image.height]; const x = c.getContext('2d'); x.drawImage(image, 0, 0); const d = x.getImageData(0, 0, c.width, c.height).data; let n = 0; for (let k = 0; k < d.length; k += 4) n += d[k + 1] > 150 || d[k + 2] > 140; return n; })()";

#[test]
fn keys_do_all_and_the_night_is_red_on_black() {
    use base64::Engine;
    let Some(mut browser) = Browser::start() else { return };
    let mut server = server(|options| options.allow_commands = true);
    let orders = server.orders().unwrap();
    let (feed, start_s) = fed(&server);
    let _tow = Tow::begin(feed.clone(), start_s);
    let tab = browser.open(&format!("http://{}/", host(&server)), 1280, 800, false);
    browser.until(&tab, "towmag.screen.drawn > 1 && towmag.store.time.length > 1000");
    browser.press(&tab, "1");
    browser.until(&tab, "towmag.store.window === 120 && towmag.store.cell === 0.1 && towmag.store.time.length > 1100");
    browser.press(&tab, "w");
    browser.until(&tab, "towmag.strips[0].scale.textContent === 'wrapped at 100 nT'");
    browser.press(&tab, "+");
    browser.press(&tab, "+");
    browser.until(&tab, "towmag.strips[0].plot.scales.y0.max === 20 && towmag.strips[0].plot.scales.y0.min === 0");
    let within = "towmag.strips[0].plot.data.slice(1).every((line) => line.every((value) => value == null || (value >= 0 && value <= 20)))";
    assert_eq!(browser.ask(&tab, within), true);
    browser.picture(&tab, "wrapped");
    browser.press(&tab, "w");
    browser.until(&tab, "towmag.strips[0].scale.textContent === 'fixed, 20 nT' && towmag.strips[0].plot.scales.y0.max - towmag.strips[0].plot.scales.y0.min === 20");
    browser.press(&tab, "ArrowDown");
    browser.press(&tab, "ArrowDown");
    browser.until(&tab, "document.querySelector('.strip.chosen strong').textContent === 'Residual'");
    browser.press(&tab, "m");
    let Order::Mark(mark) = orders.recv_timeout(Duration::from_secs(5)).unwrap() else { panic!("no mark") };
    assert!((now_s() - mark.time_s).abs() < 3.0, "{mark:?}");
    feed.send(Update::Mark(mark));
    browser.until(&tab, "document.querySelector('#marks li')");
    // A touch names the time, and the key or the button marks it; letters in a field are letters.
    browser.click(&tab, ".strip canvas");
    browser.until(&tab, "/^Mark \\d\\d:/.test(document.querySelector('#mark').textContent)");
    browser.click(&tab, "#label");
    "wreck".chars().for_each(|key| browser.press(&tab, &key.to_string()));
    browser.click(&tab, "#mark");
    let Order::Mark(mark) = orders.recv_timeout(Duration::from_secs(5)).unwrap() else { panic!("no mark") };
    assert!((20.0..100.0).contains(&(now_s() - mark.time_s)) && mark.label == "wreck", "{mark:?}");
    browser.click(&tab, "#line");
    "status".chars().for_each(|key| browser.press(&tab, &key.to_string()));
    browser.click(&tab, "#command button");
    assert_eq!(orders.recv_timeout(Duration::from_secs(5)).unwrap(), Order::Command("status".into()));
    browser.click(&tab, "#title");
    browser.ask(&tab, "void document.activeElement.blur()");
    browser.press(&tab, "n");
    browser.until(&tab, "document.documentElement.dataset.colours === 'night'");
    feed.send(Update::Lamps(Lamps {
        log: Lamp::new(Level::Bad, "NOT LOGGED"),
        card: Lamp::new(Level::Warn, "slow"),
        ..lamps()
    }));
    browser.until(&tab, "document.querySelector('.alarm.sounding')");
    std::thread::sleep(Duration::from_millis(300));
    let picture = browser.picture(&tab, "night");
    let encoded = base64::engine::general_purpose::STANDARD.encode(picture);
    assert_eq!(browser.ask(&tab, &DAYLIGHT.replace("PICTURE", &format!("'{encoded}'"))), 0);
    is_right(&mut browser, &tab, 1280);
}
