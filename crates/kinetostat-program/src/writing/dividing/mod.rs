//! Division of a block so that straight pieces follow the corrected curve.
//!
//! The corrected curve of a move is `point(s) + c(s)`, `s` the share of its length. A piece from `a`
//! to `b` is good if `c` differs from the straight line between `c(a)` and `c(b)` by no more than the
//! tolerance; the whole vector is compared, so the bound holds along the path too.
//!
//! The field says where `c` or its slope may jump ([`Structure::breaks`](crate::Structure::breaks)): those places are ends of
//! stretches before anything else ([`beginning`]). Arcs that become straight pieces are divided by their chords as well; for those
//! to which arcs are fitted ([`crate::writing::fitting`]) the correction is only found out, and how far it bends matters little. A
//! stretch ([`Stretch`]) is then evaluated in its middle, where the correction changes along it at a place that follows no pattern
//! too, and in the quarters where that does not decide it. It is good if
//!
//! - the polynomial through these values stays within the tolerance ([`crate::writing::departure`], a bound and
//!   no sample);
//! - the error of that polynomial is below a tenth of the tolerance: nothing for a field of third
//!   degree, Hermite's remainder for a smooth one;
//! - at the irregular place the polynomial agrees with the field.
//!
//! Otherwise it is halved ([`divide`]). Neighbouring pieces are joined again where the same bound allows it
//! ([`crate::writing::merge`]). All blocks are divided together, in rounds, so that the field is evaluated
//! in large batches.

pub(crate) mod beginning;
pub(crate) mod divide;

use nalgebra::Vector6;

use crate::field::Course;
use crate::number::{irregular, larger};
use crate::path::curve::Curve;
use crate::path::moves::{Move, Path};
use crate::writing::departure::{Values, departure, parabola, polynomial, remainder};
use crate::writing::merge::Accepted;
use crate::writing::options::WriteOptions;

/// Seed of the irregular places of a division; a check takes another.
const SEED: u64 = 1;

/// Part of the tolerance that may be unknown between the places evaluated.
const UNKNOWN: f64 = 0.1;

/// Part of the tolerance by which the field may differ from the polynomial at the irregular place.
const SURPRISE: f64 = 0.25;

/// Limit for a fit of arcs to the polynomial: they use the tolerance up to a part that this must stay well within.
const SURPRISE_FITTED: f64 = 0.08;

/// Limit, in tolerances, of the distance from a straight line on a stretch that is no piece: a polynomial follows it.
const BENT: f64 = 20.0;

/// A place of a stretch at which the correction is evaluated.
#[derive(Clone, Copy)]
pub(crate) enum Place {
    Middle,
    FirstQuarter,
    LastQuarter,
    /// Place that follows no pattern, at a part of the stretch.
    Irregular(f64),
}

impl Place {
    /// Part of the stretch before the place.
    pub fn part(self) -> f64 {
        match self {
            Place::Middle => 0.5,
            Place::FirstQuarter => 0.25,
            Place::LastQuarter => 0.75,
            Place::Irregular(part) => part,
        }
    }
}

/// A stretch of a move that is not accepted yet.
pub(crate) struct Stretch {
    pub move_index: usize,
    pub course: Course,
    /// The whole of a straight move, or a chord of an arc: what is good as it is needs no joining.
    pub entire: bool,
    /// Arcs are fitted to its move.
    pub fitted: bool,
    /// True if no piece ends in it unless the correction bends there: directions of the tool would say little of the
    /// axes.
    pub across_pole: bool,
    pub share: [f64; 2],
    pub ends: [Vector6<f64>; 2],
    /// Start of the piece that the tool goes along; differs from the first end where a jump too small for a step is
    /// taken up.
    pub begins: Vector6<f64>,
    pub middle: Option<Vector6<f64>>,
    pub quarters: Option<[Vector6<f64>; 2]>,
    /// An irregular part of the stretch and the correction there.
    pub irregular: Option<(f64, Vector6<f64>)>,
}

/// Decision on a stretch with the values known of it.
pub(crate) enum Decision {
    Accept,
    /// The place that follows no pattern confirms it, or not.
    Confirm,
    /// More places decide it.
    Refine,
    Halve,
    /// Too short to be halved, and still off: the correction jumps.
    Jump,
}

