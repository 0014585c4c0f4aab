//! Broken programs in KRL's newer forms: spline blocks, steps, values in braces, inline forms of KSS 8, data lists.

use kinetostat_formats::*;

const DATA: &str = "DEFDAT a\n\
    DECL E6POS XP1={X 1,Y 2,Z 3,A 0,B 0,C 180,S 2,T 3}\n\
    DECL FDAT FP1={TOOL_NO 1,BASE_NO 1,IPO_FRAME #BASE,POINT2[] \" \"}\n\
    DECL FDAT FP2={TOOL_NO 1,BASE_NO 1,IPO_FRAME #TCP,POINT2[] \" \"}\n\
    DECL LDAT LCPDAT1={VEL 2.0,ACC 100.0,APO_DIST 5.0,ORI_TYP #VAR,CIRC_TYP #BASE}\n\
    DECL LDAT LCPDAT2={VEL 2.0,ACC 100.0,APO_DIST 5.0,ORI_TYP #JOINT,CIRC_TYP #PATH}\n";

fn refused(source: &str, data: &str) -> Vec<(String, usize, String)> {
    let files = vec![
        SourceFile::new("a.src", source),
        SourceFile::new("a.dat", data),
    ];
    let found = read_krl(files, &ReadOptions::default()).expect_err("it is refused");
    let shown = found
        .iter()
        .map(|error| (error.file.clone(), error.line, error.to_string()));
    shown.collect()
}

/// Statements behind a first motion, which is line 2.
fn behind_a_motion(statements: &str) -> Vec<(usize, String)> {
    let source = format!("DEF a()\nPTP XP1\n{statements}\nEND\n");
    let found = refused(&source, &format!("{DATA}ENDDAT\n"));
    assert!(found.iter().all(|(file, ..)| file == "a.src"), "{found:?}");
    found
        .into_iter()
        .map(|(_, line, text)| (line, text))
        .collect()
}

/// What each of the statements is refused for, and in which lines: of all that is wrong, and nothing else.
fn each_is_refused(cases: &[(&str, &[(usize, &str)])]) {
    for (statements, wanted) in cases {
        let found = behind_a_motion(statements);
        let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
        let wanted_lines: Vec<usize> = wanted.iter().map(|(line, _)| *line).collect();
        assert_eq!(lines, wanted_lines, "{statements}: {found:#?}");
        for ((_, text), (_, part)) in found.iter().zip(*wanted) {
            assert!(text.contains(part), "{statements}: {text}");
        }
    }
}

#[test]
fn words_beside_a_variable_are_no_part_of_it() {
    each_is_refused(&[
        (
            "SLIN XP1 WITH $VEL D=0.2",
            &[(3, "`$VEL D` is no variable")],
        ),
        (
            "$VEL.CP D=0.2\nLIN XP1",
            &[(3, "`$VEL.CP D` is no variable")],
        ),
    ]);
    // A row of an array of texts.
    let text = "DEF a()\nCHAR text[2,10]\ntext[1,]=\"a\"\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nEND\n";
    let read = read_krl(
        vec![SourceFile::new("a.src", text)],
        &ReadOptions::default(),
    );
    assert_eq!(read.map(|program| program.motions.len()), Ok(1));
}

