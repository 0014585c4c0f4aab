//! Where directions of the tool say little of two rotary axes: closed forms of three machines.

use kinetostat_program::{Carries, GreatCircle, RotaryAxes, RotaryAxis, RotaryTurn, StatedBy};
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

/// A fork head above a table passes a pole nearby: the table turns by the angle between what both directions lean, fast, and goes on as it
/// came. Steps of half a degree took the other angles of the same direction behind the pole, half a turn off.
#[test]
fn near_a_pole_the_axes_go_on_as_they_came() {
    let axes = turn(
        [
            (Carries::Tool, Vector3::x()),
            (Carries::Part, -Vector3::z()),
        ],
        [0.0; 2],
        [0.0; 2],
    )
    .axes;
    let direction = |x: f64, y: f64| Vector3::new(x, y, (1.0 - x * x - y * y).sqrt());
    for distance in [1e-5, 5e-4, 3e-3] {
        let [from, to] = [direction(distance, -0.02), direction(distance, 0.07)];
        let start = axes.angles_towards(&from, &[0.0, 0.0]).unwrap();
        let circle = GreatCircle::new(&axes, &start, &to).unwrap();
        // What the tool leans by, seen from above, turns so far.
        let lean = |v: &Vector3<f64>| v.y.atan2(v.x).to_degrees();
        let expected = lean(&to) - lean(&from);
        let turned = circle.end_deg()[1] - circle.start_deg()[1];
        assert!(
            (turned.abs() - expected).abs() < 1e-6,
            "{distance}: {turned}, not {expected}"
        );
        assert!(expected > 100.0 && (circle.way_deg()[1] - expected).abs() < 1e-6);
        // The head does not pass upright, and the table turns one way.
        let mut before = circle.start_deg()[1];
        for step in 1..=5000 {
            let share = f64::from(step) / 5000.0;
            let angles = circle.angles_at(&axes, share);
            let [a, c] = angles[..] else { unreachable!() };
            assert!(a * start[0] > 0.0, "{distance}, {share}: A{a}");
            assert!(
                (c - before) * turned >= 0.0,
                "{distance}, {share}: C{c} behind C{before}"
            );
            let points = axes.tool_direction_at(&angles, &Vector3::z());
            assert!((points - circle.direction_at(share)).norm() < 1e-9);
            before = c;
        }
        // Fastest where the pole is nearest: an angle of the way over the distance from it.
        let sweep = from.angle(&to).to_degrees();
        let fastest = circle.fastest_deg([0.0, 1.0])[1];
        let nearest = sweep / distance;
        assert!(
            fastest > 0.9 * nearest && fastest < 1.1 * nearest,
            "{fastest} {nearest}"
        );
        assert!(circle.fastest_deg([0.6, 1.0])[1] < 0.05 * fastest);
    }
}
