//! Arcs in place of arcs: as few as follow the corrected curve.
//!
//! Where a correction varies, the corrected curve of an arc is nearly an arc. A stretch of it is taken for one arc about an axis
//! of the same direction, that rises evenly and passes through both ends; the centre is where the squares of the radial
//! distances in between are least (Newton's method in the one unknown that is left, the distance of the centre from the
//! chord). Equal ways along the path are not quite equal angles of the new arc; what is left of that after a polynomial of third
//! degree ([`crate::WrittenArc::slip`]) counts as a distance too. A stretch fits if all places looked at are within the tolerance.
//!
//! A move is taken whole, in two or three equal stretches, or in stretches each as long as it can be. A straight piece is
//! taken where no arc can be printed: one that is bent by less than its digits, or too small for them.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::number::larger;
use crate::path::curve::Arc;
use crate::writing::corrected_curve::CorrectedCurve;
use crate::writing::options::WriteOptions;
use crate::writing::output_state::FittedArc;

/// How the arcs of a block are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ArcForm {
    /// I, J and K.
    Centre,
    /// R, which says little of the centre of nearly half a circle.
    Radius,
}

/// A stretch of a move without a jump, and where its ends are to be, in mm.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Span {
    pub share: [f64; 2],
    pub ends: [Vector3<f64>; 2],
}

/// A piece that fits; straight without an arc.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FittedPiece {
    pub share_to: f64,
    pub target: Vector3<f64>,
    pub arc: Option<FittedArc>,
}

/// Stretches looked at in a piece.
const PLACES: usize = 32;
const FEW_PLACES: usize = 8;

/// Part of the tolerance that is used: the places in between, and what the correction may be off from its polynomial.
const USED: f64 = 0.85;

/// Most of a turn in one arc: behind it start and end come near each other, and the digits decide how far it goes.
const LARGEST_SWEEP: f64 = 300.0 / 360.0 * TAU;

/// Sweeps that are not written by R: the centre of nearly half a circle is anywhere.
const NOT_BY_RADIUS: [f64; 2] = [PI * 0.68, PI * 1.32];

/// An arc is at least so many last digits long, and bent by at least so many.
const SHORTEST_DIGITS: f64 = 20.0;
const FLATTEST_DIGITS: f64 = 2.0;

/// Largest radius written, mm.
const LARGEST_RADIUS_MM: f64 = 1e6;

/// Halvings in the search for the longest stretch that fits.
const HALVINGS: u32 = 14;

/// Stretches that are taken equally long if so many equal ones fit.
const MOST_EQUAL: usize = 64;

/// What arcs are fitted to.
pub(crate) struct Fit<'a> {
    pub curve: CorrectedCurve<'a>,
    /// The arc of the path; on a straight move all pieces are straight.
    pub arc: Option<&'a Arc>,
    pub form: ArcForm,
    pub options: &'a WriteOptions,
}

