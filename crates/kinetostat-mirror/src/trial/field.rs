//! The correction as a field for the writer of programs, joined where two legs meet at a corner.

use kinetostat_program::{
    Correction, CorrectionField, Course, FieldFailure, Move, NominalPath, Request, Structure,
};
use nalgebra::{Matrix3, Vector3};

use crate::deviation::{Stations, Stretch};
use crate::error::MirrorError;
use crate::number::larger;
use crate::trial::state::MirrorState;

/// A step no larger than the last digit of most programs is none, mm.
const SAME_STEP_MM: f64 = 1e-4;

/// Place of a move among the pieces of the path.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// Index of the piece.
    Piece(usize),
    /// Way between two places of the path (stretch, length along the path in mm), from one share of the way to another.
    Between([(usize, f64); 2], [f64; 2]),
}

/// The correction of a state along the path: at its stations as stated, between them on cubic curves without a kink, at corners
/// joined so that both legs are met; on moves between two passes evenly from one to the next.
pub struct MirrorField<'a> {
    nominal: &'a NominalPath<'a>,
    stations: Stations,
    correction_mm: Vec<Vector3<f64>>,
    slope: Vec<Vector3<f64>>,
    places: Vec<Place>,
}

impl<'a> MirrorField<'a> {
    /// The field of a state of this path.
    ///
    /// # Errors
    /// The state is of another path.
    pub fn new(nominal: &'a NominalPath<'a>, state: &'a MirrorState) -> Result<Self, MirrorError> {
        state.fits(nominal, &state.program_sha256, &state.settings)?;
        let smoothing_mm = state.settings.smoothing_mm;
        let stations = Stations::of(nominal, smoothing_mm)?;
        let scatter_mm = scatter_at_corners_mm(state);
        let own_mm = &state.correction_mm;
        let correction_mm = joined(nominal, &stations, own_mm, smoothing_mm, scatter_mm);
        let slope = slopes(&stations, &correction_mm);
        let places = places(nominal, &stations);
        Ok(Self {
            nominal,
            stations,
            correction_mm,
            slope,
            places,
        })
    }

    /// The correction at a length along the path, on a stretch, mm.
    fn at_length(&self, stretch: usize, along_mm: f64) -> Vector3<f64> {
        let own = self.stations.stretches()[stretch].stations.clone();
        let along = &self.stations.along_mm()[own.clone()];
        let after = along
            .partition_point(|at| *at <= along_mm)
            .clamp(1, along.len() - 1);
        let k = own.start + after - 1;
        let way = along[after] - along[after - 1];
        let u = ((along_mm - along[after - 1]) / way).clamp(0.0, 1.0);
        let (rest, both) = (1.0 - u, u * (1.0 - u));
        self.correction_mm[k] * (rest * rest * (1.0 + 2.0 * u))
            + self.slope[k] * (way * both * rest)
            + self.correction_mm[k + 1] * (u * u * (3.0 - 2.0 * u))
            - self.slope[k + 1] * (way * both * u)
    }

    fn at(&self, move_index: usize, share: f64) -> Vector3<f64> {
        match self.places[move_index] {
            Place::Piece(index) => {
                let piece = &self.nominal.pieces()[index];
                let stretch = self.stations.stretch_of(index);
                self.at_length(stretch, piece.from_mm + share * piece.length_mm)
            }
            Place::Between(ends, [first, last]) => {
                let [from, to] = ends.map(|(stretch, along_mm)| self.at_length(stretch, along_mm));
                from + (to - from) * (first + (last - first) * share)
            }
        }
    }
}

/// Scatter of the difference between two legs of a corner, mm: four standard deviations. At an end a mean rests on half the
/// points, there are two ends, and a correction carries `rho / (2 - rho)` of the variance of a measurement. Without a trial
/// any disagreement may be scatter.
fn scatter_at_corners_mm(state: &MirrorState) -> f64 {
    let Some(last) = state.trials.last() else {
        return f64::INFINITY;
    };
    let of_mean = last.figures.scatter_mm.powi(2) / last.figures.effective_points;
    let carried = last.relaxation / (2.0 - last.relaxation);
    larger(4.0 * (4.0 * of_mean * carried).sqrt(), SAME_STEP_MM)
}

/// Slopes of the cubic curves at the stations, by those beside them; around where a stretch has no end.
fn slopes(stations: &Stations, correction_mm: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let along = stations.along_mm();
    let mut slopes = vec![Vector3::zeros(); correction_mm.len()];
    for stretch in stations.stretches() {
        let own = stretch.stations.clone();
        for k in own.clone() {
            let before = k.saturating_sub(1).max(own.start);
            let after = (k + 1).min(own.end - 1);
            let way = along[after] - along[before];
            slopes[k] = (correction_mm[after] - correction_mm[before]) / way;
        }
        if stretch.closed {
            let both = 0.5 * (slopes[own.start] + slopes[own.end - 1]);
            (slopes[own.start], slopes[own.end - 1]) = (both, both);
        }
    }
    slopes
}

