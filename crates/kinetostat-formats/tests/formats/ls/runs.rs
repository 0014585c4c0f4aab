//! Programs that are run: loops, jumps, branches and calls with the values of registers.

use kinetostat_formats::*;
use nalgebra::Vector3;

use super::{position, read_with, stating, with_lines, written};

fn read(lines: &[&str], values: &[(&str, &str)]) -> RobotProgram {
    let text = with_lines(lines);
    read_with(text.as_bytes(), &stating(values)).unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// Line and reason of what is refused.
fn refused(lines: &[&str], values: &[(&str, &str)]) -> Vec<(usize, String)> {
    let text = with_lines(lines);
    let errors = read_with(text.as_bytes(), &stating(values)).expect_err("it is refused");
    let all = errors.iter();
    all.map(|error| (error.line, error.to_string())).collect()
}

/// X of the positions in hundreds: their numbers.
fn ends(program: &RobotProgram) -> Vec<usize> {
    let motions = program.motions.iter();
    motions
        .map(|motion| (motion.target.pose().unwrap().position_mm.x / 100.0) as usize)
        .collect()
}

fn heights(program: &RobotProgram) -> Vec<f64> {
    let motions = program.motions.iter();
    motions
        .map(|motion| motion.target.pose().unwrap().position_mm.z)
        .collect()
}

fn says(program: &RobotProgram, part: &str) -> bool {
    let mut all = program.findings.iter();
    all.any(|finding| finding.message.contains(part))
}

const SHIFTED: [&str; 15] = [
    "  PR[2,1]=0 ;",
    "  PR[2,2]=0 ;",
    "  PR[2,3]=0 ;",
    "  PR[2,4]=0 ;",
    "  PR[2,5]=0 ;",
    "  PR[2,6]=0 ;",
    "  FOR R[1:pass]=1 TO 3 ;",
    "  PR[2,3]=R[1]*(-2) ;",
    "L P[1] R[7]mm/sec FINE Offset,PR[2] ;",
    "  ENDFOR ;",
    "  IF (R[1]=3 AND PR[2,3]=(-6)) THEN ;",
    "L P[2] 20mm/sec FINE ;",
    "  ELSE ;",
    "L P[3] 20mm/sec FINE ;",
    "  ENDIF ;",
];

#[test]
fn loops_shift_positions_by_registers() {
    let program = read(&SHIFTED, &[("R[7]", "15")]);
    assert_eq!(heights(&program), [3.0, 1.0, -1.0, 5.0]);
    assert_eq!(ends(&program), [1, 1, 1, 2]);
    assert_eq!(program.motions[1].speed.mm_per_s, Some(15.0));
    let runs: Vec<Runs> = program.motions.iter().map(|motion| motion.runs).collect();
    assert_eq!(runs[1..], [Runs::Repeatedly, Runs::Repeatedly, Runs::Once]);
    assert!(says(&program, "`R[7]` is 15, as is stated"));
    let left = "does not come to the motions on line 18: they stay as they are written";
    assert!(says(&program, left), "{:?}", program.findings);
    // Downwards, over no number, and out of the loop.
    let count = |lines: &[&str]| ends(&read(lines, &[])).len();
    let motion = "L P[1] 20mm/sec FINE ;";
    assert_eq!(count(&["  FOR R[1]=3 DOWNTO 1 ;", motion, "  ENDFOR ;"]), 3);
    assert_eq!(count(&["  FOR R[1]=3 TO 1 ;", motion, "  ENDFOR ;"]), 0);
    let lines = [
        "  FOR R[1]=1 TO 9 ;",
        motion,
        "  IF R[1]=4,JMP LBL[1] ;",
        "  ENDFOR ;",
        "  LBL[1] ;",
    ];
    assert_eq!(count(&lines), 4);
}

/// Runs of one statement share its digits where they need the same correction.
#[test]
fn statements_that_run_several_times_take_one_correction() {
    let program = read(
        &[
            "  FOR R[1]=1 TO 2 ;",
            "L P[1] 20mm/sec FINE ;",
            "  ENDFOR ;",
        ],
        &[],
    );
    let lifted = |motion, by| Piece::to(motion, Vector3::new(100.0, 0.0, 5.0 + by));
    let output = written(&program, &[lifted(0, 0.5), lifted(1, 0.5)]);
    assert!(output.contains(&position(1, [100.0, 0.0, 5.5])), "{output}");
    let pieces = [lifted(0, 0.5), lifted(1, 0.25)];
    let error = write(&program, &pieces, &WriteOptions::default()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("line 6: the statement runs several times"),
        "{error}"
    );
}

#[test]
fn jumps_back_run_until_a_register_ends_them() {
    let lines = [
        "  R[1]=0 ;",
        "  LBL[1] ;",
        "L P[1] 20mm/sec FINE ;",
        "  R[1]=R[1]+1 ;",
        "  IF R[1]<3,JMP LBL[R[9]] ;",
        "  LBL[2] ;",
        "L P[2] 20mm/sec FINE ;",
        "  JMP LBL[2] ;",
    ];
    let program = read(&lines, &[("R[9]", "1")]);
    assert_eq!(ends(&program), [1, 1, 1, 2]);
    assert!(says(
        &program,
        "the loop never ends: its first pass is read"
    ));
    // An endless loop around one that ends, and one whose passes differ.
    let outer = [
        "  LBL[9] ;",
        "  R[1]=0 ;",
        "  LBL[1] ;",
        "L P[1] 20mm/sec FINE ;",
        "  R[1]=R[1]+1 ;",
        "  IF R[1]<3,JMP LBL[1] ;",
        "  WAIT DI[1]=ON ;",
        "  JMP LBL[9] ;",
    ];
    let program = read(&outer, &[]);
    assert_eq!(ends(&program), [1, 1, 1]);
    assert!(says(&program, "the loop never ends"));
    let text = with_lines(&[
        "  FOR R[1]=1 TO 999999 ;",
        "L P[1] 20mm/sec FINE ;",
        "  ENDFOR ;",
    ]);
    let errors = read_with(text.as_bytes(), &ReadOptions::default()).unwrap_err();
    assert!(
        errors[0].reason.contains("more than 200000 motions"),
        "{errors:?}"
    );
}

#[test]
fn stated_values_decide_branches() {
    let lines = [
        "L P[1] 20mm/sec FINE ;",
        "  SELECT R[5:kind]=1,JMP LBL[1] ;",
        "         =2,CALL SPRAY ;",
        "         ELSE,JMP LBL[2] ;",
        "L P[2] 20mm/sec FINE ;",
        "  LBL[1] ;",
        "L P[3] 20mm/sec FINE ;",
        "  LBL[2] ;",
        "  IF DI[3:hot]=ON,JMP LBL[3] ;",
        "L P[4] 20mm/sec FINE ;",
        "  LBL[3] ;",
        "L P[1] 20mm/sec FINE ;",
    ];
    let found = refused(&lines, &[("DI[3]", "ON")]);
    assert_eq!((found.len(), found[0].0), (1, 6), "{found:?}");
    let remedy = "`R[5:kind]` is not known from the text; state the value of what decides it (--set NAME=VALUE";
    assert!(found[0].1.contains(remedy), "{found:?}");
    for (kind, hot, expected) in [
        ("1", "ON", &[1, 3, 1][..]),
        ("2", "TRUE", &[1, 2, 3, 1]),
        ("3", "0", &[1, 4, 1]),
        ("3", "OFF", &[1, 4, 1]),
    ] {
        let program = read(&lines, &[("R[5]", kind), ("DI[3]", hot)]);
        assert_eq!(ends(&program), expected, "{kind} {hot}");
    }
    let program = read(&["L P[1] 20mm/sec FINE ;"], &[("R[5]", "1")]);
    assert!(says(
        &program,
        "a value of `R[5]` is stated, and the run does not ask for it"
    ));
}

/// A branch that neither moves the tool nor sets frame or tool is passed over; what it assigns is unknown behind it.
#[test]
fn branches_that_do_not_matter_are_passed_over() {
    let lines = [
        "  R[3]=1 ;",
        "  IF (DI[1]=ON) THEN ;",
        "  R[2]=2 ;",
        "  CALL OFF ;",
        "  ELSE ;",
        "  R[3]=2 ;",
        "  ENDIF ;",
        "  LBL[1] ;",
        "  WAIT .10(sec) ;",
        "  IF DI[2]=OFF,JMP LBL[1] ;",
        "L P[1] 20mm/sec FINE ;",
        "  IF RI[1]=OFF,JMP LBL[99] ;",
        "L P[2] 20mm/sec FINE ;",
        "  END ;",
        "  LBL[99] ;",
        "  UALM[1] ;",
        "  ABORT ;",
    ];
    assert_eq!(ends(&read(&lines, &[])), [1, 2]);
    let mut more = lines.to_vec();
    more.splice(
        13..13,
        [
            "  IF R[3]=2,JMP LBL[98] ;",
            "L P[3] 20mm/sec FINE ;",
            "  LBL[98] ;",
            "L P[4] 20mm/sec FINE ;",
        ],
    );
    let found = refused(&more, &[]);
    assert_eq!((found.len(), found[0].0), (1, 18), "{found:?}");
    assert_eq!(ends(&read(&more, &[("R[3]", "2")])), [1, 2, 4]);
    // Where motions may stay as written, those that may run do.
    let mut options = ReadOptions::default();
    options.unknown_targets = UnknownTargets::LeftAsWritten;
    let program = read_with(with_lines(&more).as_bytes(), &options).unwrap();
    let known = |motion: &Motion| motion.target.pose().is_some();
    let all: Vec<(bool, Runs)> = (program.motions.iter())
        .map(|motion| (known(motion), motion.runs))
        .collect();
    let once = (true, Runs::Once);
    assert_eq!(all, [once, once, (false, Runs::OnCondition), once]);
    assert_eq!(program.motions[3].follows, None);
}

#[test]
fn calls_run_with_their_arguments() {
    let main = with_lines(&[
        "  CALL SUB(1,'deep') ;",
        "L P[3] 20mm/sec FINE ;",
        "  R[1]=2 ;",
        "  CALL SUB(R[1],'flat') ;",
    ]);
    let sub = with_lines(&[
        "  IF (AR[1]=1 AND AR[2]='deep') THEN ;",
        "L P[1] 20mm/sec FINE ;",
        "  END ;",
        "  ENDIF ;",
        "L P[2] 20mm/sec FINE ;",
    ]);
    let files = |sub: &str| {
        vec![
            SourceFile::new("main.ls", main.clone()),
            SourceFile::new("sub.ls", sub.replace("PROG  PART", "PROG  SUB")),
        ]
    };
    let program = read_ls(files(&sub), &ReadOptions::default()).unwrap();
    assert_eq!(ends(&program), [1, 3, 2]);
    assert_eq!(program.motions[2].follows, Some(1));
    // A program that calls itself.
    let endless = with_lines(&["  CALL SUB ;"]);
    let errors = read_ls(files(&endless), &ReadOptions::default()).unwrap_err();
    assert!(
        errors[0].reason.contains("nested deeper than 200"),
        "{errors:?}"
    );
    // What is in none of the files may change any register, but not the counter of the loop.
    let lines = |deciding: &'static str| {
        [
            "  R[2]=1 ;",
            "  FOR R[1]=1 TO 2 ;",
            "  CALL SPINDLE ;",
            deciding,
            "L P[1] 20mm/sec FINE ;",
            "  LBL[1] ;",
            "  ENDFOR ;",
        ]
    };
    assert_eq!(ends(&read(&lines("  IF R[1]=1,JMP LBL[1] ;"), &[])), [1]);
    assert_eq!(refused(&lines("  IF R[2]=2,JMP LBL[1] ;"), &[])[0].0, 8);
}

