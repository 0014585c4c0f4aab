//! The band of a run's errors over machines that are not exactly as drawn.

use std::sync::Arc;

use kinetostat::Wrench;
use kinetostat_analysis::tolerance::{
    CUTTING_PARTS, CuttingParts, Draws, Source, UncertainRun, UncertaintyFile, band,
};
use kinetostat_cutting::{EdgeForce, Scaled};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{
    CutFailure, CuttingLoad, CuttingTool, ForceOrigin, ProgramLoad, ProgramPlace, Run, Task, Tool,
    Watch, WeightCorrection, wrenches_at,
};
use kinetostat_model::Model;

use crate::job::cut::along::stopped_or_within;
use crate::job::machine::MachineSetup;
use crate::job::setting::Setting;
use crate::job::uncertain::Uncertainty;
use crate::ui::failure::{Answer, Failing};
use crate::ui::progress::Progress;

/// About how many places of a program are solved for every machine.
pub(crate) const PLACES: usize = 100;

/// Parts of the force are varied by this share of them. The mean over a revolution is linear in them.
const VARIED: f64 = 0.05;

/// Reads the uncertainties for a model; the places need it before the run.
pub(crate) fn read(
    uncertainty: &Uncertainty,
    model: &Model,
    machine: &MachineSetup,
) -> Answer<UncertaintyFile> {
    if machine.placement.orientation_follows {
        return Err(ErrorCode::ModelUnsuited.failure("the tool of this machine turns as it moves: the band of the errors (--uncertain, [uncertain] in the job) is for machines that hold the orientation of their tool; `kinetostat tolerance` answers for single places",
        ));
    }
    let contained = !matches!(
        machine.weight,
        WeightCorrection::NotStated | WeightCorrection::All
    );
    if contained && machine.mechanism.has_own_loads() {
        return Err(ErrorCode::Conflict.failure(format!(
                "weight is \"{}\": the band of the errors (--uncertain, [uncertain] in the job) would hold the part where the machine as drawn measured it, though every machine sags by its own amount there; give weight = \"all\" (--weight all) for the band, or leave the band out",
                machine.weight.word()
            ),
        ));
    }
    let (text, name) = (&uncertainty.text, &uncertainty.name);
    Ok(UncertaintyFile::read_along_program(text, name, model)?)
}

/// The parts of the cutting force at the places, where the file has factors on them.
pub(crate) fn parts(
    file: &UncertaintyFile,
    task: &Task<'_>,
    places: &[ProgramPlace],
    machine: &MachineSetup,
    setting: &Setting,
    watch: &dyn Watch,
) -> Answer<Option<CuttingParts>> {
    let mut of_parts = file
        .sources
        .iter()
        .enumerate()
        .filter_map(|(i, source)| match source {
            Source::CuttingPart(_) => Some(&file.uncertainties.each()[i].name),
            _ => None,
        });
    let Some(name) = of_parts.next() else {
        return Ok(None);
    };
    // The load that comes and goes acts in part.
    let whole = wrenches_at(task, places);
    let acts = |(place, whole): (&ProgramPlace, &Wrench)| match whole.0.norm_squared() {
        0.0 => 0.0,
        squared => place.wrench.0.dot(&whole.0) / squared,
    };
    let acting: Vec<f64> = places.iter().zip(&whole).map(acts).collect();
    let mut parts = CuttingParts::default();
    for (k, part) in parts.iter_mut().enumerate() {
        let with = |factor: f64| {
            let mut factors = [1.0; CUTTING_PARTS.len()];
            factors[k] = factor;
            varied(task, places, machine, setting, factors, name, watch)
        };
        let (more, less) = (with(1.0 + VARIED)?, with(1.0 - VARIED)?);
        let slopes = more.iter().zip(&less).zip(&acting);
        *part = slopes
            .map(|((more, less), acts)| Wrench((more.0 - less.0) * (acts / (2.0 * VARIED))))
            .collect();
    }
    Ok(Some(parts))
}

/// The load at the places with the parts of the cutting force multiplied by factors.
fn varied(
    task: &Task<'_>,
    places: &[ProgramPlace],
    machine: &MachineSetup,
    setting: &Setting,
    factors: [f64; CUTTING_PARTS.len()],
    name: &str,
    watch: &dyn Watch,
) -> Answer<Vec<Wrench>> {
    let unknown = |why: &str| {
        setting.within(ErrorCode::Value.failure(format!(
            "'{name}' is uncertain, and {why}: make all of the load uncertain (load = \"factor\")"
        )))
    };
    let scaled = |load: &ProgramLoad| -> Answer<ProgramLoad> {
        let cutting = match load.cutting {
            CuttingLoad::Milling {
                radial,
                tangential,
                axial,
            } => CuttingLoad::Milling {
                tangential: tangential * factors[0],
                radial: radial * factors[1],
                axial: axial * factors[2],
            },
            CuttingLoad::Constant { .. } => {
                return Err(unknown("the stated force has no parts of a cut"));
            }
            CuttingLoad::FromCut {
                origin: ForceOrigin::Measured,
                ..
            } => return Err(unknown("a measured force has no parts")),
            other => other,
        };
        Ok(ProgramLoad { cutting, ..*load })
    };
    let forces = match (&machine.cut, task.cut) {
        (Some(_), Some(_)) if setting.forces.is_some() => {
            return Err(unknown(
                "the program was converted, so that only the sum of its forces is known",
            ));
        }
        (Some(cut), Some(_)) => {
            let mut question = cut.question.clone();
            for tool in &mut question.tools {
                scale(tool, factors);
            }
            let along = question.along(task.path(), watch);
            Some(along.map_err(|failure: CutFailure| stopped_or_within(failure, setting))?)
        }
        _ => None,
    };
    let tools = task.tools.iter().map(|tool| {
        Ok(Tool {
            load: scaled(&tool.load)?,
            ..*tool
        })
    });
    let tools = tools.collect::<Answer<Vec<Tool<'_>>>>()?;
    let task = Task {
        load: scaled(&task.load)?,
        tools: &tools,
        cut: forces.as_ref().or(task.cut),
        ..task.clone()
    };
    Ok(wrenches_at(&task, places))
}

fn scale(tool: &mut CuttingTool, [tangential, radial, axial]: [f64; 3]) {
    let factors = EdgeForce::new(tangential, radial, axial);
    tool.law = Arc::new(Scaled::new(tool.law.clone(), factors));
}

/// Draws machines and puts the band of the errors into the result of a run.
pub(crate) fn put_band(
    run: &mut Run,
    machine: &MachineSetup,
    model: &Model,
    uncertainty: &Uncertainty,
    file: &UncertaintyFile,
    parts: Option<CuttingParts>,
    progress: &Progress,
) -> Answer<()> {
    let given = &machine.bounds.tools;
    let tools: Vec<_> = given.iter().map(|tool| (tool.number, tool.pose)).collect();
    let is_written = run.written.is_some();
    let uncertain = UncertainRun::new(model, &tools, file, &run.places, is_written, parts)?;
    let draws = Draws::new(uncertainty.machines, uncertainty.seed);
    let found = band(
        &uncertain,
        file,
        &uncertainty.name,
        uncertainty.seed,
        &draws,
        progress,
    )?;
    run.result.uncertainty = Some(found);
    Ok(())
}
