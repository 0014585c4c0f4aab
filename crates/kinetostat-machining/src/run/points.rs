//! Every place of a program solved: where the tool is without compensation and with it, and what the machine
//! carries there.

use kinetostat::batch::{AlongPath, BatchEquilibrium};
use kinetostat::chain::FoundBy;
use kinetostat::{Error, MechanismEquilibrium, MotionKind, Pose, Posture, Wrench};
use nalgebra::UnitQuaternion;

use crate::field::cause_and_advice;
use crate::joints::{JointFigures, in_display};
use crate::load::law::{Tool, tool_on};
use crate::measured_frame::{FrameMotion, MeasuredFrame, PartPlace};
use crate::postures::arm_course::ArmCourse;
use crate::postures::neighbour::{Neighbour, Orientation, in_chunks};
use crate::result::point::{PointResult, size};
use crate::run::joints::turn_deg;
use crate::run::sites::site::Site;
use crate::task::{NoMotion, RunError, Task, kinds};
use crate::watch::Watch;

/// Points between two questions to the watch whether to stop.
pub(crate) const BATCH: usize = 16_384;

/// All points in their order, and the first of a written program that is worse than before. Sites are
/// made as they are needed, and once: a long program has many.
pub(crate) fn solve(
    task: &Task<'_>,
    mut sites: impl Iterator<Item = Site>,
    how: Solving<'_>,
    watch: &dyn Watch,
) -> Result<(Vec<PointResult>, Option<RunError>), RunError> {
    let name = if how.written {
        "deflections of the written program"
    } else {
        "deflections"
    };
    let own = task.path().own_moves();
    watch.stage(name, own.len());
    let mut points: Vec<PointResult> = Vec::with_capacity(own.len());
    let mut worse = None;
    let machines = Machines::new(task);
    let figures = JointFigures::new(task.mechanism, &task.bounds.ratings);
    let mut batch: Vec<Site> = Vec::new();
    loop {
        batch.clear();
        batch.extend(sites.by_ref().take(BATCH));
        let Some(last) = batch.last() else { break };
        let done = (last.move_index + 1).saturating_sub(own.start);
        if watch.cancelled() {
            return Err(RunError::Cancelled);
        }
        let of_one_tool = batch.chunk_by(|a, b| machines.same(a, b));
        let solved = of_one_tool.flat_map(|run| {
            let (machine, orientation) = machines.at(&run[0]);
            in_chunks(run, |memory, sites| {
                let how = Solving { orientation, ..how };
                chunk(task, machine, memory, sites, how)
            })
        });
        for (site, point) in batch.iter().zip(solved) {
            let mut point = point?;
            if let Some(before) = points.last() {
                figures.unwind(&before.actuator_command, &mut point);
            }
            figures.fill(&mut point);
            worse = worse.or_else(|| worse_than_before(task, site, &point));
            points.push(point);
        }
        watch.advance(done);
    }
    // A part of a longer program may only rise and go on.
    match points.is_empty() && task.path().part.is_none() {
        true => Err(RunError::NoMotion(NoMotion::NoLength)),
        false => Ok((points, worse)),
    }
}

/// Settings for solving points.
#[derive(Clone, Copy)]
pub(crate) struct Solving<'c> {
    pub orientation: Orientation,
    /// True for the points of a written program.
    pub written: bool,
    /// The way of an arm that is not the one from home.
    pub course: Option<&'c ArmCourse>,
    /// Frame of the part as it was measured.
    pub frame: &'c MeasuredFrame<'c>,
}

