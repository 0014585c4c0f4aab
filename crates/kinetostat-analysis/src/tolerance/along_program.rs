//! Machines as functions of uncertain numbers, along a program: commanded by the program as it is, and by the one that was written for the
//! machine as drawn.

use kinetostat::batch::{Batch, BatchEquilibrium, Commanded, Details, LoadedBatch};
use kinetostat::nalgebra::Vector3;
use kinetostat::number::larger;
use kinetostat::{Mechanism, Pose, Wrench};
use kinetostat_machining::{BandPlace, ProgramPlace, ScatteredError, UncertaintyBand, Watch};
use kinetostat_model::{Model, ParametricModel};

use crate::tolerance::draws::Draws;
use crate::tolerance::file::{CUTTING_PARTS, Source, UncertaintyFile};
use crate::tolerance::linear::Linear;
use crate::tolerance::machine::{DependsOnMachine, Room, TaskError, at};
use crate::tolerance::near_drawing::{MOST_DERIVATIVES, Margins, with_stability};
use crate::tolerance::statistics::{CONFIDENCE, quantile};
use crate::tolerance::study::{OutputAnswer, Samples, answers, linearised, monte_carlo};
use crate::tolerance::uncertain::Uncertainties;

/// Parts of the force of the cut at every place: what one of them would be more by, if it were as large again.
pub type CuttingParts = [Vec<Wrench>; CUTTING_PARTS.len()];

/// Maximum difference of an error that is solved once more: mm, and a share of it.
const SAME_MM: f64 = 1e-6;
const SAME: f64 = 1e-6;

/// Places that are cut with one tool.
#[derive(Clone, Debug)]
struct OfTool {
    /// Platform from tool, m.
    tool: Pose,
    /// The machine as drawn, with the tool, compiled.
    batch: Batch,
    /// Their indices among all places.
    indices: Vec<usize>,
    programmed: Commanded,
    commanded: Commanded,
    /// Natural length, m.
    length: f64,
    /// Stability margins of the places as they are commanded in the end.
    margins: Option<Margins>,
}

impl OfTool {
    fn new(
        drawn: &Mechanism,
        tool: Pose,
        places: &[ProgramPlace],
        number: Option<u32>,
    ) -> Result<Self, TaskError> {
        let own = places.iter().enumerate().filter(|(_, p)| p.tool == number);
        let (indices, own): (Vec<usize>, Vec<&ProgramPlace>) = own.unzip();
        let batch = Batch::new(&drawn.with_tool(&tool));
        let wrenches: Vec<Wrench> = own.iter().map(|place| place.wrench).collect();
        let commanded = |pose: fn(&ProgramPlace) -> Pose| {
            let poses: Vec<Pose> = own.iter().map(|place| pose(place)).collect();
            batch.commanded_under(&poses, &wrenches)
        };
        Ok(Self {
            programmed: commanded(|place| place.programmed)?,
            commanded: commanded(|place| place.commanded)?,
            length: drawn.natural_length(),
            margins: None,
            tool,
            batch,
            indices,
        })
    }
}

/// A run along a program as a function of uncertain numbers. Its numbers are the largest error before compensation and, of a program that
/// was compensated, after it, then both at every place: distances of the tool from where it should be, mm of the program.
#[derive(Clone, Debug)]
pub struct UncertainRun {
    parametric: ParametricModel,
    sources: Vec<Source>,
    places: Vec<ProgramPlace>,
    parts: Option<CuttingParts>,
    tools: Vec<OfTool>,
    compensated: bool,
    /// Values of the drawing.
    nominal: Vec<f64>,
}

impl UncertainRun {
    /// A model, the poses of its tools (number, platform from tool; the first without a number is that of all other places), the places of a
    /// run, whether it was compensated, and the parts of the cutting force there, where they are known.
    ///
    /// # Errors
    /// What is wrong with the numbers of the drawing, or where the machine as drawn has no answer.
    pub fn new(
        model: &Model,
        tools: &[(Option<u32>, Pose)],
        file: &UncertaintyFile,
        places: &[ProgramPlace],
        compensated: bool,
        parts: Option<CuttingParts>,
    ) -> Result<Self, TaskError> {
        let parametric = model.parametric(&file.parameters())?;
        let nominal: Vec<f64> = parametric.parameters().iter().map(|p| p.value).collect();
        let drawn = parametric.mechanism(&nominal)?;
        let mut numbers: Vec<Option<u32>> = places.iter().map(|place| place.tool).collect();
        numbers.sort_unstable();
        numbers.dedup();
        let of_tool = |number| OfTool::new(&drawn, pose_of(tools, number), places, number);
        let mut run = Self {
            parametric,
            sources: file.sources.clone(),
            places: places.to_vec(),
            parts,
            tools: numbers.into_iter().map(of_tool).collect::<Result<_, _>>()?,
            compensated,
            nominal: file.uncertainties.nominal(),
        };
        let mut tools = std::mem::take(&mut run.tools);
        for own in &mut tools {
            run.learn(own, &file.uncertainties)?;
        }
        run.tools = tools;
        let mut out = vec![0.0; run.width()];
        run.answer(
            &file.uncertainties.nominal(),
            &mut Room::default(),
            &mut out,
        )?;
        let each = run.columns();
        if let Some(at) = out[each..].iter().position(|x| !x.is_finite()) {
            return Err(TaskError::Unanswered {
                place: at / each + 1,
                reason: format!("line {} of the program", run.places[at / each].line),
            });
        }
        for (place, row) in run.places.iter().zip(out[each..].chunks_exact(each)) {
            let stated = [place.error_before_mm, place.error_after_mm];
            for (found_mm, stated_mm) in row.iter().zip(stated) {
                if (found_mm - stated_mm).abs() > SAME_MM + SAME * stated_mm {
                    return Err(TaskError::StandsOtherwise {
                        line: place.line,
                        found_mm: *found_mm,
                        stated_mm,
                    });
                }
            }
        }
        Ok(run)
    }

