//! `kinetostat._core`: machines and commands for Python.
//!
//! Arrays come and go as float64 in SI units. Quantities are documented in the Python package (`python/kinetostat`);
//! here are conversions, threads, interruption and errors, and no arithmetic of mechanics.

#![allow(
    unsafe_code,
    reason = "pyo3's macros write it; there is none of our own"
)]

mod arrays;
mod batch;
mod chatter;
mod columns;
mod command;
mod elsewhere;
mod equilibrium;
mod errors;
mod kinematics;
mod machine;
mod map;
mod plausibility;
mod posture;
mod program;
mod stiffness;
mod tolerance;
mod vibration;
mod viewed;
mod warnings;
mod work;

use pyo3::prelude::*;

#[pymodule]
mod _core {
    #[pymodule_export]
    use crate::batch::{equilibrium_of_many, stiffness_of_many, targets_of_many};
    #[pymodule_export]
    use crate::chatter::{coupled_limit_of, lobes_of, multipliers_of};
    #[pymodule_export]
    use crate::command::{command_tree, run_as_process, run_command};
    #[pymodule_export]
    use crate::elsewhere::poses_following;
    #[pymodule_export]
    use crate::equilibrium::Equilibrium;
    #[pymodule_export]
    use crate::kinematics::{
        frame_names, frames_of, frames_of_many, gradients_of, inverse_solutions, limb_coordinates,
        limb_hessian, limb_jacobian, limb_springs,
    };
    #[pymodule_export]
    use crate::machine::{Machine, preset_names, urdf_to_toml};
    #[pymodule_export]
    use crate::map::{evaluate_many, map_variables};
    #[pymodule_export]
    use crate::posture::Posture;
    #[pymodule_export]
    use crate::program::correct_program;
    #[pymodule_export]
    use crate::stiffness::Stiffness;
    #[pymodule_export]
    use crate::tolerance::{drawn_numbers, sobol_design, sobol_of_answers, tolerance_of_machine};
    #[pymodule_export]
    use crate::vibration::{Vibration, vibration_of};
    #[pymodule_export]
    use crate::viewed::Viewed;
    #[pymodule_export]
    use crate::warnings::{answer_warnings, load_warnings, tool_warnings};
    #[pymodule_export]
    use crate::work::forked;

    /// Looks numpy's functions up at once: the first look for them must not meet a Ctrl-C that waits.
    #[pymodule_init]
    fn init(module: &pyo3::Bound<'_, pyo3::types::PyModule>) -> pyo3::PyResult<()> {
        let _ = numpy::dtype::<f64>(module.py());
        Ok(())
    }

    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");

    /// Largest share of the draws without an answer of which Sobol indices are still said.
    #[pymodule_export]
    const MOST_MISSING: f64 = kinetostat_analysis::tolerance::MOST_MISSING;
}
