//! Overlays of a map: lines of equal value, the best and the worst place, the machine.

use contour::ContourBuilder;
use kinetostat::PostureRequest;
use kinetostat_analysis::outline::chain_outline;
use kinetostat_machining::MapTask;
use kinetostat_report::{Cell, PlotLine, PlotMark};

use kinetostat::number::{larger, smaller};

use crate::map::picture::Picture;
use crate::ui::numbers::number;

/// About as many lines of equal value.
const LINES: f64 = 6.0;
/// Stands where there is no value; what is found beside it is no line.
const NOTHING: f64 = -1e300;

fn value(cell: &Cell) -> f64 {
    match cell {
        Cell::Value(x) if x.is_finite() => *x,
        _ => f64::NAN,
    }
}

/// Lines of equal value, at round ones.
pub(crate) fn isolines(picture: &Picture) -> Vec<PlotLine> {
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
    let step = round((high - low) / LINES);
    let first = (low / step).floor() as i64 + 1;
    let levels: Vec<f64> = (first..)
        .map(|k| k as f64 * step)
        .take_while(|level| *level < high)
        .collect();
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
        let beside = [(i.floor(), j.floor()), (i.ceil(), j.ceil())];
        let known = |(i, j): (f64, f64)| !values[j as usize * nx + i as usize].is_nan();
        match inside && beside.into_iter().all(known) {
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

/// 1, 2 or 5 times a power of ten.
fn round(step: f64) -> f64 {
    let power = 10_f64.powf(step.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0];
    let own = factor.into_iter().find(|f| f * power >= step);
    own.unwrap_or(10.0) * power
}

/// The best and the worst place of the section.
pub(crate) fn extremes(picture: &Picture) -> Vec<PlotMark> {
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
pub(crate) fn outline(task: &MapTask<'_>, picture: &Picture) -> Vec<PlotLine> {
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
