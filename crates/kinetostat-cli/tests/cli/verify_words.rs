//! `verify`: what changes a cut is a fault whatever the load is, and all else that differs is named.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use crate::common::{run, workplace};
use crate::verify_robot::{KRL, LOADED, PLACED, POSE, changes, verified};

const GCODE: &str = "G21 G90 G17 G94\nT1 M6\nG43 H1\nS6000 M3\nM8\nG0 X-20 Y-20 Z10\nG1 Z-1 F200\nG1 X20 F800\nG1 Y5\nG0 Z10\n\
M9\nM5\nG0 X0\nM30\n";

const RAPID: &str = "MODULE Part
  PERS tooldata tMill:=[TRUE,[[0,0,150],[1,0,0,0]],[5,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata wPart:=[FALSE,TRUE,\"\",[[1300,50,900],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PROC main()
    MoveL [[0,0,30],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tMill\\WObj:=wPart;
    SetDO doSpindle,1;
    SetDO doAir,1;
    MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tMill\\WObj:=wPart;
    MoveL [[120,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tMill\\WObj:=wPart;
    MoveL [[120,0,30],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tMill\\WObj:=wPart;
    SetDO doSpindle,0;
  ENDPROC
ENDMODULE
";

#[test]
fn words_of_gcode_are_faults_or_named() {
    let with = format!("{LOADED}{PLACED}");
    let off = "THE SPINDLE DOES NOT TURN AS IN THE ORIGINAL";
    let speed = "ANOTHER SPEED OF THE SPINDLE";
    changes(
        "part.ngc",
        GCODE,
        &with,
        &[
            ("S6000 M3", "M3", 3, speed),
            ("S6000", "S3000", 3, speed),
            ("S6000 M3", "S6000", 3, off),
            (" F", " F1", 3, "ANOTHER FEED"),
            ("T1 M6\n", "", 3, "ANOTHER TOOL"),
            ("G43 H1", "G43 H9", 3, "cut with G43 H9, the original with"),
            ("G43 H1\n", "", 3, "ANOTHER TOOL"),
            ("M8\n", "M8\nG64 P1\n", 3, "ANOTHER PATH MODE"),
            ("M8\n", "M8\nG55\n", 3, "ANOTHER FRAME"),
            (
                "M5\n",
                "",
                0,
                "M5 at line 12 of the original is not in this program",
            ),
            (
                "M8\n",
                "",
                0,
                "M8 at line 5 of the original is not in this program",
            ),
            ("M9\n", "M9\nM0\n", 0, "M0 at line"),
            ("M9\n", "M9\nG04 P2.0\n", 0, "G4 P2 at line"),
            ("M8\n", "M8\nM7\n", 0, "M7 at line"),
            ("M8\n", "M08 (air)\n", 0, "VERIFIED"),
        ],
    );
}

/// What a program of `compensate` has is what its original has: nothing is said of it.
#[test]
fn own_programs_have_the_words_of_their_originals() {
    for (name, program, with) in [
        ("part.ngc", GCODE, format!("{LOADED}{PLACED}")),
        ("part.mod", RAPID, format!("{LOADED}{POSE}")),
        ("part.src", KRL, format!("{LOADED}{POSE}")),
    ] {
        let here = workplace();
        std::fs::write(here.path().join(name), program).unwrap();
        let (code, said) = verified(here.path(), name, &with, str::to_owned);
        assert!(matches!(code, 0 | 4), "{said}");
        for words in ["the original is", "in the original", "original with"] {
            assert!(!said.contains(words), "{name}: {said}");
        }
    }
}

#[test]
fn words_of_robots_are_faults_or_named() {
    let with = format!("{LOADED}{POSE}");
    let off = "THE SPINDLE DOES NOT TURN AS IN THE ORIGINAL";
    changes(
        "part.mod",
        RAPID,
        &with,
        &[
            (",v20,", ",v40,", 3, "ANOTHER FEED"),
            ("SetDO doSpindle,1;", "", 3, off),
            ("SetDO doSpindle,1;", "SetDO doSpindle,0;", 3, off),
            ("SetDO doSpindle,0;", "", 0, "SETDO DOSPINDLE,0 at line 11"),
            ("SetDO doAir,1;", "", 0, "SETDO DOAIR,1 at line 7 of the"),
            (
                "SetDO doAir,1;",
                "SetDO doAir,1; WaitTime 2;",
                0,
                "WAITTIME 2 at line",
            ),
            ("SetDO doAir,1;", "SetDO doAir,1; ! air", 0, "VERIFIED"),
        ],
    );
    let krl = KRL.replacen(" LIN ", " $OUT[3]=TRUE\n LIN ", 1);
    changes(
        "part.src",
        &krl,
        &with,
        &[
            ("$VEL.CP=0.02", "$VEL.CP=0.1", 3, "ANOTHER FEED"),
            ("$VEL.CP=0.02", "$VEL.CP=0.04", 3, "ANOTHER FEED"),
            ("LIN {X 120.", "SLIN {X 120.", 3, "with a spline motion"),
            (" $OUT[3]=TRUE\n", "", 0, "$OUT[3]=TRUE at line 5 of the"),
            (
                " $OUT[3]=TRUE\n",
                " $OUT[3]=TRUE\n WAIT SEC 2\n",
                0,
                "WAIT SEC 2 at line",
            ),
        ],
    );
}

const LS: &str = "/PROG PART\n/ATTR\n/MN\n 1:UFRAME_NUM=1 ;\n 2:UTOOL_NUM=1 ;\n 3:L P[1] 200mm/sec FINE ;\n 4:CALL SPINDLE_ON ;\n 5:DO[7]=ON ;\n \
6:L P[2] 20mm/sec FINE ;\n 7:L P[3] 20mm/sec CNT5 TB .50sec,DO[8]=ON ;\n 8:L P[4] 20mm/sec FINE ;\n 9:L P[5] 200mm/sec FINE ;\n/POS\n";

/// A program of FANUC, changed behind its compensation.
#[test]
fn words_of_fanuc_are_faults_or_named() {
    let here = workplace();
    let here = here.path();
    let places = [[0, 0, 50], [0, 0, 0], [60, 0, 0], [60, 40, 0], [60, 40, 50]];
    let places = (1..).zip(places).map(|(number, [x, y, z])| {
        format!("P[{number}]{{\n GP1:\n UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',\n X = {x}.000 mm, Y = {y}.000 mm, Z = {z}.000 mm,\n W = 180.000 deg, P = 0.000 deg, R = 0.000 deg\n}};\n")
    });
    let program = format!("{LS}{}/END\n", places.collect::<String>());
    std::fs::write(here.join("part.ls"), program).unwrap();
    let job = "schema = 1\nmodel = \"fanuc_r2000ic_like\"\nprogram = \"part.ls\"\n[load]\nweight = \"all\"\nforce_n = [60, 20, 100]\n[robot]\n\
rapid_from_mm_per_s = 150\n[robot.frames]\n\"UT:1\" = { position_mm = [0, 0, 250] }\n\"UF:1\" = { position_mm = [1500, 0, 700] }\n";
    std::fs::write(here.join("job.toml"), job).unwrap();
    let done = run(here, &["compensate", "job.toml", "--out", "out.ls"]);
    assert!(matches!(done.code, 0 | 4), "{done:?}");
    let text = std::fs::read_to_string(here.join("out.ls")).unwrap();
    for (from, to, wanted, words) in [
        ("", "", 0, "VERIFIED"),
        (" 20mm/sec", " 40mm/sec", 3, "ANOTHER FEED"),
        ("CNT5 ", "CNT100 ", 3, "ANOTHER PATH MODE"),
        ("CALL SPINDLE_ON", "", 3, "THE SPINDLE DOES NOT TURN"),
        ("DO[7]=ON", "", 0, "DO[7]=ON at line 8 of the original"),
        (
            "DO[7]=ON",
            "OVERRIDE=30%",
            3,
            "ANOTHER FEED: OVERRIDE=30% at line",
        ),
        (" TB .50sec,DO[8]=ON", "", 0, "DO[8]=ON at line"),
        ("DO[7]=ON", "WAIT 2.00(sec)", 0, "WAIT 2.00(SEC) at line"),
    ] {
        assert!(text.contains(from), "{from}: {text}");
        std::fs::write(here.join("other.ls"), text.replace(from, to)).unwrap();
        let said = run(here, &["verify", "other.ls", "--job", "job.toml"]);
        let shown = format!("{}{}", said.out, said.err);
        let shown = shown.split_whitespace().collect::<Vec<_>>().join(" ");
        let is_wanted = said.code == wanted || (wanted == 0 && said.code == 4);
        assert!(is_wanted, "{from} -> {to}: {shown}");
        assert!(shown.contains(words), "{from} -> {to}: {shown}");
        assert!(
            !from.is_empty() || !shown.contains("in the original"),
            "{shown}"
        );
    }
}
