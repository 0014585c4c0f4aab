//! Ends of the moves of another program on the guide, and starts of the next ones.

use std::collections::BTreeMap;

use kinetostat_program::{Curve, Foot, Knowledge, Move, Path};
use nalgebra::Vector3;

use crate::verify::places::End;
use crate::verify::stretches::Stretches;

/// Ends of moves nearer than this are one, mm: what is left after inches and increments.
const SAME_MM: f64 = 1e-6;

/// A program that makes a step where the load turns ends it as near to the end of the guide's, as a share of the step.
const STEPS_WITHIN: f64 = 0.1;

/// Place of an end on the guide.
#[derive(Clone, Copy)]
pub(crate) struct OnGuide {
    /// Length along the guide to which the move before goes, mm, and from which the one behind goes on: the guide turns the load
    /// between both where the program does not.
    pub(crate) arrives_mm: f64,
    pub(crate) leaves_mm: f64,
    /// Piece of the guide that it was found on.
    pub(crate) piece: usize,
    /// Index of the move of the original that is the same as the one that ends here, or that this is a part of.
    pub(crate) same_as: Option<usize>,
}

/// Search for the other program on its guide.
pub(crate) struct Search<'a> {
    pub(crate) stretches: &'a Stretches<'a>,
    pub(crate) original: &'a Path,
    pub(crate) other: &'a Path,
    /// Usual distance of the program from the guide, mm.
    pub(crate) near_mm: f64,
    /// Maximum distance along the guide between places of the program and those of the original, mm.
    pub(crate) beside_mm: f64,
}

