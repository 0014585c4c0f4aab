//! Programs that repeat, jump, count and drill, written flat.

use kinetostat_formats::*;

use super::{flat, place, program};

fn text(blocks: &str) -> String {
    format!("BEGIN PGM A MM\n{blocks}END PGM A MM\n")
}

fn blocks_of(body: &str) -> Vec<String> {
    let output = flat(&text(body));
    let lines: Vec<String> = output.lines().map(str::to_owned).collect();
    lines[1..lines.len() - 1].to_vec()
}

fn refused(body: &str) -> String {
    let files = vec![SourceFile::new("a.h", text(body))];
    expand_heidenhain(files, &ReadOptions::default()).unwrap_err()[0].to_string()
}

#[test]
fn subprograms_and_repeats_run_as_often_as_they_say() {
    let body = "L X+0 FMAX\nCALL LBL 1\nCALL LBL \"TWO\" REP 2\nL Y+9\nCALL LBL 1\nL M30\nLBL 1\nL IX+1 F100\nCALL LBL \"TWO\"\nLBL 0\nLBL \"TWO\"\nL IY+1\nLBL 0\n";
    // The repeat goes to a label below: its part ends with LBL 0, which belongs to no call there.
    let lines = blocks_of(&body.replace("CALL LBL \"TWO\" REP 2\n", ""));
    assert_eq!(
        lines,
        [
            "L X+0 FMAX",
            "L IX+1 F100",
            "L IY+1",
            "L Y+9",
            "L IX+1 F100",
            "L IY+1",
            "L M30"
        ]
    );
    let nested = "LBL 1\nLBL 2\nL IX+1\nCALL LBL 2 REP 2/2\nL IY+1\nCALL LBL 1 REP 1/1\n";
    let lines = blocks_of(nested);
    let runs = |what: &str| lines.iter().filter(|line| line.as_str() == what).count();
    assert_eq!((runs("L IX+1"), runs("L IY+1")), (6, 2));
}

#[test]
fn parameters_are_computed_as_the_control_does() {
    let body = "FN 0: Q1 = +60\nFN 1: Q2 = -Q1 + -5\nFN 2: Q3 = +10 - +4\nFN 3: Q4 = +3 * +3\nFN 4: Q5 = +4 DIV +8\nFN 5: Q6 = SQRT +4\n\
        FN 6: Q7 = SIN +30\nFN 7: Q8 = COS +60\nFN 8: Q9 = +3 LEN +4\nFN 13: Q10 = +1 ANG -1\n\
        Q11 = (Q1 + 5 * 2) / 7 - 2 ^ 3\nQ12 = SQRT 16 + ABS - 3 + INT 2,7 + SGN -4\nQ13 = NEG ATAN 1\nQL1 = ASIN 0.5 + ACOS 0.5\n\
        L X+Q2 Y-Q3 Z+Q4\nL X+Q5 Y+Q6 Z+Q7\nL X+Q8 Y+Q9 Z+Q10\nL X+Q11 Y+Q12 Z+Q13 FQ1\nL XQL1\n";
    assert_eq!(
        blocks_of(body),
        [
            "L X-65 Y-6 Z+9",
            "L X+0.5 Y+2 Z+0.5",
            "L X+0.5 Y+5 Z+135",
            "L X+2 Y+8 Z-45 F60",
            "L X+90",
        ]
    );
}

#[test]
fn jumps_follow_their_comparison() {
    let body = "Q1 = 0\nLBL 1\nQ1 = Q1 + 1\nL X+Q1\nFN 12: IF +Q1 LT +3 GOTO LBL 1\nFN 9: IF +Q1 EQU +3 GOTO LBL \"OUT\"\nL X+99\nLBL \"OUT\"\nFN 11: IF +Q1 GT +3 GOTO LBL 1\nFN 10: IF +Q1 NE +3 GOTO LBL 1\nL Y+1\n";
    assert_eq!(blocks_of(body), ["L X+1", "L X+2", "L X+3", "L Y+1"]);
}

