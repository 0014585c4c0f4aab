//! Frames against transformations by hand.

use nalgebra::Vector3;

use super::{fault, place, program, written};
use kinetostat_formats::*;

/// Turns about X, Y and Z by degrees, written out.
fn about(axis: usize, degrees: f64, v: Vector3<f64>) -> Vector3<f64> {
    let (s, c) = degrees.to_radians().sin_cos();
    match axis {
        0 => Vector3::new(v.x, c * v.y - s * v.z, s * v.y + c * v.z),
        1 => Vector3::new(c * v.x + s * v.z, v.y, -s * v.x + c * v.z),
        _ => Vector3::new(c * v.x - s * v.y, s * v.x + c * v.y, v.z),
    }
}

fn at(frames: &str) -> Vector3<f64> {
    let text = format!("G54 G17\n{frames}\nG0 X1 Y2 Z3\n");
    Vector3::from(place(&program(&text), 0))
}

fn near(found: Vector3<f64>, expected: Vector3<f64>) {
    assert!((found - expected).norm() < 1e-12, "{found} {expected}");
}

#[test]
fn frames_follow_one_another_as_they_are_stated() {
    let p = Vector3::new(1.0, 2.0, 3.0);
    let t = Vector3::new(10.0, -20.0, 30.0);
    near(at("TRANS X10 Y-20 Z30"), t + p);
    near(at("TRANS X99\nTRANS X10 Y-20 Z30"), t + p);
    near(at("TRANS X10\nATRANS Y-20 Z30"), t + p);
    near(at("ROT Z30"), about(2, 30.0, p));
    // Several angles: about Z, then the new Y, then the new X.
    near(
        at("ROT X15 Y-25 Z40"),
        about(2, 40.0, about(1, -25.0, about(0, 15.0, p))),
    );
    // A shift, and a turn in its axes; then a shift in the turned ones.
    near(at("TRANS X10 Y-20 Z30\nAROT Z30"), t + about(2, 30.0, p));
    near(at("ROT Z30\nATRANS X10 Y-20 Z30"), about(2, 30.0, t + p));
    // ROT and TRANS take back all before.
    near(at("TRANS X10\nROT Z30"), about(2, 30.0, p));
    near(at("ROT Z30\nTRANS X10 Y-20 Z30"), t + p);
    near(at("ROT X15\nTRANS X5\nTRANS"), p);
    near(at("ROT X15\nROT"), p);
    // In the plane.
    near(at("ROT RPL=30"), about(2, 30.0, p));
    near(at("G18\nROT RPL=30"), about(1, 30.0, p));
    near(at("G19\nAROT RPL=-30"), about(0, -30.0, p));
    // In inches shifts are inches, angles degrees.
    near(
        at("G70\nTRANS X1\nAROT Z90"),
        Vector3::new(25.4, 0.0, 0.0) + about(2, 90.0, 25.4 * p),
    );
}

#[test]
fn the_tool_stays_where_it_is_when_a_frame_changes() {
    // X alone is stated behind the turn: the others are where the tool is, in the new axes.
    let found = place(&program("G0 X10 Y0 Z5\nROT Z90\nG1 X3 F100\n"), 1);
    let start = about(2, -90.0, Vector3::new(10.0, 0.0, 5.0));
    near(
        Vector3::from(found),
        about(2, 90.0, Vector3::new(3.0, start.y, start.z)),
    );
}