    /// Numbers of a place: before, and after compensation.
    pub(crate) fn columns(&self) -> usize {
        1 + usize::from(self.compensated)
    }

    /// Places of the program.
    pub(crate) fn places(&self) -> &[ProgramPlace] {
        &self.places
    }

    /// Finds out how the machine stands, and how surely, a standard deviation to both sides of the drawing: the search for the
    /// equilibria of every machine starts from derivatives.
    fn learn(&self, own: &mut OfTool, uncertainties: &Uncertainties) -> Result<(), TaskError> {
        let last = |own: &OfTool, batch: &Batch, loads: &[Wrench]| {
            let places = own.last(self.compensated);
            with_stability(batch, places, loads)
        };
        let drawn = last(own, &own.batch, &self.loads(own, &self.nominal))?;
        let mut margins = Margins::new(&drawn, own.length);
        for (i, number) in uncertainties.each().iter().enumerate() {
            let step = number.distribution.standard_deviation();
            let at = |by: f64| {
                let mut values = self.nominal.clone();
                values[i] += by;
                let loads = self.loads(own, &values);
                self.built(own, &values).map(|batch| (batch, loads))
            };
            // If there is no such machine, others are searched without derivatives from here on.
            let (Ok(more), Ok(less)) = (at(step), at(-step)) else {
                return Ok(());
            };
            let [above, below] = [&more, &less].map(|(batch, loads)| last(own, batch, loads));
            margins.go_along(&above?, &below?, 2.0 * step, own.length);
            if i >= MOST_DERIVATIVES {
                continue;
            }
            let [more, less] =
                [&more, &less].map(|(batch, wrenches)| LoadedBatch { batch, wrenches });
            own.programmed.go_along(more, less, 2.0 * step)?;
            if self.compensated {
                own.commanded.go_along(more, less, 2.0 * step)?;
            }
        }
        own.margins = Some(margins);
        Ok(())
    }

    /// The machine with a tool and these values, compiled.
    fn built(&self, own: &OfTool, values: &[f64]) -> Result<Batch, TaskError> {
        let numbers = Source::of_model(&self.sources, values);
        let built = self.parametric.mechanism(&numbers)?;
        Ok(own.batch.built(&built.with_tool(&own.tool))?)
    }

    /// The loads at the places of a tool with these values.
    fn loads(&self, own: &OfTool, values: &[f64]) -> Vec<Wrench> {
        let each = own.indices.iter();
        each.map(|i| self.wrench(*i, values)).collect()
    }

    /// The load at a place with these values.
    fn wrench(&self, place: usize, values: &[f64]) -> Wrench {
        let own = self.places[place].wrench;
        let (mut sum, mut factor) = (own.0, 1.0);
        for (source, value) in self.sources.iter().zip(values) {
            match (source, &self.parts) {
                (Source::LoadFactor, _) => factor = *value,
                (Source::CuttingPart(k), Some(parts)) => {
                    sum += parts[*k][place].0 * (value - 1.0);
                }
                _ => {}
            }
        }
        Wrench(sum * factor)
    }
}

impl OfTool {
    /// The places as they are commanded in the end.
    fn last(&self, compensated: bool) -> &Commanded {
        match compensated {
            true => &self.commanded,
            false => &self.programmed,
        }
    }
}

fn pose_of(tools: &[(Option<u32>, Pose)], number: Option<u32>) -> Pose {
    let own = tools.iter().find(|(n, _)| *n == number);
    let other = || tools.iter().find(|(n, _)| n.is_none());
    own.or_else(other)
        .map_or_else(Pose::identity, |(_, pose)| *pose)
}

impl DependsOnMachine for UncertainRun {
    fn width(&self) -> usize {
        (1 + self.places.len()) * self.columns()
    }

