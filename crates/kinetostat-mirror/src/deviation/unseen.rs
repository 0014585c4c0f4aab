//! Parts of the path that measured points do not determine.

use schemars::JsonSchema;
use serde::Serialize;

use crate::alignment::AlignedPoint;
use crate::number::larger;
use kinetostat_program::NominalPath;

/// Distance from every point, in smoothing lengths, beyond which nothing is known.
const KNOWN: f64 = 3.0;

/// Places along a gap at which its path is compared with a straight line.
const PLACES: usize = 32;

/// A part of the path of which the points say nothing, or not enough.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Unseen {
    /// A whole pass without a point: it is written as it was.
    Pass {
        /// Lines of its first and last move.
        lines: [usize; 2],
        /// Length, mm.
        length_mm: f64,
    },
    /// A stretch farther than three smoothing lengths from every point: the correction fades to nothing there.
    Stretch {
        /// Lines at its ends.
        lines: [usize; 2],
        /// Length, mm.
        length_mm: f64,
    },
    /// Points of a pass farther apart than the smoothing length: deviations that bend between them are not seen.
    Gap {
        /// Lines at its ends.
        lines: [usize; 2],
        /// The largest way between two points, mm.
        gap_mm: f64,
        /// Sagitta of the path there, mm.
        sagitta_mm: f64,
    },
    /// Moves longer than the smoothing length without a point of their own, between points of the same pass: their
    /// correction is interpolated from the moves beside them.
    Moves {
        /// Number of moves.
        count: usize,
        /// Lines of the first ten.
        lines: Vec<usize>,
    },
}

/// Parts of the path that points, in the order along it, do not determine.
pub(crate) fn unseen(
    nominal: &NominalPath<'_>,
    points: &[AlignedPoint],
    smoothing_mm: f64,
) -> Vec<Unseen> {
    let mut found = Vec::new();
    let line_at = |along_mm: f64| {
        let (piece, _) = nominal.at_length(along_mm);
        nominal.motion(&nominal.pieces()[piece]).line
    };
    for (index, pass) in nominal.passes().iter().enumerate() {
        let first = points.partition_point(|point| point.pass < index);
        let end = points.partition_point(|point| point.pass <= index);
        let own = &points[first..end];
        let [from, to] = pass.along_mm;
        let ends = [pass.pieces.start, pass.pieces.end - 1];
        let lines = ends.map(|piece| nominal.motion(&nominal.pieces()[piece]).line);
        if own.is_empty() {
            found.push(Unseen::Pass {
                lines,
                length_mm: to - from,
            });
            continue;
        }
        let reach = KNOWN * smoothing_mm;
        let places = own.iter().map(|point| point.along_mm);
        let before = std::iter::once(from - reach).chain(places.clone());
        let mut widest = [0.0; 2];
        for (a, b) in before.zip(places.chain([to + reach])) {
            if b - a > 2.0 * reach {
                let stretch = [
                    larger(a + reach, from),
                    if b - reach < to { b - reach } else { to },
                ];
                found.push(Unseen::Stretch {
                    lines: stretch.map(line_at),
                    length_mm: stretch[1] - stretch[0],
                });
            } else if a >= from && b <= to && b - a > widest[1] - widest[0] {
                widest = [a, b];
            }
        }
        if widest[1] - widest[0] > smoothing_mm {
            found.push(Unseen::Gap {
                lines: widest.map(line_at),
                gap_mm: widest[1] - widest[0],
                sagitta_mm: sagitta(nominal, widest),
            });
        }
    }
    found.extend(moves_without(nominal, points, smoothing_mm));
    found
}

/// Distance of the path from the straight line between two of its places, mm.
fn sagitta(nominal: &NominalPath<'_>, [from, to]: [f64; 2]) -> f64 {
    let (start, end) = (nominal.point_at(from), nominal.point_at(to));
    let along = (end - start).try_normalize(f64::MIN_POSITIVE);
    let places = (1..PLACES).map(|k| from + (to - from) * (k as f64 / PLACES as f64));
    let off = places.map(|at| {
        let away = nominal.point_at(at) - start;
        along.map_or(away.norm(), |along| {
            (away - along * along.dot(&away)).norm()
        })
    });
    off.fold(0.0, larger)
}

/// Long moves of passes with points that have none themselves.
fn moves_without(
    nominal: &NominalPath<'_>,
    points: &[AlignedPoint],
    smoothing_mm: f64,
) -> Option<Unseen> {
    let mut has = vec![false; nominal.pieces().len()];
    let mut measured = vec![false; nominal.passes().len()];
    for point in points {
        has[point.piece] = true;
        measured[point.pass] = true;
    }
    let pieces = nominal.pieces().iter().zip(&has);
    let without = pieces
        .filter(|(piece, has)| !**has && measured[piece.pass] && piece.length_mm > smoothing_mm);
    let lines: Vec<usize> = without
        .map(|(piece, _)| nominal.motion(piece).line)
        .collect();
    (!lines.is_empty()).then(|| Unseen::Moves {
        count: lines.len(),
        lines: lines.into_iter().take(10).collect(),
    })
}
