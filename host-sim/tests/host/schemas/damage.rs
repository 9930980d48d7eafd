//! Documents that no schema may let through.

use serde_json::{Value, json};

/// The document with each of its values, one at a time, replaced by one of another type. Names that are carried through are texts as any
/// other; what may be null is not tried as null.
pub(crate) fn of(document: &Value) -> Vec<(String, Value)> {
    let mut places = Vec::new();
    leaves(document, String::new(), &mut places);
    let damaged = |pointer: String| {
        let mut damaged = document.clone();
        let value = damaged.pointer_mut(&pointer).unwrap();
        *value = if value.is_array() { json!({"damaged": true}) } else { json!(["damaged"]) };
        (pointer, damaged)
    };
    places.into_iter().map(damaged).collect()
}

/// Pointers to everything in a document; of arrays to the first element.
fn leaves(value: &Value, pointer: String, places: &mut Vec<String>) {
    if !pointer.is_empty() {
        places.push(pointer.clone());
    }
    for (key, value) in value.as_object().into_iter().flatten() {
        leaves(value, format!("{pointer}/{}", key.replace('~', "~0").replace('/', "~1")), places);
    }
    if let Some(first) = value.as_array().and_then(|array| array.first()) {
        leaves(first, format!("{pointer}/0"), places);
    }
}

/// A diagnosis with an effect that says what it may not.
pub(crate) fn of_diagnosis(diagnosis: &Value) -> Vec<(&'static str, Value)> {
    let changed = |what: &'static str, pointer: &str, value: Value| {
        let mut damaged = diagnosis.clone();
        *damaged.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}")) = value;
        (what, damaged)
    };
    let mut all = vec![
        changed("a probability above one", "/effects/0/probability", json!(1.2)),
        changed("a chance below zero", "/gap/p_value", json!(-1e-9)),
        changed("a verdict that there is not", "/verdict", json!("perhaps")),
        changed("no gap, and an effect", "/verdict", json!("no_gap")),
        changed("explained by nothing", "/effects", json!([])),
        changed("no value, and an interval", "/effects/0/parameters/0/value", Value::Null),
        changed("an interval of one end", "/effects/0/gap_closed/ci95", json!([0.5])),
        changed("six that look the same", "/effects/0/indistinguishable_from", json!(["a", "b", "c", "d", "e", "f"])),
        changed("candidates without `none`", "/candidates", json!([{"name": "unknown", "probability": 1.0}])),
        changed("a format that is not known", "/schema", json!(2)),
    ];
    for key in ["verdict", "gap", "where", "effects", "candidates", "next_manoeuvre", "targets"] {
        let mut damaged = diagnosis.clone();
        damaged.as_object_mut().unwrap().remove(key);
        all.push((key, damaged));
    }
    all
}
