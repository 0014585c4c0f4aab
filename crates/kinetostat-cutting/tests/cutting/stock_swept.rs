//! Engagement along programs of many short moves, against the swept area itself: the rim is sampled, and a place on it is in
//! the material if it is in the block and in no move's capsule. Coordinates are rounded to four decimals, as programs are.

use std::f64::consts::{PI, TAU};

use kinetostat_cutting::{Engagement, Probe};
use kinetostat_testing::figure::at_most;

use crate::noise::Noise;
use crate::stock_support::{block, flat};

const RADIUS: f64 = 3.0;
const CELL: f64 = 0.3;
const Z: f64 = -3.0;
/// Half of the block's side.
const HALF: f64 = 22.0;
/// Samples of half a turn.
const SAMPLES: usize = 900;

fn rounded([x, y]: [f64; 2]) -> [f64; 3] {
    let round = |v: f64| (v * 1e4).round() / 1e4;
    [round(x), round(y), Z]
}

/// Arc in material, rad, of a rim at a place of the last of these moves.
fn exact(places: &[[f64; 3]], at: [f64; 2], feed: [f64; 2]) -> f64 {
    let inside = |p: [f64; 2]| {
        let in_block = p[0].abs() < HALF && p[1].abs() < HALF;
        in_block
            && places.windows(2).rev().all(|ends| {
                let (a, b) = (ends[0], ends[1]);
                let d = [b[0] - a[0], b[1] - a[1]];
                let q = [p[0] - a[0], p[1] - a[1]];
                let square = d[0] * d[0] + d[1] * d[1];
                let t = ((q[0] * d[0] + q[1] * d[1]) / square).clamp(0.0, 1.0);
                (q[0] - t * d[0]).hypot(q[1] - t * d[1]) > RADIUS - 1e-6
            })
    };
    let count = (0..SAMPLES).filter(|k| {
        let (sin, cos) = ((*k as f64 + 0.5) * PI / SAMPLES as f64).sin_cos();
        inside([
            at[0] + RADIUS * (sin * feed[0] - cos * feed[1]),
            at[1] + RADIUS * (sin * feed[1] + cos * feed[0]),
        ])
    });
    count.count() as f64 * PI / SAMPLES as f64
}

fn arc(engagement: &Engagement) -> f64 {
    engagement.contacts.iter().map(|c| c.exit - c.entry).sum()
}

