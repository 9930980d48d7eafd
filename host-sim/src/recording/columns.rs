//! Which column of a recording is which.

use super::error::Fault;
use crate::message::shortened;
use csv::ByteRecord;

/// The columns that must be there, in the order of [`Columns::required`].
const REQUIRED: [&str; 5] = ["time_s", "scalar_nT", "flux_x_nT", "flux_y_nT", "flux_z_nT"];

/// Longest rendering of the whole header in a message.
const LONGEST_HEADER: usize = 120;

/// Position of every known column in a row, from 0. All others are passed through.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Columns {
    /// `time_s`.
    pub time_s: usize,
    /// `scalar_nT`.
    pub scalar_nt: usize,
    /// `flux_x_nT`, `flux_y_nT`, `flux_z_nT`.
    pub flux_nt: [usize; 3],
    /// `scalar_valid`.
    pub scalar_valid: Option<usize>,
    /// `scalar_signal`.
    pub scalar_signal: Option<usize>,
    /// `depth_m`.
    pub depth_m: Option<usize>,
    /// `temperature_degC`.
    pub temperature_deg_c: Option<usize>,
    /// `roll_deg`.
    pub roll_deg: Option<usize>,
    /// `pitch_deg`.
    pub pitch_deg: Option<usize>,
    /// `heading_deg`.
    pub heading_deg: Option<usize>,
    /// `latitude_deg`.
    pub latitude_deg: Option<usize>,
    /// `longitude_deg`.
    pub longitude_deg: Option<usize>,
    /// `current_<load>_A`, in the order of the file.
    pub currents: Vec<LoadColumn>,
    /// `line`, a label and not a number.
    pub line: Option<usize>,
}

/// A `current_<load>_A` column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadColumn {
    /// `<load>`.
    pub load: String,
    /// Position in a row, from 0.
    pub index: usize,
}

impl Columns {
    /// Find the known columns in a header whose names are trimmed already.
    pub(super) fn find(header: &ByteRecord) -> Result<Self, Fault> {
        let mut required = [None; REQUIRED.len()];
        let mut columns = Self::default();
        for (index, name) in header.iter().enumerate() {
            // Known names are ASCII: one that is not even UTF-8 is none of them.
            let Ok(name) = std::str::from_utf8(name) else { continue };
            if let Some(place) = columns.place(&mut required, name) {
                if place.replace(index).is_some() {
                    return Err(twice(name));
                }
            } else if let Some(load) = load_of(name) {
                if columns.currents.iter().any(|known| known.load == load) {
                    return Err(twice(name));
                }
                columns.currents.push(LoadColumn { load: load.into(), index });
            }
        }
        let [Some(time_s), Some(scalar_nt), Some(x), Some(y), Some(z)] = required else {
            return Err(missing(&required, header));
        };
        Ok(Self { time_s, scalar_nt, flux_nt: [x, y, z], ..columns })
    }

    /// The place where the position of a column with this name belongs.
    fn place<'a>(
        &'a mut self,
        required: &'a mut [Option<usize>; REQUIRED.len()],
        name: &str,
    ) -> Option<&'a mut Option<usize>> {
        if let Some(at) = REQUIRED.iter().position(|&known| known == name) {
            return Some(&mut required[at]);
        }
        Some(match name {
            "scalar_valid" => &mut self.scalar_valid,
            "scalar_signal" => &mut self.scalar_signal,
            "depth_m" => &mut self.depth_m,
            "temperature_degC" => &mut self.temperature_deg_c,
            "roll_deg" => &mut self.roll_deg,
            "pitch_deg" => &mut self.pitch_deg,
            "heading_deg" => &mut self.heading_deg,
            "latitude_deg" => &mut self.latitude_deg,
            "longitude_deg" => &mut self.longitude_deg,
            "line" => &mut self.line,
            _ => return None,
        })
    }

    /// Time, scalar and the three fluxgate components.
    pub(super) fn required(&self) -> [usize; 5] {
        let [x, y, z] = self.flux_nt;
        [self.time_s, self.scalar_nt, x, y, z]
    }
}

fn load_of(name: &str) -> Option<&str> {
    name.strip_prefix("current_")?.strip_suffix("_A").filter(|load| !load.is_empty())
}

fn twice(name: &str) -> Fault {
    Fault::of(name.as_bytes(), "is there twice: rename or remove one of the two columns".into())
}

fn missing(required: &[Option<usize>], header: &ByteRecord) -> Fault {
    let missing: Vec<_> =
        REQUIRED.iter().zip(required).filter(|(_, found)| found.is_none()).map(|(&name, _)| name).collect();
    let there = header.iter().collect::<Vec<_>>().join(&b", "[..]);
    let there = shortened(&there, LONGEST_HEADER);
    let what = format!("required columns are missing: {}; the header has: {there}", missing.join(", "));
    Fault { column: None, what }
}
