//! The house rules of the boards: one place chooses among them, and nothing else knows the hardware.

use std::fs;
use std::path::{Path, PathBuf};

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] }).collect()
}

/// Files of `src`, relative to it, that hold one of `words`.
fn files_with(words: &[&str]) -> Vec<String> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found: Vec<String> = sources(&src)
        .into_iter()
        .filter(|path| {
            let text = fs::read_to_string(path).unwrap();
            words.iter().any(|word| text.contains(word))
        })
        .map(|path| path.strip_prefix(&src).unwrap().to_string_lossy().replace('\\', "/"))
        .collect();
    found.sort();
    found
}

#[test]
fn one_file_chooses_the_board() {
    assert_eq!(files_with(&["feature ="]), ["board/mod.rs"]);
}

#[test]
fn only_the_boards_know_the_chip() {
    let files = files_with(&["stm32f4xx_hal", "cortex_m"]);
    assert!(!files.is_empty() && files.iter().all(|file| file.starts_with("board/")), "{files:?}");
}

/// What hangs on the pins that the board takes, in the order in which a call names them.
const CALLS: [(&str, &[&str]); 11] = [
    ("serial::scalar(", &["SCALAR_TX", "SCALAR_RX"]),
    ("serial::cable(", &["CABLE_TX", "CABLE_RX"]),
    ("serial::nmea(", &["NMEA_TX", "NMEA_RX"]),
    ("green: ", &["LIGHT_GREEN"]),
    ("yellow: ", &["LIGHT_YELLOW"]),
    ("red: ", &["LIGHT_RED"]),
    ("HousekeepingInputs::start(", &["LEAK", "BATTERY_DIVIDED"]),
    ("SecondPulses::start(", &["SECOND_PULSE"]),
    ("DataReady::new(", &["ADC_DRDY"]),
    ("buses::fluxgate(", &["ADC_SCLK", "ADC_DOUT", "ADC_DIN", "ADC_CS"]),
    ("buses::card(", &["CARD_CLK", "CARD_DAT0", "CARD_CMD", "CARD_CS"]),
];

/// What the chip has there after a reset, without the program.
const DEBUG: [(&str, &str); 2] = [("PA13", "SWDIO"), ("PA14", "SWCLK")];

/// A pin of a part of the netlist.
struct Pin {
    reference: String,
    number: String,
    name: String,
    net: String,
    value: String,
}

fn netlist() -> Vec<Pin> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("firmware/body.netlist.csv");
    let mut rows = csv::Reader::from_path(path).unwrap();
    let pin = |row: csv::StringRecord| {
        let [reference, _, value, number, name, net] = std::array::from_fn(|i| row[i].to_string());
        Pin { reference, number, name, net, value }
    };
    rows.records().map(|row| pin(row.unwrap())).collect()
}

/// Pins that a piece of the program takes: `pa.pa9` is PA9.
fn pins_taken(text: &str) -> Vec<String> {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '.');
    let pin = |word: &str| {
        let (port, rest) = word.split_once('.')?;
        let name = rest.split('.').next()?;
        let number = name.strip_prefix(port)?;
        let is_pin = port.len() == 2 && port.starts_with('p') && number.parse::<u8>().is_ok();
        is_pin.then(|| name.to_uppercase())
    };
    words.filter_map(pin).collect()
}

/// Each pin that the program takes, and what it takes it for.
fn pins_of_board() -> Vec<(String, String)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/board/stm32f405/mod.rs");
    let program = fs::read_to_string(path).unwrap();
    let mut pins: Vec<_> = DEBUG.iter().map(|(pin, net)| (pin.to_string(), net.to_string())).collect();
    for (call, nets) in CALLS {
        let (_, rest) = program.split_once(call).unwrap_or_else(|| panic!("{call} is not in the board"));
        pins.extend(pins_taken(rest).into_iter().zip(nets.iter().map(|net| net.to_string())));
    }
    assert_eq!(pins.len() - DEBUG.len(), pins_taken(&program).len(), "a pin that no call here knows");
    pins.sort();
    pins
}

