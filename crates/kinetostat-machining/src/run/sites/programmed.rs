//! The places at which a program is looked at as it is given.

use kinetostat_program::{Curve, Move, MoveKind, Path};

/// Blocks longer than this share of the path that is cut are looked at in more places.
const PIECES: f64 = 500.0;

/// A move that turns the tool is looked at after so much of its turn, deg.
const TURN_DEG: f64 = 10.0;

/// Arcs are looked at where chords leave them by at most this, mm.
pub(super) const ARC_MM: f64 = 0.01;

/// The places at which a program is looked at as it is given: the same whether and how it is written anew,
/// so that means without compensation are the same in every run.
pub(super) struct Programmed {
    longest_mm: f64,
    pub short_mm: f64,
}

impl Programmed {
    pub fn new(path: &Path, spacing_mm: f64) -> Self {
        let cut = path.moves.iter().filter(|m| m.kind == MoveKind::Feed);
        let length = match &path.part {
            Some(part) => part.whole_feed_mm,
            None => cut.map(Move::known_length_mm).sum::<f64>(),
        };
        Self {
            longest_mm: (length / PIECES).min(spacing_mm),
            short_mm: SHORT * spacing_mm,
        }
    }

    /// Into how many pieces a block is divided.
    pub fn pieces(&self, motion: &Move) -> usize {
        let length = motion.length_mm();
        // All lengths are zero in a program that only turns.
        let pieces = match length > 0.0 {
            true => (length / self.longest_mm).ceil().clamp(1.0, 1e6) as usize,
            false => 1,
        };
        let pieces = pieces.max(turns(motion, 1.0));
        match &motion.curve {
            Curve::Line => pieces,
            Curve::Arc(arc) => pieces.max(arc.chords_within(ARC_MM)),
        }
    }

    /// Ends and middles of its equal pieces ([`Self::pieces`]) of a block at feed, as shares of it, and which of them are ends: between
    /// the ends of a long block the load or the machine may differ much. A very short one has no middle.
    pub fn shares(
        &self,
        motion: &Move,
        pieces: usize,
    ) -> impl Iterator<Item = (f64, bool)> + use<> {
        let middles = pieces > 1 || motion.length_mm() > self.short_mm || motion.turns_in_place();
        (1..=2 * pieces)
            .filter(move |half| middles || half % 2 == 0)
            .map(move |half| (half as f64 / (2 * pieces) as f64, half % 2 == 0))
    }
}

/// Into how many parts a share of a move is divided by the turn of the tool in the part.
pub(super) fn turns(motion: &Move, width: f64) -> usize {
    (motion.turn_deg() * width / TURN_DEG)
        .ceil()
        .clamp(1.0, 1e6) as usize
}

/// Share of the spacing below which a block that was not divided is straight in every respect.
const SHORT: f64 = 0.05;
