//! From the language of one robot to that of another.

use kinetostat_formats::*;
use kinetostat_testing::Worst;
use nalgebra::Vector3;

use super::{ROBOTS, read_made, text_of};

const RAPID: &str = "MODULE M\nPERS wobjdata table:=[FALSE,TRUE,\"\",[[500,0,300],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\nPROC main()\n\
    MoveJ [[0,0,50],[0.02,0.8,-0.59,0.1],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tool0\\WObj:=table;\n\
    SetDO doSpindle,1;\n! groove\n\
    MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0\\WObj:=table;\n\
    CirPathMode\\ObjectFrame; MoveC [[5,5,0],[0,0.9961947,0,0.0871557],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],\
    [[10,0,0],[0,0.9848078,0,0.1736482],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0\\WObj:=table;\nENDPROC\nENDMODULE\n";

#[test]
fn a_program_of_abb_runs_on_others() {
    let text = RAPID.replace("[0.02,0.8,-0.59,0.1]", "[0,0.8,-0.6,0]");
    let program = read_rapid(
        vec![SourceFile::new("m.mod", text)],
        &ReadOptions::default(),
    )
    .unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    for (into, language) in ROBOTS {
        let made = make_of_robot(&program, &robot, &Template::default(), into).unwrap();
        assert!(
            made.kept.orientation_rad < 1e-9 && made.kept.position_mm < 1e-6,
            "{into:?} {:?}",
            made.kept
        );
        let again = read_made(&made, language);
        assert_eq!(again.motions.len(), 3);
        let (mut places, mut turns) = (Worst::default(), Worst::default());
        for (one, other) in program.motions.iter().zip(&again.motions) {
            let [one, other] = [one, other].map(|motion| motion.target.pose().unwrap());
            places.add((one.position_mm - other.position_mm).norm());
            turns.add(one.orientation.angle_to(&other.orientation));
        }
        assert!(places.value() < 1e-6 && turns.value() < 3e-8);
        let MotionKind::Circular { via } = &again.motions[2].kind else {
            panic!("{:?}", again.motions[2]);
        };
        assert!((via.pose().unwrap().position_mm - Vector3::new(5.0, 5.0, 0.0)).norm() < 1e-6);
        let text = text_of(&made, 0);
        assert!(
            text.contains("line 5: SetDO doSpindle,1") && text.contains("line 6: ! groove"),
            "{text}"
        );
        assert!(
            made.findings
                .iter()
                .any(|f| f.message.starts_with("other statements: 1 line "))
        );
    }
}

#[test]
fn work_object_and_tool_keep_pose_number_and_name() {
    let text = RAPID.replace("[0.02,0.8,-0.59,0.1]", "[0,0.8,-0.6,0]");
    let program = read_rapid(
        vec![SourceFile::new("m.mod", text)],
        &ReadOptions::default(),
    )
    .unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let text = |into| {
        text_of(
            &make_of_robot(&program, &robot, &Template::default(), into).unwrap(),
            0,
        )
    };
    assert!(text(MakeLanguage::Krl).contains("$BASE={X 500.000000,Y 0.000000,Z 300.000000,"));
    assert!(
        text(MakeLanguage::Rapid)
            .contains("PERS wobjdata table:=[FALSE,TRUE,\"\",[[500.000000,0.000000,300.000000],")
    );
    let ls = "/PROG  PART\n/ATTR\nLINE_COUNT\t= 4;\n/MN\n   1:  UFRAME_NUM=3 ;\n   2:  UTOOL_NUM=2 ;\n   3:J P[1] 10% FINE ;\n   4:L P[2] 20mm/sec FINE ;\n\
        /POS\nP[1]{\n   GP1:\n\tUF : 3, UT : 2,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = 1 mm,\tY = 2 mm,\tZ = 3 mm,\n\tW = 180 deg,\tP = 0 deg,\tR = 0 deg\n};\n\
        P[2]{\n   GP1:\n\tUF : 3, UT : 2,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = 9 mm,\tY = 2 mm,\tZ = 3 mm,\n\tW = 180 deg,\tP = 0 deg,\tR = 0 deg\n};\n/END\n";
    let program = read_ls(
        vec![SourceFile::new("part.ls", ls)],
        &ReadOptions::default(),
    )
    .unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let krl = text_of(
        &make_of_robot(&program, &robot, &Template::default(), MakeLanguage::Krl).unwrap(),
        0,
    );
    assert!(
        krl.contains("$BASE=BASE_DATA[3]\n$TOOL=TOOL_DATA[2]\n"),
        "{krl}"
    );
}

