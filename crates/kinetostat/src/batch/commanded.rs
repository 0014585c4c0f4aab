//! Machines that are built with other numbers than one that is drawn, and commanded as that one.
//!
//! Where such a machine is commanded depends on the drawing alone: the plans without load are compiled once, and so are
//! the joints of every posture found once ([`Commanded`]). What is left for each machine is its own springs and errors.

use std::sync::Arc;

use crate::batch::compiled::{BLOCKS, Batch, compiled, in_parallel, unburdened};
use crate::batch::equilibria::{BatchEquilibrium, Details, pose};
use crate::batch::machine::group::{Places, Standing};
use crate::batch::plan::steps::Plan;
use crate::batch::run::Job;
use crate::batch::table::{BLOCK, Table};
use crate::error::Result;
use crate::model::mechanism::Mechanism;
use crate::parallel;
use crate::spatial::{Pose, Wrench, pose_residual};

/// Poses that a machine is commanded to, with the joints that lead there as it is drawn.
#[derive(Clone, Debug)]
pub struct Commanded {
    pub(crate) poses: Vec<Pose>,
    /// Joints of each pose, limb after limb: commands, passive joints; NaN where no search of the kernels leads there.
    pub(crate) joints: Table,
    /// Plans to which the joints belong; `None` where no kernel supports the machine.
    pub(crate) of: Option<Arc<[Plan]>>,
    /// Equilibrium of the actual machine under a load, with the wrenches on its limbs' tips.
    pub(crate) standing: Option<Box<Standing>>,
}

impl Commanded {
    /// The poses.
    #[must_use]
    pub fn poses(&self) -> &[Pose] {
        &self.poses
    }

    /// Places with the joints if they are those of a batch, else the poses alone; `deviations` as
    /// [`Batch::equilibrium_foretold_into`] has them.
    pub(crate) fn places<'a>(&'a self, batch: &Batch, deviations: &'a [f64]) -> Places<'a> {
        match (&self.of, &batch.nominal) {
            (Some(ours), Ok(theirs)) if Arc::ptr_eq(ours, theirs) => Places::Known {
                poses: &self.poses,
                joints: &self.joints,
                standing: self.standing.as_deref(),
                deviations,
                first: 0,
            },
            _ => Places::Poses(&self.poses),
        }
    }
}

impl Commanded {
    /// Learns how the equilibria go along with one more number of the machine, from a machine with more of it and one with less,
    /// each with the wrenches on its tool, that lie `apart` in that number. Places that have no equilibrium there go along with nothing.
    ///
    /// # Errors
    /// As [`Batch::equilibrium`].
    pub fn go_along(
        &mut self,
        more: LoadedBatch<'_>,
        less: LoadedBatch<'_>,
        apart: f64,
    ) -> Result<()> {
        let at = |own: LoadedBatch<'_>| {
            let places = self.places(own.batch, &[]);
            own.batch.standing(&places, own.wrenches)
        };
        let (more, less) = (at(more)?, at(less)?);
        let Some(standing) = &mut self.standing else {
            return Ok(());
        };
        let count = self.poses.len();
        let widths = [6, more.coordinates.width(), more.wrenches.width()];
        let mut slope = Table::default();
        slope.reset(widths.iter().sum(), count);
        for i in 0..count {
            let moved = pose_residual(&pose(&more.tool, i), &pose(&less.tool, i));
            let between = |of: fn(&Standing) -> &Table| {
                let rows = of(&more).row(i).zip(of(&less).row(i));
                rows.map(|(more, less)| more - less)
            };
            let rest = between(|s| &s.coordinates).chain(between(|s| &s.wrenches));
            let numbers: Vec<f64> = (moved.0.iter().copied().chain(rest))
                .map(|x| x / apart)
                .collect();
            let known = numbers.iter().all(|x| x.is_finite());
            slope.set_row(i, |k| if known { numbers[k] } else { 0.0 });
        }
        standing.slopes.push(slope);
        Ok(())
    }
}

/// Machine with the wrenches on its tool.
#[derive(Clone, Copy, Debug)]
pub struct LoadedBatch<'a> {
    /// The machine.
    pub batch: &'a Batch,
    /// Wrench at each of the places, N and N m.
    pub wrenches: &'a [Wrench],
}

impl Batch {
    /// Finds the joints that lead to `poses`, for this machine and for all that are [`Self::built`] with other numbers.
    #[must_use]
    pub fn commanded(&self, poses: &[Pose]) -> Commanded {
        let mut joints = Table::default();
        let of = self.nominal.as_ref().ok();
        if let Some(nominal) = of {
            let width = nominal.iter().map(|p| p.commands + p.passive.len()).sum();
            joints.reset(width, poses.len());
            let parts = joints.parts(BLOCKS).enumerate();
            let jobs = parts.map(|(k, joints)| {
                let from = k * BLOCKS * BLOCK;
                Job::Joints {
                    nominal,
                    poses: &poses[from..(from + BLOCKS * BLOCK).min(poses.len())],
                    joints,
                }
            });
            in_parallel(jobs, poses.len());
        }
        Commanded {
            poses: poses.to_vec(),
            joints,
            of: of.cloned(),
            standing: None,
        }
    }

