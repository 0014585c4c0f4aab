//! Speeds that a motion states for itself (WITH), and those of spline blocks.

use kinetostat_formats::*;
use kinetostat_program::{Request, WriteOptions as PathWriteOptions};
use nalgebra::Vector3;

use super::{main_with, written};
use crate::correcting::written_and_checked;
use crate::paths::corrected;

const FRAMES: &str = "$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}";
const DATA: &str = "DECL POS XP1={X 100,Y 0,Z 5,A 0,B 0,C 180}\nDECL FDAT FP1={TOOL_NO 1,BASE_NO 0,IPO_FRAME #BASE}\nDECL LDAT LCPDAT1={VEL 2,ACC 100,APO_DIST 3,ORI_TYP #VAR}";

/// The first motion at 1.15 of its speed: what stands where it was.
fn faster(statements: &str) -> String {
    let program = main_with(DATA, statements);
    let mut piece = Piece::to(0, Vector3::new(100.0, 0.0, 5.0));
    piece.speed_factor = 1.15;
    written(&program, &[piece])
}

#[test]
fn another_speed_is_written_where_the_motion_states_its_own() {
    for (statements, expected) in [
        (
            "$VEL.CP=0.5\nSLIN XP1 WITH $VEL.CP = 0.02, $ACC.CP=1 C_SPL",
            "$VEL.CP=0.5\nSLIN XP1 WITH $VEL.CP = 0.023, $ACC.CP=1 C_SPL\n",
        ),
        // The same as in force: it still counts.
        (
            "$VEL.CP=0.02\nSLIN XP1 WITH $VEL.CP=0.02",
            "$VEL.CP=0.02\nSLIN XP1 WITH $VEL.CP=0.023\n",
        ),
        (
            "SLIN XP1 WITH $VEL = SVEL_CP(0.02, , LCPDAT1), $TOOL = STOOL2(FP1), $APO = SAPO(LCPDAT1) C_Spl",
            "SLIN XP1 WITH $VEL = SVEL_CP(0.023, , LCPDAT1), $TOOL = STOOL2(FP1), $APO = SAPO(LCPDAT1) C_Spl\n",
        ),
        (
            "SLIN XP1 WITH $VEL={CP 0.02,ORI1 200,ORI2 200},$VEL.ORI1=100",
            "SLIN XP1 WITH $VEL={CP 0.023,ORI1 200,ORI2 200},$VEL.ORI1=100\n",
        ),
        // Others in its list say nothing of the speed: it is that of before.
        (
            "$VEL.CP=0.02\nSLIN XP1 WITH $VEL.ORI1=100,$ACC.CP=1\nLIN {X 0}",
            "$VEL.CP=0.02\n$VEL.CP=0.023\nSLIN XP1 WITH $VEL.ORI1=100,$ACC.CP=1\n$VEL.CP=0.02\nLIN {X 0}\n",
        ),
        (
            "SPLINE WITH $VEL.CP=0.2\n  SLIN XP1\n  SLIN {X 0}\nENDSPLINE",
            "SPLINE WITH $VEL.CP=0.2\n  SLIN XP1 WITH $VEL.CP=0.23\n  SLIN {X 0}\nENDSPLINE\n",
        ),
        (
            "SPLINE WITH $VEL=SVEL_CP(0.2, , LCPDAT1)\n  SLIN XP1 WITH $ACC.CP=1 ; cut\nENDSPLINE",
            "  SLIN XP1 WITH $VEL.CP=0.23,$ACC.CP=1 ; cut\nENDSPLINE\n",
        ),
        (
            "$VEL.CP=0.2\nSPLINE\n  SLIN XP1 WITH $VEL.CP=0.1\nENDSPLINE",
            "SPLINE\n  SLIN XP1 WITH $VEL.CP=0.115\nENDSPLINE\n",
        ),
    ] {
        let text = faster(statements);
        assert!(text.contains(expected), "{statements}:\n{text}");
    }
}

