//! A machine in equilibrium: where its platforms are, what its limbs carry, how stiff it is there and whether it
//! stays [R 6.21-6.30].

use crate::chain::compliance::{CartesianCompliance, stiffness_against_force};
use crate::chain::directions::{Direction, DirectionKind, Share};
use crate::chain::link_load::{LinkLoad, link_loads};
use crate::chain::problem::{ChainProblem, EndCondition, load_energy};
use crate::chain::residual::{FoundBy, Residual};
use crate::chain::stability::{ShapeStability, TangentMotions};
use crate::chain::stiffness::ChainStiffness;
use crate::error::{Error, Result};
use crate::linalg::sparse::Sparse;
use crate::machine::directions::{
    condensed_directions, none_diverges, others_hold, scaled_directions,
};
use crate::machine::graded::GradedPlatforms;
use crate::machine::participation::{
    lock_nearly_rigid, name_participation, participation_of_limbs,
};
use crate::machine::platform_system::RigidRows;
use crate::machine::platforms::parts::Unknowns;
use crate::machine::platforms::solver::PlatformSolver;
use crate::machine::posture::Posture;
use crate::machine::state::MechanismState;
use crate::model::mechanism::Mechanism;
use crate::number::smaller;
use crate::spatial::{CartesianStiffness, Pose, Twist, Wrench, pose_residual};
use nalgebra::Matrix6;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Stability of the platform.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct PlatformStability {
    /// Every motion of the free platform costs energy, or (see `free`) none; for loads without a potential: it does
    /// not go away (divergence), but see `may_flutter`.
    pub stable: bool,
    /// The loads have no potential, the platform does not go away, but it may swing with growing amplitude
    /// (flutter); whether it does depends on the masses.
    #[cfg_attr(feature = "serde", serde(default))]
    pub may_flutter: bool,
    /// Smallest principal stiffness, N/m (rotations referred to the natural length).
    pub smallest_stiffness_n_per_m: f64,
    /// Number of directions without stiffness.
    pub free: usize,
}

/// State of one limb in an equilibrium.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LimbEquilibrium {
    /// Name of the limb, as in the model.
    pub name: String,
    /// Wrench of the platform on the limb's tip, about it, base axes.
    pub wrench: Wrench,
    /// Coordinates, m or rad, in the chain's order.
    pub coordinates: Vec<f64>,
    /// Torque of every spring coordinate, N or N m; zero for passive joints.
    pub spring_torques: Vec<f64>,
    /// Energy in its springs, J.
    pub energy: f64,
    /// Potential energy of its loads and weights, J; the zero is arbitrary but the same in all
    /// equilibria of a posture. `None` where a load has no potential.
    pub load_energy: Option<f64>,
    /// All its loads have a potential; if not, statements about energy do not hold.
    pub conservative: bool,
    /// Axial load of its elastic links, relative to their Euler loads.
    pub link_loads: Vec<LinkLoad>,
    /// Poses of its nodes, base from node, in the chain's order.
    pub nodes: Vec<Pose>,
    /// Force (N) or torque (N m) of the loads on every actuator.
    pub actuator_forces: Vec<f64>,
    /// Tangent stiffness at its tip.
    pub stiffness: ChainStiffness,
    /// Stability of its shape with the tip held.
    pub stability: ShapeStability,
}

impl LimbEquilibrium {
    /// True if it has no motion while its end is held, so that its end's motions are all that it has.
    fn follows_its_end(&self) -> bool {
        self.stability.stable && self.stability.share_to_buckling.is_none()
    }
}

