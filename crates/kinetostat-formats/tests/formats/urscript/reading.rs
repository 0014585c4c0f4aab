//! Motions with what they say: ends, frames, speeds, blends, and the order of a run.

use std::f64::consts::{FRAC_PI_2, PI};

use kinetostat_formats::*;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::{errors, in_def, program, read_text, written};

const EVERYTHING: &str = include_str!("../fixtures/everything.script");

fn pose(motion: &Motion) -> &PoseTarget {
    motion.target.pose().unwrap()
}

#[test]
fn every_byte_comes_back_with_any_line_ending() {
    let crlf = EVERYTHING.replace('\n', "\r\n");
    let trimmed = EVERYTHING.trim_end().to_owned();
    let marked = format!("\u{feff}{EVERYTHING}# \u{e9}\n");
    for text in [EVERYTHING.to_owned(), crlf, trimmed, marked] {
        let program = program(&text);
        assert_eq!(written(&program, &[]), text);
        let same: Vec<Piece> = (program.motions.iter().enumerate())
            .filter(|(_, motion)| (14..25).contains(&motion.line))
            .filter_map(|(index, motion)| {
                let mut piece = Piece::to(index, motion.target.pose()?.position_mm);
                if let MotionKind::Circular { via } = &motion.kind {
                    piece.via_mm = via.pose().map(|via| via.position_mm);
                }
                Some(piece)
            })
            .collect();
        assert!(same.len() > 5);
        assert_eq!(written(&program, &same), text);
    }
}

#[test]
fn every_motion_is_found_with_what_it_says() {
    let program = program(EVERYTHING);
    let kinds: Vec<char> = (program.motions.iter())
        .map(|motion| match motion.kind {
            MotionKind::Joint => 'j',
            MotionKind::Linear => 'l',
            MotionKind::Circular { .. } => 'c',
            MotionKind::Arc { .. } => 'a',
        })
        .collect();
    let kinds: String = kinds.into_iter().collect();
    assert_eq!(kinds, "jjllllcllllllll");
    let joints = vec![0.0, -90.0, 90.0, -90.0, -90.0, 0.0];
    let Target::Joints { values_deg } = &program.motions[0].target else {
        panic!("no joints")
    };
    assert!(
        values_deg
            .iter()
            .zip(&joints)
            .all(|(own, of)| (own - of).abs() < 1e-9)
    );
    // A pose by its joints, next to others.
    let first = pose(&program.motions[1]);
    assert!((first.position_mm - Vector3::new(400.0, -100.0, 250.0)).norm() < 1e-9);
    let down = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI);
    assert!(first.orientation.angle_to(&down) < 1e-6);
    let tool = &program.motions[1].tool;
    assert_eq!(tool.name, "tcp");
    assert_eq!(
        tool.known().unwrap().translation.vector,
        Vector3::new(0.0, 0.0, 180.0)
    );
    assert_eq!(program.motions[1].work_object.name, "base");
    // In a feature, which is a quarter turn about z.
    let motion = &program.motions[3];
    assert_eq!(motion.work_object.name, "table");
    assert_eq!(pose(motion).position_mm, Vector3::new(10.0, 20.0, 0.0));
    let base = motion.base_pose().unwrap().translation.vector;
    assert!(
        (base - Vector3::new(480.0, -90.0, 100.0)).norm() < 1e-6,
        "{base}"
    );
    let speeds: Vec<Option<f64>> = program.motions.iter().map(|of| of.speed.mm_per_s).collect();
    assert_eq!(speeds[0], None);
    assert_eq!(speeds[2..4], [Some(250.0), Some(20.0)]);
    let zones: Vec<Zone> = program.motions.iter().map(|of| of.zone).collect();
    assert_eq!(
        zones[..4],
        [
            Zone::Exact,
            Zone::Radius(10.0),
            Zone::Exact,
            Zone::Radius(0.5)
        ]
    );
    let follows: Vec<Option<usize>> = program.motions.iter().map(|of| of.follows).collect();
    let wanted: Vec<Option<usize>> = (0..15_usize).map(|at| at.checked_sub(1)).collect();
    assert_eq!(follows, wanted);
    // Three passes of a loop, and two calls of a function.
    let places: Vec<f64> = program.motions[9..]
        .iter()
        .map(|of| pose(of).position_mm.x)
        .collect();
    let wanted = [400.0, 410.0, 420.0, 100.0, 130.0, 130.0];
    assert!(
        places
            .iter()
            .zip(wanted)
            .all(|(own, of)| (own - of).abs() < 1e-9),
        "{places:?}"
    );
    assert!(
        program.motions[9..12]
            .iter()
            .all(|of| of.runs == Runs::Repeatedly)
    );
    let said = |text: &str| {
        program
            .findings
            .iter()
            .any(|own| own.message.contains(text))
    };
    assert!(
        said("set_payload changes the load"),
        "{:?}",
        program.findings
    );
    assert!(said("`Grip`"), "{:?}", program.findings);
}

