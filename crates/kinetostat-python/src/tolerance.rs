//! Tolerances: many machines whose numbers scatter, and draws for functions of Python.

use kinetostat::{Pose, Wrench};
use kinetostat_analysis::tolerance::{
    Distribution, Draws, Linear, Quantity, Samples, TaskError, Uncertain, UncertainMachine,
    Uncertainties, UncertaintyFile, can_be_kept, design_row, design_rows, linearised, monte_carlo,
    sobol_indices,
};
use kinetostat_machining::RunError;
use numpy::{PyArray2, PyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::arrays::{Numbers, array, poses, reserve, wrenches};
use crate::errors::{Class, error, of_core, of_model, require_stiffness};
use crate::machine::Machine;
use crate::work::{Manner, away};

fn of_task(found: &TaskError) -> PyErr {
    match found {
        TaskError::Model(found) => of_model(found),
        TaskError::Core(found) => of_core(found),
        other => error(Class::Unanswered, other.to_string()),
    }
}

/// Refuses what is too much to be kept, before it is computed.
fn kept(rows: usize, width: usize, what: &str, instead: &str) -> PyResult<()> {
    let found = can_be_kept(rows, width);
    found.map_err(|many| error(Class::Argument, format!("{what}: {many}; {instead}")))
}

/// Answers of all machines, their linear functions, and the numbers that were drawn.
type Studied = Result<(Samples, Vec<Linear>, Vec<f64>), Result<RunError, TaskError>>;

/// Machines drawn from a file of uncertainties (TOML): `inputs` (n, d), `samples` (n, places, columns), their names, and the linear
/// function of each column: `nominal` and `deviation` (places, columns), `derivatives` (places, columns, d).
#[pyfunction]
#[pyo3(signature = (machine, spread, file, places, wrench, quantities, draws, seed, threads=None, progress=None))]
pub fn tolerance_of_machine<'py>(
    py: Python<'py>,
    machine: &Machine,
    spread: &str,
    file: &str,
    places: Numbers<'py>,
    wrench: Numbers<'py>,
    quantities: Vec<String>,
    draws: usize,
    seed: u64,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    require_stiffness(&machine.mechanism)?;
    let places: Vec<Pose> = poses("poses", &places, threads)?;
    let wrench: Wrench = wrenches("wrench", &wrench)?
        .first()
        .copied()
        .unwrap_or_else(Wrench::zero);
    let quantities: Vec<Quantity> = Quantity::ALL
        .into_iter()
        .filter(|q| quantities.iter().any(|w| w == q.word()))
        .collect();
    let draws = Draws::new(draws, seed);
    let width: usize = quantities.iter().map(|q| q.columns().len()).sum();
    kept(
        draws.len(),
        places.len().saturating_mul(width),
        "results of all machines at all places",
        "take fewer draws, places or quantities, or ask for the places in parts, with the same seed",
    )?;
    let read =
        UncertaintyFile::read(spread, file, &machine.model, &wrench).map_err(|e| of_model(&e))?;
    let own = UncertainMachine::new(
        &machine.model,
        &machine.tool,
        &read,
        &places,
        wrench,
        &quantities,
    )
    .map_err(|e| of_task(&e))?;
    let columns = own.columns();
    let (count, each) = (places.len(), columns.len());
    let numbers = read.uncertainties.clone();
    let manner = Manner { threads, progress };
    let found: Studied = away(py, &manner, move |course| {
        let samples = monte_carlo(&own, &numbers, &draws, course.as_ref()).map_err(Ok)?;
        let lines = linearised(&own, &numbers).map_err(Err)?;
        let inputs = (0..draws.len()).flat_map(|i| numbers.drawn(&draws, i));
        Ok((samples, lines, inputs.collect()))
    })?;
    let (samples, lines, inputs) = found.map_err(|e| match e {
        Ok(stopped) => error(Class::Unanswered, stopped.to_string()),
        Err(task) => of_task(&task),
    })?;
    let names: Vec<String> = read
        .uncertainties
        .each()
        .iter()
        .map(|u| u.name.clone())
        .collect();
    let out = PyDict::new(py);
    out.set_item("inputs", array(py, inputs, [draws.len(), names.len()])?)?;
    out.set_item(
        "samples",
        array(py, samples.numbers, [draws.len(), count, each])?,
    )?;
    let nominal = lines.iter().map(|l| l.nominal).collect();
    let deviation = lines.iter().map(|l| l.standard_deviation).collect();
    let derivatives: Vec<f64> = lines
        .iter()
        .flat_map(|l| l.derivatives.iter().copied())
        .collect();
    out.set_item("nominal", array(py, nominal, [count, each])?)?;
    out.set_item("standard_deviation", array(py, deviation, [count, each])?)?;
    out.set_item(
        "derivatives",
        array(py, derivatives, [count, each, names.len()])?,
    )?;
    out.set_item("values", read.uncertainties.nominal())?;
    out.set_item("names", names)?;
    out.set_item("columns", columns)?;
    out.set_item("no_machine", samples.failures.no_machine)?;
    out.set_item("no_answer", samples.failures.no_answer)?;
    out.set_item("unstable", samples.failures.unstable)?;
    Ok(out)
}

