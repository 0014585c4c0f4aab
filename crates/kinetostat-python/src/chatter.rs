//! Stability of a milling cut from modal data of the tool.

use kinetostat::nalgebra::{DMatrix, Matrix3, Vector3};
use kinetostat_chatter::{
    Arc, ChatterError, Coefficients, Coupled, FeedFrame, Instability, Milled, MillingCut, Mode,
    Process, Regeneration, ToolResponse, coupled_limit, zeroth_order,
};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::arrays::{Numbers, reserve, rows};
use crate::errors::{Class, error};
use crate::work::{Manner, away};

fn refused(found: ChatterError) -> PyErr {
    error(Class::Argument, found.to_string())
}

/// A cut as Python hands it over.
#[derive(FromPyObject)]
pub struct Cut {
    teeth: usize,
    up: bool,
    immersion: f64,
    /// Pa.
    coefficients: [f64; 3],
    /// rad, m.
    helix: Option<(f64, f64)>,
    feed: [f64; 3],
    tool_axis: [f64; 3],
}

impl Cut {
    fn regeneration(&self, tool: &ToolResponse) -> Result<Regeneration, ChatterError> {
        let milled = match self.up {
            true => Milled::Up,
            false => Milled::Down,
        };
        let [tangential, radial, axial] = self.coefficients;
        let coefficients = Coefficients::new(tangential, radial, axial)?;
        let arc = Arc::straight(milled, self.immersion)?;
        let mut cut = MillingCut::new(self.teeth, arc, coefficients)?;
        if let Some((angle, diameter)) = self.helix {
            cut = cut.with_helix(angle, diameter)?;
        }
        let frame = FeedFrame::new(self.feed.into(), self.tool_axis.into())?;
        Regeneration::new(tool.in_frame(&frame), cut.into())
    }
}

/// Modal data of a tool's tip as Python hands them over.
#[derive(FromPyObject)]
pub struct Tip<'py> {
    shapes: Numbers<'py>,
    squared: Numbers<'py>,
    damping_ratios: Numbers<'py>,
    residual: Numbers<'py>,
    held: Numbers<'py>,
    rates: Option<Numbers<'py>>,
}

fn tool(tip: &Tip<'_>) -> PyResult<ToolResponse> {
    let Tip {
        shapes,
        squared,
        damping_ratios: ratios,
        residual,
        held,
        rates,
    } = tip;
    let (count, shapes) = rows("shapes", shapes, &[3])?;
    let (squares, squared) = rows("squared", squared, &[])?;
    let (damped, ratios) = rows("damping_ratios", ratios, &[])?;
    let (three, residual) = rows("residual", residual, &[3])?;
    if count != squares || count != damped || three != 3 {
        return Err(error(
            Class::Argument,
            format!(
                "shapes ({count}, 3), frequencies ({squares},), damping ratios ({damped},) and residual ({three}, 3) do not belong together"
            ),
        ));
    }
    let each = shapes.as_chunks::<3>().0.iter().zip(squared).zip(ratios);
    let modes = each
        .map(|((shape, squared), ratio)| Mode::new(Vector3::from(*shape), *squared, *ratio))
        .collect::<Result<Vec<_>, _>>()
        .map_err(refused)?;
    let residual = Matrix3::from_row_slice(residual);
    let tool = ToolResponse::new(modes)
        .and_then(|tool| tool.with_residual(residual))
        .map_err(refused)?;
    let Some(rates) = rates else {
        return Ok(tool);
    };
    let (without_mass, held) = rows("held", held, &[3])?;
    let n = count + without_mass;
    let (_, rates) = rows("rates", rates, &[n])?;
    if rates.len() != n * n {
        let found = format!("rates has {} numbers, expected ({n}, {n})", rates.len());
        return Err(error(Class::Argument, found));
    }
    let held = held.as_chunks::<3>().0.iter().map(|h| Vector3::from(*h));
    tool.with_coupled_damping(DMatrix::from_row_slice(n, n, rates), held.collect())
        .map_err(refused)
}