/// Places of all moves: those between two pieces have a share of the way between them.
fn places(nominal: &NominalPath<'_>, stations: &Stations) -> Vec<Place> {
    let (moves, pieces) = (&nominal.path().moves, nominal.pieces());
    let mut places = Vec::with_capacity(moves.len());
    let mut before: Option<(usize, f64)> = None;
    for (index, piece) in pieces.iter().enumerate() {
        let stretch = stations.stretch_of(index);
        let begins = (stretch, piece.from_mm);
        let idle = &moves[places.len()..piece.move_index];
        places.extend(between([before.unwrap_or(begins), begins], idle));
        places.push(Place::Piece(index));
        before = Some((stretch, piece.from_mm + piece.length_mm));
    }
    if let Some(end) = before {
        places.extend(between([end; 2], &moves[places.len()..]));
    }
    places
}

fn between(ends: [(usize, f64); 2], idle: &[Move]) -> Vec<Place> {
    let whole: f64 = idle.iter().map(Move::length_mm).sum();
    let mut done = 0.0;
    let shares = idle.iter().map(|motion| {
        let from = done;
        done += motion.length_mm();
        [from, done].map(|way| if whole > 0.0 { way / whole } else { 1.0 })
    });
    shares.map(|shares| Place::Between(ends, shares)).collect()
}

impl CorrectionField for MirrorField<'_> {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let at = |request: &Request| match request.turning {
            None => self.at(request.move_index, request.share),
            // Over a corner from one leg to the other, evenly as the load turns.
            Some(turn) => {
                let before = self.at(turn.from_move, turn.from_share);
                let after = self.at(request.move_index, turn.to_share);
                before.lerp(&after, turn.part)
            }
        };
        requests
            .iter()
            .map(|request| Ok(at(request).into()))
            .collect()
    }

    fn structure(&self, move_index: usize, _motion: &Move) -> Structure {
        let Place::Piece(index) = self.places[move_index] else {
            return Structure {
                breaks: Vec::new(),
                course: Course::Cubic,
            };
        };
        let piece = &self.nominal.pieces()[index];
        let stretch = &self.stations.stretches()[self.stations.stretch_of(index)];
        let own = &self.stations.along_mm()[stretch.stations.clone()];
        let shares = own.iter().map(|at| (at - piece.from_mm) / piece.length_mm);
        Structure {
            breaks: shares
                .filter(|share| *share > 0.0 && *share < 1.0)
                .collect(),
            course: Course::Cubic,
        }
    }
}

/// Sum of two fields: a model's compensation, and what was measured besides.
pub struct SumOfFields<'a> {
    /// Corrects the orientation too, where it does.
    pub model: &'a dyn CorrectionField,
    /// Added to it.
    pub mirror: &'a MirrorField<'a>,
}

impl CorrectionField for SumOfFields<'_> {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let both = self.model.corrections(requests).into_iter();
        both.zip(self.mirror.corrections(requests))
            .map(|(model, mirror)| {
                let (mut sum, mirror) = (model?, mirror?);
                sum.shift_mm += mirror.shift_mm;
                Ok(sum)
            })
            .collect()
    }

    fn turns(&self) -> bool {
        self.model.turns()
    }

    fn turns_tool(&self) -> bool {
        self.model.turns_tool()
    }

    fn structure(&self, move_index: usize, motion: &Move) -> Structure {
        let mut structure = self.model.structure(move_index, motion);
        let own = self.mirror.structure(move_index, motion);
        structure.breaks.extend(own.breaks);
        structure
    }
}

/// Legs that turn back by less than this (sine of 20 degrees) from a whole half turn are in one line, those of a seam as well.
const IN_LINE: f64 = 0.342_020_143_325_668_7;

/// Distance from a corner, in smoothing lengths, at which the joint has faded.
const FADED: f64 = 3.0;

/// Largest distance of two places that are one, mm.
const SAME_MM: f64 = 1e-6;

/// An end of a stretch at a corner: its station, and the direction of the path there.
#[derive(Clone, Copy)]
struct End {
    stretch: usize,
    station: usize,
    tangent: Vector3<f64>,
}