/// Numbers by value, word of their distribution and spread; correlations of pairs.
fn uncertainties(
    each: Vec<(f64, String, f64)>,
    pairs: &[(usize, usize, f64)],
) -> PyResult<Uncertainties> {
    let count = each.len();
    let made: PyResult<Vec<Uncertain>> = each.into_iter().enumerate().map(|(i, (value, word, spread))| {
        if !(value.is_finite() && spread.is_finite() && spread >= 0.0) {
            return Err(error(Class::Argument, format!("number {i}: value {value}, spread {spread}: give finite ones, and no negative spread")));
        }
        let distribution = match word.as_str() {
            "normal" => Distribution::Normal(spread),
            "uniform" => Distribution::Uniform(spread),
            "triangular" => Distribution::Triangular(spread),
            other => return Err(error(Class::Argument, format!("number {i}: '{other}' is none of normal, uniform, triangular"))),
        };
        Ok(Uncertain { name: i.to_string(), value, unit: String::new(), distribution })
    }).collect();
    if let Some((i, j, r)) = pairs
        .iter()
        .find(|(i, j, r)| i == j || *i.max(j) >= count || !(-1.0..=1.0).contains(r))
    {
        return Err(error(
            Class::Argument,
            format!("correlation ({i}, {j}, {r}): two different numbers and -1 to 1 are needed"),
        ));
    }
    Uncertainties::correlated(made?, pairs).map_err(|e| error(Class::Argument, e.to_string()))
}

/// Numbers of many rows, one behind the other, away from the interpreter; Ctrl-C stops it.
fn rows(
    py: Python<'_>,
    count: usize,
    row: impl Fn(usize) -> Vec<f64> + Send + Sync + 'static,
) -> PyResult<Vec<f64>> {
    /// Rows between two looks at whether they are still wanted.
    const EACH: usize = 4096;
    let manner = Manner {
        threads: None,
        progress: None,
    };
    away(py, &manner, move |course| {
        let parts = (0..count.div_ceil(EACH)).into_par_iter().map(|part| {
            let own = part * EACH..count.min((part + 1) * EACH);
            match course.stopped() {
                true => Vec::new(),
                false => own.flat_map(&row).collect::<Vec<f64>>(),
            }
        });
        parts.collect::<Vec<_>>().concat()
    })
}

/// Draws of numbers (n, d).
#[pyfunction]
pub fn drawn_numbers<'py>(
    py: Python<'py>,
    each: Vec<(f64, String, f64)>,
    pairs: Vec<(usize, usize, f64)>,
    draws: usize,
    seed: u64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let width = each.len();
    let (numbers, draws) = (uncertainties(each, &pairs)?, Draws::new(draws, seed));
    kept(draws.len(), width, "draws of all numbers", "take fewer")?;
    // In parts first, then in one.
    reserve(draws.len(), 2 * size_of::<f64>() * width)?;
    let all = rows(py, draws.len(), move |i| numbers.drawn(&draws, i))?;
    array(py, all, [draws.len(), width])
}

/// Rows for which Sobol indices want the function (n, d + 2, d).
#[pyfunction]
pub fn sobol_design<'py>(
    py: Python<'py>,
    each: Vec<(f64, String, f64)>,
    draws: usize,
    seed: u64,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let width = each.len();
    let (numbers, draws) = (uncertainties(each, &[])?, Draws::new(draws, seed));
    let count = design_rows(&numbers, &draws);
    kept(
        count,
        width,
        "rows for which the function is asked",
        "take a smaller n, or fewer numbers",
    )?;
    reserve(count, 2 * size_of::<f64>() * width)?;
    let all = rows(py, count, move |row| design_row(&numbers, &draws, row))?;
    array(py, all, [draws.len(), width + 2, width])
}

/// First and total indices and their half widths (d, 4), from the answers (n, d + 2) to the design; rows with what is no number are left
/// out. And how many rows were used.
#[pyfunction]
pub fn sobol_of_answers<'py>(
    py: Python<'py>,
    answers: Vec<f64>,
    numbers: usize,
) -> PyResult<(Bound<'py, PyArray2<f64>>, usize)> {
    let (found, used) = sobol_indices(
        &Draws::new(answers.len() / (numbers + 2), 0),
        numbers,
        &answers,
    );
    let each = found.iter().flat_map(|s| {
        [
            s.first.value,
            s.first.plus_minus,
            s.total.value,
            s.total.plus_minus,
        ]
    });
    Ok((array(py, each.collect(), [numbers, 4])?, used))
}