#[test]
fn what_does_not_run_once_is_refused() {
    let text = RAPID
        .replace("[0.02,0.8,-0.59,0.1]", "[0,0.8,-0.6,0]")
        .replace("! groove\n", "! groove\nFOR i FROM 1 TO 2 DO\n")
        .replace("ENDPROC", "ENDFOR\nENDPROC");
    let program = read_rapid(
        vec![SourceFile::new("m.mod", text)],
        &ReadOptions::default(),
    )
    .unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let found =
        make_of_robot(&program, &robot, &Template::default(), MakeLanguage::Krl).unwrap_err();
    assert_eq!(
        found.iter().map(|fault| fault.line).collect::<Vec<_>>(),
        [Some(8), Some(9)]
    );
    assert!(found[0].to_string().starts_with(
        "line 8: the motion is in a loop, or in a routine that is called more than once; write"
    ));
}

/// The world frame and the flange have the number 0, nobody sets them, and nothing else has that number.
#[test]
fn frames_of_number_0_are_those_of_the_controller() {
    let krl = |base: &str| {
        let text = format!(
            "DEF m()\n$BASE={base}\n$TOOL=$NULLFRAME\n$VEL.CP=0.02\nPTP {{X 0,Y 0,Z 0,A 0,B 0,C 180}}\nLIN {{X 9,Y 0,Z 0,A 0,B 0,C 180}}\nEND\n"
        );
        let files = vec![SourceFile::new("m.src", text)];
        let program = read_krl(files, &ReadOptions::default()).unwrap();
        let robot = path_of(&program, &PathOptions::default()).unwrap();
        move |template: &Template, into| make_of_robot(&program, &robot, template, into)
    };
    let world = krl("$NULLFRAME");
    let made = world(&Template::default(), MakeLanguage::FanucLs).unwrap();
    let text = text_of(&made, 0);
    assert!(
        text.contains("UFRAME_NUM=0 ;")
            && text.contains("UTOOL_NUM=0 ;")
            && text.contains("UF : 0, UT : 0,"),
        "{text}"
    );
    let said = |made: &Made, part: &str| made.findings.iter().any(|f| f.message.contains(part));
    assert!(said(
        &made,
        "user frame 0 is the world frame of the robot, which cannot be set"
    ));
    assert!(!said(&made, "set it there"));
    let text = text_of(
        &world(&Template::default(), MakeLanguage::Rapid).unwrap(),
        0,
    );
    assert!(
        !text.contains("PERS wobjdata") && text.contains("wobj0"),
        "{text}"
    );

    let elsewhere = krl("{X 100,Y 0,Z 0,A 0,B 0,C 0}");
    let made = elsewhere(&Template::default(), MakeLanguage::FanucLs).unwrap();
    assert!(text_of(&made, 0).contains("UFRAME_NUM=1 ;"));
    let six = "user frame 1 is that of the controller: set it there to X 100.000000, Y 0.000000, Z 0.000000 mm, W 0.00000000, P 0.00000000, R 0.00000000 deg, as it was stated in the robot's axes";
    assert!(said(&made, six), "{:?}", made.findings);
    assert!(!said(&made, "tool frame"), "{:?}", made.findings);
    let mut template = Template::default();
    template.base.number = Some(0);
    template.base.pose = Some(nalgebra::Isometry3::translation(100.0, 0.0, 0.0));
    for (language, refused) in [
        (MakeLanguage::FanucLs, true),
        (MakeLanguage::Rapid, true),
        (MakeLanguage::Krl, false),
    ] {
        match (elsewhere(&template, language), refused) {
            (Err(found), true) => assert!(
                found[0]
                    .to_string()
                    .contains("the base has the number 0, which is the world frame"),
                "{found:?}"
            ),
            (found, refused) => assert!(found.is_ok() && !refused, "{found:?}"),
        }
    }
}

/// Two tools whose names end in 0 and 1: only the flange has the number 0 at FANUC.
#[test]
fn a_tool_named_0_gets_a_free_number() {
    let tool = |name: &str, z: f64| {
        format!(
            "PERS tooldata {name}:=[TRUE,[[0,0,{z}],[1,0,0,0]],[2,[0,0,50],[1,0,0,0],0,0,0]];\n"
        )
    };
    let line = |x: f64, name: &str| {
        format!(
            "MoveL [[{x},0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,{name};\n"
        )
    };
    let text = format!(
        "MODULE M\n{}{}PROC main()\n{}{}{}{}ENDPROC\nENDMODULE\n",
        tool("mill0", 100.0),
        tool("mill1", 200.0),
        line(0.0, "mill0"),
        line(9.0, "mill0"),
        line(0.0, "mill1"),
        line(9.0, "mill1"),
    );
    let files = vec![SourceFile::new("m.mod", text)];
    let program = read_rapid(files, &ReadOptions::default()).unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let made = make_of_robot(
        &program,
        &robot,
        &Template::default(),
        MakeLanguage::FanucLs,
    )
    .unwrap();
    let text = text_of(&made, 0);
    assert!(
        text.contains("UTOOL_NUM=2 ;")
            && text.contains("UTOOL_NUM=1 ;")
            && !text.contains("UT : 0"),
        "{text}"
    );
}

