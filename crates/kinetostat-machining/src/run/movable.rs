//! A program whose places are solved wherever the part lies.
//!
//! Data that do not depend on the placement (places along the path, compiled machines, headings of the load) are made once, so
//! that a few of its places take a millisecond somewhere else.

use kinetostat::{Error, Pose, Wrench};
use nalgebra::Vector3;

use crate::field::cause_and_advice;
use crate::joints::JointFigures;
use crate::load::along_path::LoadAlongPath;
use crate::measured_frame::{MeasuredFrame, PartPlace};
use crate::placement::Placement;
use crate::postures::neighbour::{CHUNK, Neighbour, in_chunks};
use crate::result::point::{PointKind, PointResult};
use crate::run::first_look::FirstLook;
use crate::run::joints::joints_result;
use crate::run::points::{Machines, Solving, chunk, failed};
use crate::run::preparation::{has_motion, load};
use crate::run::sites::of_path::sites_of_path;
use crate::run::sites::site::Site;
use crate::task::{NoMotion, RunError, Task};
use crate::watch::Watch;

/// A program whose places are solved wherever the part lies.
pub struct MovableProgram<'t, 'm> {
    task: &'t Task<'m>,
    load: LoadAlongPath<'m>,
    machines: Machines<'t, 'm>,
    sites: Vec<Site>,
    /// Every so many places of the program are among them.
    every: usize,
}

/// Reachability of a place.
#[derive(Clone, Debug)]
pub enum Reach {
    /// Reached, inside the limits of the joints.
    Reached,
    /// Not reached, or not inside the limits.
    Refused {
        /// True beyond the limits of a joint, and not out of reach.
        by_limits: bool,
        /// Error in words.
        message: String,
    },
}

impl<'t, 'm> MovableProgram<'t, 'm> {
    /// The places at which a program is looked at as it is given, at most about `most`. The load comes and goes as where the
    /// task has the part.
    ///
    /// # Errors
    /// [`RunError::NoMotion`], [`RunError::Cancelled`].
    pub fn new(task: &'t Task<'m>, most: usize, watch: &dyn Watch) -> Result<Self, RunError> {
        has_motion(task)?;
        let load = load(task);
        let looked = FirstLook::new(task, &load, watch)?;
        let load = load.ramped(looked.stiffness()).acting;
        let sites = || sites_of_path(task, &load);
        let total = sites().count();
        if total == 0 {
            return Err(RunError::NoMotion(NoMotion::NoLength));
        }
        let every = total.div_ceil(most.max(1));
        let sites = sites().step_by(every).collect();
        Ok(Self {
            machines: Machines::new(task),
            task,
            load,
            sites,
            every,
        })
    }

    /// Number of places.
    #[must_use]
    #[allow(clippy::len_without_is_empty)]
    pub fn len(&self) -> usize {
        self.sites.len()
    }

    /// Every so many places of the program are among them: 1 where all are.
    #[must_use]
    pub fn every(&self) -> usize {
        self.every
    }

    /// Line of the program at a place, from 1.
    #[must_use]
    pub fn line(&self, index: usize) -> usize {
        self.sites[index].line
    }

    /// Desired position of the tool at a place, program coordinates, mm.
    #[must_use]
    pub fn position_mm(&self, index: usize) -> Vector3<f64> {
        self.sites[index].desired
    }

    /// True if the tool moves at feed there.
    #[must_use]
    pub fn at_feed(&self, index: usize) -> bool {
        self.sites[index].kind != PointKind::Rapid
    }

    /// Pose of the tool at a place, where the program lies so, base from tool, m.
    #[must_use]
    pub fn tool_pose(&self, placement: Placement, index: usize) -> Pose {
        let site = &self.sites[index];
        let motion = &self.task.path().moves[site.move_index];
        let lies = placement.on(motion, site.share);
        lies.pose(&site.desired, lies.orientation_of(site.orientation))
    }

