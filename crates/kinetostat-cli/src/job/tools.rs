//! The tool of a run, or its tools by number.

use kinetostat::{Mechanism, Pose};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{ProgramLoad, ToolGiven, straight_tool};
use kinetostat_model::Model;
use serde_spanned::Spanned;

use crate::job::arguments::ProgramArgs;
use crate::job::job_file::JobFile;
use crate::job::load::load;
use crate::job::tool_mass::{StatedMass, ToolMass, carrying};
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::{short, triple};

/// The tools of `[[tools]]` with their numbers and loads; none where the job file has no such table. Where it has one,
/// `words` and `given` become those of its tools, and what they weigh is added to `masses`. `bare` has no tool, `mechanism` what
/// the flange carries where a tool states nothing else.
pub(crate) fn numbered_tools(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    bare: &Model,
    mechanism: &Mechanism,
    words: &mut String,
    given: &mut Vec<ToolGiven>,
    masses: &mut Vec<(Option<u32>, ToolMass)>,
) -> Answer<Vec<(u32, Mechanism, ProgramLoad)>> {
    let mut tools: Vec<(u32, Mechanism, ProgramLoad)> = Vec::new();
    let Some(j) = job.filter(|j| !j.job.tools.is_empty()) else {
        return Ok(tools);
    };
    if flags.tool_length_mm.is_some() {
        return Err(ErrorCode::Conflict.failure("--tool-length-mm gives one length, but the job file has several tools under [[tools]]; change the length there, or leave the option out",
        ));
    }
    let mut all = Vec::new();
    given.clear();
    for entry in &j.job.tools {
        let tool = entry.get_ref();
        if tools.iter().any(|(number, ..)| *number == tool.number) {
            return Err(j.error(
                entry,
                &format!("tool {} is given twice", tool.number),
                "give each number once",
            ));
        }
        if tool.length_mm.is_none() && tool.pose.is_none() {
            return Err(j.error(
                entry,
                &format!("tool {} has no length", tool.number),
                "write length_mm = ..., or pose = { position_mm = [...], ... }",
            ));
        }
        let (pose, text) = tool_of(j, tool.length_mm.as_ref(), tool.pose.as_ref())?;
        let load = load(job, Some(tool.load.as_ref().unwrap_or(&j.job.load)), flags)?;
        let stated = StatedMass {
            mass: tool.mass_kg.as_ref(),
            centre: tool.centre_of_mass_mm.as_ref(),
            inertia: tool.inertia_kg_m2.as_ref(),
        };
        let own = stated.read(j, bare, &pose)?;
        let mass = own.or(masses.first().filter(|m| m.0.is_none()).map(|m| m.1));
        let kg = mass.map_or_else(String::new, |m| format!(", {} kg", short(m.mass_kg)));
        all.push(format!("tool {}: {text}{kg}", tool.number));
        masses.extend(mass.map(|mass| (Some(tool.number), mass)));
        given.push(ToolGiven {
            number: Some(tool.number),
            pose,
            stated: true,
        });
        let mechanism = match own {
            Some(own) => carrying(bare, own)?.mechanism.with_tool(&pose),
            None => mechanism.with_tool(&pose),
        };
        tools.push((tool.number, mechanism, load));
    }
    *words = all.join("; ");
    Ok(tools)
}

fn straight(length_mm: f64) -> Answer<(Pose, String)> {
    if !length_mm.is_finite() || length_mm.abs() > 1e5 {
        return Err(ErrorCode::Value.failure(format!(
            "the tool's length is {length_mm} mm; tools are shorter than 100 m"
        )));
    }
    let words = if length_mm == 0.0 {
        "none: the platform's own point".to_owned()
    } else {
        format!("{} mm along z of the flange", short(length_mm))
    };
    Ok((straight_tool(1e-3 * length_mm), words))
}

pub(crate) fn tool(job: Option<&JobFile>, flags: &ProgramArgs) -> Answer<(Pose, String)> {
    if let Some(length) = flags.tool_length_mm {
        return straight(length);
    }
    match job {
        Some(j) => tool_of(j, j.job.tool.length_mm.as_ref(), j.job.tool.pose.as_ref()),
        None => straight(0.0),
    }
}

/// The place of a tool's tip in words.
pub(crate) fn tip_words(pose: &Pose) -> String {
    let tip = pose.translation.vector * 1e3;
    format!("tip at {} mm in the flange", triple(tip.into(), short))
}

fn tool_of(
    j: &JobFile,
    length: Option<&Spanned<f64>>,
    pose: Option<&Spanned<kinetostat_model::schema::Placement>>,
) -> Answer<(Pose, String)> {
    match (length, pose) {
        (Some(_), Some(pose)) => Err(j.error(
            pose,
            "the tool is given twice: 'length_mm' and 'pose'",
            "keep one of them",
        )),
        (Some(length), None) => straight(*length.get_ref()),
        (None, Some(table)) => {
            let pose = table
                .get_ref()
                .pose()
                .map_err(|(message, help)| j.error(table, &message, &help))?;
            Ok((pose, tip_words(&pose)))
        }
        (None, None) => straight(0.0),
    }
}
