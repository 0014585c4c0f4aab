//! Places along a path as it is drawn: its feed moves by their length, in passes of the tool, the feet of points on it, and
//! points in their order.

pub(crate) mod in_order;

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

/// Steps towards the foot on an arc, each of which leaves a share of the distance to it like that of the point's distance
/// from the arc to its radius.
const STEPS: usize = 50;

/// A place of the path and a point that is nearest to it around there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Index of the piece.
    pub piece: usize,
    /// Share of the piece.
    pub share: f64,
    /// Length along the path, mm.
    pub along_mm: f64,
    /// The place, mm.
    pub place_mm: Vector3<f64>,
    /// Direction of the path there.
    pub tangent: Vector3<f64>,
    /// Distance of the point from the path, mm.
    pub distance_mm: f64,
}

impl NominalPath<'_> {
    /// The nearest place of the whole path; `None` for a point that is none.
    ///
    /// ```
    /// use kinetostat_program::{NominalPath, Program, ReadOptions, interpret};
    /// use nalgebra::Vector3;
    ///
    /// let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X10 F300\nG3 X10 Y20 J10\n";
    /// let path = interpret(&Program::read(text)?, &ReadOptions::default())?;
    /// let nominal = NominalPath::new(&path)?;
    /// let foot = nominal.nearest(&Vector3::new(21.0, 10.0, 0.0)).unwrap();
    /// assert!((foot.distance_mm - 1.0).abs() < 1e-12);
    /// assert!((foot.along_mm - 10.0 - 5.0 * std::f64::consts::PI).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn nearest(&self, point: &Vector3<f64>) -> Option<Foot> {
        let chord = self.chords.nearest_neighbor((*point).into())?;
        let (piece, shares) = chord.data;
        let foot = self.foot(piece, shares, point);
        foot.distance_mm.is_finite().then_some(foot)
    }

    /// The nearest places of all stretches of the path that come within a distance, in order along the path. Places belong to
    /// one stretch where the path between them is no longer than four times the distance. With a line of the program only
    /// its moves are looked at.
    #[must_use]
    pub fn feet_within(
        &self,
        point: &Vector3<f64>,
        within_mm: f64,
        line: Option<usize>,
    ) -> Vec<Foot> {
        let of_line =
            |piece: usize| line.is_none_or(|line| self.motion(&self.pieces()[piece]).line == line);
        let squared = within_mm * within_mm;
        // Chords leave their arcs a little: what is left out here by that is within the distance by no more.
        let near = self.chords.locate_within_distance((*point).into(), squared);
        let mut feet: Vec<Foot> = near
            .filter(|chord| of_line(chord.data.0))
            .map(|chord| self.foot(chord.data.0, chord.data.1, point))
            .filter(|foot| foot.distance_mm <= within_mm)
            .collect();
        feet.sort_by(|a, b| a.along_mm.total_cmp(&b.along_mm));
        let mut stretches: Vec<(f64, Foot)> = Vec::new();
        for foot in feet {
            match stretches.last_mut() {
                Some((end, best))
                    if self.pieces()[best.piece].pass == self.pieces()[foot.piece].pass
                        && foot.along_mm - *end <= 4.0 * within_mm =>
                {
                    *end = foot.along_mm;
                    if foot.distance_mm < best.distance_mm {
                        *best = foot;
                    }
                }
                _ => stretches.push((foot.along_mm, foot)),
            }
        }
        stretches.into_iter().map(|(_, foot)| foot).collect()
    }

    /// The places within a distance of a point to which it is nearer than to those beside them, in order along the path.
    ///
    /// ```
    /// use kinetostat_program::{NominalPath, Program, ReadOptions, interpret};
    /// use nalgebra::Vector3;
    ///
    /// let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X10 F300\nG1 Y10\n";
    /// let path = interpret(&Program::read(text)?, &ReadOptions::default())?;
    /// let nominal = NominalPath::new(&path)?;
    /// let near = |x, y| nominal.nearest_within(&Vector3::new(x, y, 0.0), 3.0);
    /// let along = |x, y| near(x, y).iter().map(|foot| foot.along_mm).collect::<Vec<f64>>();
    /// assert_eq!(along(8.0, 1.0), [8.0, 11.0]);
    /// assert_eq!(along(11.0, -1.0), [10.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn nearest_within(&self, point: &Vector3<f64>, within_mm: f64) -> Vec<Foot> {
        let near = self
            .chords
            .locate_within_distance((*point).into(), within_mm * within_mm);
        let mut feet: Vec<(Foot, bool)> = near
            .filter_map(|chord| self.foot_of_chord(chord.data.0, chord.data.1, point))
            .filter(|(foot, _)| foot.distance_mm <= within_mm)
            .collect();
        feet.sort_by(|a, b| a.0.along_mm.total_cmp(&b.0.along_mm));
        // The place between two chords is an end of both.
        feet.dedup_by(|b, a| {
            a.1 && b.1 && (b.0.along_mm - a.0.along_mm).abs() <= 1e-12 * (1.0 + a.0.along_mm)
        });
        feet.into_iter().map(|(foot, _)| foot).collect()
    }

    /// The foot on the piece of a chord if it lies on that chord, and whether at an end of it; none where it is an end from which
    /// the path comes nearer on the next chord.
    fn foot_of_chord(
        &self,
        piece: usize,
        [from, to]: [f64; 2],
        point: &Vector3<f64>,
    ) -> Option<(Foot, bool)> {
        let foot = self.foot(piece, [from, to], point);
        let share = foot.share.clamp(from, to);
        if share > from && share < to {
            return Some((foot, false));
        }
        let own = &self.pieces()[piece];
        let pass = &self.passes()[own.pass].pieces;
        let beyond = match (share == to, share >= 1.0, share <= 0.0) {
            (true, true, _) => (piece + 1 < pass.end).then_some((piece + 1, 0.0)),
            (false, _, true) => (piece > pass.start).then(|| (piece - 1, 1.0)),
            _ => Some((piece, share)),
        };
        let leaves = |(index, share): (usize, f64), sign: f64| {
            let motion = self.motion(&self.pieces()[index]);
            let tangent = motion.tangent(share).unwrap_or_else(Vector3::zeros);
            let away = point - motion.point(share);
            // A point at the end itself is nearest to that: which way it is away from there is rounding.
            away.norm() <= SAME_MM || sign * tangent.dot(&away) <= 1e-9 * away.norm()
        };
        let sign = if share == to { 1.0 } else { -1.0 };
        let is_nearest = beyond.is_none_or(|beyond| leaves(beyond, sign));
        is_nearest.then(|| (self.at(piece, share, point), true))
    }

    /// The foot on a piece around a chord of it.
    fn foot(&self, piece: usize, [from, to]: [f64; 2], point: &Vector3<f64>) -> Foot {
        let own = &self.pieces()[piece];
        let motion = self.motion(own);
        let tangent = |share: f64| motion.tangent(share).unwrap_or_else(Vector3::zeros);
        let step = |share: f64| {
            let way = (point - motion.point(share)).dot(&tangent(share)) / own.length_mm;
            (share + way).clamp(0.0, 1.0)
        };
        let mut share = step(0.5 * (from + to));
        if let Curve::Arc(arc) = &motion.curve {
            // Outside an arc the way along its tangent is too long for the way around.
            let radius = arc.start_radius.max(f64::MIN_POSITIVE);
            share = 0.5 * (from + to);
            for _ in 0..STEPS {
                let out = (point - arc.point(share)).norm() / radius;
                let next = share + (step(share) - share) / (1.0 + out);
                let moved = (next - share).abs();
                share = next;
                if moved * own.length_mm <= 1e-14 * radius {
                    break;
                }
            }
        }
        self.at(piece, share, point)
    }

    /// A place of a piece, with the point that belongs to it.
    fn at(&self, piece: usize, share: f64, point: &Vector3<f64>) -> Foot {
        let own = &self.pieces()[piece];
        let motion = self.motion(own);
        let place_mm = motion.point(share);
        Foot {
            piece,
            share,
            along_mm: own.from_mm + share * own.length_mm,
            place_mm,
            tangent: motion.tangent(share).unwrap_or_else(Vector3::zeros),
            distance_mm: (point - place_mm).norm(),
        }
    }
}
