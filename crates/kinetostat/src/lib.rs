//! Elastostatics of robots that machine, by virtual joint modelling.
//!
//! A robot is soft: cutting forces, gravity, joint preload and the forced assembly of
//! over-constrained machines bend it. This crate answers how stiff it is here and now, where it goes
//! under a load, whether that equilibrium is stable, what stresses assembly locked in, and what must
//! be commanded so that the tool is where it should be. It does no I/O.
//!
//! # A tour
//!
//! A limb is an ordered product of elementary motions; a mechanism is a graph of platforms joined by
//! limbs. Here is a machine of three PUU legs along x, y and z:
//!
//! ```
//! use kinetostat::*;
//! use nalgebra::{Vector3, vector};
//!
//! let bar = BeamSection::tube(2.1e11, 8.1e10, 0.022, 0.014); // Pa, m
//! let leg = |name: &str, turned: Pose| {
//!     let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 2.8e6); // N/m
//!     drive.home = -0.34;
//!     Chain::builder(name)
//!         .rigid(turned)
//!         .actuator("drive", drive)
//!         .passive_universal("foot joint", Vector3::z(), Vector3::y())
//!         .link("bar", &bar, 0.31)
//!         .passive_universal("head joint", Vector3::y(), Vector3::z())
//!         .translation(vector![0.03, 0.0, 0.0])
//!         .rigid(turned.inverse())
//!         .build()
//! };
//! let third = 2.0 * std::f64::consts::FRAC_PI_3;
//! let mut machine = Mechanism::builder("3-PUU");
//! let tool = machine.platform(Platform::new("tool", Pose::identity()));
//! for (name, turns) in [("x", 0.0), ("y", 1.0), ("z", 2.0)] {
//!     let diagonal = Vector3::repeat(1.0).normalize();
//!     let chain = leg(name, Pose::rotation(diagonal * (third * turns)))?;
//!     machine = machine.limb(Limb {
//!         name: name.into(),
//!         from: 0,
//!         to: tool,
//!         platform_from_tip: Pose::identity(),
//!         nominal: chain.clone(),
//!         actual: chain,
//!     });
//! }
//! let machine = machine.build()?;
//!
//! let t0 = Pose::translation(0.02, -0.01, 0.03);
//! let posture = machine.posture(&t0)?; // actuators commanded for t0
//! let k_c = posture.stiffness()?; // unloaded K_C [R 3.10, 3.13]
//! assert_eq!(k_c.rank(), 6);
//!
//! let cutting = Wrench::new(vector![100.0, -20.0, -30.0], vector![0.5, 1.0, 0.0]); // N, N m
//! let loaded = posture.deflected_by(&cutting)?; // t = f^-1(F | t0) [R 6.28-6.30]
//! assert!(loaded.stable());
//! let linear = k_c.cartesian.compliance().ok_or("singular")? * cutting.0;
//! assert!((loaded.displacement.0 - linear).norm() < 0.02 * linear.norm());
//!
//! let held = posture.wrench_at(&loaded.tool)?; // F = f(t | t0) [R 6.21]
//! assert!((held.wrench.0 - cutting.0).norm() < 1e-6);
//!
//! let position = [true, true, true, false, false, false];
//! let target = compensate(&machine, &t0, &cutting, position, &Settings::default())?; // [R 7.13]
//! assert!(target.left_over.linear().norm() < 1e-12); // the tool is where it should be
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Conventions
//!
//! SI units; linear part before angular; base axes at a stated point; a [`Wrench`] is what the
//! environment applies. `[R 4.16]` is equation 4.16 of the COROUSSO report L1.1; where this crate
//! departs from its print, the comment says so. A physical finding (singular, unstable, redundant,
//! free) is a field of a result; `Err` is a wrong input or a question without an answer.
//!
//! # Order of the modules
//!
//! Dependencies point one way: `spatial, saddle with block_elimination, sparse <- spring, chain <- kinematics, loading <- system
//! with sweep, sweep_factor, sweep_solve <- equilibrium, stiffness, stability <- mechanism, inverse
//! with graph <- platform, platform_step <- posture with network, forward <- assembly, constraints, mobility,
//! near_singular, overcome, platform_curve, platform_path with machine_equilibria, compensation`; and `equilibrium, stability <- reduced, singular_point <-
//! branches with tracer and bifurcation <- jumps, equilibria, critical`.

