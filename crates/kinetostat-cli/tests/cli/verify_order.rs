//! `verify`: the order of statements and cuts, settings of how motions run, and the ways of motions in the air.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use crate::common::{run, workplace};
use crate::verify_robot::{LOADED, PLACED, POSE, changes};

/// A change of a compensated program, the exit code of `verify`, and words that it says.
type Change = (&'static str, &'static str, i32, &'static str);

const KRL: &str = "DEF part()\n BAS(#INITMOV,0)\n $BASE={X 1300,Y 50,Z 900,A 0,B 0,C 0}\n $TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}\n \
$VEL.CP=0.2\n $APO.CDIS=1\n $ACC.CP=2.0\n $ORI_TYPE=#VAR\n PTP {X 0,Y 0,Z 150,A 0,B 0,C 180}\n LIN {X 0,Y 0,Z 30,A 0,B 0,C 180}\n \
SPINDLE_ON()\n COOLING()\n CUT()\n $VEL.CP=0.2\n LIN {X 120,Y 40,Z 45,A 0,B 0,C 180}\n PTP {X 120,Y 40,Z 150,A 0,B 0,C 180}\nEND\n\
DEF CUT()\n $VEL.CP=0.02\n LIN {X 0,Y 0,Z 0,A 0,B 0,C 180}\n LIN {X 120,Y 0,Z 0,A 0,B 0,C 180} C_DIS\n \
LIN {X 120,Y 40,Z 0,A 0,B 0,C 180}\nEND\n";

const RAPID: &str = "MODULE Part
  CONST num nRamp:=50;
  PERS tooldata tMill:=[TRUE,[[0,0,150],[1,0,0,0]],[5,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata wPart:=[FALSE,TRUE,\"\",[[1300,50,900],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PROC main()
    ConfL\\Off;
    AccSet 50,nRamp;
    SingArea\\Off;
    MoveJ [[0,0,150],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tMill\\WObj:=wPart;
    MoveL [[0,0,30],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tMill\\WObj:=wPart;
    SpindleOn 12000;
    Cut;
    MoveL [[120,0,30],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tMill\\WObj:=wPart;
  ENDPROC
  PROC Cut()
    MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tMill\\WObj:=wPart;
    MoveL [[120,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tMill\\WObj:=wPart;
  ENDPROC
ENDMODULE
";

const APT: &str = "PARTNO T\nUNITS/MM\nLOADTL/1\nSPINDL/5000,RPM,CLW\nCOOLNT/ON\nRAPID\nGOTO/0,0,30\nFEDRAT/600,MMPM\nGOTO/0,0,0\n\
GOTO/100,0,0\nRAPID\nGOTO/100,0,30\nSPINDL/OFF\nFINI\n";
const SIEMENS: &str = "G17 G90 G94 G710 G64\nFFWON SOFT\nT=\"MILL\" M6\nG54 D1\nS6000 M3\nM8\nG0 X-20 Y-20\nZ10\nG1 Z-1 F200\nX20 F800\n\
G0 Z50\nSTOPRE\nM9\nM30\n";
const HEIDENHAIN: &str = "BEGIN PGM h MM\nTOOL CALL 1 Z S5000\nCYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.02\nL X+0 Y+0 Z+30 R0 FMAX\nM3\nM8\nL Z+0 F600\n\
L X+100\nL Z+30 FMAX\nM9\nM30\nEND PGM h MM\n";
const GCODE: &str = "G21 G90 G17 G94\nS6000\nM3\nM8\nG0 X-20 Y-20 Z10\nG1 Z-1 F200\nG1 X20 F800\nG0 Z10\nG0 X0\nM9\nM30\n";

/// A statement on the other side of a cut, another setting, another way: each is named with its line.
#[test]
fn order_settings_and_ways_are_compared_in_all_languages() {
    let (robot, machine) = (format!("{LOADED}{POSE}"), format!("{LOADED}{PLACED}"));
    let off = "THE SPINDLE DOES NOT TURN AS IN THE ORIGINAL";
    let mode = "ANOTHER PATH MODE";
    let course = "ANOTHER COURSE OF THE PROGRAM";
    let endless = "ANOTHER COURSE OF THE PROGRAM: A LOOP WITHOUT END at line";
    let krl: [Change; 10] = [
        (
            "DEF part()\n",
            "DEF again()\n LOOP\n part()\n ENDLOOP\nEND\nDEF part()\n",
            3,
            endless,
        ),
        (
            " SPINDLE_ON()\n COOLING()\n CUT()\n",
            " COOLING()\n CUT()\n SPINDLE_ON()\n",
            3,
            off,
        ),
        (
            " COOLING()\n CUT()\n",
            " CUT()\n COOLING()\n",
            3,
            "COOLING() at line",
        ),
        (" BAS(#INITMOV,0)\n", "", 3, "BAS(#INITMOV,0)"),
        ("$ACC.CP=2.0", "$ACC.CP=5.0", 3, "cut with $ACC.CP=5.0"),
        (" $ORI_TYPE=#VAR\n", "", 3, "$ORI_TYPE=#VAR"),
        (
            " C_DIS\n LIN {X 120.",
            "\n LIN {X 120.",
            0,
            "stop at their ends",
        ),
        ("$APO.CDIS=1", "$APO.CDIS=9", 3, "is passed at up to 9 mm"),
        ("PTP {X 120.", "LIN {X 120.", 0, "goes on a straight line"),
        (
            "$VEL.CP=0.2\n LIN {X 120.",
            "$VEL.CP=0.2\n PTP {X 120.",
            3,
            course,
        ),
    ];
    let rapid: [Change; 8] = [
        (
            "SpindleOn 12000;\n    Cut;",
            "Cut;\n    SpindleOn 12000;",
            3,
            off,
        ),
        ("ConfL\\Off", "ConfL\\On", 3, mode),
        ("AccSet 50,nRamp", "AccSet 90,90", 3, "with ACCSET 90,90"),
        (
            "nRamp:=50",
            "nRamp:=40",
            3,
            "with ACCSET 50,40, the original with ACCSET 50,50",
        ),
        (
            "PROC main()",
            "PROC main()\n WHILE TRUE DO\n Again;\n ENDWHILE\n ENDPROC\n PROC Again()",
            3,
            endless,
        ),
        ("SingArea\\Off;", "", 3, "SINGAREA\\OFF"),
        ("MoveL [[120.", "MoveL\\Conc,[[120.", 3, "\\CONC"),
        ("MoveJ ", "MoveL ", 0, "goes on a straight line"),
    ];
    let apt: [Change; 2] = [
        (
            "COOLNT/ON\nRAPID\n",
            "RAPID\n",
            0,
            "COOLNT/ON at line 5 of the original",
        ),
        ("SPINDL/5000,RPM,CLW\n", "", 3, off),
    ];
    let siemens: [Change; 5] = [
        ("M8\n", "", 0, "M8 at line 6 of the original"),
        ("FFWON", "FFWOF", 3, "with FFWOF"),
        ("SOFT", "BRISK", 3, "with BRISK"),
        ("STOPRE\n", "", 0, "STOPRE at line"),
        ("S6000 M3\nM8", "M8\nS6000 M3", 0, "VERIFIED"),
    ];
    let heidenhain: [Change; 3] = [
        ("32.1 T0.02", "32.1 T0.5", 3, mode),
        ("M9\n", "", 0, "M9 at line"),
        ("M3\nM8\n", "M8\n", 3, off),
    ];
    let gcode: [Change; 3] = [
        ("M8\n", "", 0, "M8 at line 4 of the original"),
        ("G0 X0", "G1 X0", 0, "rapids run behind line"),
        ("M3\n", "", 3, off),
    ];
    changes("part.src", KRL, &robot, &krl);
    changes("part.mod", RAPID, &robot, &rapid);
    changes("part.apt", APT, &machine, &apt);
    changes("part.mpf", SIEMENS, &machine, &siemens);
    changes("part.h", HEIDENHAIN, &machine, &heidenhain);
    changes("part.ngc", GCODE, &machine, &gcode);
}

/// What `compensate` writes of a routine that runs twice passes, though a finer correction would differ from run to run.
#[test]
fn own_programs_with_shared_routines_pass() {
    let program = "DEF part()\n $BASE={X 1300,Y 50,Z 900,A 0,B 0,C 0}\n $TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}\n $VEL.CP=0.02\n \
LIN {X 0,Y 0,Z 0,A 0,B 0,C 180}\n CUT()\n CUT()\nEND\nDEF CUT()\n LIN {X 120,Y 0,Z 0,A 0,B 0,C 180}\n LIN {X 120,Y 60,Z 0,A 0,B 0,C 180}\nEND\n";
    changes("part.src", program, LOADED, &[]);
}

/// A program of two modules is read with the second one that was written with it.
#[test]
fn the_second_module_of_a_program_is_its_own() {
    let here = workplace();
    let here = here.path();
    let rest = ",[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";
    let target = |name: &str, place: &str| format!("  CONST robtarget {name}:=[{place}{rest};\n");
    let move_to = |end: &str| format!("    MoveL {end},v20,fine,tMill\\WObj:=wPart;\n");
    let data = RAPID.split("  PROC").next().unwrap();
    let moves = [format!("[[0,0,9]{rest}"), "p1".into(), "p2".into()].map(|end| move_to(&end));
    let program = format!(
        "{data}  PROC main()\n{}  ENDPROC\nENDMODULE\n",
        moves.concat()
    );
    std::fs::write(here.join("part.mod"), program).unwrap();
    let points = target("p1", "[0,0,0]") + &target("p2", "[120,0,0]");
    let points = format!("MODULE Points\n{points}ENDMODULE\n");
    std::fs::write(here.join("points.mod"), points).unwrap();
    let job = "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"part.mod\"\n[load]\nweight = \"all\"\nforce_n = [200, -150, 300]\n[robot]\n\
rapid_from_mm_per_s = 150\nfiles = [\"points.mod\"]\n";
    std::fs::write(here.join("job.toml"), job).unwrap();
    let done = run(here, &["compensate", "job.toml", "--out", "out.mod"]);
    assert!(matches!(done.code, 0 | 4), "{done:?}");
    assert!(here.join("out-points.mod").is_file(), "{done:?}");
    let said = run(here, &["verify", "out.mod", "--job", "job.toml"]);
    assert!(matches!(said.code, 0 | 4), "{said:?}");
}

/// Values that only the controller knows are stated to `expand` and `convert` as to other commands.
#[test]
fn stated_values_decide_branches_of_programs_that_are_expanded_and_converted() {
    let here = workplace();
    let here = here.path();
    let program = "DEF part()\n $BASE={X 1300,Y 50,Z 900,A 0,B 0,C 0}\n $TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}\n $VEL.CP=0.02\n \
LIN {X 0,Y 0,Z 0,A 0,B 0,C 180}\n IF $IN[1] THEN\n LIN {X 120,Y 0,Z 0,A 0,B 0,C 180}\n ENDIF\nEND\n";
    std::fs::write(here.join("part.src"), program).unwrap();
    for line in [
        "expand part.src --out flat.src",
        "convert part.src --to rapid --out part.mod",
    ] {
        let line: Vec<&str> = line.split(' ').collect();
        let refused = run(here, &line);
        assert_eq!(refused.code, 1, "{refused:?}");
        let done = run(here, &[&line[..], &["--set", "$IN[1]=TRUE"]].concat());
        assert_eq!(done.code, 0, "{done:?}");
    }
}
