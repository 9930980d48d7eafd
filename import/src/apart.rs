//! Columns told apart by their names: messages, options and profiles know them by nothing else.

use std::collections::HashSet;

use crate::source::SourceTable;

/// A column without a name has the number of its place, from 1; so has one whose name another one has before it.
pub(crate) fn tell_apart(table: &mut SourceTable) {
    let mut taken: HashSet<String> = HashSet::new();
    for (at, column) in table.columns.iter_mut().enumerate() {
        if column.name.is_empty() || taken.contains(&column.name) {
            let stem = if column.name.is_empty() { "column" } else { &column.name };
            let free = (at + 1..).map(|number| format!("{stem}_{number}")).find(|name| !taken.contains(name));
            column.name = free.unwrap_or_default();
        }
        taken.insert(column.name.clone());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::SourceColumn;

    #[test]
    fn equal_names_and_none_get_the_number_of_their_place() {
        let columns = ["mag", "mag", "", "mag_5", "mag", "Mag"].map(|name| SourceColumn::numbers(name, Vec::new()));
        let mut table = SourceTable { columns: columns.into(), ..SourceTable::default() };
        tell_apart(&mut table);
        let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(names, ["mag", "mag_2", "column_3", "mag_5", "mag_6", "Mag"]);
    }
}
