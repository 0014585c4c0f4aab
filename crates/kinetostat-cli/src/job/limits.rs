//! Limits moved by `--limit NAME=VALUE` and by `[limits]` of a job file; options go over the job file.

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Limit, Limits};

use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failing};

/// The limits of the job file, and over them those of the options.
pub(crate) fn limits(job: Option<&JobFile>, options: &[String]) -> Answer<Limits> {
    let mut limits = Limits::default();
    if let Some(job) = job {
        of_job(job, &mut limits)?;
    }
    let mut given: Vec<Limit> = Vec::new();
    for text in options {
        let (limit, value) = of_option(text)?;
        if given.contains(&limit) {
            return Err(ErrorCode::Conflict.failure(format!(
                "--limit '{text}': {} is given twice; keep one of the two",
                limit.name
            )));
        }
        given.push(limit);
        limits.set(limit, value);
        if let Some(what) = no_tool(&limits) {
            return Err(ErrorCode::Value.failure(format!("--limit '{text}': {what}")));
        }
    }
    Ok(limits)
}

/// Limits of corrections that no model computes.
pub(crate) const OF_CORRECTIONS: [&str; 2] = ["correction_mm", "blocks_per_second"];

/// Refuses options of limits that mean nothing in a command; `why` says what it is about.
pub(crate) fn refuse_limits_but(used: &[&str], options: &[String], why: &str) -> Answer<()> {
    for text in options {
        let (limit, _) = of_option(text)?;
        if !used.contains(&limit.name) {
            return Err(ErrorCode::Unused.failure(format!(
                "--limit '{text}' means nothing here, because {why}; leave it out. There are: {}",
                used.join(", ")
            )));
        }
    }
    Ok(())
}

fn of_job(job: &JobFile, limits: &mut Limits) -> Answer<()> {
    let mut last = None;
    for (name, value) in &job.job.limits {
        let Some(limit) = Limits::named(name.get_ref()) else {
            let message = format!("unknown key '{}'", name.get_ref());
            return Err(job.error(name, &message, &format!("there are: {}", names())));
        };
        if !limit.takes(*value.get_ref()) {
            let found = limit.with_unit(value.get_ref());
            let message = format!("the limit '{}' is {found}", limit.name);
            return Err(job.error(value, &message, &limit.range_description()));
        }
        limits.set(limit, *value.get_ref());
        if limit.name.ends_with("tool_mm") {
            last = Some(value);
        }
    }
    match (no_tool(limits), last) {
        (Some(what), Some(value)) => Err(job.error(value, &what, "correct one of the two")),
        _ => Ok(()),
    }
}

fn of_option(text: &str) -> Answer<(Limit, f64)> {
    let refuse = |reason: &str| ErrorCode::Value.failure(format!("--limit '{text}': {reason}"));
    let unread = |reason: &str| {
        refuse(&format!(
            "{reason}; write NAME=VALUE, as in correction_mm=5. There are: {}",
            names()
        ))
    };
    let (name, value) = text.split_once('=').ok_or_else(|| unread("no value"))?;
    let limit = Limits::named(name.trim()).ok_or_else(|| unread("unknown name"))?;
    let value: f64 = value
        .trim()
        .parse()
        .ok()
        .filter(|v: &f64| v.is_finite())
        .ok_or_else(|| unread("the value is no finite number"))?;
    if !limit.takes(value) {
        return Err(refuse(&limit.range_description()));
    }
    Ok((limit, value))
}

/// Message if the shortest tool is longer than the longest.
fn no_tool(limits: &Limits) -> Option<String> {
    let Limits {
        shortest_tool_mm: shortest,
        longest_tool_mm: longest,
        ..
    } = limits;
    (shortest > longest).then(|| {
        format!(
            "shortest_tool_mm is {shortest} and longest_tool_mm is {longest}: no tool would be allowed"
        )
    })
}

fn names() -> String {
    Limits::ALL.map(|limit| limit.name).join(", ")
}
