//! Options and keys that are for G-code alone, where the program is one of a robot.

use kinetostat_formats::Language;
use serde_spanned::Spanned;

use crate::job::arguments::ProgramArgs;
use crate::job::expand_table::ExpandTable;
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failure};

/// Refuses what would have no effect.
pub(crate) fn refuse_unfit(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    language: Language,
) -> Answer<()> {
    // A control has the switch for blocks behind a slash, as G-code has.
    let has_switch = language.has_slash_switch();
    let refuse = |what: &str, why: &str| {
        Err(Failure::input(format!(
            "{what} is for G-code; {why}: leave it out"
        )))
    };
    let reading = &flags.reading;
    let words = "a program of a robot says it by its own statements";
    for (option, is_given) in [
        ("--units", reading.units.is_some()),
        ("--arc-tolerance", reading.arc_tolerance.is_some()),
        ("--work-offset", !reading.work_offset.is_empty()),
        (
            "--block-delete",
            reading.block_delete.is_some() && !has_switch,
        ),
        ("--axes-stand-still", reading.axes_stand_still),
        ("--tool-centre-point", reading.tool_centre_point),
        ("--start-position-mm", reading.start_position_mm.is_some()),
        ("--machine-zero-mm", reading.machine_zero_mm.is_some()),
        ("--g28-mm", reading.g28_mm.is_some()),
        ("--g30-mm", reading.g30_mm.is_some()),
    ] {
        if is_given {
            return refuse(option, words);
        }
    }
    let table = job.map(|j| &j.job.reading);
    let given = table.is_some_and(|table| {
        table.units.is_some()
            || table.arc_tolerance_mm.is_some()
            || table.block_delete.is_some() && !has_switch
            || table.axes_stand_still.is_some()
            || table.tool_centre_point.is_some()
            || table.start_position_mm.is_some()
            || table.machine_zero_mm.is_some()
            || table.g28_mm.is_some()
            || table.g30_mm.is_some()
            || table.work_offset_mm.is_some()
    });
    if given {
        return refuse("[reading] in the job file", words);
    }
    let flat = "what a control's program needs to be run once, it says itself";
    if let Some(option) = flags.expansion.with.given_for_gcode() {
        return refuse(option, flat);
    }
    let table = job.and_then(|j| j.job.expand.as_ref());
    let given = table
        .map(Spanned::get_ref)
        .and_then(ExpandTable::given_for_gcode);
    if let Some(key) = given {
        return refuse(&format!("{key} under [expand]"), flat);
    }
    let in_job = job.is_some_and(|j| j.job.placement.scale.is_some());
    match flags.scale.is_some() || in_job {
        true => refuse(
            "the scale (--scale, scale under [placement])",
            "a program of a robot is in the robot's own millimetres",
        ),
        false => Ok(()),
    }
}
