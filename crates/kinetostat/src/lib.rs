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
//!     machine = machine.limb(Limb::between(name, 0, tool, chain));
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
//! let target = compensate(&machine, &t0, &cutting, Directions::POSITION, &Settings::default())?; // [R 7.13]
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
//! # Rooms
//!
//! Dependencies point one way, from every room to those above it in this list; a test draws the arrows from the sources
//! (`cargo test --workspace --test arrows`).
//!
//! ```text
//! number, spatial, error, settings   digits in text; poses, twists, wrenches; what can go wrong; tolerances
//! parallel       work on all threads, or on one
//! linalg         bordered systems, singular values, block elimination: knows nothing of robots
//! model          chains and mechanisms, spring laws, loads; Jacobians and Hessians of a chain
//! chain          one chain at one state: its system (dense or by sweeps), stiffness, stability, Newton
//! machine        a mechanism commanded for a target: inverse kinematics, posture, stiffness, platforms
//! continuation   equilibria as one parameter grows, around limit points and through bifurcations; a machine under a load
//! equilibrium    the equilibrium of a chain, all that can be found of a chain or a machine, critical loads
//! compensation   the target to command so that the loaded tool is where it should be
//! batch          many postures at once, one per lane of the processor's vector registers
//! reference      the report's own forms and iterations, for those who check, teach or simplify
//! internal       what this crate's own tests reach inside it: no part of the interface
//! ```
//!
//! # Features
//!
//! All are on by default. `serde`: models and results are written and read. `parallel`: many postures, machines and
//! starts go to all threads. `simd`: the kernels of [`batch`] for vector registers, chosen at run time. The numbers are
//! the same without the last two.

pub mod batch;
pub mod chain;
pub mod compensation;
pub mod continuation;
pub mod equilibrium;
pub mod error;
#[doc(hidden)]
pub mod internal;
pub mod linalg;
pub mod machine;
pub mod model;
pub mod number;
mod parallel;
pub mod reference;
mod settings;
pub mod spatial;

pub use chain::directions::{Direction, DirectionKind};
pub use chain::equilibrium::Equilibrium;
pub use chain::problem::{ChainProblem, EndCondition, Prescribed};
pub use chain::stiffness::{ChainStiffness, unloaded_stiffness};
pub use compensation::target::{Compensation, compensate};
pub use continuation::follow::follow;
pub use continuation::settings::{CurveSettings, Parameter};
pub use equilibrium::all_of_chain::equilibria;
pub use equilibrium::chain::solve_chain;
pub use equilibrium::critical::critical_load_factor;
pub use error::{Error, Place, Result};
pub use machine::equilibrium::MechanismEquilibrium;
pub use machine::posture::Posture;
pub use machine::request::PostureRequest;
pub use machine::stiffness::UnloadedStiffness;
pub use model::actuator::ActuatorSpec;
pub use model::beam::BeamSection;
pub use model::builder::ChainBuilder;
pub use model::chain::Chain;
pub use model::link::LinkSpec;
pub use model::loads::length_law::LengthLaw;
pub use model::loads::load::Load;
pub use model::loads::node_load::NodeLoad;
pub use model::loads::platform::PlatformLoad;
pub use model::loads::strut::Anchor;
pub use model::mechanism::{Limb, Mechanism, Platform};
pub use model::mechanism_builder::MechanismBuilder;
pub use nalgebra;
pub use settings::Settings;
pub use spatial::{CartesianStiffness, Directions, MotionKind, Pose, Twist, Wrench};

/// The examples of the README run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