#[test]
fn spline_blocks_that_are_none() {
    each_is_refused(&[
        (
            "SPLINE\n SLIN XP1\n SLIN {X 5}",
            &[(
                3,
                "`SPLINE`: the block has no end: there is no ENDSPLINE that closes it; write ENDSPLINE behind its last segment",
            )],
        ),
        // What is behind a block without an end is not said to be wrong in it.
        (
            "SPLINE WITH $VEL.CP=0.1\n SLIN XP1\nLIN XP1\nPTP XP1",
            &[(3, "the block has no end")],
        ),
        (
            "SPLINE\n SLIN XP1\nSPLINE\n SLIN {X 5}\nENDSPLINE",
            &[(3, "the block has no end")],
        ),
        (
            "SLIN XP1\nENDSPLINE",
            &[(
                4,
                "`ENDSPLINE`: it closes no block that is open here; remove it, or open its block before it",
            )],
        ),
        (
            "IF TRUE THEN\nSPLINE\n SLIN XP1\nENDIF\nENDSPLINE",
            &[(
                6,
                "`ENDIF`: it closes no block that is open here; close the SPLINE of line 4 with ENDSPLINE before it",
            )],
        ),
        (
            "SPLINE\nIF TRUE THEN\n SLIN XP1\nENDSPLINE\nENDIF",
            &[(6, "close the IF of line 4 with ENDIF before it")],
        ),
        (
            "PTP_SPLINE\n SPTP XP1",
            &[
                (3, "the block has no end: there is no ENDSPLINE"),
                (3, "depends on all of them"),
            ],
        ),
        (
            "SPLINE\n SPTP XP1\n SLIN_REL {X 5}\n SLIN XP1\nENDSPLINE",
            &[
                (4, "it is no segment of a spline block; write SLIN or SCIRC"),
                (5, "it is no segment of a spline block"),
            ],
        ),
        (
            "SPLINE\n SPL XP1\n TIME_BLOCK START\nENDSPLINE",
            &[
                (4, "depends on all of them"),
                (5, "it shares out the time of a spline block"),
            ],
        ),
        (
            "SCIRC {X 5},{X 9},CA=90",
            &[(3, "the angle CA lets the circle end elsewhere")],
        ),
        (
            "SCIRC {X 5},{X 9},CA 90\nSCIRC {X 5}",
            &[
                (3, "the angle CA lets the circle end elsewhere"),
                (4, "the motion has no end; write its target"),
            ],
        ),
    ]);
}

#[test]
fn blocks_say_which_word_is_missing() {
    for (opened, end) in [
        ("IF $IN[1] THEN", "ENDIF"),
        ("SWITCH n\nCASE 1", "ENDSWITCH"),
        ("LOOP", "ENDLOOP"),
        ("FOR i=1 TO 3", "ENDFOR"),
        ("WHILE $IN[1]", "ENDWHILE"),
        ("REPEAT", "UNTIL"),
    ] {
        let found = behind_a_motion(&format!("{opened}\n$OUT[1]=TRUE"));
        assert_eq!((found.len(), found[0].0), (1, 3), "{opened}: {found:?}");
        let said = format!("there is no {end} that closes it; write {end} where it ends");
        assert!(found[0].1.contains(&said), "{opened}: {found:?}");
    }
}

#[test]
fn steps_and_values_in_braces_that_are_none() {
    each_is_refused(&[
        ("LIN_REL {X 5,B 3}", &[(3, "turns it or moves axes")]),
        (
            "SLIN_REL {X 5} #WORLD",
            &[(
                3,
                "its steps are in axes that are not known; write #BASE or #TOOL",
            )],
        ),
        (
            "LIN_REL {X d}",
            &[(3, "its step: no `d` is declared in these files")],
        ),
        (
            "LIN_REL XP1",
            &[(3, "it goes on from where the tool is, and turns it")],
        ),
        (
            "LIN {}\nLIN {X 1,Y}\nLIN {X 1 Y 2}",
            &[
                (3, "it states no place; write X, Y, Z, A, B and C"),
                (4, "it is no position in braces"),
                (5, "it is no expression that is understood here"),
            ],
        ),
        (
            "LIN {X 1,Y 2,Z 3\nLIN {X 1.5.2,Y 2}\nLIN {X 1e9}\nLIN {X 1,W 3}",
            &[
                (3, "it is no position in braces"),
                (4, "it is no expression that is understood here"),
                (5, "its numbers are larger than any robot needs"),
                (6, "it has a member that no position has"),
            ],
        ),
        // A statement is a line.
        (
            "LIN {X 1,Y 2,\nZ 3}",
            &[
                (3, "it is no position in braces"),
                (4, "it is no statement of KRL that is known here"),
            ],
        ),
        (
            "PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\nLIN {Z 5}",
            &[(
                4,
                "the pose before it is not known from the text in these axes; write all of X, Y, Z, A, B and C",
            )],
        ),
        (
            "LIN {X 1,A 5,B 95,C 0}\nLIN {A 7}",
            &[(4, "the pose before it has a B of 90 degrees or beyond")],
        ),
        (
            "LIN XP1:{Z 5,W 3}",
            &[(3, "it has a member that no position has")],
        ),
    ]);
}