#[test]
fn a_time_gives_the_speed_of_a_straight_way() {
    let program = in_def(
        "movej(p[0.4,0,0.2,0,3.1,0])\nmovel(p[0.4,0.3,0.6,0,3.1,0], a=1, v=9, t=2.5)\nmovel(p[0.4,0.3,0.7,0,3.1,0],1.2,0.1,0,0)",
    );
    let speeds: Vec<Option<f64>> = program.motions.iter().map(|of| of.speed.mm_per_s).collect();
    assert!((speeds[1].unwrap() - 200.0).abs() < 1e-9);
    assert_eq!(speeds[2], Some(100.0));
}

#[test]
fn rotation_vectors_are_those_of_nalgebra() {
    for angle in [
        0.0,
        1e-12,
        1e-7,
        1e-3,
        FRAC_PI_2,
        PI - 1e-9,
        PI,
        PI + 1e-6,
        4.0,
        6.1,
    ] {
        for axis in [
            Vector3::x(),
            Vector3::new(1.0, -2.0, 0.5),
            Vector3::new(0.0, 1e-3, 1.0),
        ] {
            let [x, y, z]: [f64; 3] = (axis.normalize() * angle).into();
            let text = format!("def part():\nmovel(p[0.1,0.2,0.3,{x},{y},{z}])\nend");
            let program = program(&text);
            let found = pose(&program.motions[0]).orientation;
            let wanted = UnitQuaternion::from_scaled_axis(Vector3::new(x, y, z));
            assert!(found.angle_to(&wanted) < 1e-12);
            // What is written turns as it should, and stands near what stood there.
            let mut piece = super::moved(&program, 0, [0.0; 3]);
            let turn = UnitQuaternion::from_euler_angles(1e-4, -2e-4, 3e-4);
            piece.orientation = Some(turn * found);
            let again = super::program(&written(&program, &[piece]));
            let back = pose(&again.motions[0]).orientation;
            assert!(back.angle_to(&(turn * wanted)) < 4e-7, "{angle} {axis}");
        }
    }
}

#[test]
fn poses_are_computed_as_frames() {
    let program = in_def(
        "a=p[0.1,0.2,0.3,0,0,1.5707963267948966]\nb=p[0.01,0,0,0.5,0,0]\nmovel(pose_trans(pose_trans(a,b),p[0,0.02,0,0,0,0]))\n\
         c=pose_add(a,b)\nmovel(c)\nmovel(pose_inv(a))\nc[2]=c[2]+0.05\nmovel(c)\nmovel(interpolate_pose(a,b,0.5))\n\
         movel(p[point_dist(a,b),norm([0.3,0.4]),d2r(180)/10,sin(0.5),atan2(1,2),pow(2,-2)])",
    );
    let about = |axis: [f64; 3]| UnitQuaternion::from_scaled_axis(Vector3::from(axis));
    let frame = |place: [f64; 3], turn| {
        Isometry3::from_parts(Translation3::from(Vector3::from(place)), turn)
    };
    let a = frame([100.0, 200.0, 300.0], about([0.0, 0.0, FRAC_PI_2]));
    let b = frame([10.0, 0.0, 0.0], about([0.5, 0.0, 0.0]));
    let near = |index: usize, wanted: Isometry3<f64>| {
        let found = program.motions[index].base_pose().unwrap();
        let away = (found.translation.vector - wanted.translation.vector).norm();
        assert!(
            away < 1e-9 && found.rotation.angle_to(&wanted.rotation) < 1e-9,
            "{index} {found}"
        );
    };
    near(0, a * b * Translation3::new(0.0, 20.0, 0.0));
    near(1, frame([110.0, 200.0, 300.0], a.rotation * b.rotation));
    near(2, a.inverse());
    near(3, frame([110.0, 200.0, 350.0], a.rotation * b.rotation));
    near(
        4,
        frame([55.0, 100.0, 150.0], a.rotation.slerp(&b.rotation, 0.5)),
    );
    let far = Vector3::new(90.0_f64, 200.0, 300.0).norm();
    near(
        5,
        frame(
            [far, 500.0, 100.0 * PI],
            about([0.5_f64.sin(), 1_f64.atan2(2.0), 0.25]),
        ),
    );
}