/// A mechanism in equilibrium: tool, limbs and platforms, with their wrenches, stiffness and stability.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let tube = BeamSection::tube(2.1e11, 8.1e10, 0.12, 0.10); // Pa, m
/// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
/// # let chain = Chain::builder("arm")
/// #     .actuator("shoulder", hinge(2e5))
/// #     .link("upper arm", &tube, 0.6)
/// #     .actuator("elbow", hinge(1e5))
/// #     .link("forearm", &tube, 0.5)
/// #     .build()?;
/// # let home = Pose::translation(1.1, 0.0, 0.0);
/// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
/// let load = Wrench::new(vector![-300.0, 200.0, 90.0], vector![0.0, 8.0, 30.0]); // N, N m
/// let loaded = arm.posture(&home)?.deflected_by(&load)?;
/// // The shoulder's drive carries the moment of the load about its axis, which is the base's z axis.
/// let about_base = load.shifted(&-loaded.tool.translation.vector);
/// assert!((loaded.actuator_forces()[0] - about_base.moment().z).abs() < 1e-6);
/// assert!((loaded.limbs[0].wrench - load).0.norm() < 1e-6, "its only limb carries all of it");
/// // Nothing about it runs away or swings up.
/// assert!(loaded.stable() && loaded.shapes_stable() && !loaded.may_flutter());
/// assert!(loaded.share_to_buckling().is_some_and(|share| share < 0.1));
/// // No force moves it more easily than the softest; what moves most are the drives.
/// let against = loaded.stiffness_against_force(); // N/m
/// let most = loaded.compliance().springs.fixed_view::<3, 3>(0, 0).symmetric_eigenvalues().max(); // m/N
/// assert!((against * most - 1.0).abs() < 1e-3);
/// let aside = Twist::new(vector![0.0, 1e-3, 0.0], vector![0.0, 0.0, 1e-3]); // m, rad
/// assert_eq!(loaded.participation(&arm, &aside)[0].name, "arm: shoulder");
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MechanismEquilibrium {
    /// Pose of the tool platform, base from tool.
    pub tool: Pose,
    /// Motion from the nominal target to that pose.
    pub displacement: Twist,
    /// External wrench on the tool, about its origin, base axes: given (`f^-1`) or found (`f`).
    pub wrench: Wrench,
    /// Energy of all springs and potential of all weights, loads on limbs and on platforms, J, without the
    /// wrench on the tool, whose work it is while the tool is moved. `None` where a load has no
    /// potential.
    pub energy: Option<f64>,
    /// All loads on limbs and the dead wrench on the tool (if it is not held) have a potential; if
    /// not, the machine
    /// may gain energy on a closed path, and stability by stiffness is not all of it.
    pub conservative: bool,
    /// Tangent stiffness of the tool with all other platforms free, at its origin, base axes.
    pub stiffness: CartesianStiffness,
    /// Principal directions of that stiffness, rotations referred to the natural length.
    pub directions: Vec<Direction>,
    /// Natural length, m: what a rotation is multiplied with to be compared with a translation.
    pub length: f64,
    /// Stability of the free platform.
    pub platform: PlatformStability,
    /// Limbs in the mechanism's order.
    pub limbs: Vec<LimbEquilibrium>,
    /// Residual of the conditions of equilibrium.
    pub residual: Residual,
    /// Method by which it was found: a restart may have changed the branch.
    pub found_by: FoundBy,
    /// State from which a neighbouring equilibrium can be started.
    pub state: MechanismState,
    /// Platforms other than the tool keep their places while the tool is held.
    pub(crate) others_hold: bool,
}

impl MechanismEquilibrium {
    /// Tangent compliance of the tool: it exists where the stiffness is infinite (rigid directions)
    /// or zero (free ones).
    #[must_use]
    pub fn compliance(&self) -> CartesianCompliance {
        CartesianCompliance::of(&self.stiffness.matrix, &self.directions, self.length)
    }

    /// Every limb keeps its shape while the tool is held.
    #[must_use]
    pub fn shapes_stable(&self) -> bool {
        self.limbs.iter().all(|l| l.stability.stable)
    }

    /// The motions of the tool are all that the machine has.
    pub(crate) fn moves_with_its_tool(&self) -> bool {
        self.state.platforms.len() == 2 && self.limbs.iter().all(LimbEquilibrium::follows_its_end)
    }