/// A list holds for its motion alone, that of a block for the block: then what was in force is in force again.
#[test]
fn with_holds_for_its_motion_or_its_block() {
    let program = main_with(
        DATA,
        "BAS(#TOOL,0)\n$BASE=$NULLFRAME\n$VEL.CP=0.5\n$APO.CDIS=7\n\
         SLIN XP1 WITH $VEL.CP=0.1,$APO.CDIS=2,$TOOL={X 0,Y 0,Z 9,A 0,B 0,C 0},$BASE={X 4,Y 0,Z 0,A 0,B 0,C 0} C_SPL\n\
         SLIN XP1 C_SPL\n\
         SPLINE WITH $VEL.CP=0.3,$BASE={X 5,Y 0,Z 0,A 0,B 0,C 0}\n\
         SLIN XP1\nSLIN XP1 WITH $VEL.CP=0.2,$TOOL={X 0,Y 0,Z 8,A 0,B 0,C 0}\nSLIN XP1\n\
         ENDSPLINE\nSLIN XP1 C_SPL",
    );
    let place = |frame: &FrameUse| frame.known().unwrap().translation.vector;
    let found: Vec<_> = (program.motions.iter())
        .map(|motion| {
            (
                motion.speed.mm_per_s.unwrap(),
                motion.zone,
                place(&motion.tool).z,
                place(&motion.work_object).x,
            )
        })
        .collect();
    let segment = |speed: f64, tool: f64| (speed, Zone::Unstated, tool, 5.0);
    let wanted = [
        (100.0, Zone::Radius(2.0), 9.0, 4.0),
        (500.0, Zone::Radius(7.0), 0.0, 0.0),
        segment(300.0, 0.0),
        segment(200.0, 8.0),
        segment(300.0, 0.0),
        (500.0, Zone::Radius(7.0), 0.0, 0.0),
    ];
    assert_eq!(found, wanted);
}

/// The functions of inline forms read data and change nothing of them, wherever they stand.
#[test]
fn data_that_functions_of_inline_forms_read_stay_known() {
    for reads in [
        "SPLINE WITH $APO=SAPO(LCPDAT1),$TOOL=STOOL2(FP1)\nSLIN XP1\nENDSPLINE",
        "$APO=SAPO(LCPDAT1)\n$TOOL=STOOL2(FP1)",
        "SLIN XP1 WITH $APO=SAPO(LCPDAT1),$TOOL=STOOL2(FP1)",
    ] {
        let statements = format!(
            "TOOL_DATA[1]={{X 0,Y 0,Z 70,A 0,B 0,C 0}}\n{reads}\nLDAT_ACT=LCPDAT1\nFDAT_ACT=FP1\nBAS(#CP_PARAMS,0.2)\nLIN XP1 C_DIS"
        );
        let program = main_with(DATA, &statements);
        let last = program.motions.last().unwrap();
        assert_eq!(last.zone, Zone::Radius(3.0), "{reads}");
        let tool = last.tool.known().map(|tool| tool.translation.z);
        assert_eq!(tool, Some(70.0), "{reads}");
    }
    // A routine of somebody else may.
    let program = main_with(
        DATA,
        "change(LCPDAT1)\nLDAT_ACT=LCPDAT1\nBAS(#CP_PARAMS,0.2)\nLIN XP1 C_DIS",
    );
    assert_eq!(program.motions[0].zone, Zone::Unstated);
}

/// A field that stretches the path by 15 %: the part is cut as fast as before if every motion is 15 % faster, wherever its speed stands.
#[test]
fn the_feed_along_the_part_is_kept_wherever_it_is_stated() {
    let text = format!(
        "DEF part()\n{FRAMES}\n$VEL.CP=0.02\nLIN {{X 0,Y 0,Z 5,A 0,B 0,C 180}}\n\
         SLIN {{X 10,Y 0,Z 5,A 0,B 0,C 180}} WITH $VEL.CP=0.1\n\
         SLIN {{X 20,Y 0,Z 5,A 0,B 0,C 180}} WITH $VEL=SVEL_CP(0.02, , LCPDAT1),$ACC=SACC_CP(LCPDAT1)\n\
         SPLINE WITH $VEL.CP=0.04\nSLIN {{X 30,Y 0,Z 5,A 0,B 0,C 180}}\n\
         SLIN {{X 40,Y 0,Z 5,A 0,B 0,C 180}} WITH $VEL.CP=0.06\nENDSPLINE\n\
         LIN {{X 50,Y 0,Z 5,A 0,B 0,C 180}}\nEND\n"
    );
    let (reading, making) = (ReadOptions::default(), PathOptions::default());
    let files = vec![SourceFile::new("part.src", text)];
    let program = read_krl(files, &reading).unwrap();
    let path = path_of(&program, &making).unwrap();
    let field = |request: &Request| Ok(Vector3::x() * 0.15 * request.position_mm.x);
    let mut writing = PathWriteOptions::default();
    writing.header = None;
    let both = ((&program, &path), (&reading, &making));
    let written = written_and_checked(both.0, both.1, &field, &writing).unwrap();
    let output = String::from_utf8(written.bytes).unwrap();
    let lines: Vec<&str> = output
        .lines()
        .filter(|line| line.contains("SLIN"))
        .collect();
    let number = |text: &str, before: &str| -> f64 {
        let rest = text.split(before).nth(1).unwrap().trim_start();
        let end = rest.find(|c: char| !matches!(c, '0'..='9' | '.' | '-'));
        rest[..end.unwrap_or(rest.len())].parse().unwrap()
    };
    // Ends and speeds of all motions by hand: 1.15 of what they were.
    let wanted = [
        (11.5, "$VEL.CP=", 0.115),
        (23.0, "SVEL_CP(", 0.023),
        (34.5, "$VEL.CP=", 0.046),
        (46.0, "$VEL.CP=", 0.069),
    ];
    assert_eq!(lines.len(), wanted.len(), "{output}");
    for (line, (x, before, speed)) in lines.iter().zip(wanted) {
        assert!((number(line, "X ") - x).abs() < 1e-3, "{line}");
        assert!((number(line, before) - speed).abs() < 1e-6, "{line}");
    }
    // No assignment stands in the block, and the last motion has its own again.
    let block = output.split("SPLINE").nth(1).unwrap();
    assert!(!block.contains("\n$VEL"), "{output}");
    assert!(
        output.contains("ENDSPLINE\n$VEL.CP=0.023\nLIN {X 57.5"),
        "{output}"
    );
}