/// Points of a chunk, by vector kernels where there are some, else one after the other; up to the first that has no
/// answer.
pub(crate) fn chunk(
    task: &Task<'_>,
    machine: &AlongPath,
    memory: &mut [Neighbour; 2],
    sites: &[Site],
    how: Solving<'_>,
) -> Vec<Result<PointResult, RunError>> {
    let Solving {
        orientation,
        written,
        course,
        frame,
    } = how;
    let mechanism = machine.mechanism();
    let places: Vec<PartPlace> = sites
        .iter()
        .map(|s| s.programmed(s.placement(task)))
        .collect();
    let programmed: Vec<Pose> = places.iter().map(PartPlace::pose).collect();
    let standing =
        |i: usize| course.and_then(|c| c.standing_at(sites[i].move_index, sites[i].share));
    let motions = match sites.first() {
        Some(site) => frame.motions(task.mechanism_on(site.line), &places, standing),
        None => Vec::new(),
    };
    let wrenches: Vec<Wrench> = sites.iter().map(|s| s.wrench).collect();
    // Along a way of its own every place is solved next to the arm there.
    let together = course.is_none();
    let before = written.then(|| {
        together
            .then(|| machine.rest(&programmed, &wrenches))
            .flatten()
    });
    let commanded = match written {
        true => sites.iter().map(|s| s.commanded_pose(task)).collect(),
        false => programmed.clone(),
    };
    let after = together.then(|| machine.with_stability(&commanded, &wrenches));
    let after = after.flatten();
    let [before_memory, after_memory] = memory;
    // One after the other: each starts from its neighbour.
    let mut solved = |i: usize| -> Result<PointResult, Error> {
        let wrench = &wrenches[i];
        if let Some(posture) = standing(i) {
            before_memory.stand_at(posture);
            after_memory.stand_at(posture);
        }
        let before = match &before {
            None => None,
            Some(Some(found)) => Some((found.commands.row(i).collect(), found.tool_pose(i))),
            Some(None) => {
                let pose = &programmed[i];
                let (posture, tool) = before_memory.rest(mechanism, pose, wrench, orientation)?;
                Some((posture.commands(), tool))
            }
        };
        let after = match &after {
            Some(found) => Loaded::of_batch(found, i, &commanded[i]),
            None => None,
        };
        let after = match after {
            Some(after) => after,
            None => {
                let pose = &commanded[i];
                let found = after_memory.equilibrium(mechanism, pose, wrench, orientation)?;
                Loaded::of_posture(&found.0, &found.1)
            }
        };
        let motion = motions[i].clone()?;
        Ok(point(task, &sites[i], &motion, before, after))
    };
    let mut points = Vec::with_capacity(sites.len());
    for (i, site) in sites.iter().enumerate() {
        let point = solved(i).map_err(|cause| failed(site, cause));
        let ends = point.is_err();
        points.push(point);
        if ends {
            break;
        }
    }
    points
}

/// A place without an answer.
pub(crate) fn failed(site: &Site, cause: Error) -> RunError {
    RunError::Point {
        line: site.line,
        position_mm: site.desired.into(),
        message: cause_and_advice(&cause),
        cause: Box::new(cause),
    }
}

/// Equilibrium as a result states it.
struct Loaded {
    tool: Pose,
    /// Orientation of the unloaded tool.
    nominal: UnitQuaternion<f64>,
    commands: Vec<f64>,
    actuator_forces: Vec<f64>,
    stiffness_against_force: f64,
    share_to_buckling: Option<f64>,
    stable: bool,
    found_by: FoundBy,
}

impl Loaded {
    fn of_posture(posture: &Posture, equilibrium: &MechanismEquilibrium) -> Self {
        Self {
            tool: equilibrium.tool,
            nominal: posture.target().rotation,
            commands: posture.commands(),
            actuator_forces: equilibrium.actuator_forces(),
            stiffness_against_force: equilibrium.stiffness_against_force(),
            share_to_buckling: equilibrium.share_to_buckling(),
            stable: equilibrium.stable(),
            found_by: equilibrium.found_by,
        }
    }

    fn of_batch(found: &BatchEquilibrium, i: usize, commanded: &Pose) -> Option<Self> {
        let stability = found.stability(i)?;
        Some(Self {
            tool: found.tool_pose(i),
            nominal: commanded.rotation,
            commands: found.commands.row(i).collect(),
            actuator_forces: found.actuator_forces.row(i).collect(),
            stiffness_against_force: stability.stiffness_against_force,
            share_to_buckling: stability.share_to_buckling,
            stable: stability.stable,
            found_by: found.found_by[i],
        })
    }
}

/// A change of a joint value without whole turns: of two values a turn apart, that stand for the same posture, a solution takes
/// one as well as the other.
fn change(kind: MotionKind, difference: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    match kind {
        MotionKind::Prismatic => difference,
        MotionKind::Revolute => difference - turn * (difference / turn).round(),
    }
}