    /// Every limb keeps its shape and the platform its place.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.platform.stable && self.shapes_stable()
    }

    /// True if, under loads without a potential, nothing diverges but the machine may oscillate with growing amplitude
    /// (flutter), which depends on the masses.
    #[must_use]
    pub fn may_flutter(&self) -> bool {
        self.stable()
            && (self.platform.may_flutter || self.limbs.iter().any(|l| l.stability.may_flutter()))
    }

    /// Largest share of the way to buckling `mu` of all limbs; below 1 is stable.
    #[must_use]
    pub fn share_to_buckling(&self) -> Option<f64> {
        self.limbs
            .iter()
            .filter_map(|l| l.stability.share_to_buckling)
            .max_by(f64::total_cmp)
    }

    /// Force (N) that moves the tool's origin by 1 m in its softest direction while the tool may
    /// turn as it likes: what a person who pushes the tool feels. Zero if a direction is free,
    /// negative if the symmetric part of the stiffness lets some force move the tool against itself, infinite
    /// if no force moves it. It says nothing of stability: a tool that runs away may yet be moved along every force,
    /// see [`Self::stable`].
    #[must_use]
    pub fn stiffness_against_force(&self) -> f64 {
        stiffness_against_force(&self.stiffness.symmetric(), &self.directions, self.length)
    }

    /// Forces (N) or torques (N m) of the loads on all actuators, in the mechanism's order.
    #[must_use]
    pub fn actuator_forces(&self) -> Vec<f64> {
        self.limbs
            .iter()
            .flat_map(|l| l.actuator_forces.iter().copied())
            .collect()
    }
}

/// Stiffness, stability and limbs at a solved state.
pub(crate) fn conclude(
    solver: &mut PlatformSolver<'_>,
    residual: Residual,
) -> Result<MechanismEquilibrium> {
    let (tangent, unbalanced) = solver.finish();
    let m = solver.mechanism;
    if let Some(&(.., value)) = tangent.entries.iter().find(|(.., x)| !x.is_finite()) {
        return Err(Error::NotFinite {
            place: m.place(),
            what: "its tangent stiffness".into(),
            value,
        });
    }
    // The unbalanced wrench of a tool under displacement control is what its holder must apply.
    let wrench = match solver.unknowns {
        Unknowns::Displacement => Wrench(-unbalanced[m.tool()].0),
        _ => solver.wrench,
    };
    let stiffness_and_stability: Vec<_> = (0..m.limbs().len())
        .map(|i| solver.stiffness_and_stability(i))
        .collect();
    let limbs = stiffness_and_stability.into_iter().enumerate();
    let limbs =
        limbs.map(|(i, (stiffness, stability))| limb_equilibrium(solver, i, stiffness, stability));
    let limbs: Vec<LimbEquilibrium> = limbs.collect::<Result<_>>()?;
    let outside = potential_of_platforms(solver);
    let energy = limbs.iter().fold(outside, |sum, limb| {
        Some(sum? + limb.energy + limb.load_energy?)
    });
    let conservative = outside.is_some()
        && limbs.iter().all(|l| l.conservative)
        && (solver.unknowns == Unknowns::Displacement
            || m.tool_moment_has_potential(&solver.dead_moment(&wrench)));
    let tool = ToolStiffness::of(solver, tangent, &limbs);
    let (platform, others_hold) = tool.stability(solver, conservative, &limbs);
    let place = solver.state.platforms[m.tool()];
    let mut directions = tool.directions;
    let participation = |twist: &Twist| {
        participation_of_limbs(m, &place, limbs.iter().map(|limb| &limb.stiffness), twist)
    };
    lock_nearly_rigid(&mut directions, solver, participation);
    name_participation(&mut directions, participation);
    Ok(MechanismEquilibrium {
        tool: place,
        displacement: pose_residual(&place, &solver.target),
        conservative,
        energy,
        wrench,
        stiffness: CartesianStiffness {
            matrix: tool.matrix,
        },
        platform,
        others_hold,
        directions,
        length: m.scale().length,
        limbs,
        residual,
        found_by: solver.found_by,
        state: solver.state.clone(),
    })
}