#[test]
fn local_parameters_are_those_of_one_program() {
    let called = |main: &str, sub: &str| {
        let files = vec![
            SourceFile::new("main.h", text(main)),
            SourceFile::new("SUBQ.H", text(sub)),
        ];
        expand_heidenhain(files, &ReadOptions::default())
    };
    let main =
        "QL1 = 7\nQ1 = 3\nQR1 = 4\nL X+QL1 Y+0 Z+0 F500\nCALL PGM SUBQ.H\nL X+QL1 Y+Q1 Z+QR1\n";
    let flat = called(main, "QL1 = 99\nQ1 = Q1 + 10\nQR1 = 5\nL Y+QL1\n").unwrap();
    let flat = super::program(&String::from_utf8_lossy(flat.file.bytes()));
    let places: Vec<[f64; 3]> = (0..3).map(|at| place(&flat, at)).collect();
    assert_eq!(
        places,
        [[7.0, 0.0, 0.0], [7.0, 99.0, 0.0], [7.0, 13.0, 5.0]]
    );
    // What the caller's QL parameters are, the called program does not know; nor the caller those of it.
    let without = called(main, "L Y+QL1\n").unwrap_err()[0].to_string();
    assert_eq!(
        without,
        "SUBQ.H, line 2: `L Y+QL1`: QL1 has no value that its program states (QL parameters are those of one program: one that is called has its own); state it before (FN 0: Q1 = +5), or give the value that it has on the machine (--set Q1=5)"
    );
    let behind = called("CALL PGM SUBQ\nL X+QL2\n", "QL2 = 1\n").unwrap_err();
    assert!(
        behind[0]
            .to_string()
            .starts_with("main.h, line 3: `L X+QL2`")
    );
    // A label belongs to the same program.
    let same = "QL1 = 7\nCALL LBL 1\nL X+QL1 M30\nLBL 1\nQL1 = QL1 + 1\nLBL 0\n";
    assert_eq!(blocks_of(same), ["L X+8 M30"]);
}

#[test]
fn other_programs_run_where_they_are_called_and_lines_say_where_from() {
    let main = "0 BEGIN PGM MAIN MM\n1 Q1 = 5\n2 CALL PGM TNC:\\PARTS\\Sub.h ; here\n3 L Y+Q2\n4 END PGM MAIN MM\n";
    let sub = "BEGIN PGM SUB MM\nL X+Q1\nQ2 = Q1 * 2\nEND PGM SUB MM\n";
    let files = vec![
        SourceFile::new("main.h", main),
        SourceFile::new("dir/SUB.H", sub),
    ];
    let flat = expand_heidenhain(files, &ReadOptions::default()).unwrap();
    assert_eq!(
        String::from_utf8_lossy(flat.file.bytes()),
        "0 BEGIN PGM MAIN MM\n1 L X+5\n2 L Y+10\n3 END PGM MAIN MM\n"
    );
    assert_eq!(flat.origins, [(0, 1), (1, 2), (0, 4), (0, 5)]);
    assert_eq!(flat.file.name(), "main.h");
}

#[test]
fn a_program_that_is_called_is_whole() {
    let main = "BEGIN PGM MAIN MM\nCALL PGM SUB\nEND PGM MAIN MM\n";
    for (sub, part) in [
        (
            "BEGIN PGM SUB MM\nL X+1\n",
            "line 2: `L X+1`: no block END PGM ends the program that is called",
        ),
        (
            "BEGIN PGM SUB MM\nLBL 1\nLBL 1\nEND PGM SUB MM\n",
            "line 3: `LBL 1`: there is a label of this name above, in line 2;",
        ),
        (
            "BEGIN PGM SUB MM\nL X+1\nEND PGM OTHER MM\n",
            "line 3: `END PGM OTHER MM`: the program ends as OTHER and begins as SUB in line 1",
        ),
    ] {
        let files = vec![SourceFile::new("m.h", main), SourceFile::new("sub.h", sub)];
        let found = expand_heidenhain(files, &ReadOptions::default()).unwrap_err();
        assert_eq!(found[0].file, "sub.h");
        assert!(found[0].to_string().contains(part), "{found:?}");
    }
    // Nor are there two of its name.
    let sub = "BEGIN PGM SUB MM\nL X+1\nEND PGM SUB MM\n";
    let files = [("m.h", main), ("a/sub.h", sub), ("b/SUB.H", sub)];
    let files = files
        .map(|(name, text)| SourceFile::new(name, text))
        .to_vec();
    let found = expand_heidenhain(files, &ReadOptions::default()).unwrap_err();
    let both = "b/SUB.H, line 1: `BEGIN PGM SUB MM`: a call cannot tell this program from that of the same name in a/sub.h, line 1";
    assert!(found[0].to_string().contains(both), "{found:?}");
}

