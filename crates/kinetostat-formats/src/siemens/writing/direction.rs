//! The tool's direction as the text states it.

use nalgebra::Vector3;

use crate::model::orientation::OrientationText;
use crate::model::site::TargetSite;
use crate::siemens::place::without;
use crate::siemens::writing::writer::{Reason, SAME, Writer};
use crate::writing::piece::Piece;

/// Directions as written are the same below this, rad: their last digit.
const SAME_WRITTEN: f64 = 2e-7;

impl Writer<'_> {
    /// The direction that the text states, in the part's axes.
    fn stated_direction(&self) -> Option<Vector3<f64>> {
        let by_axis = matches!(&self.motion.site.target, TargetSite::Literal(text) if text.convention == OrientationText::Axis);
        let pose = self.motion.target.pose().filter(|_| by_axis)?;
        Some(pose.orientation * Vector3::z())
    }

    pub(crate) fn turns(&self, pieces: &[&Piece]) -> Result<(), Reason> {
        let pose = self.motion.target.pose();
        let axis = pose.map(|pose| pose.orientation * Vector3::z());
        let turns = |piece: &&Piece| {
            let wanted = piece.orientation.map(|turn| turn * Vector3::z());
            wanted
                .zip(axis)
                .is_some_and(|(to, from)| to.angle(&from) > SAME)
        };
        match self.stated_direction().is_none() && pieces.iter().any(turns) {
            true => Err((
                "the end states no direction of the tool that could be corrected",
                "let the CAM system write directions (A3, B3, C3), or correct its place alone",
            )),
            false => Ok(()),
        }
    }

    /// Words of the direction of the first piece.
    pub(crate) fn direction(&mut self, piece: &Piece, added: &mut String) {
        let Some(own) = self.stated_direction() else {
            return;
        };
        let words = &self.written.direction_words;
        if !words.is_empty() {
            self.held.direction = None;
            let wanted = piece.orientation.map(|turn| turn * Vector3::z());
            if wanted.is_none_or(|wanted| wanted.angle(&own) <= SAME) {
                return;
            }
            for word in words {
                let word = without(self.file.bytes(), word, self.written.words_at);
                self.edits.replace(word, "");
            }
        }
        self.direction_of(piece, added);
    }

    /// Words of a direction that is not in force; it is then.
    pub(crate) fn direction_of(&mut self, piece: &Piece, added: &mut String) {
        let Some(own) = self.stated_direction() else {
            return;
        };
        let wanted = piece.orientation.map_or(own, |turn| turn * Vector3::z());
        let in_force = self.held.direction.unwrap_or(own);
        if wanted.angle(&in_force) <= SAME_WRITTEN {
            return;
        }
        let digits = self.options.quaternion_decimals;
        let inner = self.written.frame.rotation.inverse() * wanted;
        for (letter, value) in ["A3", "B3", "C3"].iter().zip(inner.iter()) {
            added.push_str(&format!(" {letter}={value:.digits$}"));
        }
        self.held.direction = (wanted.angle(&own) > SAME).then_some(wanted);
    }
}
