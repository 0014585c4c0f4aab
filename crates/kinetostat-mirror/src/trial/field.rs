//! The correction as a field for the writer of programs.

use kinetostat_program::{
    Correction, CorrectionField, Course, FieldFailure, Move, Request, Structure,
};
use nalgebra::Vector3;

use crate::deviation::Stations;
use crate::error::MirrorError;
use crate::number::larger;
use crate::trial::joined::joined;
use crate::trial::state::MirrorState;
use kinetostat_program::NominalPath;

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
