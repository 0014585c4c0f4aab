//! External axes of motions that are divided: every piece takes them along by its share of the way, as the controller does.

use kinetostat_formats::*;
use kinetostat_program::{MachineProgram, Request, Unwatched};
use kinetostat_testing::Worst;
use nalgebra::Vector3;

/// A first motion to x = 0 with the axis at 100, and a second one to x = 200 with the axis at 350, or without.
struct Case {
    language: Language,
    text: String,
    line: usize,
    names: &'static str,
}

fn rapid(first: &str, second: &str) -> Case {
    let pose = |x: f64, axis: &str| {
        format!("[[{x},0,0],[0,1,0,0],[0,0,0,0],[{axis},9E9,9E9,9E9,9E9,9E9]]")
    };
    Case {
        language: Language::Rapid,
        text: format!(
            "MODULE M\nPROC main()\nMoveL {},v20,fine,tool0;\nMoveL {},v20,fine,tool0;\nENDPROC\nENDMODULE\n",
            pose(0.0, first),
            pose(200.0, second)
        ),
        line: 4,
        names: "external axis eax_a",
    }
}

fn krl(first: &str, second: &str) -> Case {
    let pose = |x: f64, axis: &str| format!("{{X {x},Y 0,Z 0,A 0,B 0,C 180{axis}}}");
    Case {
        language: Language::Krl,
        text: format!(
            "DEF m()\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=0.02\nLIN {}\nLIN {}\nEND\n",
            pose(0.0, first),
            pose(200.0, second)
        ),
        line: 6,
        names: "external axis E1",
    }
}

fn ls(first: &str, second: &str) -> Case {
    let pose = |number: usize, x: f64, axis: &str| {
        format!(
            "P[{number}]{{\n   GP1:\n\tUF : 0, UT : 0,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {x:9.3}  mm,\tY =      .000  mm,\tZ =      .000  mm,\n\tW =   180.000 deg,\tP =      .000 deg,\tR =      .000 deg{axis}\n}};\n"
        )
    };
    Case {
        language: Language::FanucLs,
        text: format!(
            "/PROG M\n/ATTR\n/MN\n   1:L P[1] 20mm/sec FINE ;\n   2:L P[2] 20mm/sec FINE ;\n/POS\n{}{}/END\n",
            pose(1, 0.0, first),
            pose(2, 200.0, second)
        ),
        line: 5,
        names: "external axis or group axis 1",
    }
}

fn poses(first: &str, second: &str) -> Case {
    Case {
        language: Language::Poses,
        text: format!(
            "x_mm,y_mm,z_mm,external_1_mm,speed_mm_per_s\n0,0,0,{first},20\n200,0,0,{second},20\n"
        ),
        line: 3,
        names: "external axis 1",
    }
}

/// With 100 at first and 350 then.
fn moving() -> [Case; 4] {
    [
        rapid("100", "350"),
        krl(",E1 100.0", ",E1 350.0"),
        ls(",\n\tE1=   100.000 mm", ",\n\tE1=   350.000 mm"),
        poses("100", "350"),
    ]
}

fn read_case(case: &Case) -> (RobotProgram, ReadOptions) {
    let mut options = ReadOptions::default();
    options.external_axes = ExternalAxes::Carried;
    let files = vec![SourceFile::new("m.txt", case.text.as_bytes())];
    let program = read(case.language, files, &options);
    let program = program.unwrap_or_else(|found| panic!("{:?}: {found:#?}", case.language));
    (program, options)
}

/// The text with this field of corrections, mm.
fn compensated(
    (program, options): (&RobotProgram, &ReadOptions),
    field: impl Fn(&Request) -> Vector3<f64> + Sync,
) -> Result<Vec<u8>, String> {
    let path = path_of(program, &PathOptions::default()).unwrap();
    let robot = Correctable {
        program,
        path: &path,
        reading: options,
        making: &PathOptions::default(),
        writing: &WriteOptions::default(),
    };
    let mut writing = kinetostat_program::WriteOptions::default();
    writing.header = None;
    let field = |request: &Request| Ok(field(request));
    let written = robot
        .write(&field, &writing, &Unwatched)
        .map_err(|error| error.to_string())?;
    robot.verify(&written, &writing).unwrap();
    Ok(written.bytes)
}

