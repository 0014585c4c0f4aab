//! Arrays of numpy to poses, wrenches and commands, and back.

use kinetostat::nalgebra::{
    Matrix3, Matrix4, Matrix6, Rotation3, UnitQuaternion, Vector3, Vector6,
};
use kinetostat::{Pose, Wrench};
use numpy::ndarray::IntoDimension;
use numpy::{IntoPyArray, PyArray, PyArray1, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};
use rayon::prelude::*;

use crate::errors::{Class, error};
use crate::work::pool;

/// An array of float64, C-contiguous: what `numpy.ascontiguousarray(x, dtype=float)` gives.
pub type Numbers<'py> = PyReadonlyArrayDyn<'py, f64>;

/// Bytes that must stay free for the work itself.
const MARGIN: usize = 64 << 20;

/// Requests below this many bytes are not checked.
const SMALL: usize = 1 << 20;

/// Checks that `count` items of `size` bytes can be allocated, because Rust ends the process where an allocation fails.
///
/// # Errors
/// `MemoryError`.
pub fn reserve(count: usize, size: usize) -> PyResult<()> {
    let bytes = count.saturating_mul(size);
    let mut probe = Vec::<u8>::new();
    if bytes < SMALL
        || probe
            .try_reserve_exact(bytes.saturating_add(MARGIN))
            .is_ok()
    {
        // Without this the compiler may leave out an allocation that nobody uses.
        std::hint::black_box(&probe);
        return Ok(());
    }
    Err(PyMemoryError::new_err(format!(
        "{} MB cannot be allocated: ask for fewer postures at a time",
        bytes >> 20
    )))
}

/// The numbers of an array whose rows have a given shape, with the number of rows; one row may come without the axis before it.
///
/// # Errors
/// An array of another shape, or with a number that is not finite; both shapes are said.
pub fn rows<'a>(
    name: &str,
    array: &'a Numbers<'_>,
    shape: &[usize],
) -> PyResult<(usize, &'a [f64])> {
    let (count, numbers) = shaped(name, array, shape)?;
    if let Some(at) = numbers.iter().position(|x| !x.is_finite()) {
        let each: usize = shape.iter().product();
        let said = not_finite(name, numbers[at], at / each.max(1));
        return Err(error(Class::Argument, said));
    }
    Ok((count, numbers))
}

fn not_finite(name: &str, number: f64, row: usize) -> String {
    format!("{name} holds {number} in row {row}: give finite numbers")
}

/// Shape check without a check of the numbers.
fn shaped<'a>(name: &str, array: &'a Numbers<'_>, shape: &[usize]) -> PyResult<(usize, &'a [f64])> {
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
    Ok((count, numbers))
}

/// Maximum error of a rotation matrix, entry by entry of `R^T R - 1`.
const ROUNDED: f64 = 1e-6;

/// Reads poses one after the other: what one has in common with the one before is looked at once.
#[derive(Default)]
struct PoseReader {
    /// The last rotation, row by row, and as the core takes it.
    last: Option<([f64; 9], UnitQuaternion<f64>)>,
}

impl PoseReader {
    /// A pose from sixteen numbers, a 4 x 4 matrix row by row; or what is wrong with it.
    fn pose(&mut self, name: &str, row: usize, m: &[f64; 16]) -> Result<Pose, String> {
        // Without a branch for each number.
        if !m.iter().fold(true, |all, x| all & x.is_finite()) {
            let culprit = m.iter().find(|x| !x.is_finite()).unwrap_or(&f64::NAN);
            return Err(not_finite(name, *culprit, row));
        }
        if m[12..] != [0.0, 0.0, 0.0, 1.0] {
            return Err(no_pose(
                name,
                row,
                "the last row of a 4 x 4 pose is 0 0 0 1",
            ));
        }
        let own = [m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]];
        let rotation = match self.last {
            Some((last, rotation)) if last == own => rotation,
            _ => rotation_of(&own).map_err(|what| no_pose(name, row, what))?,
        };
        self.last = Some((own, rotation));
        Ok(Pose::from_parts(
            Vector3::new(m[3], m[7], m[11]).into(),
            rotation,
        ))
    }
}

fn no_pose(name: &str, row: usize, what: &str) -> String {
    format!("{name}[{row}] is no pose: {what}")
}