#[test]
fn the_netlist_wires_the_pins_as_the_program_takes_them() {
    let is_port = |pin: &&Pin| pin.name.len() >= 3 && ["PA", "PB", "PC", "PD"].contains(&&pin.name[..2]);
    let wired = netlist();
    let chip = wired.iter().filter(|pin| pin.reference == "U1");
    let ports = chip.filter(is_port).filter(|pin| pin.net != "NC");
    let mut ports: Vec<_> = ports.map(|pin| (pin.name.clone(), pin.net.clone())).collect();
    ports.sort();
    assert_eq!(ports, pins_of_board());
}

/// A line of the page's table of wires begins with the pins that it is about.
#[test]
fn the_page_names_every_pin_that_is_wired() {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/body.md")).unwrap();
    let (_, wiring) = page.split_once("## Wiring").unwrap();
    let cells = wiring.lines().filter_map(|line| line.strip_prefix("| P")?.split('|').next());
    let mut named: Vec<String> = cells
        .flat_map(|cell| format!("P{cell}").split([' ', ',', '(']).map(str::to_string).collect::<Vec<_>>())
        .filter(|word| word.len() >= 3 && word.starts_with('P') && word[2..].parse::<u8>().is_ok())
        .collect();
    let mut wired: Vec<String> = pins_of_board().into_iter().map(|(pin, _)| pin).collect();
    named.sort();
    wired.sort();
    assert_eq!(named, wired);
}

#[test]
fn each_pin_of_the_netlist_is_wired_once_and_each_net_has_two() {
    let pins = netlist();
    for (index, pin) in pins.iter().enumerate() {
        let again = pins[..index].iter().any(|p| p.reference == pin.reference && p.number == pin.number);
        assert!(!again, "{} pin {} twice", pin.reference, pin.number);
        let on_net = pins.iter().filter(|other| other.net == pin.net).count();
        assert!(pin.net == "NC" || on_net >= 2, "{}: nothing else is on {}", pin.reference, pin.net);
    }
    let numbers = pins.iter().filter(|pin| pin.reference == "U1").map(|pin| pin.number.parse::<u8>().unwrap());
    assert!(numbers.eq(1..=64), "the package has 64 pins");
}

/// Parts of one value between two nets.
fn between(pins: &[Pin], value: &str, [one, other]: [&str; 2]) -> usize {
    let has = |reference: &str, net: &str| pins.iter().any(|pin| pin.reference == reference && pin.net == net);
    pins.iter().filter(|pin| pin.value == value && pin.net == one && has(&pin.reference, other)).count()
}

#[test]
fn what_a_chip_needs_to_start_is_there() {
    let pins = netlist();
    let needed = [
        ("10 kohm", ["BOOT0", "GND"], 1),
        ("100 nF", ["NRST", "GND"], 1),
        ("27 pF", ["OSC_IN", "GND"], 1),
        ("27 pF", ["OSC_OUT", "GND"], 1),
        ("8 MHz crystal, load 18 pF", ["OSC_IN", "OSC_OUT"], 1),
        ("2.2 uF", ["VCAP_1", "GND"], 1),
        ("2.2 uF", ["VCAP_2", "GND"], 1),
        ("10 kohm", ["ADC_RESET", "3V3"], 1),
        ("47 kohm", ["CARD_CS", "CARD_3V3"], 1),
        ("47 kohm", ["CARD_DAT0", "CARD_3V3"], 1),
        ("120 ohm", ["CABLE_DOWN_P", "CABLE_DOWN_N"], 1),
        ("100 kohm 0.1 %", ["BATTERY", "BATTERY_DIVIDED"], 1),
        ("10 kohm 0.1 %", ["BATTERY_DIVIDED", "GND"], 1),
        ("1 kohm", ["LEAK_CONTACT", "LEAK"], 1),
    ];
    for (value, nets, count) in needed {
        assert_eq!(between(&pins, value, nets), count, "{value} between {nets:?}");
    }
    // One at each supply pin of the microcontroller at least.
    assert!(between(&pins, "100 nF", ["3V3", "GND"]) >= 5);
}