impl Stretch {
    /// The share at a part of the stretch.
    pub fn at(&self, part: f64) -> f64 {
        self.share[0] + (self.share[1] - self.share[0]) * part
    }

    fn node_values(&self) -> Option<Values> {
        let middle = self.middle?;
        let [first, last] = self.ends;
        Some(match self.quarters {
            Some([low, high]) => [first, low, middle, high, last],
            None => parabola(first, middle, last),
        })
    }

    /// The part of the stretch that follows no pattern.
    pub fn irregular_part(&self, path: &Path) -> f64 {
        let number = path.moves_before() + self.move_index;
        // Not near the places that are evaluated anyway.
        let place = irregular(SEED, number as u64, self.share[0].to_bits());
        0.25 * ((4.0 * place).floor() + 0.2 + 0.6 * (4.0 * place).fract())
    }

    fn length_mm(&self, path: &Path, options: &WriteOptions) -> f64 {
        let motion = &path.moves[self.move_index];
        let [from, to] = self.share;
        // The length of a move that turns the tool is the way of a point of the tool if that is longer.
        let turned = motion.way_with_turn_mm(options.turn_lever_mm) * (to - from);
        larger(motion.length_between_mm(from, to), turned)
    }

    /// True if the stretch is too short to be halved.
    pub fn is_shortest(&self, path: &Path, options: &WriteOptions) -> bool {
        let [from, to] = self.share;
        let short = self.length_mm(path, options) <= options.smallest_piece_mm;
        short || self.at(0.5) <= from || self.at(0.5) >= to
    }

    /// True if the stretch is so short that the correction is linear between its ends, given the declared smoothness of the
    /// field.
    fn is_straight(&self, path: &Path, options: &WriteOptions) -> bool {
        let (Course::Steady { radius_mm }, true) = (self.course, self.entire && !self.fitted)
        else {
            return false;
        };
        let (tolerance, [first, last]) = (options.tolerance_mm, self.ends);
        let size = larger(tolerance, larger(first.norm(), last.norm()));
        let way = path.moves[self.move_index].length_mm();
        let off = (self.begins - first).norm();
        remainder(2, size, way, radius_mm) <= UNKNOWN * tolerance && off <= 0.25 * tolerance
    }

    /// True if a stretch that [is straight](Self::is_straight) needs no more values: it changes by less than the tolerance, or
    /// the place that follows no pattern confirms it.
    fn is_confirmed(&self, options: &WriteOptions) -> bool {
        let (tolerance, [first, last]) = (options.tolerance_mm, self.ends);
        match self.irregular {
            None => (last - first).norm() <= tolerance,
            Some((part, value)) => (value - first.lerp(&last, part)).norm() <= SURPRISE * tolerance,
        }
    }

    /// True if the ends determine the correction.
    fn ends_suffice(&self, path: &Path, options: &WriteOptions) -> bool {
        self.is_straight(path, options) && self.is_confirmed(options)
    }

    /// Places of it at which the correction is to be evaluated before anything is decided.
    pub fn lacks(
        &self,
        path: &Path,
        options: &WriteOptions,
    ) -> impl Iterator<Item = Place> + use<> {
        use Place::{FirstQuarter, Irregular, LastQuarter, Middle};
        let cubic = self.course == Course::Cubic && !self.fitted;
        let irregular = || {
            let unknown = self.irregular.is_none();
            unknown.then(|| Irregular(self.irregular_part(path)))
        };
        let places = match self.middle {
            None if !self.is_straight(path, options) => [Some(Middle), None, None],
            None if self.is_confirmed(options) => [None; 3],
            None => [Some(irregular().unwrap_or(Middle)), None, None],
            Some(_) => match self.decide(path, options) {
                Decision::Confirm => [irregular(), None, None],
                Decision::Refine if cubic => [Some(FirstQuarter), Some(LastQuarter), None],
                Decision::Refine => [Some(FirstQuarter), Some(LastQuarter), irregular()],
                Decision::Accept | Decision::Halve | Decision::Jump => [None; 3],
            },
        };
        places.into_iter().flatten()
    }