/// What was found and what is, rad, at every station from a move on; moves shorter than 0.01 mm have no direction.
fn compared(places: &[[f64; 3]], from: usize) -> Vec<[f64; 2]> {
    let mut stock = block([-HALF, -HALF, -8.0], [HALF, HALF, 0.0], CELL);
    let mut probe = Probe::new(&flat(2.0 * RADIUS));
    let down = [places[0][0], places[0][1], 5.0];
    probe.cut(&mut stock, down, places[0]).unwrap();
    let mut all = Vec::new();
    for (k, ends) in places.windows(2).enumerate() {
        let (a, b) = (ends[0], ends[1]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        if length == 0.0 {
            continue;
        }
        for station in probe.stations(&mut stock, a, b).unwrap() {
            if k < from || length < 0.01 {
                continue;
            }
            let at: [f64; 3] = std::array::from_fn(|i| a[i] + station.share * (b[i] - a[i]));
            let mut way = places[..=k].to_vec();
            way.push(at);
            let feed = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
            all.push([arc(&station.engagement), exact(&way, [at[0], at[1]], feed)]);
        }
    }
    all
}

/// A straight way at an angle in chords of random length.
fn straight(angle: f64, noise: &mut Noise) -> Vec<[f64; 3]> {
    let (sin, cos) = angle.sin_cos();
    let mut places = Vec::new();
    let mut way = -12.0;
    while way < 12.0 {
        places.push(rounded([0.13 + way * cos, way * sin - 0.07]));
        way += 0.02 + 0.98 * noise.uniform();
    }
    places
}

/// An arc or a spiral (`rise` mm per turn) in chords of random length.
fn round(radius: f64, rise: f64, turns: f64, noise: &mut Noise) -> Vec<[f64; 3]> {
    let mut places = Vec::new();
    let mut angle = 0.3;
    while angle < 0.3 + TAU * turns {
        let r = radius + rise * angle / TAU;
        places.push(rounded([0.11 + r * angle.cos(), r * angle.sin() - 0.23]));
        angle += (0.02 + 0.38 * noise.uniform()) / (r + 0.5);
    }
    places
}

/// Along its own fresh wall a tool meets nothing: straight, at odd angles, again and backwards, with other chords.
#[test]
fn figure_along_its_own_straight_wall_a_tool_meets_nothing() {
    let mut noise = Noise(3);
    let (mut worst, mut count): (f64, usize) = (0.0, 0);
    for k in 0..8 {
        let angle = 0.2 + 0.77 * f64::from(k);
        let mut places = straight(angle, &mut noise);
        let fresh = places.len();
        let mut back = straight(angle, &mut noise);
        back.reverse();
        // Not beyond the ends of the first pass, where there is material.
        back.retain(|p| (p[0] - 0.13).hypot(p[1] + 0.07) < 11.0);
        places.extend(back.iter());
        places.extend(back.iter().rev());
        for [found, _] in compared(&places, fresh) {
            assert!(found.is_finite());
            worst = if found > worst { found } else { worst };
            count += 1;
        }
    }
    assert!(count > 200, "{count}");
    at_most(
        "engagement along a fresh straight wall: largest arc",
        worst,
        0.05,
        "rad",
    );
    assert!(worst < 0.05, "{worst}");
}

/// On arcs the chords of the second pass leave those of the first by up to their height, 0.4^2/(8 3) = 0.007 mm, which is an
/// arc of 0.07 rad; a cell on the rim is 0.1 rad.
#[test]
fn figure_along_its_own_round_wall_a_tool_meets_slivers_at_most() {
    let mut noise = Noise(5);
    let (mut worst, mut count): (f64, usize) = (0.0, 0);
    for radius in [1.5, 4.0, 9.0] {
        let mut places = round(radius, 0.0, 1.02, &mut noise);
        let fresh = places.len();
        places.extend(round(radius, 0.0, 1.02, &mut noise));
        for [found, _] in compared(&places, fresh) {
            assert!(found.is_finite());
            worst = if found > worst { found } else { worst };
            count += 1;
        }
    }
    assert!(count > 200, "{count}");
    at_most(
        "engagement along a fresh round wall: largest arc",
        worst,
        0.2,
        "rad",
    );
    assert!(worst < 0.2, "{worst}");
}

/// A pocket out of the middle: what is found is what is, and it changes from station to station by no more.
#[test]
fn figure_spirals_of_random_chords_have_the_engagement_of_what_they_sweep() {
    let mut noise = Noise(11);
    let stations = compared(&round(0.2, 2.0, 3.5, &mut noise), 0);
    assert!(stations.len() > 150, "{}", stations.len());
    let (mut worst, mut sum): (f64, f64) = (0.0, 0.0);
    let mut changes = [0.0; 2];
    for (k, [found, is]) in stations.iter().enumerate() {
        let off = (found - is).abs();
        assert!(off.is_finite());
        worst = if off > worst { off } else { worst };
        sum += off;
        if k > 0 {
            for i in 0..2 {
                changes[i] += (stations[k][i] - stations[k - 1][i]).abs();
            }
        }
    }
    let mean = sum / stations.len() as f64;
    at_most(
        "engagement along a spiral of chords: largest error",
        worst,
        0.1,
        "rad",
    );
    at_most(
        "engagement along a spiral of chords: mean error",
        mean,
        0.02,
        "rad",
    );
    assert!(worst < 0.1, "{worst}");
    assert!(mean < 0.02, "{mean}");
    assert!(changes[0] < 1.1 * changes[1] + 0.1, "{changes:?}");
}
