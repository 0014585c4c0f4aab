//! Rapids of another program beside those of the original: where they go.

use kinetostat::number::larger;
use kinetostat_program::{Corrected, Knowledge, Move, MoveKind, NominalPath, Path};
use nalgebra::Vector3;

use crate::verify::matched::RapidElsewhere;
use crate::verify::stretches::Guide;

/// Rapids nearer than this are the same, mm, beside what corrections shift them by: clearances are larger.
pub(crate) const NEAR_MM: f64 = 1.0;

/// A rapid that leads on by less comes back to where the cut was left, mm: its ends are rounded.
const LEADS_ON_MM: f64 = 0.002;

/// Maximum number of listed rapids.
const MOST: usize = 100;

/// Maximum shift of the original by the guide, mm.
pub(crate) fn largest_shift_mm(original: &Path, guide: &Corrected) -> f64 {
    let shift = |piece: &kinetostat_program::Piece| {
        let nominal = original.moves[piece.move_index].point(piece.share_to);
        (piece.commanded_to - nominal).norm()
    };
    guide.pieces.iter().map(shift).fold(0.0, larger)
}

/// Rapids from and to places that the program states.
fn rapids(moves: &[Move]) -> Vec<Way> {
    let stated = |m: &&Move| {
        m.kind == MoveKind::Rapid && m.known != Knowledge::Nothing && !m.words.is_to_machine()
    };
    let way = |m: &Move| Way {
        line: m.line,
        ends: match m.known {
            Knowledge::Whole => [m.start, m.end],
            _ => [m.end, m.end],
        },
    };
    moves.iter().filter(stated).map(way).collect()
}

/// Start or end of a pass of the other program on the guide.
#[derive(Clone, Copy)]
pub(crate) struct Reached {
    pub(crate) along_mm: f64,
    /// Before the turn of the load that is made there, if one is.
    pub(crate) arrives_mm: f64,
    /// The pass of the guide that it was found on.
    pub(crate) pass: usize,
}

/// The moves before each pass of a path, and those behind the last one; `move_of` gives the move of a piece.
fn between_passes<'p>(
    moves: &'p [Move],
    nominal: &NominalPath<'_>,
    move_of: impl Fn(usize) -> usize,
) -> Vec<&'p [Move]> {
    let index = |piece: usize| move_of(nominal.pieces()[piece].move_index);
    let mut from = 0;
    let mut between = Vec::with_capacity(nominal.passes().len() + 1);
    for pass in nominal.passes() {
        let begins = index(pass.pieces.start);
        between.push(&moves[from..begins.max(from)]);
        from = index(pass.pieces.end - 1) + 1;
    }
    between.push(&moves[from..]);
    between
}

/// Rapids of the other program that differ from those of the original; `passes` are the places on the guide at which the
/// passes of the other program begin and end.
pub(crate) fn elsewhere(
    guide: &Guide<'_>,
    other: &NominalPath<'_>,
    passes: &[[Reached; 2]],
    shift_mm: f64,
) -> Vec<RapidElsewhere> {
    let nominal = guide.nominal;
    let of_piece = |piece: usize| guide.written.pieces[piece].move_index;
    let of_original = between_passes(&guide.original.moves, nominal, of_piece);
    let of_other = between_passes(&other.path().moves, other, |i| i);
    let known = nominal.passes();
    let slack_mm = 0.05 + shift_mm;
    let mut found = Vec::new();
    for (index, moves) in of_other.into_iter().enumerate() {
        let own = rapids(moves);
        if own.is_empty() || found.len() == MOST {
            continue;
        }
        let ended = index.checked_sub(1).map(|before| passes[before][1]);
        let begins = passes.get(index).map(|pass| pass[0]);
        // Matches by the passes that both ends were found on, and by their lengths: of short passes in one place either may be
        // mistaken.
        let by_pass = [
            ended.map_or(0, |at| at.pass + 1),
            begins.map_or(known.len(), |at| at.pass),
        ];
        let by_length = [
            ended.map_or(0, |at| {
                known.partition_point(|pass| pass.along_mm[0] < at.along_mm - slack_mm)
            }),
            begins.map_or(known.len(), |at| {
                known.partition_point(|pass| pass.along_mm[1] <= at.along_mm + slack_mm)
            }),
        ];
        let readings = [by_pass, by_length];
        let same = readings.iter().filter(|[first, last]| first == last);
        // The peck before or after may be meant if pecks in one hole are as short as corrections.
        let same: Vec<RapidElsewhere> = same
            .flat_map(|[way, _]| way.saturating_sub(1)..=(way + 1).min(known.len()))
            .filter_map(|way| worst(&own, &rapids(of_original[way])))
            .collect();
        let is_other = |way: &RapidElsewhere| way.distance_mm > NEAR_MM + shift_mm;
        if readings.iter().any(|[first, last]| first == last) {
            let least = same.into_iter();
            let least = least.min_by(|a, b| a.distance_mm.total_cmp(&b.distance_mm));
            found.extend(least.filter(is_other));
            continue;
        }
        // Passes are left out, which is said.
        if readings.iter().any(|[first, last]| first < last) {
            continue;
        }
        // In the midst of a cut, where the original has no rapid.
        let [from, to] = [own.first(), own.last()];
        let stays = from.zip(to).map(|(from, to)| Way {
            line: 0,
            ends: [from.ends[0], to.ends[1]],
        });
        let stays: Vec<Way> = stays.into_iter().collect();
        let beside = worst(&own, &stays).filter(is_other);
        // A rapid that leads back has its part cut again. At an end of a pass, as in a hole that is pecked, another pass may be
        // meant.
        let goes_on = |[from, to]: [Reached; 2]| {
            let inside = known.get(from.pass).is_some_and(|pass| {
                let [begins, ends] = pass.along_mm;
                begins + slack_mm < from.arrives_mm && to.along_mm < ends - slack_mm
            });
            inside && from.pass == to.pass && to.along_mm >= from.arrives_mm - LEADS_ON_MM
        };
        let leads_on = || {
            let leads = leads_on(stays.first()?, own.last()?.line)?;
            ended.zip(begins).filter(|(a, b)| goes_on([*a, *b]))?;
            Some(leads)
        };
        found.extend(beside.or_else(leads_on));
    }
    found
}

