//! Figures 7.5 and 7.6: what errors of the legs and the cutting force make of a small circle, each alone and both [R 7.5].
//!
//! The report leaves the stiffness of the drives open; both readings of it are calculated (section 2.6 of the reference values).

use nalgebra::{Matrix2, Vector3};

use crate::orthoglide::circle::{At, Circle, READINGS, Reading};
use crate::orthoglide::groove::{DrawnPath, load, plan};
use crate::orthoglide::machine::POINTS;
use crate::{Cause, Contents, Item};

/// The small circle at Q1 under both readings: their letters, what they say of the drives, the reading.
fn small_circles() -> [(&'static str, &'static str, Reading); 2] {
    let small = |reading: Reading| Reading {
        radius: READINGS[1].radius,
        ..reading
    };
    [
        ("A", "rigid drives", small(READINGS[0])),
        ("B", "drives of 1000 N/mm", small(READINGS[2])),
    ]
}

/// The circle of a reading about Q1, and what is said of all its numbers.
fn small_circle(drives: &str, reading: &Reading) -> Result<(Circle, String), Cause> {
    let note = format!(
        "circle of 2 mm about Q1, 1 degree of error in each leg, {drives}; the figure prints no digits"
    );
    Ok((reading.circle(POINTS[1].1)?, note))
}

/// Angle (degrees, 0 to 180) of the longest axis of a path in the plane.
fn longest_axis(circle: &Circle, of: impl Fn(&At) -> Vector3<f64>) -> f64 {
    let centre = circle.mean(&of);
    let mut spread = Matrix2::zeros();
    for p in circle.points.iter().skip(1) {
        let d = (of(p) - centre).xy();
        spread += d * d.transpose();
    }
    let twice = (2.0 * spread[(0, 1)]).atan2(spread[(0, 0)] - spread[(1, 1)]);
    (0.5 * twice.to_degrees()).rem_euclid(180.0)
}

pub(crate) fn fig_7_5() -> Result<Contents, Cause> {
    let paths: [DrawnPath; 5] = [
        ("(1) target", |p| p.desired),
        ("(2) errors of the legs", |p| p.desired + p.sources.errors),
        ("(3) cutting force", |p| p.desired + p.sources.force),
        ("(4) both", |p| p.desired + p.sources.both),
        ("(5) adjusted", |p| p.desired + p.correction),
    ];
    let mut items = load();
    let mut plots = Vec::new();
    for (letter, drives, reading) in small_circles() {
        let (circle, note) = small_circle(drives, &reading)?;
        let mut say = |name: &str, value: f64, unit: &str, note: &str| {
            items.push(Item::unprinted(
                format!("reading {letter}: {name}"),
                value,
                unit,
                note,
            ));
        };
        let centres = [
            ("(2)", circle.mean(|p| p.sources.errors)),
            ("(3)", circle.mean(|p| p.sources.force)),
            ("(4)", circle.mean(|p| p.sources.both)),
            ("(5), opposite to (4)", circle.mean(|p| p.correction)),
        ];
        for (path, centre) in centres {
            for (k, axis) in ["x", "y"].into_iter().enumerate() {
                say(
                    &format!("centre of path {path}: {axis}"),
                    centre[k],
                    "mm",
                    &note,
                );
            }
        }
        let of_both = longest_axis(&circle, |p| p.desired + p.sources.both);
        say("longest axis of path (4)", of_both, "deg", &note);
        let of_adjusted = longest_axis(&circle, |p| p.desired + p.correction);
        let across = "the text: across that of path (4)";
        say("longest axis of path (5)", of_adjusted, "deg", across);
        let crossing = "the text says that paths (1) and (3) intersect because of the torque: where they do, the difference of their radii has both signs";
        let off = |p: &At| p.outwards(p.sources.force);
        let [least, most] = [circle.least(off), circle.most(off)];
        say(
            "radius of (3) less that of (1), smallest",
            least,
            "mm",
            crossing,
        );
        say(
            "radius of (3) less that of (1), largest",
            most,
            "mm",
            crossing,
        );
        let title = format!(
            "Circle of 2 mm about Q1, {drives}: where the tool goes, and the adjusted path"
        );
        plots.push(plan(title, &circle, &paths));
    }
    Ok(Contents { items, plots })
}

pub(crate) fn fig_7_6() -> Result<Contents, Cause> {
    let paths: [DrawnPath; 4] = [
        ("(1) target", |p| p.desired),
        ("(2) errors of the legs", |p| p.desired + p.sources.errors),
        ("(3) sum of both alone", |p| {
            p.desired + p.sources.superposed()
        }),
        ("(4) both together", |p| p.desired + p.sources.both),
    ];
    let (mut items, mut plots) = (Vec::new(), Vec::new());
    let large = [&READINGS[0], &READINGS[2]];
    for ((letter, drives, reading), large) in small_circles().into_iter().zip(large) {
        let (circle, note) = small_circle(drives, &reading)?;
        let mut say = |name: &str, value: f64, note: &str| {
            items.push(Item::unprinted(
                format!("reading {letter}: {name}"),
                value,
                "mm",
                note,
            ));
        };
        let total = circle.most(|p| p.sources.both.norm());
        say("largest total error (4)", total, &note);
        let summed = circle.most(|p| p.sources.superposed().norm());
        let less = "the text: the total error is less than the one by superposition";
        say("largest error by superposition (3)", summed, less);
        let excess = |p: &At| p.sources.superposed().norm() - p.sources.both.norm();
        let [least, most] = [circle.least(excess), circle.most(excess)];
        say("largest excess of (3) over (4) in length", most, &note);
        let holds = "positive where the text's remark holds";
        say("smallest excess of (3) over (4) in length", least, holds);
        for index in [0, 1, 3] {
            let (name, point) = POINTS[index];
            let apart = large.circle(point)?.most(|p| p.sources.apart());
            let name = format!("{name}: largest difference of (3) and (4)");
            say(&name, apart, &format!("circle of 50 mm, {drives}"));
        }
        let apart = circle.most(|p| p.sources.apart());
        say(
            "Q1: largest difference of (3) and (4), small circle",
            apart,
            &note,
        );
        let title =
            format!("Circle of 2 mm about Q1, {drives}: superposition of the two sources of error");
        plots.push(plan(title, &circle, &paths));
    }
    Ok(Contents { items, plots })
}
