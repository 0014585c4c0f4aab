//! The machine of a run: model, deviations, tool, placement and load, from a job file and options.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use kinetostat::Mechanism;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{
    Bounds, FileRead, Placement, ProgramLoad, RunInputs, ToolGiven, TouchOff, Warning,
    WeightCorrection,
};
use kinetostat_model::Model;
use kinetostat_program::{RotaryAxes, WriteOptions};

use crate::files::hash::{FNV1A, fnv1a};
use crate::files::input_files::InputFiles;
use crate::files::origin;
use crate::job::arguments::ProgramArgs;
use crate::job::cell::Cell;
use crate::job::cut::{CutSetup, FilesOfCut, MeasuredSetup, cut_setup, measured_setup};
use crate::job::format::WeightWord;
use crate::job::job_file::{JobFile, model_named};
use crate::job::load::load;
use crate::job::part_stated::part_stated;
use crate::job::placement::{placement, placement_description};
use crate::job::robot::frames::RobotFrames;
use crate::job::robot::machine::{
    placement_of_robot, tool_of_robot, tools_of_converted, tools_of_robot,
};
use crate::job::rotary::rotary;
use crate::job::tool_mass::{StatedMass, ToolMass, carrying};
use crate::job::tools::{numbered_tools, tool};
use crate::machine::model_warnings::deviation_descriptions;
use crate::machine::stiffness_list;
use crate::place::orientation;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::short;

/// The machine with its tool, where the program lies, and what acts.
pub(crate) struct MachineSetup {
    pub(crate) mechanism: Mechanism,
    pub(crate) placement: Placement,
    pub(crate) load: ProgramLoad,
    pub(crate) weight: WeightCorrection,
    /// Mass at the flange by tool numbers; `None` for a single tool without a number.
    pub(crate) tool_masses: Vec<(Option<u32>, ToolMass)>,
    /// The cuts that the load is computed from, where the job names a material.
    pub(crate) cut: Option<CutSetup>,
    /// Forces that were measured, where the job has them.
    pub(crate) measured: Option<MeasuredSetup>,
    /// Tools by number, each with its machine and load.
    pub(crate) tools: Vec<(u32, Mechanism, ProgramLoad)>,
    /// Rotary axes of the model, for programs in G-code.
    pub(crate) rotary: Option<Arc<RotaryAxes>>,
    pub(crate) run_inputs: RunInputs,
    /// Ratings, tool and workspace; limits are those of the run.
    pub(crate) bounds: Bounds,
    /// Tolerance of a program that states none, mm, and where it comes from.
    pub(crate) usual_tolerance: (f64, String),
    /// Hash of the model's text and deviations.
    pub(crate) fingerprint: u64,
    /// True if the flange's z axis points away from it.
    pub(crate) is_arm: bool,
    /// Masses that a template states and the job does not, where weights act.
    pub(crate) not_carried: Option<Warning>,
}

/// A model as it was read.
struct ReadModel {
    model: Model,
    /// Absent for a preset.
    path: Option<PathBuf>,
    file: FileRead,
    /// File, or the name of a preset.
    source: String,
}

/// The model that an option or the job names.
fn read_model(
    files: &InputFiles,
    job: Option<&JobFile>,
    flag_model: Option<&str>,
) -> Answer<ReadModel> {
    let (named, base) = model_named(job, flag_model)?;
    let (model, path) = files.model(&named, &base)?;
    let file = match &path {
        Some(path) => origin::file("model", path, &files.bytes("model", path)?),
        None => origin::file(
            "model",
            Path::new(&format!("preset {named}")),
            model.text.as_bytes(),
        ),
    };
    let source = match &path {
        Some(_) => named,
        None => format!("preset {named}"),
    };
    Ok(ReadModel {
        model,
        path,
        file,
        source,
    })
}

