//! From measured points to deviations at the stations of a path.
//!
//! Scatter of a point, from the differences between neighbours.
//!
//! Distances from the smoothed deviation have in them what the smoothing does not let through. Differences of a higher order have
//! next to nothing of it: of the deviations of `m + 1` neighbours at the lengths `x_i` along the path the sum `sum c_i e_i`,
//! `c_i = (-1)^i prod_{j < k; j, k != i} (x_k - x_j)`, is none for every polynomial below the order `m` (the divided difference
//! times Vandermonde's determinant, so that two points at one place do no harm). If the `e_i` scatter with the standard deviation
//! `sigma`, it has `sigma |c|` (von Neumann 1941; of a higher order Gasser, Sroka and Jennen-Steinmetz 1986). The median of its
//! length over all neighbours does not follow outliers (Rayleigh, two directions).
//!
//! A wave that turns by the angle `a` from point to point leaves about `a^m / sqrt((2 m)! / m!^2)` of its height: a high order sees
//! less of it. An outlier spoils `m + 1` of them: a low order sees less of that. Each can only add to the scatter, so that
//! the smaller of two orders is nearer to it.

use kinetostat_program::{NominalPath, WhyLeftOut};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::alignment::{AlignedPoint, Alignment, LeftOut, align};
use crate::deviation::kernel::{Kernel, Smoothed};
use crate::deviation::outliers::{Outlier, take_outliers};
use crate::deviation::stations::Stations;
use crate::deviation::unseen::{Unseen, unseen};
use crate::error::MirrorError;
use crate::number::{OF_TWO_DIRECTIONS, larger, median, smaller};
use crate::points::{MeasuredPoint, MeasuredPoints};
use crate::registration::{Motion, Registration, RegistrationOptions, of_the_same_size, register};

/// Largest share of points beyond the window for a motion onto the path.
const MOST_BEYOND: f64 = 0.1;

/// Motion that brings measured points into the frame of the program before they are compared with its path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Register {
    /// No motion: the points are in the frame of the program, and a shift of the whole is a deviation.
    None,
    /// A shift.
    Translation,
    /// A shift and a turn.
    Rigid,
}

/// Reads a registration; states of earlier versions have `true` for a rigid motion and `false` for none.
fn word_or_bool<'de, D: serde::Deserializer<'de>>(from: D) -> Result<Register, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Written {
        IsRigid(bool),
        Word(Register),
    }
    Ok(match Written::deserialize(from)? {
        Written::IsRigid(true) => Register::Rigid,
        Written::IsRigid(false) => Register::None,
        Written::Word(word) => word,
    })
}

impl Register {
    /// Name on the command line and in states.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Translation => "translation",
            Self::Rigid => "rigid",
        }
    }
}

/// Settings by which points become deviations; equal for all trials of a program.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct MeasureSettings {
    /// Standard deviation of the kernel along the path, mm.
    pub smoothing_mm: f64,
    /// Maximum distance of the tool from its path, mm.
    pub window_mm: f64,
    /// Rule by which points find their places.
    pub align: Alignment,
    /// Registration onto the path before that. The motion that it takes away is not corrected.
    #[serde(deserialize_with = "word_or_bool")]
    pub register: Register,
    /// True if a rigid motion onto the path has a scale.
    pub scale: bool,
}

impl Default for MeasureSettings {
    fn default() -> Self {
        Self {
            smoothing_mm: 5.0,
            window_mm: RegistrationOptions::default().window_mm,
            align: Alignment::Nearest,
            register: Register::Rigid,
            scale: false,
        }
    }
}

/// A measurement, compared with the path.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// The motion onto the path, where one was sought.
    pub registration: Option<Registration>,
    /// Points that count, in the order along the path.
    pub points: Vec<AlignedPoint>,
    /// Smoothed deviation at each of them.
    pub at_points: Vec<Smoothed>,
    /// Points that no neighbour bears out.
    pub outliers: Vec<Outlier>,
    /// Rows of points beside a corner that may belong to its other leg: they do not count.
    pub beside_corners: Vec<usize>,
    /// Points without a place on the path.
    pub left_out: Vec<LeftOut>,
    /// Smoothed deviation at each station.
    pub at_stations: Vec<Smoothed>,
    /// Parts of the path that the points do not cover.
    pub unseen: Vec<Unseen>,
    /// [`MeasuredPoints::known_to_mm`] of its points.
    pub known_to_mm: f64,
    /// Sizes.
    pub figures: DeviationFigures,
}

