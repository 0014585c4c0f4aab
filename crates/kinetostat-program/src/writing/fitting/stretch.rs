//! One piece for one stretch: the arc, or else the straight piece, that is near all places of the corrected curve.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use crate::number::{larger, smaller};
use crate::path::curve::{Arc, Curve};
use crate::writing::corrected_curve::CorrectedCurve;
use crate::writing::fitting::Circle;
use crate::writing::options::WriteOptions;
use crate::writing::output_state::{FittedArc, FittedCircle, slipped};

/// Form of the arcs of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ArcForm {
    /// I, J and K.
    Centre,
    /// R, which says little of the centre of nearly half a circle.
    Radius,
}

/// Shape of the pieces of a move.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Shape<'a> {
    /// Arcs about the axis of this one, which is that of the path.
    Arcs(&'a Arc, ArcForm),
    /// Circles through three places, which may lean.
    Circles,
    Straight,
}

/// A stretch of a move without a jump, and where its ends are to be, in mm.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Span {
    pub share: [f64; 2],
    pub ends: [Vector3<f64>; 2],
}

/// A piece that fits; straight without an arc and a circle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FittedPiece {
    pub share_to: f64,
    pub target: Vector3<f64>,
    pub arc: Option<FittedArc>,
    pub circle: Option<FittedCircle>,
}

impl FittedPiece {
    /// Empty piece at the start of the first one.
    pub fn start(span: &Span) -> Self {
        Self {
            share_to: span.share[0],
            target: span.ends[0],
            arc: None,
            circle: None,
        }
    }

    /// Length of the piece from its start, in mm, about an axis of this direction.
    pub fn length_mm(&self, from: &Vector3<f64>, axis: &Vector3<f64>) -> f64 {
        let way = self.target - from;
        match (&self.arc, &self.circle) {
            (_, Some(circle)) => circle.length_mm,
            (Some(arc), _) => (arc.radius_mm * arc.sweep_rad).hypot(way.dot(axis)),
            (None, None) => way.norm(),
        }
    }
}

/// An arc that fits from the start of a stretch, and the heights along its axis, lowest and highest in mm, at which it may end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tube {
    pub arc: FittedArc,
    pub heights: [f64; 2],
}

/// Stretches looked at in a piece.
const PLACES: usize = 32;
const FEW_PLACES: usize = 8;

/// Part of the tolerance that is used: the places in between, and what the correction may be off from its polynomial.
const USED: f64 = 0.85;

/// Maximum sweep of one arc: beyond it start and end come near each other, and the digits decide how far it goes.
const LARGEST_SWEEP: f64 = 300.0 / 360.0 * TAU;

/// Sweeps that are not written by R: the centre of nearly half a circle is anywhere.
const NOT_BY_RADIUS: [f64; 2] = [PI * 0.68, PI * 1.32];

/// An arc is at least so many last digits long, and bent by at least so many.
const SHORTEST_DIGITS: f64 = 20.0;
const FLATTEST_DIGITS: f64 = 2.0;

/// A circle through a place has ends so far apart, mm, goes no farther round, and is bent by so many last digits: robots refuse
/// places of a circle that are near each other or nearly on a line, and none of more than 240 degrees is taken by all.
const SHORTEST_CIRCLE_MM: f64 = 1.0;
const LARGEST_CIRCLE: f64 = TAU * 239.0 / 360.0;
const FLATTEST_CIRCLE_DIGITS: f64 = 100.0;

/// Largest radius written, mm.
const LARGEST_RADIUS_MM: f64 = 1e6;

/// A place of the corrected curve.
struct CurvePlace {
    /// Part of the stretch before it.
    part: f64,
    /// In mm.
    position: Vector3<f64>,
}

/// Curve, shape and tolerances of a fit.
pub(crate) struct Fit<'a> {
    pub curve: CorrectedCurve<'a>,
    pub shape: Shape<'a>,
    pub options: &'a WriteOptions,
}

