//! Figures of the cut along a path, from its forces: every place in turn, and a result of bounded size.

use std::f64::consts::TAU;

use kinetostat_program::{Move, MoveKind, Path};

use crate::cut::profile::ForceAlongPath;
use crate::cut::station::CutStation;
use crate::result::cutting::{CutPlace, CuttingResult};
use crate::result::point::PointKind;
use crate::run::sites::site::starts;

/// Lines with the largest forces that are listed.
const WORST: usize = 10;

/// Every station of the cut along the path that its forces were computed for, in order, and the ends of its rapids.
///
/// ```
/// use std::sync::Arc;
///
/// use kinetostat_cutting::{Engagement, Linear, Shape, Side, Tool};
/// use kinetostat_machining::{
///     CutQuestion, CuttingTool, EngagementSource, ForceChoice, Unwatched, cut_places,
/// };
/// use kinetostat_program::{Program, ReadOptions, interpret};
///
/// let tool = CuttingTool::new(
///     Tool::new(Shape::Flat, 6.0, 2)?,
///     Arc::new(Linear::new([800.0, 200.0, 0.0], [0.0; 3])?), // N/mm2, N/mm
/// );
/// let question = CutQuestion {
///     tools: vec![tool],
///     engagement: EngagementSource::Constant(Engagement::straight(3.0, 6.0, 2.0, Side::Left)?),
///     choice: ForceChoice::Mean,
///     rpm: None,
///     rotation: None,
///     spindle: None,
/// };
/// let path = interpret(&Program::read("G21 S10000 M3\nG0 X0 Y0 Z0\nG1 X40 F600\n")?, &ReadOptions::default())?;
/// let forces = question.along(&path, &Unwatched)?;
/// let slot = cut_places(&forces, &path).last().unwrap();
/// assert_eq!((slot.line, slot.depth_mm, slot.rpm), (3, 2.0, 10_000.0));
/// assert!((slot.arc_deg - 180.0).abs() < 1e-9);
/// // Mean torque of a slot: K_tc depth feed teeth diameter / (2 pi).
/// assert!((slot.torque_n_m - 1e-3 * 800.0 * 2.0 * 0.03 * 2.0 * 6.0 / std::f64::consts::TAU).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn cut_places<'a>(
    forces: &'a ForceAlongPath,
    path: &'a Path,
) -> impl Iterator<Item = CutPlace> + 'a {
    let starts = starts(path);
    path.moves.iter().enumerate().flat_map(move |(i, motion)| {
        let start_mm = starts[i];
        let stations = forces.stations(i).iter();
        let cut = stations.map(move |station| place(forces, motion, i, start_mm, station));
        let rapid = motion.kind == MoveKind::Rapid;
        let end = rapid.then(|| CutPlace {
            kind: PointKind::Rapid,
            ..place(forces, motion, i, start_mm, &CutStation::air(1.0))
        });
        cut.chain(end)
    })
}

fn place(
    forces: &ForceAlongPath,
    motion: &Move,
    index: usize,
    start_mm: f64,
    station: &CutStation,
) -> CutPlace {
    let length = motion.known_length_mm();
    let limit = forces
        .spindle()
        .filter(|_| station.rpm > 0.0)
        .and_then(|curve| curve.limit_at(station.rpm));
    let force = station.wrench.force();
    CutPlace {
        line: motion.line,
        move_number: index + 1,
        kind: PointKind::Feed,
        share: station.share,
        path_mm: start_mm + station.share * length,
        position_mm: motion.point(station.share).into(),
        depth_mm: station.depth_mm,
        arc_deg: station.arc.to_degrees(),
        force_along_feed_n: force.x,
        force_left_n: force.y,
        force_up_n: force.z,
        torque_n_m: station.torque_n_m,
        power_w: station.torque_n_m * station.rpm * TAU / 60.0,
        spindle_torque_n_m: limit.map(|limit| limit.torque_n_m),
        chip_mm: station.chip_mm,
        feed_per_tooth_mm: station.feed_per_tooth_mm,
        rpm: station.rpm,
    }
}