/// Compares a measurement with the path.
///
/// ```
/// use kinetostat_mirror::{MeasureSettings, MeasuredPoints, NominalPath, Register, measure};
/// use kinetostat_program::{Program, ReadOptions, interpret};
/// use nalgebra::Vector3;
///
/// let program = Program::read("G21 G90\nG0 X0 Y0 Z0\nG1 X100 F300\n")?;
/// let path = interpret(&program, &ReadOptions::default())?;
/// let nominal = NominalPath::new(&path)?;
/// let points: Vec<_> = (0..=100).map(|x| Vector3::new(f64::from(x), 0.05, 0.0)).collect();
/// let settings = MeasureSettings { register: Register::None, ..MeasureSettings::default() };
/// let measured = measure(&nominal, &MeasuredPoints::at(&points)?, &settings)?;
/// assert!((measured.figures.smoothed_largest_mm - 0.05).abs() < 1e-4);
/// assert!(measured.outliers.is_empty() && measured.unseen.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Settings that are no lengths, or a smoothing length that is far too small for the path; a registration that fails, and points none of which has a place on the path.
pub fn measure(
    nominal: &NominalPath<'_>,
    measured: &MeasuredPoints,
    settings: &MeasureSettings,
) -> Result<Measurement, MirrorError> {
    let stations = Stations::of(nominal, settings.smoothing_mm)?;
    if !(settings.window_mm > 0.0 && settings.window_mm.is_finite()) {
        return Err(MirrorError::new(format!(
            "the window is {} mm; expected a length above 0",
            settings.window_mm
        )));
    }
    let options = RegistrationOptions {
        with_scale: settings.scale,
        only_shift: settings.register == Register::Translation,
        window_mm: settings.window_mm,
    };
    let registration = match settings.register {
        Register::None => {
            of_the_same_size(nominal, measured, Some(settings.smoothing_mm))?;
            None
        }
        _ => Some(register(nominal, measured, options)?),
    };
    let motion = registration
        .as_ref()
        .map_or_else(Motion::default, |found| found.motion);
    let moved: Vec<(MeasuredPoint, Vector3<f64>)> = measured
        .points()
        .iter()
        .map(|point| (*point, motion.of(&point.position_mm)))
        .collect();
    let (mut points, left_out) = align(nominal, &moved, settings.align, settings.window_mm);
    let taken = take_outliers(nominal, &mut points, measured.known_to_mm());
    if points.is_empty() {
        return Err(MirrorError::new(nothing_left(
            measured, &left_out, settings,
        )));
    }
    if let Some(found) = &registration {
        is_of_this_path(found, &left_out, measured.points().len(), settings)?;
    }
    let kernel = Kernel {
        length_mm: settings.smoothing_mm,
    };
    let [at_points, at_stations] = smoothed_along(&stations, kernel, &points);
    let scatter = scatter_mm(&stations, &points, settings.smoothing_mm);
    let figures = figures(&points, &at_points, &stations, &at_stations, scatter);
    Ok(Measurement {
        unseen: unseen(nominal, &points, settings.smoothing_mm),
        registration,
        points,
        at_points,
        outliers: taken.outliers,
        beside_corners: taken.beside_corners,
        left_out,
        at_stations,
        known_to_mm: measured.known_to_mm(),
        figures,
    })
}

