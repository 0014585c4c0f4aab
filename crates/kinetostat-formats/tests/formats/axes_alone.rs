//! Programs that state the direction of the tool's axis alone: how the tool stands then, and what is written of it.

use std::io::Write as _;

use kinetostat_formats::*;
use kinetostat_program::{
    Correction, CorrectionField, FieldFailure, NoCorrection, Request,
    WriteOptions as PathWriteOptions,
};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use crate::chance::Chance;
use crate::correcting::written_and_checked;
use crate::real_files::{programs, stated};

/// Axes that lean all along a half circle, off all axes of the part.
fn leaning(chance: &mut Chance) -> (String, Vec<Vector3<f64>>) {
    let (mut text, mut axes) = ("UNITS/MM\nMULTAX\nRAPID\n".to_owned(), Vec::new());
    for index in 0..40 {
        let place = Vector3::from_fn(|_, _| chance.within(90.0));
        let lean = chance.within(0.9);
        let around = f64::from(index) * 0.4;
        let written = [
            lean.sin() * around.cos(),
            lean.sin() * around.sin(),
            lean.cos(),
        ];
        let digits = written.map(|part| format!("{part:.6}"));
        let [x, y, z] = [place.x, place.y, place.z].map(|part| format!("{part:.3}"));
        text += &format!("GOTO/{x},{y},{z},{}\n", digits.join(","));
        let read = digits.map(|part| part.parse::<f64>().unwrap());
        axes.push(Vector3::from(read).normalize());
        if index == 0 {
            text += "FEDRAT/900,MMPM\n";
        }
    }
    (text, axes)
}

fn apt(text: &str) -> RobotProgram {
    read_apt(
        vec![SourceFile::new("a.apt", text)],
        &ReadOptions::default(),
    )
    .unwrap()
}

/// The rotation of two rotation matrices' columns: no quaternion.
fn matrix(turn: &UnitQuaternion<f64>) -> Matrix3<f64> {
    turn.to_rotation_matrix().into_inner()
}

#[test]
fn the_axis_is_that_of_the_text_and_goes_on_the_great_circle() {
    let mut chance = Chance::new(7);
    let (text, axes) = leaning(&mut chance);
    let robot = path_of(&apt(&text), &PathOptions::default()).unwrap();
    assert!(robot.axis_alone);
    assert_eq!(robot.path.moves.len(), axes.len());
    for index in 1..axes.len() {
        let (from, to) = (axes[index - 1], axes[index]);
        let angle = from.dot(&to).acos();
        for share in [0.0, 0.3, 0.5, 0.9, 1.0] {
            // Between two directions, evenly: by sines.
            let wanted =
                (from * ((1.0 - share) * angle).sin() + to * (share * angle).sin()) / angle.sin();
            let is = robot.path.tool_direction(index, share);
            assert!(
                (is - wanted).norm() < 1e-9,
                "{index} at {share}: {is} {wanted}"
            );
        }
        // It does not turn about its axis: the rotation from start to end has its axis across both.
        let motion = &robot.path.moves[index];
        let [start, end] = [0.0, 1.0].map(|share| matrix(&motion.orientation(share).unwrap()));
        let turn = end * start.transpose();
        let about = Vector3::new(
            turn[(2, 1)] - turn[(1, 2)],
            turn[(0, 2)] - turn[(2, 0)],
            turn[(1, 0)] - turn[(0, 1)],
        );
        assert!(
            about.dot(&from).abs() < 1e-9 && about.dot(&to).abs() < 1e-9,
            "{index}"
        );
        // One motion begins as the one before it ends.
        let before = robot.path.moves[index - 1].orientation(1.0).unwrap();
        assert!((matrix(&before) - start).norm() < 1e-9, "{index}");
    }
    // Where it begins: z of the part is reached with x of the tool along x.
    let first = matrix(&robot.path.moves[0].orientation(1.0).unwrap());
    let back = UnitQuaternion::rotation_between(&axes[0], &Vector3::z()).unwrap();
    let upright = matrix(&back) * first;
    assert!((upright - Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0))).norm() < 1e-9);
}

