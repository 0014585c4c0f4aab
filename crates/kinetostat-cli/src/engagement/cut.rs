//! Tools, material, stock and spindle of the program: from options, and else from the job file.

use kinetostat::Pose;
use kinetostat_cutting::{CutError, Rotation};
use kinetostat_machining::{CutQuestion, Placement};
use nalgebra::UnitQuaternion;

use crate::engagement::arguments::{EngagementArgs, RotationWord};
use crate::engagement::missing::{NO_STOCK, no_factors, nothing_missing};
use crate::engagement::own_cut::{own_cutters, own_engagement, own_material};
use crate::files::input_files::InputFiles;
use crate::force::cut::curve;
use crate::force::refusal::{refused, within};
use crate::job::arguments::ProgramArgs;
use crate::job::cut::cutters::{cutters, extremes};
use crate::job::cut::material::material as material_of_job;
use crate::job::cut::question::{curve as curve_of_job, spindle_speed, where_it_cuts};
use crate::job::cut::refused::refused as refused_in_job;
use crate::job::cut::{CutSetup, FilesOfCut, cut_setup};
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failure};

/// The cut, each part of it from the options, and else from the job.
pub(super) fn cut(
    files: &InputFiles,
    job: Option<&JobFile>,
    args: &EngagementArgs,
    flags: &ProgramArgs,
) -> Answer<CutSetup> {
    if let Some(j) = job.filter(|_| !options_given(args)) {
        no_factors(&args.material)?;
        let of_job = cut_setup(files, job, flags, &as_programmed())?;
        return of_job.ok_or_else(|| {
            Failure::input(format!(
                "the job file '{}' names no material: without it nothing is known of a cut; write [material] name = \"AlMg4.5Mn\" with [stock] (or [engagement]) and the cutter of the tool, or give --material, --block-mm and --tool",
                j.path.display()
            ))
        });
    }
    nothing_missing(job, args)?;
    let mut read = FilesOfCut::default();
    let mut of_tools = Vec::new();
    let cutters = match (args.tool.given(), job) {
        (false, Some(j)) => cutters(files, j, flags, (&mut read, &mut of_tools))?,
        _ => own_cutters(files, &args.tool, (job, flags), &mut read)?,
    };
    let Some((smallest, largest)) = extremes(&cutters) else {
        return Err(Failure::input(
            "no tool: the program calls none of the table (T); give --tool-number for the whole program",
        ));
    };
    let of_job = job.and_then(|j| Some((j, j.job.material.as_ref()?)));
    let material = match (&args.material.material, of_job) {
        (None, Some((j, table))) => {
            no_factors(&args.material)?;
            material_of_job(files, j, table.get_ref(), &mut read)?
        }
        _ => own_material(files, args, (smallest, largest), &mut read)?,
    };
    let mut words = material.words.clone();
    words.append(&mut of_tools);
    let tools = cutters
        .iter()
        .map(|cutter| material.for_tool(cutter, &mut words))
        .collect::<Result<Vec<_>, CutError>>()
        .map_err(|error| match (&args.material.material, of_job) {
            (None, Some((j, table))) => refused_in_job(j, &table.get_ref().name, &error),
            _ => refused(&error),
        })?;
    let (engagement, source_words) = match (own_engagement(&args.stock, (smallest, largest))?, job)
    {
        (Some(own), _) => own,
        (None, Some(j)) => where_it_cuts((files, &mut read), j, (smallest, largest))?
            .ok_or_else(|| Failure::input(NO_STOCK))?,
        (None, None) => return Err(Failure::input(NO_STOCK)),
    };
    words.push(source_words);
    let table = job.and_then(|j| j.job.spindle.as_ref().map(|s| (j, s.get_ref())));
    let rpm = match (args.turning.rpm, table) {
        (Some(rpm), _) => Some(within(
            "speed of the spindle",
            rpm,
            1e-3..=1e6,
            "turns per minute",
        )?),
        (None, Some((j, table))) => spindle_speed(j, table)?,
        (None, None) => None,
    };
    let rotation = args.turning.rotation.map(|word| match word {
        RotationWord::Clockwise => Rotation::Clockwise,
        RotationWord::CounterClockwise => Rotation::CounterClockwise,
    });
    let spindle = match (curve(&args.spindle)?, table) {
        (None, Some((j, table))) => curve_of_job(j, table)?,
        (own, _) => own,
    };
    let choice = table.and_then(|(_, table)| table.force).unwrap_or_default();
    words.push(format!("force that counts: {}", choice.description()));
    Ok(CutSetup {
        material: material.name().to_owned(),
        question: CutQuestion {
            tools,
            engagement,
            choice,
            rpm,
            rotation: rotation.or(table.and_then(|(_, table)| table.rotation)),
            spindle,
        },
        words,
        files: read,
    })
}

/// True if an option describes the cut; a job alone is read as `compensate` reads it.
fn options_given(args: &EngagementArgs) -> bool {
    args.material.material.is_some()
        || args.tool.given()
        || args.stock.block_mm.is_some()
        || args.stock.width_mm.is_some()
        || args.turning.rpm.is_some()
        || args.turning.rotation.is_some()
        || args.spindle.spindle_power_w.is_some()
}

/// The program in its own coordinates, the tool along z: a cut knows no machine.
fn as_programmed() -> Placement {
    Placement {
        base_from_part: Pose::identity(),
        tool_orientation: UnitQuaternion::identity(),
        orientation_follows: false,
        scale: 1.0,
    }
}
