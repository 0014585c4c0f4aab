//! A map as a drawing of one section.

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Grid, MapPlace, PlaceState};
use kinetostat_report::{Cell, Plot, PlotLine, PlotMark, Section};

use crate::map::answer::MapAnswer;
use crate::map::arguments::MapArgs;
use crate::map::columns::Shown;
use crate::map::query::AXES;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::{load_triple, short};

/// Upper limit of the cells of a drawing along an axis; a finer grid is thinned.
const MOST_CELLS: usize = 400;

/// Content of a drawing: a section of the grid, or a curve along its only axis. Its size is bounded.
#[derive(Clone)]
pub(crate) struct Picture {
    pub(crate) show: Shown,
    /// Horizontal and vertical axis.
    pub(crate) axes: [usize; 2],
    /// Stride between the places along them.
    pub(crate) strides: [usize; 2],
    /// Numbers of the places along them.
    pub(crate) places: [Vec<usize>; 2],
    /// Axis across and the number of the places there.
    pub(crate) across: (usize, usize),
    pub(crate) grid: Grid,
    pub(crate) cells: Vec<Cell>,
    /// Something is drawn.
    pub(crate) wanted: bool,
}

impl Picture {
    pub(crate) fn new(args: &MapArgs, grid: &Grid, show: Shown) -> Answer<Self> {
        let across = across(args.section.as_deref(), grid)?;
        let axes = match across.0 {
            0 => [1, 2],
            1 => [0, 2],
            _ => [0, 1],
        };
        let strides = axes.map(|a| grid.counts[a].div_ceil(MOST_CELLS));
        let places = [0, 1].map(|k| {
            (0..grid.counts[axes[k]])
                .step_by(strides[k])
                .collect::<Vec<_>>()
        });
        Ok(Self {
            show,
            axes,
            strides,
            cells: vec![Cell::Value(f64::NAN); places[0].len() * places[1].len()],
            places,
            across,
            grid: *grid,
            wanted: args.plot.is_some(),
        })
    }

    /// The cell of a place and its number, if it lies in the section.
    pub(crate) fn cell(&self, place: &MapPlace) -> Option<(usize, Cell)> {
        if !self.wanted || place.index[self.across.0] != self.across.1 {
            return None;
        }
        let [a, b] = [0, 1].map(|k| {
            let own = place.index[self.axes[k]];
            own.is_multiple_of(self.strides[k])
                .then_some(own / self.strides[k])
        });
        let at = a? + b? * self.places[0].len();
        let cell = match place.state {
            PlaceState::Unreachable => Cell::Other(0),
            PlaceState::OutsideLimits => Cell::Other(1),
            PlaceState::Unstable | PlaceState::Unanswered => Cell::Other(2),
            PlaceState::Regular | PlaceState::Singular => Cell::Value(self.show.of(place)),
        };
        Some((at, cell))
    }

    pub(crate) fn along(&self, k: usize) -> Vec<f64> {
        let axis = self.axes[k];
        let places = self.places[k].iter();
        places.map(|i| self.grid.position_mm(axis, *i)).collect()
    }

    pub(crate) fn svg(&self, a: &MapAnswer, lines: Vec<PlotLine>, marks: Vec<PlotMark>) -> String {
        let fixed: Vec<String> = (0..3)
            .filter(|k| self.grid.counts[*k] == 1 || *k == self.across.0)
            .map(|k| {
                let index = if k == self.across.0 { self.across.1 } else { 0 };
                let at = self.grid.position_mm(k, index);
                format!("{} = {} mm", AXES[k], short(at))
            })
            .collect();
        let under = match a.loaded {
            _ if a.cases > 1 => format!("; worst of {} orientations and loads", a.cases),
            true => format!(
                "; force {} N, moment {} N m on the tool",
                load_triple(a.force_n),
                load_triple(a.moment_n_m)
            ),
            false => "; no load".to_owned(),
        };
        let tool = match a.tool.starts_with("none") {
            true => "; no tool".to_owned(),
            false => format!("; tool {}", a.tool),
        };
        let title = format!(
            "{}: {} at {}{under}{tool}",
            a.model,
            self.show.description(),
            fixed.join(", ")
        );
        let label = |k: usize| format!("{}, mm", AXES[self.axes[k]]);
        let value_label = format!("{}, {}", self.show.description(), self.show.unit());
        let single = (0..2).find(|k| self.places[*k].len() == 1);
        if let Some(single) = single {
            let values = self.cells.iter().map(|c| match c {
                Cell::Value(x) => *x,
                Cell::Other(_) | Cell::Grey(_) => f64::NAN,
            });
            let points = self.along(1 - single).into_iter().zip(values).collect();
            return Plot {
                title,
                x_label: label(1 - single),
                y_label: value_label,
                lines: vec![PlotLine {
                    points,
                    ..PlotLine::default()
                }],
                marks: Vec::new(),
            }
            .svg();
        }
        Section {
            title,
            x_label: label(0),
            y_label: label(1),
            value_label,
            x: self.along(0),
            y: self.along(1),
            cells: self.cells.clone(),
            others: vec![
                "cannot be reached".into(),
                "outside limits".into(),
                "not stable".into(),
            ],
            lines,
            marks,
            interpolated: true,
            ..Section::default()
        }
        .svg()
    }
}

/// The axis across the section and the number of the places in it.
fn across(section: Option<&str>, grid: &Grid) -> Answer<(usize, usize)> {
    let Some(text) = section else {
        // Across an axis with one place, or else across z.
        let axis = (0..3).rev().find(|k| grid.counts[*k] == 1).unwrap_or(2);
        return Ok((axis, (grid.counts[axis] - 1) / 2));
    };
    let refuse = || {
        ErrorCode::Value.failure(format!(
                "--section '{text}': write the axis across the section and where it is cut in mm, as in z=150"
            ),
        )
    };
    let (name, value) = text.split_once('=').ok_or_else(refuse)?;
    let axis = AXES.iter().position(|a| *a == name.trim().to_lowercase());
    let axis = axis.ok_or_else(refuse)?;
    let value: f64 = value.trim().parse().map_err(|_| refuse())?;
    let far = |i: usize| (grid.position_mm(axis, i) - value).abs();
    let nearest = (0..grid.counts[axis]).min_by(|a, b| far(*a).total_cmp(&far(*b)));
    nearest
        .filter(|_| value.is_finite())
        .map(|i| (axis, i))
        .ok_or_else(refuse)
}
