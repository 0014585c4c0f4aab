//! How many arcs a corrected arc needs, against the fewest that there can be.
//!
//! The corrections are those of the demonstration's groove (a circle of 25 mm milled on an Orthoglide), as a sum of waves along the
//! circle. Its height is a wave of 0.16 mm: whatever its plane has, the height of a helical arc grows evenly with its length, so the
//! height of a program of arcs in the plane is a broken line, and no program within a distance has fewer arcs than a broken line
//! within that distance of the wave has parts.

use crate::writing::{at_origin, bare, written_with};
use kinetostat_program::*;
use kinetostat_testing::{Worst, largest, least};
use nalgebra::Vector3;

/// Mean, cosine and sine of one to six waves around the circle, mm: x, y and z.
const WAVES: [[f64; 13]; 3] = [
    [
        -0.009526, -0.521353, 0.167290, -0.021622, 0.012325, 0.000757, -0.000243, -0.000075,
        -0.000038, 0.000001, 0.0, -0.000004, -0.000003,
    ],
    [
        -0.147025, -0.203836, -0.551479, 0.001567, 0.008906, 0.000802, -0.002979, 0.000027,
        0.000123, 0.000005, -0.000002, 0.0, 0.0,
    ],
    [
        -0.114127, 0.009938, -0.158976, 0.009394, 0.005506, -0.000417, -0.000474, -0.000034,
        -0.000013, 0.000004, -0.000001, 0.000001, -0.000001,
    ],
];

const GROOVE: &str =
    "G21 G90 G17 G94\nG0 X25 Y0 Z-2\nG3 X-25 Y0 I-25 J0 F600\nG3 X25 Y0 I25 J0\nM2\n";

fn correction(angle: f64) -> Vector3<f64> {
    let sum = |waves: &[f64; 13]| {
        let pairs = waves[1..].chunks(2).zip(1..);
        let pairs = pairs.map(|(pair, k)| {
            let (sine, cosine) = (f64::from(k) * angle).sin_cos();
            pair[0] * cosine + pair[1] * sine
        });
        waves[0] + pairs.sum::<f64>()
    };
    Vector3::new(sum(&WAVES[0]), sum(&WAVES[1]), sum(&WAVES[2]))
}

fn corrected(angle: f64) -> Vector3<f64> {
    Vector3::new(25.0 * angle.cos(), 25.0 * angle.sin(), -2.0) + correction(angle)
}

fn field(request: &Request) -> Result<Vector3<f64>, FieldFailure> {
    let at = request.position_mm;
    Ok(correction(at.y.atan2(at.x)))
}

/// The fewest parts of a broken line within a distance of the height over the way in the plane, even if its parts did not join;
/// over half a circle from an angle.
fn fewest(from: f64, within_mm: f64) -> usize {
    let count = 10_000;
    let mut way = 0.0;
    let mut places = Vec::new();
    let mut last = corrected(from);
    for k in 0..=count {
        let at = corrected(from + std::f64::consts::PI * f64::from(k) / f64::from(count));
        way += (at - last).xy().norm();
        places.push((way, at.z));
        last = at;
    }
    let (mut parts, mut first) = (0, 0);
    while first < places.len() {
        parts += 1;
        // As far as one line goes.
        let (mut end, mut beyond) = (first + 1, places.len() + 1);
        while beyond - end > 1 {
            let middle = (end + beyond) / 2;
            match has_line(&places[first..middle], within_mm) {
                true => end = middle,
                false => beyond = middle,
            }
        }
        first = end;
    }
    parts
}

/// Whether a straight line goes through all of these within a distance: the strip of a convex hull, by its rotating sides.
fn has_line(places: &[(f64, f64)], within_mm: f64) -> bool {
    let hull = |sign: f64| {
        let mut hull: Vec<(f64, f64)> = Vec::new();
        for &(x, y) in places {
            while let [.., a, b] = hull.as_slice() {
                if sign * ((b.0 - a.0) * (y - a.1) - (b.1 - a.1) * (x - a.0)) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push((x, y));
        }
        hull
    };
    let (lower, upper) = (hull(1.0), hull(-1.0));
    let width = |slope: f64| {
        let off = |&(x, y): &(f64, f64)| y - slope * x;
        let high = largest(upper.iter().map(off));
        let low = least(lower.iter().map(off));
        high - low
    };
    // The width is a convex function of the slope.
    let (mut low, mut high) = (-0.05, 0.05);
    for _ in 0..60 {
        let third = (high - low) / 3.0;
        match width(low + third) < width(high - third) {
            true => high -= third,
            false => low += third,
        }
    }
    width(0.5 * (low + high)) <= 2.0 * within_mm
}

#[test]
fn twice_the_blocks_would_be_farther_off() {
    // 22 blocks, of which 12 are no arcs or steps: five arcs for each half of the circle.
    let least = |within_mm: f64| [0.0, std::f64::consts::PI].map(|from| fewest(from, within_mm));
    println!(
        "at 0.44 um at least {:?} arcs, at 0.72 um {:?}",
        least(0.00044),
        least(0.00072)
    );
    assert!(least(0.00044).iter().all(|arcs| *arcs >= 11));
    let (mut low, mut high) = (0.0005, 0.01);
    for _ in 0..20 {
        let middle = 0.5 * (low + high);
        match least(middle).iter().all(|arcs| *arcs <= 5) {
            true => high = middle,
            false => low = middle,
        }
    }
    println!(
        "five arcs for each half are {:.2} um off at least",
        1e3 * high
    );
    assert!(high > 0.002 && high < 0.004);
}

#[test]
fn the_groove_has_about_as_few_arcs_as_its_height_allows() {
    let program = Program::read(GROOVE).unwrap();
    let path = interpret(&program, &at_origin()).unwrap();
    for (tolerance_mm, chord_mm) in [
        (0.0002, 0.0002),
        (0.0005, 0.0004),
        (0.001, 0.0004),
        (0.005, 0.004),
    ] {
        let mut writing = bare();
        writing.tolerance_mm = tolerance_mm;
        writing.chord_tolerance_mm = chord_mm;
        writing.decimals = Some(5);
        let (_, result) = written_with(GROOVE, &field, &at_origin(), &writing);
        verify_against_field(&path, &result, &field, &writing, &Unwatched).unwrap();
        let mut worst = Worst::new();
        let mut arcs = [0; 2];
        for piece in result.pieces.iter().filter(|piece| piece.arc.is_some()) {
            let motion = &path.moves[piece.move_index];
            arcs[piece.move_index - 1] += 1;
            for k in 0..=200 {
                let part = f64::from(k) / 200.0;
                let share = piece.share_from + (piece.share_to - piece.share_from) * part;
                let angle = std::f64::consts::PI * (share + (piece.move_index - 1) as f64);
                worst.add((piece.commanded(motion, part) - corrected(angle)).norm());
            }
        }
        let off = worst.of(201 * (arcs[0] + arcs[1]));
        let least = [0.0, std::f64::consts::PI].map(|from| fewest(from, off));
        println!(
            "{tolerance_mm} + {chord_mm} mm: {arcs:?} arcs, {:.3} um off; no program so near has fewer than {least:?}",
            1e3 * off
        );
        assert!(off <= tolerance_mm + chord_mm);
        assert_eq!(result.pieces.len(), 1 + arcs[0] + arcs[1]);
        for (arcs, least) in arcs.into_iter().zip(least) {
            assert!(arcs <= least + 2, "{arcs} {least}");
        }
    }
}