    /// Prepares many machines that are loaded about like this one by `wrenches`: their equilibria are searched from
    /// that of this one, or from those predicted by derivatives ([`Commanded::go_along`]), with the corrections of this
    /// one, to the accuracy of a path, a millionth of a tenth of a micrometre.
    ///
    /// # Errors
    /// See [`Self::equilibrium`].
    pub fn commanded_under(&self, poses: &[Pose], wrenches: &[Wrench]) -> Result<Commanded> {
        let mut commanded = self.commanded(poses);
        let standing = self.standing(&commanded.places(self, &[]), wrenches)?;
        commanded.standing = Some(Box::new(standing));
        Ok(commanded)
    }

    /// A machine that is built with other numbers, and commanded as this one is drawn ([`Mechanism::commanded_as`]).
    ///
    /// ```
    /// use kinetostat::batch::{Batch, BatchEquilibrium, Details};
    /// use kinetostat::nalgebra::{Vector3, vector};
    /// use kinetostat::{ActuatorSpec, Chain, Mechanism, MotionKind, Pose, Wrench};
    ///
    /// let gantry = |drive: f64| {
    ///     let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, drive); // N/m
    ///     let chain = Chain::builder("gantry")
    ///         .actuator("x", slide(Vector3::x()))
    ///         .actuator("y", slide(Vector3::y()))
    ///         .build()?;
    ///     Mechanism::serial(chain, Pose::identity(), Vector3::zeros())
    /// };
    /// let drawn = Batch::new(&gantry(5e7)?);
    /// let places = drawn.commanded(&[Pose::translation(0.1, 0.2, 0.0)]);
    /// let mut found = BatchEquilibrium::default();
    /// for drive in [4.9e7, 5.1e7] {
    ///     let load = [Wrench::new(vector![500.0, 0.0, 0.0], Vector3::zeros())]; // N
    ///     drawn.built(&gantry(drive)?)?.equilibrium_commanded_into(&places, &load, Details::Rest, &mut found)?;
    ///     let moved = found.tool_pose(0).translation.x - places.poses()[0].translation.x;
    ///     assert!((moved - 500.0 / drive).abs() < 1e-15);
    /// }
    /// # Ok::<(), kinetostat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Mechanism::commanded_as`].
    pub fn built(&self, machine: &Mechanism) -> Result<Self> {
        let mechanism = machine.commanded_as(&self.mechanism)?;
        let actual = unburdened(&mechanism).and_then(|()| compiled(&mechanism, |l| &l.actual));
        Ok(Self {
            mechanism,
            // Compiled of chains that are the drawing's.
            nominal: self.nominal.clone(),
            actual,
            along: self.along,
            buffers: self.buffers.shared(),
        })
    }

    /// Solves like [`Self::equilibrium_into`], with known joints.
    ///
    /// # Errors
    /// See [`Self::equilibrium`].
    pub fn equilibrium_commanded_into(
        &self,
        places: &Commanded,
        wrenches: &[Wrench],
        details: Details,
        out: &mut BatchEquilibrium,
    ) -> Result<()> {
        self.equilibrium_foretold_into(places, &[], wrenches, details, out)
    }

    /// Solves a machine whose numbers differ from those of the drawing by `deviations`, in the order in which
    /// [`Commanded::go_along`] has learnt of them: the search starts from the prediction by derivatives.
    ///
    /// # Errors
    /// See [`Self::equilibrium`].
    pub fn equilibrium_foretold_into(
        &self,
        places: &Commanded,
        deviations: &[f64],
        wrenches: &[Wrench],
        details: Details,
        out: &mut BatchEquilibrium,
    ) -> Result<()> {
        self.loaded(&places.places(self, deviations), wrenches, details, out)
    }
}

/// Computes the same of `count` machines: `machine(i)` makes the i-th, which is compiled, given to
/// `compute` and dropped, so that memory does not grow with their number. Machines are spread over the
/// threads, the postures of each over the lanes. Answers are in order, and one machine's
/// answer depends on no other machine and not on the number of threads; a machine that cannot be
/// made or computed leaves the others alone.
///
/// ```
/// use kinetostat::batch::over_machines;
/// # use kinetostat::{ActuatorSpec, Chain, Mechanism, MotionKind, Pose};
/// # use nalgebra::{Matrix6, Vector3};
/// // An arm whose drive is 1 % softer with every draw.
/// let arm = |i: usize| {
///     let drive = ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), 1e6 * 0.99_f64.powi(i as i32));
///     let chain = Chain::builder("arm")
///         .actuator("joint", drive)
///         .translation(Vector3::new(0.5, 0.0, 0.2))
///         .spring6("link", &Matrix6::from_diagonal_element(1e7), [0.0; 6])
///         .build()?;
///     Mechanism::serial(chain, Pose::translation(0.5, 0.0, 0.2), Vector3::zeros())
/// };
/// let across = over_machines(100, arm, |_, batch| {
///     Ok(batch.stiffness_at_joints(&[0.0])?.stiffness.get(0, 7))
/// });
/// let first = across[0].as_ref().unwrap();
/// assert!(across.iter().all(|k| k.as_ref().unwrap() <= first));
/// ```
///
/// # Errors
/// Of each machine its own.
pub fn over_machines<T: Send>(
    count: usize,
    machine: impl Fn(usize) -> Result<Mechanism> + Sync,
    compute: impl Fn(usize, &Batch) -> Result<T> + Sync,
) -> Vec<Result<T>> {
    parallel::map((0..count).collect(), |i| {
        let own = machine(i)?;
        compute(i, &Batch::new(&own))
    })
}
