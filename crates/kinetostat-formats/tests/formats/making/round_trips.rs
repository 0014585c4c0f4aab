//! G-code to each language and back: the same moves, places to 1e-6 mm, orientations to 1e-9 rad, feeds equal.

use kinetostat_formats::*;
use kinetostat_program::{MoveKind, Program, ReadOptions as Reading, interpret};
use kinetostat_testing::Worst;

use super::{ROBOTS, cell, gcode, made, read_made, text_of, turned};

const POCKET: &str = "%\nG21 G90 (a pocket)\nT1 M6\nS8000 M3\nG0 X-12.3456789 Y7.1 Z25\nG0 Z2\nM8\nG1 Z-1.5 F600\n\
    X33.333333333 Y-8.25 F1260\nG3 X43.333333333 Y1.75 I0 J10\nG1 X20\nG2 X10 Y11.75 R10\nG1 X0 Y0\nG0 Z25\nM9\nM5\nM30\n%\n";

#[test]
fn programs_for_robots_go_along_the_path() {
    let (_, path) = gcode(POCKET);
    for (into, language) in ROBOTS {
        let made = made(POCKET, &cell(), into);
        let program = read_made(&made, language);
        let mut making = PathOptions::default();
        making.rapid_from_mm_per_s = Some(200.0);
        let again = path_of(&program, &making).unwrap();
        assert_eq!(again.path.moves.len(), path.moves.len(), "{into:?}");
        let (mut places, mut turns, mut feeds, mut between) = (
            Worst::default(),
            Worst::default(),
            Worst::default(),
            Worst::default(),
        );
        for (index, (one, other)) in path.moves.iter().zip(&again.path.moves).enumerate() {
            assert_eq!(one.kind, other.kind, "{into:?} {index}");
            places.add((one.end - other.end).norm());
            turns.add(other.orientation(1.0).unwrap().angle_to(&turned()));
            if one.kind == MoveKind::Feed {
                let [one, other] = [one, other].map(|m| m.feed_mm_per_minute(0.0).unwrap());
                feeds.add((one / other - 1.0).abs());
            }
            if index > 0 {
                for share in [0.2, 0.5, 0.8] {
                    between.add((one.point(share) - other.point(share)).norm());
                }
            }
        }
        assert!(
            places.value() < 1e-6 && between.value() < 1e-5,
            "{into:?} {places:?} {between:?}"
        );
        assert!(
            turns.value() < 3e-8 && feeds.value() < 1e-9,
            "{into:?} {turns:?} {feeds:?}"
        );
        // What `make` itself measured, with an angle that is exact for small ones.
        assert!(
            made.kept.orientation_rad < 1e-9 && made.kept.position_mm < 1e-6,
            "{:?}",
            made.kept
        );
        assert_eq!((made.kept.moves, made.kept.motions), (9, 9));
    }
}

