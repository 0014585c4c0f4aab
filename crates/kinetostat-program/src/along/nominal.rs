//! Feed moves along their length, in passes of the tool.

use nalgebra::Vector3;
use rstar::RTree;
use rstar::primitives::{GeomWithData, Line};

use crate::path::curve::Curve;
use crate::path::moves::{Move, Path};

/// A path that nothing can be compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the program has no feed move with a length from a known place: there is nothing to compare with it"
)]
pub struct NoFeedMove;

/// Largest distance of two places that are one, mm: rounding of increments and inches.
pub(crate) const SAME_MM: f64 = 1e-6;

/// Chord error of the search, mm.
const CHORD_MM: f64 = 0.01;

/// A feed move with its place along the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeedPiece {
    /// Index of the move in [`Path::moves`].
    pub move_index: usize,
    /// Length of the path before it, mm.
    pub from_mm: f64,
    /// Length of the piece, mm.
    pub length_mm: f64,
    /// Index of its pass in [`NominalPath::passes`].
    pub pass: usize,
}

/// Feed moves one after the other, without a rapid between them: the tool stays on the part.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// Pieces of the pass, in [`NominalPath::pieces`].
    pub pieces: std::ops::Range<usize>,
    /// Start and end along the path, mm.
    pub along_mm: [f64; 2],
}

/// A chord in the search tree, with its piece and the shares at its ends.
pub(crate) type Chord = GeomWithData<Line<[f64; 3]>, (usize, [f64; 2])>;

/// The path as it is drawn: its feed moves from known places, which alone are measured and corrected.
///
/// ```
/// use kinetostat_program::{NominalPath, Program, ReadOptions, interpret};
///
/// let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X10 F300\nG1 Y10\nG0 Z5\nG0 X0 Y0\nG0 Z0\nG1 X5 Y5\n";
/// let path = interpret(&Program::read(text)?, &ReadOptions::default())?;
/// let nominal = NominalPath::new(&path)?;
/// assert_eq!((nominal.pieces().len(), nominal.passes().len()), (3, 2));
/// assert_eq!(nominal.passes()[0].along_mm, [0.0, 20.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct NominalPath<'a> {
    path: &'a Path,
    pieces: Vec<FeedPiece>,
    passes: Vec<Pass>,
    pub(crate) chords: RTree<Chord>,
}

impl<'a> NominalPath<'a> {
    /// The feed moves of a program.
    ///
    /// # Errors
    /// There is none that has a length and starts at a known place.
    pub fn new(path: &'a Path) -> Result<Self, NoFeedMove> {
        let (mut pieces, mut passes) = (Vec::<FeedPiece>::new(), Vec::<Pass>::new());
        let mut along_mm = 0.0;
        // End of the current pass.
        let mut reached: Option<Vector3<f64>> = None;
        for (move_index, motion) in path.moves.iter().enumerate() {
            if !motion.is_known_feed() {
                // A block without length does not leave the part.
                reached = reached.filter(|_| !motion.has_length());
                continue;
            }
            if !motion.has_length() {
                continue;
            }
            let goes_on = reached.is_some_and(|end| (motion.start - end).norm() <= SAME_MM);
            let length_mm = motion.length_mm();
            if !goes_on {
                passes.push(Pass {
                    pieces: pieces.len()..pieces.len(),
                    along_mm: [along_mm; 2],
                });
            }
            pieces.push(FeedPiece {
                move_index,
                from_mm: along_mm,
                length_mm,
                pass: passes.len() - 1,
            });
            along_mm += length_mm;
            if let Some(pass) = passes.last_mut() {
                pass.pieces.end = pieces.len();
                pass.along_mm[1] = along_mm;
            }
            reached = Some(motion.end);
        }
        if pieces.is_empty() {
            return Err(NoFeedMove);
        }
        let chords = pieces.iter().enumerate();
        let chords =
            chords.flat_map(|(index, piece)| chords_of(index, &path.moves[piece.move_index]));
        let chords = RTree::bulk_load(chords.collect());
        Ok(Self {
            path,
            pieces,
            passes,
            chords,
        })
    }

    /// The pieces in their order.
    #[must_use]
    pub fn pieces(&self) -> &[FeedPiece] {
        &self.pieces
    }

    /// The passes in their order.
    #[must_use]
    pub fn passes(&self) -> &[Pass] {
        &self.passes
    }

    /// The path that it was made from.
    #[must_use]
    pub fn path(&self) -> &'a Path {
        self.path
    }

    /// The move of a piece.
    #[must_use]
    pub fn motion(&self, piece: &FeedPiece) -> &'a Move {
        &self.path.moves[piece.move_index]
    }

    /// Length of all pieces, mm.
    #[must_use]
    pub fn length_mm(&self) -> f64 {
        self.pieces
            .last()
            .map_or(0.0, |piece| piece.from_mm + piece.length_mm)
    }

    /// The piece and the share of it at a length along the path, mm; the nearest end outside of it.
    #[must_use]
    pub fn at_length(&self, along_mm: f64) -> (usize, f64) {
        let after = self
            .pieces
            .partition_point(|piece| piece.from_mm <= along_mm);
        let index = after.saturating_sub(1);
        let piece = &self.pieces[index];
        let share = (along_mm - piece.from_mm) / piece.length_mm;
        (index, share.clamp(0.0, 1.0))
    }

    /// The place at a length along the path, mm.
    #[must_use]
    pub fn point_at(&self, along_mm: f64) -> Vector3<f64> {
        let (index, share) = self.at_length(along_mm);
        self.motion(&self.pieces[index]).point(share)
    }
}

fn chords_of(piece: usize, motion: &Move) -> impl Iterator<Item = Chord> {
    let parts = match &motion.curve {
        Curve::Line => 1,
        Curve::Arc(arc) => arc.chords_within(CHORD_MM),
    };
    let corner = move |part: usize| motion.point(part as f64 / parts as f64).into();
    (0..parts).map(move |part| {
        let shares = [part, part + 1].map(|part| part as f64 / parts as f64);
        let line = Line::new(corner(part), corner(part + 1));
        Chord::new(line, (piece, shares))
    })
}
