//! Corrections of two legs that meet at a corner, joined.
//!
//! Each leg has a correction across itself, `P1 c1` and `P2 c2` with `P = I - t t'`. The tool passes the corner once, with one
//! correction: the `c` that meets both best, `(P1 + P2) c = P1 c1 + P2 c2`. Across the plane of the legs that is the mean of both; in it,
//! both are met exactly: lines that are moved aside meet where they cross. From the corner on the difference fades
//! along the leg, over three smoothing lengths or the whole leg. In the plane it goes along the leg, where it
//! changes nothing that is measured; so the iteration of the trials knows nothing of it.
//!
//! A leg that nothing was measured of takes the correction of the other. Legs that turn back are in one line: they take the mean.

use kinetostat_program::NominalPath;
use nalgebra::{Matrix3, Vector3};

use crate::deviation::{Stations, Stretch};

/// Legs that turn back by less than this (sine of 20 degrees) from a whole half turn are in one line, those of a seam as well.
const IN_LINE: f64 = 0.342_020_143_325_668_7;

/// Distance from a corner, in smoothing lengths, at which the joint has faded.
const FADED: f64 = 3.0;

/// Largest distance of two places that are one, mm.
const SAME_MM: f64 = 1e-6;

/// An end of a stretch at a corner: its station, and the direction of the path there.
#[derive(Clone, Copy)]
struct End {
    stretch: usize,
    station: usize,
    tangent: Vector3<f64>,
}

/// Corrections at the stations, joined at corners and at the seams of closed passes; what legs disagree by beyond a scatter (mm) is
/// left to them.
pub(crate) fn joined(
    nominal: &NominalPath<'_>,
    stations: &Stations,
    correction_mm: &[Vector3<f64>],
    smoothing_mm: f64,
    scatter_mm: f64,
) -> Vec<Vector3<f64>> {
    let mut joined = correction_mm.to_vec();
    for [end, start] in corners(nominal, stations) {
        let both = [end, start].map(|at| correction_mm[at.station]);
        let Some(common) = common(both, [end.tangent, start.tangent]) else {
            continue;
        };
        let along = |at: &End, own: &Vector3<f64>| at.tangent * at.tangent.dot(&(common - own));
        let [one, other] =
            [(end, both[0]), (start, both[1])].map(|(at, own)| common - own - along(&at, &own));
        let measured = both.iter().all(|own| *own != Vector3::zeros());
        let steps = measured && (one - other).norm() > scatter_mm;
        for (at, own) in [end, start].into_iter().zip(both) {
            let difference = match steps {
                true => along(&at, &own),
                false => common - own,
            };
            fade(&mut joined, stations, at, difference, smoothing_mm);
        }
    }
    joined
}

/// Ends of stretches at the beginning of another of the same pass: at corners, and at seams of closed passes.
fn corners(nominal: &NominalPath<'_>, stations: &Stations) -> Vec<[End; 2]> {
    let all = stations.stretches();
    let mut found = Vec::new();
    let mut first = 0;
    for index in 0..all.len() {
        let own = &all[index];
        let follows = all.get(index + 1).is_some_and(|next| next.pass == own.pass);
        let next = match follows {
            true => index + 1,
            false => first,
        };
        let meets = (end_of(nominal, own) - start_of(nominal, &all[next])).norm() <= SAME_MM;
        if meets && !own.closed {
            found.extend(ends(nominal, stations, [index, next]));
        }
        if !follows {
            first = index + 1;
        }
    }
    found
}

fn start_of(nominal: &NominalPath<'_>, stretch: &Stretch) -> Vector3<f64> {
    nominal
        .motion(&nominal.pieces()[stretch.pieces.start])
        .point(0.0)
}

fn end_of(nominal: &NominalPath<'_>, stretch: &Stretch) -> Vector3<f64> {
    nominal
        .motion(&nominal.pieces()[stretch.pieces.end - 1])
        .point(1.0)
}

fn ends(
    nominal: &NominalPath<'_>,
    stations: &Stations,
    [before, after]: [usize; 2],
) -> Option<[End; 2]> {
    let all = stations.stretches();
    let tangent = |piece: usize, share: f64| {
        let motion = nominal.motion(&nominal.pieces()[piece]);
        motion.tangent(share)
    };
    let end = End {
        stretch: before,
        station: all[before].stations.end - 1,
        tangent: tangent(all[before].pieces.end - 1, 1.0)?,
    };
    let start = End {
        stretch: after,
        station: all[after].stations.start,
        tangent: tangent(all[after].pieces.start, 0.0)?,
    };
    Some([end, start])
}

/// The correction that both legs have in common; nothing where neither has one. A value that is zero to the last digit was not
/// measured.
fn common(
    [first, second]: [Vector3<f64>; 2],
    [before, after]: [Vector3<f64>; 2],
) -> Option<Vector3<f64>> {
    match [first, second].map(|own| own != Vector3::zeros()) {
        [false, false] => return None,
        [true, false] => return Some(first),
        [false, true] => return Some(second),
        [true, true] => {}
    }
    if before.cross(&after).norm() < IN_LINE {
        return Some(0.5 * (first + second));
    }
    let across = |tangent: Vector3<f64>| Matrix3::identity() - tangent * tangent.transpose();
    let [one, other] = [across(before), across(after)];
    let met = (one + other).cholesky()?;
    Some(met.solve(&(one * first + other * second)))
}

/// Adds a difference at an end of a stretch, and less and less of it along the stretch.
fn fade(
    joined: &mut [Vector3<f64>],
    stations: &Stations,
    at: End,
    difference: Vector3<f64>,
    smoothing_mm: f64,
) {
    let own = stations.stretches()[at.stretch].stations.clone();
    let along = &stations.along_mm()[own.clone()];
    let length = along[along.len() - 1] - along[0];
    let over = match FADED * smoothing_mm < length {
        true => FADED * smoothing_mm,
        false => length,
    };
    let from = stations.along_mm()[at.station];
    for (station, place) in own.zip(along) {
        let u = ((place - from).abs() / over).min(1.0);
        joined[station] += difference * (1.0 - u * u * (3.0 - 2.0 * u));
    }
}
