//! The lines of a survey: rows one after the other with the same label.

use std::ops::Range;

use crate::table::Table;

/// Rows with the same label.
#[derive(Debug, PartialEq)]
pub(crate) struct Leg<'a> {
    /// `None` between the lines, and where there is no column `line`.
    pub(crate) label: Option<&'a str>,
    /// The label, where it is a number; else a running one that no label has.
    pub(crate) number: String,
    /// Which rows.
    pub(crate) rows: Range<usize>,
}

impl Leg<'_> {
    /// Whether the number is not the label.
    pub(crate) fn is_renumbered(&self) -> bool {
        self.label != Some(&self.number)
    }
}

/// All rows, line by line. A line that was left and taken up again is two legs.
pub(crate) fn legs(table: &Table) -> Vec<Leg<'_>> {
    let labels = table.line_labels().unwrap_or(&[]);
    let label = |row: usize| labels.get(row).and_then(Option::as_deref);
    let starts = (0..table.len()).filter(|&row| row == 0 || label(row) != label(row - 1));
    let mut legs: Vec<Leg<'_>> =
        starts.map(|start| Leg { label: label(start), number: String::new(), rows: start..table.len() }).collect();
    for at in 1..legs.len() {
        legs[at - 1].rows.end = legs[at].rows.start;
    }
    number(&mut legs);
    legs
}

fn number(legs: &mut [Leg<'_>]) {
    let taken: Vec<&str> = legs.iter().filter_map(|leg| leg.label).filter(|label| is_number(label)).collect();
    let mut free = (1_u64..).map(|number| number.to_string()).filter(|number| !taken.contains(&number.as_str()));
    for leg in legs {
        let own = leg.label.filter(|label| is_number(label)).map(String::from);
        leg.number = own.or_else(|| free.next()).unwrap_or_default();
    }
}

/// Digits, and perhaps a version after a dot, as Geosoft numbers its lines.
fn is_number(label: &str) -> bool {
    let is_digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    label.split_once('.').map_or(is_digits(label), |(line, version)| is_digits(line) && is_digits(version))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{TableColumn, Values};

    fn table(labels: &[&str]) -> Table {
        let label = |label: &&str| Some(label.to_string()).filter(|label| !label.is_empty());
        let values = Values::Label(labels.iter().map(label).collect());
        let columns = vec![TableColumn { name: "line".into(), unit: "", values }];
        Table { file: "t.csv".into(), columns, lines: (2..).take(labels.len()).collect() }
    }

    #[test]
    fn a_leg_ends_where_the_label_changes() {
        let table = table(&["1", "1", "", "box", "box", "1", "1002.20"]);
        let found = legs(&table);
        let found: Vec<_> = found.iter().map(|leg| (leg.number.as_str(), leg.label, leg.rows.clone())).collect();
        assert_eq!(
            found,
            [
                ("1", Some("1"), 0..2),
                ("2", None, 2..3),
                ("3", Some("box"), 3..5),
                ("1", Some("1"), 5..6),
                ("1002.20", Some("1002.20"), 6..7)
            ]
        );
    }

    #[test]
    fn without_the_column_all_is_one() {
        let mut table = table(&["7", "8"]);
        table.columns[0].name = "other".into();
        assert_eq!(legs(&table), [Leg { label: None, number: "1".into(), rows: 0..2 }]);
    }
}
