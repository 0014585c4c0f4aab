//! Programs corrected by a field that Python brings along.

use kinetostat::nalgebra::Vector3;
use kinetostat_program::{
    Correction, CorrectionField, FieldFailure, Program, ReadOptions, Request, Unwatched,
    WriteError, WriteOptions, interpret, verify_against_field, verify_written, write_corrected,
};
use numpy::{PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::sync::Mutex;

use crate::arrays::{Numbers, array, rows};
use crate::errors::{Class, error};
use crate::plausibility::of_corrections;

const MM: f64 = 1000.0;

/// A function of positions (n, 3) and directions of motion (n, 3), both part axes, m and 1; gives corrections (n, 3), m.
struct Function {
    called: Py<PyAny>,
    /// The first thing that it raised, which the caller of this module gets.
    raised: Mutex<Option<PyErr>>,
}

impl Function {
    fn answers(&self, py: Python<'_>, requests: &[Request]) -> PyResult<Vec<Correction>> {
        let count = requests.len();
        let places = requests
            .iter()
            .flat_map(|r| (r.position_mm / MM).data.0[0])
            .collect();
        let ways = requests
            .iter()
            .flat_map(|r| r.tangent.unwrap_or(Vector3::repeat(f64::NAN)).data.0[0])
            .collect();
        let given = (array(py, places, [count, 3])?, array(py, ways, [count, 3])?);
        let answer = self.called.bind(py).call1(given)?;
        let answer = answer
            .cast_into::<PyArrayDyn<f64>>()
            .map_err(|_| error(Class::Argument, "the field gives no array of float64"))?;
        let answer: Numbers<'_> = answer.readonly();
        let (found, numbers) = rows("corrections", &answer, &[3])?;
        if found != count {
            let what = format!("corrections has shape ({found}, 3), expected ({count}, 3)");
            return Err(error(Class::Argument, what));
        }
        let (each, _) = numbers.as_chunks::<3>();
        Ok(each
            .iter()
            .map(|v| Correction::from(Vector3::from(*v) * MM))
            .collect())
    }
}

impl CorrectionField for Function {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let found = Python::attach(|py| {
            py.check_signals()?;
            self.answers(py, requests)
        });
        match found {
            Ok(found) => found.into_iter().map(Ok).collect(),
            Err(raised) => {
                let failure = FieldFailure::new(raised.to_string());
                if let Ok(mut kept) = self.raised.lock() {
                    kept.get_or_insert(raised);
                }
                vec![Err(failure); requests.len()]
            }
        }
    }
}

/// A program whose last check fails was corrected by a field that is no function of the place, or one that jumps.
fn of_field(found: &WriteError) -> String {
    match found {
        WriteError::Verification { line, what, .. } => format!(
            "line {line}: the written program does not follow the field: {what}. The field has to be continuous, and to give the same correction at the same place and direction each time that it is called"
        ),
        other => other.to_string(),
    }
}

/// A G-code program whose path is its own plus the field's correction: its bytes, and what was measured when it was read again.
#[pyfunction]
pub fn correct_program<'py>(
    py: Python<'py>,
    program: Vec<u8>,
    field: Py<PyAny>,
    tolerance: f64,
    decimals: Option<u8>,
) -> PyResult<(Bound<'py, PyBytes>, Bound<'py, PyDict>)> {
    let field = Function {
        called: field,
        raised: Mutex::new(None),
    };
    let wrong = |e: &dyn std::fmt::Display| error(Class::Argument, e.to_string());
    let done = py.detach(|| {
        let program = Program::read(program).map_err(|e| wrong(&e))?;
        let reading = ReadOptions::default();
        let path = interpret(&program, &reading).map_err(|e| wrong(&e))?;
        let mut writing = WriteOptions::default();
        (writing.tolerance_mm, writing.decimals) = (tolerance * MM, decimals);
        let unanswered = |e: &WriteError| error(Class::Unanswered, e.to_string());
        let written = write_corrected(&program, &path, &field, &writing, &Unwatched)
            .map_err(|e| unanswered(&e))?;
        verify_written(&program, &path, &written, &reading, &writing)
            .map_err(|e| unanswered(&e))?;
        let check = verify_against_field(&path, &written, &field, &writing, &Unwatched)
            .map_err(|e| error(Class::Unanswered, of_field(&e)))?;
        Ok::<_, PyErr>((written, check))
    });
    let raised = (field.raised.lock().ok()).and_then(|mut kept| kept.take());
    if let Some(raised) = raised {
        return Err(raised);
    }
    let (written, check) = done?;
    let told = PyDict::new(py);
    told.set_item("pieces", written.pieces.len())?;
    told.set_item("places", check.places)?;
    let before = check.before.distance_mm.max(check.before_at_ends_mm);
    told.set_item("error_before", before / MM)?;
    told.set_item("error_after", check.after.distance_mm / MM)?;
    told.set_item("allowed", check.allowed_mm / MM)?;
    told.set_item("warnings", of_corrections(before / MM, tolerance))?;
    Ok((PyBytes::new(py, &written.bytes), told))
}
