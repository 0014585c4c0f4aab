//! The machine of a run: model, deviations, tool, placement and load, from a job file and options.

use std::path::{Path, PathBuf};

use kinetostat::{Mechanism, Pose, Wrench};
use kinetostat_machining::number::without_zeros;
use kinetostat_machining::{
    Bounds, CornerLoad, CuttingLoad, LoadAxes, Placement, ProgramLoad, Question, ToolGiven,
    Warning, WarningCode, straight_tool,
};
use kinetostat_model::Model;
use kinetostat_program::WriteOptions;
use nalgebra::{UnitQuaternion, Vector3};
use serde_spanned::Spanned;

use crate::command_line::ProgramArgs;
use crate::files::input::Files;
use crate::files::journal::{FNV1A, fnv1a};
use crate::files::origin;
use crate::job::format::{Axes, CornerWord, LoadTable, OrientationWord};
use crate::job::setting::{JobFile, chosen, finite, scale_of_program, vector};
use crate::place::orientation;
use crate::ui::failure::{Answer, Failure};
use crate::ui::screen::{fixed, triple};

/// The machine with its tool, where the program lies, and what acts.
pub(crate) struct Machine {
    pub(crate) mechanism: Mechanism,
    pub(crate) placement: Placement,
    pub(crate) load: ProgramLoad,
    /// Tools by number, each with its machine and load.
    pub(crate) tools: Vec<(u32, Mechanism, ProgramLoad)>,
    pub(crate) question: Question,
    /// Ratings, tool and workspace; limits are those of the run.
    pub(crate) bounds: Bounds,
    /// Tolerance of a program that states none, mm, and where it comes from.
    pub(crate) usual_tolerance: (f64, String),
    /// Of the model's text and deviations.
    pub(crate) fingerprint: u64,
}

/// The machine, its tool, the placement and the load.
pub(crate) fn machine(
    files: &Files,
    job: Option<&JobFile>,
    flag_model: Option<&str>,
    flags: &ProgramArgs,
    inputs: &mut Vec<PathBuf>,
) -> Answer<(Machine, Model)> {
    let table = job.and_then(|j| j.job.model.as_ref());
    let (named, base) = match (flag_model, table) {
        (Some(named), _) => (named.to_owned(), PathBuf::new()),
        (None, Some(named)) => (
            named.get_ref().clone(),
            job.map(JobFile::base).unwrap_or_default(),
        ),
        (None, None) => {
            return Err(Failure::input(match job {
                Some(j) => format!(
                    "the job file '{}' names no model; write  model = \"orthoglide\"  at its top, or give --model MODEL",
                    j.path.display()
                ),
                None => "no model is named; give a job file, or --model MODEL (a preset or a file); the presets are listed by `kinetostat model list`".to_owned(),
            }));
        }
    };
    let (model, path) = files.model(&named, &base)?;
    inputs.extend(path.clone());
    let model_file = match &path {
        Some(path) => origin::file("model", path, &files.bytes("model", path)?),
        None => origin::file(
            "model",
            Path::new(&format!("preset {named}")),
            model.text.as_bytes(),
        ),
    };
    let model = with_deviations(model, job)?;
    let fingerprint = fingerprint(&model);
    let (tool, mut tool_words) = tool(job, flags)?;
    let mechanism = model.mechanism.with_tool(&tool);
    let placement = placement(job, flags, &mechanism)?;
    let load = load(job, job.map(|j| &j.job.load), flags)?;
    let mut given = vec![ToolGiven {
        number: None,
        pose: tool,
        stated: flags.tool_length_mm.is_some()
            || job.is_some_and(|j| j.job.tool.length_mm.is_some() || j.job.tool.pose.is_some()),
    }];
    let tools = numbered_tools(job, flags, &model.mechanism, &mut tool_words, &mut given)?;
    let source = match &path {
        Some(_) => named,
        None => format!("preset {named}"),
    };
    let question = Question {
        model: model.name().to_owned(),
        model_source: source,
        model_deviations: deviations_in_words(&model),
        placement: placement_in_words(&placement),
        tool: tool_words,
        tool_orientation: orientation::in_words(&placement.tool_orientation),
        stiffnesses: origin::stiffnesses(&model),
        files: vec![model_file],
        ..Question::default()
    };
    Ok((
        Machine {
            mechanism,
            placement,
            load,
            tools,
            question,
            bounds: Bounds {
                ratings: model.ratings(),
                tools: given,
                workspace: model.workspace(),
                ..Bounds::default()
            },
            usual_tolerance: usual_tolerance(&model),
            fingerprint,
        },
        model,
    ))
}