/// A field that asks for many pieces, and moves no place along x.
fn wavy(request: &Request) -> Vector3<f64> {
    Vector3::z() * 0.2 * (request.position_mm.x / 20.0).sin()
}

#[test]
fn axes_are_shared_out_over_the_pieces_of_a_motion() {
    for case in moving() {
        let (program, options) = read_case(&case);
        let bytes = compensated((&program, &options), wavy).unwrap();
        let files = vec![SourceFile::new("m.txt", bytes)];
        let again = read(case.language, files, &options).unwrap();
        assert!(again.motions.len() > 8, "{:?}", case.language);
        let mut worst = Worst::new();
        for motion in &again.motions {
            let pose = motion.target.pose().unwrap();
            let axis = pose.external[0].unwrap();
            worst.add(axis - (100.0 + 250.0 * pose.position_mm.x / 200.0));
        }
        // Both are rounded, and the axis goes a little farther than the tool.
        assert!(worst.holds(2e-3), "{worst:?}");
        let last = again.motions.last().unwrap().target.pose().unwrap();
        assert_eq!(last.external[0], Some(350.0));
    }
}

#[test]
fn without_corrections_every_byte_stays() {
    for case in moving() {
        let (program, options) = read_case(&case);
        let bytes = compensated((&program, &options), |_| Vector3::zeros()).unwrap();
        assert_eq!(String::from_utf8(bytes).unwrap(), case.text);
    }
}

/// Where the axis is at the start is not known: the motion is refused by line once it must be divided, and not before.
#[test]
fn axes_that_come_from_nowhere_are_refused_by_line() {
    for case in [
        rapid("9E9", "350"),
        krl("", ",E1 350.0"),
        ls("", ",\n\tE1=   350.000 mm"),
        poses("", "350"),
    ] {
        let (program, options) = read_case(&case);
        let stays = compensated((&program, &options), |_| Vector3::zeros()).unwrap();
        assert_eq!(String::from_utf8(stays).unwrap(), case.text);
        let refused = compensated((&program, &options), wavy).unwrap_err();
        let wanted = format!("line {}: {} may move with it", case.line, case.names);
        assert!(refused.contains(&wanted), "{refused}");
        assert!(
            refused.contains("state the axis in the motion before, too"),
            "{refused}"
        );
    }
}

/// An axis that no motion moves, or that the text leaves out behind a place that it knows, is written as it is.
#[test]
fn axes_that_stay_are_copied() {
    for (case, kept) in [
        (rapid("100", "100"), "[100,9E9"),
        (rapid("100", "9E9"), "[9E9,9E9"),
        (krl(",E1 100.0", ",E1 100"), "E1 100}"),
        (krl(",E1 100.0", ""), "C 180}"),
    ] {
        let (program, options) = read_case(&case);
        let bytes = compensated((&program, &options), wavy).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.matches(kept).count() > 8, "{text}");
    }
}

/// Behind a joint motion that states them the axes are known in RAPID and KRL, behind an axis that moves alone they are not.
#[test]
fn joint_motions_say_where_axes_are() {
    let mut case = rapid("9E9", "350");
    let second = case.text.rfind("MoveL").unwrap();
    case.text.insert_str(
        second,
        "MoveAbsJ [[0,0,0,0,0,0],[100,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\nMoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\n",
    );
    let (program, options) = read_case(&case);
    let bytes = compensated((&program, &options), wavy).unwrap();
    assert!(String::from_utf8(bytes).unwrap().contains("[350,9E9"));

    for moves in [
        "MoveExtJ j1,v10,fine",
        "EOffsSet [100,0,0,0,0,0]",
        "EOffsOn j1",
        "EOffsOff",
    ] {
        let mut case = rapid("100", "350");
        let second = case.text.rfind("MoveL").unwrap();
        case.text.insert_str(second, &format!("{moves};\n"));
        let (program, options) = read_case(&case);
        let refused = compensated((&program, &options), wavy).unwrap_err();
        assert!(
            refused.contains("line 5: external axis eax_a may move"),
            "{refused}"
        );
    }
}