    fn answer(&self, values: &[f64], room: &mut Room, out: &mut [f64]) -> Result<usize, TaskError> {
        let numbers = Source::of_model(&self.sources, values);
        let built = self.parametric.mechanism(&numbers)?;
        let each = self.columns();
        room.deviate(values, &self.nominal);
        let (largest, of_places) = out.split_at_mut(each);
        let mut unstable = 0;
        for own in &self.tools {
            let batch = own.batch.built(&built.with_tool(&own.tool))?;
            room.wrenches.clear();
            let loads = own.indices.iter().map(|i| self.wrench(*i, values));
            room.wrenches.extend(loads);
            let (loads, by, before) = (&room.wrenches, &room.deviations, &mut room.loaded);
            if self.compensated {
                let details = Details::Rest;
                batch.equilibrium_foretold_into(&own.programmed, by, loads, details, before)?;
            }
            let details = match own.margins.as_ref().is_some_and(|m| m.hold(by)) {
                true => Details::Rest,
                false => Details::Stability,
            };
            let (last, after) = (own.last(self.compensated), &mut room.compensated);
            batch.equilibrium_foretold_into(last, by, loads, details, after)?;
            let stable = (0..own.indices.len()).filter_map(|i| room.compensated.stability(i));
            unstable += stable.filter(|s| !s.stable).count();
            for (k, i) in own.indices.iter().enumerate() {
                let place = &self.places[*i];
                let row = &mut of_places[each * i..each * (i + 1)];
                let off = |found: &BatchEquilibrium, wanted: &Pose| {
                    let away: Vector3<f64> = at(found, k) - wanted.translation.vector;
                    away.norm() / place.metres_per_mm
                };
                if self.compensated {
                    row[0] = off(&room.loaded, &place.wanted);
                    row[1] = off(&room.compensated, &place.wanted_as_commanded);
                } else {
                    row[0] = off(&room.compensated, &place.wanted);
                }
            }
        }
        for (column, largest) in largest.iter_mut().enumerate() {
            let all = of_places.iter().skip(column).step_by(each);
            *largest = all.copied().fold(0.0, larger);
        }
        Ok(unstable)
    }
}

/// Shares of the machines between which a band lies, and its middle.
const BAND: [f64; 3] = [0.05, 0.5, 0.95];

/// Draws machines and gives the band of the errors; `name` is that of the file, `seed` that of the draws.
///
/// # Errors
/// [`TaskError`] where a machine next to the drawing is none, or the watch stops the work.
pub fn band(
    run: &UncertainRun,
    file: &UncertaintyFile,
    name: &str,
    seed: u64,
    draws: &Draws,
    watch: &dyn Watch,
) -> Result<UncertaintyBand, TaskError> {
    let samples = monte_carlo(run, &file.uncertainties, draws, watch)?;
    let each = run.columns();
    let mut lines: Vec<Linear> = linearised(run, &file.uncertainties)?;
    // Only the largest errors are propagated linearly; places have quantiles.
    lines.truncate(each);
    let largest = answers(&file.uncertainties, draws, &samples, lines);
    let mut band = UncertaintyBand::default();
    name.clone_into(&mut band.file);
    band.uncertain = file.uncertainties.as_stated();
    band.machines = draws.len();
    band.unanswered = samples.failures.no_machine + samples.failures.no_answer;
    band.unstable = samples.failures.unstable;
    band.seed = seed;
    band.confidence = CONFIDENCE;
    band.places = places(run, &samples);
    let mut scattered = largest.iter().map(scattered);
    band.before = scattered.next().unwrap_or_default();
    band.after = scattered.next();
    Ok(band)
}

fn scattered(answer: &OutputAnswer) -> ScatteredError {
    let draws = &answer.draws;
    let high = draws.quantiles.iter().find(|q| q.share == BAND[2]);
    ScatteredError {
        as_drawn_mm: answer.linear.nominal,
        mean_mm: draws.mean.value,
        deviation_mm: draws.standard_deviation.value,
        deviation_plus_minus_mm: draws.standard_deviation.plus_minus,
        low_mm: draws.quantile(BAND[0]),
        high_mm: draws.quantile(BAND[2]),
        high_at_most_mm: high.and_then(|q| q.high),
        deviation_by_line_mm: answer.linear.standard_deviation,
        linear_is_enough: answer.verdict.linear_is_enough,
    }
}

fn places(run: &UncertainRun, samples: &Samples) -> Vec<BandPlace> {
    let each = run.columns();
    let of_column = |column: usize| -> [f64; 3] {
        let mut values = samples.column(column);
        values.retain(|x| x.is_finite());
        values.sort_unstable_by(f64::total_cmp);
        BAND.map(|share| quantile(&values, share).value)
    };
    let place = |(i, place): (usize, &kinetostat_machining::ProgramPlace)| BandPlace {
        line: place.line,
        path_mm: place.path_mm,
        before_mm: of_column(each * (i + 1)),
        after_mm: (each > 1).then(|| of_column(each * (i + 1) + 1)),
    };
    run.places().iter().enumerate().map(place).collect()
}