/// A program need not be better than its machine repeats: a third of that. Arms repeat within about
/// 0.06 mm.
fn usual_tolerance(model: &Model) -> (f64, String) {
    match model.document.mechanism.repeatability_mm {
        Some(mm) => (
            mm / 3.0,
            format!("a third of the machine's repeatability, {} mm", short(mm)),
        ),
        None if model.is_arm() => (
            0.02,
            "usual for an arm; the model states no repeatability".to_owned(),
        ),
        None => (
            WriteOptions::default().tolerance_mm,
            "the smallest in use; the model states no repeatability".to_owned(),
        ),
    }
}

/// A run that has no answer, with what smells in its model: that is most likely why.
pub(crate) fn with_smells(failure: Failure, model: &Model) -> Failure {
    let mut smells = of_model(model);
    match smells.next() {
        Some(first) => {
            let more = match smells.count() {
                0 => String::new(),
                _ => "; `kinetostat check` says what else looks wrong".to_owned(),
            };
            failure.with_reason(&format!("{first}{more}"))
        }
        None => failure,
    }
}

/// What looks wrong in a model, for the list of a run.
pub(crate) fn of_model(model: &Model) -> impl Iterator<Item = Warning> + '_ {
    model.warnings.iter().map(|problem| Warning {
        line: problem.line,
        ..Warning::new(
            WarningCode::Model,
            match problem.help.as_str() {
                "" => problem.message.clone(),
                help => format!("{}; {help}", problem.message),
            },
        )
        .of_file(problem.file.clone())
    })
}

/// What is judged, and what is not, under loads on limbs that have no potential: for answers that do not say it of
/// every place.
pub(crate) fn no_potential(mechanism: &Mechanism) -> Option<Warning> {
    let limbs = mechanism.limbs().iter().enumerate();
    let names: Vec<String> = limbs
        .filter(|(i, _)| !mechanism.loads_conservative(*i))
        .map(|(_, limb)| format!("'{}'", limb.name))
        .collect();
    (!names.is_empty()).then(|| {
        Warning::new(
            WarningCode::NoPotential,
            format!(
                "loads on limb {} follow the machine and have no potential: 'stable' means that nothing goes away; whether it swings with growing amplitude (flutter) depends on the masses, which are not asked for here",
                names.join(", ")
            ),
        )
    })
}

fn with_deviations(model: Model, job: Option<&JobFile>) -> Answer<Model> {
    let Some(j) = job.filter(|j| !j.job.deviation.is_empty()) else {
        return Ok(model);
    };
    let mut model = model;
    for deviation in &j.job.deviation {
        model = model
            .deviating(deviation.get_ref().clone())
            .map_err(|error| {
                let (message, help) = error.problems().first().map_or_else(
                    || (error.to_string(), String::new()),
                    |p| (p.message.clone(), p.help.clone()),
                );
                j.error(deviation, &message, &help)
            })?;
    }
    Ok(model)
}

/// The deviations of a model, one sentence each.
pub(crate) fn deviations_in_words(model: &Model) -> Vec<String> {
    let list = model.document.deviation.iter();
    list.map(kinetostat_model::schema::Deviation::in_words)
        .collect()
}

/// A number as short as it can be at four decimals.
pub(crate) fn short(value: f64) -> String {
    without_zeros(&fixed(value, 4)).to_owned()
}

