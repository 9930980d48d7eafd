//! Damaged recordings through the whole of `replay` and `calibrate`: a result with a row for every row, or one clear
//! line and nothing written.

use std::path::Path;

use host_sim::command;
use host_sim::recording::Input;
use proptest::prelude::*;
use towmag::Settings;

fn survey() -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../sample/survey.csv");
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().take(401).collect::<Vec<_>>().join("\n").into_bytes()
}

#[derive(Clone, Debug)]
enum Damage {
    Cut(prop::sample::Index),
    Overwrite(prop::sample::Index, Vec<u8>),
    RepeatLine(prop::sample::Index),
    DropLine(prop::sample::Index),
    SwapLines(prop::sample::Index, prop::sample::Index),
    DropColumn(prop::sample::Index),
    Rubbish(Vec<u8>),
}

fn damage() -> impl Strategy<Value = Damage> {
    let index = any::<prop::sample::Index>;
    let bytes = proptest::collection::vec(any::<u8>(), 0..12);
    let digits = proptest::collection::vec(proptest::sample::select(b"0123456789.,-eE\n\" ".to_vec()), 1..6);
    prop_oneof![
        index().prop_map(Damage::Cut),
        (index(), bytes).prop_map(|(at, bytes)| Damage::Overwrite(at, bytes)),
        (index(), digits).prop_map(|(at, bytes)| Damage::Overwrite(at, bytes)),
        index().prop_map(Damage::RepeatLine),
        index().prop_map(Damage::DropLine),
        (index(), index()).prop_map(|(a, b)| Damage::SwapLines(a, b)),
        index().prop_map(Damage::DropColumn),
        proptest::collection::vec(any::<u8>(), 0..400).prop_map(Damage::Rubbish),
    ]
}

fn apply(damage: &Damage, recording: Vec<u8>) -> Vec<u8> {
    if recording.is_empty() {
        return recording;
    }
    let mut bytes = recording;
    let mut lines: Vec<Vec<u8>> = bytes.split(|&byte| byte == b'\n').map(<[u8]>::to_vec).collect();
    let count = lines.len();
    match damage {
        Damage::Cut(at) => bytes.truncate(at.index(bytes.len())),
        Damage::Overwrite(at, new) => {
            let start = at.index(bytes.len());
            let end = (start + new.len()).min(bytes.len());
            bytes.splice(start..end, new.iter().copied());
        }
        Damage::RepeatLine(at) => lines.insert(at.index(count), lines[at.index(count)].clone()),
        Damage::DropLine(at) => _ = lines.remove(at.index(count)),
        Damage::SwapLines(a, b) => lines.swap(a.index(count), b.index(count)),
        Damage::DropColumn(at) => {
            for line in &mut lines {
                let fields: Vec<&[u8]> = line.split(|&byte| byte == b',').collect();
                let gone = at.index(6);
                let kept = fields.iter().enumerate().filter(|(i, _)| *i != gone).map(|(_, field)| *field);
                *line = kept.collect::<Vec<_>>().join(&b","[..]);
            }
        }
        Damage::Rubbish(rubbish) => return rubbish.clone(),
    }
    match damage {
        Damage::Cut(_) | Damage::Overwrite(..) => bytes,
        _ => lines.join(&b"\n"[..]),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn a_whole_result_or_one_line(damages in proptest::collection::vec(damage(), 1..4), is_strict: bool) {
        let folder = tempfile::tempdir().unwrap();
        let (recording, out) = (folder.path().join("rec.csv"), folder.path().join("out"));
        let bytes = damages.iter().fold(survey(), |bytes, damage| apply(damage, bytes));
        std::fs::write(&recording, &bytes).unwrap();
        let settings = Settings::default();
        let replayed = command::replay(Input::new(&recording, is_strict), None, &out, &settings).map(|summary| summary.rows);
        let calibrated = command::calibrate(Input::new(&recording, is_strict), &folder.path().join("cal"), &settings).map(|result| result.summary.rows);
        for (result, folder) in [(replayed, &out), (calibrated, &folder.path().join("cal"))] {
            match result {
                Ok(rows) => prop_assert!(rows > 0 && folder.join("summary.json").exists()),
                Err(error) => {
                    let line = error.to_string();
                    prop_assert!(line.lines().count() == 1 && line.contains("rec.csv"), "{line}");
                    prop_assert_eq!(error.exit_code(), 2);
                    prop_assert!(!folder.exists());
                }
            }
        }
        if out.exists() {
            let rows = csv::Reader::from_path(out.join("compensated.csv")).unwrap().byte_records().count();
            let first = bytes.iter().position(|&byte| byte == b'\n').unwrap();
            prop_assert_eq!(rows, csv::ReaderBuilder::new().has_headers(false).from_reader(&bytes[first + 1..]).byte_records().count());
        }
    }
}