    fn task_at(&self, placement: Placement) -> Task<'m> {
        let mut task = self.task.clone();
        task.placement = placement;
        task
    }

    fn sites_at(&self, placement: &Placement, indices: &[usize]) -> Vec<Site> {
        let moved = |&index: &usize| {
            let site = &self.sites[index];
            let wrench = self.load.wrench(placement, site.move_index, site.share);
            Site {
                wrench,
                ..site.clone()
            }
        };
        indices.iter().map(moved).collect()
    }

    /// Solves some places in the order of the program without compensation, for this placement of it.
    ///
    /// # Errors
    /// Position in `indices` of the first that has no answer, and why.
    pub fn points(
        &self,
        placement: Placement,
        indices: &[usize],
    ) -> Result<Vec<PointResult>, (usize, RunError)> {
        let task = self.task_at(placement);
        let sites = self.sites_at(&placement, indices);
        let frame = MeasuredFrame::of(&task, None).map_err(|error| (0, error))?;
        let figures = JointFigures::new(task.mechanism, &task.bounds.ratings);
        let of_one_tool = sites.chunk_by(|a, b| self.machines.same(a, b));
        let mut points = Vec::with_capacity(sites.len());
        for run in of_one_tool {
            let (machine, orientation) = self.machines.at(&run[0]);
            let how = Solving {
                orientation,
                written: false,
                course: None,
                frame: &frame,
            };
            let first = points.len();
            let solved = in_chunks(run, |memory, sites| {
                chunk(&task, machine, memory, sites, how)
            });
            // A chunk ends with its first failure, so that later ones would not stand at their numbers.
            for (offset, point) in solved.into_iter().enumerate() {
                let mut point = point.map_err(|error| (first + offset, error))?;
                figures.fill(&mut point);
                points.push(point);
            }
        }
        Ok(points)
    }

    /// Size of the correction of the tool's place that compensation would command at some places, mm of the program.
    ///
    /// # Errors
    /// Position in `indices` of the first that has no answer, and why.
    pub fn corrections_mm(
        &self,
        placement: Placement,
        indices: &[usize],
    ) -> Result<Vec<f64>, (usize, RunError)> {
        let sites = self.sites_at(&placement, indices);
        let task = self.task_at(placement);
        let frame = MeasuredFrame::of(&task, None).map_err(|error| (0, error))?;
        let mut sizes = Vec::with_capacity(sites.len());
        for run in sites.chunk_by(|a, b| self.machines.same(a, b)) {
            let (machine, orientation) = self.machines.at(&run[0]);
            for sites in run.chunks(CHUNK) {
                let first = sizes.len();
                let programmed = |s: &Site| s.programmed(s.placement(&task));
                let places: Vec<PartPlace> = sites.iter().map(programmed).collect();
                let corrected = task.corrected;
                let own = task.mechanism_on(sites[0].line);
                let motions = frame.motions(own, &places, |_| None).into_iter();
                let wanted = places.iter().zip(motions).enumerate();
                let wanted = wanted.map(|(i, (place, motion))| {
                    let motion = motion.map_err(|cause| (first + i, failed(&sites[i], cause)))?;
                    Ok(place.corrected(&motion, corrected).pose())
                });
                let poses = wanted.collect::<Result<Vec<Pose>, _>>()?;
                let wrenches: Vec<Wrench> = sites.iter().map(|s| s.wrench).collect();
                let targets = match machine.targets(&poses, &wrenches, corrected) {
                    Some(targets) => targets,
                    None => {
                        let mut memory = Neighbour::default();
                        let mechanism = machine.mechanism();
                        let mut target = |i: usize| {
                            let (pose, wrench) = (&poses[i], &wrenches[i]);
                            let found =
                                memory.target(mechanism, pose, wrench, orientation, corrected);
                            let found = found.map(|found| *found.target());
                            found.map_err(|cause| (first + i, failed(&sites[i], cause)))
                        };
                        let all = (0..sites.len()).map(&mut target);
                        all.collect::<Result<Vec<Pose>, _>>()?
                    }
                };
                for (programmed, target) in places.iter().zip(&targets) {
                    let shift = target.translation.vector - programmed.pose().translation.vector;
                    sizes.push(programmed.place.to_program(&shift).norm());
                }
            }
        }
        Ok(sizes)
    }

    /// Reachability of a place for such a placement of the program, from home and without a load.
    #[must_use]
    pub fn reach(&self, placement: Placement, index: usize) -> Reach {
        let site = &self.sites[index];
        let (machine, orientation) = self.machines.at(site);
        let pose = self.tool_pose(placement, index);
        let found = orientation.posture(machine.mechanism(), &pose, None);
        match found.and_then(|posture| posture.within_limits()) {
            Ok(()) => Reach::Reached,
            Err(error) => Reach::Refused {
                by_limits: matches!(error, Error::OutsideLimits { .. }),
                message: cause_and_advice(&error),
            },
        }
    }

    /// Number of changes of the machine's posture on feed moves along all places, which no feed motion can do; and the line of the first.
    #[must_use]
    pub fn posture_changes(
        &self,
        placement: Placement,
        points: &[PointResult],
    ) -> Option<(usize, usize)> {
        let found = joints_result(&self.task_at(placement), points);
        let first = found.changes.first()?;
        Some((found.change_count, first.line))
    }
}
