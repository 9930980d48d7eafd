//! Names of columns as SQLite takes them: quoted, and different even where case does not count.

use crate::table::Table;

/// Of all columns, in their order.
pub(super) fn of_columns(table: &Table) -> Vec<String> {
    let mut taken: Vec<String> = Vec::new();
    for column in &table.columns {
        let name = free(&column.name, &taken);
        taken.push(name);
    }
    taken.iter().map(|name| quoted(name)).collect()
}

/// Of the key and of the geometry: the usual ones, unless a column has them.
pub(super) fn own(columns: &[(String, &'static str)]) -> [String; 2] {
    let taken: Vec<String> = columns.iter().map(|(name, _)| name.trim_matches('"').to_string()).collect();
    ["fid", "geom"].map(|name| quoted(&free(name, &taken)))
}

fn free(name: &str, taken: &[String]) -> String {
    let mut name = name.to_string();
    while taken.iter().any(|taken| taken.to_lowercase() == name.to_lowercase()) {
        name.push('_');
    }
    name
}

fn quoted(name: &str) -> String {
    format!("\"{}\"", name.replace('"', "\"\""))
}