/// An arm on a track stands elsewhere: what the made program leaves out is named.
#[test]
fn external_axes_that_are_left_out_are_named() {
    let at = |first: &str, then: &str| {
        let text = RAPID.replace("[0.02,0.8,-0.59,0.1]", "[0,0.8,-0.6,0]");
        let text = text.replacen("[9E9,", &format!("[{first},"), 1);
        text.replace(
            "[[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,",
            &format!("[[0,0,0],[0,1,0,0],[0,0,0,0],[{then},"),
        )
    };
    let mut options = ReadOptions::default();
    options.external_axes = ExternalAxes::Carried;
    for (text, words) in [
        (
            at("500", "500"),
            Some("line 4: external axis eax_a stands at 500"),
        ),
        (
            at("0", "500"),
            Some("line 7: external axis eax_a moves along"),
        ),
        (at("0", "0"), None),
        (at("9E9", "9E9"), None),
    ] {
        let program = read_rapid(vec![SourceFile::new("m.mod", text)], &options).unwrap();
        let robot = path_of(&program, &PathOptions::default()).unwrap();
        let made =
            make_of_robot(&program, &robot, &Template::default(), MakeLanguage::Krl).unwrap();
        let said = made.findings.iter();
        let said = said.map(|found| format!("line {}: {}", found.line.unwrap_or(0), found.message));
        let said: Vec<String> = said.filter(|text| text.contains("external axis")).collect();
        match words {
            Some(words) => assert!(said.len() == 1 && said[0].contains(words), "{said:?}"),
            None => assert!(said.is_empty(), "{said:?}"),
        }
    }
}

/// Every controller turns the tool from point to point by its own law: it stands as in the source between the points, too, or the angle is
/// named.
#[test]
fn the_tool_turns_as_in_the_source_between_points() {
    let krl = "DEF ori()\n$BASE={X 1800,Y 50,Z 900,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 180,A 0,B 0,C 0}\n$VEL.CP=0.15\n\
        PTP {X 0,Y 0,Z 10,A 0,B 0,C 180}\nLIN {X 100,Y 0,Z 10,A 70,B 30,C -160}\nLIN {X 100,Y 50,Z 10,A 0,B -20,C 150}\nEND\n";
    let rapid = "MODULE M\nPROC main()\n\
        MoveJ [[0,0,50],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;\n\
        MoveL [[9,0,0],[0.2,0.8,-0.55,0.13],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;\n\
        MoveL [[9,0,40],[0.3,0.7,0.5,-0.4],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\n\
        ENDPROC\nENDMODULE\n"
        .replace("[0.2,0.8,-0.55,0.13]", "[0.2012,0.8048,-0.5533,0.0704]")
        .replace("[0.3,0.7,0.5,-0.4]", "[0.3,0.7071,0.5,-0.3999]");
    for (from, text) in [(Language::Krl, krl), (Language::Rapid, rapid.as_str())] {
        let files = vec![SourceFile::new("source", text)];
        let program = read(from, files, &ReadOptions::default()).unwrap();
        let source = path_of(&program, &PathOptions::default()).unwrap().path;
        for (into, language) in ROBOTS {
            let made = super::of_robot(from, text, into);
            let again = read_made(&made, language);
            let made_path = path_of(&again, &PathOptions::default()).unwrap().path;
            assert_eq!(made.parts.len(), made_path.moves.len());
            let mut worst = Worst::default();
            for (motion, (index, [from, to])) in made_path.moves.iter().zip(&made.parts).skip(1) {
                for share in [0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0] {
                    let own = motion.orientation(share).unwrap();
                    let wanted = source.moves[*index].orientation(from + (to - from) * share);
                    worst.add(own.angle_to(&wanted.unwrap()).to_degrees());
                }
            }
            // 0.01 deg is stated; some of the digits.
            assert!(worst.value() < 0.0101, "{from:?} {into:?}: {worst:?}");
            let same = (from == Language::Krl) == (language == Language::Krl);
            assert_eq!(made_path.moves.len() == 3, same, "{from:?} {into:?}");
            assert_eq!(
                super::found(&made, "2 moves, here first, are divided into"),
                !same
            );
        }
    }
    // A circle stays one, and what it has otherwise is named with its line.
    let circle = krl.replace(
        "LIN {X 100,Y 0,Z 10,A 70,B 30,C -160}",
        "CIRC {X 50,Y 30,Z 10,A 0,B 0,C 180},{X 100,Y 0,Z 10,A 70,B 30,C -160}",
    );
    let made = super::of_robot(Language::Krl, &circle, MakeLanguage::Rapid);
    let named = made.findings.iter().find(|finding| {
        finding
            .message
            .starts_with("between the points the tool stands up to ")
    });
    assert_eq!(
        named.and_then(|finding| finding.line),
        Some(6),
        "{:?}",
        made.findings
    );
}