/// The machine, its tool, the placement and the load.
pub(crate) fn machine_setup(
    files: &InputFiles,
    job: Option<&JobFile>,
    flag_model: Option<&str>,
    flags: &ProgramArgs,
    frames: Option<&RobotFrames>,
    inputs: &mut Vec<PathBuf>,
) -> Answer<(MachineSetup, Model)> {
    let named = read_model(files, job, flag_model)?;
    inputs.extend(named.path);
    named.model.require_stiffness()?;
    let (mut tool, mut tool_words) = tool(job, flags)?;
    // A program that states how its tool stands brings tool and work object with it; one that was converted has them of the cell.
    let is_own = |frames: &RobotFrames| frames.states_orientation && !frames.converted;
    let cell = match frames.is_some_and(is_own) {
        true => None,
        false => Cell::of(files, job, flags)?,
    };
    let of_cell = cell
        .as_ref()
        .map(|cell| cell.tool(&tool))
        .transpose()?
        .flatten();
    let tool_is_of_cell = of_cell.is_some();
    (tool, tool_words) = of_cell.unwrap_or((tool, tool_words));
    if let Some(frames) = frames {
        (tool, tool_words) = tool_of_robot(frames, job, flags, tool, tool_words)?;
    }
    let mass = job.map(|j| {
        let table = &j.job.tool;
        let stated = StatedMass {
            mass: table.mass_kg.as_ref(),
            centre: table.centre_of_mass_mm.as_ref(),
            inertia: table.inertia_kg_m2.as_ref(),
        };
        stated.read(j, &named.model, &tool)
    });
    let mass = mass.transpose()?.flatten();
    if let Some(cell) = &cell {
        cell.same_mass(mass.map(|mass| mass.mass_kg))?;
    }
    let mut tool_masses: Vec<_> = mass.map(|mass| (None, mass)).into_iter().collect();
    let bare = with_deviations(named.model, job)?;
    let mut model = bare.clone();
    if let Some(mass) = mass {
        model = carrying(&bare, mass)?;
        tool_words.push_str(&format!(", {} kg", short(mass.mass_kg)));
    }
    let fingerprint = fingerprint(&model);
    let mechanism = model.mechanism.with_tool(&tool);
    let mut placement = placement(job, flags, &mechanism)?;
    if let Some(cell) = &cell {
        cell.place(&mut placement)?;
    }
    if let Some(frames) = frames {
        placement = placement_of_robot(frames, job, flags, placement)?;
    }
    let load = load(job, job.map(|j| &j.job.load), flags)?;
    let weight = weight(job, flags)?;
    if frames.is_some_and(|f| f.axis_is_open && f.states_orientation) && load.turns() {
        return Err(ErrorCode::Missing.failure("this load turns with feed and tool, and the program does not say along which axis of its frame the tool lies: at KUKA that is x in some cells and z in others. State it, from the tip to the holder: --tool-axis -x or -z, or tool_axis under [robot]",
        ));
    }
    let measured = measured_setup(files, job, flags, &placement)?;
    let cut = cut_setup(files, job, flags, &placement)?;
    let of_cut = cut.iter().map(|cut| &cut.files);
    let read: Vec<&FilesOfCut> = of_cut
        .chain(measured.iter().map(|measured| &measured.files))
        .collect();
    inputs.extend(read.iter().flat_map(|files| files.paths.clone()));
    let files_of_cut: Vec<FileRead> = read.iter().flat_map(|files| files.read.clone()).collect();
    let mut given = vec![ToolGiven {
        number: None,
        pose: tool,
        stated: frames.is_some_and(|frames| frames.tools.iter().any(|(_, _, pose)| pose.is_some()))
            || flags.tool_length_mm.is_some()
            || tool_is_of_cell
            || job.is_some_and(|j| j.job.tool.length_mm.is_some() || j.job.tool.pose.is_some()),
    }];
    let mut tools = numbered_tools(
        job,
        flags,
        &bare,
        &model.mechanism,
        &mut tool_words,
        &mut given,
        &mut tool_masses,
    )?;
    if let Some(cell) = &cell {
        cell.add_tools(
            &mut tools,
            &model.mechanism,
            load,
            &mut tool_words,
            &mut given,
        )?;
    }
    if let Some(frames) = frames.filter(|frames| frames.converted && !tools.is_empty()) {
        tools = tools_of_converted(frames, &model.mechanism, load, &tools, &mut given)?;
    }
    if let Some(frames) = frames.filter(|frames| tools.is_empty() && frames.states_orientation) {
        let words = &mut tool_words;
        tools = tools_of_robot(frames, &model.mechanism, load, words, &mut given)?;
    }
    let run_inputs = {
        let mut run_inputs = RunInputs::default();
        run_inputs.model = model.name().to_owned();
        run_inputs.model_source = named.source;
        run_inputs.model_deviations = deviation_descriptions(&model);
        (run_inputs.part_number, run_inputs.revision) = part_stated(job, flags)?;
        run_inputs.placement = placement_description(&placement);
        run_inputs.tool = tool_words;
        run_inputs.cut = cut.iter().flat_map(|cut| cut.words.clone()).collect();
        let log = measured.iter().map(|measured| measured.words());
        run_inputs.cut.extend(log);
        let own = frames.and_then(|frames| frames.own_angles?.standing());
        run_inputs.tool_orientation =
            own.unwrap_or_else(|| orientation::description(&placement.tool_orientation));
        run_inputs.stiffnesses = stiffness_list::stiffnesses(&model);
        run_inputs.files = vec![named.file];
        run_inputs.files.extend(files_of_cut);
        run_inputs
    };
    Ok((
        MachineSetup {
            rotary: rotary(&model, &placement),
            mechanism,
            placement,
            load,
            weight,
            not_carried: cell.and_then(|cell| {
                let weighs = model.mechanism.gravity().norm() > 0.0;
                cell.not_carried(&tool_masses).filter(|_| weighs)
            }),
            tool_masses,
            cut,
            measured,
            tools,
            run_inputs,
            bounds: Bounds {
                ratings: model.ratings(),
                tools: given,
                workspace: model.workspace(),
                is_unplaced: flags.part_origin_mm.is_none()
                    && job.is_none_or(|j| j.job.placement.part_origin_mm.is_none())
                    && frames.is_none_or(|f| f.converted || !f.states_orientation),
                ..Bounds::default()
            },
            usual_tolerance: usual_tolerance(&model),
            fingerprint,
            is_arm: model.is_arm(),
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

/// A number that changes with every character of the model and with its deviations (FNV-1a): it
/// tells in a program's header which model it was made for.
fn fingerprint(model: &Model) -> u64 {
    let text = model.to_toml().unwrap_or_else(|_| model.text.clone());
    fnv1a(FNV1A, text.as_bytes())
}

/// Reads it; not stated where neither job nor options say anything.
fn weight(job: Option<&JobFile>, flags: &ProgramArgs) -> Answer<WeightCorrection> {
    if let Some(j) = job {
        of_tools(j)?;
    }
    let table = job.map(|j| &j.job.load);
    let in_job = table.and_then(|table| table.weight.as_ref());
    let places_in_job = table.and_then(|table| table.touch_off_mm.as_ref());
    let word = flags.weight.or(in_job.map(|word| *word.get_ref()));
    let help = "give one place, or three and more that are not on one line: touch_off_mm = [[X, Y, Z]] under [load], or --touch-off X Y Z";
    let touch_off = |places: Vec<[f64; 3]>| {
        TouchOff::at(places).map_err(|error| match (job, places_in_job, &flags.touch_off) {
            (Some(j), Some(at), None) => j.error(at, &error.to_string(), help),
            _ => ErrorCode::ProgramUnsuited.failure(format!("{error}; {help}")),
        })
    };
    let places = match (&flags.touch_off, places_in_job) {
        (Some(all), _) => {
            let all = all.chunks_exact(3);
            Some(all.map(|p| [p[0], p[1], p[2]]).collect())
        }
        (None, places) => places.map(|places| places.get_ref().clone()),
    };
    // A word on the command line goes over the places of the job.
    let goes_over = flags.weight.is_some() && flags.touch_off.is_none();
    match word {
        Some(WeightWord::TouchOff) => {
            let touched = touch_off(places.unwrap_or_default())?;
            Ok(WeightCorrection::TouchOff(touched))
        }
        _ if places.is_some() && !goes_over => Err(ErrorCode::Conflict.failure("places where the part was touched off are given (touch_off_mm under [load], --touch-off), and weight is not \"touch-off\"; write weight = \"touch-off\" under [load] or --weight touch-off, or leave the places out",
        )),
        Some(WeightWord::All) => Ok(WeightCorrection::All),
        Some(WeightWord::None) => Ok(WeightCorrection::None),
        None => Ok(WeightCorrection::NotStated),
    }
}

/// The frame is that of the whole program.
fn of_tools(j: &JobFile) -> Answer<()> {
    let tools = j
        .job
        .tools
        .iter()
        .filter_map(|tool| tool.get_ref().load.as_ref());
    for table in tools {
        if let Some(at) = &table.weight {
            return Err(j.error(
                at,
                "the weight is stated for one tool, and the part frame is measured once for all",
                "write it under [load] at the top of the job",
            ));
        }
    }
    Ok(())
}
