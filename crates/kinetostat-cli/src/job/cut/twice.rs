//! A load that is given twice is refused.

use serde_spanned::Spanned;

use crate::job::arguments::ProgramArgs;
use crate::job::format::LoadTable;
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failure};

/// Source of a computed force that excludes a typed one, in words.
pub(super) struct OtherForce {
    /// Text after "a force, and".
    what: &'static str,
    /// Text after "on the command line, and by".
    whose: &'static str,
    table: &'static str,
}

pub(super) const MATERIAL: OtherForce = OtherForce {
    what: "a material to compute it from",
    whose: "the material",
    table: "[material]",
};

pub(super) const MEASURED: OtherForce = OtherForce {
    what: "measured forces",
    whose: "the measured forces",
    table: "[measured]",
};

/// A force that is typed in stands against one that is computed or measured.
pub(super) fn not_typed_too<T>(
    j: &JobFile,
    flags: &ProgramArgs,
    table: &Spanned<T>,
    other: &OtherForce,
) -> Answer<()> {
    let typed = |load: &LoadTable| {
        load.force_n.is_some() || load.moment_n_m.is_some() || load.milling.is_some()
    };
    let of_tools = j
        .job
        .tools
        .iter()
        .filter_map(|tool| tool.get_ref().load.as_ref());
    if typed(&j.job.load) || of_tools.into_iter().any(typed) {
        return Err(j.error(
            table,
            &format!("the load is given twice: a force, and {}", other.what),
            &format!("keep [load] or {}", other.table),
        ));
    }
    if flags.force.is_some() || flags.moment.is_some() || flags.milling.is_some() {
        return Err(Failure::input(format!(
            "the load is given twice: on the command line, and by {} of the job file; keep one of them",
            other.whose
        )));
    }
    Ok(())
}
