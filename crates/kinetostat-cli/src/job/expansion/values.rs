//! Numbers with a value each: options of the form NUMBER=VALUE, and tables of a job file.

use std::collections::BTreeMap;

use crate::job::expand_table::NumberedTable;
use crate::job::job_file::JobFile;
use crate::job::values::NotAllowed;
use crate::ui::failure::{Answer, Failure};

/// Predicate for allowed values.
pub(super) type Allowed = fn(f64) -> Result<f64, NotAllowed>;

/// Diameters of tools: what would be larger is in another unit.
pub(super) fn diameter(mm: f64) -> Result<f64, NotAllowed> {
    match (-1000.0..=1000.0).contains(&mm) {
        true => Ok(mm),
        false => Err(NotAllowed(
            "a tool is at most 1000 mm in diameter; a diameter below 0 puts it on the other side",
        )),
    }
}

/// Parameters: any number.
pub(super) fn any(value: f64) -> Result<f64, NotAllowed> {
    match value.is_finite() {
        true => Ok(value),
        false => Err(NotAllowed("a finite number is needed")),
    }
}

/// The values of options by their numbers.
pub(super) fn of_options(
    option: &str,
    words: &[String],
    allowed: Allowed,
) -> Answer<BTreeMap<u32, f64>> {
    let mut values = BTreeMap::new();
    for word in words {
        let refuse = |what: &str| {
            Failure::input(format!(
                "{option} '{word}': {what}; write a number and its value, as in 3=6.5"
            ))
        };
        let (number, value) = word
            .split_once('=')
            .ok_or_else(|| refuse("there is no ="))?;
        let number: u32 = number
            .trim()
            .parse()
            .map_err(|_| refuse("before the = stands no whole number"))?;
        let value = value.trim().parse().ok().filter(|x: &f64| x.is_finite());
        let value = value.ok_or_else(|| refuse("behind the = stands no number"))?;
        let value = allowed(value).map_err(|NotAllowed(reason)| refuse(reason))?;
        if values.insert(number, value).is_some() {
            return Err(refuse("the number comes twice"));
        }
    }
    Ok(values)
}

/// The values of a table of a job by their numbers.
pub(super) fn of_table(
    job: &JobFile,
    table: Option<&NumberedTable>,
    allowed: Allowed,
) -> Answer<BTreeMap<u32, f64>> {
    let mut values = BTreeMap::new();
    for (key, value) in table.into_iter().flat_map(|table| table.get_ref()) {
        let number: u32 = key.get_ref().trim().parse().map_err(|_| {
            let what = format!("'{}' is no whole number", key.get_ref());
            job.error(
                key,
                &what,
                "write a number and its value, as in  { 3 = 6.5 }",
            )
        })?;
        let number_value = allowed(*value.get_ref()).map_err(|NotAllowed(reason)| {
            let what = format!("the value {} is not allowed here", value.get_ref());
            job.error(value, &what, reason)
        })?;
        // 1 and 01 are one number.
        if values.insert(number, number_value).is_some() {
            let what = format!("the number {number} comes twice");
            return Err(job.error(key, &what, "keep one of the two"));
        }
    }
    Ok(values)
}