/// A motion onto the path that leaves more than a tenth of the points beyond the window brought together what does not belong
/// together: the rest lies on the path by chance.
fn is_of_this_path(
    found: &Registration,
    left_out: &[LeftOut],
    count: usize,
    settings: &MeasureSettings,
) -> Result<(), MirrorError> {
    let beyond = left_out
        .iter()
        .filter(|point| point.why == WhyLeftOut::BeyondWindow);
    let beyond = beyond.count();
    if beyond as f64 <= MOST_BEYOND * count as f64 {
        return Ok(());
    }
    Err(MirrorError::new(format!(
        "{beyond} of its {count} points have no place on the path: they are beyond the window of {} mm after the motion that brings them nearest to it (turned by {:.3} deg, moved by {:.3} mm). Where more than a tenth are, that motion is not to be trusted; nothing was mirrored. Check units and frame, leave out points that are not of this path, widen the window, or give the points in the frame of the program and do not register them",
        settings.window_mm,
        found.motion.rotation.angle().to_degrees(),
        found.motion.shift_mm.norm()
    )))
}

fn nothing_left(
    measured: &MeasuredPoints,
    left_out: &[LeftOut],
    settings: &MeasureSettings,
) -> String {
    let elsewhere = |point: &LeftOut| point.why == WhyLeftOut::NotOnItsLine;
    if left_out.iter().all(elsewhere) && !left_out.is_empty() {
        return format!(
            "none of the {} measured points lies on the cut of the line that it names: check the column line, which has numbers of lines of the program that cut at feed",
            measured.points().len()
        );
    }
    let nearest = left_out.iter().filter_map(|point| point.distance_mm);
    let nearest = nearest.min_by(f64::total_cmp).unwrap_or(f64::NAN);
    format!(
        "none of the {} measured points has a place on the path within {} mm that is the only one; the nearest is {nearest:.3} mm away: check units and frame, register the points, widen the window, or align them by arc length",
        measured.points().len(),
        settings.window_mm
    )
}

/// Orders of the differences: of a wave of ten points they leave a 19th and a 176th of its height.
const ORDERS: [usize; 2] = [3, 5];

/// Minimum number of values for a median: that of five which do not depend on each other is twice the true one once in 450
/// times.
const FEWEST: usize = 5;

/// The standard deviation of a point in one direction, mm, from neighbours that are no farther apart than this; `None` where
/// there are too few of them.
fn scatter_mm(stations: &Stations, points: &[AlignedPoint], apart_mm: f64) -> Option<f64> {
    let of_orders = ORDERS.map(|order| of_order(stations, points, apart_mm, order));
    let known = of_orders.into_iter().flatten();
    known.reduce(smaller)
}

fn of_order(
    stations: &Stations,
    points: &[AlignedPoint],
    apart_mm: f64,
    order: usize,
) -> Option<f64> {
    let mut lengths = Vec::new();
    for stretch in stations.stretches() {
        let first = points.partition_point(|point| point.piece < stretch.pieces.start);
        let end = points.partition_point(|point| point.piece < stretch.pieces.end);
        let groups = points[first..end].windows(order + 1);
        lengths.extend(groups.filter_map(|group| difference_mm(group, apart_mm)));
    }
    (lengths.len() >= FEWEST).then(|| OF_TWO_DIRECTIONS * median(lengths))
}

/// The length of the difference of neighbours, as large as the scatter of one of them; `None` where two are too far apart,
/// or so many at one place that nothing is left of it.
fn difference_mm(group: &[AlignedPoint], apart_mm: f64) -> Option<f64> {
    let near = |pair: &[AlignedPoint]| pair[1].along_mm - pair[0].along_mm <= apart_mm;
    let span = group.last()?.along_mm - group.first()?.along_mm;
    if !group.windows(2).all(near) || span <= 0.0 {
        return None;
    }
    let (mut sum, mut squares) = (Vector3::zeros(), 0.0);
    for (i, own) in group.iter().enumerate() {
        let mut share = if i % 2 == 0 { 1.0 } else { -1.0 };
        for (k, upper) in group.iter().enumerate().filter(|(k, _)| *k != i) {
            for (_, lower) in group[..k].iter().enumerate().filter(|(j, _)| *j != i) {
                share *= (upper.along_mm - lower.along_mm) / span;
            }
        }
        sum += own.deviation_mm * share;
        squares += share * share;
    }
    (squares > 0.0).then(|| sum.norm() / squares.sqrt())
}