mod assembly;
pub mod batch;
mod beam;
mod behind;
mod bifurcation;
mod block_elimination;
mod bowing;
mod branches;
mod builder;
mod chain;
mod chain_blocks;
mod compensation;
mod compliance;
mod constraints;
mod critical;
mod curve_matrix;
mod curve_sweep;
mod directions;
mod divergence;
mod elimination;
mod equilibria;
mod equilibrium;
mod error;
mod family;
mod follower;
mod forward;
mod function_load;
mod graded;
mod graded_platforms;
mod graph;
mod graph_check;
mod inverse;
mod jet;
mod jumps;
mod kinematics;
mod krylov;
mod length_law;
mod link;
mod link_load;
mod load_check;
mod load_energy;
mod load_way;
mod loading;
mod logarithm;
mod lost_motion;
mod machine_descent;
mod machine_directions;
mod machine_equilibria;
mod mechanism;
mod mobility;
mod near_singular;
mod nearest;
mod network;
mod no_equilibrium;
pub mod number;
mod orientation_follows;
mod overcome;
mod parallelogram;
mod passive_rules;
mod platform;
mod platform_chain;
mod platform_curve;
mod platform_limb;
mod platform_load;
mod platform_path;
mod platform_step;
mod posture;
mod reduced;
mod report_iteration;
mod saddle;
mod settings;
mod shape_criterion;
mod singular_point;
mod singular_values;
mod sparse;
mod spatial;
mod spring;
mod stability;
mod state_distance;
mod stiffness;
mod strut;
mod sweep;
mod sweep_factor;
mod sweep_solve;
#[cfg(test)]
mod sweep_tests;
mod system;
mod tracer;
mod turned_loads;
mod uniform;

pub use assembly::LinearAssembly;
pub use beam::BeamSection;
pub use bifurcation::{Special, SpecialKind};
pub use bowing::BowingLaw;
pub use branches::{Branch, BranchEnd, CurvePoint, CurveSettings, Curves, follow};
pub use builder::{ActuatorSpec, ChainBuilder};
pub use chain::{
    Actuator, Body, Chain, Coordinate, Drive, Element, Motion, MotionKind, Role, Scale,
};
pub use chain_blocks::ChainBlocks;
pub use compensation::{Compensation, compensate, compensate_from, target_under_load};
pub use compliance::CartesianCompliance;
pub use constraints::{Overconstraint, SelfStress};
pub use critical::{CriticalLoad, CriticalPoint, Judged, critical_load_factor};
pub use directions::{Direction, DirectionKind, Share};
pub use elimination::{Applied, Inapplicable, LoadedClosedForm, Recursion};
pub use equilibria::{Bounds, Equilibria, FoundEquilibrium, SearchSettings, equilibria};
pub use equilibrium::{
    ChainProblem, EndCondition, Equilibrium, Prescribed, Residual, solve_chain, unloaded_tip,
};
pub use error::{Error, Result};
pub use follower::{Follower, PointForce};
pub use function_load::FunctionLoad;
pub use graded::{uneven_in_words, uneven_springs_in_words};
pub use inverse::{LimbPosture, inverse_kinematics};
pub use jumps::Jump;
pub use kinematics::Kinematics;
pub use length_law::{LengthFunction, LengthLaw, LengthResponse};
pub use link::{LinkConvention, LinkElasticity, LinkSpec};
pub use link_load::{LinkLoad, link_loads};
pub use load_check::{TangentCheck, check_tangents};
pub use load_energy::{is_conservative, load_energy};
pub use load_way::LoadLimit;
pub use loading::{Load, NodeLoad, NodeTangent};
pub use logarithm::LogarithmLaw;
pub use machine_equilibria::{MachineEquilibria, MachineFound, SpreadSettings};
pub use mechanism::{Limb, Mechanism, MechanismBuilder, Platform};
pub use near_singular::{NearSingularity, SingularityKind};
pub use orientation_follows::{compensate_following, target_under_load_following};
pub use overcome::OvercomeSpring;
pub use parallelogram::ParallelogramLaw;
pub use passive_rules::{
    Axis, Elimination, eliminate_passive, planar_beam, planar_with_hinge_at_end,
    planar_with_slide_along_x, planar_with_slide_along_y, with_hinge_at, with_hinge_at_end,
    with_hinge_at_root, with_slide, with_spherical_joint_at_end, with_universal_joint_at_end,
};
pub use platform::MechanismState;
pub use platform_curve::{HeldCurve, HeldPoint};
pub use platform_load::PlatformLoad;
pub use platform_path::{MachinePath, PathJump, PathPoint, PathSpecial, PathSpecialKind};
pub use posture::{
    LimbEquilibrium, MechanismEquilibrium, PlatformStability, Posture, UnloadedStiffness,
};
pub use reduced::{LoadPattern, Parameter};
pub use report_iteration::{
    ChainState, IterationOutcome, IterationSettings, ReportIteration, newton_iteration,
    report_iteration,
};
pub use saddle::Inertia;
pub use settings::Settings;
pub use shape_criterion::{ShapeCriterion, shape_criterion};
pub use singular_values::SingularValues;
pub use spatial::{
    CartesianStiffness, Pose, Twist, Wrench, hat, moved, pose_residual, shift_matrix, turn_matrix,
};
pub use spring::{Segment, SpringBlock, SpringLaw};
pub use stability::{ShapeStability, ShapeVerdict};
pub use stiffness::{ChainStiffness, unloaded_stiffness};
pub use strut::{Anchor, Strut};
