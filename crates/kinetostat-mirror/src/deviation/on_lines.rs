//! Deviations on a feature of the part: on the feed moves of some lines of the program.

use schemars::JsonSchema;
use serde::Serialize;

use crate::deviation::measure::Measurement;
use crate::number::larger;
use kinetostat_program::NominalPath;

/// Deviations on lines of the program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct OnLines {
    /// Points that count there.
    pub points: usize,
    /// Length of the feed moves on these lines, mm; 0 where none of them cuts.
    pub length_mm: f64,
    /// Length of them that is farther than the smoothing length from every point of the same pass, mm.
    pub unseen_mm: f64,
    /// The largest deviation of a point there, mm; `None` without points.
    pub largest_mm: Option<f64>,
    /// The largest deviation after smoothing, mm.
    pub smoothed_largest_mm: Option<f64>,
}

/// Deviations on the feed moves from the first line to the last.
///
/// ```
/// use kinetostat_mirror::{MeasureSettings, MeasuredPoints, NominalPath, Register, measure, on_lines};
/// use kinetostat_program::{Program, ReadOptions, interpret};
/// use nalgebra::Vector3;
///
/// let program = Program::read("G21 G90\nG0 X0 Y0 Z0\nG1 X60 F300\nG1 X100\n")?;
/// let path = interpret(&program, &ReadOptions::default())?;
/// let nominal = NominalPath::new(&path)?;
/// let points: Vec<_> = (0..=50).map(|x| Vector3::new(f64::from(x), 0.05, 0.0)).collect();
/// let settings = MeasureSettings { register: Register::None, ..MeasureSettings::default() };
/// let measured = measure(&nominal, &MeasuredPoints::at(&points)?, &settings)?;
/// let first = on_lines(&nominal, &measured, [3, 3], settings.smoothing_mm);
/// assert_eq!((first.points, first.length_mm), (51, 60.0));
/// // A smoothing length of 5 mm behind the last point is seen, 5 more are not.
/// assert!((first.unseen_mm - 5.0).abs() < 1e-9);
/// let second = on_lines(&nominal, &measured, [4, 4], settings.smoothing_mm);
/// assert_eq!((second.points, second.largest_mm), (0, None));
/// assert!((second.unseen_mm - 40.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn on_lines(
    nominal: &NominalPath<'_>,
    measured: &Measurement,
    [first, last]: [usize; 2],
    smoothing_mm: f64,
) -> OnLines {
    let own = |piece: usize| {
        let line = nominal.motion(&nominal.pieces()[piece]).line;
        (first..=last).contains(&line)
    };
    let mut found = OnLines::default();
    for (index, piece) in nominal.pieces().iter().enumerate() {
        if !own(index) {
            continue;
        }
        let [from, to] = [piece.from_mm, piece.from_mm + piece.length_mm];
        let all = &measured.points;
        let near = all.partition_point(|p| p.pass < piece.pass || p.along_mm < from - smoothing_mm);
        let of_pass = all[near..].iter().take_while(|p| p.pass == piece.pass);
        let of_pass = of_pass.map(|p| p.along_mm);
        let seen = covered_mm(
            [from, to],
            of_pass.take_while(|at| *at < to + smoothing_mm),
            smoothing_mm,
        );
        found.length_mm += piece.length_mm;
        found.unseen_mm += piece.length_mm - seen;
    }
    let larger_of = |most: Option<f64>, own: f64| Some(most.map_or(own, |most| larger(most, own)));
    for (point, smoothed) in measured.points.iter().zip(&measured.at_points) {
        if own(point.piece) {
            found.points += 1;
            found.largest_mm = larger_of(found.largest_mm, point.deviation_mm.norm());
            found.smoothed_largest_mm =
                larger_of(found.smoothed_largest_mm, smoothed.deviation_mm.norm());
        }
    }
    found
}

/// The length of a stretch that is no farther than `reach_mm` from a point; points in their order along the path.
fn covered_mm([from, to]: [f64; 2], points: impl Iterator<Item = f64>, reach_mm: f64) -> f64 {
    let (mut covered, mut done) = (0.0, from);
    for at in points {
        let begins = larger(at - reach_mm, done);
        let ends = if at + reach_mm < to {
            at + reach_mm
        } else {
            to
        };
        if ends > begins {
            covered += ends - begins;
            done = ends;
        }
    }
    covered
}
