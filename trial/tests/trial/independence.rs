//! The trial judges the diagnosis: nothing that it is built from may be what it judges.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use toml::Value;

/// Every package of a lock file and what it is built from, tests included.
fn packages(lock: &Path) -> BTreeMap<String, Vec<String>> {
    let lock: toml::Table = std::fs::read_to_string(lock).unwrap().parse().unwrap();
    let of = |package: &Value| {
        let named = package.get("dependencies").and_then(Value::as_array).into_iter().flatten();
        // "name", or "name version" where there are several.
        let names = named.map(|name| name.as_str().unwrap().split(' ').next().unwrap().to_string());
        (package["name"].as_str().unwrap().to_string(), names.collect())
    };
    lock["package"].as_array().unwrap().iter().map(of).collect()
}

fn tree(root: &str, packages: &BTreeMap<String, Vec<String>>) -> BTreeSet<String> {
    let mut found = BTreeSet::from([root.to_string()]);
    let mut open = vec![root.to_string()];
    while let Some(name) = open.pop() {
        let new = packages[&name].iter().filter(|name| found.insert((*name).clone()));
        open.extend(new.cloned());
    }
    found
}

#[test]
fn the_trial_is_built_without_the_core_and_without_host_sim() {
    let packages = packages(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.lock"));
    let tree_of = |root: &str| tree(root, &packages);
    let trial = tree_of("towmag-trial");
    assert!(trial.contains("rand_chacha"), "{trial:?}");
    let is_judged = |name: &String| name == "towmag" || name.starts_with("host-sim");
    assert!(!trial.iter().any(is_judged), "{trial:?}");
    // And the test would notice.
    let host_sim = tree_of("host-sim");
    assert!(host_sim.contains("towmag") && host_sim.contains("host-sim-library"));
}