/// As KUKA's inline forms write them, with the speed in force the same as that of the motion: the last check of the file failed.
#[test]
fn inline_forms_are_corrected_along_their_paths() {
    let line = |x: f64, y: f64| {
        format!(
            "SLIN {{X {x},Y {y},Z 5,A 0,B 0,C 180}} WITH $VEL = SVEL_CP(0.02, , LCPDAT1), $TOOL = {{X 0,Y 0,Z 150,A 0,B 0,C 0}}, $BASE = $NULLFRAME, $IPO_MODE = #BASE, $LOAD = SLOAD(1), $ACC = SACC_CP(LCPDAT1), $APO.CDIS=1, $JERK = SJERK(LCPDAT1) C_Spl\n"
        )
    };
    let text = format!(
        "DEF part()\n{FRAMES}\n$VEL.CP=0.02\n{}{}{}END\n",
        line(0.0, 0.0),
        line(200.0, 0.0),
        line(200.0, 90.0)
    );
    let found = corrected(
        Language::Krl,
        "part.src",
        text.as_bytes(),
        &ReadOptions::default(),
    );
    assert_eq!(found, Ok(3));
}

#[test]
fn lists_with_what_may_move_the_tool_are_refused() {
    let end = "{X 100,Y 0,Z 5,A 0,B 0,C 180}";
    for (list, words) in [
        ("$IPO_MODE=#TCP", "the robot holds the part"),
        (
            "$IPO_MODE=SIPO_MODE(FP2.IPO_FRAME)",
            "the robot holds the part",
        ),
        ("$IPO_MODE=mode", "is computed while the program runs"),
        ("$ORI_TYPE=#JOINT", "does not turn evenly"),
        ("$EX_AX_IGNORE='B000001'", "external axes do not go"),
        (
            "$ROBROOT={X 1,Y 0,Z 0,A 0,B 0,C 0}",
            "no setting of a motion",
        ),
        (
            "$VEL.CP=0.1,$SPL_TECH[1]={MODE #ON}",
            "no setting of a motion",
        ),
        ("$VEL.CP=0.1,SOMETHING", "no setting of a motion"),
    ] {
        for statements in [
            format!("SLIN {end} WITH {list}"),
            format!("SPLINE WITH {list}\nSLIN {end}\nENDSPLINE"),
        ] {
            let data = "DEFDAT part\nDECL FDAT FP2={TOOL_NO 1,BASE_NO 1,IPO_FRAME #TCP}\nENDDAT\n";
            let files = vec![
                SourceFile::new("part.src", format!("DEF part()\n{statements}\nEND\n")),
                SourceFile::new("part.dat", data),
            ];
            let faults = read_krl(files, &ReadOptions::default()).unwrap_err();
            assert_eq!(faults.len(), 1, "{statements}: {faults:#?}");
            assert!(
                faults[0].line == 2 && faults[0].to_string().contains(words),
                "{statements}: {faults:#?}"
            );
        }
    }
    // What is in force from before, too.
    for (statement, words) in [
        (
            "$ROBROOT={X 1,Y 0,Z 0,A 0,B 0,C 0}",
            "all points behind it stand elsewhere",
        ),
        (
            "$TECH[1].MODE=#SINGLE",
            "may move the tool beside the program",
        ),
        ("$EX_AX_IGNORE=1", "external axes do not go"),
    ] {
        let text = format!("DEF part()\n{statement}\nLIN {end}\nEND\n");
        let files = vec![SourceFile::new("part.src", text)];
        let faults = read_krl(files, &ReadOptions::default()).unwrap_err();
        assert!(faults[0].to_string().contains(words), "{faults:#?}");
    }
    for statement in [
        "$TECH[1].MODE=#OFF",
        "$EX_AX_IGNORE='B0'",
        "$IPO_MODE=#BASE",
    ] {
        assert_eq!(
            main_with("", &format!("{statement}\nLIN {end}"))
                .motions
                .len(),
            1
        );
    }
}
