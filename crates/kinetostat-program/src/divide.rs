//! Where a block must be divided so that straight pieces follow the corrected curve.
//!
//! The corrected curve of a move is `point(s) + c(s)`, `s` the share of its length. A piece from `a`
//! to `b` is good if `c` differs from the straight line between `c(a)` and `c(b)` by no more than the
//! tolerance; the whole vector is compared, so the bound holds for the way along the path too. It is
//! tested in the middle, and in the quarters too unless the correction changes by less than the
//! tolerance over the whole piece and the middle lies well within it: then no quarter of a correction
//! that only rises or only falls can be off. Arcs are divided first, by their chords.
//!
//! Neighbouring pieces of a straight move are joined again where the tolerance allows it
//! ([`crate::merge`]). All blocks are divided together, in rounds, so that the field is asked in large batches.

use nalgebra::Vector3;

use crate::curve::NO_LENGTH_MM;
use crate::error::WriteError;
use crate::field::{CorrectionField, Monitor, Request};
use crate::merge::{Sample, merge};
use crate::path::{Knowledge, Move, MoveKind, Path};
use crate::turn::{Jump, follow_turns};
use crate::write::WriteOptions;

/// Points asked for in one call of the field.
const BATCH: usize = 8192;

/// A point of a move between two pieces (or at its ends), with the correction that holds before it
/// and the one that holds after it; they differ where the correction jumps inside the move.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub move_index: usize,
    pub share: f64,
    pub before: Vector3<f64>,
    pub after: Vector3<f64>,
    /// Shares between which the correction jumps, where it jumps inside the move.
    pub bracket: [f64; 2],
    /// Index of the jump at this node, see [`Division::jumps`].
    pub jump: Option<usize>,
}

impl Node {
    fn smooth(move_index: usize, share: f64, value: Vector3<f64>) -> Self {
        Self {
            move_index,
            share,
            before: value,
            after: value,
            bracket: [share; 2],
            jump: None,
        }
    }
}

/// All nodes, by move and share.
pub(crate) struct Division {
    pub nodes: Vec<Node>,
    pub jumps: Vec<Jump>,
    pub evaluations: usize,
    /// Largest part of a correction along axes that the program never states, in mm.
    pub left_out_mm: f64,
}

/// A stretch of a move that is not accepted yet.
struct Stretch {
    move_index: usize,
    share: [f64; 2],
    ends: [Vector3<f64>; 2],
    middle: Option<Vector3<f64>>,
    quarters: Option<[Vector3<f64>; 2]>,
}

impl Stretch {
    fn at(&self, part: f64) -> f64 {
        self.share[0] + (self.share[1] - self.share[0]) * part
    }

    /// Remembers what was asked inside, for [`merge`]: a straight move of several pieces may do with
    /// fewer. The chords of an arc are needed for the arc.
    fn keep_samples(&self, path: &Path, samples: &mut Vec<Sample>) {
        let move_index = self.move_index;
        if path.moves[move_index].curve != crate::Curve::Line || self.share == [0.0, 1.0] {
            return;
        }
        let asked = [
            (0.5, self.middle),
            (0.25, self.quarters.map(|pair| pair[0])),
            (0.75, self.quarters.map(|pair| pair[1])),
        ];
        samples.extend(asked.into_iter().filter_map(|(part, value)| {
            Some(Sample {
                move_index,
                share: self.at(part),
                value: value?,
            })
        }));
    }

    fn deviation(&self, part: f64, value: &Vector3<f64>) -> f64 {
        (value - self.ends[0].lerp(&self.ends[1], part)).norm()
    }
}

/// Whether a move is divided at all: feed moves with a length and a known start.
pub(crate) fn is_divided(motion: &Move) -> bool {
    motion.kind == MoveKind::Feed
        && motion.known == Knowledge::Whole
        && motion.length_mm() > NO_LENGTH_MM
}

/// Whether only the end of a move is corrected: rapids, and moves from an unknown place.
pub(crate) fn is_corrected_at_end(motion: &Move) -> bool {
    motion.known == Knowledge::End
        || motion.known == Knowledge::Whole && motion.kind == MoveKind::Rapid
}

