//! The model as a field of corrections for the program writer.

use kinetostat::batch::AlongPath;
use kinetostat::{Directions, Error, Mechanism, Pose, Wrench};
use kinetostat_program::{
    Correction, CorrectionField, Course, FieldFailure, Move, Request, Structure,
};
use nalgebra::Vector3;

use crate::load::along_path::LoadAlongPath;
use crate::near::natural_length;
use crate::placement::Placement;
use crate::postures::arm_course::ArmCourse;
use crate::postures::neighbour::in_chunks;
use crate::postures::orientation::Orientation;

/// Answers, for every point of a path, what must be added to the program so that the tool is there
/// under the load of the program.
pub struct ModelField<'a> {
    /// Machine with its tool; with that of [`LoadAlongPath::tool_of`] where there are several.
    pub mechanism: &'a Mechanism,
    /// Where the program lies.
    pub placement: Placement,
    /// Cutting load at every place of the path; it also knows the tool at each.
    pub load: &'a LoadAlongPath<'a>,
    /// What of the pose is corrected.
    corrected: Directions,
    /// How far the correction can be continued to every side, program mm.
    radius_mm: f64,
    /// The way of an arm that is not the one from home.
    course: Option<&'a ArmCourse>,
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
            radius_mm: SMOOTH * 1e3 * natural_length(mechanism) / placement.scale,
            course: None,
        }
    }

    /// The same with what of the tool's pose is corrected: [`Directions::POSITION`], which it does without this, or
    /// [`Directions::ALL`] where the program states the orientation.
    #[must_use]
    pub fn correcting(mut self, directions: Directions) -> Self {
        self.corrected = directions;
        self
    }

    /// The same along the way of an arm, where it is not the one from home.
    pub(crate) fn on_course(mut self, course: Option<&'a ArmCourse>) -> Self {
        self.course = course;
        self
    }

    fn wrench(&self, request: &Request) -> Wrench {
        match request.turning {
            None => self
                .load
                .wrench(&self.placement, request.move_index, request.share),
            Some(turn) => self.load.turning_wrench(
                &self.placement,
                (turn.from_move, turn.from_share),
                (request.move_index, turn.to_share),
                turn.part,
            ),
        }
    }
}

impl CorrectionField for ModelField<'_> {
    fn turns(&self) -> bool {
        true
    }

    fn structure(&self, move_index: usize, _motion: &Move) -> Structure {
        Structure {
            breaks: self.load.breaks(move_index),
            course: Course::Smooth {
                radius_mm: self.radius_mm,
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
            let places: Vec<Placement> = requests
                .iter()
                .map(|r| {
                    let motion = &self.load.path().moves[r.move_index];
                    self.placement.on(motion, r.share)
                })
                .collect();
            let poses: Vec<Pose> = requests
                .iter()
                .zip(&places)
                .map(|(r, place)| place.pose(&r.position_mm, place.orientation_of(r.orientation)))
                .collect();
            let wrenches: Vec<Wrench> = requests.iter().map(|r| self.wrench(r)).collect();
            let turns = self.corrected == Directions::ALL;
            let correction = |place: &Placement, pose: &Pose, target: &Pose| {
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
            let together = || machine.targets(&poses, &wrenches, self.corrected);
            let targets = match self.course {
                Some(_) => None,
                None => together(),
            };
            if let Some(targets) = targets {
                let all = places.iter().zip(&poses).zip(&targets);
                return all
                    .map(|((place, pose), target)| Ok(correction(place, pose, target)))
                    .collect();
            }
            let all = requests.iter().zip(&places).zip(&poses).zip(&wrenches);
            all.map(|(((request, place), pose), wrench)| {
                let course = self.course;
                let on_the_way =
                    course.and_then(|c| c.standing_at(request.move_index, request.share));
                if let Some(posture) = on_the_way {
                    memory[0].stand_at(posture);
                }
                memory[0]
                    .target(mechanism, pose, wrench, (orientation, self.corrected))
                    .map(|posture| correction(place, pose, posture.target()))
                    .map_err(|error| FieldFailure::new(cause_and_advice(&error)))
            })
            .collect()
        })
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