#[test]
fn holes_of_cycle_200_go_to_their_depth_in_pecks() {
    let body = "TOOL CALL 1 Z S100\nL Z+50 R0 FMAX M3\nL X+1 Y+2 F700\n\
        CYCL DEF 200 DRILLING ~\n  Q200=+2 ;SET-UP CLEARANCE ~\n  Q201=-12 ;DEPTH ~\n  Q206=+150 ;FEED ~\n  Q202=+5 ;PECK ~\n  Q210=+0 ;DWELL ~\n  Q203=-10 ;SURFACE ~\n  Q204=+30 ;2ND CLEARANCE ~\n  Q211=+0.5 ;DWELL BELOW\n\
        CYCL CALL M8\nL X+20 FMAX M99\nL FMAX M99\nL X+30\n";
    let lines = blocks_of(body);
    let hole = [
        "L Z-8 R0 FMAX",
        "L Z-15 R0 F150",
        "L Z-8 R0 FMAX",
        "L Z-13 R0 FMAX",
        "L Z-20 R0 F150",
        "L Z-8 R0 FMAX",
        "L Z-18 R0 FMAX",
        "L Z-22 R0 F150",
        "CYCL DEF 9.0 DWELL TIME",
        "CYCL DEF 9.1 DWELL 0.5",
        "L Z-8 R0 FMAX",
        "L Z+20 R0 FMAX",
    ];
    let mut expected = vec![
        "TOOL CALL 1 Z S100",
        "L Z+50 R0 FMAX M3",
        "L X+1 Y+2 F700",
        "M8",
    ];
    expected.extend(hole);
    expected.push("L X+20 FMAX");
    expected.extend(hole);
    expected.extend(hole);
    // The feed of before is stated again.
    expected.push("L X+30 F700");
    assert_eq!(lines, expected);
    // Flat, it is read: the bottom of the second hole.
    let program = program(&flat(&text(body)));
    let deepest = (0..program.motions.len()).filter(|index| {
        let end = program.motions[*index].target.pose();
        end.is_some_and(|end| (end.position_mm.z + 22.0).abs() < 1e-9)
    });
    let places: Vec<[f64; 3]> = deepest.map(|index| place(&program, index)).collect();
    assert_eq!(
        places,
        [[1.0, 2.0, -22.0], [20.0, 2.0, -22.0], [20.0, 2.0, -22.0]]
    );
}

#[test]
fn reaming_universal_drilling_and_pecking_go_their_ways() {
    let reamed = blocks_of(
        "CYCL DEF 201 REAMING ~\n Q200=+2 ~\n Q201=-5 ~\n Q206=+100 ~\n Q211=+0 ~\n Q208=+250 ~\n Q203=+0 ~\n Q204=+10\nL X+1 Y+1 M89\nL X+2 M99\nL X+3\n",
    );
    let hole = [
        "L Z+2 R0 FMAX",
        "L Z-5 R0 F100",
        "L Z+2 R0 F250",
        "L Z+10 R0 FMAX",
    ];
    let mut expected = vec!["L X+1 Y+1"];
    expected.extend(hole);
    expected.push("L X+2");
    expected.extend(hole);
    expected.push("L X+3");
    assert_eq!(reamed, expected);
    // One chip is broken in the hole, then it is cleared; pecks become smaller.
    let universal = blocks_of(
        "CYCL DEF 203 UNIVERSAL ~\n Q200=+1 ~\n Q201=-10 ~\n Q206=+90 ~\n Q202=+4 ~\n Q210=+0 ~\n Q203=+0 ~\n Q204=+0 ~\n Q212=+1 ~\n Q213=+1 ~\n Q205=+2 ~\n Q211=+0 ~\n Q208= MAX ~\n Q256=+0.2\nL X+1 FMAX M99\n",
    );
    assert_eq!(
        universal,
        [
            "L X+1 FMAX",
            "L Z+1 R0 FMAX",
            "L Z-4 R0 F90",
            "L Z-3.8 R0 FMAX",
            "L Z-7 R0 F90",
            "L Z+1 R0 FMAX",
            "L Z-6 R0 FMAX",
            "L Z-9 R0 F90",
            "L Z-8.8 R0 FMAX",
            "L Z-10 R0 F90",
            "L Z+1 R0 FMAX",
        ]
    );
    let pecked = blocks_of(
        "CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP 2\nCYCL DEF 1.2 DEPTH -6\nCYCL DEF 1.3 PECKG 4\nCYCL DEF 1.4 DWELL 1\nCYCL DEF 1.5 F80\nL Z+2 FMAX M99\n",
    );
    assert_eq!(
        pecked,
        [
            "L Z+2 FMAX",
            "L IZ-6 R0 F80",
            "L IZ+6 R0 FMAX",
            "L IZ-5.4 R0 FMAX",
            "L IZ-2.6 R0 F80",
            "CYCL DEF 9.0 DWELL TIME",
            "CYCL DEF 9.1 DWELL 1",
            "L IZ+8 R0 FMAX",
        ]
    );
}

