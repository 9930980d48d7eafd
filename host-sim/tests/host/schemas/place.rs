//! A place in a schema, and the table of `docs/results.md` that tells its keys.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

/// Keys by the table that they belong to.
pub(crate) type Keys = BTreeMap<String, BTreeSet<String>>;

/// Every schema by its file name.
pub(crate) type Schemas = BTreeMap<String, Value>;

/// A part of a schema.
#[derive(Clone)]
pub(crate) struct Place<'a> {
    schemas: &'a Schemas,
    file: &'a str,
    node: &'a Value,
    /// Table, such as `summary.schema.json#bad_rows`.
    table: String,
    /// From there, such as `first[].line`.
    path: String,
}

impl<'a> Place<'a> {
    pub(crate) fn root(schemas: &'a Schemas, file: &str) -> Self {
        let (file, node) = schemas.get_key_value(file).unwrap_or_else(|| panic!("no schema {file}"));
        Self { schemas, file, node, table: file.clone(), path: String::new() }
    }

    /// Where a reference leads. What has keys of its own and is referred to has a table of its own.
    fn followed(self) -> Self {
        if let Some(other) = self.node.get("anyOf").and_then(Value::as_array) {
            let not_null = other.iter().find(|node| node["type"] != "null").unwrap();
            return Self { node: not_null, ..self }.followed();
        }
        let Some(reference) = self.node.get("$ref").and_then(Value::as_str) else { return self };
        let (file, name) = reference.split_once("#/$defs/").unwrap_or((reference, ""));
        let root = Self::root(self.schemas, if file.is_empty() { self.file } else { file });
        if name.is_empty() {
            return root;
        }
        let target = Self { node: &root.node["$defs"][name], table: format!("{}#{name}", root.file), ..root };
        assert!(!target.node.is_null(), "{reference}");
        if target.node.get("properties").is_some() {
            return target;
        }
        Self { file: target.file, node: target.node, ..self }.followed()
    }

    fn below(&self, node: &'a Value, path: String) -> Self {
        Self { node, path, ..self.clone() }
    }

    fn path_of(&self, key: &str) -> String {
        if self.path.is_empty() { key.into() } else { format!("{}.{key}", self.path) }
    }

    fn items(&self) -> Option<Self> {
        Some(self.below(self.node.get("items")?, format!("{}[]", self.path)))
    }

    /// Of keys that are names of something.
    fn any_key(&self) -> Option<Self> {
        let node = self.node.get("additionalProperties").filter(|node| node.is_object())?;
        Some(self.below(node, self.path_of("*")))
    }

    fn key(&self, key: &str) -> Option<Self> {
        let node = self.node.get("properties").and_then(|properties| properties.get(key));
        node.map(|node| self.below(node, self.path_of(key))).or_else(|| self.any_key())
    }

    fn told(&self, keys: &mut Keys) -> bool {
        keys.entry(self.table.clone()).or_default().insert(self.path.clone())
    }

    /// Every key that the schema knows.
    pub(crate) fn all_keys(self, keys: &mut Keys) {
        let place = self.followed();
        let named = place.node.get("properties").and_then(Value::as_object).into_iter().flatten();
        let children = named.map(|(key, node)| place.below(node, place.path_of(key))).chain(place.any_key());
        for child in children {
            if child.told(keys) {
                child.all_keys(keys);
            }
        }
        if let Some(items) = place.items() {
            items.all_keys(keys);
        }
    }

    /// Every key that a document has, those too that the schema does not know.
    pub(crate) fn keys_of(self, document: &Value, keys: &mut Keys) {
        let place = self.followed();
        for (key, value) in document.as_object().into_iter().flatten() {
            match place.key(key) {
                Some(child) => {
                    child.told(keys);
                    child.keys_of(value, keys);
                }
                None => {
                    place.below(&Value::Null, place.path_of(key)).told(keys);
                }
            }
        }
        for value in document.as_array().into_iter().flatten() {
            if let Some(items) = place.items() {
                items.keys_of(value, keys);
            }
        }
    }
}
