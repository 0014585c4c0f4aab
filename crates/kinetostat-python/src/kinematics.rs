//! Kinematics of limbs, frames of many postures, all postures at a pose, and gradients by the numbers of a model.

use kinetostat::model::{Kinematics, Role};
use kinetostat::nalgebra::DMatrix;
use kinetostat::{Pose, PostureRequest};
use kinetostat_analysis::sensitivity::{GradientTask, SensitivityError, gradients};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Numbers, array, matrix_of, one_pose, rows, rows_of, wrenches};
use crate::columns::{Columns, done};
use crate::errors::{Class, error, of_core, of_model};
use crate::machine::Machine;
use crate::posture::Posture;
use crate::work::{Manner, away};

/// A limb at a posture, up to the node that is asked for: the reference point of its platform without one.
struct LimbAt {
    node: usize,
    kinematics: Kinematics,
}

impl LimbAt {
    fn new(posture: &Posture, limb: usize, at: Option<&str>) -> PyResult<Self> {
        let (own, joints) = (
            &posture.0.mechanism().limbs()[limb],
            &posture.0.limbs()[limb],
        );
        let (chain, node) = match at {
            Some(name) => own
                .nominal
                .node(name)
                .map(|node| (own.nominal.clone(), node)),
            None => own
                .nominal
                .with_end("\u{1}end", &own.platform_from_tip.inverse())
                .map(|chain| {
                    let tip = chain.tip();
                    (chain, tip)
                }),
        }
        .map_err(|e| of_core(&e))?;
        let base = &posture.0.platforms()[own.from];
        let kinematics = Kinematics::new(&chain, base, &joints.coordinates, &joints.commands);
        Ok(Self { node, kinematics })
    }
}

fn square<'py>(py: Python<'py>, m: &DMatrix<f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let shape = [m.nrows(), m.ncols()];
    array(py, m.transpose().as_slice().to_vec(), shape)
}

/// Name and role (theta, passive, actuated) of the coordinates and actuators of a limb, the columns of its Jacobian.
#[pyfunction]
pub fn limb_coordinates(posture: &Posture, limb: usize) -> Vec<(String, &'static str)> {
    let chain = &posture.0.mechanism().limbs()[limb].nominal;
    let springs = chain.coordinates().iter().map(|c| {
        let role = match c.role {
            Role::Spring => "theta",
            Role::Passive => "passive",
        };
        (c.name.clone(), role)
    });
    let actuators = chain.actuators().iter();
    springs
        .chain(actuators.map(|a| (a.name.clone(), "actuated")))
        .collect()
}

/// Jacobian of a node of a limb (6, coordinates and actuators).
#[pyfunction]
#[pyo3(signature = (posture, limb, at=None))]
pub fn limb_jacobian<'py>(
    py: Python<'py>,
    posture: &Posture,
    limb: usize,
    at: Option<&str>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let at = LimbAt::new(posture, limb, at)?;
    let jacobian = at.kinematics.jacobian(at.node);
    let numbers = jacobian.transpose().as_slice().to_vec();
    array(py, numbers, [6, jacobian.ncols()])
}

/// Hessian of a wrench (1, 6) on a node of a limb, by its coordinates and actuators.
#[pyfunction]
#[pyo3(signature = (posture, limb, wrench, at=None))]
pub fn limb_hessian<'py>(
    py: Python<'py>,
    posture: &Posture,
    limb: usize,
    wrench: Numbers<'py>,
    at: Option<&str>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let at = LimbAt::new(posture, limb, at)?;
    let wrench = wrenches("wrench", &wrench)?[0];
    square(py, &at.kinematics.hessian(&[(at.node, wrench)]))
}

/// Stiffness of the springs of a limb.
#[pyfunction]
pub fn limb_springs<'py>(
    py: Python<'py>,
    posture: &Posture,
    limb: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let chain = &posture.0.mechanism().limbs()[limb].nominal;
    let found = chain.spring_stiffness(&posture.0.limbs()[limb].coordinates);
    square(py, &found.map_err(|e| of_core(&e))?)
}

/// Limb and node of the frames of [`frames_of_many`].
#[pyfunction]
pub fn frame_names(machine: &Machine) -> Vec<(String, String)> {
    let limbs = machine.mechanism.limbs().iter();
    limbs
        .flat_map(|limb| {
            let nodes = limb.nominal.nodes().iter();
            nodes.map(|node| (limb.name.clone(), node.clone()))
        })
        .collect()
}

fn frames(posture: &kinetostat::Posture, to: &mut [f64]) {
    let mut rows = to.chunks_exact_mut(16);
    let limbs = posture.mechanism().limbs().iter().zip(posture.limbs());
    for (limb, joints) in limbs {
        let base = &posture.platforms()[limb.from];
        let chain = &limb.nominal;
        let found = Kinematics::new(chain, base, &joints.coordinates, &joints.commands);
        for (node, row) in (0..chain.nodes().len()).zip(&mut rows) {
            row.copy_from_slice(&matrix_of(&found.node_pose(node)));
        }
    }
}

/// Frames of all nodes of one posture (nodes, 4, 4).
#[pyfunction]
pub fn frames_of<'py>(
    py: Python<'py>,
    posture: &Posture,
) -> PyResult<Bound<'py, numpy::PyArray3<f64>>> {
    let limbs = posture.0.mechanism().limbs().iter();
    let count: usize = limbs.map(|limb| limb.nominal.nodes().len()).sum();
    let mut numbers = vec![0.0; 16 * count];
    frames(&posture.0, &mut numbers);
    array(py, numbers, [count, 4, 4])
}

