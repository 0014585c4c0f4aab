//! Arrays of numpy to poses, wrenches and commands, and back.

use kinetostat::nalgebra::{
    Matrix3, Matrix4, Matrix6, Rotation3, UnitQuaternion, Vector3, Vector6,
};
use kinetostat::{Pose, Wrench};
use numpy::ndarray::IntoDimension;
use numpy::{IntoPyArray, PyArray, PyArray1, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

use crate::errors::{Class, error};

/// An array of float64, C-contiguous: what `numpy.ascontiguousarray(x, dtype=float)` gives.
pub type Numbers<'py> = PyReadonlyArrayDyn<'py, f64>;

/// The numbers of an array whose rows have a given shape, with the number of rows; one row may come without the axis before it.
///
/// # Errors
/// An array of another shape, or with a number that is not finite; both shapes are said.
pub fn rows<'a>(
    name: &str,
    array: &'a Numbers<'_>,
    shape: &[usize],
) -> PyResult<(usize, &'a [f64])> {
    use numpy::PyUntypedArrayMethods;
    let found = array.shape();
    let single = found == shape;
    if !single && (found.len() != shape.len() + 1 || &found[1..] != shape) {
        let wanted: Vec<String> = shape.iter().map(usize::to_string).collect();
        let found: Vec<String> = found.iter().map(usize::to_string).collect();
        return Err(error(
            Class::Argument,
            format!(
                "{name} has shape ({}), expected (n, {})",
                found.join(", "),
                wanted.join(", ")
            ),
        ));
    }
    let count = if single { 1 } else { found[0] };
    let numbers = array.as_slice().map_err(|_| {
        error(
            Class::Argument,
            format!("{name} is not C-contiguous: use numpy.ascontiguousarray"),
        )
    })?;
    if let Some(at) = numbers.iter().position(|x| !x.is_finite()) {
        let each: usize = shape.iter().product();
        return Err(error(
            Class::Argument,
            format!(
                "{name} holds {} in row {}: give finite numbers",
                numbers[at],
                at / each.max(1)
            ),
        ));
    }
    Ok((count, numbers))
}

/// How far a rotation matrix may be from one, entry by entry of `R^T R - 1`.
const ROUNDED: f64 = 1e-6;

/// A pose from sixteen numbers, a 4 x 4 matrix row by row.
///
/// # Errors
/// A matrix that is no rigid motion: what is wrong with it.
pub fn pose(name: &str, row: usize, m: &[f64]) -> PyResult<Pose> {
    let refuse = |what: &str| {
        Err(error(
            Class::Argument,
            format!("{name}[{row}] is no pose: {what}"),
        ))
    };
    let rotation = Matrix3::new(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
    if m[12..16] != [0.0, 0.0, 0.0, 1.0] {
        return refuse("the last row of a 4 x 4 pose is 0 0 0 1");
    }
    if (rotation.transpose() * rotation - Matrix3::identity()).amax() > ROUNDED {
        return refuse("its rotation is not orthonormal");
    }
    if rotation.determinant() < 0.0 {
        return refuse("its rotation mirrors (determinant -1)");
    }
    let rotation =
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
    Ok(Pose::from_parts(
        Vector3::new(m[3], m[7], m[11]).into(),
        rotation,
    ))
}

/// Poses read between two looks at signals: some milliseconds.
const POSES_BETWEEN_SIGNALS: usize = 4096;

/// Poses from an array (n, 4, 4). Millions of them take a while, in which others run and Ctrl-C is heard.
///
/// # Errors
/// As [`rows`] and [`pose`]; `KeyboardInterrupt`.
pub fn poses(name: &str, array: &Numbers<'_>) -> PyResult<Vec<Pose>> {
    let py = array.py();
    let (count, numbers) = rows(name, array, &[4, 4])?;
    let (each, _) = numbers.as_chunks::<16>();
    let mut found = Vec::with_capacity(count);
    for part in each.chunks(POSES_BETWEEN_SIGNALS) {
        let first = found.len();
        py.detach(|| {
            for (i, m) in part.iter().enumerate() {
                found.push(pose(name, first + i, m)?);
            }
            PyResult::Ok(())
        })?;
        py.check_signals()?;
    }
    Ok(found)
}

/// One pose from an array (4, 4) or (1, 4, 4).
///
/// # Errors
/// As [`rows`] and [`pose`], and more than one pose.
pub fn one_pose(name: &str, array: &Numbers<'_>) -> PyResult<Pose> {
    let (count, numbers) = rows(name, array, &[4, 4])?;
    match count {
        1 => pose(name, 0, numbers),
        _ => Err(error(
            Class::Argument,
            format!("{name}: give one pose, not {count}"),
        )),
    }
}

/// One wrench from anything that numpy takes for six finite numbers.
///
/// # Errors
/// Another shape, complex numbers, text, NaN: what was expected and what was found.
pub fn one_wrench(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Wrench> {
    // The usual kinds at once. Arrays of other dtypes would lose imaginary parts on the way.
    let usual = given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>();
    if (usual || given.cast::<PyArray1<f64>>().is_ok())
        && let Ok(numbers) = given.extract::<[f64; 6]>()
        && numbers.iter().all(|x| x.is_finite())
    {
        return Ok(Wrench(Vector6::from(numbers)));
    }
    let arrays = given.py().import("kinetostat._arrays")?;
    let fitted = arrays.call_method1("one", (name, given, (6,)))?;
    Ok(Wrench(Vector6::from(fitted.extract::<[f64; 6]>()?)))
}

/// Wrenches from an array (n, 6): force, moment.
///
/// # Errors
/// As [`rows`].
pub fn wrenches(name: &str, array: &Numbers<'_>) -> PyResult<Vec<Wrench>> {
    let (_, numbers) = rows(name, array, &[6])?;
    let (each, _) = numbers.as_chunks::<6>();
    Ok(each
        .iter()
        .map(|w| Wrench(Vector6::from_column_slice(w)))
        .collect())
}

/// A new array of a given shape; the numbers go over without a copy.
///
/// # Errors
/// More or fewer numbers than the shape has: a fault of this module.
pub fn array<'py, S: IntoDimension>(
    py: Python<'py>,
    numbers: Vec<f64>,
    shape: S,
) -> PyResult<Bound<'py, PyArray<f64, S::Dim>>> {
    numbers.into_pyarray(py).reshape(shape)
}

/// A pose as a 4 x 4 matrix, row by row.
pub fn matrix_of(pose: &Pose) -> Vec<f64> {
    let m: Matrix4<f64> = pose.to_homogeneous();
    m.transpose().as_slice().to_vec()
}

/// A 6 x 6 matrix row by row.
pub fn rows_of(m: &Matrix6<f64>) -> Vec<f64> {
    m.transpose().as_slice().to_vec()
}