#[test]
fn a_direction_of_the_tool_is_held_towards_one_of_the_part() {
    let mut chance = Chance::new(11);
    let (text, axes) = leaning(&mut chance);
    let in_part = Vector3::new(2.0, 0.5, 0.1);
    for (tool_axis, of_tool) in [
        (-Vector3::z(), Vector3::x()),
        (-Vector3::z(), Vector3::new(0.3, -0.4, 0.9)),
        (-Vector3::x(), Vector3::y()),
        (Vector3::new(0.6, 0.0, 0.8), Vector3::z()),
    ] {
        let mut options = PathOptions::default();
        options.tool_axis = tool_axis;
        options.turn_about_axis = TurnAboutAxis::Towards { of_tool, in_part };
        let robot = path_of(&apt(&text), &options).unwrap();
        for (index, axis) in axes.iter().enumerate() {
            let turn = robot.path.moves[index].orientation(1.0).unwrap();
            assert!((turn * tool_axis - axis).norm() < 1e-9, "{index}");
            // The best of all turns about the axis, by brute force.
            let nearness = |by: f64| {
                let about = nalgebra::Unit::new_normalize(*axis);
                let turned = UnitQuaternion::from_axis_angle(&about, by) * turn * of_tool;
                turned.dot(&in_part)
            };
            let best = (1..720).map(|step| nearness(f64::from(step) * 0.5_f64.to_radians()));
            let own = nearness(0.0);
            assert!(best.into_iter().all(|other| other < own), "{index}");
        }
    }
}

#[test]
fn what_says_no_turn_is_refused_by_line() {
    let faults = |text: &str, options: &PathOptions| {
        let all = path_of(&apt(text), options).unwrap_err();
        all.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let over = "UNITS/MM\nGOTO/0,0,0,0,.6,.8\nGOTO/1,0,0,0,-.6,-.8\nGOTO/2,0,0\n";
    let found = faults(over, &PathOptions::default());
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("line 3: the tool's axis turns to its opposite here"));
    // In air it begins anew.
    let text = over.replace("GOTO/1", "RAPID\nGOTO/1");
    let robot = path_of(&apt(&text), &PathOptions::default()).unwrap();
    let axis = robot.path.tool_direction(1, 1.0);
    assert!((axis - Vector3::new(0.0, -0.6, -0.8)).norm() < 1e-12);
    let mut options = PathOptions::default();
    options.turn_about_axis = TurnAboutAxis::Towards {
        of_tool: Vector3::x(),
        in_part: Vector3::new(0.0, 0.6, 0.8),
    };
    let found = faults(over, &options);
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(found[2].contains("line 4: the tool's axis points along the direction"));
}

/// A program of three axes stays one of positions, whatever its axis is called.
#[test]
fn upright_axes_state_no_orientation() {
    let text = "UNITS/MM\nMULTAX\nGOTO/0,0,0,0,0,1\nGOTO/9,0,0,0,0,1\n";
    let robot = path_of(&apt(text), &PathOptions::default()).unwrap();
    assert!(!robot.axis_alone);
    assert!(
        robot
            .path
            .moves
            .iter()
            .all(|motion| motion.tool_turn.is_none())
    );
}

/// Sags, and turns the tool.
struct Bending(f64);

impl CorrectionField for Bending {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let at = |request: &Request| {
            let p = request.position_mm / 200.0;
            let turn = Vector3::new(p.z.cos(), p.x.sin(), -p.y.cos()) * self.0;
            let shift_mm = Vector3::new(p.y.sin(), (p.x + p.z).cos(), (2.0 * p.x).sin()) * 0.2;
            Ok(Correction { shift_mm, turn })
        };
        requests.iter().map(at).collect()
    }
}

/// The text of a corrected program, which keeps all promises, with its path.
fn corrected(
    language: Language,
    (name, text): (&str, &[u8]),
    reading: &ReadOptions,
    by: f64,
) -> Result<(Vec<u8>, RobotPath), String> {
    let file = SourceFile::new(name, text);
    let program = read(language, vec![file], reading).map_err(|all| all[0].to_string())?;
    let making = PathOptions::default();
    let path = path_of(&program, &making).map_err(|all| all[0].to_string())?;
    let write = |field: &dyn CorrectionField, writing: &PathWriteOptions| {
        written_and_checked((&program, &path), (reading, &making), field, writing)
    };
    let mut writing = PathWriteOptions::default();
    writing.tolerance_mm = 0.005;
    writing.chord_tolerance_mm = 0.01;
    let same = write(&NoCorrection, &writing).unwrap();
    assert!(same.bytes == text, "{name}: without a correction");
    writing.header = None;
    let written = write(&Bending(by), &writing)?;
    Ok((written.bytes, path))
}

