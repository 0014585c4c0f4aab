//! The deflection at one place.

use std::path::Path;

use kinetostat::Wrench;
use kinetostat_diagnostic::ErrorCode;

use crate::deflect::answer::answer;
use crate::deflect::arguments::DeflectArgs;
use crate::deflect::text::answer_text;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::machine::displacement_warnings::snaps;
use crate::place::query::place_query;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::given::Given;
use crate::ui::json;

/// Explains a place without result: the machine's own loads find no equilibrium there.
fn without_load(error: kinetostat::Error) -> Failure {
    match &error {
        kinetostat::Error::NotConverged {
            place,
            load_factor,
            limit: None,
            ..
        } => ErrorCode::NotConverged.failure(format!(
                "{place}: without any load on the tool, weights, preloads and deviations of the model lead from the commanded place to no equilibrium (only {} of them could be followed); check them, or let `kinetostat equilibria` search for the shapes that the machine can take",
                kinetostat_machining::number::share(*load_factor)
            ),
        ),
        _ => error.into(),
    }
}

/// Options of one place; all others are for a run along a program.
const OF_A_PLACE: [&str; 10] = [
    "--at",
    "--rotation",
    "--joints",
    "--controller",
    "--pendant",
    "--tool-length-mm",
    "--force",
    "--moment",
    "--json",
    "--force-overwrite",
];

pub(crate) fn at_place(args: &DeflectArgs, given: &Given) -> Answer<()> {
    given.refuse_but(
        &OF_A_PLACE,
        "belongs to a run along a program; name the program with --program FILE or give a job file",
    )?;
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