/// State of one limb at a solved state.
fn limb_equilibrium(
    solver: &PlatformSolver<'_>,
    i: usize,
    stiffness: ChainStiffness,
    stability: ShapeStability,
) -> Result<LimbEquilibrium> {
    let limb = &solver.mechanism.limbs()[i];
    let system = solver.limb_system(i);
    let n = limb.actual.coordinate_count();
    let r = limb.actual.actuators().len();
    Ok(LimbEquilibrium {
        load_energy: load_energy_of_limb(solver, i)?,
        conservative: solver.mechanism.loads_conservative(i),
        link_loads: link_loads(&limb.actual, &system.spring_torque),
        nodes: (0..limb.actual.nodes().len())
            .map(|node| system.kinematics.node_pose(node))
            .collect(),
        name: limb.name.clone(),
        wrench: solver.state.wrenches[i],
        coordinates: solver.state.coordinates[i].clone(),
        spring_torques: system.spring_torque.clone(),
        energy: system.energy,
        actuator_forces: system.torque[n..n + r].to_vec(),
        stiffness,
        stability,
    })
}

/// Potential of what acts on a limb between its ends, J; `None` where a load has none.
fn load_energy_of_limb(solver: &PlatformSolver<'_>, i: usize) -> Result<Option<f64>> {
    let limb = &solver.mechanism.limbs()[i];
    let joints = &solver.posture[i];
    let loaded = ChainProblem {
        chain: &limb.actual,
        base: solver.state.platforms[limb.from],
        commands: joints.commands.clone(),
        posture: joints.coordinates.clone(),
        loads: solver.loads[i].clone(),
        end: EndCondition::pose(solver.limb_system(i).kinematics.tip_pose()),
    };
    load_energy(&loaded, &solver.state.coordinates[i])
}

/// Energy of springs and loads and of the wrench on the tool at the evaluated state, J; `None` where a load has no potential.
pub(crate) fn potential(solver: &PlatformSolver<'_>) -> Option<f64> {
    let limbs = (0..solver.mechanism.limbs().len())
        .map(|i| Some(solver.limb_system(i).energy + load_energy_of_limb(solver, i).ok()??));
    let place = solver.state.platforms[solver.mechanism.tool()]
        .translation
        .vector;
    let tool = solver.wrench.moment() == nalgebra::Vector3::zeros();
    let tool = tool.then(|| -solver.wrench.force().dot(&place));
    let outside = [potential_of_platforms(solver), tool].into_iter();
    limbs.chain(outside).sum()
}

/// Potential of weights, dead forces and compensators on the platforms, J; `None` where one has none.
fn potential_of_platforms(solver: &PlatformSolver<'_>) -> Option<f64> {
    let m = solver.mechanism;
    let poses = &solver.state.platforms;
    let weights = m.platforms().iter().zip(poses).skip(1).map(|(p, pose)| {
        let centre = pose * nalgebra::Point3::from(p.centre_of_mass);
        -p.mass * m.gravity().dot(&centre.coords)
    });
    let weights: f64 = weights.sum();
    // A dead force has a potential; a dead moment is not required to have one here.
    let dead = solver.others.iter().map(|(platform, wrench)| {
        let place = poses[*platform].translation.vector;
        (wrench.moment() == nalgebra::Vector3::zeros()).then(|| -wrench.force().dot(&place))
    });
    let between = m.platform_loads().iter().map(|load| load.energy(poses));
    let outside = dead.chain(between).sum::<Option<f64>>();
    outside.map(|outside| outside + weights)
}

/// Tangent stiffness of a machine at its tool, and the whole tangent from which it comes.
struct ToolStiffness {
    /// Tangent of all moving platforms, 6P x 6P.
    tangent: Sparse,
    rigid: RigidRows,
    graded: Option<GradedPlatforms>,
    /// Stiffness of the tool with all other platforms free, 6 x 6.
    matrix: Matrix6<f64>,
    directions: Vec<Direction>,
}