impl Fit<'_> {
    /// The pieces of a stretch without a jump.
    pub fn pieces(&self, span: &Span) -> Result<Vec<FittedPiece>, WriteError> {
        for count in 1..=3 {
            if let Some(pieces) = self.equal(span, count) {
                return Ok(pieces);
            }
        }
        let longest = self.longest(span)?;
        let equal = match longest.len() <= MOST_EQUAL {
            true => self.equal(span, longest.len()),
            false => None,
        };
        Ok(equal.unwrap_or(longest))
    }

    fn point(&self, span: &Span, share: f64) -> Vector3<f64> {
        match share {
            share if share >= span.share[1] => span.ends[1],
            share if share <= span.share[0] => span.ends[0],
            share => self.curve.point(share),
        }
    }

    fn part(&self, span: &Span, from: &FittedPiece, to: f64) -> Span {
        Span {
            share: [from.share_to, to],
            ends: [from.target, self.point(span, to)],
        }
    }

    fn start(span: &Span) -> FittedPiece {
        FittedPiece {
            share_to: span.share[0],
            target: span.ends[0],
            arc: None,
        }
    }

    /// So many pieces of the same length, if all of them fit.
    pub fn equal(&self, span: &Span, count: usize) -> Option<Vec<FittedPiece>> {
        let [from, to] = span.share;
        let mut pieces = Vec::with_capacity(count);
        let mut last = Self::start(span);
        for piece in 1..=count {
            let share = match piece == count {
                true => to,
                false => from + (to - from) * piece as f64 / count as f64,
            };
            last = self.fitting(&self.part(span, &last, share))?;
            pieces.push(last);
        }
        Some(pieces)
    }

    /// Pieces that are each as long as they can be.
    fn longest(&self, span: &Span) -> Result<Vec<FittedPiece>, WriteError> {
        let to = span.share[1];
        let motion = self.curve.motion;
        let shortest = self.options.smallest_piece_mm / motion.length_mm();
        let mut pieces: Vec<FittedPiece> = Vec::new();
        let mut last = Self::start(span);
        let mut stride = to - span.share[0];
        while last.share_to < to {
            if pieces.len() >= self.options.max_pieces {
                return Err(WriteError::TooManyPieces {
                    line: motion.line,
                    limit: self.options.max_pieces,
                });
            }
            let from = last.share_to;
            let fitting = |share: f64| self.fitting(&self.part(span, &last, share));
            let mut best = None;
            // What fits is as long as the piece before, or longer, or shorter.
            let mut high = (from + 2.0 * stride).min(to);
            let mut low = from;
            for _ in 0..HALVINGS {
                match fitting(high) {
                    Some(piece) if high >= to => {
                        best = Some(piece);
                        break;
                    }
                    Some(piece) => {
                        best = Some(piece);
                        low = high;
                        high = (high + 2.0 * (high - from)).min(to);
                    }
                    None => break,
                }
            }
            if low < high && best.is_none_or(|piece| piece.share_to < to) {
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    match fitting(middle) {
                        Some(piece) => (best, low) = (Some(piece), middle),
                        None => high = middle,
                    }
                    if high - low <= shortest {
                        break;
                    }
                }
            }
            // Shorter than the shortest piece the curve is followed as it is, with an end where it may have a corner.
            let corner = self.curve.quarters(from, to).next();
            let next = (from + shortest).min(corner.unwrap_or(to)).min(to);
            let piece = best.unwrap_or_else(|| FittedPiece {
                share_to: next,
                target: self.point(span, next),
                arc: None,
            });
            stride = piece.share_to - from;
            if stride <= 0.0 {
                // A share so near the end that the sum does not reach it.
                last = FittedPiece {
                    share_to: to,
                    target: span.ends[1],
                    arc: None,
                };
                pieces.push(last);
                continue;
            }
            pieces.push(piece);
            last = piece;
        }
        Ok(pieces)
    }

    /// The arc, or else the straight piece, for a stretch, if one fits.
    fn fitting(&self, span: &Span) -> Option<FittedPiece> {
        let [from, to] = span.share;
        let place = |part: f64| (part, self.curve.point(from + (to - from) * part));
        let even = |count: usize| (1..count).map(move |place| place as f64 / count as f64);
        // A few places show most of what does not fit.
        let few: Vec<_> = even(FEW_PLACES).map(place).collect();
        self.through(span, &few)?;
        let mut parts: Vec<f64> = even(PLACES).collect();
        let quarters = self.curve.quarters(from, to);
        parts.extend(quarters.map(|share| (share - from) / (to - from)));
        let all: Vec<_> = parts.into_iter().map(place).collect();
        self.through(span, &all)
    }

    /// The piece that is near these places, by the part of the stretch.
    fn through(&self, span: &Span, places: &[(f64, Vector3<f64>)]) -> Option<FittedPiece> {
        let piece = |arc| FittedPiece {
            share_to: span.share[1],
            target: span.ends[1],
            arc,
        };
        if let Some(arc) = self.arc.and_then(|arc| self.arc(arc, span, places)) {
            return Some(piece(Some(arc)));
        }
        let [start, end] = &span.ends;
        let straight = places.iter().all(|(part, place)| {
            // What is no number does not fit.
            (start.lerp(end, *part) - place).norm() <= self.allowed_mm()
        });
        straight.then(|| piece(None))
    }

    fn allowed_mm(&self) -> f64 {
        let options = self.options;
        let most = match self.arc {
            Some(_) => USED * (options.tolerance_mm + options.chord_tolerance_mm),
            None => USED * options.tolerance_mm,
        };
        // A larger jump may be taken up along the first piece.
        match options.smallest_step_mm() > options.tolerance_mm {
            true => most + options.smallest_step_mm(),
            false => most,
        }
    }

    fn arc(&self, arc: &Arc, span: &Span, places: &[(f64, Vector3<f64>)]) -> Option<FittedArc> {
        let [from, to] = span.share;
        let share_at = |part: f64| from + (to - from) * part;
        let sweep = arc.sweep * (to - from);
        let digit_mm = self
            .options
            .last_digit_mm(self.curve.motion.words.mm_per_unit);
        let in_plane = |point: &Vector3<f64>| [point.dot(&arc.first), point.dot(&arc.second)];
        let (start, end) = (in_plane(&span.ends[0]), in_plane(&span.ends[1]));
        let chord = [end[0] - start[0], end[1] - start[1]];
        let length = chord[0].hypot(chord[1]);
        let enough = length >= SHORTEST_DIGITS * digit_mm;
        if sweep.abs() > LARGEST_SWEEP || !enough {
            return None;
        }
        let points: Vec<[f64; 2]> = places.iter().map(|(_, place)| in_plane(place)).collect();
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
            || self.form == ArcForm::Radius && near_half
        {
            return None;
        }
        // How far equal ways of the path and of the arc are apart: two polynomials that have nothing in common over even
        // places, and little over others.
        let mut sums = [[0.0; 2]; 2];
        let parts: Vec<f64> = places
            .iter()
            .zip(&points)
            .map(|((part, _), point)| circle.turned(*point, turned * part) / turned)
            .collect();
        for ((part, _), is) in places.iter().zip(&parts) {
            let first = part * (1.0 - part);
            let second = first * (1.0 - 2.0 * part);
            for (sum, shape) in sums.iter_mut().zip([first, second]) {
                sum[0] += (is - part) * shape;
                sum[1] += shape * shape;
            }
        }
        let fitted = FittedArc {
            centre_mm: circle.centre,
            radius_mm: circle.radius,
            sweep_rad: turned,
            slip: sums.map(|[product, square]| product / square),
            largest_correction_mm: places
                .iter()
                .map(|(part, place)| (place - self.curve.motion.point(share_at(*part))).norm())
                .fold(0.0, larger),
        };
        // The tool never turns back: beyond this the derivative could change its sign.
        let steady = fitted.slip[0].abs() + fitted.slip[1].abs() <= 0.4;
        (steady && off_mm(arc, span, places, (&circle, &fitted)) <= self.allowed_mm())
            .then_some(fitted)
    }
}

