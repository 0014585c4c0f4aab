//! Placement of the program in the machine, and orientation of the tool.

use kinetostat::{Mechanism, Pose};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::Placement;
use nalgebra::{UnitQuaternion, Vector3};
use serde_spanned::Spanned;

use crate::job::arguments::ProgramArgs;
use crate::job::format::OrientationWord;
use crate::job::job_file::JobFile;
use crate::job::values::{chosen, scale_of_program};
use crate::options::vector;
use crate::place::orientation;
use crate::place::query::FARTHEST;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::{short, triple};

pub(crate) fn placement(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    mechanism: &Mechanism,
) -> Answer<Placement> {
    let table = job.map(|j| j.job.placement.clone()).unwrap_or_default();
    let origin = origin_mm(job, flags, table.part_origin_mm.as_ref())?;
    let written = |at: &Option<Spanned<kinetostat_model::schema::Placement>>| {
        let (Some(j), Some(table)) = (job, at) else {
            return Ok(None);
        };
        let pose = table
            .get_ref()
            .pose()
            .map_err(|(message, help)| j.error(table, &message, &help))?;
        if pose.translation.vector.norm() > 0.0 {
            return Err(j.error(
                table,
                "this is an orientation, but a position is given in it",
                "write the place of the part as part_origin_mm, the tool's tip under [tool]",
            ));
        }
        Ok(Some(pose.rotation))
    };
    let part: UnitQuaternion<f64> = match &flags.part_orientation {
        Some(text) => orientation::option("--part-orientation", text)?,
        None => written(&table.part_orientation)?.unwrap_or_default(),
    };
    let home = mechanism.platforms()[mechanism.tool()].home.rotation;
    let flag = match &flags.tool_orientation {
        Some(text) => Some(orientation::option_or_follows("--tool-orientation", text)?),
        None => None,
    };
    let in_job = written(&table.tool_orientation)?;
    let follows = match (flag, table.orientation) {
        (Some(None), _) | (None, Some(OrientationWord::Follows)) => true,
        (Some(Some(_)), _) | (None, Some(OrientationWord::Held)) => false,
        // Unless it was requested, no machine is held to what it cannot do.
        (None, None) => in_job.is_none() && mechanism.turns_as_it_moves(),
    };
    let tool = flag.flatten().or(in_job).unwrap_or(home);
    let scale = chosen(
        job,
        "--scale",
        flags.scale,
        table.scale.as_ref(),
        scale_of_program,
    )?
    .unwrap_or(1.0);
    Ok(Placement {
        base_from_part: Pose::from_parts((1e-3 * origin).into(), part),
        tool_orientation: tool,
        orientation_follows: follows,
        scale,
    })
}

/// Position of the program's zero, mm.
fn origin_mm(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    written: Option<&Spanned<[f64; 3]>>,
) -> Answer<Vector3<f64>> {
    let too_far = |mm: &[f64]| mm.iter().copied().find(|x| 1e-3 * x.abs() > FARTHEST);
    let far = |x: f64| format!("{x:?} mm leads more than 10 km away; coordinates are in mm");
    if let Some(given) = &flags.part_origin_mm {
        return match too_far(given) {
            Some(x) if x.is_finite() => {
                Err(ErrorCode::Value.failure(format!("--part-origin-mm: {}", far(x))))
            }
            _ => vector("--part-origin-mm", given),
        };
    }
    let Some(written) = written else {
        return Ok(Vector3::zeros());
    };
    match (job, too_far(written.get_ref())) {
        (Some(j), Some(x)) => Err(j.error(
            written,
            &far(x),
            "write where the program's zero lies in the base, as in part_origin_mm = [20, 20, 120]",
        )),
        _ => Ok((*written.get_ref()).into()),
    }
}

pub(crate) fn placement_description(placement: &Placement) -> String {
    let origin = placement.base_from_part.translation.vector * 1e3;
    let mut text = format!(
        "program zero at {} mm in the base, axes {}; tool {}",
        triple(origin.into(), short),
        orientation::description(&placement.base_from_part.rotation),
        match placement.orientation_follows {
            true => format!(
                "as near as it can be to the orientation {} (the orientation follows)",
                orientation::description(&placement.tool_orientation)
            ),
            false => orientation::description(&placement.tool_orientation),
        },
    );
    if placement.scale != 1.0 {
        text.push_str(&format!("; scaled by {}", placement.scale));
    }
    text
}
