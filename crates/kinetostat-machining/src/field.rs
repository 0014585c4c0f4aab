//! The model as a field of corrections for the program writer.

use kinetostat::batch::AlongPath;
use kinetostat::number::larger;
use kinetostat::{Directions, Error, Mechanism, Pose, Wrench};
use kinetostat_program::{
    Correction, CorrectionField, Course, FieldFailure, Move, Request, RotaryTurn, Structure,
};
use nalgebra::Vector3;

use crate::load::along_path::LoadAlongPath;
use crate::measured_frame::{FrameMotion, MeasuredFrame, PartPlace};
use crate::near::natural_length;
use crate::placement::Placement;
use crate::postures::arm_course::ArmCourse;
use crate::postures::neighbour::{Neighbour, Orientation, in_chunks};

/// Answers, for every point of a path, what must be added to the program so that the tool is there
/// under the load of the program.
pub struct ModelField<'a> {
    /// Machine with its tool; with that of [`LoadAlongPath::tool_of`] where there are several.
    pub mechanism: &'a Mechanism,
    /// Placement of the program.
    pub placement: Placement,
    /// Cutting load at every place of the path; it also knows the tool at each.
    pub load: &'a LoadAlongPath<'a>,
    /// Directions of the pose that are corrected.
    corrected: Directions,
    /// The orientation is corrected by rotary axes: the path has their angles.
    turned_by_axes: bool,
    /// Distance to which the correction can be continued in every direction, program mm.
    radius_mm: f64,
    /// The way of an arm that is not the one from home.
    course: Option<&'a ArmCourse>,
    /// Frame of the part as it was measured.
    frame: &'a MeasuredFrame<'a>,
}

/// Share of the machine's natural length within which its deflection under a load that does not change
/// is taken for a power series of the tool's place: geometry and stiffness vary over lengths like the
/// natural one.
const SMOOTH: f64 = 0.25;

impl<'a> ModelField<'a> {
    /// The field of a machine with its tool, for a program that lies somewhere, under a load.
    #[must_use]
    pub fn new(
        mechanism: &'a Mechanism,
        placement: Placement,
        load: &'a LoadAlongPath<'a>,
    ) -> Self {
        Self {
            mechanism,
            placement,
            load,
            corrected: Directions::POSITION,
            turned_by_axes: false,
            radius_mm: SMOOTH * 1e3 * natural_length(mechanism) / placement.scale,
            course: None,
            frame: &MeasuredFrame::AsStated,
        }
    }

    /// Sets the corrected directions of the tool's pose: [`Directions::POSITION`], the default, or
    /// [`Directions::ALL`] if the program states the orientation.
    #[must_use]
    pub fn correcting(mut self, directions: Directions) -> Self {
        self.corrected = directions;
        let mut moves = self.load.path().moves.iter();
        self.turned_by_axes = directions == Directions::ALL && moves.any(|m| rotary(m).is_some());
        self
    }

    /// Follows the course of an arm, if it is not the one from home.
    pub(crate) fn on_course(mut self, course: Option<&'a ArmCourse>) -> Self {
        self.course = course;
        self
    }

    /// Uses the frame of the part as it was measured.
    pub(crate) fn in_frame(mut self, frame: &'a MeasuredFrame<'a>) -> Self {
        self.frame = frame;
        self
    }

    fn wrench(&self, request: &Request) -> Wrench {
        match request.turning {
            None => self
                .load
                .wrench(&self.placement, request.move_index, request.share),
            Some(turning) => {
                self.load
                    .turning_wrench(&self.placement, request.move_index, &turning)
            }
        }
    }
}

impl CorrectionField for ModelField<'_> {
    fn turns(&self) -> bool {
        true
    }

    fn turns_tool(&self) -> bool {
        self.corrected == Directions::ALL
    }

    fn structure(&self, move_index: usize, _motion: &Move) -> Structure {
        let radius_mm = self.radius_mm;
        let is_steady = !self.placement.orientation_follows && self.load.is_steady(move_index);
        Structure {
            breaks: self.load.breaks(move_index),
            course: match is_steady {
                true => Course::Steady { radius_mm },
                false => Course::Smooth { radius_mm },
            },
        }
    }

    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let number = |r: &Request| self.load.tool_of(r.move_index).map(|tool| tool.number);
        let of_one_tool = requests.chunk_by(|a, b| number(a) == number(b));
        of_one_tool
            .flat_map(|requests| {
                let tool = self.load.tool_of(requests[0].move_index);
                self.with(tool.map_or(self.mechanism, |t| t.mechanism), requests)
            })
            .collect()
    }
}