pub(crate) fn divide(
    path: &Path,
    field: &dyn CorrectionField,
    options: &WriteOptions,
    monitor: &dyn Monitor,
) -> Result<Division, WriteError> {
    let mut asker = Asker {
        path,
        field,
        monitor,
        answered: 0,
        left_out_mm: 0.0,
    };
    let mut nodes = Vec::new();
    let mut samples = Vec::new();
    let mut open = first_round(&mut asker, options, &mut nodes)?;
    while !open.is_empty() {
        answer(&mut asker, &mut open, options)?;
        open = next_round(path, open, options, &mut nodes, &mut samples);
        if nodes.len() + open.len() > options.max_pieces {
            let line = open
                .first()
                .map_or(0, |stretch| path.moves[stretch.move_index].line);
            return Err(WriteError::TooManyPieces {
                line,
                limit: options.max_pieces,
            });
        }
    }
    nodes.sort_by(|a, b| {
        a.move_index
            .cmp(&b.move_index)
            .then(a.share.total_cmp(&b.share))
    });
    samples.sort_by(|a, b| {
        a.move_index
            .cmp(&b.move_index)
            .then(a.share.total_cmp(&b.share))
    });
    let mut nodes = merge(nodes, &samples, options.tolerance_mm);
    let jumps = follow_turns(&mut asker, &mut nodes, options)?;
    Ok(Division {
        nodes,
        jumps,
        evaluations: asker.answered,
        left_out_mm: asker.left_out_mm,
    })
}

/// Asks for the ends of all pieces that chords make, and the middles between them.
fn first_round(
    asker: &mut Asker<'_>,
    options: &WriteOptions,
    nodes: &mut Vec<Node>,
) -> Result<Vec<Stretch>, WriteError> {
    let path = asker.path;
    let mut requests = Vec::new();
    let mut chords = Vec::with_capacity(path.moves.len());
    for (move_index, motion) in path.moves.iter().enumerate() {
        let count = if is_divided(motion) {
            match &motion.curve {
                crate::Curve::Line => 1,
                crate::Curve::Arc(arc) => arc.chords_within(options.chord_tolerance_mm),
            }
        } else {
            0
        };
        if requests.len() / 2 + count > options.max_pieces {
            return Err(WriteError::TooManyPieces {
                line: motion.line,
                limit: options.max_pieces,
            });
        }
        chords.push(count);
        if count > 0 {
            for half in 0..=2 * count {
                requests.push(asker.request(move_index, half as f64 / (2 * count) as f64));
            }
        } else if is_corrected_at_end(motion) {
            requests.push(asker.request(move_index, 1.0));
        }
    }
    let answers = asker.ask(&requests)?;
    let mut at = 0;
    let mut open = Vec::new();
    for (move_index, motion) in path.moves.iter().enumerate() {
        let count = chords[move_index];
        if count > 0 {
            let shares = &requests[at..=at + 2 * count];
            let values = &answers[at..=at + 2 * count];
            at += 2 * count + 1;
            for chord in 0..=count {
                let (share, value) = (shares[2 * chord].share, values[2 * chord]);
                nodes.push(Node::smooth(move_index, share, value));
            }
            for chord in 0..count {
                open.push(Stretch {
                    move_index,
                    share: [shares[2 * chord].share, shares[2 * chord + 2].share],
                    ends: [values[2 * chord], values[2 * chord + 2]],
                    middle: Some(values[2 * chord + 1]),
                    quarters: None,
                });
            }
        } else if is_corrected_at_end(motion) {
            let value = answers[at];
            at += 1;
            nodes.push(Node::smooth(move_index, 1.0, value));
        }
    }
    Ok(open)
}

/// Gets the values that the open stretches need next.
fn answer(
    asker: &mut Asker<'_>,
    open: &mut [Stretch],
    options: &WriteOptions,
) -> Result<(), WriteError> {
    let requests: Vec<Request> = open
        .iter()
        .filter(|stretch| stretch.middle.is_none())
        .map(|stretch| asker.request(stretch.move_index, stretch.at(0.5)))
        .collect();
    let mut answers = asker.ask(&requests)?.into_iter();
    for stretch in open.iter_mut().filter(|stretch| stretch.middle.is_none()) {
        stretch.middle = answers.next();
    }

    let wants_quarters = |stretch: &Stretch| {
        stretch.middle.is_some_and(|middle| {
            let deviation = stretch.deviation(0.5, &middle);
            let change = (stretch.ends[1] - stretch.ends[0]).norm();
            deviation > 0.25 * options.tolerance_mm || change > options.tolerance_mm
        })
    };
    let requests: Vec<Request> = open
        .iter()
        .filter(|stretch| wants_quarters(stretch))
        .flat_map(|stretch| {
            [0.25, 0.75].map(|part| asker.request(stretch.move_index, stretch.at(part)))
        })
        .collect();
    let answers = asker.ask(&requests)?;
    let mut pairs = answers.chunks_exact(2);
    for stretch in open.iter_mut().filter(|stretch| wants_quarters(stretch)) {
        stretch.quarters = pairs.next().map(|pair| [pair[0], pair[1]]);
    }
    Ok(())
}