impl Fit<'_> {
    /// Point of the curve at a share of a stretch; the ends are those of the stretch.
    pub fn point(&self, span: &Span, share: f64) -> Vector3<f64> {
        match share {
            share if share >= span.share[1] => span.ends[1],
            share if share <= span.share[0] => span.ends[0],
            share => self.curve.point(share),
        }
    }

    /// The stretch from the end of a piece to a share.
    pub fn part(&self, span: &Span, from: &FittedPiece, to: f64) -> Span {
        Span {
            share: [from.share_to, to],
            ends: [from.target, self.point(span, to)],
        }
    }

    /// Maximum distance of pieces from the curve, in mm.
    pub fn allowed_mm(&self) -> f64 {
        let options = self.options;
        // On an arc they may leave the curve by what its chords may leave it, too.
        let most = match self.curve.motion.curve {
            Curve::Arc(_) => USED * (options.tolerance_mm + options.chord_tolerance_mm),
            Curve::Line => USED * options.tolerance_mm,
        };
        // A larger jump may be taken up along the first piece.
        match options.smallest_step_mm() > options.tolerance_mm {
            true => most + options.smallest_step_mm(),
            false => most,
        }
    }

    /// Tolerance that remains, in mm, after the error of interpolating the rotation of the tool linearly between the ends of a
    /// stretch; `None` if nothing remains.
    fn left_mm(&self, span: &Span, within_mm: f64) -> Option<f64> {
        let [from, to] = span.share;
        let (Some(first), Some(last)) = (self.curve.turn(from), self.curve.turn(to)) else {
            return Some(within_mm);
        };
        let off = even(PLACES).map(|part| {
            let turn = self.curve.turn(from + (to - from) * part);
            turn.map_or(0.0, |turn| (first.lerp(&last, part) - turn).norm())
        });
        let off = off.fold(0.0, larger);
        let left = (within_mm * within_mm - off * off).sqrt();
        (left >= 0.0).then_some(left)
    }

    /// The arc, or else the straight piece, between the ends of a stretch, if one fits.
    pub fn fitting(&self, span: &Span) -> Option<FittedPiece> {
        let allowed_mm = self.left_mm(span, self.allowed_mm())?;
        self.through(span, &self.few(span), allowed_mm)?;
        self.through(span, &self.all(span), allowed_mm)
    }

    /// The arcs from the start of a stretch that leave the curve by no more than `within_mm`.
    pub fn tube(&self, span: &Span, within_mm: f64) -> Option<Tube> {
        let Shape::Arcs(arc, form) = self.shape else {
            return None;
        };
        let within_mm = self.left_mm(span, within_mm)?;
        let tube = |places: &[CurvePlace]| self.arcs(arc, form, span, places, within_mm);
        tube(&self.few(span))?;
        tube(&self.all(span))
    }

    /// A few places show most of what does not fit.
    fn few(&self, span: &Span) -> Vec<CurvePlace> {
        self.places(span, even(FEW_PLACES))
    }

    fn all(&self, span: &Span) -> Vec<CurvePlace> {
        let [from, to] = span.share;
        let quarters = self.curve.quarters(from, to);
        let quarters = quarters.map(|share| (share - from) / (to - from));
        self.places(span, even(PLACES).chain(quarters))
    }

    fn places(&self, span: &Span, parts: impl Iterator<Item = f64>) -> Vec<CurvePlace> {
        let [from, to] = span.share;
        parts
            .map(|part| CurvePlace {
                part,
                position: self.curve.point(from + (to - from) * part),
            })
            .collect()
    }

    /// The piece that is near these places.
    fn through(&self, span: &Span, places: &[CurvePlace], allowed_mm: f64) -> Option<FittedPiece> {
        let piece = |arc| FittedPiece {
            share_to: span.share[1],
            target: span.ends[1],
            arc,
            circle: None,
        };
        if let (Shape::Circles, Curve::Arc(arc)) = (self.shape, &self.curve.motion.curve)
            && let Some(circle) = self.circle(arc, span, places, allowed_mm)
        {
            return Some(FittedPiece {
                circle: Some(circle),
                ..piece(None)
            });
        }
        if let Shape::Arcs(arc, form) = self.shape
            && let Some(tube) = self.arcs(arc, form, span, places, allowed_mm)
            && (tube.heights[0]..=tube.heights[1]).contains(&span.ends[1].dot(&arc.axis))
        {
            return Some(piece(Some(tube.arc)));
        }
        let [start, end] = &span.ends;
        let straight = places.iter().all(|place| {
            // NaN does not fit.
            (start.lerp(end, place.part) - place.position).norm() <= allowed_mm
        });
        straight.then(|| piece(None))
    }

    fn arcs(
        &self,
        arc: &Arc,
        form: ArcForm,
        span: &Span,
        places: &[CurvePlace],
        within_mm: f64,
    ) -> Option<Tube> {
        let [from, to] = span.share;
        let sweep = arc.sweep * (to - from);
        let digit_mm = self
            .options
            .last_digit_mm(self.curve.motion.words.mm_per_unit);
        let in_plane = |point: &Vector3<f64>| [point.dot(&arc.first), point.dot(&arc.second)];
        let (start, end) = (in_plane(&span.ends[0]), in_plane(&span.ends[1]));
        let length = (end[0] - start[0]).hypot(end[1] - start[1]);
        let enough = length >= SHORTEST_DIGITS * digit_mm;
        if sweep.abs() > LARGEST_SWEEP || !enough {
            return None;
        }
        let points: Vec<[f64; 2]> = places
            .iter()
            .map(|place| in_plane(&place.position))
            .collect();
        let circle = Circle::through(start, end, &points, sweep)?;
        let turned = circle.turned(end, sweep);
        // The other way round, bent to its other side, it would be nearly a whole circle to a controller.
        if (turned - sweep).abs() > 0.5 || turned * sweep <= 0.0 || turned.abs() > LARGEST_SWEEP {
            return None;
        }
        let flat = circle.radius * (1.0 - (0.5 * turned).cos());
        let near_half = (NOT_BY_RADIUS[0]..NOT_BY_RADIUS[1]).contains(&turned.abs());
        if circle.radius > LARGEST_RADIUS_MM
            || flat < FLATTEST_DIGITS * digit_mm
            || form == ArcForm::Radius && near_half
        {
            return None;
        }
        let fitted = FittedArc {
            centre_mm: circle.centre,
            radius_mm: circle.radius,
            sweep_rad: turned,
            slip: slip(places, |index, part| {
                circle.turned(points[index], turned * part) / turned
            }),
            largest_correction_mm: self.largest_correction_mm(span, places),
        };
        if !is_steady(&fitted.slip) {
            return None;
        }
        let start = span.ends[0].dot(&arc.axis);
        let heights = heights(arc, start, places, &points, &circle, &fitted, within_mm)?;
        Some(Tube {
            arc: fitted,
            heights,
        })
    }

    /// The circle through the ends and a place about in the middle between them.
    fn circle(
        &self,
        arc: &Arc,
        span: &Span,
        places: &[CurvePlace],
        within_mm: f64,
    ) -> Option<FittedCircle> {
        let [from, to] = span.share;
        let sweep = (arc.sweep * (to - from)).abs();
        let [start, end] = &span.ends;
        if (end - start).norm() < SHORTEST_CIRCLE_MM || sweep > LARGEST_CIRCLE {
            return None;
        }
        let via_mm = self.curve.point(from + 0.5 * (to - from));
        let curve = Arc::through(start, &via_mm, end)?;
        let digit_mm = self.options.last_digit_mm(1.0);
        let flat = curve.start_radius * (1.0 - (0.5 * curve.sweep).cos());
        if (curve.sweep - sweep).abs() > 0.5
            || curve.sweep > LARGEST_CIRCLE
            || curve.start_radius > LARGEST_RADIUS_MM
            || flat < FLATTEST_CIRCLE_DIGITS * digit_mm
        {
            return None;
        }
        let slip = slip(places, |index, part| {
            curve.angle_to(&places[index].position, curve.sweep * part) / curve.sweep
        });
        let near = places.iter().all(|place| {
            (curve.point(slipped(&slip, place.part)) - place.position).norm() <= within_mm
        });
        (near && is_steady(&slip)).then(|| FittedCircle {
            via_mm,
            slip,
            length_mm: curve.start_radius * curve.sweep,
            largest_correction_mm: self.largest_correction_mm(span, places),
        })
    }

    fn largest_correction_mm(&self, span: &Span, places: &[CurvePlace]) -> f64 {
        let [from, to] = span.share;
        let motion = self.curve.motion;
        let corrections = places
            .iter()
            .map(|place| (place.position - motion.point(from + (to - from) * place.part)).norm());
        corrections.fold(0.0, larger)
    }
}

