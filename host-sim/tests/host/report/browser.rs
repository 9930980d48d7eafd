//! A page in a real browser: what it says of itself once all its scripts have run.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::rc::Rc;

/// What every page is asked, as expressions of its own language.
const ALWAYS: [(&str, &str); 6] = [
    ("drawn", "state.drawn"),
    ("errors", "state.errors || 'none'"),
    ("width", "innerWidth"),
    ("loads", "performance.getEntriesByType('resource').length"),
    ("links", r#"document.querySelectorAll("[src], link:not([href^='data:']), a[href^=http]").length"#),
    (
        "overflow",
        "wide.map((e) => e.tagName + '.' + e.className).join(' ') || (document.documentElement.scrollWidth > innerWidth ? 'page' : 'none')",
    ),
];

/// Asks the drawn page what it looks like and tells the page around it.
fn probe(questions: &[(&str, &str)]) -> String {
    let asked = ALWAYS.iter().chain(questions).map(|(key, expression)| format!("{key}: {expression},\n"));
    format!(
        r#"<script>
const wait = setInterval(() => {{
  const state = document.documentElement.dataset;
  if (!state.drawn && !state.errors) return;
  clearInterval(wait);
  for (const details of document.querySelectorAll("details")) details.open = true;
  const edge = document.querySelector("h1").getBoundingClientRect().right; // of the text column
  const wide = [...document.querySelectorAll("main :not(svg *)")].filter((e) => e.getBoundingClientRect().right > edge + 0.5);
  parent.postMessage({{{}}}, "*");
}}, 50);
</script>"#,
        asked.collect::<String>()
    )
}

/// The page around some, each as wide as is asked for: a browser window cannot be as narrow as a phone. What they tell is kept by number.
fn frames(widths_px: impl Iterator<Item = u32>) -> String {
    let frame = |(at, width_px): (usize, u32)| {
        format!(r#"<iframe src="{at}.html" width="{width_px}" height="3000" style="border:0"></iframe>"#)
    };
    let frames: String = widths_px.enumerate().map(frame).collect();
    format!(
        r#"<body>{frames}<script>
const frames = [...document.querySelectorAll("iframe")];
addEventListener("message", ({{data, source}}) => {{
  const at = frames.findIndex((frame) => frame.contentWindow === source);
  for (const [key, value] of Object.entries(data)) document.body.dataset[key + at] = value;
}});
</script></body>"#
    )
}

/// The browser that there is, if any.
pub(crate) fn browser() -> Option<PathBuf> {
    if let Some(chosen) = std::env::var_os("CHROME") {
        return Some(chosen.into());
    }
    let path = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let found = std::env::split_paths(&path)
        .flat_map(|directory| names.map(|name| directory.join(name)))
        .find(|file| file.is_file());
    if found.is_none() {
        println!("skipped: no chromium, chromium-browser or google-chrome on PATH, and CHROME is not set");
    }
    found
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

/// Opens a page `width_px` wide, and returns what the probe saw: `value(key)`. `questions` are more keys, each with an
/// expression that the page evaluates.
pub(crate) fn look(
    browser: &Path,
    name: &str,
    page: &str,
    width_px: u32,
    questions: &[(&str, &str)],
) -> impl Fn(&str) -> String + use<> {
    let [seen] = look_at(browser, name, [(page, width_px)], questions);
    seen
}

/// The same of one page at some widths, px, each with what was seen.
pub(crate) fn look_at_widths<const WIDTHS: usize>(
    browser: &Path,
    name: &str,
    page: &str,
    widths_px: [u32; WIDTHS],
    questions: &[(&str, &str)],
) -> impl Iterator<Item = (u32, impl Fn(&str) -> String + use<WIDTHS>)> + use<WIDTHS> {
    widths_px.into_iter().zip(look_at(browser, name, widths_px.map(|width_px| (page, width_px)), questions))
}

/// The same of several pages in one browser: to start one, and to read the library of the charts, takes longer than to draw most of them.
pub(crate) fn look_at<const PAGES: usize>(
    browser: &Path,
    name: &str,
    pages: [(&str, u32); PAGES],
    questions: &[(&str, &str)],
) -> [impl Fn(&str) -> String + use<PAGES>; PAGES] {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("report_{name}"));
    let _ = std::fs::remove_dir_all(&directory); // a browser wants a new profile
    std::fs::create_dir_all(&directory).unwrap();
    for (at, (page, _)) in pages.iter().enumerate() {
        // A scroll bar from the start: one that comes with opened details would make the page narrower than it was drawn.
        let probed = page.replace("</head>", "<style>html { overflow-y: scroll; }</style></head>");
        let probed = probed.replace("</body>", &format!("{}</body>", probe(questions)));
        std::fs::write(directory.join(format!("{at}.html")), probed).unwrap();
    }
    let around = directory.join("frames.html");
    std::fs::write(&around, frames(pages.iter().map(|(_, width_px)| *width_px))).unwrap();
    let dom: Rc<str> = dump(browser, &directory, &around).into();
    std::array::from_fn(|at| {
        let dom = dom.clone();
        move |key: &str| {
            let value = dom.split_once(&format!("data-{key}{at}=\"")).and_then(|(_, rest)| rest.split_once('"'));
            value.unwrap_or_else(|| panic!("no {key} of page {at} in: {dom}")).0.to_owned()
        }
    })
}