/// A rotation from a 3 x 3 matrix row by row, or why it is none.
fn rotation_of(rows: &[f64; 9]) -> Result<UnitQuaternion<f64>, &'static str> {
    let matrix = Matrix3::from_row_slice(rows);
    if (matrix.transpose() * matrix - Matrix3::identity()).amax() > ROUNDED {
        return Err("its rotation is not orthonormal");
    }
    if matrix.determinant() < 0.0 {
        return Err("its rotation mirrors (determinant -1)");
    }
    let rotation = Rotation3::from_matrix_unchecked(matrix);
    Ok(UnitQuaternion::from_rotation_matrix(&rotation))
}

/// Poses that a thread reads at a time.
const POSES_EACH: usize = 1024;

/// Poses read between two looks at signals: some milliseconds.
const POSES_BETWEEN_SIGNALS: usize = 256 * POSES_EACH;

/// Poses from an array (n, 4, 4), read by so many threads. Millions of them take a while, in which others run and Ctrl-C is heard.
///
/// # Errors
/// As [`rows`], and the first matrix that is no rigid motion; `KeyboardInterrupt`.
pub fn poses(name: &str, array: &Numbers<'_>, threads: Option<usize>) -> PyResult<Vec<Pose>> {
    let py = array.py();
    let (count, numbers) = shaped(name, array, &[4, 4])?;
    let (each, _) = numbers.as_chunks::<16>();
    reserve(count, size_of::<Pose>())?;
    let mut found = vec![Pose::identity(); count];
    let read = |first: usize, given: &[[f64; 16]], to: &mut [Pose]| -> Result<(), String> {
        let mut reader = PoseReader::default();
        for (i, (m, pose)) in given.iter().zip(to).enumerate() {
            *pose = reader.pose(name, first + i, m)?;
        }
        Ok(())
    };
    if count <= POSES_EACH {
        read(0, each, &mut found).map_err(|what| error(Class::Argument, what))?;
        return Ok(found);
    }
    let pool = pool(threads)?;
    let parts = each.chunks(POSES_BETWEEN_SIGNALS);
    for (part, (given, to)) in parts
        .zip(found.chunks_mut(POSES_BETWEEN_SIGNALS))
        .enumerate()
    {
        let fault = py.detach(|| {
            pool.install(|| {
                let blocks = given.par_chunks(POSES_EACH);
                let blocks = blocks.zip(to.par_chunks_mut(POSES_EACH)).enumerate();
                // The first one, whichever thread finds another before.
                blocks.find_map_first(|(block, (given, to))| {
                    let first = part * POSES_BETWEEN_SIGNALS + block * POSES_EACH;
                    read(first, given, to).err()
                })
            })
        });
        if let Some(what) = fault {
            return Err(error(Class::Argument, what));
        }
        py.check_signals()?;
    }
    Ok(found)
}

/// Reads one pose from an array (4, 4) or (1, 4, 4).
///
/// # Errors
/// As [`rows`] and [`pose`], and more than one pose.
pub fn one_pose(name: &str, array: &Numbers<'_>) -> PyResult<Pose> {
    let (count, numbers) = shaped(name, array, &[4, 4])?;
    let said = match numbers.as_chunks::<16>().0 {
        [only] => match PoseReader::default().pose(name, 0, only) {
            Ok(pose) => return Ok(pose),
            Err(what) => what,
        },
        _ => format!("{name}: give one pose, not {count}"),
    };
    Err(error(Class::Argument, said))
}

/// Reads one wrench from anything that numpy takes for six finite numbers.
///
/// # Errors
/// Another shape, complex numbers, text, NaN: what was expected and what was found.
pub fn one_wrench(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Wrench> {
    // The usual kinds at once. Arrays of other dtypes would lose imaginary parts on the way, masked ones (a kind of array, too)
    // what their mask says.
    let numbers = if given.is_exact_instance_of::<PyArray1<f64>>() {
        // Arrays that are not contiguous, or are being written, are read below.
        let array = given.cast::<PyArray1<f64>>().ok();
        array
            .and_then(|array| array.try_readonly().ok())
            .and_then(|array| {
                let numbers = array.as_slice().ok()?;
                <[f64; 6]>::try_from(numbers).ok()
            })
    } else if given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>() {
        given.extract::<[f64; 6]>().ok()
    } else {
        None
    };
    if let Some(numbers) = numbers.filter(|numbers| numbers.iter().all(|x| x.is_finite())) {
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
    reserve(each.len(), size_of::<Wrench>())?;
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