/// Parts of a stretch between this many equal ones.
fn even(count: usize) -> impl Iterator<Item = f64> {
    (1..count).map(move |place| place as f64 / count as f64)
}

/// Difference between equal ways of the path and of the arc, as coefficients of two polynomials that are orthogonal over even
/// places, and nearly so over others.
fn slip(places: &[CurvePlace], turned: impl Fn(usize, f64) -> f64) -> [f64; 2] {
    let mut sums = [[0.0; 2]; 2];
    for (index, place) in places.iter().enumerate() {
        let part = place.part;
        let is = turned(index, part);
        let first = part * (1.0 - part);
        let second = first * (1.0 - 2.0 * part);
        for (sum, shape) in sums.iter_mut().zip([first, second]) {
            sum[0] += (is - part) * shape;
            sum[1] += shape * shape;
        }
    }
    sums.map(|[product, square]| product / square)
}

/// The tool never turns back: beyond this the derivative could change its sign.
fn is_steady(slip: &[f64; 2]) -> bool {
    slip[0].abs() + slip[1].abs() <= 0.4
}

/// Lowest and highest end of an arc that begins at a height and is within a distance of all places; none if there is none.
fn heights(
    arc: &Arc,
    start: f64,
    places: &[CurvePlace],
    points: &[[f64; 2]],
    circle: &Circle,
    fitted: &FittedArc,
    within_mm: f64,
) -> Option<[f64; 2]> {
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for (place, point) in places.iter().zip(points) {
        let turned = slipped(&fitted.slip, place.part);
        let (sine, cosine) = (circle.start_angle + fitted.sweep_rad * turned).sin_cos();
        let off = [
            circle.centre[0] + circle.radius * cosine - point[0],
            circle.centre[1] + circle.radius * sine - point[1],
        ];
        // Distance that remains beside the error in the plane; NaN if nothing remains.
        let left = (within_mm * within_mm - off[0] * off[0] - off[1] * off[1]).sqrt();
        let rise = place.position.dot(&arc.axis) - start;
        low = larger(low, (rise - left) / turned);
        high = smaller(high, (rise + left) / turned);
    }
    (low <= high).then_some([start + low, start + high])
}
