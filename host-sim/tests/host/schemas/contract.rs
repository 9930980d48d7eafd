//! `docs/schemas` and `docs/results.md`, held against documents.

use std::path::Path;

use jsonschema::Registry;
use serde_json::Value;

use super::place::{Keys, Place, Schemas};
use crate::common::of_repository;

/// What is promised of the results.
pub(crate) struct Contract {
    pub(crate) schemas: Schemas,
    /// Keys and columns by table, as documented.
    pub(crate) documented: Keys,
}

impl Contract {
    pub(crate) fn read() -> Self {
        let files = std::fs::read_dir(of_repository("docs/schemas")).unwrap().map(|file| file.unwrap().path());
        let name = |path: &Path| path.file_name().unwrap().to_str().unwrap().to_string();
        let schemas = files.map(|path| (name(&path), json(&path))).collect();
        Self { schemas, documented: documented(&page()) }
    }

    /// What is wrong with a document; nothing where it is as promised.
    pub(crate) fn errors(&self, schema: &str, document: &Value) -> Vec<String> {
        let uri = |name: &str| format!("json-schema:///{name}");
        let all = self.schemas.iter().map(|(name, schema)| (uri(name), schema));
        let registry = Registry::new().extend(all).unwrap().prepare().unwrap();
        let validator = jsonschema::options().with_registry(&registry).build(&self.schemas[schema]).unwrap();
        validator.iter_errors(document).map(|error| format!("{}: {error}", error.instance_path())).collect()
    }

    /// Keys of a document that no table tells.
    pub(crate) fn undocumented(&self, schema: &str, document: &Value) -> Vec<String> {
        let mut keys = Keys::new();
        Place::root(&self.schemas, schema).keys_of(document, &mut keys);
        let is_told = |table: &String, key: &String| self.documented.get(table).is_some_and(|told| told.contains(key));
        let each = keys.iter().flat_map(|(table, keys)| keys.iter().map(move |key| (table, key)));
        each.filter(|(table, key)| !is_told(table, key)).map(|(table, key)| format!("{table}: {key}")).collect()
    }

    /// Columns of a table that are documented.
    pub(crate) fn columns(&self, table: &str) -> Vec<&str> {
        self.documented[table].iter().map(String::as_str).collect()
    }
}

pub(crate) fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap_or_else(|error| panic!("{path:?}: {error}"))
}

pub(crate) fn page() -> String {
    std::fs::read_to_string(of_repository("docs/results.md")).unwrap()
}

/// The names in the first column of every table behind `<!-- keys: TABLE -->` or `<!-- columns: TABLE -->`.
fn documented(page: &str) -> Keys {
    let mut keys = Keys::new();
    let mut table = None;
    for line in page.lines() {
        let mark = line.strip_prefix("<!-- keys: ").or_else(|| line.strip_prefix("<!-- columns: "));
        if let Some(name) = mark.and_then(|mark| mark.strip_suffix(" -->")) {
            table = Some(name.to_string());
        } else if !line.starts_with('|') {
            table = None;
        } else if let Some(name) = &table {
            let first = line.split('|').nth(1).unwrap();
            let names = first.split('`').skip(1).step_by(2).map(String::from);
            keys.entry(name.clone()).or_default().extend(names);
        }
    }
    keys
}