/// Largest distance of an arc from the corrected curve, in mm.
fn off_mm(
    arc: &Arc,
    span: &Span,
    places: &[(f64, Vector3<f64>)],
    (circle, fitted): (&Circle, &FittedArc),
) -> f64 {
    let heights = span.ends.map(|end| end.dot(&arc.axis));
    let off = places.iter().map(|(part, place)| {
        let shape = part * (1.0 - part);
        let turned = part + shape * (fitted.slip[0] + fitted.slip[1] * (1.0 - 2.0 * part));
        let (sine, cosine) = (circle.start_angle + fitted.sweep_rad * turned).sin_cos();
        let made = arc.first * (circle.centre[0] + circle.radius * cosine)
            + arc.second * (circle.centre[1] + circle.radius * sine)
            + arc.axis * (heights[0] + (heights[1] - heights[0]) * turned);
        (made - place).norm()
    });
    off.fold(0.0, larger)
}

/// A circle in the plane of an arc.
struct Circle {
    centre: [f64; 2],
    radius: f64,
    start_angle: f64,
}

impl Circle {
    /// Through two ends, and as near to the places between as it can be; the sweep is about this.
    fn through(start: [f64; 2], end: [f64; 2], places: &[[f64; 2]], sweep: f64) -> Option<Self> {
        let chord = [end[0] - start[0], end[1] - start[1]];
        let length = chord[0].hypot(chord[1]);
        let left = [-chord[1] / length, chord[0] / length];
        let half = 0.5 * length;
        let middle = [start[0] + 0.5 * chord[0], start[1] + 0.5 * chord[1]];
        // Distance of the centre from the chord, to its left.
        let mut height = half / (0.5 * sweep).tan();
        let centre = |height: f64| [middle[0] + height * left[0], middle[1] + height * left[1]];
        for _ in 0..4 {
            let (about, radius) = (centre(height), half.hypot(height));
            let (mut product, mut square) = (0.0, 0.0);
            for place in places {
                let out = [place[0] - about[0], place[1] - about[1]];
                let distance = out[0].hypot(out[1]);
                let slope = -(out[0] * left[0] + out[1] * left[1]) / distance - height / radius;
                product += (distance - radius) * slope;
                square += slope * slope;
            }
            height -= product / square;
        }
        let (centre, radius) = (centre(height), half.hypot(height));
        let out = [start[0] - centre[0], start[1] - centre[1]];
        let usable = radius.is_finite() && radius > 0.0;
        usable.then(|| Self {
            centre,
            radius,
            start_angle: out[1].atan2(out[0]),
        })
    }

    /// Angle from the start to a place, the one that is nearest to what is expected.
    fn turned(&self, place: [f64; 2], expected: f64) -> f64 {
        let angle = (place[1] - self.centre[1]).atan2(place[0] - self.centre[0]) - self.start_angle;
        angle + TAU * ((expected - angle) / TAU).round()
    }
}
