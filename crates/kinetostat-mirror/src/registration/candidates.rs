//! Choice among several motions, or the finding that the points do not determine it.
//!
//! Points that lie about where the path is are in the frame of the program: the motion found from there is the one, unless another
//! leaves less than a tenth. Points of another frame may fit several places: a part that lies on itself when it is turned, or
//! a side of which there are two. Then their order tells, where they were measured along the whole path from its beginning;
//! and where it does not, no motion is taken.

use crate::error::MirrorError;
use crate::number::{larger, median};
use crate::points::MeasuredPoint;
use crate::registration::closest::{Closest, FARTHEST_DEVIATIONS};
use crate::registration::motion::{FreeMotion, Motion};
use crate::registration::starts::places_in_order;
use kinetostat_program::NominalPath;
use nalgebra::Vector3;

/// A motion of points in the frame of the program is only given up for one that leaves less than this share.
const CLEARLY: f64 = 0.1;

/// Difference of distances, as a share of the size of the points, that is rounding.
const SAME: f64 = 1e-9;

/// Largest residual, as a share of the size, of a motion that fits all points exactly.
const EXACT: f64 = 1e-6;

/// Residual, as a share of the size, of motions that are no fit at all. The window refuses these.
const NO_FIT: f64 = 0.1;

/// A motion fits as well as another if no more than this share of the points leave the path with it.
const AS_WELL: f64 = 0.02;

/// Largest distance, as a share of the size, of the places of points under two motions that are one.
const APART: f64 = 0.01;

/// Points are in the order of the path if half of them are no farther than this share of their size from their share of it.
const IN_ORDER: f64 = 0.05;

/// Criterion by which the motion was chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ToldBy {
    /// The points lay about where the path is.
    Frame,
    /// The points lay elsewhere, and fit the path in one place only.
    Shape,
    /// The points lay elsewhere and fit in several places: in one of them they run along the path as it does.
    Order,
}

/// A motion that was followed onto the path.
pub(crate) struct Candidate {
    pub motion: Motion,
    pub closest: Closest,
    /// True if it was found from where the points are, which is about where the path is.
    pub near: bool,
}

/// The motion to take of those that were followed.
pub(crate) fn chosen(
    nominal: &NominalPath<'_>,
    points: &[MeasuredPoint],
    candidates: &[Candidate],
    free: &dyn Fn(&Motion) -> Vec<FreeMotion>,
) -> Result<Option<(Motion, ToldBy)>, MirrorError> {
    let left = |c: &&Candidate| c.closest.left_mm;
    let Some(best) = candidates.iter().min_by(|a, b| left(a).total_cmp(&left(b))) else {
        return Ok(None);
    };
    let size = best.closest.size_mm;
    let enough = larger(best.closest.left_mm / CLEARLY, SAME * size);
    let near = candidates
        .iter()
        .find(|c| c.near && c.closest.left_mm <= enough);
    if let Some(near) = near {
        return Ok(Some((near.motion, ToldBy::Frame)));
    }
    if best.closest.left_mm > NO_FIT * size {
        return Ok(Some((best.motion, ToldBy::Shape)));
    }
    let within = larger(
        FARTHEST_DEVIATIONS * best.closest.deviation_mm,
        EXACT * size,
    );
    let inliers = |c: &Candidate| {
        let near = c
            .closest
            .all
            .iter()
            .filter(|p| p.foot.distance_mm <= within);
        near.count() as f64
    };
    let fewest = inliers(best) - AS_WELL * points.len() as f64;
    let as_well: Vec<&Candidate> = candidates.iter().filter(|c| inliers(c) >= fewest).collect();
    let apart_mm = larger(APART * size, 3.0 * within);
    let other = as_well.iter().find(|c| apart(best, c) > apart_mm);
    let open = free(&best.motion);
    if other.is_none() && open.is_empty() {
        return Ok(Some((best.motion, ToldBy::Shape)));
    }
    let off = |c: &Candidate| off_order(nominal, points, &c.motion);
    let in_order = as_well.iter().map(|c| (off(c), c.motion));
    let in_order = in_order.min_by(|a, b| a.0.total_cmp(&b.0));
    match in_order {
        Some((off, motion)) if off <= IN_ORDER * size => Ok(Some((motion, ToldBy::Order))),
        _ => Err(MirrorError::new(not_told(
            best,
            other.copied(),
            &open,
            within,
        ))),
    }
}

/// Distance between the places to which two motions bring the points: the median, mm.
fn apart(one: &Candidate, other: &Candidate) -> f64 {
    let both = one.closest.all.iter().zip(&other.closest.all);
    median(both.map(|(a, b)| (a.moved - b.moved).norm()).collect())
}

/// Median distance of the moved points from the same share of the path as of the way through them, mm.
fn off_order(nominal: &NominalPath<'_>, points: &[MeasuredPoint], motion: &Motion) -> f64 {
    let places = places_in_order(nominal, points);
    let both = points.iter().zip(places);
    let off = both.map(|(point, place)| (motion.of(&point.position_mm) - place).norm());
    median(off.collect())
}

fn not_told(
    best: &Candidate,
    other: Option<&Candidate>,
    open: &[FreeMotion],
    within_mm: f64,
) -> String {
    let fits = match (other, open) {
        (Some(other), _) => format!(
            "{}, and {}, and leave the path by no more than {} mm in both",
            in_words(&best.motion),
            in_words(&other.motion),
            digits(within_mm)
        ),
        (None, open) => {
            let open: Vec<String> = open.iter().map(ToString::to_string).collect();
            format!(
                "{}, and as well after {}",
                in_words(&best.motion),
                open.join(" or ")
            )
        }
    };
    format!(
        "the measured points fit the path in several places ({fits}), and neither their frame nor their order tells which: measure more of the path, or all of it in the order of the program, or give the points in the frame of the program and do not register them"
    )
}

fn in_words(motion: &Motion) -> String {
    let numbers = |v: Vector3<f64>| {
        let [x, y, z] = [v.x, v.y, v.z].map(digits);
        format!("({x}, {y}, {z})")
    };
    format!(
        "moved by {} mm and turned by {} deg",
        numbers(motion.shift_mm),
        numbers(motion.rotation.scaled_axis().map(f64::to_degrees))
    )
}

/// A number with so many digits as one reads.
fn digits(number: f64) -> String {
    match number.abs() {
        size if size < 1e-9 => "0".to_owned(),
        size if size < 5e-3 => format!("{number:.1e}"),
        _ => format!("{number:.3}"),
    }
}
