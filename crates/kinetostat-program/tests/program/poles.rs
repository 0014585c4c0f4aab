//! Where directions of the tool say little of two rotary axes: closed forms of three machines.

use kinetostat_program::{Carries, RotaryAxes, RotaryAxis, RotaryTurn, StatedBy};
use nalgebra::{Unit, UnitQuaternion, Vector3};

fn turn(axes: [(Carries, Vector3<f64>); 2], from: [f64; 2], to: [f64; 2]) -> RotaryTurn {
    let axis = |(carries, direction)| RotaryAxis {
        letter: 'A',
        carries,
        direction: Unit::new_normalize(direction),
        point_mm: Vector3::zeros(),
        limits_deg: None,
    };
    let axes = RotaryAxes {
        axes: axes.map(axis).to_vec(),
        tool_at_zero: UnitQuaternion::identity(),
    };
    RotaryTurn {
        axes: axes.into(),
        start_deg: from.to_vec(),
        end_deg: to.to_vec(),
        origin_deg: vec![0.0; 2],
        great_circle: None,
        stated: StatedBy::Direction,
    }
}

#[test]
fn poles_lie_where_the_axes_turn_the_tool_about_one_direction() {
    let (head, table) = (Carries::Tool, Carries::Part);
    let (x, z) = (Vector3::x(), Vector3::z());
    let near = 0.01_f64;
    // A fork head above a table passes the pole at A0, halfway.
    let fork = turn([(head, x), (table, -z)], [20.0, 0.0], [-20.0, 90.0]);
    let [[from, to]] = fork.shares_near_poles(near)[..] else {
        panic!("{:?}", fork.shares_near_poles(near));
    };
    let half = near.to_degrees() / 40.0;
    assert!((from - 0.5 + half).abs() < 1e-12 && (to - 0.5 - half).abs() < 1e-12);
    // A cradle below a table: from the pole to the other one, upside down.
    let cradle = turn([(table, x), (table, z)], [0.0, 10.0], [180.0, 40.0]);
    assert_eq!(cradle.shares_near_poles(near).len(), 2);
    // A nutating head at 45 degrees: the pole at zero, and the tool flat at half a turn.
    let leaning = Vector3::new(0.0, 1.0, 1.0);
    let nutating = turn([(head, z), (head, leaning)], [0.0, -10.0], [90.0, 190.0]);
    let found = nutating.shares_near_poles(near);
    let middles: Vec<f64> = found.iter().map(|[a, b]| 0.5 * (a + b)).collect();
    assert!((middles[0] - 0.05).abs() < 1e-9 && (middles[1] - 0.95).abs() < 1e-9);
    // One axis along the other, one that stands, and one that stays near the pole have none.
    let none = [
        turn([(head, z), (table, z)], [0.0, 10.0], [90.0, 40.0]),
        turn([(head, x), (table, z)], [5.0, 10.0], [5.0, 40.0]),
        turn([(head, x), (table, z)], [-0.1, 10.0], [0.1, 40.0]),
    ];
    for turn in none {
        assert!(turn.shares_near_poles(near).is_empty(), "{turn:?}");
    }
}
