//! `verify`: what programs of robots and of other controls say beside their places.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use crate::common::{run, workplace};

const RAPID: &str = "MODULE Part
  PERS tooldata tSpindle:=[TRUE,[[0,0,150],[1,0,0,0]],[5,[0,0,50],[1,0,0,0],0,0,0]];
  PERS tooldata tOther:=[TRUE,[[0,0,150],[1,0,0,0]],[5,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata wPart:=[FALSE,TRUE,\"\",[[1300,50,900],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PROC main()
    MoveL [[0,0,30],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tSpindle\\WObj:=wPart;
    MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tSpindle\\WObj:=wPart;
    MoveL [[120,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tSpindle\\WObj:=wPart;
    MoveL [[0,60,0],[0,0.9848078,0.1736482,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tSpindle\\WObj:=wPart;
    MoveL [[0,60,30],[0,0.9848078,0.1736482,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tSpindle\\WObj:=wPart;
  ENDPROC
ENDMODULE
";
pub(crate) const KRL: &str = "DEF part()\n $BASE={X 1300,Y 50,Z 900,A 0,B 0,C 0}\n $TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}\n $VEL.CP=0.2\n LIN {X 0,Y 0,Z 30,A 0,B 0,C 180}\n \
$VEL.CP=0.02\n LIN {X 0,Y 0,Z 0,A 0,B 0,C 180}\n LIN {X 120,Y 0,Z 0,A 0,B 0,C 180}\n $VEL.CP=0.2\n LIN {X 120,Y 0,Z 30,A 0,B 0,C 180}\nEND\n";
const HEIDENHAIN: &str = "BEGIN PGM h MM\nTOOL CALL 1 Z S5000\nL X+0 Y+0 Z+30 R0 FMAX M3\nL Z+0 F600\nL X+100\nL Y+60\nL Z+30 FMAX\nM30\nEND PGM h MM\n";
const APT: &str = "PARTNO T\nUNITS/MM\nLOADTL/1\nSPINDL/5000,RPM,CLW\nRAPID\nGOTO/0,0,30\nFEDRAT/600,MMPM\nGOTO/0,0,0\nGOTO/100,0,0\nGOTO/100,60,0\nRAPID\nGOTO/100,60,30\nFINI\n";
const SHIFTED: &str = "G21 G90 G17 G94\nT1 M6\nS5000 M3\nG92 X0 Y0 Z30\nG0 X0 Y0 Z30\nG1 Z0 F600\nX100\nY60\nG0 Z30\nM2\n";

pub(crate) const LOADED: &str = "--model heavy_6r --weight all --force 200 -150 300";
pub(crate) const POSE: &str = " --rapid-from-mm-per-s 150 --correct pose";
pub(crate) const PLACED: &str = " --tool-length-mm 150 --part-origin-mm 1300 50 900";

/// What is said of a compensated program that was changed, and the exit code.
pub(crate) fn verified(
    here: &Path,
    original: &str,
    with: &str,
    change: impl Fn(&str) -> String,
) -> (i32, String) {
    let end = original.rsplit_once('.').unwrap().1;
    let (out, other) = (format!("out.{end}"), format!("other.{end}"));
    let options: Vec<&str> = with.split_whitespace().collect();
    let mut line = vec![
        "compensate",
        "--program",
        original,
        "--out",
        &out,
        "--force-overwrite",
    ];
    line.extend(&options);
    let done = run(here, &line);
    assert!(matches!(done.code, 0 | 4), "{done:?}");
    let text = std::fs::read_to_string(here.join(&out)).unwrap();
    std::fs::write(here.join(&other), change(&text)).unwrap();
    let mut line = vec!["verify", other.as_str(), "--against", original];
    line.extend(&options);
    let said = run(here, &line);
    let text = format!("{}{}", said.out, said.err);
    (
        said.code,
        text.split_whitespace().collect::<Vec<_>>().join(" "),
    )
}

/// Own programs pass, and each change gets its exit code and its words.
pub(crate) fn changes(name: &str, program: &str, with: &str, all: &[(&str, &str, i32, &str)]) {
    let here = workplace();
    std::fs::write(here.path().join(name), program).unwrap();
    let (code, said) = verified(here.path(), name, with, str::to_owned);
    assert!(matches!(code, 0 | 4), "{said}");
    assert!(
        !said.contains("in the original at") && !said.contains("ANOTHER"),
        "{said}"
    );
    for (from, to, wanted, words) in all {
        let (code, said) = verified(here.path(), name, with, |text| {
            assert!(text.contains(from), "{from}: {text}");
            text.replace(from, to)
        });
        assert_eq!(code, *wanted, "{from} -> {to}: {said}");
        assert!(said.contains(words), "{from} -> {to}: {said}");
    }
}

/// Frames, tools and zones of a robot's program were those of the original, whatever the program says.
#[test]
fn frames_and_tools_of_a_robot_are_those_of_the_original() {
    let tool = "tooldata tSpindle:=[TRUE,[[0,0,150],[1,0,0,0]]";
    changes(
        "part.mod",
        RAPID,
        &format!("{LOADED}{POSE}"),
        &[
            (
                "[[1300,50,900]",
                "[[1000,50,900]",
                3,
                "it is at (1000, 50, 900) mm",
            ),
            (
                "[[1300,50,900],[1,0,0,0]]",
                "[[1300,50,900],[0.9999619,0,0,0.0087265]]",
                3,
                "it is turned by 1",
            ),
            (
                tool,
                "tooldata tSpindle:=[TRUE,[[0,0,151],[1,0,0,0]]",
                3,
                "it is at (0, 0, 151) mm",
            ),
            (
                "\\WObj:=wPart;",
                ";",
                3,
                "with work object 'wobj0', the original with work object 'wPart'",
            ),
            (
                ",tSpindle\\",
                ",tOther\\",
                0,
                "with tool 'tOther', the original with tool 'tSpindle'",
            ),
            (
                "  ENDPROC",
                "    Elsewhere;\n  ENDPROC",
                0,
                "ELSEWHERE at line",
            ),
            (
                "  ENDPROC",
                "    %\"Elsewhere\"%;\n  ENDPROC",
                0,
                "%\"ELSEWHERE\"% at line",
            ),
            (
                "  ENDPROC",
                "    MoveAbsJ [[0,0,0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tSpindle;\n  ENDPROC",
                3,
                "by joint values",
            ),
            ("v20,fine", "v20,z50", 3, "stop at their ends"),
            ("v20,fine", "v20,z50", 3, "is passed at up to 50 mm"),
            (
                "[0,0,0,0],[9E9",
                "[0,0,0,1],[9E9",
                0,
                "configuration [0,0,0,1]",
            ),
        ],
    );
    changes(
        "part.src",
        KRL,
        &format!("{LOADED}{POSE}"),
        &[
            ("$BASE={X 1300", "$BASE={X 1200", 3, "ANOTHER FRAME"),
            (
                "$TOOL={X 0,Y 0,Z 150,A 0",
                "$TOOL={X 0,Y 0,Z 150,A 90",
                3,
                "ANOTHER TOOL",
            ),
        ],
    );
}

/// Where the orientation is corrected too, a tool that is tilted is a fault.
#[test]
fn a_tilted_tool_is_a_fault_where_its_pose_is_corrected() {
    let here = workplace();
    std::fs::write(here.path().join("part.mod"), RAPID).unwrap();
    let tilt = |text: &str| {
        let line = text
            .lines()
            .find(|line| line.contains("MoveL [[120."))
            .unwrap();
        let from = line.find("],[").unwrap() + 3;
        let to = from + line[from..].find(']').unwrap();
        text.replace(
            line,
            &format!("{}0.0087265,0.9999619,0,0{}", &line[..from], &line[to..]),
        )
    };
    let with = format!("{LOADED}{POSE}");
    let (code, said) = verified(here.path(), "part.mod", &with, tilt);
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("THE TOOL IS TILTED at line"), "{said}");
}

/// What a Heidenhain control or APT calls for, and a shift before the first place.
#[test]
fn calls_for_tools_and_shifts_are_compared() {
    let with = format!("{LOADED}{PLACED}");
    changes(
        "part.h",
        HEIDENHAIN,
        &with,
        &[
            (
                "TOOL CALL 1 Z",
                "TOOL CALL 2 Z",
                3,
                "with tool 'TOOL:2', the original with tool 'TOOL:1'",
            ),
            (
                "TOOL CALL 1 Z S5000",
                "TOOL CALL 1 Z S5000 DL+1",
                3,
                "cut with DL1, the original with no DL and DR",
            ),
            (
                "S5000",
                "S500",
                3,
                "cut with M3 at 500 rpm, the original with M3 at 5000 rpm",
            ),
            (
                "FMAX M3",
                "FMAX M4",
                3,
                "cut with M4 at 5000 rpm, the original with M3",
            ),
        ],
    );
    changes(
        "part.apt",
        APT,
        &with,
        &[
            (
                "LOADTL/1",
                "LOADTL/2",
                3,
                "with tool 'TOOL:2', the original with tool 'TOOL:1'",
            ),
            (
                "LOADTL/1",
                "TOOLNO/1",
                0,
                "LOADTL/1 at line 3 of the original",
            ),
        ],
    );
    changes(
        "part.ngc",
        SHIFTED,
        &with,
        &[(
            "G92 X0 Y0 Z30\n",
            "",
            3,
            "cut with no G92 before the first place, the original with G92",
        )],
    );
}
