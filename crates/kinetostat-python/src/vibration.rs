//! Vibrations of a machine about an equilibrium.

use std::sync::Arc;

use kinetostat::Directions;
use kinetostat::nalgebra::{Complex, DMatrix};
use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_dynamics::{
    Damping, EnergyShare, Error, Held, ModalResponse, Mode, Point, Quantity, Receptance,
};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;

use crate::arrays::{Numbers, array, one_wrench, rows};
use crate::equilibrium::Equilibrium;
use crate::errors::{Class, error, of_core, require_stiffness};
use crate::posture::Posture;
use crate::stiffness::json_of;

/// An error of the dynamics.
pub fn of_dynamics(found: Error) -> PyErr {
    match found {
        Error::Statics(own) => of_core(&own),
        Error::NotSolved(_) => error(Class::Unanswered, found.to_string()),
        _ => error(Class::Argument, found.to_string()),
    }
}

/// Damping as the package writes it, see `kinetostat.Damping`.
pub fn damping(json: &str) -> PyResult<Damping> {
    serde_json::from_str(json)
        .map_err(|e| error(Class::Argument, format!("damping {json}: no such law: {e}")))
}

/// A machine that vibrates about the equilibrium under a load.
#[pyclass(frozen, module = "kinetostat._core")]
pub struct Vibration(Arc<VibratingMachine>);

impl Vibration {
    fn point(&self, name: Option<&str>) -> PyResult<Point> {
        match name {
            None => Ok(self.0.dynamics.tool()),
            Some(name) => self.0.dynamics.place(name).map_err(of_dynamics),
        }
    }

    fn mode(&self, index: usize) -> PyResult<&Mode> {
        let modes = &self.0.modes.modes;
        modes.get(index).ok_or_else(|| {
            let count = modes.len();
            error(
                Class::Argument,
                format!("mode {index} of {count}: count from 0"),
            )
        })
    }
}

fn pairs(shares: Vec<EnergyShare>) -> Vec<(String, f64)> {
    shares.into_iter().map(|s| (s.name, s.share)).collect()
}

fn square<'py>(py: Python<'py>, m: &DMatrix<f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
    array(
        py,
        m.transpose().as_slice().to_vec(),
        [m.nrows(), m.ncols()],
    )
}

/// Equilibrium of a posture under a wrench (6,), and the modes about it, the tool held in some of `x y z rx ry rz`.
#[pyfunction]
pub fn vibration_of(
    posture: &Posture,
    wrench: &Bound<'_, PyAny>,
    held: [bool; 6],
) -> PyResult<Vibration> {
    let py = wrench.py();
    let wrench = one_wrench("wrench", wrench)?;
    require_stiffness(posture.0.mechanism())?;
    let held = Held {
        directions: held,
        ..Held::directions(Directions::NONE)
    };
    let found = py.detach(|| VibratingMachine::at(&posture.0, &wrench, &held));
    Ok(Vibration(Arc::new(found.map_err(of_dynamics)?)))
}

#[pymethods]
impl Vibration {
    /// The equilibrium about which it vibrates.
    #[getter]
    fn equilibrium(&self) -> Equilibrium {
        Equilibrium::of(self.0.equilibrium.clone())
    }

