//! HDF5 as the data sets of MagNav have it: flat, a data set a column, all numbers doubles.
//!
//! Names: `get_XYZ.jl` of <https://github.com/MIT-AI-Accelerator/MagNav.jl>. What it has no name for keeps its own.

use ::hdf5_pure::{AttrValue, FileBuilder};
use towmag_recording::Column;

use crate::error::ExportError;
use crate::legs::{Leg, legs};
use crate::table::{Table, TableColumn, Values};

/// Ours and theirs. Not `base_nT` for their `diurnal`, which is a variation and no total field.
const NAMES: [(&str, &str); 12] = [
    ("time_s", "tt"),
    ("latitude_deg", "lat"),
    ("longitude_deg", "lon"),
    ("flux_x_nT", "flux_a_x"),
    ("flux_y_nT", "flux_a_y"),
    ("flux_z_nT", "flux_a_z"),
    ("scalar_nT", "mag_1_uc"),
    ("scalar2_nT", "mag_2_uc"),
    ("compensated_nT", "mag_1_c"),
    ("roll_deg", "roll"),
    ("pitch_deg", "pitch"),
    ("heading_deg", "yaw"),
];

/// Their height above the sea, which no recording has but as a depth.
const ALTITUDE: &str = "alt";
/// The labels of the lines as they were, where some are no numbers.
const LINE_LABEL: &str = "line_label";

/// The table as a file.
pub(crate) fn encode(table: &Table) -> Result<Vec<u8>, ExportError> {
    let mut file = Builder { file: FileBuilder::new(), taken: Vec::new() };
    file.file.set_attr("source", AttrValue::VarLenString(table.file_name().into()));
    if let Some(dt_s) = median_step_s(table) {
        file.number("dt", &[dt_s], "s", true);
    }
    file.number("N", &[table.len() as f64], "", true);
    if let Some(depth_m) = table.numbers(Column::Depth.name()) {
        file.number(ALTITUDE, &depth_m.iter().map(|depth_m| -depth_m).collect::<Vec<_>>(), "m", false);
    }
    // Theirs first: a column that has such a name by chance is not to take it from the one that is meant.
    let (theirs, ours): (Vec<_>, Vec<_>) = table.columns.iter().partition(|column| name_of(column) != column.name);
    for column in theirs.into_iter().chain(ours) {
        if column.name == Column::Line.name() {
            file.lines(&legs(table));
        } else {
            file.column(column);
        }
    }
    file.file.finish().map_err(ExportError::encoding("hdf5"))
}

fn name_of(column: &TableColumn) -> &str {
    NAMES.iter().find(|(ours, _)| *ours == column.name).map_or(&column.name, |(_, theirs)| theirs)
}

struct Builder {
    file: FileBuilder,
    taken: Vec<String>,
}

impl Builder {
    fn column(&mut self, column: &TableColumn) {
        let name = name_of(column);
        match &column.values {
            Values::Number(numbers) => self.number(name, numbers, column.unit, false),
            Values::Flag(flags) => {
                let numbers: Vec<f64> = flags.iter().map(|flag| flag.map_or(f64::NAN, f64::from)).collect();
                self.number(name, &numbers, column.unit, false);
            }
            Values::Label(labels) => self.text(name, labels.iter().map(Option::as_deref)),
        }
    }

    /// As numbers, which MagNav picks lines by; and as they were, where that is something else.
    fn lines(&mut self, legs: &[Leg<'_>]) {
        let rows = |leg: &Leg<'_>| std::iter::repeat_n(leg.number.parse().unwrap_or(f64::NAN), leg.rows.len());
        self.number(Column::Line.name(), &legs.iter().flat_map(rows).collect::<Vec<_>>(), "", false);
        if legs.iter().any(Leg::is_renumbered) {
            self.text(LINE_LABEL, legs.iter().flat_map(|leg| std::iter::repeat_n(leg.label, leg.rows.len())));
        }
    }

    fn number(&mut self, name: &str, numbers: &[f64], unit: &str, is_scalar: bool) {
        let name = self.free(name);
        let data = self.file.create_dataset(&name).with_f64_data(numbers);
        if is_scalar {
            data.with_shape(&[]);
        }
        if !unit.is_empty() {
            data.set_attr("unit", AttrValue::VarLenString(unit.into()));
        }
    }

    /// Missing labels are empty.
    fn text<'a>(&mut self, name: &str, labels: impl Iterator<Item = Option<&'a str>>) {
        let name = self.free(name);
        let labels: Vec<&str> = labels.map(Option::unwrap_or_default).collect();
        self.file.create_dataset(&name).with_vlen_strings(&labels);
    }

    /// A name that is not taken yet. A slash would open a group.
    fn free(&mut self, name: &str) -> String {
        let mut name = name.replace('/', "_");
        while self.taken.contains(&name) {
            name.push('_');
        }
        self.taken.push(name.clone());
        name
    }
}

/// The median of the steps of `time_s`, to the nanosecond.
fn median_step_s(table: &Table) -> Option<f64> {
    let time_s = table.numbers(Column::Time.name())?;
    let mut steps_s: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| !step.is_nan()).collect();
    steps_s.sort_by(f64::total_cmp);
    steps_s.get(steps_s.len() / 2).map(|step_s| (step_s * 1e9).round() / 1e9)
}

#[cfg(test)]
mod tests {
    use towmag_recording::Column;

    use super::NAMES;

    #[test]
    fn our_names_are_those_of_the_contract() {
        for (ours, _) in NAMES.iter().filter(|(ours, _)| *ours != "compensated_nT") {
            assert!(Column::named(ours).is_some(), "{ours}");
        }
    }
}