#[test]
fn inline_forms_whose_data_are_missing_or_say_something_else() {
    let with = |point: &str, data: &str| {
        format!(
            ";FOLD SLIN {point} Vel=0.1 m/s CPDAT1 Tool[1] Base[1] ;%{{PE}}\nSLIN X{point} WITH $VEL = SVEL_CP(0.1, , {data}), $TOOL = STOOL2(F{point}), $BASE = SBASE(F{point}.BASE_NO), $ORI_TYPE = SORI_TYP({data})\n;ENDFOLD"
        )
    };
    each_is_refused(&[
        (
            &with("P9", "LCPDAT1"),
            &[(4, "no `XP9` is declared in these files; give the .dat file")],
        ),
        (
            &with("P1", "LCPDAT9"),
            &[(
                4,
                "no `LCPDAT9` is declared in these files; give the .dat file",
            )],
        ),
        (
            &with("P1", "LCPDAT2"),
            &[(
                4,
                "the tool does not turn evenly to the orientation of the point; write ORI_TYP #VAR in these data",
            )],
        ),
        (
            "SCIRC {X 5},{X 9,Y 3} WITH $CIRC_TYPE = SCIRC_TYP(LCPDAT2)",
            &[(
                3,
                "the tool turns with the circle (#PATH), whatever its points say; write CIRC_TYP #BASE in these data",
            )],
        ),
        (
            "LDAT_ACT=LCPDAT2\nBAS(#CP_PARAMS,0.1)\nLIN XP1",
            &[(
                3,
                "the tool does not turn evenly to the orientation of the point; write ORI_TYP #VAR in these data",
            )],
        ),
        (
            "LDAT_ACT=LCPDAT1\nLDAT_ACT.CIRC_TYP=#PATH\nLIN XP1",
            &[(4, "the tool turns with the circle (#PATH)")],
        ),
        (
            "$SINGUL_STRATEGY=0\n$SINGUL_STRATEGY=1\nLIN XP1",
            &[(
                4,
                "near singular postures the tool leaves its orientation on lines and circles; write $SINGUL_STRATEGY=0",
            )],
        ),
        (
            "$CIRC_MODE.AUX_PT.ORI=#INTERPOLATE\nCIRC {X 5},{X 9,Y 3}",
            &[(
                3,
                "the tool passes the orientation of the place on it, which is not followed; write #IGNORE",
            )],
        ),
        (
            "SCIRC {X 5},{X 9,Y 3} WITH $CIRC_MODE={AUX_PT {ORI #INTERPOLATE}}",
            &[(3, "the tool passes the orientation of the place on it")],
        ),
        (
            "SLIN XP1 WITH $TOOL = STOOL2(FP2)",
            &[(3, "the tool stands still and the robot holds the part")],
        ),
        (
            "SLIN XP1 Vel=0.1 m/s CPDAT1",
            &[(
                3,
                "behind the target stands what only the text of an inline form has",
            )],
        ),
        (
            "FDAT_ACT=FP2\nBAS(#CP_PARAMS,0.1)\nLIN XP1",
            &[(4, "the tool stands still and the robot holds the part")],
        ),
    ]);
}