#[test]
fn a_step_behind_a_shifted_frame_adds_to_the_number_of_its_axis() {
    // As controls come (SD42440 = 1): the machine goes the offset with the first step of an axis, and none with further ones.
    let cases = [
        ("G0 X100 Y5 Z7\nTRANS X10\nG91\nG0 X3", [113.0, 5.0, 7.0]),
        (
            "G0 X100 Y5 Z7\nTRANS X10\nG0 X=IC(3)\nX=IC(3)",
            [116.0, 5.0, 7.0],
        ),
        // An axis waits until it is stepped; one that no offset is of steps alone.
        (
            "G0 X100 Y5 Z7\nTRANS X10\nG91\nG0 Y2\nY2\nX3",
            [113.0, 9.0, 7.0],
        ),
        (
            "G0 X100 Y5 Z7\nTRANS X10 Z-4\nATRANS X1\nG91\nG0 X3 Z1",
            [114.0, 5.0, 4.0],
        ),
        (
            "G0 X100 Y5 Z7\nTRANS X10\nTRANS\nG91\nG0 X3",
            [103.0, 5.0, 7.0],
        ),
        // Taken back, the offset is gone back.
        (
            "TRANS X10\nG0 X100 Y5 Z7\nTRANS\nG91\nG0 X3",
            [103.0, 5.0, 7.0],
        ),
        (
            "G0 X100 Y5 Z7\nTRANS X10\nG0 X100\nG91\nX3",
            [113.0, 5.0, 7.0],
        ),
        (
            "G70\nG0 X1 Y2 Z3\nTRANS Y1\nG91\nG0 Y0.5",
            [25.4, 88.9, 76.2],
        ),
    ];
    for (text, expected) in cases {
        let program = program(&format!("G54\n{text}\n"));
        let last = program.motions.len() - 1;
        near(
            Vector3::from(place(&program, last)),
            Vector3::from(expected),
        );
    }
    // In turned axes, shifted and stepped along them.
    let found = program("ROT X15 Z30\nG0 X1 Y2 Z3\nATRANS X10 Y-4\nG91\nG0 X3 Y1\n");
    let expected = about(2, 30.0, about(0, 15.0, Vector3::new(14.0, -1.0, 3.0)));
    near(Vector3::from(place(&found, 1)), expected);
}

#[test]
fn a_step_behind_a_frame_that_is_turned_is_refused() {
    let head = "G54\nG0 X10 Y1 Z5\nROT Z30\n";
    let found = fault(&format!("{head}G91 G1 F100\nX3\n"));
    assert!(
        found.contains("line 5: `X3`: a step (G91, IC) is the first word of its axis behind a frame that is turned otherwise"),
        "{found}"
    );
    // Along the axis that it turns about nothing is otherwise; behind an absolute place all is known; a rapid stays.
    let last = |text: &str| {
        let program = program(&format!("{head}{text}"));
        let last = program.motions.len() - 1;
        Vector3::from(place(&program, last))
    };
    near(last("G91 G1 Z-2 F100\n"), Vector3::new(10.0, 1.0, 3.0));
    near(
        last("G0 X1 Y2\nG91 G1 X3 F100\n"),
        about(2, 30.0, Vector3::new(4.0, 2.0, 5.0)),
    );
    near(
        last("G91 G0 X3\nG90 X1 Y2\n"),
        about(2, 30.0, Vector3::new(1.0, 2.0, 5.0)),
    );
    let found = fault("G54 G17\nG0 X10 Y1 Z5\nTRANS X5\nG91 G3 X0 Y20 CR=10 F100\n");
    assert!(
        found.contains("line 4") && found.contains("a step (G91, IC) of an arc is the first word"),
        "{found}"
    );
}