/// The file with each language's way of stating an axis, and the same places.
fn as_sinumerik(text: &str) -> String {
    let mut made = "N10 G17 G71 G90 G94\nN20 TRAORI\nN30 ORIWKS ORIVECT\n".to_owned();
    let mut code = "G0";
    for line in text.lines() {
        if let Some(numbers) = line.strip_prefix("GOTO/") {
            let n: Vec<&str> = numbers.split(',').collect();
            let names = ["X", "Y", "Z", "A3=", "B3=", "C3="];
            let words: Vec<String> = names
                .iter()
                .zip(n)
                .map(|(a, b)| format!("{a}{b}"))
                .collect();
            made += &format!("{code} {}\n", words.join(" "));
            code = "G1 F900";
        }
    }
    made + "M30\n"
}

#[test]
fn axes_stay_or_are_turned_as_vectors() {
    let mut chance = Chance::new(3);
    let (text, _) = leaning(&mut chance);
    // Axes that hold until the next one.
    let text = format!("{text}GOTO/1,2,3\nGOTO/40,2,3\nGOTO/40,2,3,0,0,1\nGOTO/80,2,3\n");
    let sinumerik = as_sinumerik(&text);
    for (language, name, text) in [
        (Language::Apt, "a.apt", &text),
        (Language::Siemens, "a.mpf", &sinumerik),
    ] {
        for by in [0.0, 2e-3] {
            let bytes = text.as_bytes();
            let (written, path) =
                corrected(language, (name, bytes), &ReadOptions::default(), by).unwrap();
            let file = SourceFile::new(name, written.clone());
            let again = read(language, vec![file], &ReadOptions::default()).unwrap();
            let again = path_of(&again, &PathOptions::default()).unwrap();
            // Every end is there with its axis, turned as the field says.
            let mut ends = again.path.moves.iter().enumerate();
            for (index, motion) in path.path.moves.iter().enumerate() {
                let place = motion.end / 200.0;
                let turn = Vector3::new(place.z.cos(), place.x.sin(), -place.y.cos()) * by;
                let wanted =
                    UnitQuaternion::from_scaled_axis(turn) * path.path.tool_direction(index, 1.0);
                let shift = Vector3::new(
                    place.y.sin(),
                    (place.x + place.z).cos(),
                    (2.0 * place.x).sin(),
                );
                let found = ends.any(|(index, made)| {
                    let axis = again.path.tool_direction(index, 1.0);
                    (made.end - motion.end - 0.2 * shift).norm() < 2e-4
                        && (axis - wanted).norm() < 2e-6
                });
                assert!(
                    found,
                    "{name}, {by}, line {}: {}",
                    motion.line,
                    String::from_utf8_lossy(&written)
                );
            }
        }
    }
}

/// Real files whose tool leans: refused before, now corrected.
#[test]
fn real_files_that_lean_are_corrected() {
    let all = programs("apt");
    let (mut done, mut leaning) = (Vec::new(), 0);
    for (name, bytes) in &all {
        let file = SourceFile::new(name.clone(), bytes.clone());
        let Ok(program) = read_apt(vec![file], &stated()) else {
            continue;
        };
        let leans = |motion: &Motion| {
            let pose = motion.target.pose();
            pose.is_some_and(|pose| (pose.orientation * Vector3::z() - Vector3::z()).norm() > 1e-9)
        };
        if !program.motions.iter().any(leans) {
            continue;
        }
        leaning += 1;
        for by in [0.0, 2e-3] {
            match corrected(Language::Apt, (name, bytes), &stated(), by) {
                Ok((_, path)) => done.push((name, by, path.path.moves.len())),
                Err(why) => {
                    let _ = writeln!(std::io::stderr(), "{name}, {by}: {why}");
                }
            }
        }
    }
    let _ = writeln!(
        std::io::stderr(),
        "{leaning} APT files lean; corrected: {done:?}"
    );
    assert!(all.is_empty() || done.len() >= 6, "{done:?}");
}

