//! The results are what `docs/schemas` and `docs/results.md` say, key by key, and what is damaged is not.

mod contract;
mod damage;
mod place;
mod results;

use contract::{Contract, json, page};
use host_sim::emulator::{FIGURE_NAMES, in_instructions};
use place::{Keys, Place};
use serde_json::Value;

#[test]
fn every_key_of_a_schema_is_documented_and_no_other() {
    let contract = Contract::read();
    let mut known = Keys::new();
    contract.schemas.keys().for_each(|file| Place::root(&contract.schemas, file).all_keys(&mut known));
    let mut documented = contract.documented.clone();
    documented.retain(|table, _| table.contains(".schema.json"));
    for (table, keys) in &known {
        assert_eq!(documented.remove(table).unwrap_or_default(), *keys, "{table}");
    }
    assert!(documented.is_empty(), "tables of no schema: {documented:?}");
}

#[test]
fn every_schema_is_one_and_linked() {
    let (contract, page) = (Contract::read(), page());
    assert!(contract.schemas.len() >= 10, "{:?}", contract.schemas.keys());
    for (file, schema) in &contract.schemas {
        assert!(jsonschema::meta::is_valid(schema), "{file}: {:?}", jsonschema::meta::validate(schema));
        assert_eq!(
            (&schema["$id"], schema["properties"].get("schema").is_some()),
            (&Value::from(file.as_str()), !UNNUMBERED.contains(&file.as_str()))
        );
        assert!(page.contains(&format!("(schemas/{file})")), "{file}");
    }
}

/// Files that hold no number of their format.
const UNNUMBERED: [&str; 2] = ["answers.schema.json", "figures.schema.json"];

/// A document is as promised, and all of it is documented; damaged anywhere it is not as promised.
fn holds(contract: &Contract, schema: &str, document: &Value) {
    assert_eq!(contract.errors(schema, document), [""; 0], "{schema}");
    assert_eq!(contract.undocumented(schema, document), [""; 0], "{schema}");
    for (place, damaged) in damage::of(document) {
        assert!(!contract.errors(schema, &damaged).is_empty(), "{schema}: damage to {place} is not seen");
    }
    let mut more = document.clone();
    let object = if more.is_array() { more.get_mut(0).unwrap() } else { &mut more };
    object["a_key_of_tomorrow"] = Value::from(1);
    assert_eq!(contract.errors(schema, &more), [""; 0], "{schema}: more keys may be added");
    assert_eq!(contract.undocumented(schema, &more).len(), 1, "{schema}: a key that nobody has documented");
}

#[test]
fn compensation() {
    let contract = Contract::read();
    let folder = results::compensation();
    let path = |name: &str| folder.path().join(name);
    holds(&contract, "summary.schema.json", &json(&path("calibrated/summary.json")));
    holds(&contract, "summary.schema.json", &json(&path("replayed/summary.json")));
    holds(&contract, "compare.schema.json", &json(&path("compared/summary.json")));
    let coefficients = std::fs::read_to_string(path("calibrated/coefficients.toml")).unwrap();
    holds(&contract, "coefficients.schema.json", &toml::from_str(&coefficients).unwrap());
    let recorded = results::header(&path("survey.csv"));
    let mut columns = results::header(&path("replayed/compensated.csv"));
    assert_eq!(columns.drain(..recorded.len()).collect::<Vec<_>>(), recorded);
    columns.sort_unstable();
    assert_eq!(columns, contract.columns("compensated.csv"));
}

#[test]
fn a_survey() {
    let contract = Contract::read();
    let folder = results::surveyed();
    holds(&contract, "survey.schema.json", &json(&folder.path().join("out/summary.json")));
    let columns = |name: &str| results::header(&folder.path().join("out").join(name));
    let mut added = columns("levelled.csv").split_off(8);
    added.sort_unstable();
    assert_eq!(added, contract.columns("levelled.csv"));
    let mut contacts = columns("contacts.csv");
    contacts.sort_unstable();
    assert_eq!(contacts, contract.columns("contacts.csv"));
}

#[test]
fn a_diagnosis() {
    let contract = Contract::read();
    let folder = results::diagnosis();
    let diagnosis = json(&folder.path().join("gap/diagnosis.json"));
    assert_eq!(diagnosis["effects"][0]["name"], "mains_alias", "{}", diagnosis["summary"]);
    holds(&contract, "diagnosis.schema.json", &diagnosis);
    let mut columns = results::header(&folder.path().join("gap/gap.csv"));
    columns.sort_unstable();
    assert_eq!(columns, contract.columns("gap.csv"));
    for (damage, damaged) in damage::of_diagnosis(&diagnosis) {
        assert!(!contract.errors("diagnosis.schema.json", &damaged).is_empty(), "{damage} is not seen");
    }
}

