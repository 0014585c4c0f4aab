//! Subject of the command: a program, or a job with its program.

use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;

use crate::engagement::arguments::EngagementArgs;
use crate::ui::failure::{Answer, Failing};

/// Job file and program, as far as they are named.
pub(super) struct Subject<'a> {
    pub(super) job: Option<&'a Path>,
    /// Program in place of the job's.
    pub(super) program: Option<PathBuf>,
}

/// Sorts what is named out: a file without an option is a job file by its ending, or else a program.
pub(super) fn subject(args: &EngagementArgs) -> Answer<Subject<'_>> {
    let is_job = |path: &Path| {
        let ending = path.extension().and_then(|ending| ending.to_str());
        ending.is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
    };
    let twice = |what: &str, a: &Path, b: &Path| {
        Err(ErrorCode::Conflict.failure(format!(
            "two {what} are named: '{}' and '{}'; keep one of them",
            a.display(),
            b.display()
        )))
    };
    let named = args.subject.as_deref();
    let (job, program) = match named.map(is_job) {
        Some(true) => (named, None),
        _ => (None, named),
    };
    let job = match (job, args.job.as_deref()) {
        (Some(a), Some(b)) => return twice("job files", a, b),
        (a, b) => a.or(b),
    };
    let program = match (program, args.program.as_deref()) {
        (Some(a), Some(b)) => return twice("programs", a, b),
        (a, b) => a.or(b),
    };
    Ok(Subject {
        job,
        program: program.map(Path::to_owned),
    })
}
