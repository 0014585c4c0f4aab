//! The pole that the written blocks leave behind, where it is another one.

use nalgebra::Vector2;

use crate::heidenhain::plane::Plane;
use crate::heidenhain::reading::found::Way;
use crate::heidenhain::writing::words::word_text;
use crate::heidenhain::writing::writer::{OwnPole, Writer};
use crate::model::motion::Motion;

/// Poles nearer than this are one, mm.
const SAME_POLE_MM: f64 = 1e-9;

/// Limit of the decimals of a pole that is stated again.
const MOST_DIGITS: usize = 7;

impl Writer<'_> {
    /// Puts a pole of its own in force; whether a CC block is needed for it.
    pub(crate) fn own_pole(&mut self, way: &Way, at: Vector2<f64>) -> bool {
        let in_force = match self.pole.filter(|own| way.pole.whole <= own.count) {
            Some(own) if own.count == way.pole.count => Some((own.plane, own.at)),
            Some(_) => None,
            None => {
                (way.pole.at.filter(|_| way.pole_from.is_none())).map(|pole| (pole.plane, pole.at))
            }
        };
        let is_same = |(plane, pole): (Plane, Vector2<f64>)| {
            plane == way.plane && (pole - at).norm() < SAME_POLE_MM
        };
        if in_force.is_some_and(is_same) {
            return false;
        }
        self.pole = Some(OwnPole {
            plane: way.plane,
            at,
            count: way.pole.count,
        });
        // After CC no last polar radius exists.
        self.polar_broken = true;
        true
    }

    /// States the pole again that a block counts from, where another one is in force.
    pub(crate) fn restore_pole(&mut self, motion: &Motion, way: &Way) {
        let Some(own) = self.pole else {
            return;
        };
        if way.pole.whole > own.count {
            self.pole = None;
            return;
        }
        let Some(pole) = way.pole.at.filter(|_| way.pole.used) else {
            return;
        };
        self.pole = None;
        let file = &self.program.files[motion.file];
        let signs = self.signs[motion.file];
        let text = [0, 1].map(|axis| {
            let value = pole.at[axis] / way.unit_mm;
            let is_exact = |digits: &usize| {
                let fine = 10.0_f64.powi(*digits as i32);
                ((value * fine).round() / fine - value).abs() < SAME_POLE_MM
            };
            let digits = (0..MOST_DIGITS).find(is_exact);
            let axis = pole.plane.axes()[axis];
            word_text(axis, value, digits.unwrap_or(MOST_DIGITS), signs)
        });
        let mut inserted = file
            .part(&(way.block.lines.start..motion.span.start))
            .to_vec();
        inserted.extend_from_slice(format!("CC {} {}", text[0], text[1]).as_bytes());
        inserted.extend_from_slice(file.line_ending());
        let at = way.block.lines.start;
        self.edits[motion.file].replace(at..at, inserted);
        self.added[motion.file] = true;
    }
}