/// Figures of the cut along the path that its forces were computed for: the largest values, and a bounded number of places.
#[must_use]
pub fn cutting_result(forces: &ForceAlongPath, path: &Path) -> CuttingResult {
    let total = cut_places(forces, path).count();
    let mut result = CuttingResult {
        spread_percent: 100.0 * forces.spread(),
        ..CuttingResult::default()
    };
    let mut kept = Kept::new(total);
    let mut before: Option<CutPlace> = None;
    for place in cut_places(forces, path) {
        kept.add(place);
        if place.kind == PointKind::Rapid {
            continue;
        }
        result.stations += 1;
        // A station speaks for the way from the one before it.
        let same = before.filter(|b| b.move_number == place.move_number);
        let from = same.map_or(place.path_mm, |b| b.path_mm);
        if place.rpm > 0.0 {
            result.cut_length_mm += place.path_mm - from;
            note(&mut result, &place);
        }
        before = Some(place);
    }
    result.places = kept.list();
    result
}

/// The largest so far.
fn note(result: &mut CuttingResult, place: &CutPlace) {
    let largest = |slot: &mut Option<CutPlace>, figure: fn(&CutPlace) -> f64| {
        let most = slot.as_ref().map_or(f64::NEG_INFINITY, figure);
        // NaN stays visible.
        if figure(place) > most || figure(place).is_nan() {
            *slot = Some(*place);
        }
    };
    largest(&mut result.largest_force, CutPlace::force_n);
    largest(&mut result.largest_torque, |p| p.torque_n_m);
    largest(&mut result.largest_power, |p| p.power_w);
    largest(&mut result.largest_chip, |p| p.chip_mm);
    if let Some(share) = place.share_of_spindle() {
        let most = result.nearest_to_spindle.as_ref();
        if most
            .and_then(CutPlace::share_of_spindle)
            .is_none_or(|most| share > most)
        {
            result.nearest_to_spindle = Some(*place);
        }
    }
    let worst = &mut result.worst_lines;
    match worst.iter_mut().find(|other| other.line == place.line) {
        Some(own) if place.force_n() > own.force_n() => *own = *place,
        Some(_) => return,
        None => {
            let least = worst.last().filter(|_| worst.len() == WORST);
            if least.is_some_and(|least| least.force_n() >= place.force_n()) {
                return;
            }
            worst.push(*place);
        }
    }
    worst.sort_by(|a, b| b.force_n().total_cmp(&a.force_n()));
    worst.truncate(WORST);
}

/// Figures of which the largest and the smallest of a stretch are kept.
const FIGURES: [fn(&CutPlace) -> f64; 4] = [
    CutPlace::force_n,
    |p| p.torque_n_m,
    |p| p.depth_mm,
    |p| p.arc_deg,
];

/// Places of a stretch: its first and last one, the last end of a rapid, and the largest and smallest of the figures.
const PER_STRETCH: usize = 2 * FIGURES.len() + 3;

/// The envelope of the figures over stretches of as many places each.
struct Kept {
    length: usize,
    open: Vec<CutPlace>,
    list: Vec<CutPlace>,
}

impl Kept {
    fn new(total: usize) -> Self {
        let most = CuttingResult::MAX_PLACES;
        let length = match total <= most {
            true => 1,
            false => total.div_ceil(most / PER_STRETCH),
        };
        Self {
            length,
            open: Vec::with_capacity(length),
            list: Vec::new(),
        }
    }

    fn add(&mut self, place: CutPlace) {
        self.open.push(place);
        if self.open.len() == self.length {
            self.close();
        }
    }

    fn close(&mut self) {
        let feed = |p: &CutPlace| p.kind != PointKind::Rapid;
        let mut keep = vec![0, self.open.len() - 1];
        keep.extend(self.open.iter().rposition(|p| !feed(p)));
        for figure in FIGURES {
            let places = || self.open.iter().enumerate().filter(|(_, p)| feed(p));
            // The first of equal places is kept, as in the result's list of the largest.
            let order = |a: &(usize, &CutPlace), b: &(usize, &CutPlace)| {
                figure(a.1).total_cmp(&figure(b.1))
            };
            let first = |a: &(usize, &CutPlace), b: &(usize, &CutPlace)| b.0.cmp(&a.0);
            keep.extend(
                places()
                    .max_by(|a, b| order(a, b).then(first(a, b)))
                    .map(|(i, _)| i),
            );
            keep.extend(places().min_by(order).map(|(i, _)| i));
        }
        keep.sort_unstable();
        keep.dedup();
        self.list.extend(keep.iter().map(|i| self.open[*i]));
        self.open.clear();
    }

    fn list(mut self) -> Vec<CutPlace> {
        if !self.open.is_empty() {
            self.close();
        }
        self.list
    }
}
