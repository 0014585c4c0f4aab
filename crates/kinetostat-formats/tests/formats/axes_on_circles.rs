//! Directions of the tool on machines with rotary axes: on which way the tool's axis goes between them, as read and as written.

use std::sync::Arc;

use kinetostat_formats::*;
use kinetostat_program::{
    Carries, Request, RotaryAxes, RotaryAxis, WriteOptions as PathWriteOptions,
};
use nalgebra::{Unit, UnitQuaternion, Vector3};

use crate::correcting::written_and_checked;

/// A fork head about x, above a table about z.
fn portal(limits_of_a: Option<[f64; 2]>) -> PathOptions {
    let axis = |letter, carries, direction, limits_deg| RotaryAxis {
        letter,
        carries,
        direction: Unit::new_normalize(direction),
        point_mm: Vector3::new(0.0, 0.0, -20.0),
        limits_deg,
    };
    let mut making = PathOptions::default();
    making.rotary = Some(Arc::new(RotaryAxes {
        axes: vec![
            axis('A', Carries::Tool, Vector3::x(), limits_of_a),
            axis('C', Carries::Part, -Vector3::z(), None),
        ],
        tool_at_zero: UnitQuaternion::identity(),
    }));
    making
}

const DIRECTIONS: [[f64; 3]; 5] = [
    [0.0, 0.0, 1.0],
    [0.173648, 0.0, 0.984808],
    [0.0, 0.173648, 0.984808],
    [-0.3, 0.4, 0.866025],
    [-0.3, 0.2, 0.932738],
];

const PLACES: [[f64; 3]; 5] = [
    [0.0, 0.0, -1.0],
    [50.0, 0.0, -1.0],
    [50.0, 50.0, -1.0],
    [0.0, 50.0, -2.0],
    [0.0, 50.0, -2.0],
];

fn apt() -> (Language, String) {
    let mut text = "UNITS/MM\nMULTAX/ON\nRAPID\nGOTO/0,0,20,0,0,1\nFEDRAT/600,MMPM\n".to_owned();
    for (place, direction) in PLACES.iter().zip(DIRECTIONS) {
        let all: Vec<String> = place.iter().chain(&direction).map(f64::to_string).collect();
        text += &format!("GOTO/{}\n", all.join(","));
    }
    (Language::Apt, text + "FINI\n")
}

fn sinumerik(word: &str) -> (Language, String) {
    let mut text = format!("G90 G71 G94 G17\nTRAORI\nORIWKS {word}\nG0 X0 Y0 Z20 A3=0 B3=0 C3=1\n");
    for ([x, y, z], [i, j, k]) in PLACES.iter().zip(DIRECTIONS) {
        text += &format!("G1 X{x} Y{y} Z{z} A3={i} B3={j} C3={k} F600\n");
    }
    (Language::Siemens, text + "TRAFOOF\nM30\n")
}

fn read_as((language, text): &(Language, String)) -> RobotProgram {
    let file = SourceFile::new("a.txt", text.clone());
    read(*language, vec![file], &ReadOptions::default()).unwrap_or_else(|all| panic!("{}", all[0]))
}

/// Between two directions, evenly, by sines.
fn between(from: [f64; 3], to: [f64; 3], share: f64) -> Vector3<f64> {
    let [from, to] = [from, to].map(|v| Vector3::from(v).normalize());
    let angle = from.dot(&to).clamp(-1.0, 1.0).acos();
    match angle < 1e-9 {
        true => from,
        false => (from * ((1.0 - share) * angle).sin() + to * (share * angle).sin()) / angle.sin(),
    }
}

/// The largest angle between the axis of a path and the great circle, deg; by the motions at `place` of each of `DIRECTIONS`.
fn off_circle(robot: &RobotPath) -> f64 {
    let mut largest = f64::NEG_INFINITY;
    for index in 2..=DIRECTIONS.len() {
        for step in 0..=40 {
            let share = f64::from(step) / 40.0;
            let wanted = between(DIRECTIONS[index - 2], DIRECTIONS[index - 1], share);
            let off = robot
                .path
                .tool_direction(index, share)
                .angle(&wanted)
                .to_degrees();
            assert!(off.is_finite());
            largest = if off > largest { off } else { largest };
        }
    }
    largest
}

