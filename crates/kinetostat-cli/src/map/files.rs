//! The files of a map: the table, the drawing, and the fields for other programs.

use std::path::Path;

use contour::ContourBuilder;
use kinetostat::PostureRequest;
use kinetostat::number::{larger, smaller};
use kinetostat_analysis::outline::chain_outline;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::fields::Fields;
use kinetostat_machining::MapTask;
use kinetostat_report::{Cell, PlotLine, PlotMark, Section};

use crate::files::outputs::Outputs;
use crate::map::answer::MapAnswer;
use crate::map::arguments::MapArgs;
use crate::map::fields::{Gathering, netcdf};
use crate::map::picture::Picture;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::number;

/// Places of the files among the outputs.
pub(crate) struct Files {
    pub(crate) csv: Option<usize>,
    plot: Option<usize>,
    vtk: Option<usize>,
    netcdf: Option<usize>,
    parquet: Option<usize>,
}

impl Files {
    /// Claims what the options name.
    pub(crate) fn claimed(args: &MapArgs, outputs: &mut Outputs) -> Answer<Self> {
        let mut claim =
            |what, path: Option<&Path>| path.map(|p| outputs.claim(what, p)).transpose();
        Ok(Self {
            csv: claim("table", args.csv.as_deref())?,
            plot: claim("plot", args.plot.as_deref())?,
            vtk: claim("VTK file", args.vtk.as_deref())?,
            netcdf: claim("NetCDF file", args.netcdf.as_deref())?,
            parquet: claim("Parquet file", args.parquet.as_deref())?,
        })
    }

    /// True if fields are gathered.
    pub(crate) fn want_fields(&self) -> bool {
        self.vtk.is_some() || self.netcdf.is_some() || self.parquet.is_some()
    }

    /// Draws the section.
    pub(crate) fn draw(
        &self,
        outputs: &mut Outputs,
        task: &MapTask<'_>,
        answer: &MapAnswer,
        picture: &Picture,
    ) -> Answer<()> {
        let Some(index) = self.plot else {
            return Ok(());
        };
        let mut lines = isolines(picture);
        lines.extend(outline(task, picture));
        let marks = extremes(picture);
        outputs.fill(index, picture.svg(answer, lines, marks).as_bytes())
    }

    /// Writes the fields in the forms that are asked for.
    pub(crate) fn write_fields(
        &self,
        outputs: &mut Outputs,
        gathering: Option<Gathering>,
    ) -> Answer<()> {
        let Some(fields) = gathering.map(Gathering::done) else {
            return Ok(());
        };
        if let Some(index) = self.vtk {
            outputs.fill(index, &fields.vtk())?;
        }
        if let Some(index) = self.netcdf {
            outputs.fill(index, &netcdf(&fields)?)?;
        }
        if let Some(index) = self.parquet {
            outputs.fill(index, &parquet_of(&fields)?)?;
        }
        Ok(())
    }
}

#[cfg(feature = "parquet")]
fn parquet_of(fields: &Fields) -> Answer<Vec<u8>> {
    fields
        .parquet()
        .map_err(|error| ErrorCode::Output.failure(error))
}

#[cfg(not(feature = "parquet"))]
fn parquet_of(_: &Fields) -> Answer<Vec<u8>> {
    Err(ErrorCode::NotBuiltIn.failure("--parquet: this program was built without Parquet"))
}

/// Nearer than this to a place, in steps of the grid, a line runs through it.
const EDGE: f64 = 1e-6;
/// Stands where there is no value; what is found beside it is no line.
const NOTHING: f64 = -1e300;

fn value(cell: &Cell) -> f64 {
    match cell {
        Cell::Value(x) if x.is_finite() => *x,
        _ => f64::NAN,
    }
}

