//! Where the rows were.

use towmag_recording::Column;

use crate::error::ExportError;
use crate::table::Table;

/// Columns of the grid that a survey is planned on; not of a recording, but of what was made from one.
const GRID: [&str; 2] = ["easting_m", "northing_m"];

/// Two columns that place a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Position<'a> {
    /// Eastwards: longitude or easting.
    pub(crate) x: &'a [f64],
    /// Northwards: latitude or northing.
    pub(crate) y: &'a [f64],
    /// The columns, x first.
    pub(crate) names: [&'static str; 2],
    /// Whether it is longitude and latitude in WGS 84, and not a grid that nobody has named.
    pub(crate) is_wgs84: bool,
}

impl<'a> Position<'a> {
    /// On the grid where there is one, else by longitude and latitude; `None` where no row has either.
    pub(crate) fn any(table: &'a Table) -> Option<Self> {
        let known = |names, is_wgs84| Self::of(table, names, is_wgs84).filter(|position| position.is_known(table));
        known(GRID, false).or_else(|| known(geographic(), true))
    }

    /// By longitude and latitude; `None` where no row has them.
    ///
    /// # Errors
    ///
    /// When one is not on Earth.
    pub(crate) fn on_earth(table: &'a Table) -> Result<Option<Self>, ExportError> {
        let Some(position) = Self::of(table, geographic(), true) else { return Ok(None) };
        for (name, values, limit) in [(position.names[0], position.x, 180.0), (position.names[1], position.y, 90.0)] {
            if let Some(row) = values.iter().position(|degrees| degrees.abs() > limit) {
                return Err(table.at(row, name, format!("{} is outside -{limit} to {limit} degrees", values[row])));
            }
        }
        Ok(Some(position).filter(|position| position.is_known(table)))
    }

    /// By longitude and latitude.
    ///
    /// # Errors
    ///
    /// When there is none, or one that is not on Earth.
    pub(crate) fn wgs84(table: &'a Table) -> Result<Self, ExportError> {
        Self::on_earth(table)?.ok_or_else(|| missing(table))
    }

    /// By longitude and latitude where there are some, for a map needs no more; else on the grid.
    ///
    /// # Errors
    ///
    /// When there is neither, or a position that is not on Earth.
    pub(crate) fn on_a_map(table: &'a Table) -> Result<Self, ExportError> {
        let grid = || Self::of(table, GRID, false).filter(|grid| grid.is_known(table));
        Self::on_earth(table)?.or_else(grid).ok_or_else(|| missing(table))
    }

    /// Where a row was, x first, if it is known.
    pub(crate) fn at(&self, row: usize) -> Option<[f64; 2]> {
        Some([self.x[row], self.y[row]]).filter(|position| position.iter().all(|value| !value.is_nan()))
    }

    fn is_known(&self, table: &Table) -> bool {
        (0..table.len()).any(|row| self.at(row).is_some())
    }

    fn of(table: &'a Table, names: [&'static str; 2], is_wgs84: bool) -> Option<Self> {
        let [x, y] = names.map(|name| table.numbers(name));
        Some(Self { x: x?, y: y?, names, is_wgs84 })
    }
}

fn geographic() -> [&'static str; 2] {
    [Column::Longitude.name(), Column::Latitude.name()]
}

fn missing(table: &Table) -> ExportError {
    let names = geographic();
    let absent: Vec<&str> = names.into_iter().filter(|name| table.numbers(name).is_none()).collect();
    let what = match absent.as_slice() {
        [] => format!("{} and {} are empty in every row", names[0], names[1]),
        [name] => format!("{name} is missing"),
        _ => format!("{} are missing", absent.join(" and ")),
    };
    table.lacks(format!("{what}, so there is no track: add positions, or export to xyz, parquet, mcap or hdf5"))
}