#[test]
fn runs_are_bounded_and_faults_name_their_line() {
    let cases = [
        (
            "LBL 1\nCALL LBL 1\nLBL 0\n",
            "line 3: `CALL LBL 1`: calls and repeats are nested more than 20 deep",
        ),
        (
            "LBL 1\nFN 9: IF +0 EQU +0 GOTO LBL 1\n",
            "more than a million blocks that write nothing",
        ),
        (
            "LBL 1\nL IX+1\nCALL LBL 1 REP 65534\nLBL 2\nL IX+1\nCALL LBL 2 REP 65534\nLBL 3\nCALL LBL 1 REP 65534\n",
            "more than 5 million blocks",
        ),
        (
            "CALL LBL 5\n",
            "line 2: `CALL LBL 5`: there is no LBL 5; write the label",
        ),
        (
            "LBL 1\nL IX+1\nCALL LBL 1 REP 0\n",
            "not a whole number from 1 to 65534",
        ),
        (
            "LBL 1\nL IX+1\nCALL LBL 1 REP 1e3\n",
            "line 4: `CALL LBL 1 REP 1e3`: a number with an exponent",
        ),
        (
            "LBL 1\nL IX+1\nCALL LBL 1 REP 2 M8\n",
            "not a whole number from 1 to 65534",
        ),
        (
            "LBL 1 L X+5\nL IX+1 M99\n",
            "line 2: `LBL 1 L X+5`: more stands behind the label",
        ),
        (
            "L X+Q7\n",
            "line 2: `L X+Q7`: Q7 has no value that the program states; state it before (FN 0: Q1 = +5), or give the value",
        ),
        (
            "Q1 = Q2 + 1\nL X+Q1\n",
            "line 2: `Q1 = Q2 + 1`: Q2 has no value",
        ),
        ("Q1 = 1 / 0\nL X+Q1\n", "divides by zero"),
        ("Q1 = SQRT -1\nL X+Q1\n", "no finite value"),
        ("Q1 = FOO 3\nL X+Q1\n", "the function FOO is not known"),
        ("Q1 = (1 + 2\nL X+Q1\n", "a bracket is not closed"),
        ("Q1 = 1 2\nL X+Q1\n", "not understood to its end"),
        (
            "FN 18: SYSREAD Q3 = ID270 NR1 IDX1\nL X+Q3\n",
            "line 3: `L X+Q3`: Q3 has no value",
        ),
        ("L X+1 M99\n", "no cycle is defined"),
        (
            "LBL 1\nL X+1\nLBL 1\nCALL LBL 1 REP 2\n",
            "line 4: `LBL 1`: there is a label of this name above, in line 2; name it otherwise",
        ),
        (
            "CYCL DEF 207 RIGID TAPPING ~\n Q200=+2 ~\n Q201=-10\nL X+1 M99\n",
            "line 5: `L X+1 M99`: cycle 207 is called, and what it does is not followed",
        ),
        (
            "CYCL DEF 200 DRILLING ~\n Q200=+2 ~\n Q201=+10 ~\n Q203=+0 ~\n Q206=+5\nL X+1 M99\n",
            "the depth of the cycle is above the surface",
        ),
        (
            "CYCL DEF 200 DRILLING ~\n Q200=+2 ~\n Q201=-10 ~\n Q203=+0\nL X+1 M99\n",
            "the cycle has no feed",
        ),
        (
            "CYCL DEF 200 DRILLING ~\n Q200=+2 ~\n Q201=-10 ~\n Q206=+9 ~\n Q203=+0 ~\n Q211=-1\nL X+1 M99\n",
            "the dwell of the cycle is below zero",
        ),
        (
            "CYCL DEF 200 DRILLING ~\n Q200=+2 ~\n Q201=-10 ~\n Q206=+9 ~\n Q203=+0 ~\n Q395=+1\nL X+1 M99\n",
            "the drill's full diameter (Q395)",
        ),
        (
            "CYCL DEF 200 DRILLING ~\n Q201=-10 ~\n Q206=+9 ~\n Q203=+0\nL X+1 M99\n",
            "Q200 of cycle 200 is stated nowhere",
        ),
        ("Q1 = 1\n/L X+Q1\n", "depends on a switch at the machine"),
        (
            "FN 14: ERROR = 1000\nCALL LBL 1\nLBL 1\nL X+1\nLBL 0\n",
            "ends here with an error of its own",
        ),
    ];
    for (body, part) in cases {
        let message = refused(body);
        assert!(message.contains(part), "{body}: {message}");
    }
    let deep = format!("Q1 = {}1\nL X+Q1\n", "(".repeat(100_000));
    assert!(refused(&deep).contains("nested more than 64 deep"));
}

