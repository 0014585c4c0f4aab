//! The deflection at one place.

use std::path::Path;

use kinetostat::Wrench;

use crate::deflect::answer::answer;
use crate::deflect::arguments::DeflectArgs;
use crate::deflect::text::answer_text;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::machine::displacement_warnings::snaps;
use crate::place::query::place_query;
use crate::ui::failure::{Answer, Failure};
use crate::ui::json;

/// Why nothing is reported of a place where the machine's own loads find no equilibrium.
fn without_load(error: kinetostat::Error) -> Failure {
    match &error {
        kinetostat::Error::NotConverged {
            place,
            load_factor,
            limit: None,
            ..
        } => Failure::unanswered(format!(
            "{place}: without any load on the tool, weights, preloads and deviations of the model lead from the commanded place to no equilibrium (only {} of them could be followed); check them, or let `kinetostat equilibria` search for the shapes that the machine can take",
            kinetostat_machining::number::share(*load_factor)
        )),
        _ => error.into(),
    }
}

pub(crate) fn at_place(args: &DeflectArgs) -> Answer<()> {
    refuse_program_flags(args)?;
    let files = InputFiles::default();
    let query = place_query(
        &files,
        &args.subject,
        &args.place,
        args.program.tool_length_mm,
        args.program.force.as_deref(),
        args.program.moment.as_deref(),
    )?;
    let posture = query.posture()?;
    let rest = posture.deflected_by(&Wrench::zero());
    let rest = rest.map_err(without_load)?;
    let loaded = posture.deflected_by(&query.wrench)?;
    let limit = posture.snaps_before(&rest, &loaded)?;
    let mut answer = answer(&query, &posture, &loaded, &rest, limit.is_some());
    answer.warnings.extend(limit.as_ref().map(snaps));
    let text = answer_text(&query, &answer);
    let to_screen = args.json.as_deref() == Some(Path::new("-"));
    let mut paths = Vec::new();
    if let Some(path) = args.json.as_deref().filter(|_| !to_screen) {
        let mut outputs = Outputs::new(
            Existing::forced(args.program.force_overwrite),
            query.inputs.clone(),
        );
        let index = outputs.claim("result", path)?;
        outputs.fill(index, json::json(&answer)?.as_bytes())?;
        paths = outputs.commit()?;
    }
    let text = format!("{text}{}", outputs::written(&paths));
    json::print_answer(&text, &answer, to_screen)
}

/// Options that say something about a program are not dropped silently.
fn refuse_program_flags(args: &DeflectArgs) -> Answer<()> {
    let p = &args.program;
    let given = [
        ("--report", p.report.is_some()),
        ("--points", p.points.is_some()),
        ("--all-points", p.all_points),
        ("--milling", p.milling.is_some()),
        ("--part-origin-mm", p.part_origin_mm.is_some()),
        ("--part-orientation", p.part_orientation.is_some()),
        ("--tool-orientation", p.tool_orientation.is_some()),
        ("--below-z-mm", p.below_z_mm.is_some()),
        ("--weight", p.weight.is_some()),
        ("--touch-off", p.touch_off.is_some()),
        ("--load-axes", p.load_axes.is_some()),
        ("--load-at-corners", p.load_at_corners.is_some()),
        ("--scale", p.scale.is_some()),
        ("--units", p.reading.units.is_some()),
        ("--arc-tolerance", p.reading.arc_tolerance.is_some()),
        ("--work-offset", !p.reading.work_offset.is_empty()),
        ("--block-delete", p.reading.block_delete.is_some()),
        ("--axes-stand-still", p.reading.axes_stand_still),
        ("--start-position-mm", p.reading.start_position_mm.is_some()),
        ("--machine-zero-mm", p.reading.machine_zero_mm.is_some()),
        ("--g28-mm", p.reading.g28_mm.is_some()),
        ("--g30-mm", p.reading.g30_mm.is_some()),
        ("--chord-tolerance-um", p.chord_tolerance_um.is_some()),
        ("--limit", !p.limits.is_empty()),
    ];
    match given.iter().find(|(_, given)| *given) {
        Some((name, _)) => Err(Failure::input(format!(
            "{name} belongs to a run along a program; name the program with --program FILE or give a job file"
        ))),
        None => Ok(()),
    }
}