/// Accepts the good stretches and bisects the others.
fn next_round(
    path: &Path,
    open: Vec<Stretch>,
    options: &WriteOptions,
    nodes: &mut Vec<Node>,
    samples: &mut Vec<Sample>,
) -> Vec<Stretch> {
    let mut next = Vec::new();
    for stretch in open {
        let Some(middle) = stretch.middle else {
            continue;
        };
        let [low, high] = stretch.quarters.unwrap_or([
            stretch.ends[0].lerp(&middle, 0.5),
            middle.lerp(&stretch.ends[1], 0.5),
        ]);
        let worst = stretch
            .deviation(0.5, &middle)
            .max(stretch.deviation(0.25, &low))
            .max(stretch.deviation(0.75, &high));
        if worst <= options.tolerance_mm {
            stretch.keep_samples(path, samples);
            continue;
        }
        let [from, to] = stretch.share;
        let [first, last] = stretch.ends;
        let share = stretch.at(0.5);
        let move_index = stretch.move_index;
        let length = path.moves[move_index].length_between_mm(from, to);
        if length <= options.smallest_piece_mm || share <= from || share >= to {
            // No piece is short enough: the correction jumps here. The tool steps at one place.
            nodes.push(Node {
                move_index,
                share,
                before: first,
                after: last,
                bracket: stretch.share,
                jump: None,
            });
            continue;
        }
        nodes.push(Node::smooth(move_index, share, middle));
        let [low, high] = match stretch.quarters {
            Some([low, high]) => [Some(low), Some(high)],
            None => [None, None],
        };
        next.push(Stretch {
            move_index,
            share: [from, share],
            ends: [first, middle],
            middle: low,
            quarters: None,
        });
        next.push(Stretch {
            move_index,
            share: [share, to],
            ends: [middle, last],
            middle: high,
            quarters: None,
        });
    }
    next
}

/// Asks the field and checks its answers.
pub(crate) struct Asker<'a> {
    pub path: &'a Path,
    pub field: &'a dyn CorrectionField,
    monitor: &'a dyn Monitor,
    answered: usize,
    left_out_mm: f64,
}

impl Asker<'_> {
    pub fn request(&self, move_index: usize, share: f64) -> Request {
        let motion = &self.path.moves[move_index];
        let tangent = if motion.known == Knowledge::Whole {
            motion.tangent(share)
        } else {
            None
        };
        Request {
            move_index,
            share,
            position_mm: motion.point(share),
            tangent,
            turning: None,
        }
    }

    pub fn ask(&mut self, requests: &[Request]) -> Result<Vec<Vector3<f64>>, WriteError> {
        let mut values = Vec::with_capacity(requests.len());
        let total = self.answered + requests.len();
        for batch in requests.chunks(BATCH) {
            if self.monitor.cancelled() {
                return Err(WriteError::Cancelled);
            }
            let mut answers = self.field.corrections(batch).into_iter();
            if self.monitor.cancelled() {
                return Err(WriteError::Cancelled);
            }
            for request in batch {
                let failure = |message: String| WriteError::Field {
                    line: self.path.moves[request.move_index].line,
                    share: request.share,
                    position_mm: request.position_mm,
                    message,
                };
                let mut value = match answers.next() {
                    Some(Ok(value)) if value.iter().all(|number| number.is_finite()) => value,
                    Some(Ok(_)) => {
                        return Err(failure(
                            "the field answered with no finite number".to_owned(),
                        ));
                    }
                    Some(Err(reason)) => return Err(failure(reason.message)),
                    None => return Err(failure("the field gave too few answers".to_owned())),
                };
                for axis in 0..3 {
                    if !self.path.stated[axis] {
                        self.left_out_mm = self.left_out_mm.max(value[axis].abs());
                        value[axis] = 0.0;
                    }
                }
                values.push(value);
            }
            self.answered += batch.len();
            self.monitor
                .progress(self.answered, total.max(self.answered));
        }
        Ok(values)
    }
}
