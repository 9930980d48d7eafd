//! The page in a real browser: drawn, without an error, without the network, and not wider than a phone.
#![cfg(not(target_os = "none"))]

#[path = "report/demo.rs"]
mod demo;

use std::path::{Path, PathBuf};
use std::process::Command;

use host_sim::report::{Kind, render};

/// Time, spectrum, heading and three groups of coefficients: one element each.
const CHARTS: usize = 6;

/// Asks the drawn page what it looks like and tells the page around it.
const PROBE: &str = r##"<script>
const wait = setInterval(() => {
  const state = document.documentElement.dataset;
  if (!state.drawn && !state.errors) return;
  clearInterval(wait);
  for (const details of document.querySelectorAll("details")) details.open = true;
  const edge = document.querySelector("h1").getBoundingClientRect().right; // of the text column
  const wide = [...document.querySelectorAll("main :not(svg *)")].filter((e) => e.getBoundingClientRect().right > edge + 0.5);
  parent.postMessage({
    drawn: state.drawn, errors: state.errors || "none", width: innerWidth,
    axes: [...document.querySelectorAll(".chart")].filter((chart) => chart.querySelector(".cartesianlayer .xtick")).length,
    lines: document.querySelectorAll("#over-time .scatterlayer .trace").length,
    bars: document.querySelectorAll("#by-heading .point").length,
    markers: document.querySelectorAll("[id^=coefficients-] path.point").length,
    overflow: wide.map((e) => e.tagName + "." + e.className).join(" ") || (document.documentElement.scrollWidth > innerWidth ? "page" : "none"),
    loads: performance.getEntriesByType("resource").length,
    links: document.querySelectorAll("[src], link:not([href^='data:']), a[href^=http]").length,
  }, "*");
}, 50);
</script>"##;

/// The page around it, as wide as a phone: a browser window cannot be that narrow.
fn frame(page: &str, width_px: u32) -> String {
    format!(
        r#"<body><iframe src="{page}" width="{width_px}" height="3000" style="border:0"></iframe><script>
addEventListener("message", ({{data}}) => {{ for (const [key, value] of Object.entries(data)) document.body.dataset[key] = value; }});
</script></body>"#
    )
}

fn browser() -> Option<PathBuf> {
    if let Some(chosen) = std::env::var_os("CHROME") {
        return Some(chosen.into());
    }
    let path = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome"];
    std::env::split_paths(&path)
        .flat_map(|directory| names.map(|name| directory.join(name)))
        .find(|file| file.is_file())
}

/// The document as the browser sees it after all scripts have run.
fn dump(browser: &Path, directory: &Path, file: &Path) -> String {
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking"])
        .args(["--disable-component-update", "--disable-sync", "--virtual-time-budget=10000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", directory.join("profile").display()))
        .arg(format!("file://{}", file.display()))
        .output()
        .expect("the browser starts");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Renders a page, opens it `width_px` wide, and returns what the probe saw: `value(key)`.
fn look(browser: &Path, name: &str, page: &str, width_px: u32) -> impl Fn(&str) -> String + use<> {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("report_{name}_{width_px}"));
    let _ = std::fs::remove_dir_all(&directory); // a browser wants a new profile
    std::fs::create_dir_all(&directory).unwrap();
    std::fs::write(directory.join("report.html"), page.replace("</body>", &format!("{PROBE}</body>"))).unwrap();
    let around = directory.join("frame.html");
    std::fs::write(&around, frame("report.html", width_px)).unwrap();
    let dom = dump(browser, &directory, &around);
    move |key| {
        let value = dom.split_once(&format!("data-{key}=\"")).and_then(|(_, rest)| rest.split_once('"'));
        value.unwrap_or_else(|| panic!("no {key} in: {dom}")).0.to_owned()
    }
}

fn check(browser: &Path, name: &str, kind: Kind, rows: u32, width_px: u32) {
    let data = demo::report(kind, rows);
    let seen = look(browser, name, &render(&data).unwrap(), width_px);
    let number = |key: &str| seen(key).parse::<usize>().unwrap();
    assert_eq!(seen("errors"), "none");
    assert_eq!(number("width"), width_px as usize);
    assert_eq!(number("drawn"), CHARTS);
    assert_eq!(number("axes"), CHARTS, "{name}: a chart has no axis");
    // The scalar, and two lines per method; the uncompensated residual is off, for it would dwarf them.
    assert_eq!(number("lines"), 1 + 2 * data.methods.len());
    assert!(number("bars") >= data.methods.len(), "{name}: no bars");
    assert_eq!(number("markers"), 18 * data.methods.len());
    assert_eq!(seen("overflow"), "none", "{name} at {width_px} px");
    assert_eq!((number("loads"), number("links")), (0, 0), "{name}: something came from elsewhere");
}

#[test]
fn page_is_drawn_whole_on_a_screen_and_on_a_phone() {
    let Some(browser) = browser() else {
        println!("skipped: no chromium, chromium-browser or google-chrome on PATH, and CHROME is not set");
        return;
    };
    check(&browser, "compare", Kind::Compare, 26_000, 390);
    check(&browser, "compare", Kind::Compare, 26_000, 1600);
    check(&browser, "replay", Kind::Replay, 3_000, 390);
    check(&browser, "calibrate", Kind::Calibrate, 9_000, 390);
}

#[test]
fn page_of_nothing_says_so_and_is_still_a_page() {
    let mut data = demo::report(Kind::Replay, 0);
    data.methods.clear();
    let page = render(&data).unwrap();
    assert!(page.contains("The heading is not known"));
    let Some(browser) = browser() else { return };
    let seen = look(&browser, "nothing", &page, 390);
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
        let seen = look(&browser, "hostile", &page, 390);
        assert_eq!((seen("errors"), seen("loads"), seen("links")), ("none".into(), "0".into(), "0".into()));
        assert_eq!(seen("overflow"), "none");
    }
}
