//! The words of a fitted arc: a centre or a radius in printed digits.
//!
//! A controller refuses an arc whose radii at start and end differ, so of the printed centres near the fitted one that is
//! taken whose radii differ least. The words that stand in the block are kept where none is better.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::number::{fixed, larger};
use crate::path::curve::Curve;
use crate::writing::blocks::words::AxisWords;
use crate::writing::blocks::{BlockText, Place};
use crate::writing::fitting::stretch::ArcForm;
use crate::writing::output_state::{FittedArc, OutputMove, OutputState, WrittenArc};

/// Digits to both sides of the rounded centre, or radius, that are looked at.
const NEIGHBOURS: i32 = 2;

/// Distance by which rounding the centre may move the arc between its ends, in last digits, to make its radii equal.
const MOVED_DIGITS: f64 = 1.5;

/// An arc to be printed, between ends that are rounded already.
pub(crate) struct ToPrint<'a> {
    pub fitted: &'a FittedArc,
    /// Axis of its normal.
    pub normal: usize,
    pub from: Vector3<f64>,
    pub to: Vector3<f64>,
    /// Origin of its centre words, mm.
    pub reference: Vector3<f64>,
    pub mm_per_unit: f64,
    pub decimals: usize,
}

/// A word: its letter, and its number, or none where the one that stands there (or the missing one) will do.
pub(crate) type ArcWord = (u8, Option<String>);

impl ToPrint<'_> {
    fn step(&self) -> f64 {
        10_f64.powi(-(self.decimals as i32))
    }

    /// Numbers near a value in units, as printed.
    fn near(&self, value: f64) -> impl Iterator<Item = (f64, Option<String>)> + '_ {
        (-NEIGHBOURS..=NEIGHBOURS).filter_map(move |digits| {
            let text = fixed(value + f64::from(digits) * self.step(), self.decimals);
            Some((text.parse().ok()?, Some(text)))
        })
    }

    /// Neighbouring values, after the existing number if that is as near as rounding comes.
    fn choices(&self, value: f64, standing: Option<f64>) -> Vec<(f64, Option<String>)> {
        standing
            .filter(|word| (word - value).abs() <= 0.5 * self.step() * (1.0 + 1e-6))
            .map(|word| (word, None))
            .into_iter()
            .chain(self.near(value))
            .collect()
    }

    fn about(&self, centre_mm: [f64; 2]) -> WrittenArc {
        let mut arc = WrittenArc {
            normal: self.normal,
            centre_mm,
            sweep_rad: self.fitted.sweep_rad,
            slip: self.fitted.slip,
        };
        let curve = arc.between(&self.from, &self.to);
        let [first, second, _] = arc.axes();
        let end = (self.to[second] - centre_mm[1]).atan2(self.to[first] - centre_mm[0]);
        let angle = end - curve.start_angle;
        arc.sweep_rad = angle + TAU * ((self.fitted.sweep_rad - angle) / TAU).round();
        arc
    }

    /// Distance of the printed arc from the fitted one between its ends, and difference of its radii, mm.
    fn off(&self, arc: &WrittenArc) -> [f64; 2] {
        let curve = arc.between(&self.from, &self.to);
        let [first, second, _] = arc.axes();
        let [u, v] = self.fitted.centre_mm;
        let moved = [0.25, 0.5, 0.75].map(|part| {
            let point = curve.point(part);
            ((point[first] - u).hypot(point[second] - v) - self.fitted.radius_mm).abs()
        });
        [
            moved.into_iter().fold(0.0, larger),
            (curve.end_radius - curve.start_radius).abs(),
        ]
    }

    /// The best of some arcs with their words: the least difference of radii among those that move little, or the one that moves least.
    fn best<W>(&self, arcs: impl Iterator<Item = (WrittenArc, W)>) -> Option<(WrittenArc, W)> {
        let most = MOVED_DIGITS * self.step() * self.mm_per_unit;
        // Differences of a nanometre are none.
        let nanometres = |mm: f64| (mm * 1e6).round();
        let rank = |arc: &WrittenArc| {
            let [moved, radii] = self.off(arc);
            match moved <= most {
                true => (0, nanometres(radii), nanometres(moved)),
                false => (1, nanometres(moved), nanometres(radii)),
            }
        };
        let mut best = None;
        let mut least = None;
        for (arc, words) in arcs {
            let rank = rank(&arc);
            if least.is_none_or(|least| rank < least) {
                (least, best) = (Some(rank), Some((arc, words)));
            }
        }
        best
    }

    /// The words of its centre; `standing` has those that the block has, 0 for a missing one where that means the same.
    pub fn centre(&self, standing: [Option<f64>; 3]) -> Option<(WrittenArc, Vec<ArcWord>)> {
        let axes = [(self.normal + 1) % 3, (self.normal + 2) % 3];
        let choices: Vec<Vec<(f64, Option<String>)>> = (0..2)
            .map(|k| {
                let axis = axes[k];
                let wanted = (self.fitted.centre_mm[k] - self.reference[axis]) / self.mm_per_unit;
                self.choices(wanted, standing[axis])
            })
            .collect();
        let pairs = choices[0]
            .iter()
            .flat_map(|first| choices[1].iter().map(move |second| [first, second]));
        let (arc, words) = self.best(pairs.map(|pair| {
            let centre = [0, 1].map(|k| self.reference[axes[k]] + pair[k].0 * self.mm_per_unit);
            (self.about(centre), pair)
        }))?;
        let words = [0, 1].map(|k| (b"IJK"[axes[k]], words[k].1.clone()));
        Some((arc, words.to_vec()))
    }

    /// Word of the radius, negative for more than half a circle; `standing` is that of the block.
    pub fn radius(&self, standing: Option<f64>) -> Option<(WrittenArc, Vec<ArcWord>)> {
        let axes = [(self.normal + 1) % 3, (self.normal + 2) % 3];
        let sign = match self.fitted.sweep_rad.abs() > PI {
            true => -1.0,
            false => 1.0,
        };
        let start = axes.map(|axis| self.from[axis]);
        let chord = [0, 1].map(|k| self.to[axes[k]] - start[k]);
        let length = chord[0].hypot(chord[1]);
        let half = 0.5 * length;
        let side = match (self.fitted.sweep_rad < 0.0) == (sign > 0.0) {
            true => -1.0,
            false => 1.0,
        };
        let wanted = sign * self.fitted.radius_mm / self.mm_per_unit;
        let arcs = self
            .choices(wanted, standing)
            .into_iter()
            .filter_map(|(word, text)| {
                let radius = (word * self.mm_per_unit).abs();
                let height = (radius * radius - half * half).sqrt();
                let centre = [
                    start[0] + 0.5 * chord[0] - side * height * chord[1] / length,
                    start[1] + 0.5 * chord[1] + side * height * chord[0] / length,
                ];
                height.is_finite().then(|| (self.about(centre), text))
            });
        let mut all: Vec<(WrittenArc, Option<String>)> = arcs.collect();
        // All of them have one radius: what counts is where the arc is, and then that the word stands there.
        all.sort_by(|a, b| {
            let moved = |arc: &WrittenArc| {
                (self.off(arc)[0] / (self.step() * self.mm_per_unit) * 2.0).floor()
            };
            moved(&a.0).total_cmp(&moved(&b.0))
        });
        let (arc, text) = all.into_iter().next()?;
        Some((arc, vec![(b'R', text)]))
    }
}

