//! The stock as a program removes it, as the page draws it: heights over a grid, not finer than a picture shows.

use std::sync::{Mutex, PoisonError};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Placement, StockAlong};
use nalgebra::Vector3;

use crate::shown::answer::StockAtPlace;
use crate::ui::failure::{Answer, Failing};

/// Points of the grid along its longer side.
const POINTS: usize = 160;

/// The stock of a job along its program.
pub(crate) struct ShownStock {
    /// It remembers how far it was asked last.
    along: Mutex<StockAlong>,
    placement: Placement,
}

impl ShownStock {
    pub(crate) fn of(along: StockAlong, placement: &Placement) -> Self {
        Self {
            along: Mutex::new(along),
            placement: *placement,
        }
    }

    /// What is left when the tool has come to a share of a move.
    pub(crate) fn at(&self, (index, share): (usize, f64)) -> Answer<StockAtPlace> {
        let mut along = self.along.lock().unwrap_or_else(PoisonError::into_inner);
        let left = along
            .at(index, share)
            .map_err(|error| ErrorCode::Value.failure(error))?;
        drop(along);
        let [low, high] = left.space_mm();
        let longer = (high[0] - low[0]).max(high[1] - low[1]);
        let step = left.cell_mm().max(longer / POINTS as f64);
        let cells = [0, 1].map(|k| ((high[k] - low[k]) / step).round().max(1.0));
        let steps = [0, 1].map(|k| (high[k] - low[k]) / cells[k]);
        let counts = cells.map(|count| count as usize + 1);
        // A point on the rim has the height just inside of it.
        let inside = |k: usize, i: usize| {
            let half = 0.5 * left.cell_mm().min(high[k] - low[k]);
            (low[k] + steps[k] * i as f64).clamp(low[k] + half, high[k] - half)
        };
        let places = (0..counts[1]).flat_map(|j| (0..counts[0]).map(move |i| [i, j]));
        let height = |[i, j]: [usize; 2]| {
            let top = left.top_mm(inside(0, i), inside(1, j))?;
            Some((top - low[2]) as f32)
        };
        let in_base = |v: Vector3<f64>| -> [f64; 3] { (self.placement.to_metres(&v) * 1e3).into() };
        let origin = self.placement.base_from_part.translation.vector * 1e3;
        Ok(StockAtPlace {
            corner_mm: (origin + Vector3::from(in_base(low.into()))).into(),
            steps_mm: [0, 1].map(|k| in_base(Vector3::ith(k, steps[k]))),
            up_mm: in_base(Vector3::z()),
            counts,
            heights: places.map(height).collect(),
        })
    }
}
