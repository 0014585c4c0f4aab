//! What a template leaves open and the job states, in one template for both: part, tools and how the tool stands.

use kinetostat::Pose;
use kinetostat_formats::Template;
use nalgebra::{Isometry3, Vector3};

use crate::convert::free_turn::in_metres;
use crate::job::arguments::ProgramArgs;
use crate::job::job_file::JobFile;
use crate::job::machine::MachineSetup;
use crate::ui::failure::{Answer, Failure};
use crate::ui::numbers::short;

/// Differences below this are those of digits, m and rad.
const SAME: f64 = 1e-6;

/// From the tip of the tool to its holder, axes of the tool: its z lies along the spindle, and up in the part is the holder.
pub(crate) fn up(template: &Template) -> Vector3<f64> {
    let turned = template.tool_orientation.unwrap_or_default() * Vector3::z();
    match turned.z >= 0.0 {
        true => Vector3::z(),
        false => -Vector3::z(),
    }
}

/// What the template leaves open is that of the job, and both say the same.
pub(crate) fn complete(
    template: &mut Template,
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    machine: &MachineSetup,
) -> Answer<()> {
    let placement = &machine.placement;
    let part_is_stated = flags.part_origin_mm.is_some()
        || flags.part_orientation.is_some()
        || job.is_some_and(|j| {
            j.job.placement.part_origin_mm.is_some() || j.job.placement.part_orientation.is_some()
        });
    let base = one_of(
        ("[base]", template.base.pose.as_ref()),
        (
            "the place of the part (part_origin_mm, part_orientation)",
            part_is_stated,
        ),
        &placement.base_from_part,
    )?;
    template.base.pose = Some(base);
    if job.is_some_and(|j| !j.job.tools.is_empty()) {
        numbered_tools(template, machine)?;
    }
    if template.tools.is_empty() {
        let given = machine.bounds.tools.first();
        let of_job = given.map_or_else(Pose::identity, |given| given.pose);
        let is_stated = given.is_some_and(|given| given.stated);
        let tool = one_of(
            ("[tool]", template.tool.frame.pose.as_ref()),
            ("the tool (length_mm, pose)", is_stated),
            &of_job,
        )?;
        template.tool.frame.pose = Some(tool);
        if let (None, Some(own)) = (template.tool.mass_kg, machine.tool_mass) {
            template.tool.mass_kg = Some(own.mass_kg);
            template.tool.centre_of_mass_mm = Some(own.centre_mm);
        }
    }
    let stated = flags.tool_orientation.is_some()
        || job.is_some_and(|j| j.job.placement.tool_orientation.is_some());
    let in_part = base.rotation.inverse() * placement.tool_orientation;
    template.tool_orientation = Some(match template.tool_orientation {
        Some(own) if stated && own.angle_to(&in_part) > SAME => {
            return Err(twice("tool_orientation", "tool_orientation"));
        }
        Some(own) => own,
        None => in_part,
    });
    Ok(())
}

/// The tools of a job under `[[tools]]`: each is one of the template, with the number that it has in the program.
fn numbered_tools(template: &mut Template, machine: &MachineSetup) -> Answer<()> {
    for given in &machine.bounds.tools {
        let Some(number) = given.number else { continue };
        let tool = template.tools.entry(number).or_default();
        let pose = one_of(
            (
                &format!("in_program = {number} under [[tools]]"),
                tool.frame.pose.as_ref(),
            ),
            (&format!("number = {number} under [[tools]]"), true),
            &given.pose,
        )?;
        tool.frame.pose = Some(pose);
        if tool.frame.number.is_none() && tool.frame.name.is_none() {
            tool.frame.number = Some(number);
        }
    }
    Ok(())
}

/// The pose of a template, or that of a job, mm.
fn one_of(
    (of_template, own): (&str, Option<&Isometry3<f64>>),
    (of_job, is_stated): (&str, bool),
    pose: &Pose,
) -> Answer<Isometry3<f64>> {
    let in_mm = Isometry3::from_parts((1e3 * pose.translation.vector).into(), pose.rotation);
    let Some(own) = own else {
        return Ok(in_mm);
    };
    let metres = in_metres(own);
    let apart = (metres.translation.vector - pose.translation.vector).norm() > SAME
        || metres.rotation.angle_to(&pose.rotation) > SAME;
    match is_stated && apart {
        true => Err(twice(of_template, of_job)),
        false => Ok(*own),
    }
}

fn twice(of_template: &str, of_job: &str) -> Failure {
    Failure::input(format!(
        "stated twice, and not the same: {of_template} in the template and {of_job} of the job; leave one of them out"
    ))
}

/// Forces of the cut are those of a tool that stands upright in the part.
pub(crate) fn refuse_leaning_tool(template: &Template) -> Answer<()> {
    let turn = template.tool_orientation.unwrap_or_default();
    let leans = (turn * up(template)).angle(&Vector3::z());
    match leans.to_degrees() < 0.1 {
        true => Ok(()),
        false => Err(Failure::input(format!(
            "the tool leans by {} deg from z of the part, and forces that are computed from the cut or measured are those of a tool along z: correct tool_orientation, or state the force under [load]",
            short(leans.to_degrees())
        ))),
    }
}
