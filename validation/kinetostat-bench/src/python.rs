//! The extension module `kinetostat_bench`: arrays of f64 come and go as their bytes.

#![allow(
    unsafe_code,
    reason = "pyo3's macros write it; there is none of our own"
)]

use pyo3::prelude::*;

#[pymodule]
mod kinetostat_bench {
    use std::path::PathBuf;
    use std::sync::Mutex;

    use pyo3::exceptions::PyValueError;
    use pyo3::prelude::*;
    use pyo3::types::{PyBytes, PyDict};

    use crate::{BenchQuantity, Places, Results, Task as Own};

    fn refused(error: impl std::fmt::Display) -> PyErr {
        PyValueError::new_err(format!("{error:#}"))
    }

    fn numbers(bytes: &[u8]) -> Vec<f64> {
        let (rows, _) = bytes.as_chunks::<8>();
        rows.iter().map(|b| f64::from_ne_bytes(*b)).collect()
    }

    /// A task for many postures of one machine.
    #[pyclass(frozen)]
    struct Task(Own, Mutex<Results>);

    #[pymethods]
    impl Task {
        /// `work` is one of stiffness, stiffness+jacobian, equilibrium, equilibrium+stiffness. One
        /// of `joints` (commands) and `poses` (rotation matrix row by row, position) is given.
        #[new]
        #[pyo3(signature = (model, work, joints=None, poses=None, wrenches=None))]
        fn new(
            model: PathBuf,
            work: &str,
            joints: Option<&[u8]>,
            poses: Option<&[u8]>,
            wrenches: Option<&[u8]>,
        ) -> PyResult<Self> {
            let quantity = match work {
                "stiffness" => BenchQuantity::Stiffness,
                "stiffness+jacobian" => BenchQuantity::StiffnessAndJacobian,
                "equilibrium" => BenchQuantity::Equilibrium,
                "equilibrium+stiffness" => BenchQuantity::EquilibriumAndStiffness,
                other => return Err(refused(format!("'{other}' is no quantity to compute"))),
            };
            let places = match (joints, poses) {
                (Some(commands), None) => Places::Joints(numbers(commands)),
                (None, Some(poses)) => Places::from_numbers(&numbers(poses)).map_err(refused)?,
                _ => return Err(refused("give joints or poses")),
            };
            let wrenches = wrenches.map(numbers).unwrap_or_default();
            let own = Own::open(&model, quantity, places, &wrenches).map_err(refused)?;
            Ok(Self(own, Mutex::default()))
        }

        /// Reason for which the postures are solved one by one, or None.
        fn scalar_reason(&self) -> Option<String> {
            self.0.scalar_reason()
        }

        /// Goes once through all postures, `block` of them in each call: what is timed.
        fn run(&self, block: usize) -> PyResult<()> {
            let mut results = self.1.lock().map_err(refused)?;
            self.0.run(block, &mut results).map_err(refused)
        }

        /// A dictionary of bytes: tool, coordinates, stiffness, jacobian; and the numbers of postures
        /// that were solved vectorised and not at all.
        fn answers<'py>(&self, py: Python<'py>, block: usize) -> PyResult<Bound<'py, PyDict>> {
            let all = self.0.answers(block).map_err(refused)?;
            let bytes = |numbers: &[f64]| {
                let flat: Vec<u8> = numbers.iter().flat_map(|x| x.to_ne_bytes()).collect();
                PyBytes::new(py, &flat)
            };
            let out = PyDict::new(py);
            out.set_item("tool", bytes(&all.tool))?;
            out.set_item("coordinates", bytes(&all.coordinates))?;
            out.set_item("stiffness", bytes(&all.stiffness))?;
            out.set_item("jacobian", bytes(&all.jacobian))?;
            out.set_item("vectorised", all.vectorised)?;
            out.set_item("not_found", all.not_found)?;
            Ok(out)
        }
    }
}
