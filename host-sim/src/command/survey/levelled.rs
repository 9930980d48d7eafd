//! `levelled.csv`: the recordings as they were, and what the survey makes of each row.

use towmag_survey::{Survey, SurveyedTow};

use super::digits::fixed;
use crate::error::HostError;
use crate::output::{OutputDir, StagedFile};
use crate::recording::{Input, RecordingRow, Schema};

/// The columns that are added, in this order.
const ADDED: [&str; 5] = ["field_nT", "field_std_nT", "anomaly_nT", "anomaly_std_nT", "valid"];
/// The columns of a second scalar sensor, after those.
const SECOND: [&str; 3] = ["field2_nT", "difference_nT", "mean_nT"];
/// Names the recording of each row, first; only there with several.
pub(super) const RECORDING: &str = "recording";
/// Of all fields: a tenth of a picotesla.
const DECIMALS: usize = 4;

/// Write all recordings, one after the other.
pub(super) fn write(output: &OutputDir, inputs: &[Input], survey: &Survey) -> Result<(), HostError> {
    let mut writer = csv::Writer::from_writer(output.create_file("levelled.csv")?);
    let has_second = survey.tows.iter().any(|tow| tow.second.is_some());
    let mut columns = Columns { is_several: inputs.len() > 1, has_second, ..Columns::default() };
    for input in inputs {
        columns.add(input.open()?.schema());
    }
    columns.write_header(&mut writer)?;
    for (input, tow) in inputs.iter().zip(&survey.tows) {
        write_recording(&mut writer, &columns, input, tow)?;
    }
    let file = writer.into_inner().map_err(|error| csv::Error::from(std::io::Error::other(error.to_string())))?;
    Ok(file.finish()?)
}

/// The columns of all recordings, in the order in which they come up: a name that is there twice counts twice.
#[derive(Default)]
struct Columns {
    is_several: bool,
    has_second: bool,
    names: Vec<(Vec<u8>, usize)>,
}

impl Columns {
    fn add(&mut self, schema: &Schema) {
        for name in self.own(schema) {
            if !self.names.contains(&name) {
                self.names.push(name);
            }
        }
    }

    /// The names of a recording that are kept, each with how often it was there before; in the order of the recording.
    fn own(&self, schema: &Schema) -> Vec<(Vec<u8>, usize)> {
        let mut own: Vec<(Vec<u8>, usize)> = Vec::new();
        for name in schema.names().filter(|name| !self.is_added(name)) {
            let before = own.iter().filter(|(known, _)| known == name).count();
            own.push((name.to_vec(), before));
        }
        own
    }

    /// Those of an earlier survey are replaced.
    fn is_added(&self, name: &[u8]) -> bool {
        ADDED.iter().chain(&SECOND).any(|added| added.as_bytes() == name)
            || self.is_several && name == RECORDING.as_bytes()
    }

    fn write_header(&self, writer: &mut csv::Writer<StagedFile>) -> csv::Result<()> {
        if self.is_several {
            writer.write_field(RECORDING)?;
        }
        self.names.iter().try_for_each(|(name, _)| writer.write_field(name))?;
        let second = if self.has_second { &SECOND[..] } else { &[] };
        writer.write_record(ADDED.iter().chain(second))
    }

    /// Where in the recording each column is.
    fn positions(&self, schema: &Schema) -> Vec<Option<usize>> {
        let kept: Vec<usize> = (0..schema.len()).filter(|&at| !self.is_added(schema.name(at))).collect();
        let own = self.own(schema);
        self.names.iter().map(|name| own.iter().position(|own| own == name).map(|at| kept[at])).collect()
    }
}

fn write_recording(
    writer: &mut csv::Writer<StagedFile>,
    columns: &Columns,
    input: &Input,
    tow: &SurveyedTow,
) -> Result<(), HostError> {
    let mut recording = input.open()?;
    let positions = columns.positions(recording.schema());
    let mut row = RecordingRow::default();
    for at in 0..tow.time_s.len() {
        if !recording.read_row(&mut row)? {
            let what = "has fewer rows than when it was read first: is it still being written?";
            return Err(HostError::NotEnough(format!("{}: {what}", input.shown())));
        }
        if columns.is_several {
            writer.write_field(&tow.name)?;
        }
        for position in &positions {
            match position {
                Some(position) => {
                    recording.write_fields(&row, &[*position], &mut |field| writer.write_field(field))?;
                }
                None => writer.write_field("")?,
            }
        }
        write_added(writer, tow, at)?;
    }
    Ok(())
}

fn write_added(writer: &mut csv::Writer<StagedFile>, tow: &SurveyedTow, at: usize) -> csv::Result<()> {
    let number = |nt: f64| if nt.is_finite() { fixed(nt, DECIMALS) } else { String::new() };
    let is_valid = tow.is_valid[at];
    for values in [&tow.field_nt, &tow.field_std_nt, &tow.anomaly_nt, &tow.anomaly_std_nt] {
        writer.write_field(if is_valid { number(values[at]) } else { String::new() })?;
    }
    writer.write_field(if is_valid { "1" } else { "0" })?;
    if let Some(second) = &tow.second {
        for values in [&second.field_nt, &second.difference_nt, &second.mean_nt] {
            writer.write_field(number(values[at]))?;
        }
    }
    writer.write_record(None::<&[u8]>)
}