/// On a circle the axes go by the length of the way on it; the places between the ends get those of halfway.
#[test]
fn axes_go_evenly_round_a_circle() {
    let pose = |x: f64, y: f64, axis: f64| {
        format!("[[{x},{y},0],[0,1,0,0],[0,0,0,0],[{axis},9E9,9E9,9E9,9E9,9E9]]")
    };
    let text = format!(
        "MODULE M\nPROC main()\nMoveL {},v20,fine,tool0;\nMoveC {},{},v20,fine,tool0;\nENDPROC\nENDMODULE\n",
        pose(-100.0, 0.0, 0.0),
        pose(0.0, 100.0, 90.0),
        pose(100.0, 0.0, 180.0)
    );
    let case = Case {
        language: Language::Rapid,
        text,
        line: 4,
        names: "external axis eax_a",
    };
    let (program, options) = read_case(&case);
    let bytes = compensated((&program, &options), wavy).unwrap();
    let files = vec![SourceFile::new("m.txt", bytes)];
    let again = read_rapid(files, &options).unwrap();
    assert!(again.motions.len() > 8);
    let mut worst = Worst::new();
    for motion in &again.motions {
        let via = match &motion.kind {
            MotionKind::Circular { via } => via.pose(),
            _ => None,
        };
        for pose in via.into_iter().chain(motion.target.pose()) {
            let place = pose.position_mm;
            let angle_deg = 180.0 - place.y.atan2(place.x).to_degrees();
            worst.add(pose.external[0].unwrap() - angle_deg);
        }
    }
    assert!(worst.holds(2e-3), "{worst:?}");
}

/// Without shares the lengths of the pieces count; shares that are none are refused.
#[test]
fn pieces_of_a_caller() {
    let case = rapid("100", "350");
    let (program, _) = read_case(&case);
    let to = |x: f64| Piece::to(1, Vector3::new(x, 0.0, 0.0));
    let all = [to(50.0), to(200.0)];
    let written = write(&program, &all, &WriteOptions::default()).unwrap();
    let text = String::from_utf8(written[0].1.clone()).unwrap();
    assert!(text.contains("[162.500,9E9"), "{text}");
    for share in [f64::NAN, 2.0, -0.1] {
        let mut all = all.clone();
        for piece in &mut all {
            piece.share = Some(share);
        }
        let refused = write(&program, &all, &WriteOptions::default()).unwrap_err();
        assert!(refused.to_string().contains("state the share"), "{refused}");
    }
}

/// The poses before do not state where the axis stands.
#[test]
fn an_axis_that_is_first_stated_in_the_middle_is_refused_as_one_that_moves() {
    for (case, moves) in [
        (rapid("9E9", "350"), true),
        (krl("", ",E1 350.0"), true),
        // Positions of TP programs state all that there is, others nothing.
        (ls("", ",\n\tE1=   350.000 mm"), false),
        // Arms without external axes state zeros here and there.
        (rapid("9E9", "0"), false),
        (krl("", ",E1 0.0"), false),
        (krl(",E1 350.0", ""), false),
        (krl(",E1 350.0", ",E1 350.0"), false),
    ] {
        let files = vec![SourceFile::new("m.txt", case.text.as_bytes())];
        let found = read(case.language, files, &ReadOptions::default());
        match (moves, found) {
            (false, found) => assert!(found.is_ok(), "{found:?}"),
            (true, found) => {
                let faults = found.unwrap_err();
                assert_eq!(faults[0].line, case.line, "{faults:?}");
                let reason = &faults[0].reason;
                let words = format!("{} goes to 350, and the poses before do not", case.names);
                assert!(reason.starts_with(&words), "{faults:?}");
            }
        }
    }
}