/// Corrections at the stations, joined at corners and at the seams of closed passes; what legs disagree by beyond a scatter (mm) is
/// left to them.
///
/// Each leg has a correction across itself, `P1 c1` and `P2 c2` with `P = I - t t'`. The tool passes the corner once, with one
/// correction: the `c` that meets both best, `(P1 + P2) c = P1 c1 + P2 c2`. Across the plane of the legs that is the mean of both; in it,
/// both are met exactly: lines that are moved aside meet where they cross. From the corner on the difference fades
/// along the leg, over three smoothing lengths or the whole leg. In the plane it goes along the leg, where it
/// changes nothing that is measured; so the iteration of the trials knows nothing of it.
///
/// A leg that nothing was measured of takes the correction of the other. Legs that turn back are in one line: they take the mean.
pub(crate) fn joined(
    nominal: &NominalPath<'_>,
    stations: &Stations,
    correction_mm: &[Vector3<f64>],
    smoothing_mm: f64,
    scatter_mm: f64,
) -> Vec<Vector3<f64>> {
    let mut joined = correction_mm.to_vec();
    for [end, start] in corners(nominal, stations) {
        let both = [end, start].map(|at| correction_mm[at.station]);
        let Some(common) = common(both, [end.tangent, start.tangent]) else {
            continue;
        };
        let along = |at: &End, own: &Vector3<f64>| at.tangent * at.tangent.dot(&(common - own));
        let [one, other] =
            [(end, both[0]), (start, both[1])].map(|(at, own)| common - own - along(&at, &own));
        let measured = both.iter().all(|own| *own != Vector3::zeros());
        let steps = measured && (one - other).norm() > scatter_mm;
        for (at, own) in [end, start].into_iter().zip(both) {
            let difference = match steps {
                true => along(&at, &own),
                false => common - own,
            };
            fade(&mut joined, stations, at, difference, smoothing_mm);
        }
    }
    joined
}

/// Ends of stretches at the beginning of another of the same pass: at corners, and at seams of closed passes.
fn corners(nominal: &NominalPath<'_>, stations: &Stations) -> Vec<[End; 2]> {
    let all = stations.stretches();
    let mut found = Vec::new();
    let mut first = 0;
    for index in 0..all.len() {
        let own = &all[index];
        let follows = all.get(index + 1).is_some_and(|next| next.pass == own.pass);
        let next = match follows {
            true => index + 1,
            false => first,
        };
        let meets = (end_of(nominal, own) - start_of(nominal, &all[next])).norm() <= SAME_MM;
        if meets && !own.closed {
            found.extend(ends(nominal, stations, [index, next]));
        }
        if !follows {
            first = index + 1;
        }
    }
    found
}

fn start_of(nominal: &NominalPath<'_>, stretch: &Stretch) -> Vector3<f64> {
    nominal
        .motion(&nominal.pieces()[stretch.pieces.start])
        .point(0.0)
}

fn end_of(nominal: &NominalPath<'_>, stretch: &Stretch) -> Vector3<f64> {
    nominal
        .motion(&nominal.pieces()[stretch.pieces.end - 1])
        .point(1.0)
}

fn ends(
    nominal: &NominalPath<'_>,
    stations: &Stations,
    [before, after]: [usize; 2],
) -> Option<[End; 2]> {
    let all = stations.stretches();
    let tangent = |piece: usize, share: f64| {
        let motion = nominal.motion(&nominal.pieces()[piece]);
        motion.tangent(share)
    };
    let end = End {
        stretch: before,
        station: all[before].stations.end - 1,
        tangent: tangent(all[before].pieces.end - 1, 1.0)?,
    };
    let start = End {
        stretch: after,
        station: all[after].stations.start,
        tangent: tangent(all[after].pieces.start, 0.0)?,
    };
    Some([end, start])
}

/// The correction that both legs have in common; nothing where neither has one. A value that is zero to the last digit was not
/// measured.
fn common(
    [first, second]: [Vector3<f64>; 2],
    [before, after]: [Vector3<f64>; 2],
) -> Option<Vector3<f64>> {
    match [first, second].map(|own| own != Vector3::zeros()) {
        [false, false] => return None,
        [true, false] => return Some(first),
        [false, true] => return Some(second),
        [true, true] => {}
    }
    if before.cross(&after).norm() < IN_LINE {
        return Some(0.5 * (first + second));
    }
    let across = |tangent: Vector3<f64>| Matrix3::identity() - tangent * tangent.transpose();
    let [one, other] = [across(before), across(after)];
    let met = (one + other).cholesky()?;
    Some(met.solve(&(one * first + other * second)))
}

/// Adds a difference at an end of a stretch, and less and less of it along the stretch.
fn fade(
    joined: &mut [Vector3<f64>],
    stations: &Stations,
    at: End,
    difference: Vector3<f64>,
    smoothing_mm: f64,
) {
    let own = stations.stretches()[at.stretch].stations.clone();
    let along = &stations.along_mm()[own.clone()];
    let length = along[along.len() - 1] - along[0];
    let over = match FADED * smoothing_mm < length {
        true => FADED * smoothing_mm,
        false => length,
    };
    let from = stations.along_mm()[at.station];
    for (station, place) in own.zip(along) {
        let u = ((place - from).abs() / over).min(1.0);
        joined[station] += difference * (1.0 - u * u * (3.0 - 2.0 * u));
    }
}
