//! Template and job in one: part, tools and orientation of the tool.

use kinetostat::Pose;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{StatedTool, Template};
use nalgebra::{Isometry3, Vector3};

use crate::job::job_file::JobFile;
use crate::job::machine::MachineSetup;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::short;

/// Direction from the tip to the holder, axes of the tool: its z lies along the spindle, and up in the part is the holder.
pub(crate) fn up(template: &Template) -> Vector3<f64> {
    let turned = template.tool_orientation.unwrap_or_default() * Vector3::z();
    match turned.z >= 0.0 {
        true => Vector3::z(),
        false => -Vector3::z(),
    }
}

/// Fills in what a template leaves open with part, tools and orientation of the machine's job, which agree with it.
pub(crate) fn complete(template: &mut Template, job: Option<&JobFile>, machine: &MachineSetup) {
    let placement = &machine.placement;
    let base = template.base.pose;
    let base = base.unwrap_or_else(|| in_mm(&placement.base_from_part));
    template.base.pose = Some(base);
    if job.is_some_and(|j| !j.job.tools.is_empty()) {
        for given in &machine.bounds.tools {
            let Some(number) = given.number else { continue };
            let tool = template.tools.entry(number).or_default();
            take_mass(tool, machine, Some(number));
            let frame = &mut tool.frame;
            frame.pose.get_or_insert(in_mm(&given.pose));
            if frame.number.is_none() && frame.name.is_none() {
                frame.number = Some(number);
            }
        }
    }
    if template.tools.is_empty() {
        let given = machine.bounds.tools.first();
        let of_job = given.map_or_else(Pose::identity, |given| given.pose);
        template.tool.frame.pose.get_or_insert(in_mm(&of_job));
        take_mass(&mut template.tool, machine, None);
    }
    let in_part = base.rotation.inverse() * placement.tool_orientation;
    template.tool_orientation.get_or_insert(in_part);
}

/// The mass that the job states of a tool, where the template states none.
fn take_mass(tool: &mut StatedTool, machine: &MachineSetup, number: Option<u32>) {
    let mut masses = machine.tool_masses.iter();
    if let (None, Some((_, own))) = (tool.mass_kg, masses.find(|(of, _)| *of == number)) {
        tool.mass_kg = Some(own.mass_kg);
        tool.centre_of_mass_mm = Some(own.centre_mm);
    }
}

fn in_mm(pose: &Pose) -> Isometry3<f64> {
    Isometry3::from_parts((1e3 * pose.translation.vector).into(), pose.rotation)
}

/// Forces of the cut are those of a tool that stands upright in the part.
pub(crate) fn refuse_leaning_tool(template: &Template) -> Answer<()> {
    let turn = template.tool_orientation.unwrap_or_default();
    let leans = (turn * up(template)).angle(&Vector3::z());
    match leans.to_degrees() < 0.1 {
        true => Ok(()),
        false => Err(ErrorCode::ProgramUnsuited.failure(format!(
                "the tool leans by {} deg from z of the part, and forces that are computed from the cut or measured are those of a tool along z: correct tool_orientation, or state the force under [load]",
                short(leans.to_degrees())
            ),
        )),
    }
}