#[test]
fn data_lists_that_do_not_state_what_is_asked() {
    for (declared, line, reason) in [
        (
            "DECL E6POS XP1={X 1,Y 2,Z 3,A 0,B 0,C 0}",
            7,
            "the name is declared twice",
        ),
        ("DECL E6POS", 7, "nothing is declared here"),
        (
            "DECL E6POS 5={X 1}",
            7,
            "a declared name is missing or longer than 24 characters",
        ),
        ("DECL", 7, "nothing is declared here"),
    ] {
        let found = refused(
            "DEF a()\nPTP XP1\nLIN {X 3}\nEND\n",
            &format!("{DATA}{declared}\nENDDAT\n"),
        );
        assert_eq!(
            (found.len(), found[0].0.as_str(), found[0].1),
            (1, "a.dat", line),
            "{declared}: {found:?}"
        );
        assert!(found[0].2.contains(reason), "{declared}: {found:?}");
    }
    for (declared, reason) in [
        ("DECL E6POS XQ", "`XQ` has no value in these files"),
        (
            "DECL E6POS XQ={X 1,Y 2",
            "`LIN XQ`: it is no expression that is understood here",
        ),
        (
            "DECL E6POS XQ={X one,Y 2}",
            "`XQ`: no `one` is declared in these files",
        ),
        ("DECL E6POS XQ={S 2,T 3}", "it states no place"),
        (
            "DECL E6POS XQ={X 1,Y 2,Z 3,A 0,B 0,C 0,S 2.5,T 3}",
            "`XQ`: its S and T are not whole numbers",
        ),
        (
            "DECL E6POS XQ={X 1,Y 2,Z 3,A 0,B 0,C 0,S 2,T -1}",
            "`XQ`: its S and T are not whole numbers",
        ),
        ("DECL E6AXIS XQ={A1 10,A2 20}", "it states only some axes"),
        (
            "DECL E6POS XQ={X 1,Y 2,\nZ 3}",
            "`LIN XQ`: it is no expression that is understood here",
        ),
        ("XQ={X 1,Y 2,Z 3", "`LIN XQ`: it is no expression"),
    ] {
        let found = refused(
            "DEF a()\nPTP XP1\nLIN XQ\nEND\n",
            &format!("{DATA}{declared}\nENDDAT\n"),
        );
        assert_eq!(
            (found.len(), found[0].0.as_str(), found[0].1),
            (1, "a.src", 3),
            "{declared}: {found:?}"
        );
        assert!(found[0].2.contains(reason), "{declared}: {found:?}");
    }
}

#[test]
fn folds_that_are_not_paired_are_reported_and_carried() {
    let text = "DEF a()\n;ENDFOLD\n;FOLD one\nPTP {X 1,Y 2,Z 3,A 0,B 0,C 0}\n;ENDFOLD\n;FOLD two\nLIN {X 3}\nEND\n;endfold (three)\n; ENDFOLD\n";
    let files = vec![SourceFile::new("a.src", text)];
    let program = read_krl(files, &ReadOptions::default()).unwrap();
    let said: Vec<(usize, &str)> = (program.findings.iter())
        .filter(|finding| finding.message.contains("FOLD"))
        .map(|finding| (finding.line, finding.message.split(':').next().unwrap()))
        .collect();
    let closes_none = "no FOLD is open that this ENDFOLD could close";
    assert_eq!(said, [(2, closes_none), (10, closes_none)]);
    assert_eq!(super::written(&program, &[]), text);
    let text = text.replace(";endfold (three)\n; ENDFOLD\n", "");
    let program = read_krl(
        vec![SourceFile::new("a.src", text)],
        &ReadOptions::default(),
    )
    .unwrap();
    assert!(program.findings.iter().any(
        |finding| finding.line == 6 && finding.message.starts_with("this FOLD has no ENDFOLD")
    ));
}

/// A broken head makes a routine go on from a motion that stands behind it.
#[test]
fn a_routine_that_calls_itself_behind_a_broken_head() {
    let source = "DEF part()\nDEF sub()\nLIN XP1\nDEF par, A -64.2, B 74.1, C 26} C_,INT i\nlin XP1 C_DIS\nsub()";
    assert!(!refused(source, &format!("{DATA}ENDDAT\n")).is_empty());
}

#[test]
fn a_circle_without_its_comma() {
    each_is_refused(&[
        (
            "CIRC XP1 XP1:{X 5,Y 6,Z 7}",
            &[(
                3,
                "no comma stands between the place on the circle and its end; write  CIRC place, end",
            )],
        ),
        (
            "CIRC XP1",
            &[(3, "the motion has no end; write its target")],
        ),
    ]);
}