    /// Takes the correction at one of these places; that of the first quarter comes before that of the last.
    pub fn learn(&mut self, place: Place, value: Vector6<f64>) {
        match place {
            Place::Middle => self.middle = Some(value),
            Place::FirstQuarter => self.quarters = Some([value; 2]),
            Place::LastQuarter => {
                if let Some(quarters) = &mut self.quarters {
                    quarters[1] = value;
                }
            }
            Place::Irregular(part) => self.irregular = Some((part, value)),
        }
    }

    /// Decides what to do with the stretch.
    pub fn decide(&self, path: &Path, options: &WriteOptions) -> Decision {
        if self.middle.is_none() && self.ends_suffice(path, options) {
            return Decision::Accept;
        }
        let Some(values) = self.node_values() else {
            return Decision::Refine;
        };
        let motion = &path.moves[self.move_index];
        let [from, to] = self.share;
        let length = self.length_mm(path, options);
        let tolerance = options.tolerance_mm;
        let all_requested = self.quarters.is_some();
        let off = departure(&values, [self.begins, self.ends[1]]);
        let bends = off > 0.25 * tolerance;
        let changes = (self.ends[1] - self.ends[0]).norm() > tolerance;
        let (unknown, needs_quarters) = match self.course {
            Course::Cubic if !self.fitted => (0.0, true),
            Course::Cubic => (self.unknown_round(motion, &values), true),
            Course::Smooth { radius_mm } | Course::Steady { radius_mm } => {
                // A size of zero may only mean that nothing was seen yet: it is the tolerance at least.
                let seen = self.irregular.iter().map(|(_, value)| value);
                let size = values
                    .iter()
                    .chain(seen)
                    .map(Vector6::norm)
                    .fold(tolerance, larger);
                let radius = match &motion.curve {
                    Curve::Line => radius_mm,
                    Curve::Arc(arc) => radius_mm.min(arc.start_radius.min(arc.end_radius)),
                };
                // A turn of the tool is a way as well.
                let turn = motion.turn_ratio(radius, self.share) * (to - from);
                let way = larger(motion.length_between_mm(from, to), turn * radius);
                let points = if all_requested { 5 } else { 3 };
                (
                    remainder(points, size, way, radius),
                    bends || (changes && self.fitted),
                )
            }
        };
        let surprise = match self.fitted {
            true => SURPRISE_FITTED,
            false => SURPRISE,
        };
        let surprised = self.irregular.is_some_and(|(part, value)| {
            (value - polynomial(&values, part)).norm() > surprise * tolerance
        });
        let bent = match self.fitted && length > options.smallest_piece_mm {
            true => BENT * tolerance,
            false => tolerance,
        };
        if off > bent || surprised {
            return match (all_requested, self.is_shortest(path, options)) {
                // A stretch outside the tolerance is evaluated once more before it is halved.
                (false, _) => Decision::Refine,
                (true, true) => Decision::Jump,
                (true, false) => Decision::Halve,
            };
        }
        if !all_requested && (needs_quarters || unknown > UNKNOWN * tolerance) {
            return Decision::Refine;
        }
        if !all_requested && changes && self.irregular.is_none() {
            return Decision::Confirm;
        }
        if unknown > UNKNOWN * tolerance && length > options.smallest_piece_mm && !self.across_pole
        {
            return Decision::Halve;
        }
        Decision::Accept
    }

    /// Bound of the error of a polynomial through five values on an arc, for a correction that is one of third degree along
    /// straight lines: the coordinates are no polynomials along an arc, and a stretch of an angle `a` is a straight line but for
    /// terms of `a^2` and more. They begin with those of the fifth degree.
    fn unknown_round(&self, motion: &Move, values: &Values) -> f64 {
        let Curve::Arc(arc) = &motion.curve else {
            return 0.0;
        };
        let angle = arc.sweep * (self.share[1] - self.share[0]);
        let varies = values.iter().map(|value| (value - values[0]).norm());
        0.02 * angle * angle * varies.fold(0.0, larger)
    }

    /// Remembers what was found inside, for [`crate::writing::merge::merge`].
    pub fn accepted(&self, accepted: &mut Vec<Accepted>) {
        if self.entire {
            return;
        }
        if let Some(values) = self.node_values() {
            accepted.push(Accepted {
                move_index: self.move_index,
                share: self.share[0],
                values,
            });
        }
    }
}
