//! How the tool turns along a move.

use kinetostat_program::{ToolTurn, irregular};
use kinetostat_testing::Worst;
use nalgebra::{Unit, UnitQuaternion, UnitVector3, Vector3};

fn any(seed: u64, index: u64, size: f64) -> UnitQuaternion<f64> {
    let part = |n: u64| size * (2.0 * irregular(seed, index, n) - 1.0);
    UnitQuaternion::from_scaled_axis(Vector3::new(part(0), part(1), part(2)))
}

fn axis(seed: u64, index: u64) -> UnitVector3<f64> {
    let part = |n: u64| irregular(seed, index, n) - 0.5;
    Unit::new_normalize(Vector3::new(part(0), part(1), part(2)))
}

/// The axis stays in the plane of its two directions and goes evenly, and the turn about it is even: the angular velocity has the
/// same parts along the axis and across it everywhere.
#[test]
fn an_axis_swivels_in_a_plane_and_the_tool_turns_evenly_about_it() {
    let (mut plane, mut even, mut ends) = (Worst::new(), Worst::new(), Worst::new());
    for index in 0..200 {
        let [start, end] = [any(1, index, 3.0), any(2, index, 3.0)];
        let axis = axis(3, index);
        let turn = ToolTurn::swivelled(start, end, axis);
        ends.add(turn.at(0.0).angle_to(&start));
        ends.add(turn.at(1.0).angle_to(&end));
        let direction = |share: f64| turn.at(share) * axis.into_inner();
        let [first, last] = [direction(0.0), direction(1.0)];
        let normal = first.cross(&last).normalize();
        let step = 1e-4;
        let rate = |share: f64| {
            let way = (turn.at(share - step).inverse() * turn.at(share + step)).scaled_axis();
            let along = way.dot(&axis);
            (
                along / (2.0 * step),
                (way - axis.into_inner() * along).norm() / (2.0 * step),
            )
        };
        let (along, across) = rate(0.5);
        assert!((across - first.angle(&last)).abs() < 1e-5);
        for k in 0..5 {
            let share = 0.01 + 0.98 * irregular(4, index, k);
            plane.add(direction(share).dot(&normal));
            let (here, there) = rate(share);
            even.add(here - along);
            even.add(there - across);
        }
    }
    assert!(plane.of(1000) < 1e-12, "{}", plane.value());
    assert!(even.of(2000) < 1e-6, "{}", even.value());
    assert!(ends.of(400) < 1e-7, "{}", ends.value());
}

/// A motion in pieces turns the tool as the whole one does.
#[test]
fn pieces_of_a_turn_are_the_turn() {
    let mut worst = Worst::new();
    for index in 0..200 {
        let [start, end] = [any(5, index, 3.0), any(6, index, 3.0)];
        let whole = match index % 2 {
            0 => ToolTurn::swivelled(start, end, axis(7, index)),
            _ => ToolTurn::shortest(start, end),
        };
        let [a, b] = [
            0.5 * irregular(8, index, 0),
            0.5 + 0.5 * irregular(8, index, 1),
        ];
        let piece = whole.with_ends(whole.at(a), whole.at(b));
        for k in 0..4 {
            let part = irregular(9, index, k);
            let [found, wanted] = [piece.at(part), whole.at(a + part * (b - a))];
            worst.add((found.inverse() * wanted).scaled_axis().norm());
        }
    }
    assert!(worst.of(800) < 1e-10, "{}", worst.value());
}

#[test]
fn an_axis_that_stays_or_is_turned_round_has_a_way_too() {
    let start = any(10, 0, 1.0);
    let axis = Vector3::x_axis();
    let spin = UnitQuaternion::from_axis_angle(&axis, 0.8);
    let turn = ToolTurn::swivelled(start, start * spin, axis);
    let half = start * UnitQuaternion::from_axis_angle(&axis, 0.4);
    assert!(turn.at(0.5).angle_to(&half) < 1e-9);
    let round = start * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::PI);
    let turn = ToolTurn::swivelled(start, round, axis);
    assert!(turn.at(1.0).angle_to(&round) < 1e-7);
    let middle = turn.at(0.5);
    assert!(middle.coords.iter().all(|part| part.is_finite()));
    assert!((middle.angle_to(&start) - std::f64::consts::FRAC_PI_2).abs() < 1e-6);
}