/// `before`: commands and pose of the tool without compensation, of a written program.
fn point(
    task: &Task<'_>,
    site: &Site,
    motion: &FrameMotion,
    before: Option<(Vec<f64>, Pose)>,
    after: Loaded,
) -> PointResult {
    let place = &site.placement(task);
    let wanted = site.programmed(*place).moved(motion).pose();
    let off = |tool: &Pose| -> [f64; 3] {
        let shift = tool.translation.vector - wanted.translation.vector;
        place.to_program(&shift).into()
    };
    let lies = &site.commanded_placement(task);
    let there = site.programmed(*lies).moved(motion).pose();
    let error_after_mm: [f64; 3] = {
        let shift = after.tool.translation.vector - there.translation.vector;
        lies.to_program(&shift).into()
    };
    let (error_before_mm, actuator_correction) = match before {
        Some((nominal, tool)) => {
            let both = after.commands.iter().zip(&nominal);
            let correction = both
                .zip(kinds(task.mechanism))
                .map(|((after, before), kind)| in_display(kind) * change(kind, after - before))
                .collect();
            (off(&tool), correction)
        }
        None => (error_after_mm, vec![0.0; after.commands.len()]),
    };
    PointResult {
        line: site.line,
        move_index: site.move_index,
        output_line: site.output_line,
        end: site.end,
        kind: site.kind,
        share: site.share,
        path_mm: site.path_mm,
        start_mm: site.start_mm,
        programmed: site.programmed,
        position_mm: site.desired.into(),
        part_turn: task.path().moves[site.move_index].part_turn(site.share),
        tool_orientation: site.orientation.map(|o| [o.w, o.i, o.j, o.k]),
        error_before_mm,
        error_after_mm,
        correction_mm: (site.commanded - site.desired).into(),
        force_n: place.to_part_axes(&site.wrench.force()).into(),
        moment_n_m: place.to_part_axes(&site.wrench.moment()).into(),
        residual_rotation_deg: match site.orientation {
            // The turn about the tool is free.
            Some(_) if site.commanded_deg.is_some() => {
                let axis = task.path().tool_axis;
                let [tool, wanted] = [after.tool, there].map(|pose| pose.rotation * axis);
                tool.cross(&wanted).norm().atan2(tool.dot(&wanted))
            }
            Some(_) => after.tool.rotation.angle_to(&wanted.rotation),
            None => {
                let turn = lies.to_base_axes(&motion.turn.scaled_axis());
                let held = UnitQuaternion::from_scaled_axis(turn) * after.nominal;
                (after.tool.rotation * held.inverse()).angle()
            }
        }
        .to_degrees(),
        tool_turn_deg: place
            .orientation_follows
            .then(|| turn_deg(&wanted.rotation, &after.nominal)),
        actuator_command: after
            .commands
            .iter()
            .zip(kinds(task.mechanism))
            .map(|(command, kind)| in_display(kind) * command)
            .collect(),
        actuator_force: after.actuator_forces,
        actuator_correction,
        smallest_stiffness_n_per_mm: 1e-3 * after.stiffness_against_force,
        share_to_buckling: after.share_to_buckling.filter(|mu| mu.is_finite()),
        stable: after.stable,
        found_by: after.found_by,
        ..PointResult::default()
    }
}

/// Error of a block that ends farther off than without compensation, beyond tolerance and rounding.
fn worse_than_before(task: &Task<'_>, site: &Site, point: &PointResult) -> Option<RunError> {
    let decimals = i32::from(task.writing.decimals.unwrap_or(4));
    let slack =
        task.writing.tolerance_mm + task.writing.chord_tolerance_mm + 10_f64.powi(-decimals);
    let last = site.end && site.share >= 1.0;
    let (before_mm, after_mm) = (size(&point.error_before_mm), size(&point.error_after_mm));
    (last && after_mm > before_mm + slack).then_some(RunError::Worse {
        line: site.line,
        before_mm,
        after_mm,
    })
}

/// The machine of a run with each of its tools, ready to solve many postures.
pub(crate) struct Machines<'t, 'm> {
    task: &'t Task<'m>,
    /// The first is the machine without one of the tools.
    machines: Vec<AlongPath>,
}

impl<'t, 'm> Machines<'t, 'm> {
    pub fn new(task: &'t Task<'m>) -> Self {
        let machine = match task.placement.orientation_follows {
            true => AlongPath::by_neighbours,
            false => AlongPath::new,
        };
        let machines = std::iter::once(task.mechanism);
        let machines = machines.chain(task.tools.iter().map(|tool| tool.mechanism));
        Self {
            task,
            machines: machines.map(machine).collect(),
        }
    }

    fn tool(&self, site: &Site) -> Option<&'t Tool<'m>> {
        tool_on(self.task.tools, self.task.path(), site.line)
    }

    /// True if two places are cut with one tool.
    pub fn same(&self, one: &Site, other: &Site) -> bool {
        let number = |site: &Site| self.tool(site).map(|tool| tool.number);
        number(one) == number(other)
    }

    /// The machine that cuts at a place, and what is done with the orientation there.
    pub fn at(&self, site: &Site) -> (&AlongPath, Orientation) {
        let tool = self.tool(site);
        let position = |tool: &Tool<'_>| {
            let own = |other: &Tool<'_>| other.number == tool.number;
            self.task.tools.iter().position(own)
        };
        let index = tool.and_then(position).map_or(0, |index| index + 1);
        let load = tool.map_or(&self.task.load, |tool| &tool.load);
        let orientation = Orientation::of(&self.task.placement, load);
        (&self.machines[index], orientation)
    }
}