/// The tools of `[[tools]]`, and all tools in words.
fn numbered_tools(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    mechanism: &Mechanism,
    words: &mut String,
    given: &mut Vec<ToolGiven>,
) -> Answer<Vec<(u32, Mechanism, ProgramLoad)>> {
    let mut tools: Vec<(u32, Mechanism, ProgramLoad)> = Vec::new();
    let Some(j) = job.filter(|j| !j.job.tools.is_empty()) else {
        return Ok(tools);
    };
    if flags.tool_length_mm.is_some() {
        return Err(Failure::input(
            "--tool-length-mm gives one length, but the job file has several tools under [[tools]]; change the length there, or leave the option out",
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
        all.push(format!("tool {}: {text}", tool.number));
        given.push(ToolGiven {
            number: Some(tool.number),
            pose,
            stated: true,
        });
        tools.push((tool.number, mechanism.with_tool(&pose), load));
    }
    *words = all.join("; ");
    Ok(tools)
}

fn straight(length_mm: f64) -> Answer<(Pose, String)> {
    if !length_mm.is_finite() || length_mm.abs() > 1e5 {
        return Err(Failure::input(format!(
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

fn tool(job: Option<&JobFile>, flags: &ProgramArgs) -> Answer<(Pose, String)> {
    if let Some(length) = flags.tool_length_mm {
        return straight(length);
    }
    match job {
        Some(j) => tool_of(j, j.job.tool.length_mm.as_ref(), j.job.tool.pose.as_ref()),
        None => straight(0.0),
    }
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
            let tip = pose.translation.vector * 1e3;
            Ok((
                pose,
                format!("tip at {} mm in the flange", triple(tip.into(), short)),
            ))
        }
        (None, None) => straight(0.0),
    }
}

fn placement(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    mechanism: &Mechanism,
) -> Answer<Placement> {
    let table = job.map(|j| j.job.placement.clone()).unwrap_or_default();
    let origin = match (&flags.part_origin_mm, table.part_origin_mm) {
        (Some(v), _) => vector("--part-origin-mm", v)?,
        (None, Some(v)) => v.into(),
        _ => Vector3::zeros(),
    };
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
        // Unless it was asked for, no machine is held to what it cannot do.
        (None, None) => in_job.is_none() && mechanism.turns_as_it_moves(),
    };
    let tool = flag.flatten().or(in_job).unwrap_or(home);
    let scale = chosen(
        job,
        ("--scale", flags.scale),
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

fn placement_in_words(placement: &Placement) -> String {
    let origin = placement.base_from_part.translation.vector * 1e3;
    let mut text = format!(
        "program zero at {} mm in the base, axes {}; tool {}",
        triple(origin.into(), short),
        orientation::in_words(&placement.base_from_part.rotation),
        match placement.orientation_follows {
            true => format!(
                "as near as it can be to the orientation {} (the orientation follows)",
                orientation::in_words(&placement.tool_orientation)
            ),
            false => orientation::in_words(&placement.tool_orientation),
        },
    );
    if placement.scale != 1.0 {
        text.push_str(&format!("; scaled by {}", placement.scale));
    }
    text
}

fn load(
    job: Option<&JobFile>,
    table: Option<&LoadTable>,
    flags: &ProgramArgs,
) -> Answer<ProgramLoad> {
    let table = table.cloned().unwrap_or_default();
    if let (Some(j), Some(milling)) = (job, &table.milling)
        && (table.force_n.is_some() || table.moment_n_m.is_some() || table.axes.is_some())
    {
        return Err(j.error(
            milling,
            "the load is given twice: 'milling' and 'force_n', 'moment_n_m' or 'axes'",
            "keep one of them",
        ));
    }
    let constant =
        |force: Vector3<f64>, moment: Vector3<f64>, axes: Option<Axes>| CuttingLoad::Constant {
            axes: match axes.unwrap_or(Axes::Base) {
                Axes::Base => LoadAxes::Base,
                Axes::Tool => LoadAxes::Tool,
                Axes::Feed => LoadAxes::Feed,
            },
            wrench: Wrench::new(force, moment),
        };
    let cutting = if let Some(v) = &flags.milling {
        let v = vector("--milling", v)?;
        CuttingLoad::Milling {
            radial: v.x,
            tangential: v.y,
            axial: v.z,
        }
    } else if flags.force.is_some() || flags.moment.is_some() {
        // A force on the command line goes over a milling force of the job.
        let part = |name: &str, flag: &Option<Vec<f64>>, written: Option<[f64; 3]>| match flag {
            Some(v) => vector(name, v),
            None => Ok(written.map_or_else(Vector3::zeros, Into::into)),
        };
        constant(
            part("--force", &flags.force, table.force_n)?,
            part("--moment", &flags.moment, table.moment_n_m)?,
            flags.load_axes.or(table.axes),
        )
    } else if let Some(m) = &table.milling {
        let m = m.get_ref();
        CuttingLoad::Milling {
            radial: m.radial_n,
            tangential: m.tangential_n,
            axial: m.axial_n,
        }
    } else if table.force_n.is_some() || table.moment_n_m.is_some() {
        constant(
            table.force_n.unwrap_or_default().into(),
            table.moment_n_m.unwrap_or_default().into(),
            flags.load_axes.or(table.axes),
        )
    } else {
        CuttingLoad::None
    };
    let mut load = ProgramLoad::new(cutting);
    load.at_corners = match flags.load_at_corners.or(table.at_corners) {
        Some(CornerWord::FollowsFeed) => CornerLoad::FollowsFeed,
        Some(CornerWord::Turns) | None => CornerLoad::Turns,
    };
    load.below_z_mm = flags.below_z_mm.or(table.below_z_mm);
    if let Some(z) = load.below_z_mm {
        finite("the height below which the load acts", &[z])?;
    }
    if let (Some(j), Some(angle)) = (job, &table.gentle_corner_deg) {
        if !(0.0..=180.0).contains(angle.get_ref()) {
            return Err(j.error(
                angle,
                "a corner turns by 0 to 180 degrees",
                "correct the angle",
            ));
        }
        load.gentle_corner = angle.get_ref().to_radians();
    }
    if let (Some(j), Some(length)) = (job, &table.turning_length_mm) {
        if *length.get_ref() <= 0.0 {
            return Err(j.error(
                length,
                "a length above zero is needed",
                "write some millimetres",
            ));
        }
        load.turning_length_mm = *length.get_ref();
    }
    Ok(load)
}

/// A number that changes with every character of the model and with its deviations (FNV-1a): it
/// tells in a program's header which model it was made for.
fn fingerprint(model: &Model) -> u64 {
    let text = model.to_toml().unwrap_or_else(|_| model.text.clone());
    fnv1a(FNV1A, text.as_bytes())
}