#[test]
fn conditions_loops_and_threads_run() {
    let program = program(
        "def part():\n  n = 0\n  thread blink():\n    while True:\n      set_digital_out(1, True)\n      sync()\n    end\n  end\n  h = run blink()\n\
           while n < 4:\n    n = n + 1\n    if n == 2:\n      continue\n    elif not (n != 4):\n      break\n    else:\n      pass\n    end\n\
             movel(p[0.1*n,0,0,0,0,0])\n  end\n  if get_digital_in(3): textmsg(\"on\") end\n  while digital_in(1) == False: sync() end\n  kill h\n\
           movel(p[9,0,0,0,0,0])\nend\n",
    );
    let places: Vec<f64> = program
        .motions
        .iter()
        .map(|of| pose(of).position_mm.x.round())
        .collect();
    assert_eq!(places, [100.0, 300.0, 9000.0]);
    // Statements in no routine are the program.
    let text = "def up(z, by):\n  local p1 = p[0.5,0,z+by,0,0,0]\n  return p1\nend\ndef go():\n movel(up(by=0.1, z=0.2))\nend\ngo()\n";
    let program = super::program(text);
    assert!((pose(&program.motions[0]).position_mm.z - 300.0).abs() < 1e-9);
}

#[test]
fn what_only_the_controller_knows_is_refused_by_line_and_can_be_stated() {
    let text = "def part():\n  z = read_input_float_register(0)\n  if get_digital_in(1):\n    movel(p[0.1,0,0,0,0,0])\n  end\n\
                  movel(p[0.1,0,z,0,0,0])\n  movel(pose_trans(plane_1,p[0.1,0,0,0,0,0]))\nend\n";
    let found = read_text(text, &ReadOptions::default()).unwrap_err();
    let lines: Vec<usize> = found.iter().map(|error| error.line).collect();
    assert_eq!(lines, [3, 6], "{found:?}");
    assert!(
        found[0].to_string().contains("--set NAME=VALUE"),
        "{}",
        found[0]
    );
    assert!(
        found[1]
            .to_string()
            .contains("`read_input_float_register` is computed"),
        "{}",
        found[1]
    );
    let mut options = ReadOptions::default();
    (options.values).insert(
        "read_input_float_register".into(),
        StatedValue::Number(0.25),
    );
    options
        .values
        .insert("get_digital_in".into(), StatedValue::Truth(false));
    let program = read_text(text, &options).unwrap();
    assert_eq!(pose(&program.motions[0]).position_mm.z, 250.0);
    // A feature of the pendant is a frame that the caller states.
    assert_eq!(program.motions[1].work_object.known(), None);
    options
        .frames
        .insert("plane_1".into(), Isometry3::translation(0.0, 0.0, 40.0));
    let program = read_text(text, &options).unwrap();
    assert_eq!(
        program.motions[1].base_pose().unwrap().translation.vector.z,
        40.0
    );
    assert_eq!(program.motions[1].tool.known(), None);
    options
        .frames
        .insert("tcp".into(), Isometry3::translation(0.0, 0.0, 120.0));
    let program = read_text(text, &options).unwrap();
    assert_eq!(
        program.motions[1]
            .tool
            .known()
            .unwrap()
            .translation
            .vector
            .z,
        120.0
    );
    // Here the tool is, which nobody knows before the run.
    let found = errors("a=get_actual_tcp_pose()\nmovel(a)");
    assert!(
        found[0]
            .1
            .contains("`get_actual_tcp_pose` is computed while the program runs"),
        "{found:?}"
    );
}