#[test]
fn arcs_lie_in_the_turned_plane() {
    let program = program("G17 G54\nROT X90\nG0 X10 Y0 Z0\nG3 X0 Y10 CR=10 F100\n");
    let MotionKind::Arc {
        centre_mm,
        axis,
        angle_rad,
    } = program.motions[1].kind
    else {
        panic!()
    };
    near(centre_mm, Vector3::zeros());
    near(axis, about(0, 90.0, Vector3::z()));
    assert!((angle_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    near(
        Vector3::from(place(&program, 1)),
        Vector3::new(0.0, 0.0, 10.0),
    );
}

#[test]
fn arcs_by_radius_opening_and_plane() {
    let cases = [
        // Centre, axis, angle in degrees.
        ("G17", "G2 X10 Y10 CR=10", [10.0, 0.0, 0.0], 2, -90.0),
        ("G17", "G3 X10 Y10 CR=10", [0.0, 10.0, 0.0], 2, 90.0),
        ("G17", "G3 X10 Y10 CR=-10", [10.0, 0.0, 0.0], 2, 270.0),
        ("G17", "G2 X10 Y10 AR=90", [10.0, 0.0, 0.0], 2, -90.0),
        ("G17", "G2 X10 Y10 AR=270", [0.0, 10.0, 0.0], 2, -270.0),
        ("G17", "G2 I10 J0 AR=90", [10.0, 0.0, 0.0], 2, -90.0),
        ("G17", "G3 X20 I10", [10.0, 0.0, 0.0], 2, 180.0),
        ("G17", "G3 X20 I=AC(10)", [10.0, 0.0, 0.0], 2, 180.0),
        // Z is the first axis of G18, Y that of G19.
        ("G18", "G3 Z10 X10 CR=10", [10.0, 0.0, 0.0], 1, 90.0),
        ("G18", "G2 Z10 X10 I0 K10", [0.0, 0.0, 10.0], 1, -90.0),
        ("G19", "G3 Y10 Z10 CR=10", [0.0, 0.0, 10.0], 0, 90.0),
    ];
    for (plane, words, centre, across, degrees) in cases {
        let program = program(&format!("{plane} G0 X0 Y0 Z0\n{words} F100\n"));
        let MotionKind::Arc {
            centre_mm,
            axis,
            angle_rad,
        } = program.motions[1].kind
        else {
            panic!("{words}")
        };
        let mut normal = Vector3::zeros();
        normal[across] = 1.0;
        assert!(
            (centre_mm - Vector3::from(centre)).norm() < 1e-9,
            "{words}: {centre_mm}"
        );
        assert_eq!(axis, normal, "{words}");
        assert!(
            (angle_rad.to_degrees() - degrees).abs() < 1e-9,
            "{words}: {angle_rad}"
        );
        // The start turned about the centre is the end.
        let end = Vector3::from(place(&program, 1));
        let turned = centre_mm + about(across, degrees, -centre_mm);
        assert!((turned - end).norm() < 1e-9, "{words}: {turned} {end}");
    }
}

#[test]
fn directions_by_angles() {
    // Euler: Z, new X, new Z. RPY: Z by C2, new Y by B2, new X by A2.
    let z = Vector3::z();
    let cases = [
        (
            "ORIEULER",
            about(2, 20.0, about(0, 30.0, about(2, 40.0, z))),
        ),
        ("ORIRPY", about(2, 40.0, about(1, 30.0, about(0, 20.0, z)))),
    ];
    for (mode, expected) in cases {
        let text = format!("TRAORI\n{mode}\nG0 X0 Y0 Z0 A2=20 B2=30 C2=40\n");
        let pose = program(&text).motions[0].target.pose().unwrap().clone();
        near(pose.orientation * z, expected);
    }
}

#[test]
fn corrections_are_written_in_the_axes_of_the_frame() {
    let text = "G54\nTRANS X100\nAROT Z90\nG0 X0 Y0 Z5\nG1 X10 F100\n";
    let program = program(text);
    let end = Vector3::from(place(&program, 1));
    near(end, Vector3::new(100.0, 10.0, 5.0));
    // Along the part's X is along -Y of the frame.
    let output = written(
        &program,
        &[Piece::to(1, end + Vector3::new(0.25, 0.0, 0.0))],
    );
    assert_eq!(output, text.replace("G1 X10 F100", "G1 X10 Y-0.250 F100"));
}

/// Behind a frame the step of an axis counts from the last word of it: where the writer states the axis, the step becomes a place.
#[test]
fn a_step_behind_a_frame_becomes_a_place_where_its_axis_is_stated() {
    let own = program("G17 G90 G94 F600\nG0 X1 Y2 Z80\nATRANS Z3.5\nG1 X5\nG91\nG1 Z-20\n");
    let ends: Vec<[f64; 3]> = (0..3).map(|at| place(&own, at)).collect();
    assert_eq!(ends, [[1.0, 2.0, 80.0], [5.0, 2.0, 80.0], [5.0, 2.0, 63.5]]);
    let up = Piece::to(1, nalgebra::Vector3::new(5.0, 2.0, 80.25));
    let text = written(&own, &[up]);
    let again = program(&text);
    let ends: Vec<[f64; 3]> = (0..3).map(|at| place(&again, at)).collect();
    assert_eq!(
        ends,
        [[1.0, 2.0, 80.0], [5.0, 2.0, 80.25], [5.0, 2.0, 63.5]]
    );
}