impl Search<'_> {
    /// The places of all ends, none where an end is nowhere on the guide.
    pub(crate) fn places(&self, ends: &[End], feet: &[Option<Foot>]) -> Vec<Option<OnGuide>> {
        let tied: Vec<Option<f64>> = (feet.iter().enumerate())
            .map(|(index, foot)| Some(self.tied(foot.as_ref()?, ends.get(index + 1))))
            .collect();
        let of_foot = |(index, foot): (usize, &Option<Foot>)| {
            let (foot, to) = (foot.as_ref()?, tied[index]?);
            // A block from a corner on that is shorter than ends are near to it ends where it ends.
            let off = |index: usize| Some((feet[index].as_ref()?.along_mm - tied[index]?).abs());
            let shares_it = |other: usize, begins: usize| {
                ends.get(begins).is_some_and(|end| !end.begins_pass)
                    && tied.get(other).copied().flatten() == Some(to)
                    && off(other) < off(index)
            };
            let before = index.checked_sub(1);
            let is_other = before.is_some_and(|before| shares_it(before, index))
                || shares_it(index + 1, index + 1);
            let at = if is_other { foot.along_mm } else { to };
            Some(OnGuide {
                arrives_mm: at,
                leaves_mm: at,
                piece: foot.piece,
                same_as: None,
            })
        };
        let found: Vec<_> = feet.iter().enumerate().map(of_foot).collect();
        let mut places = found.clone();
        for (index, place) in places.iter_mut().enumerate() {
            if let Some(place) = place
                && let Some([from, to]) = self.lone_turn(index, ends, &found)
            {
                (place.arrives_mm, place.leaves_mm) = (from, to);
            }
        }
        self.put_same_moves(ends, feet, &mut places);
        places
    }

    /// The corner or the end of a cut at which a place lies, where there is one as near, mm along the guide; else where the place is. The
    /// end behind it, if any, is `next`.
    fn tied(&self, foot: &Foot, next: Option<&End>) -> f64 {
        let ends_pass = next.is_none_or(|next| next.begins_pass);
        let end = ends_pass.then(|| self.stretches.at_end(foot)).flatten();
        let corner = || (self.stretches).at_corner(foot, self.near_mm, self.original);
        end.unwrap_or_else(corner)
    }

    fn pass(&self, piece: usize) -> usize {
        self.stretches.pass_of_piece(piece)
    }

    /// Distance from the ends of a turn of the load within which a program may step there.
    fn step_slack_mm(&self, [from, to]: [f64; 2]) -> f64 {
        let length = to - from;
        self.near_mm.min(0.5 * length).max(STEPS_WITHIN * length)
    }

    /// The turn of the load in which this end lies alone: the program makes no step there, and the load turns at one place of it.
    fn lone_turn(&self, index: usize, ends: &[End], found: &[Option<OnGuide>]) -> Option<[f64; 2]> {
        let own = found[index]?;
        let [from, to] = self
            .stretches
            .turn_at(own.arrives_mm, self.pass(own.piece))?;
        let slack = self.step_slack_mm([from, to]);
        let of_pass = |index: usize, begins: usize| {
            let end = ends.get(begins).filter(|end| !end.begins_pass);
            end.and(found.get(index).copied().flatten())
        };
        let before = index
            .checked_sub(1)
            .and_then(|before| of_pass(before, index));
        let after = of_pass(index + 1, index + 1);
        let steps_before = before.is_some_and(|place| place.arrives_mm >= from - slack);
        let steps_after = after.is_some_and(|place| place.arrives_mm <= to + slack);
        (!steps_before && !steps_after).then_some([from, to])
    }

    /// Moves that the original makes just so are those of the original.
    fn put_same_moves(&self, ends: &[End], feet: &[Option<Foot>], places: &mut [Option<OnGuide>]) {
        let mut of_original: BTreeMap<[i64; 6], Vec<usize>> = BTreeMap::new();
        for (index, own) in self.original.moves.iter().enumerate() {
            if own.is_known_feed() {
                of_original.entry(key(own)).or_default().push(index);
            }
        }
        for last in 0..ends.len() {
            let end = &ends[last];
            let (Some(foot), true) = (feet[last], !end.begins_pass && end.shares[1] == 1.0) else {
                continue;
            };
            let motion = &self.other.moves[end.move_index];
            let same = of_original.get(&key(motion)).into_iter().flatten();
            let same = same.filter(|index| is_same(&self.original.moves[**index], motion));
            let spans = same.filter_map(|index| Some((*index, self.stretches.span_mm(*index)?)));
            let far = |span: &[f64; 2]| (span[1] - foot.along_mm).abs();
            let nearest = spans.min_by(|a, b| far(&a.1).total_cmp(&far(&b.1)));
            let Some((index, [begins, ends_mm])) =
                nearest.filter(|(_, span)| far(span) <= self.beside_mm)
            else {
                continue;
            };
            let parts = (0..=last).rev();
            let parts: Vec<usize> = parts
                .take_while(|part| {
                    ends[*part].move_index == end.move_index && !ends[*part].begins_pass
                })
                .collect();
            let first = parts.last().copied().unwrap_or(last);
            for part in parts {
                if let Some(place) = places[part].as_mut() {
                    place.same_as = Some(index);
                }
            }
            let pass = self.pass(self.stretches.first_piece(index).unwrap_or(foot.piece));
            let turn_at = |at: f64| self.stretches.turn_at(at, pass);
            // A block behind it that ends where the turn ends is the step.
            let next = ends.get(last + 1).filter(|next| !next.begins_pass);
            let next = next.and(places.get(last + 1).copied().flatten());
            let steps_behind = |turn: [f64; 2]| {
                next.is_some_and(|next| next.arrives_mm <= turn[1] + self.step_slack_mm(turn))
            };
            if let Some(place) = places[last].as_mut() {
                place.arrives_mm = ends_mm;
                place.leaves_mm = turn_at(ends_mm)
                    .filter(|turn| turn[0] >= ends_mm && !steps_behind(*turn))
                    .map_or(ends_mm, |turn| turn[1]);
            }
            let before = first.checked_sub(1);
            if let Some(place) = before.and_then(|before| places[before].as_mut()) {
                place.leaves_mm = begins;
                let turn = turn_at(begins).filter(|turn| turn[1] <= begins);
                let most = turn.map_or(begins, |turn| turn[0]);
                place.arrives_mm = match ends[first - 1].begins_pass {
                    true => most,
                    false => place.arrives_mm.min(begins),
                };
            }
        }
    }
}

/// Start and end of a move, in steps far below the written digits.
fn key(motion: &Move) -> [i64; 6] {
    let [from, to] = [motion.start, motion.end].map(|p: Vector3<f64>| {
        let step = |x: f64| (x / (100.0 * SAME_MM)).round() as i64;
        [step(p.x), step(p.y), step(p.z)]
    });
    [from[0], from[1], from[2], to[0], to[1], to[2]]
}

/// True if both programs make the same moves: the original itself, or one that nobody has compensated.
pub(crate) fn are_same(original: &Path, other: &Path) -> bool {
    let same = |(a, b): (&Move, &Move)| {
        let there = || match a.known {
            Knowledge::Whole => is_same(a, b),
            Knowledge::End => (a.end - b.end).norm() <= SAME_MM,
            Knowledge::Nothing => true,
        };
        a.kind == b.kind && a.known == b.known && there()
    };
    original.moves.len() == other.moves.len() && original.moves.iter().zip(&other.moves).all(same)
}

/// True if two moves between the same places are one.
fn is_same(a: &Move, b: &Move) -> bool {
    let same = |share: f64| (a.point(share) - b.point(share)).norm() <= SAME_MM;
    matches!(a.curve, Curve::Line) == matches!(b.curve, Curve::Line)
        && [0.0, 0.3, 0.7, 1.0].into_iter().all(same)
}