#[test]
fn the_axis_goes_as_the_controller_takes_it() {
    let making = portal(None);
    for program in [
        apt(),
        sinumerik(""),
        sinumerik("ORIVECT"),
        sinumerik("ORIPLANE"),
    ] {
        let robot = path_of(&read_as(&program), &making).unwrap();
        let off = off_circle(&robot);
        assert!(off < 1e-6, "{off} deg: {}", program.1);
    }
    // Evenly turning axes leave it by degrees.
    let robot = path_of(&read_as(&sinumerik("ORIAXES")), &making).unwrap();
    let off = off_circle(&robot);
    assert!(off > 2.0, "{off}");
    let turn = robot.path.moves[2].tool_turn.as_ref().unwrap();
    let rotary = turn.rotary.as_ref().unwrap();
    let mean = rotary
        .start_deg
        .iter()
        .zip(&rotary.end_deg)
        .map(|(a, b)| 0.5 * (a + b));
    let mean: Vec<f64> = mean.collect();
    assert!(
        rotary
            .angles_deg(0.5)
            .iter()
            .zip(&mean)
            .all(|(a, b)| (a - b).abs() < 1e-9)
    );
}

#[test]
fn written_programs_stay_on_the_great_circle() {
    for program in [apt(), sinumerik("ORIVECT"), sinumerik("ORIAXES")] {
        for rotary in [true, false] {
            let making = match rotary {
                true => portal(None),
                false => PathOptions::default(),
            };
            let even = program.1.contains("ORIAXES") && rotary;
            let (read_program, reading) = (read_as(&program), ReadOptions::default());
            let path = path_of(&read_program, &making).unwrap();
            let mut writing = PathWriteOptions::default();
            writing.header = None;
            writing.tolerance_mm = 0.002;
            let field = |request: &Request| {
                let p = request.position_mm / 40.0;
                let bend = Vector3::new(p.y * p.y, -p.x, p.x * p.y);
                Ok(bend * 0.05 * (0.5 + request.share * request.share))
            };
            let written = written_and_checked(
                (&read_program, &path),
                (&reading, &making),
                &field,
                &writing,
            )
            .unwrap();
            let text = String::from_utf8(written.bytes.clone()).unwrap();
            let again = path_of(&read_as(&(program.0, text.clone())), &making).unwrap();
            let mut checked = 0;
            for (index, piece) in written.pieces.iter().enumerate() {
                if piece.move_index < 2 || piece.corner_step {
                    continue;
                }
                for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
                    let share = piece.share_from + part * (piece.share_to - piece.share_from);
                    let wanted = match even {
                        true => path.path.tool_direction(piece.move_index, share),
                        false => between(
                            DIRECTIONS[piece.move_index - 2],
                            DIRECTIONS[piece.move_index - 1],
                            share,
                        ),
                    };
                    let off = again.path.tool_direction(index, part).angle(&wanted);
                    // Seven digits of a direction.
                    assert!(off < 1e-6, "{off} rad at {part} of piece {index}\n{text}");
                    checked += 1;
                }
            }
            assert!(checked > 50, "{checked}\n{text}");
        }
    }
}

#[test]
fn a_direction_of_the_tool_that_is_held_does_not_take_its_axis_off_the_circle() {
    let mut making = PathOptions::default();
    making.turn_about_axis = TurnAboutAxis::Towards {
        of_tool: Vector3::x(),
        in_part: Vector3::x(),
    };
    let robot = path_of(&read_as(&apt()), &making).unwrap();
    assert!(off_circle(&robot) < 1e-6);
}

#[test]
fn limits_of_rotary_axes_choose_the_angles_or_are_told_by_line() {
    // Of the two ways to every direction the one with A above zero, or below it.
    for limits in [[-0.5, 110.0], [-110.0, 0.5]] {
        for program in [apt(), sinumerik("ORIAXES")] {
            let robot = path_of(&read_as(&program), &portal(Some(limits))).unwrap();
            for motion in &robot.path.moves {
                let turn = motion.tool_turn.as_ref().unwrap();
                for share in [0.0, 0.3, 0.7, 1.0] {
                    let a = turn.rotary.as_ref().unwrap().angles_deg(share)[0];
                    assert!((limits[0] - 1e-6..=limits[1] + 1e-6).contains(&a), "{a}");
                }
            }
        }
    }
    let faults = path_of(&read_as(&apt()), &portal(Some([-15.0, 15.0]))).unwrap_err();
    let said: Vec<String> = faults.iter().map(ToString::to_string).collect();
    // 30 degrees towards (-3, 4), and 22 degrees towards (-3, 2).
    assert_eq!(faults.len(), 2, "{said:?}");
    assert!(
        said[0].contains("line 9") && said[0].contains("axis A would stand at"),
        "{said:?}"
    );
    assert!(
        said[0].contains("it reaches -15 to 15 deg (nearest angles: A"),
        "{said:?}"
    );
}
