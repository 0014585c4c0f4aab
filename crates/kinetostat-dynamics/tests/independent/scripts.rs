//! Programs of others, called through small scripts.

use std::io::Write;
use std::process::{Command, Stdio};

use serde_json::Value;

/// What a script under `scripts/` answers; `None`, said in words, where Python or what the script needs is not installed.
pub fn ask(script: &str, needs: &str, request: &Value) -> Option<Value> {
    let path = format!(
        "{}/../../validation/scripts/{script}",
        env!("CARGO_MANIFEST_DIR")
    );
    let started = Command::new("python3")
        .arg(path)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn();
    let Ok(mut process) = started else {
        println!("SKIPPED: python3 is not installed");
        return None;
    };
    process
        .stdin
        .take()
        .unwrap()
        .write_all(request.to_string().as_bytes())
        .ok();
    let output = process.wait_with_output().unwrap();
    if output.status.code() == Some(3) {
        println!("SKIPPED: {needs} is not installed");
        return None;
    }
    assert!(output.status.success(), "{script} failed");
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

/// A list of numbers; NaN where there is none, so that no test passes without it.
pub fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().unwrap();
    list.iter()
        .map(|x| x.as_f64().unwrap_or(f64::NAN))
        .collect()
}
