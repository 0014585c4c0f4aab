//! `verify`: words that both programs have, and that are in force at other cuts.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use crate::common::{run, workplace};
use crate::verify::without_line;
use crate::verify_robot::{KRL, LOADED, PLACED, POSE, changes, verified};

const FRAMES: &str = "G21 G90 G17 G40 G94 G61\nT1 M6\nG43 H1\nS6000 M3\nG54\nG0 X-20 Y-20 Z10\nG1 Z-1 F200\nG1 X20 F800\n\
G0 Z10\nG64 P0.01\nG55\nG43 H2\nG0 X-8 Y-5 Z10\nG1 Z-2 F150\nG1 X8 F600\nG0 Z10\nG54\nG61\nG0 X-5 Y5 Z10\nG1 Z-3 F150\n\
G1 X8 F600\nG0 Z10\nM2\n";
const TWO_TOOLS: &str = "MODULE Part
  PERS tooldata tMill:=[TRUE,[[0,0,200],[1,0,0,0]],[5,[0,0,50],[1,0,0,0],0,0,0]];
  PERS tooldata tDrill:=[TRUE,[[0,0,150],[1,0,0,0]],[5,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata wPart:=[FALSE,TRUE,\"\",[[1300,50,900],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PROC main()
    MoveL [[0,0,30],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tMill\\WObj:=wPart;
    MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tMill\\WObj:=wPart;
    MoveL [[120,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tMill\\WObj:=wPart;
    MoveL [[120,0,30],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tMill\\WObj:=wPart;
    MoveL [[0,60,30],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tDrill\\WObj:=wPart;
    MoveL [[0,60,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tDrill\\WObj:=wPart;
    MoveL [[80,60,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tDrill\\WObj:=wPart;
    MoveL [[80,60,30],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tDrill\\WObj:=wPart;
  ENDPROC
ENDMODULE
";
const SIEMENS: &str = "G17 G90 G94 G710 G60\nT=\"MILL\" M6\nG54 D1 S6000 M3\nG0 X-20 Y-20\nZ10\nG1 Z-1 F200\nX20 F800\nG0 Z50\n\
T=\"DRILL\" M6\nD1 S2000 M3\nG0 X5 Y5\nZ10\nG1 Z-2 F150\nX9\nG0 Z50\nM30\n";

#[test]
fn frames_and_lengths_are_compared_at_every_cut() {
    let with = format!("{LOADED}{PLACED}");
    changes(
        "part.ngc",
        FRAMES,
        &with,
        &[
            (
                "G54\nG61",
                "G61",
                3,
                "with G55, the original with G54 (line 20 there)",
            ),
            (
                "G43 H2",
                "G43 H1",
                3,
                "with G43 H1, the original with G43 H2 (line 14 there)",
            ),
            ("G43 H2", "G49", 3, "with G49, the original with G43 H2"),
            // The written program stops at the corners of its last cut, as long as it says so.
            (
                "G54\nG61\n",
                "G54\n",
                3,
                "with G64 P0.01, the original with G61",
            ),
            ("\nG1 ", "\n/G1 ", 0, "with /, the original with no /"),
        ],
    );
}

#[test]
fn tools_of_robots_are_compared_at_every_cut() {
    let with = format!("{LOADED}{POSE}");
    let exchanged = |text: &str| {
        let text = text.replace(",tMill\\", ",tOther\\");
        let text = text.replace(",tDrill\\", ",tMill\\");
        text.replace(",tOther\\", ",tDrill\\")
    };
    let here = workplace();
    std::fs::write(here.path().join("part.mod"), TWO_TOOLS).unwrap();
    let (code, said) = verified(here.path(), "part.mod", &with, exchanged);
    assert_eq!(code, 3, "{said}");
    let words = "cut with tool 'tDrill', the original with tool 'tMill'";
    assert!(said.contains(words), "{said}");
    let exit = |text: &str| {
        let line = text
            .lines()
            .find(|line| line.contains(",tDrill\\"))
            .unwrap();
        text.replacen(line, &format!("    EXIT;\n{line}"), 1)
    };
    let (code, said) = verified(here.path(), "part.mod", &with, exit);
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("ARE NOT CUT by this program"), "{said}");
    changes(
        "part.src",
        KRL,
        &with,
        &[
            (
                " $VEL.CP=0.02\n",
                " $VEL.CP=0.02\n HALT\n",
                3,
                "HALT at line",
            ),
            (
                " $VEL.CP=0.02\n",
                " $VEL.CP=0.02\n $OV_PRO=30\n",
                3,
                "$OV_PRO=30 at line",
            ),
        ],
    );
}

#[test]
fn words_of_a_sinumerik_are_compared_at_every_cut() {
    let with = format!("{LOADED}{PLACED}");
    changes(
        "part.mpf",
        SIEMENS,
        &with,
        &[
            (
                "T=\"DRILL\"",
                "T=\"MILL\"",
                3,
                "with tool 'T MILL', the original with tool 'T DRILL'",
            ),
            ("\nD1", "\nD2", 3, "with D2, the original with D1"),
            (
                "S2000",
                "S6000",
                3,
                "with M3 at 6000 rpm, the original with M3 at 2000 rpm",
            ),
            (
                "S2000 M3",
                "S2000 M4",
                3,
                "with M4 at 2000 rpm, the original with M3 at 2000 rpm",
            ),
            (
                "G17 G90",
                "G642 ADIS=1 G17 G90",
                3,
                "the control follows the path otherwise",
            ),
        ],
    );
}

/// What another post writes for the same is the same, and a statement that the original has is one where it has it.
/// A change of tools stops the spindle, and no cut is made with one that stands still, whatever the forces are.
#[test]
fn a_spindle_that_stands_still_is_a_fault() {
    let with = format!("{LOADED}{PLACED}");
    let what = "THE SPINDLE DOES NOT TURN AS IN THE ORIGINAL";
    let two = "G21 G90\nT1 M6\nS6000 M3\nG0 X-14 Y-14 Z10\nG1 Z-1 F200\nX0\nG0 Z10\nT2 M6\nS5000 M3\nG0 X0 Y0\nG1 Z-1\nX8\nG0 Z10\nM2\n";
    let changed = [
        ("S5000 M3", "S5000", 3, what),
        ("S5000 M3", "S5000 M4", 3, what),
        ("S5000 M3", "S0 M3", 3, what),
        ("S5000 M3", "S4000 M3", 3, "ANOTHER SPEED OF THE SPINDLE"),
    ];
    changes("part.ngc", two, &with, &changed);
    let stands =
        "with a spindle that stands still, the original with M3 at 2000 rpm (line 13 there)";
    changes(
        "part.mpf",
        SIEMENS,
        &with,
        &[
            ("S2000 M3", "S2000", 3, stands),
            ("M30", "M5\nM30", 0, "M5"),
            ("S2000 M3", "S0 M3", 3, "ANOTHER SPEED OF THE SPINDLE"),
            (
                "S2000 M3",
                "S2000 M3\nSPOS=0",
                3,
                "with a spindle that stands still, the original with M3",
            ),
        ],
    );
    let heidenhain = "0 BEGIN PGM P MM\n1 TOOL CALL 5 Z S6000\n2 L X-20 Y-20 R0 FMAX M3\n3 L Z+10 R0 FMAX\n4 L Z-1 F200\n5 L X+20 F800\n6 L Z+50 R0 FMAX\n7 TOOL CALL 7 Z S2000\n8 L X+5 Y+5 R0 FMAX M3\n9 L Z+10 R0 FMAX\n10 L Z-2 F150\n11 L X+9\n12 L Z+50 R0 FMAX M30\n13 END PGM P MM\n";
    let (code, said) = {
        let here = workplace();
        std::fs::write(here.path().join("part.h"), heidenhain).unwrap();
        verified(here.path(), "part.h", &with, |text| {
            let last = text.rfind(" M3\n").unwrap();
            format!("{}{}", &text[..last], &text[last + 3..])
        })
    };
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("with a spindle that stands still"), "{said}");
}

/// Motions under a condition may not be made.
#[test]
fn a_condition_around_cuts_is_a_fault() {
    let with = format!("{LOADED}{POSE}");
    let here = workplace();
    std::fs::write(here.path().join("part.mod"), TWO_TOOLS).unwrap();
    let around = |text: &str| {
        let from = text.find(",tDrill\\").unwrap();
        let from = text[..from].rfind('\n').unwrap() + 1;
        let text = format!("{}    IF FALSE THEN\n{}", &text[..from], &text[from..]);
        text.replace("  ENDPROC", "    ENDIF\n  ENDPROC")
    };
    let (code, said) = verified(here.path(), "part.mod", &with, around);
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("ARE NOT CUT by this program"), "{said}");
}

#[test]
fn other_ways_to_write_the_same_are_the_same() {
    let same = |name: &str, program: &str, with: &str, change: &dyn Fn(&str) -> String| {
        let here = workplace();
        std::fs::write(here.path().join(name), program).unwrap();
        let (code, said) = verified(here.path(), name, with, |text| {
            let changed = change(text);
            assert_ne!(changed, text);
            changed
        });
        assert!(matches!(code, 0 | 4), "{said}");
        for words in ["cut with", "cuts with", "ANOTHER", "not in the original"] {
            assert!(!said.contains(words), "{said}");
        }
    };
    let placed = format!("{LOADED}{PLACED}");
    let first_g55 = FRAMES.replacen("G54\n", "G55\n", 1);
    same("part.ngc", &first_g55, &placed, &|text| {
        format!("G54\n{text}")
    });
    let corners = FRAMES.replace("G64 P0.01", "G64 P0.01 Q0.005");
    same("part.ngc", &corners, &placed, &|text| {
        text.replace("G64 P0.01 Q0.005", "G64 Q0.005 P0.010")
    });
    same("part.mpf", SIEMENS, &placed, &|text| {
        text.replace("T=\"MILL\" M6", "t = \"mill\"M6")
            .replace("S6000 M3", "M03 S6000")
    });
    let heidenhain = "BEGIN PGM h MM\nTOOL CALL 1 Z S5000 DL-0.1\nL X+0 Y+0 Z+30 R0 FMAX M3\nL Z+0 F600\nL X+100\nL Z+30 FMAX\nM30\nEND PGM h MM\n";
    same("part.h", heidenhain, &placed, &|text| {
        text.replace(
            "TOOL CALL 1 Z S5000 DL-0.1",
            "TOOL CALL 01 Z DL-0.100 S5000",
        )
    });
    let returns = TWO_TOOLS.replacen(
        "    MoveL [[0,60,30]",
        "    IF FALSE RETURN;\n    MoveL [[0,60,30]",
        1,
    );
    same("part.mod", &returns, &format!("{LOADED}{POSE}"), &|text| {
        text.replace("tMill", "TMILL")
    });
}

/// The writer reads blocks behind a slash as the program was read.
#[test]
fn blocks_behind_a_slash_run_or_are_left_out() {
    let here = workplace();
    let program = SIEMENS.replace("\nX20 F800", "\n/X20 F800\n/Y9");
    std::fs::write(here.path().join("part.mpf"), program).unwrap();
    for way in ["run", "skip"] {
        let with = format!("{LOADED}{PLACED} --block-delete {way}");
        let (code, said) = verified(here.path(), "part.mpf", &with, str::to_owned);
        assert!(matches!(code, 0 | 4), "{said}");
    }
}

#[test]
fn a_statement_that_ends_the_program_is_one_where_the_original_has_it() {
    let here = workplace();
    let program = "PARTNO T\nUNITS/MM\nLOADTL/1\nRAPID\nGOTO/0,0,30\nFEDRAT/600,MMPM\nGOTO/0,0,0\nGOTO/100,0,0\nRAPID\n\
GOTO/100,0,30\nLOADTL/2\nRAPID\nGOTO/0,60,30\nFEDRAT/600,MMPM\nGOTO/0,60,0\nGOTO/100,60,0\nRAPID\nGOTO/100,60,30\nFINI\n";
    std::fs::write(here.path().join("part.apt"), program).unwrap();
    let with = format!("{LOADED}{PLACED}");
    let (code, said) = verified(here.path(), "part.apt", &with, |text| {
        text.replace("FINI\n", "")
            .replace("LOADTL/2", "FINI\nLOADTL/2")
    });
    assert_eq!(code, 3, "{said}");
    let words = "with statements that nothing leads to, the original with statements that run once";
    assert!(said.contains(words), "{said}");
}

/// Where the orientation is not corrected it is that of the original.
#[test]
fn another_orientation_is_a_fault_where_only_the_position_is_corrected() {
    let here = workplace();
    std::fs::write(here.path().join("part.mod"), TWO_TOOLS).unwrap();
    let with = format!("{LOADED} --rapid-from-mm-per-s 150 --correct position");
    let turned = |text: &str| {
        let lines = text
            .lines()
            .map(|line| match line.contains("MoveL [[120.") {
                true => line.replace("[0,1,0,0]", "[0,0.9990482,0.0436194,0]"),
                false => line.to_owned(),
            });
        lines.collect::<Vec<_>>().join("\n")
    };
    let (code, said) = verified(here.path(), "part.mod", &with, str::to_owned);
    assert!(matches!(code, 0 | 4), "{said}");
    let (code, said) = verified(here.path(), "part.mod", &with, turned);
    assert_eq!(code, 3, "{said}");
    assert!(
        said.contains("ANOTHER ORIENTATION OF THE TOOL at line"),
        "{said}"
    );
}

/// Behind a plunge without a load, which is written as it is, the step is a block of its own.
#[test]
fn a_step_behind_a_block_that_stays_is_a_step() {
    let here = workplace();
    let program =
        "G21 G90 G17\nS6000 M3\nG0 X-20 Y-20 Z10\nG0 Z0.5\nG1 Z-1 F200\nG1 X20 F800\nG0 Z0.5\nM2\n";
    std::fs::write(here.path().join("part.ngc"), program).unwrap();
    let job = "schema = 1\nmodel = \"orthoglide\"\nprogram = \"part.ngc\"\n[placement]\npart_origin_mm = [0, 0, 100]\n[tool]\n\
length_mm = 100\ncutter = { shape = \"flat\", diameter_mm = 6, teeth = 2, helix_deg = 30 }\n[material]\nname = \"AlMg4.5Mn\"\n\
[engagement]\nwidth_mm = 2\ndepth_mm = 1\npart = \"left\"\n";
    std::fs::write(here.path().join("job.toml"), job).unwrap();
    let done = run(here.path(), &["compensate", "job.toml", "--out", "out.ngc"]);
    assert_eq!(done.code, 4, "{done:?}");
    let said = run(here.path(), &["verify", "out.ngc", "--job", "job.toml"]);
    assert_eq!(said.code, 4, "{said:?}");
}

/// Lines of an expanded original are named as they are run and as they are written.
#[test]
fn lines_of_an_expanded_original_are_those_of_its_file() {
    let here = workplace();
    let program = "G21 G90 G17\nG0 X0 Y0 Z5\n#1 = 0\no100 repeat [3]\nG0 X[#1] Y0\nG1 Z-2 F200\nG0 Z5\n#1 = [#1 + 10]\no100 endrepeat\nM2\n";
    std::fs::write(here.path().join("part.ngc"), program).unwrap();
    let with = format!("{LOADED}{PLACED} --expand --dialect linuxcnc");
    let (code, said) = verified(here.path(), "part.ngc", &with, |text| {
        let lines: Vec<&str> = text.lines().collect();
        let last = lines.iter().rposition(|line| line.starts_with("G1"));
        without_line(text, last.unwrap() + 1)
    });
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("(line 6 of part.ngc)"), "{said}");
}
