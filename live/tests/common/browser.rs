//! A real browser, steered over its DevTools protocol: it runs in real time, with keys, touches and several pages.

use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use base64::Engine;
use serde_json::{Value, json};
use tungstenite::{Message, WebSocket};

/// How long a page may take for anything that is asked of it.
const PATIENCE: Duration = Duration::from_secs(20);

/// The browser that there is, if any.
fn program() -> Option<PathBuf> {
    if let Some(chosen) = std::env::var_os("CHROME") {
        return Some(chosen.into());
    }
    let path = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let found =
        std::env::split_paths(&path).flat_map(|folder| names.map(|name| folder.join(name))).find(|file| file.is_file());
    if found.is_none() {
        println!("skipped: no chromium, chromium-browser or google-chrome on PATH, and CHROME is not set");
    }
    found
}

/// A running browser.
pub(crate) struct Browser {
    child: Child,
    wire: WebSocket<TcpStream>,
    number: u64,
    profile: tempfile::TempDir,
    /// What went wrong in a page.
    pub(crate) errors: Vec<String>,
}

/// One page of it.
#[derive(Clone)]
pub(crate) struct Tab(String);

impl Browser {
    /// Start it; `None` where there is none.
    pub(crate) fn start() -> Option<Self> {
        let profile = tempfile::tempdir().unwrap();
        let mut child = Command::new(program()?)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking"])
            .args(["--disable-component-update", "--disable-sync", "--hide-scrollbars", "--remote-debugging-port=0"])
            .args([
                "--disable-renderer-backgrounding",
                "--disable-background-timer-throttling",
                "--disable-backgrounding-occluded-windows",
            ])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the browser starts");
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let told = lines
            .by_ref()
            .map_while(Result::ok)
            .find_map(|line| Some(line.split_once("DevTools listening on ")?.1.to_string()));
        let address = told.expect("the browser tells where it can be steered");
        // Or it would stop when the pipe is full.
        std::thread::spawn(move || lines.for_each(drop));
        let host = address.trim_start_matches("ws://").split('/').next().unwrap().to_string();
        let stream = TcpStream::connect(host).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let wire = tungstenite::client(address.as_str(), stream).unwrap().0;
        Some(Self { child, wire, number: 0, profile, errors: Vec::new() })
    }

    /// Open a page so many pixels wide and high.
    pub(crate) fn open(&mut self, address: &str, width_px: u32, height_px: u32, is_phone: bool) -> Tab {
        // A window of its own, or a page that is not in front is not drawn.
        let target = self.call(None, "Target.createTarget", json!({"url": "about:blank", "newWindow": true}));
        let attached =
            self.call(None, "Target.attachToTarget", json!({"targetId": target["targetId"], "flatten": true}));
        let tab = Tab(attached["sessionId"].as_str().unwrap().into());
        self.on(&tab, "Runtime.enable", json!({}));
        self.on(&tab, "Log.enable", json!({}));
        self.on(&tab, "Page.enable", json!({}));
        self.resize(&tab, width_px, height_px, is_phone);
        self.on(&tab, "Page.navigate", json!({"url": address}));
        self.until(&tab, "window.towmag?.link.session != null");
        tab
    }

    pub(crate) fn resize(&mut self, tab: &Tab, width_px: u32, height_px: u32, is_phone: bool) {
        let metrics = json!({"width": width_px, "height": height_px, "deviceScaleFactor": if is_phone { 2 } else { 1 }, "mobile": is_phone});
        self.on(tab, "Emulation.setDeviceMetricsOverride", metrics);
        self.on(tab, "Emulation.setTouchEmulationEnabled", json!({"enabled": is_phone}));
    }

    /// The value of an expression of the page.
    pub(crate) fn ask(&mut self, tab: &Tab, expression: &str) -> Value {
        let asked = json!({"expression": expression, "returnByValue": true, "awaitPromise": true});
        let answer = self.on(tab, "Runtime.evaluate", asked);
        assert!(answer.get("exceptionDetails").is_none(), "{expression}: {answer}");
        answer["result"]["value"].clone()
    }

    /// Wait until an expression is true.
    pub(crate) fn until(&mut self, tab: &Tab, expression: &str) {
        let begin = Instant::now();
        while self.ask(tab, &format!("Boolean({expression})")) != true {
            let errors = &self.errors;
            assert!(begin.elapsed() < PATIENCE, "it never was so: {expression}; errors: {errors:?}");
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// Press a key.
    pub(crate) fn press(&mut self, tab: &Tab, key: &str) {
        let text = if key.chars().count() == 1 { key } else { "" };
        self.on(tab, "Input.dispatchKeyEvent", json!({"type": "keyDown", "key": key, "text": text}));
        self.on(tab, "Input.dispatchKeyEvent", json!({"type": "keyUp", "key": key}));
    }

    /// Press where the middle of an element is.
    pub(crate) fn click(&mut self, tab: &Tab, selector: &str) {
        let place = self.ask(
            tab,
            &format!("(() => {{ const box = document.querySelector({selector:?}); box.scrollIntoView({{block: 'nearest'}}); const r = box.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; }})()"),
        );
        for kind in ["mousePressed", "mouseReleased"] {
            let event = json!({"type": kind, "x": place[0], "y": place[1], "button": "left", "clickCount": 1});
            self.on(tab, "Input.dispatchMouseEvent", event);
        }
    }

    /// Keep a picture of the page in a folder of the build, for people to look at.
    pub(crate) fn picture(&mut self, tab: &Tab, name: &str) -> Vec<u8> {
        let picture = self.on(tab, "Page.captureScreenshot", json!({"format": "png"}));
        let bytes = base64::engine::general_purpose::STANDARD.decode(picture["data"].as_str().unwrap()).unwrap();
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("live_page");
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join(format!("{name}.png")), &bytes).unwrap();
        bytes
    }

    /// Processor time of all its processes so far is not the server's: only its own folder is told here.
    pub(crate) fn profile(&self) -> &Path {
        self.profile.path()
    }

    pub(crate) fn on(&mut self, tab: &Tab, method: &str, parameters: Value) -> Value {
        self.call(Some(tab), method, parameters)
    }

    fn call(&mut self, tab: Option<&Tab>, method: &str, parameters: Value) -> Value {
        self.number += 1;
        let mut call = json!({"id": self.number, "method": method, "params": parameters});
        if let Some(Tab(session)) = tab {
            call["sessionId"] = json!(session);
        }
        self.wire.send(Message::text(call.to_string())).unwrap();
        loop {
            let Message::Text(text) = self.wire.read().unwrap() else { continue };
            let answer: Value = serde_json::from_str(&text).unwrap();
            match answer["method"].as_str() {
                Some("Runtime.exceptionThrown") => self.errors.push(answer["params"]["exceptionDetails"].to_string()),
                Some("Log.entryAdded") => self.errors.push(answer["params"]["entry"]["text"].to_string()),
                _ => {}
            }
            if answer["id"] == self.number {
                assert!(answer.get("error").is_none(), "{method}: {answer}");
                return answer["result"].clone();
            }
        }
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        _ = self.child.kill();
        _ = self.child.wait();
    }
}