#[test]
fn the_made_programs_look_like_those_of_their_controllers() {
    let mut template = cell();
    template.program_name = "pocket".into();
    template.base.number = Some(3);
    template.tool.frame.number = Some(2);
    let krl = made(POCKET, &template, MakeLanguage::Krl);
    assert_eq!(krl.files[0].0, "pocket.src");
    let text = text_of(&krl, 0);
    assert!(text.starts_with("&ACCESS RVP\nDEF pocket( )\n"));
    for line in [
        "BAS(#INITMOV,0)\n",
        "$BASE=BASE_DATA[3]\n$TOOL=TOOL_DATA[2]\n",
        "; line 4: S8000 M3\n",
        "$VEL.CP=0.021\n",
        "CIRC {X ",
        "\nEND\n",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    let rapid = text_of(&made(POCKET, &template, MakeLanguage::Rapid), 0);
    assert!(rapid.starts_with("MODULE pocket\n"), "{rapid}");
    for line in [
        "ConfL\\Off;\n",
        "CONST speeddata vFeed1:=[10,500,5000,1000];\n",
        "MoveC [[",
        "fine,tool2\\WObj:=wobj3;\n",
        "! line 7: M8\n",
    ] {
        assert!(rapid.contains(line), "{line}: {rapid}");
    }
    let ls = made(POCKET, &template, MakeLanguage::FanucLs);
    assert_eq!(ls.files[0].0, "pocket.ls");
    let ls = text_of(&ls, 0);
    assert!(ls.starts_with("/PROG  POCKET\n/ATTR\n"), "{ls}");
    for line in [
        "UFRAME_NUM=3 ;\n",
        "L P[2] 200mm/sec FINE    ;\n",
        "L P[3] 10mm/sec CNT20",
        "C P[5]    \n    :  P[6] 21mm/sec CNT20    ;\n",
        "UF : 3, UT : 2,\t\tCONFIG : 'N U T, 0, 0, 0'",
    ] {
        assert!(ls.contains(line), "{line}: {ls}");
    }
}

#[test]
fn poses_and_configurations_of_the_template_are_written() {
    let mut template = cell();
    template.base.pose = Some(nalgebra::Isometry3::translation(800.0, -20.5, 400.0));
    template.tool.frame.pose = Some(nalgebra::Isometry3::translation(0.0, 0.0, 187.25));
    template.acceleration_m_per_s2 = Some(2.5);
    template.rapids = Rapids::Joint;
    template.start_joints_deg = Some(vec![0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    for (into, language, configuration, written) in [
        (MakeLanguage::Krl, Language::Krl, "S 2, T 35", ",S 2, T 35}"),
        (
            MakeLanguage::Rapid,
            Language::Rapid,
            "[0,-1,0,0]",
            "],[0,-1,0,0],[9E9",
        ),
        (
            MakeLanguage::FanucLs,
            Language::FanucLs,
            "F U T, 0, 0, 1",
            "CONFIG : 'F U T, 0, 0, 1'",
        ),
    ] {
        template.configuration = Some(configuration.into());
        let made = made(POCKET, &template, into);
        assert!(text_of(&made, 0).contains(written), "{}", text_of(&made, 0));
        let program = read_made(&made, language);
        assert_eq!(program.motions.len(), 10);
        // The motion to the joint values goes along nothing of the path, and stands where the first move begins.
        assert_eq!(made.parts.len(), program.motions.len());
        assert_eq!(made.parts[0], (made.parts[1].0, [0.0, 0.0]));
        assert_eq!(made.parts[1].1, [0.0, 1.0]);
        assert!(
            matches!(&program.motions[0].target, Target::Joints { values_deg } if values_deg[1] == -90.0)
        );
        if into != MakeLanguage::FanucLs {
            let motion = &program.motions[3];
            assert_eq!(motion.work_object.known(), template.base.pose.as_ref());
            assert_eq!(motion.tool.known(), template.tool.frame.pose.as_ref());
            assert!(program.findings.is_empty(), "{:?}", program.findings);
        }
    }
}

#[test]
fn tables_and_apt_hold_the_same_places() {
    let (_, path) = gcode(POCKET);
    let csv = made(POCKET, &cell(), MakeLanguage::Csv);
    let text = text_of(&csv, 0);
    let rows: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(rows[0], "x_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_per_s,rapid");
    assert!(
        rows[1].starts_with("-12.345679,7.100000,25.000000,"),
        "{}",
        rows[1]
    );
    assert!(rows[1].ends_with(",200,1") && rows[3].ends_with(",10,0"));
    assert!(csv.findings.iter().any(|finding| {
        finding
            .message
            .contains("2 arcs, here first, are followed by")
    }));
    let apt = made(POCKET, &cell(), MakeLanguage::Apt);
    assert!(apt.kept.chord_mm > 1e-4 && apt.kept.chord_mm < 1.01e-3);
    let program = read_made(&apt, Language::Apt);
    let last = program
        .motions
        .last()
        .unwrap()
        .target
        .pose()
        .unwrap()
        .position_mm;
    assert!((last - path.moves.last().unwrap().end).norm() < 1e-6);
    assert!(text_of(&apt, 0).contains("FEDRAT/1260,MMPM\n"));
}

#[test]
fn g_code_to_a_robot_and_back_is_the_same_path() {
    let (_, path) = gcode(POCKET);
    let made_for_krl = made(POCKET, &cell(), MakeLanguage::Krl);
    let program = read_made(&made_for_krl, Language::Krl);
    let mut making = PathOptions::default();
    making.rapid_from_mm_per_s = Some(200.0);
    // The tool leans in its frame so that it stands upright in the part.
    making.tool_axis = turned().inverse() * nalgebra::Vector3::z();
    let robot = path_of(&program, &making).unwrap();
    let back = make(
        &robot.path,
        &events_of_robot(&program),
        &Template::default(),
        MakeLanguage::Gcode,
    )
    .unwrap();
    let text = text_of(&back, 0);
    assert!(
        text.contains("(; line 4: S8000 M3)") || text.contains("S8000 M3"),
        "{text}"
    );
    let program = Program::read(text.clone()).unwrap();
    let again = interpret(&program, &Reading::default()).unwrap();
    assert_eq!(again.moves.len(), path.moves.len());
    let mut worst = Worst::default();
    for (one, other) in path.moves.iter().zip(&again.moves) {
        assert_eq!(one.kind, other.kind, "{text}");
        worst.add((one.end - other.end).norm());
        worst.add(
            1e-1 * (one.point(0.5) - other.point(0.5)).norm() * f64::from(u8::from(one.line > 5)),
        );
        if let (Some(one), Some(other)) =
            (one.feed_mm_per_minute(0.0), other.feed_mm_per_minute(0.0))
        {
            worst.add(1e-4 * (one / other - 1.0).abs());
        }
    }
    assert!(worst.value() < 2e-6, "{worst:?}");
}

#[test]
fn fewer_decimals_are_said() {
    let mut template = cell();
    template.position_decimals = 3;
    template.angle_decimals = 3;
    let made = made(POCKET, &template, MakeLanguage::Krl);
    assert!(made.kept.position_mm > 1e-4 && made.kept.position_mm < 1e-3);
    let said = |words: &str| {
        made.findings
            .iter()
            .any(|finding| finding.message.contains(words))
    };
    assert!(said("3 decimals of lengths move places by up to "));
    assert!(said("the decimals of orientations turn the tool by up to "));
}

#[test]
fn feeds_of_a_pendant_are_rounded_and_it_is_said() {
    let text = POCKET.replace("F1260", "F127");
    let made = made(&text, &cell(), MakeLanguage::FanucLs);
    assert!((made.kept.speed_relative - (1.0 - 2.1 / (127.0 / 60.0))).abs() < 1e-12);
    assert!(
        made.findings
            .iter()
            .any(|f| f.message.contains("feeds are rounded by up to 0.79 %")),
        "{:?}",
        made.findings
    );
    let mut exact = cell();
    exact.speed_decimals = Some(9);
    assert!(
        super::made(&text, &exact, MakeLanguage::FanucLs)
            .kept
            .speed_relative
            < 1e-8
    );
}

/// Decimals of speeds are of mm/s in every language, KRL's metres too; a speed of which they leave nothing is refused by line.
#[test]
fn slow_feeds_keep_a_speed() {
    let mut cell = cell();
    cell.speed_decimals = Some(1);
    let text = POCKET.replace("F1260", "F127");
    let made = super::made(&text, &cell, MakeLanguage::Krl);
    let said = text_of(&made, 0);
    assert!(said.contains("$VEL.CP=0.0021\n"), "{said}");
    cell.speed_decimals = Some(0);
    let slow = POCKET.replace("F1260", "F20");
    for language in [MakeLanguage::Krl, MakeLanguage::Rapid] {
        let (program, path) = gcode(&slow);
        let events = events_of_gcode(&program, &path);
        let faults = make(&path, &events, &cell, language).unwrap_err();
        assert!(
            faults.iter().any(|f| f.line.is_some()
                && f.reason
                    .contains("with 0 decimals its speed of 0.333333333 mm/s would be 0")),
            "{faults:?}"
        );
    }
}