/// The first parameter may stand behind the name of the cycle, on its line.
#[test]
fn parameters_on_the_line_of_the_cycle_count() {
    let hole = |cycle: &str| {
        blocks_of(&format!(
            "TOOL CALL 1 Z S100\nL Z+50 R0 FMAX M3\n{cycle}\nL X+1 FMAX M99\n"
        ))
    };
    let below = "CYCL DEF 200 DRILL ~\n Q200=+2 ~\n Q201=-10 ~\n Q206=+150 ~\n Q202=+10 ~\n Q203=+0 ~\n Q204=+50";
    let expected = hole(below);
    assert!(
        expected.iter().any(|line| line == "L Z-10 R0 F150"),
        "{expected:?}"
    );
    for beside in [
        "CYCL DEF 200 DRILL Q200=+2 ~\n Q201=-10 ~\n Q206=+150 ~\n Q202=+10 ~\n Q203=+0 ~\n Q204=+50",
        "CYCL DEF 200 UNIVERSAL DRILL Q201=-10 Q200=2 Q206=150 Q202=10 Q203=0 Q204=50",
        "CYCL DEF 200 Q200=+2 Q201=-10 Q206=+150 Q202=+10 Q203=+0 Q204=+50",
    ] {
        assert_eq!(hole(beside), expected, "{beside}");
    }
}

#[test]
fn cycles_that_are_not_followed_stay_where_that_is_asked_for() {
    let body =
        text("Q1 = 4\nCYCL DEF 207 RIGID TAPPING ~\n Q200=+2 ~\n Q201=-10\nL X+Q1 Y+1 FMAX M99\n");
    let mut options = ReadOptions::default();
    options.unknown_targets = UnknownTargets::LeftAsWritten;
    let flat = expand_heidenhain(vec![SourceFile::new("a.h", body)], &options).unwrap();
    let output = String::from_utf8_lossy(flat.file.bytes()).into_owned();
    assert!(output.contains("\nL X+4 Y+1 FMAX M99\n"), "{output}");
    let program = read_heidenhain(vec![flat.file], &options).unwrap();
    assert!(program.motions[0].target.pose().is_none());
}

#[test]
fn an_endless_loop_is_named_by_the_jump_back_and_nothing_is_read_of_it() {
    let within = |body: &str| {
        let files = vec![SourceFile::new("a.h", text(body))];
        internal::expand_heidenhain_within(files, &ReadOptions::default(), 1000).unwrap_err()
    };
    for (body, line) in [
        ("LBL 1\nL IX+1 F100\nFN 9: IF +0 EQU +0 GOTO LBL 1\n", 4),
        // What runs in it and is called there is not meant.
        (
            "LBL 1\nLBL 3\nL IX+1 F100\nCALL LBL 3 REP 2\nCALL LBL 2\nFN 9: IF +0 EQU +0 GOTO LBL 1\nL M30\nLBL 2\nL IY+1\nLBL 0\n",
            7,
        ),
        // Nothing is written.
        ("LBL 1\nQ1 = 2\nFN 9: IF +0 EQU +0 GOTO LBL 1\n", 4),
    ] {
        let found = within(body);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].line, line, "{found:?}");
        let said = found[0].to_string();
        assert!(
            said.contains("the loop that goes back here does not end"),
            "{said}"
        );
    }
    // A repeat that is too long ends.
    let found = within("LBL 1\nL IX+1 F100\nCALL LBL 1 REP 65000\n");
    assert!(
        found[0].to_string().contains("repeat fewer times"),
        "{found:?}"
    );
}

