//! What goes over the wire, to viewers that are no browsers.
#![cfg(not(target_os = "none"))]

mod common;

use std::time::{Duration, Instant};

use common::demo::{contact, host, lamps, now_s, sample, server};
use common::raw::{Viewer, get};
use serde_json::{Value, json};
use towmag_live::{Feed, Lamp, Lamps, Level, Mark, Order, Sample, Update};

fn send(feed: &Feed, start_s: f64, ticks: std::ops::Range<u32>) {
    ticks.for_each(|tick| feed.send(Update::Sample(sample(start_s, tick))));
}

/// Wait until a viewer finds an epoch in the history: all that was sent before is there then.
fn settled(host: &str, time_s: f64) {
    let begin = Instant::now();
    while Viewer::greeted(host).1["now_s"].as_f64().is_none_or(|now_s| now_s < time_s - 0.01) {
        assert!(begin.elapsed() < Duration::from_secs(5));
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_viewer_is_greeted_and_sent_what_is_new() {
    let server = server(|_| {});
    let (feed, start_s) = (server.feed(), now_s());
    feed.send(Update::Lamps(lamps()));
    feed.send(Update::Text("settings: intact".into()));
    feed.send(contact(1, start_s));
    send(&feed, start_s, 0..50);
    settled(&host(&server), start_s + 4.9);
    let (mut viewer, hello) = Viewer::greeted(&host(&server));
    assert_eq!(
        (&hello["title"], &hello["may_mark"], &hello["may_command"]),
        (&json!("demo"), &json!(true), &json!(false))
    );
    assert_eq!((&hello["lamps"]["log"]["level"], &hello["texts"][0]), (&json!("good"), &json!("settings: intact")));
    assert_eq!((&hello["contacts"][0]["snr"], &hello["alarms"][0]["kind"]), (&json!(31.0), &json!("target")));
    send(&feed, start_s, 50..51);
    let epochs = viewer.next("epochs");
    let row = &epochs["rows"][0];
    assert!((row[0].as_f64().unwrap() - start_s - 5.0).abs() < 1e-6);
    let [raw_nt, compensated_nt, deviation_nt] = [0, 1, 2].map(|place| row[2][place].as_f64().unwrap());
    assert!((raw_nt - compensated_nt - deviation_nt).abs() < 1e-3, "{row}");
    assert_eq!((row[2].as_array().unwrap().len(), &row[4], &epochs["lost"]), (6, &json!(15.8), &json!(0)));
    // The same lamps again are no news.
    feed.send(Update::Lamps(lamps()));
    feed.send(Update::Lamps(Lamps { card: Lamp::new(Level::Warn, "slow"), ..lamps() }));
    assert_eq!(viewer.next("lamps")["lamps"]["card"]["word"], "slow");
    feed.send(Update::End);
    viewer.next("end");
    assert_eq!(Viewer::greeted(&host(&server)).1["is_over"], true);
}

fn history(viewer: &mut Viewer, wish: Value) -> Value {
    viewer.send(&wish.to_string());
    viewer.next("history")
}

#[test]
fn the_history_fills_a_gap_exactly() {
    let server = server(|_| {});
    let (feed, start_s) = (server.feed(), now_s());
    send(&feed, start_s, 0..3_000);
    settled(&host(&server), start_s + 299.9);
    let (mut viewer, _) = Viewer::greeted(&host(&server));
    let all = history(&mut viewer, json!({"want": "history", "window_s": 600, "since_s": null}));
    let times: Vec<f64> = all["time_s"].as_array().unwrap().iter().map(|time| time.as_f64().unwrap()).collect();
    assert!((600..=602).contains(&times.len()) && all["cell_s"] == 0.5, "{}", times.len());
    assert!((299..=301).contains(&all["track"].as_array().unwrap().len()));
    let since_s = start_s + 200.0;
    let part = history(&mut viewer, json!({"want": "history", "window_s": 600, "since_s": since_s}));
    let count = part["time_s"].as_array().unwrap().len();
    assert!((200..=202).contains(&count), "{count}");
    let (low, high) = (all["low"].as_array().unwrap(), part["low"].as_array().unwrap());
    assert_eq!(low[low.len() - count..], high[..], "what is sent again is the same");
    let fine = history(&mut viewer, json!({"want": "history", "window_s": 120, "since_s": null}));
    assert_eq!(fine["time_s"].as_array().unwrap().len(), 1_201);
}

#[test]
fn marks_and_seen_alarms_go_to_whoever_records() {
    let mut server = server(|_| {});
    let (feed, orders, start_s) = (server.feed(), server.orders().unwrap(), now_s());
    assert!(server.orders().is_none());
    send(&feed, start_s, 0..20);
    settled(&host(&server), start_s + 1.9);
    let (mut viewer, _) = Viewer::greeted(&host(&server));
    let mut order = |json: &str| {
        viewer.send(json);
        orders.recv_timeout(Duration::from_secs(5)).unwrap()
    };
    let label = |label: &str, time_s| Order::Mark(Mark { time_s, label: label.into() });
    let Order::Mark(now) = order(r#"{"want":"mark","time_s":null,"label":"wreck"}"#) else { panic!("no mark") };
    assert!((now.time_s - start_s - 1.9).abs() < 1e-3 && now.label == "wreck");
    // Times beyond what is known are brought to its ends.
    assert_eq!(order(r#"{"want":"mark","time_s":1e300,"label":""}"#), label("", now.time_s));
    assert_eq!(order(r#"{"want":"mark","time_s":-5,"label":""}"#), label("", start_s));
    feed.send(contact(1, start_s));
    viewer.next("alarms");
    viewer.send(r#"{"want":"acknowledge","alarm":"target"}"#);
    assert_eq!(viewer.next("alarms")["alarms"], json!([]));
    let seen = orders.recv_timeout(Duration::from_secs(5)).unwrap();
    assert_eq!(seen, Order::Note("alarm seen: Target 1: +8.7 nT, signal to noise 31".into()));
    // No alarm, no command: nothing is ordered.
    viewer.send(r#"{"want":"acknowledge","alarm":"rum"}"#);
    viewer.send(r#"{"want":"command","line":"status"}"#);
    assert!(viewer.next("refused")["text"].as_str().unwrap().contains("--allow-commands"));
    assert!(orders.try_recv().is_err());
}

#[test]
fn commands_where_they_are_allowed() {
    let mut server = server(|options| options.allow_commands = true);
    let orders = server.orders().unwrap();
    let (mut viewer, hello) = Viewer::greeted(&host(&server));
    assert_eq!(hello["may_command"], true);
    viewer.send(r#"{"want":"command","line":"status"}"#);
    assert_eq!(orders.recv_timeout(Duration::from_secs(5)).unwrap(), Order::Command("status".into()));
}

/// The kinds of the alarms that come until there is one of this kind in this state.
fn alarm(viewer: &mut Viewer, kind: &str, is_over: bool) {
    let begin = Instant::now();
    loop {
        let told = viewer.next("alarms");
        if told["alarms"].as_array().unwrap().iter().any(|alarm| alarm["kind"] == kind && alarm["is_over"] == is_over) {
            return;
        }
        assert!(begin.elapsed() < Duration::from_secs(8), "no {kind}");
    }
}

#[test]
fn everything_that_goes_wrong_has_its_alarm() {
    let server = server(|_| {});
    let (feed, start_s) = (server.feed(), now_s());
    let (mut viewer, _) = Viewer::greeted(&host(&server));
    feed.send(Update::Lamps(lamps()));
    send(&feed, start_s, 0..10);
    let lost =
        Lamps { sensor: Lamp::new(Level::Bad, "no scalar"), log: Lamp::new(Level::Bad, "NOT LOGGED"), ..lamps() };
    feed.send(Update::Lamps(lost));
    send(&feed, start_s, 10..22);
    alarm(&mut viewer, "log", false);
    feed.send(Update::Lamps(lamps()));
    send(&feed, start_s, 22..24);
    alarm(&mut viewer, "sensor", true);
    let low = |tick| Sample { altitude_m: Some(1.5), has_leak: Some(true), ..sample(start_s, tick) };
    (24..36).for_each(|tick| feed.send(Update::Sample(low(tick))));
    alarm(&mut viewer, "leak", false);
    alarm(&mut viewer, "altitude", false);
    // And now nothing at all.
    alarm(&mut viewer, "cable", false);
    send(&feed, start_s, 36..38);
    alarm(&mut viewer, "cable", true);
}

#[test]
fn a_recording_that_is_shown_again_may_be_silent() {
    let server = server(|options| options.is_live = false);
    let (mut viewer, _) = Viewer::greeted(&host(&server));
    std::thread::sleep(Duration::from_millis(2_600));
    server.feed().send(Update::Text("now".into()));
    viewer.next("text");
    assert_eq!(Viewer::greeted(&host(&server)).1["alarms"], json!([]));
}

#[test]
fn the_page_needs_nothing_from_elsewhere() {
    let server = server(|_| {});
    let answer = get(&host(&server), "/");
    let (head, page) = answer.split_once("\r\n\r\n").unwrap();
    assert!(head.starts_with("HTTP/1.1 200"), "{head}");
    for header in [
        "content-security-policy: default-src 'none'",
        "x-content-type-options: nosniff",
        "referrer-policy: no-referrer",
        "cache-control: no-store",
    ] {
        assert!(head.contains(header), "{header} in {head}");
    }
    assert!(page.len() < 150_000 && !page.contains("{{") && page.contains("uPlot"), "{}", page.len());
    assert_eq!((page.matches("src=").count(), page.matches("<link").count()), (0, 1));
    let nonce = |answer: &str| answer[answer.find("nonce-").unwrap()..][..38].to_string();
    assert_ne!(nonce(&answer), nonce(&get(&host(&common::demo::server(|_| {})), "/")), "each start has its own");
}

#[test]
fn an_address_that_is_taken_is_said() {
    let server = server(|_| {});
    let options = towmag_live::LiveOptions::new(server.address().unwrap(), "again");
    let error = towmag_live::Server::start(options).unwrap_err().to_string();
    assert!(
        error.starts_with(&format!("--serve {}: ", host(&server))) && error.ends_with("Name another port"),
        "{error}"
    );
    assert_eq!(server.links(), [format!("http://{}/", host(&server))]);
}

#[test]
fn others_look_with_the_token_and_do_nothing_else() {
    let mut server = server(|options| {
        options.address = Some("0.0.0.0:0".parse().unwrap());
        options.allow_commands = true;
    });
    let orders = server.orders().unwrap();
    let link = server.links()[1].clone();
    let (other, token) = link.trim_start_matches("http://").split_once('/').unwrap();
    if other.starts_with("0.0.0.0") {
        println!("skipped: this machine has no address but its own");
        return;
    }
    // From this address of the machine, not from its loopback.
    assert!(get(other, "/").starts_with("HTTP/1.1 403"));
    assert!(get(other, "/?token=0123456789abcdef0123456789abcdef").starts_with("HTTP/1.1 403"));
    assert!(Viewer::connect(other, "/live", &[]).is_err());
    assert!(get(other, &format!("/{token}")).starts_with("HTTP/1.1 200"));
    let mut viewer = Viewer::connect(other, &format!("/live{token}"), &[]).unwrap();
    let hello = viewer.next("hello");
    assert_eq!((&hello["may_mark"], &hello["may_command"]), (&json!(false), &json!(false)));
    for wish in [
        r#"{"want":"mark","time_s":null,"label":"a"}"#,
        r#"{"want":"acknowledge","alarm":"target"}"#,
        r#"{"want":"command","line":"status"}"#,
    ] {
        viewer.send(wish);
        viewer.next("refused");
    }
    assert!(orders.try_recv().is_err());
    viewer.send(r#"{"want":"history","window_s":120,"since_s":null}"#);
    viewer.next("history");
}
