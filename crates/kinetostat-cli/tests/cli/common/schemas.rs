//! Holds the JSON of every command that the tests run against the schema that `kinetostat schema` prints.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use jsonschema::Validator;
use kinetostat_machining::Unwatched;
use serde_json::Value;

/// Fails the test if a JSON result, on the standard output or in the file of `--json FILE`, does not follow its schema.
#[track_caller]
pub fn check_results(directory: &Path, arguments: &[&str], out: &str) {
    let Some(command) = arguments.first().filter(|a| !a.starts_with('-')) else {
        return;
    };
    if matches!(*command, "schema" | "help") {
        return;
    }
    check(command, out.as_bytes());
    let file = arguments.iter().position(|a| *a == "--json");
    let file = file.and_then(|at| arguments.get(at + 1));
    if let Some(file) = file.filter(|file| !file.starts_with('-'))
        && let Ok(bytes) = std::fs::read(directory.join(file))
    {
        check(command, &bytes);
    }
}

/// Results are told from other JSON, as of `model schema`, by the version of the program in them.
#[track_caller]
fn check(command: &str, bytes: &[u8]) {
    let Ok(value) = serde_json::from_slice::<Value>(bytes) else {
        return;
    };
    if value.get("kinetostat_version").is_none() && command != "reproduce" {
        return;
    }
    let is_error = value.get("errors").is_some() && value.get("exit_code").is_some();
    let command = if is_error { "error" } else { command };
    let validator = validator(command).unwrap_or_else(|| panic!("`{command}` has no schema"));
    let faults: Vec<String> = validator
        .iter_errors(&value)
        .take(5)
        .map(|error| format!("{}: {error:.300}", error.instance_path))
        .collect();
    assert!(
        faults.is_empty(),
        "JSON of `{command}` beside its schema: {faults:#?}"
    );
}

/// The compiled schema of a command, made once.
fn validator(command: &str) -> Option<Arc<Validator>> {
    static MADE: OnceLock<Mutex<BTreeMap<String, Arc<Validator>>>> = OnceLock::new();
    let made = MADE.get_or_init(Mutex::default);
    let mut made = made.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(found) = made.get(command) {
        return Some(found.clone());
    }
    let words = ["schema", command];
    let outcome = kinetostat_cli::run_inside(words.map(Into::into), Arc::new(Unwatched));
    let schema: Value = serde_json::from_slice(&outcome.out).ok()?;
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    let validator = Arc::new(validator);
    made.insert(command.to_owned(), validator.clone());
    Some(validator)
}