#[test]
fn a_feed_by_turns_is_known_while_the_spindle_turns() {
    let body = "TOOL CALL 1 Z S5000\nL X+0 Y+0 Z+10 R0 FMAX M3\nL Y+10 M136 F0.12\nTOOL CALL S250\nL Y+20\nL Y+30 M137 F600\nL Y+40 M136 F0.12 M5\nL Y+50\n";
    let program = program(&text(body));
    let found: Vec<Option<f64>> = program
        .motions
        .iter()
        .map(|one| one.speed.mm_per_s)
        .collect();
    let near = |index: usize, speed: f64| (found[index].unwrap() - speed).abs() < 1e-12;
    assert!(
        near(1, 0.12 * 5000.0 / 60.0) && near(2, 0.12 * 250.0 / 60.0) && near(3, 10.0),
        "{found:?}"
    );
    assert!(found[4].is_none() && found[5].is_none(), "{found:?}");
}

/// Taps and borings are the control's own: their calls stay, over each hole, whose place is corrected.
#[test]
fn cycles_of_the_control_stay_over_their_holes() {
    let define = "CYCL DEF 207 RIGID TAPPING ~\n Q200=+2 ~\n Q201=-10 ~\n Q239=+1 ~\n Q203=+5 ~\n Q204=+50\n";
    let body = text(&format!(
        "L X+0 Y+0 Z+60 R0 FMAX\nL F200\n{define}L X+10 FMAX M99\nL Y+7 FMAX\nCYCL CALL\nL Y+9\n"
    ));
    let flat =
        expand_heidenhain(vec![SourceFile::new("a.h", body)], &ReadOptions::default()).unwrap();
    let output = String::from_utf8_lossy(flat.file.bytes()).into_owned();
    let hole = "L Z+7 R0 FMAX\nCYCL CALL\nL Z+55 R0 FMAX\n";
    let expected = format!("L X+10 FMAX\n{hole}L Y+7 FMAX\n{hole}L Y+9 F200\n");
    assert!(output.contains(&expected), "{output}");
    assert!(output.contains("CYCL DEF 207 RIGID TAPPING"), "{output}");
    let program = read_heidenhain(vec![flat.file], &ReadOptions::default()).unwrap();
    let ends: Vec<[f64; 3]> = (program.motions.iter())
        .map(|motion| motion.target.pose().unwrap().position_mm.into())
        .collect();
    assert_eq!(
        ends[1..],
        [
            [10.0, 0.0, 60.0],
            [10.0, 0.0, 7.0],
            [10.0, 0.0, 55.0],
            [10.0, 7.0, 55.0],
            [10.0, 7.0, 7.0],
            [10.0, 7.0, 55.0],
            [10.0, 9.0, 55.0]
        ]
    );
    assert_eq!(
        (program.motions[3].follows, program.motions[4].follows),
        (None, Some(3))
    );
    let path = path_of(&program, &PathOptions::default()).unwrap().path;
    assert!(path.unjudged_feed_on.is_some());
    // Over no place, and beside other words, it is refused as before.
    let read = |body: &str| {
        let file = SourceFile::new("a.h", text(body));
        read_heidenhain(vec![file], &ReadOptions::default())
    };
    for body in [
        format!("L Z+9 FMAX\n{define}CYCL CALL\n"),
        format!("L X+0 Y+0 Z+9 FMAX\n{define}L X+5 FMAX M99\n"),
    ] {
        let refused = read(&body).unwrap_err();
        assert!(
            refused
                .iter()
                .any(|fault| fault.reason.contains("cycle 207 is called")),
            "{refused:?}"
        );
    }
}