    /// Signed frequencies (m,), Hz, ascending.
    #[getter]
    fn frequencies_hz<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.0.modes.frequencies_hz())
    }

    /// Kind of each mode.
    #[getter]
    fn kinds_json(&self) -> PyResult<String> {
        let kinds: Vec<_> = self.0.modes.modes.iter().map(|mode| mode.kind).collect();
        json_of(&kinds)
    }

    /// Counts of directions of each kind.
    #[getter]
    fn counts_json(&self) -> PyResult<String> {
        json_of(&self.0.modes.counts)
    }

    /// Joints and springs that take part in neutral directions.
    #[getter]
    fn neutral(&self) -> Vec<String> {
        self.0.modes.neutral.clone()
    }

    #[getter]
    fn stable(&self) -> PyResult<bool> {
        let complex = self.0.complex_modes(&Damping::Undamped, 0);
        Ok(self.0.stable(complex.map_err(of_dynamics)?.as_ref()))
    }

    /// Verdict (JSON), complexity and eigenvalues (m,), 1/s, under loads without a potential; nothing where all have one.
    fn complex_modes<'py>(&self, py: Python<'py>, law: &str) -> PyResult<Option<Complexes<'py>>> {
        let law = damping(law)?;
        let found = py.detach(|| self.0.complex_modes(&law, usize::MAX));
        let Some(found) = found.map_err(of_dynamics)? else {
            return Ok(None);
        };
        let values = found.modes.iter().map(|mode| mode.eigenvalue).collect();
        Ok(Some((
            json_of(&found.verdict)?,
            found.complexity,
            PyArray1::from_vec(py, values),
        )))
    }

    /// Craig and Bampton's reduction to six motions of a place and so many vibrations with it held: mass, stiffness, basis,
    /// frequencies that were kept, the lowest that was not, frequencies with bounds.
    fn reduced<'py>(
        &self,
        py: Python<'py>,
        at: Option<&str>,
        kept: usize,
    ) -> PyResult<Reduced<'py>> {
        let (point, whole) = (self.point(at)?, &self.0.dynamics);
        let found = py.detach(|| {
            let reduced = whole.reduced(point, kept)?;
            let frequencies = reduced.frequencies(whole)?;
            Ok((reduced, frequencies))
        });
        let (reduced, frequencies) = found.map_err(of_dynamics)?;
        let pairs = frequencies.iter().flat_map(|f| [f.hz, f.relative_bound]);
        Ok((
            square(py, &reduced.mass)?,
            square(py, &reduced.stiffness)?,
            square(py, &reduced.basis)?,
            PyArray1::from_vec(py, reduced.kept_hz),
            reduced.left_out_hz,
            array(py, pairs.collect(), [frequencies.len(), 2])?,
        ))
    }

    #[getter]
    fn circulatory(&self) -> bool {
        self.0.dynamics.is_circulatory()
    }

    #[getter]
    fn total_mass(&self) -> f64 {
        self.0.dynamics.total_mass()
    }

    /// Names of limbs and platforms without any mass.
    fn without_mass(&self, posture: &Posture) -> Vec<String> {
        self.0.without_mass(&posture.0)
    }

    /// Motion of the tool in each mode, (m, 6).
    #[getter]
    fn tool_shapes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let modes = &self.0.modes.modes;
        let numbers = modes.iter().flat_map(|m| m.tool.iter().copied()).collect();
        array(py, numbers, [modes.len(), 6])
    }

    /// Shapes of all modes by the independent coordinates, a row each.
    #[getter]
    fn shapes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let modes = &self.0.modes.modes;
        let numbers = modes.iter().flat_map(|m| m.shape.iter().copied()).collect();
        array(py, numbers, [modes.len(), self.0.dynamics.len()])
    }

    /// Mass matrix by the independent coordinates.
    #[getter]
    fn mass_matrix<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        square(py, self.0.dynamics.mass())
    }

    /// Tangent `K - H` by the independent coordinates.
    #[getter]
    fn tangent<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        square(py, self.0.dynamics.tangent())
    }

    /// Names of places where it is pushed and looked at.
    #[getter]
    fn places(&self) -> Vec<String> {
        self.0.dynamics.place_names().map(str::to_owned).collect()
    }

    /// Kinetic energy of a mode by bodies, elastic energy by joints and springs.
    fn shares(&self, mode: usize) -> PyResult<[Vec<(String, f64)>; 2]> {
        let mode = self.mode(mode)?;
        let dynamics = &self.0.dynamics;
        Ok([
            pairs(dynamics.kinetic_shares(mode)),
            pairs(dynamics.elastic_shares(mode)),
        ])
    }

    /// Ratios to critical damping of all modes (m,).
    fn damping_ratios<'py>(
        &self,
        py: Python<'py>,
        law: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let found = self
            .0
            .dynamics
            .damping_ratios(&self.0.modes, &damping(law)?);
        Ok(PyArray1::from_vec(py, found.map_err(of_dynamics)?))
    }

    /// Response (f, 6, 6) between two places over frequencies (f,), Hz; by modes with the residual of all others, or directly.
    #[pyo3(signature = (frequencies, law, at, by, quantity, modes))]
    fn response<'py>(
        &self,
        py: Python<'py>,
        frequencies: Numbers<'py>,
        law: &str,
        at: Option<&str>,
        by: Option<&str>,
        quantity: &str,
        modes: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray3<Complex<f64>>>> {
        let (_, hz) = rows("frequencies_hz", &frequencies, &[])?;
        let law = damping(law)?;
        let (at, from) = (self.point(at)?, self.point(by)?);
        let quantity = match quantity {
            "displacement" => Quantity::Displacement,
            "velocity" => Quantity::Velocity,
            "acceleration" => Quantity::Acceleration,
            _ => {
                return Err(error(
                    Class::Argument,
                    format!("quantity is '{quantity}': displacement, velocity or acceleration"),
                ));
            }
        };
        let (dynamics, own) = (&self.0.dynamics, &self.0.modes);
        let found: Result<Vec<Receptance>, Error> = py.detach(|| match modes {
            Some(kept) => {
                Ok(ModalResponse::new(dynamics, own, &law, at, from, kept)?.over(hz, quantity))
            }
            None => dynamics.direct(own, &law)?.over(at, from, hz, quantity),
        });
        let found = found.map_err(of_dynamics)?;
        let numbers: Vec<Complex<f64>> = found
            .iter()
            .flat_map(|g| (0..36).map(|k| g[(k / 6, k % 6)]))
            .collect();
        numbers.into_pyarray(py).reshape([found.len(), 6, 6])
    }

    /// Modal data of the tool's tip for chatter: shapes (m, 3), squares (m,), ratios (m,), residual (3, 3), what has no mass and is held by
    /// dampers (h, 3), and the damping between all of them (m + h, m + h).
    fn tool_modes<'py>(&self, py: Python<'py>, law: &str) -> PyResult<ToolModes<'py>> {
        let law = damping(law)?;
        let found = self.0.tool_response(&law, usize::MAX);
        let data = found
            .and_then(|response| response.translational())
            .map_err(of_dynamics)?;
        let shapes = data.shapes.iter().flat_map(|s| [s.x, s.y, s.z]).collect();
        let (held, rates) = data.coupling.map_or_else(Default::default, |coupling| {
            (coupling.held, Some(coupling.rates))
        });
        Ok((
            array(py, shapes, [data.shapes.len(), 3])?,
            PyArray1::from_vec(py, data.squared),
            PyArray1::from_vec(py, data.ratios),
            array(py, data.residual.transpose().as_slice().to_vec(), [3, 3])?,
            array(
                py,
                held.iter().flat_map(|h| [h.x, h.y, h.z]).collect(),
                [held.len(), 3],
            )?,
            rates
                .map(|r| {
                    array(
                        py,
                        r.transpose().as_slice().to_vec(),
                        [r.nrows(), r.ncols()],
                    )
                })
                .transpose()?,
        ))
    }
}

/// Verdict, complexity, eigenvalues.
type Complexes<'py> = (String, f64, Bound<'py, PyArray1<Complex<f64>>>);

/// Mass, stiffness, basis, frequencies kept, the lowest left out, frequencies with bounds.
type Reduced<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    Option<f64>,
    Bound<'py, PyArray2<f64>>,
);

/// Shapes, squares, ratios, residual, held, rates.
type ToolModes<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Option<Bound<'py, PyArray2<f64>>>,
);