/// Lines of equal value, where the colours of the section change.
fn isolines(picture: &Picture) -> Vec<PlotLine> {
    let values: Vec<f64> = picture.cells.iter().map(value).collect();
    let known = || values.iter().copied().filter(|x| !x.is_nan());
    let (low, high) = (
        known().fold(f64::INFINITY, smaller),
        known().fold(f64::NEG_INFINITY, larger),
    );
    let [nx, ny] = [0, 1].map(|k| picture.places[k].len());
    if !(high - low).is_normal() || high - low < 1e-9 * high.abs() || nx < 3 || ny < 3 {
        return Vec::new();
    }
    let levels = Section::borders(known());
    let filled: Vec<f64> = values
        .iter()
        .map(|x| if x.is_nan() { NOTHING } else { *x })
        .collect();
    // The grid of the contours is shifted by half a cell from the places.
    let builder = ContourBuilder::new(nx, ny, true);
    let Ok(lines) = builder.lines(&filled, &levels) else {
        return Vec::new();
    };
    let [x, y] = [0, 1].map(|k| picture.along(k));
    let at = |places: &[f64], k: f64| {
        let last = places.len() - 1;
        let step = (places[last] - places[0]) / last as f64;
        places[0] + step * k
    };
    let place = |c: &contour_coordinate::Coordinate| {
        let (i, j) = (c.x - 0.5, c.y - 0.5);
        let inside = i >= 0.0 && j >= 0.0 && i <= (nx - 1) as f64 && j <= (ny - 1) as f64;
        // A line that runs through a place beside one without a value is the border of the values, no line of equal ones.
        let beside = |at: f64, count: usize| {
            let last = (count - 1) as f64;
            [(at - EDGE).floor().max(0.0), (at + EDGE).ceil().min(last)].map(|at| at as usize)
        };
        let known = |i: usize, j: usize| !values[j * nx + i].is_nan();
        let all_known = || {
            let rows = beside(j, ny);
            let mut columns = beside(i, nx).into_iter();
            columns.all(|i| rows.into_iter().all(|j| known(i, j)))
        };
        match inside && all_known() {
            true => (at(&x, i), at(&y, j)),
            false => (f64::NAN, f64::NAN),
        }
    };
    let strings = lines.iter().flat_map(|line| &line.geometry().0);
    strings
        .map(|string| PlotLine {
            points: string.0.iter().map(place).collect(),
            ..PlotLine::default()
        })
        .collect()
}

/// The crate's kind of a point, by a name of our own.
mod contour_coordinate {
    pub(super) type Coordinate = geo_types::Coord<f64>;
}

/// The best and the worst place of the section.
fn extremes(picture: &Picture) -> Vec<PlotMark> {
    let (x, y) = (picture.along(0), picture.along(1));
    let known = picture.cells.iter().enumerate();
    let known = known
        .map(|(i, c)| (i, value(c)))
        .filter(|(_, v)| !v.is_nan());
    let least = known.clone().min_by(|a, b| a.1.total_cmp(&b.1));
    let most = known.max_by(|a, b| a.1.total_cmp(&b.1));
    let names = match picture.show.small_is_bad() {
        Some(true) => ["worst", "best"],
        Some(false) => ["best", "worst"],
        None => ["least", "most"],
    };
    let (Some(least), Some(most)) = (least, most) else {
        return Vec::new();
    };
    if least.1 == most.1 {
        return Vec::new();
    }
    let mark = |((i, v), name): ((usize, f64), &str)| PlotMark {
        at: (x[i % x.len()], y[i / x.len()]),
        name: format!("{name} {}", number(v, 3)),
        detail: format!("{name}: {} {}", number(v, 5), picture.show.unit()),
    };
    [least, most].into_iter().zip(names).map(mark).collect()
}

/// The limbs of the machine with its tool in the middle of the section.
fn outline(task: &MapTask<'_>, picture: &Picture) -> Vec<PlotLine> {
    let middle = [0, 1].map(|k| {
        let places = &picture.places[k];
        places[places.len() / 2]
    });
    let mut position = [0.0; 3];
    for k in 0..2 {
        position[picture.axes[k]] = picture.grid.position_mm(picture.axes[k], middle[k]);
    }
    let (across, index) = picture.across;
    position[across] = picture.grid.position_mm(across, index);
    let position = nalgebra::Vector3::from(position) * 1e-3;
    let pose = kinetostat::Pose::from_parts(position.into(), task.orientation);
    let request = match task.orientation_follows {
        true => PostureRequest::position(&position, &task.orientation),
        false => PostureRequest::pose(&pose),
    };
    let Ok(posture) = task.mechanism.posture(request) else {
        return Vec::new();
    };
    let limbs = task.mechanism.limbs().iter().zip(posture.limbs());
    limbs
        .map(|(limb, joints)| {
            let base = &posture.platforms()[limb.from];
            let line = chain_outline(&limb.nominal, base, &joints.commands, &joints.coordinates);
            let points = line.iter().map(|p| {
                let mm = p * 1e3;
                (mm[picture.axes[0]], mm[picture.axes[1]])
            });
            PlotLine::dashed("machine with its tool in the middle", 0, points.collect())
        })
        .collect()
}