#[test]
fn a_recording_held_against_a_simulation_and_a_plan() {
    let contract = Contract::read();
    let folder = results::held_against();
    let diagnosis = json(&folder.path().join("gap/diagnosis.json"));
    assert_eq!(diagnosis["simulation"]["terms"], "refitted");
    holds(&contract, "diagnosis.schema.json", &diagnosis);
    holds(&contract, "plan.schema.json", &json(&folder.path().join("plan/plan.json")));
}

#[test]
fn a_trial_and_its_answers() {
    let contract = Contract::read();
    let folder = results::trial();
    let [trial, answers] = ["trial.json", "answers.json"].map(|name| json(&folder.path().join(name)));
    assert_eq!(contract.undocumented("trial.schema.json", &trial), [""; 0]);
    // Damage to what a diagnosis says is tried above.
    let unopened = without_results(trial.clone());
    assert_eq!(contract.errors("trial.schema.json", &trial), [""; 0]);
    holds(&contract, "trial.schema.json", &unopened);
    holds(&contract, "answers.schema.json", &answers);
}

fn without_results(mut trial: Value) -> Value {
    trial["results"] = Value::Array(Vec::new());
    trial
}

#[test]
fn what_a_card_holds() {
    let contract = Contract::read();
    let folder = results::recovered();
    holds(&contract, "recover.schema.json", &json(&folder.path().join("found/summary.json")));
    let columns = results::header(&folder.path().join("found/recording.csv"));
    let documented = contract.columns("recording.csv");
    let unknown: Vec<_> = columns.iter().filter(|column| !documented.contains(&column.as_str())).collect();
    assert!(unknown.is_empty() && columns.len() >= 14, "{unknown:?} of {columns:?}");
}

#[test]
fn a_log_and_its_replay() {
    let contract = Contract::read();
    let folder = results::mismatch();
    let diagnosis = json(&folder.path().join("gap/diagnosis.json"));
    assert_eq!(diagnosis["exact_replay"][0]["outcome"], "differs");
    holds(&contract, "diagnosis.schema.json", &diagnosis);
}

#[test]
fn the_table_of_the_paper() {
    let folder = results::table();
    holds(&Contract::read(), "table.schema.json", &json(&folder.path().join("table.json")));
}

#[test]
fn what_the_cable_tells() {
    let folder = results::heard();
    let mut columns = results::header(&folder.path().join("telemetry.csv"));
    columns.sort_unstable();
    assert_eq!(columns, Contract::read().columns("listen.csv"));
}

#[test]
fn figures_of_an_emulated_body() {
    let figures = in_instructions(&FIGURE_NAMES.iter().map(|name| (*name, 7)).collect());
    assert_eq!(figures.len(), FIGURE_NAMES.len());
    holds(&Contract::read(), "figures.schema.json", &serde_json::to_value(figures).unwrap());
}

#[test]
fn an_import() {
    let contract = Contract::read();
    let folder = results::imported();
    for name in ["units_row", "comments", "date_and_time"] {
        let report = json(&folder.path().join(format!("{name}.import.json")));
        holds(&contract, "import.schema.json", &report);
        let profile = std::fs::read_to_string(folder.path().join(format!("{name}.profile.toml"))).unwrap();
        let keys = keys_of_profile("", &toml::from_str(&profile).unwrap());
        assert!(keys.len() >= 5, "{profile}");
        let unknown: Vec<_> = keys.iter().filter(|key| !page().contains(&format!("\n| `{key}` | "))).collect();
        assert!(unknown.is_empty(), "{name}: {unknown:?} of its profile are not documented");
    }
    let example = example_in("json", "## `REC.import.json`");
    holds(&contract, "import.schema.json", &serde_json::from_str(&example).unwrap());
    let example = example_in("toml", "## `REC.profile.toml`");
    towmag_import::profile::Profile::from_toml("example", &example).unwrap();
}

/// `text.delimiter` and the like; of all columns the same.
fn keys_of_profile(above: &str, value: &toml::Value) -> Vec<String> {
    let toml::Value::Table(table) = value else { return vec![above.to_string()] };
    let place = |key: &str| match above {
        "" => key.to_string(),
        "columns" => "columns.COLUMN".to_string(),
        above => format!("{above}.{key}"),
    };
    table.iter().flat_map(|(key, value)| keys_of_profile(&place(key), value)).collect()
}

/// An example of the page, in this language, below this heading.
fn example_in(language: &str, heading: &str) -> String {
    let page = page();
    let (_, below) = page.split_once(heading).unwrap();
    let (_, example) = below.split_once(&format!("```{language}\n")).unwrap();
    example.split("```").next().unwrap().to_string()
}
