//! Geosoft XYZ, read as its description has it: by blanks.

use towmag_export::{Format, Options, encode, read_from};

use super::{FLAGS, LABELS, cells, encoded, expected_number};

#[test]
fn rows_stand_under_their_line() {
    let text = String::from_utf8(encoded(Format::Xyz)).unwrap();
    let comments: Vec<&str> = text.lines().take_while(|line| line.starts_with('/')).collect();
    let names: Vec<&str> = comments.last().unwrap()[1..].split_whitespace().collect();
    let units: Vec<&str> = comments[comments.len() - 2].strip_prefix("/ units: ").unwrap().split(' ').collect();
    assert_eq!(names.len(), units.len());
    assert_eq!((names[..4].join(" "), units[..4].join(" ")), ("x y time_s scalar_nT".into(), "deg deg s nT".into()));

    let (header, rows) = cells();
    let lines = ["101", "101", "101", "1", "2", "2", "102"];
    let (mut line, mut read) = (String::new(), 0);
    for text in text.lines().filter(|line| !line.starts_with('/')) {
        if let Some(number) = text.strip_prefix("Line ") {
            line = number.into();
            continue;
        }
        assert_eq!(line, lines[read]);
        let fields: Vec<&str> = text.split(' ').collect();
        assert_eq!(fields.len(), names.len(), "{text}");
        for (name, field) in names.iter().zip(fields) {
            let ours = [("x", "longitude_deg"), ("y", "latitude_deg")];
            let ours = ours.iter().find(|(theirs, _)| theirs == name).map_or(*name, |(_, ours)| ours);
            let expected = &rows[read][header.iter().position(|name| name == ours).unwrap()];
            if LABELS.contains(name) {
                assert_eq!(field, if expected.is_empty() { "*".into() } else { expected.replace(' ', "_") });
            } else if FLAGS.contains(name) {
                assert_eq!(field, if expected.is_empty() { "*" } else { expected });
            } else {
                assert_eq!((field != "*").then(|| field.parse().unwrap()), expected_number(expected), "{name} {read}");
            }
        }
        read += 1;
    }
    assert_eq!(read, rows.len());
    // The label that is no number is told.
    assert!(text.contains("\n/ Line 2 is \"box 2\"\nLine 2\n"), "{text}");
}

#[test]
fn the_grid_goes_before_longitude_and_latitude() {
    let csv = "time_s,easting_m,northing_m,latitude_deg,longitude_deg\n0.1,500000.5,6300000.25,-33.5,151.5\n";
    let table = read_from("g.csv", csv.as_bytes()).unwrap();
    let text = String::from_utf8(encode(&table, Format::Xyz, &Options::default()).unwrap()).unwrap();
    assert!(text.ends_with(
        "/ units: m m s deg deg\n/ x y time_s latitude_deg longitude_deg\nLine 1\n500000.5 6300000.25 0.1 -33.5 151.5\n"
    ));
}

#[test]
fn an_empty_grid_hides_no_position() {
    let csv = "time_s,easting_m,northing_m,latitude_deg,longitude_deg\n0.1,,,-33.5,151.5\n";
    let table = read_from("g.csv", csv.as_bytes()).unwrap();
    let text = String::from_utf8(encode(&table, Format::Xyz, &Options::default()).unwrap()).unwrap();
    assert!(text.ends_with("/ x y time_s easting_m northing_m\nLine 1\n151.5 -33.5 0.1 * *\n"), "{text}");
}
