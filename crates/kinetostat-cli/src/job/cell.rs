//! The cell that a template states: place of the part, tools, and how the tool stands in the part.
//!
//! Every command along a program reads it in the same way: what the template states is that of the job, and where both
//! state it they must agree.

use kinetostat::{Mechanism, Pose};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::Template;
use kinetostat_machining::{Placement, ProgramLoad, ToolGiven, Warning, WarningCode};

use crate::files::input_files::InputFiles;
use crate::job::arguments::ProgramArgs;
use crate::job::job_file::JobFile;
use crate::job::robot::frames::in_metres;
use crate::job::template_file::TemplateFile;
use crate::job::tool_mass::ToolMass;
use crate::job::tools::tip_words;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::numbers::short;

/// Differences below this are those of digits, m and rad.
const SAME: f64 = 1e-6;

/// The cell of a template, beside what the job states itself.
pub(crate) struct Cell {
    template: Template,
    part_is_stated: bool,
    tool_is_stated: bool,
    orientation_is_stated: bool,
}

impl Cell {
    /// The cell of the template that an option or `[robot]` of the job names.
    pub(crate) fn of(
        files: &InputFiles,
        job: Option<&JobFile>,
        flags: &ProgramArgs,
    ) -> Answer<Option<Self>> {
        let Some(path) = TemplateFile::path(job, flags.robot.template.as_deref()) else {
            return Ok(None);
        };
        let table = job.map(|j| &j.job);
        let placement = table.map(|job| &job.placement);
        Ok(Some(Self {
            template: TemplateFile::of_file(files, &path)?.template,
            part_is_stated: flags.part_origin_mm.is_some()
                || flags.part_orientation.is_some()
                || placement
                    .is_some_and(|p| p.part_origin_mm.is_some() || p.part_orientation.is_some()),
            tool_is_stated: flags.tool_length_mm.is_some()
                || table.is_some_and(|job| job.tool.length_mm.is_some() || job.tool.pose.is_some()),
            orientation_is_stated: flags.tool_orientation.is_some()
                || placement.is_some_and(|p| p.tool_orientation.is_some()),
        }))
    }

    /// The tool in the flange with words for it, where the template states one.
    pub(crate) fn tool(&self, of_job: &Pose) -> Answer<Option<(Pose, String)>> {
        let Some(own) = self.template.tool.frame.pose.as_ref().map(in_metres) else {
            return Ok(None);
        };
        match self.tool_is_stated && apart(&own, of_job) {
            true => Err(twice("[tool]", "the tool (length_mm, pose)")),
            false => Ok(Some((own, tip_words(&own)))),
        }
    }

    /// Refuses two masses of the tool: one would be the controller's, the other the model's.
    pub(crate) fn same_mass(&self, of_job: Option<f64>) -> Answer<()> {
        match (self.template.tool.mass_kg, of_job) {
            (Some(own), Some(of_job)) if (own - of_job).abs() > SAME * of_job => {
                Err(twice("mass_kg under [tool]", "mass_kg under [tool]"))
            }
            _ => Ok(()),
        }
    }

    /// Masses of tools that only the template states: the controller counts with them, and the model does not carry them.
    pub(crate) fn not_carried(&self, carried: &[(Option<u32>, ToolMass)]) -> Option<Warning> {
        let numbered = self.template.tools.iter().filter(|(number, _)| {
            let is_own = |(of_job, _): &(Option<u32>, ToolMass)| *of_job == Some(**number);
            !carried.iter().any(is_own)
        });
        let only = [("[tool]".to_owned(), self.template.tool.mass_kg)].into_iter();
        let masses = only
            .filter(|_| carried.is_empty())
            .chain(numbered.map(|(number, tool)| (format!("tool {number}"), tool.mass_kg)));
        let stated = masses.filter_map(|(name, mass)| Some(format!("{name}: {} kg", short(mass?))));
        let stated: Vec<String> = stated.collect();
        (!stated.is_empty()).then(|| {
            let text = format!(
                "the template states a mass that the job does not ({}): the controller counts with it, and the model here carries no such weight. Write mass_kg under [tool] of the job, too (numbered ones: under [[tools]])",
                stated.join(", ")
            );
            Warning::new(WarningCode::Model, text)
        })
    }

    /// Puts the part where the template has it, and the tool as it stands there.
    pub(crate) fn place(&self, placement: &mut Placement) -> Answer<()> {
        if let Some(own) = self.template.base.pose.as_ref().map(in_metres) {
            if self.part_is_stated && apart(&own, &placement.base_from_part) {
                return Err(twice(
                    "[base]",
                    "the place of the part (part_origin_mm, part_orientation)",
                ));
            }
            placement.base_from_part = own;
        }
        if let Some(in_part) = self.template.tool_orientation {
            let own = placement.base_from_part.rotation * in_part;
            if self.orientation_is_stated && own.angle_to(&placement.tool_orientation) > SAME {
                return Err(twice("tool_orientation", "tool_orientation"));
            }
            placement.tool_orientation = own;
            placement.orientation_follows = false;
        }
        Ok(())
    }

    /// Adds the numbered tools of the template to those of the job under `[[tools]]`.
    pub(crate) fn add_tools(
        &self,
        tools: &mut Vec<(u32, Mechanism, ProgramLoad)>,
        mechanism: &Mechanism,
        load: ProgramLoad,
        words: &mut String,
        given: &mut Vec<ToolGiven>,
    ) -> Answer<()> {
        for (number, tool) in &self.template.tools {
            let Some(pose) = tool.frame.pose.as_ref().map(in_metres) else {
                continue;
            };
            let of_job = given.iter().find(|given| given.number == Some(*number));
            if let Some(of_job) = of_job {
                if apart(&pose, &of_job.pose) {
                    return Err(twice(
                        &format!("in_program = {number} under [[tools]]"),
                        &format!("number = {number} under [[tools]]"),
                    ));
                }
                continue;
            }
            let described = format!("tool {number}: {}", tip_words(&pose));
            if tools.is_empty() {
                given.clear();
                *words = described;
            } else {
                words.push_str(&format!("; {described}"));
            }
            given.push(ToolGiven {
                number: Some(*number),
                pose,
                stated: true,
            });
            tools.push((*number, mechanism.with_tool(&pose), load));
        }
        Ok(())
    }
}

fn apart(a: &Pose, b: &Pose) -> bool {
    (a.translation.vector - b.translation.vector).norm() > SAME
        || a.rotation.angle_to(&b.rotation) > SAME
}

fn twice(of_template: &str, of_job: &str) -> Failure {
    ErrorCode::Conflict.failure(format!(
            "stated twice, and not the same: {of_template} in the template and {of_job} of the job; leave one of them out"
        ),
    )
}
