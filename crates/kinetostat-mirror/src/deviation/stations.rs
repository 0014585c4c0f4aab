//! Places along the path at which deviations and corrections are kept, stretch by stretch.
//!
//! A pass is divided at its corners. Each leg is measured across itself: what one leg sees of a deviation is not what the next
//! one sees, so that a mean over both is neither. A pass that comes back to its beginning without a corner has no end.

use std::ops::Range;

use crate::error::MirrorError;
use kinetostat_program::NominalPath;

/// Stations in a smoothing length: on cubic curves between them nothing is lost of what the kernel lets through.
const IN_SMOOTHING_LENGTH: f64 = 4.0;

/// Maximum number of stations: more fill memory and state without telling more, since a measurement has fewer points.
const MOST: f64 = 1e6;

/// Cosine of the turn (20 degrees) from which on a path has a corner; what is less is a curve in short lines.
const CORNER: f64 = 0.939_692_620_785_908_4;

/// A pass comes back to where it began if its ends are no farther apart, mm.
const SAME_MM: f64 = 1e-6;

/// A part of a pass without a corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// Index of its pass.
    pub pass: usize,
    /// Pieces of the path.
    pub pieces: Range<usize>,
    /// Stations of the stretch.
    pub stations: Range<usize>,
    /// True if it ends where it begins, without a corner between them.
    pub closed: bool,
}

/// Places along each stretch, evenly from its beginning to its end.
///
/// ```
/// use kinetostat_mirror::{NominalPath, Stations};
/// use kinetostat_program::{Program, ReadOptions, interpret};
///
/// let program = Program::read("G21 G90\nG0 X0 Y0 Z0\nG1 X10 F300\nG1 Y5\n")?;
/// let path = interpret(&program, &ReadOptions::default())?;
/// let nominal = NominalPath::new(&path)?;
/// let stations = Stations::of(&nominal, 10.0)?;
/// assert_eq!(stations.along_mm(), [0.0, 2.5, 5.0, 7.5, 10.0, 10.0, 12.5, 15.0]);
/// assert_eq!(stations.stretches()[1].stations, 5..8);
/// let why = Stations::of(&nominal, 1e-9).unwrap_err().to_string();
/// assert!(why.ends_with("path of 15 mm allows lengths from 0.00006 mm to 10 times its own"), "{why}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Stations {
    along_mm: Vec<f64>,
    stretches: Vec<Stretch>,
}

impl Stations {
    /// Four stations on a smoothing length, two at least on each stretch.
    ///
    /// # Errors
    /// A smoothing length that is not above 0, that is more than ten times the path, or so small that the path has more
    /// than a million stations.
    pub fn of(nominal: &NominalPath<'_>, smoothing_mm: f64) -> Result<Self, MirrorError> {
        possible(nominal, smoothing_mm)?;
        let mut along_mm = Vec::new();
        let mut stretches = Vec::new();
        for (pass, own) in nominal.passes().iter().enumerate() {
            for pieces in without_corners(nominal, &own.pieces) {
                let last = &nominal.pieces()[pieces.end - 1];
                let from = nominal.pieces()[pieces.start].from_mm;
                let to = last.from_mm + last.length_mm;
                let parts = ((to - from) * IN_SMOOTHING_LENGTH / smoothing_mm).ceil();
                let parts = parts.max(1.0) as usize;
                let first = along_mm.len();
                along_mm
                    .extend((0..=parts).map(|k| from + (to - from) * (k as f64 / parts as f64)));
                stretches.push(Stretch {
                    pass,
                    closed: pieces == own.pieces && is_closed(nominal, &pieces),
                    pieces,
                    stations: first..along_mm.len(),
                });
            }
        }
        Ok(Self {
            along_mm,
            stretches,
        })
    }

    /// Their lengths along the path, mm; the end of a stretch and the beginning of the next have the same.
    #[must_use]
    pub fn along_mm(&self) -> &[f64] {
        &self.along_mm
    }

    /// The stretches in their order.
    #[must_use]
    pub fn stretches(&self) -> &[Stretch] {
        &self.stretches
    }

    /// The stretch of a piece of the path.
    #[must_use]
    pub fn stretch_of(&self, piece: usize) -> usize {
        let after = self.stretches.partition_point(|s| s.pieces.start <= piece);
        after.saturating_sub(1)
    }

    /// The length of path that each of them stands for, mm.
    pub(crate) fn lengths_mm(&self) -> Vec<f64> {
        let mut lengths = vec![0.0; self.along_mm.len()];
        for stretch in &self.stretches {
            for k in stretch.stations.start..stretch.stations.end - 1 {
                let half = 0.5 * (self.along_mm[k + 1] - self.along_mm[k]);
                lengths[k] += half;
                lengths[k + 1] += half;
            }
        }
        lengths
    }
}

/// Maximum smoothing length over that of the path: beyond it only the mean of its deviations is left, a slip, or
/// another unit.
const LONGEST: f64 = 10.0;

/// A smoothing length that says something of this path, and with which its stations can be counted.
fn possible(nominal: &NominalPath<'_>, smoothing_mm: f64) -> Result<(), MirrorError> {
    let length_mm = nominal.length_mm();
    if smoothing_mm > 0.0
        && smoothing_mm <= LONGEST * length_mm
        && length_mm * IN_SMOOTHING_LENGTH / smoothing_mm <= MOST
    {
        return Ok(());
    }
    // Rounded up to two digits, so that what is named is allowed.
    let least = length_mm * IN_SMOOTHING_LENGTH / MOST;
    let digit = 10.0_f64.powf(least.log10().floor() - 1.0);
    let least = (least / digit - 1e-6).ceil() * digit * (1.0 + 1e-6);
    Err(MirrorError::new(format!(
        "the smoothing length is {smoothing_mm} mm; this path of {} mm allows lengths from {} mm to {LONGEST} times its own",
        in_short(length_mm),
        in_short(least)
    )))
}

/// A length with so many digits as one reads.
fn in_short(mm: f64) -> f64 {
    format!("{mm:.3e}").parse().unwrap_or(mm)
}

/// Pieces of a pass, divided at its corners.
fn without_corners(nominal: &NominalPath<'_>, pass: &Range<usize>) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut first = pass.start;
    for piece in pass.clone() {
        if piece + 1 == pass.end || !goes_on(nominal, piece, piece + 1) {
            found.push(first..piece + 1);
            first = piece + 1;
        }
    }
    found
}

/// The path goes on from one piece to another without a corner. A move that has no direction at its end has none.
fn goes_on(nominal: &NominalPath<'_>, before: usize, after: usize) -> bool {
    let motion = |piece: usize| nominal.motion(&nominal.pieces()[piece]);
    let directions = motion(before).tangent(1.0).zip(motion(after).tangent(0.0));
    directions.is_none_or(|(before, after)| before.dot(&after) >= CORNER)
}

fn is_closed(nominal: &NominalPath<'_>, pieces: &Range<usize>) -> bool {
    let motion = |piece: usize| nominal.motion(&nominal.pieces()[piece]);
    let [start, end] = [
        motion(pieces.start).point(0.0),
        motion(pieces.end - 1).point(1.0),
    ];
    (end - start).norm() <= SAME_MM && goes_on(nominal, pieces.end - 1, pieces.start)
}
