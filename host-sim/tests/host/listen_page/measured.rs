//! What the live page costs, and how late it is. Long: `cargo test -p host-sim --test host listen_page::measured -- --ignored --nocapture`.

use std::fs;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use super::browser::Browser;
use super::parts::{Listening, body, told};
use super::rehearsal;

/// Viewers at a time.
const VIEWERS: usize = 5;

/// How long the delay is measured, s.
const MEASURED_S: u32 = 60;

/// A number of `/proc/PID/status`, kB.
pub(crate) fn memory_kb(pid: u32, name: &str) -> u64 {
    let status = fs::read_to_string(format!("/proc/{pid}/status")).unwrap();
    let line = status.lines().find(|line| line.starts_with(name)).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

/// Processor time of a process so far, s: user and system, in ticks of a hundredth (`proc(5)`).
fn processor_s(pid: u32) -> f64 {
    let stat = fs::read_to_string(format!("/proc/{pid}/stat")).unwrap();
    // Behind the name, which may hold blanks.
    let fields: Vec<&str> = stat.rsplit_once(')').unwrap().1.split_whitespace().collect();
    [11, 12].map(|place| fields[place].parse::<f64>().unwrap()).iter().sum::<f64>() / 100.0
}

#[test]
#[ignore = "80 s: from a byte on the cable to a picture in five browser pages, and what that takes of a processor"]
fn delay_and_processor() {
    let folder = tempfile::tempdir().unwrap();
    let Some(mut browser) = Browser::start() else { return };
    let (port, body) = body(10 * (MEASURED_S + 30), Duration::from_millis(100));
    let record = folder.path().join("cable.bin");
    let listening = Listening::begin(&[&port, "--record", record.to_str().unwrap()]);
    let share = on_time(&mut browser, &listening.host, listening.child.id());
    body.join().unwrap();
    assert!(share < 10.0);
}

#[test]
#[ignore = "100 s: the same of the emulated body, its faults too; needs QEMU and the image"]
fn delay_of_the_emulated_body() {
    let folder = tempfile::tempdir().unwrap();
    let (Some(image), Some(mut browser)) = (rehearsal::image(), Browser::start()) else { return };
    rehearsal::tow(folder.path(), 10 * (MEASURED_S as usize + 60));
    let mut command =
        rehearsal::emulation(folder.path(), &image, "watched", &["--serve", "127.0.0.1:0", "--speed", "1"]);
    let mut emulation = rehearsal::Emulation(command.stderr(Stdio::piped()).spawn().unwrap());
    let host = rehearsal::host(&mut emulation);
    on_time(&mut browser, &host, emulation.0.id());
}

/// From the stamp of an epoch, or else from when it was read, to the picture of it in five pages; what that takes, % of a core.
fn on_time(browser: &mut Browser, host: &str, pid: u32) -> f64 {
    let address = format!("http://{host}/");
    let tabs: Vec<_> = (0..VIEWERS).map(|_| browser.open(&address, 800, 600, false)).collect();
    for tab in &tabs {
        browser.until(tab, "towmag.screen.delays.length > 5");
        browser.ask(tab, "void towmag.screen.delays.splice(0)");
    }
    let (begin, begin_s) = (Instant::now(), processor_s(pid));
    std::thread::sleep(Duration::from_secs(MEASURED_S.into()));
    let share = 100.0 * (processor_s(pid) - begin_s) / begin.elapsed().as_secs_f64();
    let mut delays_ms: Vec<f64> = Vec::new();
    for tab in &tabs {
        let delays = browser.ask(tab, "towmag.screen.delays");
        delays_ms.extend(delays.as_array().unwrap().iter().filter_map(|ms| ms.as_f64()));
    }
    delays_ms.sort_by(f64::total_cmp);
    let at = |share: f64| delays_ms[((delays_ms.len() - 1) as f64 * share) as usize];
    let load = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    println!(
        "{} pictures in {VIEWERS} pages: median {:.0} ms, 95 % below {:.0} ms, largest {:.0} ms",
        delays_ms.len(),
        at(0.5),
        at(0.95),
        at(1.0)
    );
    println!("host-sim: {share:.1} % of a core; load of the machine {}", load.trim());
    assert!(at(0.95) < 200.0);
    assert!(delays_ms.len() > 5 * VIEWERS * MEASURED_S as usize);
    share
}

/// A recording of the cable, so many hours long.
fn recording(path: &Path, hours: u32) {
    let mut file = BufWriter::new(fs::File::create(path).unwrap());
    (0..hours * 36_000)
        .for_each(|tick| file.write_all(&told(tick, 1_767_225_600_000 + 100 * u64::from(tick))).unwrap());
    file.flush().unwrap();
}

#[test]
#[ignore = "15 minutes: memory over 24 hours of a recording at a hundred times its speed"]
fn memory_over_a_day() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("day.bin");
    recording(&file, 24);
    let listening = Listening::begin(&["--replay", file.to_str().unwrap(), "--speed", "100"]);
    let pid = listening.child.id();
    let mut viewer = listening.viewer();
    let (mut rows, mut told_h, mut memory) = (0, 0, Vec::new());
    while rows < 24 * 36_000 - 100 {
        rows += viewer.next("epochs")["rows"].as_array().unwrap().len();
        if rows / 36_000 >= told_h {
            memory.push(memory_kb(pid, "VmRSS:"));
            println!("{told_h} h: {} kB", memory[memory.len() - 1]);
            told_h += 1;
        }
    }
    println!("at most {} kB; {:.0} s of a processor", memory_kb(pid, "VmHWM:"), processor_s(pid));
    let (first, last) = (memory[13], memory[memory.len() - 1]);
    assert!(last < first + 2_000, "from {first} kB, when twelve hours were full, to {last} kB");
}