/// Form of the arc in the block: radius or centre.
pub(crate) fn arc_form(text: &BlockText<'_>) -> ArcForm {
    match text.word(b'R') {
        Some(_) => ArcForm::Radius,
        None => ArcForm::Centre,
    }
}

/// Words of a piece that begins at a place and is an arc, after its axis words; none of a straight one.
pub(crate) fn arc_words(
    axes: &AxisWords<'_>,
    state: &mut OutputState,
    step: &OutputMove,
    from: Vector3<f64>,
    place: Place,
) -> Result<Vec<ArcWord>, WriteError> {
    state.arc = None;
    let (Some(fitted), Curve::Arc(arc)) = (&step.arc, &axes.motion.curve) else {
        return Ok(Vec::new());
    };
    let words = &axes.motion.words;
    let to_print = ToPrint {
        fitted,
        normal: arc.axis.imax(),
        from,
        to: state.position,
        reference: match words.absolute_centre {
            true => words.work_offset_mm + state.offset.active_mm,
            false => from,
        },
        mm_per_unit: words.mm_per_unit,
        decimals: axes.decimals,
    };
    let standing = |letter: u8| match place {
        Place::OwnLine => axes.text.number_of(letter),
        Place::FurtherLine => None,
    };
    // On the block's own line a missing word is a centre right beside the start.
    let missing = (place == Place::OwnLine && !words.absolute_centre).then_some(0.0);
    let printed = match arc_form(&axes.text) {
        ArcForm::Radius => to_print.radius(standing(b'R')),
        ArcForm::Centre => to_print.centre(b"IJK".map(|letter| standing(letter).or(missing))),
    };
    let (written, words) = printed.ok_or(WriteError::Verification {
        line: axes.motion.line,
        output_line: 0,
        what: "an arc that was fitted cannot be printed".to_owned(),
    })?;
    state.arc = Some(written);
    Ok(words)
}