/// Poses of the tool (n, 4, 4), frames of all nodes (n, nodes, 4, 4) and states of postures with these commands (n, actuators).
#[pyfunction]
#[pyo3(signature = (machine, joints, threads=None, progress=None))]
pub fn frames_of_many<'py>(
    py: Python<'py>,
    machine: &Machine,
    joints: Numbers<'py>,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let each = machine.mechanism.actuator_count();
    let (count, numbers) = rows("joints", &joints, &[each])?;
    crate::arrays::reserve(count, size_of::<f64>() * each)?;
    let (commands, mechanism) = (numbers.to_vec(), machine.mechanism.clone());
    let nodes = frame_names(machine).len();
    let mut columns = Columns::new(count, &[16, 16 * nodes])?;
    let manner = Manner { threads, progress };
    let columns = done(py, count, &manner, move |course| {
        columns.fill(course, |_: &mut (), first, out, status| {
            for (i, status) in status.iter_mut().enumerate() {
                let own = &commands[each * (first + i)..each * (first + i + 1)];
                let (tool, all) = (16 * i..16 * (i + 1), 16 * nodes * i..16 * nodes * (i + 1));
                match mechanism.posture(PostureRequest::commands(own)) {
                    Ok(posture) => {
                        out[0][tool].copy_from_slice(&matrix_of(posture.target()));
                        frames(&posture, &mut out[1][all]);
                        *status = u8::from(posture.within_limits().is_err());
                    }
                    Err(_) => {
                        out[0][tool].fill(f64::NAN);
                        out[1][all].fill(f64::NAN);
                        *status = 2;
                    }
                }
            }
        });
        columns
    })?;
    let mut numbers = columns.numbers.into_iter();
    let mut next = || numbers.next().unwrap_or_default();
    let answer = PyDict::new(py);
    answer.set_item("tool", array(py, next(), [count, 4, 4])?)?;
    answer.set_item("frames", array(py, next(), [count, nodes, 4, 4])?)?;
    answer.set_item("status", PyArray1::from_vec(py, columns.status))?;
    Ok(answer)
}

/// All postures of a serial arm without passive joints at a pose (1, 4, 4).
#[pyfunction]
pub fn inverse_solutions(
    py: Python<'_>,
    machine: &Machine,
    pose: Numbers<'_>,
) -> PyResult<Vec<Posture>> {
    let pose: Pose = one_pose("pose", &pose)?;
    // A machine that cannot be commanded by joints is no such arm.
    let none = machine.batch().targets_at_joints(&[]);
    none.map_err(|e| of_core(&e))?;
    let configurations = machine.configurations();
    let found = py.detach(|| configurations.all(&pose));
    Ok(found
        .into_iter()
        .map(|p| Posture(std::sync::Arc::new(p)))
        .collect())
}

/// Derivatives of pose and stiffness by numbers of the model file: path, value, unit and reason of those without an answer, and
/// arrays with derivatives and errors.
#[pyfunction]
#[pyo3(signature = (machine, posture, paths, wrench=None, threads=None))]
pub fn gradients_of<'py>(
    py: Python<'py>,
    machine: &Machine,
    posture: &Posture,
    paths: Vec<String>,
    wrench: Option<Numbers<'py>>,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyDict>> {
    let wrench = wrench.map(|w| wrenches("wrench", &w)).transpose()?;
    let (model, tool, own) = (machine.model.clone(), machine.tool, posture.0.clone());
    let manner = Manner {
        threads,
        progress: None,
    };
    let found = away(py, &manner, move |_| {
        let task = GradientTask {
            model: &model,
            tool,
            posture: &own,
            wrench: wrench.map(|all| all[0]),
        };
        let paths: Vec<&str> = paths.iter().map(String::as_str).collect();
        gradients(&task, &paths)
    })?;
    let found = found.map_err(|failed| match failed {
        SensitivityError::Machine(failed) => of_core(&failed),
        SensitivityError::Model(failed) => of_model(&failed),
        other => error(Class::Unanswered, other.to_string()),
    })?;
    let count = found.len();
    let mut about = Vec::new();
    let mut columns: [Vec<f64>; 4] = Default::default();
    for gradient in found {
        let p = gradient.parameter;
        let reason = gradient.derivatives.as_ref().err().cloned();
        about.push((p.path, p.value, p.unit, reason));
        match gradient.derivatives {
            Ok([best, error]) => {
                columns[0].extend(best.0.iter());
                columns[1].extend(rows_of(&best.1));
                columns[2].extend(error.0.iter());
                columns[3].extend(rows_of(&error.1));
            }
            Err(_) => {
                for (column, width) in columns.iter_mut().zip([6, 36, 6, 36]) {
                    column.resize(column.len() + width, f64::NAN);
                }
            }
        }
    }
    let [pose, stiffness, pose_error, stiffness_error] = columns;
    let answer = PyDict::new(py);
    answer.set_item("about", about)?;
    answer.set_item("pose", array(py, pose, [count, 6])?)?;
    answer.set_item("stiffness", array(py, stiffness, [count, 6, 6])?)?;
    answer.set_item("pose_error", array(py, pose_error, [count, 6])?)?;
    answer.set_item(
        "stiffness_error",
        array(py, stiffness_error, [count, 6, 6])?,
    )?;
    Ok(answer)
}