impl ModelField<'_> {
    /// The place of a request as the program states it.
    fn programmed(&self, request: &Request) -> PartPlace {
        let motion = &self.load.path().moves[request.move_index];
        PartPlace {
            place: self.placement.on(motion, request.share),
            position_mm: request.position_mm,
            orientation: request.orientation,
        }
    }

    /// Corrections of one tool.
    fn with(
        &self,
        mechanism: &Mechanism,
        requests: &[Request],
    ) -> Vec<Result<Correction, FieldFailure>> {
        let load = self.load.load_of(requests[0].move_index);
        let orientation = Orientation::of(&self.placement, load);
        let machine = match orientation.follows {
            true => AlongPath::by_neighbours(mechanism),
            false => AlongPath::new(mechanism),
        };
        in_chunks(requests, |memory, requests| {
            let places: Vec<PartPlace> = requests.iter().map(|r| self.programmed(r)).collect();
            let standing = |i: usize| {
                let course = self.course?;
                course.standing_at(requests[i].move_index, requests[i].share)
            };
            let motions = self.frame.motions(mechanism, &places, standing);
            // Without a motion of the frame there is no correction either, and the check of the written program
            // reports the reason.
            let motions = motions.into_iter().map(Result::unwrap_or_default);
            let motions: Vec<FrameMotion> = motions.collect();
            let wanted = places.iter().zip(&motions);
            let poses: Vec<Pose> = wanted
                .map(|(place, motion)| place.corrected(motion, self.corrected).pose())
                .collect();
            let wrenches: Vec<Wrench> = requests.iter().map(|r| self.wrench(r)).collect();
            let turns = self.corrected == Directions::ALL;
            let correction = |programmed: &PartPlace, target: &Pose| {
                let (place, pose) = (&programmed.place, programmed.pose());
                let shift = target.translation.vector - pose.translation.vector;
                let turn = (target.rotation * pose.rotation.inverse()).scaled_axis();
                Correction {
                    shift_mm: place.to_program(&shift),
                    turn: match turns {
                        true => place.to_part_axes(&turn),
                        false => Vector3::zeros(),
                    },
                }
            };
            if self.turned_by_axes {
                let all = requests.iter().zip(&wrenches).zip(&motions);
                return all
                    .map(|((r, wrench), motion)| {
                        self.by_axes(&mut memory[0], mechanism, r, wrench, motion)
                    })
                    .collect();
            }
            let targets = match self.course {
                Some(_) => None,
                None => targets(&machine, &poses, &wrenches, self.corrected),
            };
            if let Some(targets) = targets {
                let all = places.iter().zip(&targets);
                return all
                    .map(|(programmed, target)| Ok(correction(programmed, target)))
                    .collect();
            }
            let all = places.iter().zip(&poses).zip(&wrenches).enumerate();
            all.map(|(i, ((programmed, pose), wrench))| {
                if let Some(posture) = standing(i) {
                    memory[0].stand_at(posture);
                }
                memory[0]
                    .target(mechanism, pose, wrench, orientation, self.corrected)
                    .map(|posture| correction(programmed, posture.target()))
                    .map_err(|error| FieldFailure::new(cause_and_advice(&error)))
            })
            .collect()
        })
        .collect()
    }
}

/// Poses to command for places along a path. A place at which one block ends and the next begins is solved once.
fn targets(
    machine: &AlongPath,
    poses: &[Pose],
    wrenches: &[Wrench],
    corrected: Directions,
) -> Option<Vec<Pose>> {
    let mut answer_of = Vec::with_capacity(poses.len());
    let (mut places, mut loads) = (Vec::new(), Vec::new());
    for (pose, wrench) in poses.iter().zip(wrenches) {
        if places.last() != Some(pose) || loads.last() != Some(wrench) {
            places.push(*pose);
            loads.push(*wrench);
        }
        answer_of.push(places.len() - 1);
    }
    let found = machine.targets(&places, &loads, corrected)?;
    Some(answer_of.into_iter().map(|k| found[k]).collect())
}

/// Steps of the iteration for the angles of rotary axes: each is exact to the share by which the deflection changes with them.
const STEPS: usize = 8;

/// Angles that change by less are found, rad.
const SAME_RAD: f64 = 1e-10;

fn rotary(motion: &Move) -> Option<&RotaryTurn> {
    motion.tool_turn.as_ref()?.rotary.as_ref()
}