/// Deviations smoothed at the points themselves and at the stations, stretch by stretch.
pub(crate) fn smoothed_along(
    stations: &Stations,
    kernel: Kernel,
    points: &[AlignedPoint],
) -> [Vec<Smoothed>; 2] {
    let (mut at_points, mut at_stations) = (Vec::new(), Vec::new());
    for stretch in stations.stretches() {
        let first = points.partition_point(|point| point.piece < stretch.pieces.start);
        let end = points.partition_point(|point| point.piece < stretch.pieces.end);
        let own = &points[first..end];
        let places: Vec<f64> = own.iter().map(|point| point.along_mm).collect();
        let along = &stations.along_mm()[stretch.stations.clone()];
        let smoothed = |places: &[f64]| match stretch.closed {
            true => kernel.smoothed_around(own, places, [along[0], along[along.len() - 1]]),
            false => kernel.smoothed(own, places),
        };
        at_points.extend(smoothed(&places));
        at_stations.extend(smoothed(along));
    }
    [at_points, at_stations]
}

/// Sizes of deviations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct DeviationFigures {
    /// Points that count.
    pub points: usize,
    /// Root of the mean square of their deviations, mm.
    pub rms_mm: f64,
    /// The largest of them, mm.
    pub largest_mm: f64,
    /// Root of the mean square along the path after smoothing, mm.
    pub smoothed_rms_mm: f64,
    /// The largest after smoothing, mm.
    pub smoothed_largest_mm: f64,
    /// Root of the mean product of deviation and smoothed deviation, mm: what the proof of convergence is about.
    pub passing_rms_mm: f64,
    /// Standard deviation of a point in one direction, mm, from what differs between neighbours no farther apart than the
    /// smoothing length.
    pub scatter_mm: f64,
    /// True if there are too few such neighbours: the scatter is that about the smoothed deviation, with all in it that
    /// bends within a smoothing length. The true one is no larger.
    #[serde(default)]
    pub scatter_has_bends: bool,
    /// Mean number of points that a smoothed deviation rests on.
    pub effective_points: f64,
}

/// Sizes of deviations at the points and at the stations, with the scatter that neighbours tell.
pub(crate) fn figures(
    points: &[AlignedPoint],
    at_points: &[Smoothed],
    stations: &Stations,
    at_stations: &[Smoothed],
    scatter_mm: Option<f64>,
) -> DeviationFigures {
    let mean = |pairs: &mut dyn Iterator<Item = (f64, f64)>| {
        let (mut sum, mut total) = (0.0, 0.0);
        for (value, weight) in pairs {
            sum += value * weight;
            total += weight;
        }
        sum / total
    };
    let both = || points.iter().zip(at_points);
    let squares = points
        .iter()
        .map(|p| (p.deviation_mm.norm_squared(), p.weight));
    let passing = both().map(|(p, smoothed)| {
        let product = p.deviation_mm.dot(&smoothed.deviation_mm);
        (product, p.weight * smoothed.support)
    });
    let off = both().map(|(p, smoothed)| (p.deviation_mm - smoothed.deviation_mm).norm());
    let lengths = stations.lengths_mm();
    let seen = || {
        let all = at_stations.iter().zip(&lengths);
        all.filter(|(smoothed, _)| smoothed.effective_points > 0.0)
    };
    let smoothed = seen().map(|(smoothed, length)| (smoothed.deviation_mm.norm_squared(), *length));
    DeviationFigures {
        points: points.len(),
        rms_mm: mean(&mut squares.into_iter()).sqrt(),
        largest_mm: points
            .iter()
            .map(|p| p.deviation_mm.norm())
            .fold(0.0, larger),
        smoothed_rms_mm: mean(&mut smoothed.into_iter()).sqrt(),
        smoothed_largest_mm: at_stations
            .iter()
            .map(|s| s.deviation_mm.norm())
            .fold(0.0, larger),
        passing_rms_mm: larger(mean(&mut passing.into_iter()), 0.0).sqrt(),
        scatter_mm: scatter_mm.unwrap_or_else(|| OF_TWO_DIRECTIONS * median(off.collect())),
        scatter_has_bends: scatter_mm.is_none(),
        effective_points: mean(&mut seen().map(|(s, length)| (s.effective_points, *length))),
    }
}