/// Limits of a cut over spindle speeds (s,), rpm, up to a depth, m; NaN where there is none. See `kinetostat.chatter.lobes`.
#[pyfunction]
#[pyo3(signature = (tip, cut, speeds, up_to, threads=None, progress=None))]
pub fn lobes_of<'py>(
    py: Python<'py>,
    tip: Tip<'py>,
    cut: Cut,
    speeds: Numbers<'py>,
    up_to: f64,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let tool = tool(&tip)?;
    let regeneration = cut.regeneration(&tool).map_err(refused)?;
    let (_, speeds) = rows("speeds_rpm", &speeds, &[])?;
    let speeds = speeds.to_vec();
    let manner = Manner { threads, progress };
    let found = away(py, &manner, move |course| {
        course.of(speeds.len());
        let each = speeds.par_iter().map(|speed| {
            // Cancelled work is not solved, and dropped.
            if course.stopped() {
                return Ok(None);
            }
            let exact = regeneration.stability_at(*speed, up_to)?;
            let zeroth_order = zeroth_order::limit(&regeneration, *speed)?;
            course.add(1);
            Ok(Some((exact, zeroth_order)))
        });
        each.collect::<Result<Vec<_>, ChatterError>>()
    })?;
    let found: Vec<_> = found.map_err(refused)?.into_iter().flatten().collect();
    let limits: Vec<_> = found.iter().map(|(exact, _)| exact.limit()).collect();
    let number = |of: &dyn Fn(&kinetostat_chatter::Crossing) -> f64| {
        let each = limits.iter().map(|limit| limit.map_or(f64::NAN, of));
        PyArray1::from_vec(py, each.collect())
    };
    let answer = PyDict::new(py);
    answer.set_item("limit", number(&|c| c.depth))?;
    answer.set_item("frequency_hz", number(&|c| c.frequency_hz))?;
    answer.set_item("resolved", number(&|c| c.resolved))?;
    let flips = limits
        .iter()
        .map(|limit| limit.is_some_and(|c| c.kind == Instability::Flip));
    answer.set_item("flip", PyArray1::from_vec(py, flips.collect()))?;
    let zeroth = found
        .iter()
        .map(|(_, limit)| limit.map_or(f64::NAN, |l| l.depth));
    answer.set_item("zeroth_order", PyArray1::from_vec(py, zeroth.collect()))?;
    let stable: Vec<Vec<(f64, f64)>> = found.iter().map(|(exact, _)| exact.stable()).collect();
    answer.set_item("stable", stable)?;
    Ok(answer)
}

/// Size of the largest multiplier of one period at speeds (rpm) and depths (m), (n,) each.
#[pyfunction]
#[pyo3(signature = (tip, cut, speeds, depths, threads=None, progress=None))]
pub fn multipliers_of<'py>(
    py: Python<'py>,
    tip: Tip<'py>,
    cut: Cut,
    speeds: Numbers<'py>,
    depths: Numbers<'py>,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let tool = tool(&tip)?;
    let regeneration = cut.regeneration(&tool).map_err(refused)?;
    let (count, speeds) = rows("speeds_rpm", &speeds, &[])?;
    let (other, depths) = rows("depths", &depths, &[])?;
    if count != other {
        return Err(error(
            Class::Argument,
            format!(
                "speeds_rpm has shape ({count},) and depths ({other},): one depth for each speed"
            ),
        ));
    }
    reserve(count, 3 * size_of::<f64>())?;
    let pairs: Vec<(f64, f64)> = speeds.iter().copied().zip(depths.iter().copied()).collect();
    let manner = Manner { threads, progress };
    let found = away(py, &manner, move |course| {
        course.of(pairs.len());
        let each = pairs.par_iter().map(|(speed, depth)| {
            if course.stopped() {
                return Ok(f64::NAN);
            }
            let size = regeneration.multiplier(*speed, *depth)?.size();
            course.add(1);
            Ok(size)
        });
        each.collect::<Result<Vec<_>, ChatterError>>()
    })?;
    Ok(PyArray1::from_vec(py, found.map_err(refused)?))
}

/// The smallest process along a chip and a force direction that makes the tool unstable without any delay: factor, N/m, whether it
/// flutters, frequency, Hz; nothing where none does. See `kinetostat.chatter.coupled_limit`.
#[pyfunction]
pub fn coupled_limit_of<'py>(
    tip: Tip<'py>,
    chip: [f64; 3],
    force: [f64; 3],
) -> PyResult<Option<(f64, bool, f64)>> {
    let tool = tool(&tip)?;
    let process = Process::new(chip.into(), force.into()).map_err(refused)?;
    let found = coupled_limit(&tool, &process).map_err(refused)?;
    Ok(found.map(|limit| {
        let flutters = limit.kind == Coupled::Flutter;
        (limit.factor, flutters, limit.frequency_hz)
    }))
}
