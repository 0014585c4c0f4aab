//! On-line compensation: one step of a plan in each cycle of a controller.
//!
//! A controller takes corrections (KUKA RSI, ABB EGM) or code (LinuxCNC), and this crate says what to correct: the elastic deflection of
//! the machine under its own loads, under the force that the program expects, and - slowly - under the part of a measured force that the program did not know.
//! A [`Plan`] is compiled once from a [`kinetostat::Mechanism`]; [`step`] allocates nothing, takes at most [`MOST_PASSES`] passes and never panics.
//!
//! ```
//! use kinetostat::nalgebra::{Vector3, vector};
//! use kinetostat::*;
//! use kinetostat_online::{Command, Input, Mode, Plan, PlanSettings, step};
//!
//! let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
//! let chain = Chain::builder("gantry")
//!     .actuator("x", slide(Vector3::x()))
//!     .actuator("y", slide(Vector3::y()))
//!     .actuator("z", slide(Vector3::z()))
//!     .build()?;
//! let gantry = Mechanism::serial(chain, Pose::identity(), Vector3::zeros())?;
//! let mut settings = PlanSettings::new(1e-3); // s
//! settings.probe = None; // the port vouches for an absolute correction object
//! let plan = Plan::compile(&gantry, &settings)?;
//! let mut state = plan.start()?;
//!
//! let mut input = Input { programmed: Wrench::new(vector![500.0, 0.0, 0.0], Vector3::zeros()), ..Input::default() }; // N
//! for cycle in 1..=100 {
//!     input.sequence = cycle;
//!     input.command = if cycle == 10 { Command::Arm } else { Command::None }; // a person
//!     let output = step(&plan, &mut state, &input);
//!     assert!(cycle > 10 || output.correction == Twist::zero(), "nothing moves before");
//! }
//! assert_eq!(state.mode(), Mode::Active);
//! // The force bends the machine by 10 um along x; the correction points against it.
//! assert!((state.correction().linear().x + 1e-5).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # One cycle
//!
//! 1. Checks: numbers, sequence, age, joints within limits.
//! 2. The sensor's reading becomes the wrench of the process on the tool: offset and weight are removed.
//! 3. The programmed wrench is fed forward; a second-order low pass sees the difference to it alone.
//! 4. The difference is scaled by direction, so that the static loop gain is 0.7 at most for the stated process stiffness.
//! 5. The loaded equilibrium with the tool at its place gives the correction, from the state of the cycle before.
//! 6. The machine of states decides what is sent; size, speed and acceleration are limited.
//!
//! SI units; linear part before angular; base axes at the tool's reference point. A [`kinetostat::Wrench`] is what the environment
//! applies. The correction is the motion from the program's pose to the pose to command. Latency: one cycle, plus the filter's for what the program did not know.
//!
//! # Modules
//!
//! ```text
//! error, settings, probe, supervisor, input   what can be refused, set, sent and found
//! small, low_pass, limiter, gain, sensor, critical_gain   one formula each
//! machine        the machine's joints, springs and platform, on the core's evaluation of chains
//! plan, state    what never changes, and what a cycle changes
//! step           the cycle
//! ```
//!
//! # Not covered
//!
//! Ports and their watchdogs: a correction that nobody renews stays where it was, so that the part that applies it must look at the sequence.
//! Machines with platforms between base and tool; tools that turn as they move. Regenerative chatter and posture-dependent frequencies are not in the
//! predicted critical gain. No number here was measured on a machine.

#![forbid(unsafe_code)]

mod critical_gain;
mod error;
mod gain;
mod input;
mod limiter;
mod low_pass;
mod machine;
mod plan;
mod probe;
mod sensor;
mod settings;
mod small;
mod state;
mod step;
mod supervisor;

pub use critical_gain::SampledLoop;
pub use error::{Error, Result};
pub use gain::LARGEST_LOOP_GAIN;
pub use input::{Clamped, Command, Input, MOST_JOINTS, Output};
pub use machine::equilibrium::MOST_PASSES;
pub use plan::{Plan, Warning};
pub use probe::{Probe, ProbeSettings, Verdict};
pub use settings::{Drive, Limits, PlanSettings, Sensor};
pub use state::State;
pub use step::step;
pub use supervisor::{Mode, Reason};