/// Machines of five axes: the angles that made the directions come back, for each arrangement of heads and tables.
#[test]
fn rotary_axes_of_a_machine_are_turned_to_the_axis() {
    use kinetostat_program::{Carries, RotaryAxes, RotaryAxis};
    use nalgebra::{Unit, Vector3 as V};
    let axis = |letter, carries, direction: V<f64>| RotaryAxis {
        letter,
        carries,
        direction: Unit::new_normalize(direction),
        point_mm: V::new(3.0, -8.0, 20.0),
        limits_deg: None,
    };
    let (head, table) = (Carries::Tool, Carries::Part);
    let upright = UnitQuaternion::identity();
    let down = UnitQuaternion::from_axis_angle(&V::x_axis(), std::f64::consts::PI);
    for (first, second, at_zero) in [
        (axis('C', head, V::z()), axis('B', head, V::y()), upright),
        (axis('A', head, V::x()), axis('C', table, -V::z()), down),
        (axis('A', table, V::x()), axis('C', table, V::z()), down),
        // A head whose axis is inclined by 45 degrees.
        (
            axis('C', head, V::z()),
            axis('A', head, V::new(0.0, 1.0, 1.0)),
            upright,
        ),
    ] {
        let letters = [first.letter, second.letter];
        let is_45 = second.direction.y > 0.5 && second.direction.z > 0.5;
        let axes = RotaryAxes {
            axes: vec![first, second],
            tool_at_zero: at_zero,
        };
        let mut text = "UNITS/MM\nRAPID\nGOTO/0,0,50,0,0,1\nFEDRAT/600,MMPM\n".to_owned();
        let mut angles = Vec::new();
        for step in 1..60 {
            let t = f64::from(step) * 0.1;
            // The axis that leans the tool does not come back to zero.
            let (lean, around) = (25.0 + 15.0 * (0.7 * t).sin(), 130.0 * t - 40.0);
            let both = match letters {
                ['C', _] => [around, lean],
                _ => [lean, around],
            };
            // Of the tool: turned by hand, rotations one after the other.
            let turn = |index: usize| {
                let axis = &axes.axes[index];
                UnitQuaternion::from_axis_angle(&axis.direction, both[index].to_radians())
            };
            let carried = |carries| {
                (0..2).fold(UnitQuaternion::identity(), |all, index| {
                    match axes.axes[index].carries == carries {
                        true => all * turn(index),
                        false => all,
                    }
                })
            };
            let direction = carried(table).inverse() * (carried(head) * V::z());
            text += &format!(
                "GOTO/{step},0,0,{:.12},{:.12},{:.12}\n",
                direction.x, direction.y, direction.z
            );
            angles.push(both);
        }
        let mut making = PathOptions::default();
        making.rotary = Some(axes.into());
        let program = apt(&text);
        let robot = path_of(&program, &making).unwrap();
        for (index, wanted) in angles.iter().enumerate() {
            let motion = &robot.path.moves[index + 1];
            let turn = motion.tool_turn.as_ref().unwrap().rotary.as_ref().unwrap();
            // From zero it may begin the other way round; from there on it goes on.
            let away = |a: f64, b: f64| (a - b).abs();
            let first = &robot.path.moves[1].tool_turn.as_ref().unwrap().rotary;
            let begun = &first.as_ref().unwrap().end_deg;
            let same_way = (0..2).all(|i| away(begun[i], angles[0][i]) < 1e-6);
            if same_way {
                let all = (0..2).all(|i| away(turn.end_deg[i], wanted[i]) < 1e-6);
                assert!(all, "{letters:?} {index}: {:?} {wanted:?}", turn.end_deg);
            }
            let before = &turn.start_deg;
            let steps = (0..2).map(|i| away(turn.end_deg[i], before[i]));
            assert!(
                index == 0 || steps.into_iter().all(|step| step < 40.0),
                "{index}"
            );
            let axis = robot.path.tool_direction(index + 1, 1.0);
            let stated = program.motions[index + 1]
                .target
                .pose()
                .unwrap()
                .orientation
                * V::z();
            assert!((axis - stated).norm() < 1e-9, "{letters:?} {index}");
        }
        // Corrected and read again with the same axes.
        let reading = ReadOptions::default();
        let mut writing = PathWriteOptions::default();
        writing.header = None;
        written_and_checked(
            (&program, &robot),
            (&reading, &making),
            &Bending(0.0),
            &writing,
        )
        .unwrap();
        // A direction that the machine does not reach is told by line.
        if is_45 {
            let far = apt("UNITS/MM\nGOTO/0,0,0,0,0,1\nGOTO/1,0,0,0,0.1,-0.994987437\n");
            let faults = path_of(&far, &making).unwrap_err();
            assert!(
                faults[0]
                    .to_string()
                    .contains("line 3: the rotary axes of the machine do not point"),
                "{faults:?}"
            );
        }
    }
}