/// A rapid that leaves out a part of a cut: between both its ends there is a way, be it the step of a corner.
fn leads_on(way: &Way, line: usize) -> Option<RapidElsewhere> {
    let [from, to] = way.ends;
    let distance_mm = (to - from).norm();
    (distance_mm > LEADS_ON_MM).then_some(RapidElsewhere {
        line,
        line_of_original: None,
        position_mm: to.into(),
        distance_mm,
    })
}

/// Largest distance between ways: ends of each from the other.
fn worst(own: &[Way], wanted: &[Way]) -> Option<RapidElsewhere> {
    let nearest = |point: &Vector3<f64>, ways: &[Way]| {
        let distances = ways.iter().map(|way| (way.distance(point), way.line));
        distances.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let of_own = own.iter().flat_map(|way| {
        way.ends.iter().filter_map(move |end| {
            let (distance_mm, line) = nearest(end, wanted)?;
            Some((distance_mm, way.line, line, end))
        })
    });
    let of_wanted = wanted.iter().flat_map(|way| {
        way.ends.iter().filter_map(move |end| {
            let (distance_mm, line) = nearest(end, own)?;
            Some((distance_mm, line, way.line, end))
        })
    });
    let all = of_own.chain(of_wanted);
    let (distance_mm, line, line_of_original, end) = all.max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(RapidElsewhere {
        line,
        line_of_original: Some(line_of_original).filter(|line| *line > 0),
        position_mm: (*end).into(),
        distance_mm,
    })
}

/// A way lies on another within this, mm, beside what corrections shift it by.
pub(crate) const ON_WAY_MM: f64 = 0.05;

/// A straight way of the tool.
pub(crate) struct Way {
    pub(crate) line: usize,
    pub(crate) ends: [Vector3<f64>; 2],
}

impl Way {
    /// True if a place lies beside it within a distance, and not beyond its ends: corrections shift a way across, not along.
    pub(crate) fn holds(&self, point: &Vector3<f64>, within_mm: f64) -> bool {
        let [from, to] = &self.ends;
        let length = (to - from).norm();
        if length <= ON_WAY_MM {
            return (point - from).norm() <= ON_WAY_MM;
        }
        let along = (point - from).dot(&(to - from)) / length;
        (-ON_WAY_MM..=length + ON_WAY_MM).contains(&along) && self.distance(point) <= within_mm
    }

    pub(crate) fn distance(&self, point: &Vector3<f64>) -> f64 {
        let [from, to] = &self.ends;
        let way = to - from;
        let squared = way.norm_squared();
        let share = match squared > 0.0 {
            true => ((point - from).dot(&way) / squared).clamp(0.0, 1.0),
            false => 0.0,
        };
        (from + share * way - point).norm()
    }
}