/// A register that holds a position of the program is an end, too; a corrected one is written as a position.
#[test]
fn positions_in_registers_are_ends() {
    let lines = [
        "  UFRAME_NUM=2 ;",
        "  UTOOL_NUM=1 ;",
        "  PR[1]=P[2] ;",
        "  PR[1,3]=PR[1,3]+10 ;",
        "L PR[1:above] 20mm/sec FINE ;",
        "  R[1]=2 ;",
        "L P[R[1]] 20mm/sec FINE ;",
    ];
    let program = read(&lines, &[]);
    assert_eq!(
        (ends(&program), heights(&program)),
        (vec![2, 2], vec![15.0, 5.0])
    );
    assert_eq!(written(&program, &[]), with_lines(&lines));
    let up = |z| Vector3::new(200.0, 0.0, z);
    let output = written(&program, &[Piece::to(0, up(15.5)), Piece::to(1, up(6.0))]);
    assert!(
        output.contains("   5:L P[6:above] 20mm/sec FINE ;"),
        "{output}"
    );
    assert!(output.contains("   7:L P[5] 20mm/sec FINE ;"), "{output}");
    for (number, z) in [(2, 5.0), (5, 6.0), (6, 15.5)] {
        assert!(
            output.contains(&position(number, [200.0, 0.0, z])),
            "{output}"
        );
    }
    // Several pieces are positions, too.
    let pieces = [(150.0, 15.2), (200.0, 15.5)].map(|(x, z)| Piece::to(0, Vector3::new(x, 0.0, z)));
    let output = written(&program, &pieces);
    assert!(
        output.contains("   5:L P[5:above] 20mm/sec CNT100 ;\n   6:L P[6:above] 20mm/sec FINE ;"),
        "{output}"
    );
    assert_eq!(
        heights(&read_with(output.as_bytes(), &ReadOptions::default()).unwrap())[..2],
        [15.2, 15.5]
    );
}