impl ModelField<'_> {
    /// The correction on a machine whose rotary axes turn tool and part: the tip exactly, and the tool's axis as far as these axes
    /// can turn it. Only the position is corrected at a place without their angles.
    fn by_axes(
        &self,
        memory: &mut Neighbour,
        mechanism: &Mechanism,
        request: &Request,
        wrench: &Wrench,
        measured: &FrameMotion,
    ) -> Result<Correction, FieldFailure> {
        let failed = |error: Error| FieldFailure::new(cause_and_advice(&error));
        let path = self.load.path();
        let motion = &path.moves[request.move_index];
        let placed = |angles: Option<&[f64]>| match (angles, rotary(motion)) {
            (Some(angles), Some(rotary)) => {
                let place = self.placement.turned(Some(&rotary.axes.part(angles)));
                (place, place.orientation_of(Some(rotary.axes.tool(angles))))
            }
            _ => (
                self.placement.on(motion, request.share),
                self.placement.orientation_on(motion, request.share),
            ),
        };
        let wanted_mm = request.position_mm + measured.shift_mm;
        let Some(rotary) = rotary(motion) else {
            let (place, orientation) = placed(None);
            let pose = place.pose(&wanted_mm, orientation);
            let (target, _) = memory
                .target_and_tool(mechanism, &pose, wrench)
                .map_err(failed)?;
            let shift = target.translation.vector - pose.translation.vector;
            let shift_mm = measured.shift_mm + place.to_program(&shift);
            return Ok(Correction::from(shift_mm));
        };
        let programmed = rotary.angles_deg(request.share);
        let wanted = measured.turn * path.tool_direction(request.move_index, request.share);
        let mut commanded = |angles: &[f64]| {
            let (place, orientation) = placed(Some(angles));
            let pose = place.pose(&wanted_mm, orientation);
            let found = memory.target_and_tool(mechanism, &pose, wrench);
            let (target, tool) = found.map_err(failed)?;
            let shift = place.to_program(&(target.translation.vector - pose.translation.vector));
            Ok((place, tool, measured.shift_mm + shift))
        };
        let mut angles = programmed.clone();
        for _ in 0..STEPS {
            let (place, tool, _) = commanded(&angles)?;
            let reached = place.to_part_axes(&(tool.rotation * path.tool_axis));
            let across = reached.cross(&wanted).cross(&reached);
            let (turns, _) = rotary.axes.turns_for(&angles, &path.tool_axis, &across);
            for (angle, turn) in angles.iter_mut().zip(&turns) {
                *angle += turn.to_degrees();
            }
            if turns.iter().all(|turn| turn.abs() < SAME_RAD) {
                break;
            }
        }
        let turns = angles.iter().zip(&programmed);
        let turns: Vec<f64> = turns.map(|(angle, own)| angle - own).collect();
        let turns = rotary
            .axes
            .gradual_turns(&programmed, &path.tool_axis, &turns);
        let kept = kept_beside_pole(rotary, &programmed, &turns);
        for (angle, (own, turn)) in angles.iter_mut().zip(programmed.iter().zip(&turns)) {
            *angle = own + kept * turn;
        }
        let (_, _, shift_mm) = commanded(&angles)?;
        let turn = rotary.axes.tool(&angles) * rotary.axes.tool(&programmed).inverse();
        Ok(Correction {
            shift_mm,
            turn: turn.scaled_axis(),
        })
    }
}

/// Distances from the pole, as multiples of the rotation of the axes, beyond which all of it is kept, and below which
/// nothing is.
const KEPT: [f64; 2] = [20.0, 4.0];

/// Share of a rotation of the axes that is kept if directions lead the tool past a pole: with another sign of its tilt the written way
/// would pass the pole on the other side, and the axis that turns about it would turn the other way round.
fn kept_beside_pole(rotary: &RotaryTurn, programmed: &[f64], turns_deg: &[f64]) -> f64 {
    let from_pole = rotary.axes.from_pole_rad(programmed);
    let Some(from_pole) = from_pole.filter(|_| rotary.great_circle.is_some()) else {
        return 1.0;
    };
    let turn = turns_deg.iter().map(|turn| turn.to_radians().abs());
    let turn = turn.fold(0.0, larger);
    let [all, nothing] = KEPT.map(|times| times * turn);
    match from_pole {
        _ if from_pole >= all => 1.0,
        _ if from_pole <= nothing => 0.0,
        _ => (from_pole - nothing) / (all - nothing),
    }
}

/// A failure of the core with what a person can do about it.
pub(crate) fn cause_and_advice(error: &Error) -> String {
    let advice = match error {
        Error::Unreachable { .. } | Error::OutsideLimits { .. } => {
            "; move the part (placement) or check the model's limits"
        }
        Error::NotConverged { limit: Some(_), .. } => {
            "; `kinetostat curve` shows how, `kinetostat equilibria` finds the others"
        }
        Error::NotConverged { .. } => {
            "; the load may be beyond what the machine can carry here: check force and moment, or look at `kinetostat deflect` with a part of it"
        }
        Error::FreeDirection { .. } => {
            "; the machine does not hold this direction: check passive joints and platform"
        }
        _ => "",
    };
    format!("{error}{advice}")
}