impl ToolStiffness {
    fn of(solver: &PlatformSolver<'_>, tangent: Sparse, limbs: &[LimbEquilibrium]) -> Self {
        let m = solver.mechanism;
        let scale = m.scale();
        let rigid = match m.platforms().len() {
            2 => RigidRows::none(1),
            _ => solver.rigid_rows(&solver.state).0,
        };
        let own: Vec<&ChainStiffness> = limbs.iter().map(|limb| &limb.stiffness).collect();
        let graded = solver.graded(&tangent, &own);
        // With platforms in between, what blocks the tool is not one limb's affair.
        let (matrix, directions) = if m.platforms().len() > 2 {
            condensed_directions(&tangent, graded.as_ref(), &rigid, m.tool() - 1, scale)
        } else {
            let mut matrix = Matrix6::zeros();
            for &(i, j, value) in &tangent.entries {
                matrix[(i, j)] += value;
            }
            let own = own.into_iter().zip(m.limbs()).map(|(limb, description)| {
                let arm = solver.state.platforms[m.tool()].rotation
                    * description.platform_from_tip.translation.vector;
                (limb, arm, description.actual.scale())
            });
            let directions = scaled_directions(&matrix, graded.as_ref(), scale, own);
            (matrix, directions)
        };
        Self {
            tangent,
            rigid,
            graded,
            matrix,
            directions,
        }
    }

    /// Stability of the tool's platform, and true if the other platforms are stable while the tool is held.
    fn stability(
        &self,
        solver: &PlatformSolver<'_>,
        conservative: bool,
        limbs: &[LimbEquilibrium],
    ) -> (PlatformStability, bool) {
        let m = solver.mechanism;
        let (tool, scale) = (m.tool() - 1, m.scale());
        let (tangent, rigid, directions) = (&self.tangent, &self.rigid, &self.directions);
        let stiffnesses = directions.iter().map(|d| d.stiffness_n_per_m);
        let least = stiffnesses.fold(f64::INFINITY, smaller);
        let free = directions.iter().filter(|d| d.kind == DirectionKind::Free);
        let all = limbs.iter().all(LimbEquilibrium::follows_its_end);
        let motions = TangentMotions::all_if(all);
        let hold = |held| others_hold(tangent, self.graded.as_ref(), rigid, tool, scale, held);
        let stays = |held| {
            !conservative && none_diverges(tangent, directions, rigid, tool, scale, held, motions)
        };
        let held = solver.unknowns == Unknowns::Displacement;
        let definite = least >= 0.0 && hold(held);
        let stable = definite || stays(held);
        let platform = PlatformStability {
            stable,
            may_flutter: stable && !definite,
            smallest_stiffness_n_per_m: least,
            free: free.count(),
        };
        (platform, hold(true) || stays(true))
    }
}

impl Posture {
    /// `f(t | t0)`: the wrench that holds the tool at `pose` [R 6.21].
    ///
    /// # Errors
    /// [`Error::NotConverged`], for instance for a pose that the limbs cannot follow.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let tube = BeamSection::tube(2.1e11, 8.1e10, 0.12, 0.10); // Pa, m
    /// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
    /// # let chain = Chain::builder("arm")
    /// #     .actuator("shoulder", hinge(2e5))
    /// #     .link("upper arm", &tube, 0.6)
    /// #     .actuator("elbow", hinge(1e5))
    /// #     .link("forearm", &tube, 0.5)
    /// #     .build()?;
    /// # let home = Pose::translation(1.1, 0.0, 0.0);
    /// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let posture = arm.posture(&home)?;
    /// let aside = spatial::moved(&home, &Twist::new(vector![0.0, 1e-3, 0.0], Vector3::zeros()));
    /// let held = posture.wrench_at(&aside)?;
    /// assert!(held.wrench.force().y > 0.0, "it takes a force to hold it there");
    /// # Ok::<(), Error>(())
    /// ```
    pub fn wrench_at(&self, pose: &Pose) -> Result<MechanismEquilibrium> {
        self.finite("the pose", pose.to_homogeneous().iter())?;
        let mut state = self.rest_state();
        state.platforms[self.mechanism.tool()] = *pose;
        let mut solver = self.solver(state, Unknowns::Displacement);
        let residual = solver.solve_robustly()?;
        conclude(&mut solver, residual)
    }
}

impl MechanismEquilibrium {
    /// Participation as by [`UnloadedStiffness::participation`](crate::UnloadedStiffness::participation), under load.
    #[must_use]
    pub fn participation(&self, mechanism: &Mechanism, twist: &Twist) -> Vec<Share> {
        let limbs = self.limbs.iter().map(|limb| &limb.stiffness);
        participation_of_limbs(mechanism, &self.tool, limbs, twist)
    }
}
