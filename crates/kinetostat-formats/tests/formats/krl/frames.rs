//! Tools and bases in force.

use kinetostat_formats::*;
use nalgebra::{Isometry3, Vector3};

use super::main_with;

const HERE: &str = "LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}";

fn frames(data: &str, statements: &str, options: &ReadOptions) -> (FrameUse, FrameUse) {
    let files = vec![
        SourceFile::new(
            "part.src",
            format!("DEF part()\n{statements}\n{HERE}\nEND\n"),
        ),
        SourceFile::new("part.dat", format!("DEFDAT part\n{data}\nENDDAT\n")),
        SourceFile::new(
            "KRC/$config.dat",
            "DEFDAT $CONFIG\nFRAME TOOL_DATA[16]\nTOOL_DATA[3]={X 1.0,Y 2.0,Z 3.0,A 0.0,B 0.0,C 0.0}\n\
             FRAME BASE_DATA[16]\nBASE_DATA[4]={FRAME: X 10,Y 20,Z 30,A 90,B 0,C 0}\nENDDAT",
        ),
    ];
    let program = read_krl(files, options).unwrap_or_else(|errors| panic!("{errors:#?}"));
    let last = program.motions.last().unwrap();
    (last.tool.clone(), last.work_object.clone())
}

fn place(frame: &FrameUse) -> Option<[f64; 3]> {
    frame.known().map(|frame| frame.translation.vector.into())
}

#[test]
fn frames_are_those_that_statements_set() {
    let cases = [
        (
            "$TOOL=TOOL_DATA[3]\n$BASE=BASE_DATA[4]",
            Some([1.0, 2.0, 3.0]),
            Some([10.0, 20.0, 30.0]),
        ),
        (
            "BAS(#TOOL,3)\nBAS(#BASE,4)",
            Some([1.0, 2.0, 3.0]),
            Some([10.0, 20.0, 30.0]),
        ),
        (
            "$TOOL=$NULLFRAME\n$BASE=$WORLD",
            Some([0.0; 3]),
            Some([0.0; 3]),
        ),
        (
            "$tool = tool_data[0]\n$base=BASE_DATA[0]",
            Some([0.0; 3]),
            Some([0.0; 3]),
        ),
        (
            "$TOOL={X 7,Y 8,Z 9,A 0,B 0,C 0}\n$BASE=mine",
            Some([7.0, 8.0, 9.0]),
            Some([4.0, 5.0, 6.0]),
        ),
        // One behind the other: the second is turned with the first.
        (
            "$BASE=BASE_DATA[4]:{X 5,Y 0,Z 0,A 0,B 0,C 0}",
            None,
            Some([10.0, 25.0, 30.0]),
        ),
        (
            "FDAT_ACT=FP1\nBAS(#CP_PARAMS,0.1)",
            Some([1.0, 2.0, 3.0]),
            Some([10.0, 20.0, 30.0]),
        ),
        (
            "FDAT_ACT=FP1\nBAS(#PTP_PARAMS,100)",
            Some([1.0, 2.0, 3.0]),
            Some([10.0, 20.0, 30.0]),
        ),
        ("BAS(#TOOL,3)\n$TOOL.Z=5", None, None),
        ("BAS(#TOOL,3)\nBAS(#INITMOV,0)", None, None),
        // What is in none of the files is taken to leave it in force.
        ("BAS(#TOOL,3)\nelsewhere()", Some([1.0, 2.0, 3.0]), None),
        ("$TOOL=computed(1)", None, None),
        ("$BASE=BASE_DATA[count]", None, None),
        (
            "BASE_DATA[4]={X 0,Y 0,Z 7,A 0,B 0,C 0}\n$BASE=BASE_DATA[4]",
            None,
            Some([0.0, 0.0, 7.0]),
        ),
        ("$BASE=BASE_DATA[9]", None, None),
    ];
    let data = "DECL FRAME mine={X 4,Y 5,Z 6,A 0,B 0,C 0}\nINT count\nDECL FDAT FP1={TOOL_NO 3,BASE_NO 4,IPO_FRAME #BASE}";
    for (statements, tool, base) in cases {
        let found = frames(data, statements, &ReadOptions::default());
        let near = |found: Option<[f64; 3]>, expected: Option<[f64; 3]>| match (found, expected) {
            (Some(found), Some(expected)) => {
                (Vector3::from(found) - Vector3::from(expected)).norm() < 1e-9
            }
            (found, expected) => found == expected,
        };
        assert!(near(place(&found.0), tool), "{statements}: {found:?}");
        assert!(near(place(&found.1), base), "{statements}: {found:?}");
    }
}

#[test]
fn frames_that_the_caller_states_count() {
    let mut options = ReadOptions::default();
    options.frames.insert(
        "base_data[ 9 ]".into(),
        Isometry3::translation(1.0, 0.0, 0.0),
    );
    options
        .frames
        .insert("$TOOL".into(), Isometry3::translation(0.0, 0.0, 7.0));
    let (tool, base) = frames("", "$BASE=BASE_DATA[9]", &options);
    assert_eq!(
        (place(&tool), place(&base)),
        (Some([0.0, 0.0, 7.0]), Some([1.0, 0.0, 0.0]))
    );
    // A statement counts more than what is stated for where there is none.
    let (tool, _) = frames("", "BAS(#TOOL,3)", &options);
    assert_eq!(place(&tool), Some([1.0, 2.0, 3.0]));
}

#[test]
fn frames_of_branches_loops_and_routines_are_those_of_every_way() {
    let tool = |statements: &str| {
        let found = frames("BOOL ready\nINT n", statements, &ReadOptions::default());
        place(&found.0)
    };
    let third = Some([1.0, 2.0, 3.0]);
    for statements in [
        "BAS(#TOOL,3)\nFOR n=1 TO 3\n$VEL.CP=0.1\nENDFOR",
        "FOR n=1 TO 3\nBAS(#TOOL,n)\nENDFOR",
        "n=2\nIF n==2 THEN\nBAS(#TOOL,3)\nELSE\nBAS(#TOOL,0)\nENDIF",
        "REPEAT\nBAS(#TOOL,3)\nUNTIL TRUE",
        "BAS(#TOOL,3)\nGOTO there\nBAS(#TOOL,0)\nthere:",
    ] {
        assert_eq!(tool(statements), third, "{statements}");
    }
    // Which way it goes is not known.
    let file = SourceFile::new(
        "a.src",
        "DEF a()\nIF $IN[1] THEN\nBAS(#TOOL,0)\nENDIF\nEND\n",
    );
    let mut options = ReadOptions::default();
    let refused = read_krl(vec![file.clone()], &options).unwrap_err();
    assert!(
        refused[0].line == 2 && refused[0].remedy.contains("--set"),
        "{refused:?}"
    );
    options
        .values
        .insert("$IN[1]".to_owned(), StatedValue::Truth(true));
    assert!(read_krl(vec![file], &options).is_ok());
    let both = |calls: &str| {
        let source = format!("DEF part()\n{calls}\nEND\nDEF sub()\n{HERE}\nEND\n");
        let files = vec![SourceFile::new("part.src", source)];
        read_krl(files, &ReadOptions::default()).unwrap().motions[0].clone()
    };
    let twice = both("$TOOL=$NULLFRAME\nsub()\nsub()");
    assert_eq!(
        (place(&twice.tool), twice.runs),
        (Some([0.0; 3]), Runs::Repeatedly)
    );
    let twice = both("$TOOL=$NULLFRAME\nsub()\n$TOOL={X 1,Y 0,Z 0,A 0,B 0,C 0}\nsub()");
    assert_eq!(place(&twice.tool), Some([0.0; 3]));
}

#[test]
fn a_fold_that_says_otherwise_than_its_statements_is_a_finding() {
    let fold = |tool: u32| {
        format!(
            ";FOLD LIN P1 Vel=2 m/s CPDAT1 Tool[{tool}]:mill Base[4] ;%{{PE}}\nFDAT_ACT=FP1\nBAS(#CP_PARAMS,2)\nLIN XP1\n;ENDFOLD"
        )
    };
    let data = "DECL FDAT FP1={TOOL_NO 3,BASE_NO 4,IPO_FRAME #BASE}\nDECL POS XP1={X 1,Y 2,Z 3,A 0,B 0,C 0}";
    let said = |tool: u32| {
        let program = main_with(data, &fold(tool));
        let found = program
            .findings
            .iter()
            .find(|finding| finding.message.contains("FOLD"));
        found.map(|finding| (finding.line, finding.message.clone()))
    };
    assert_eq!(said(3), None);
    let (line, message) = said(5).unwrap();
    assert_eq!(line, 5);
    assert_eq!(
        message,
        "the text of the FOLD says Tool[5], its statements set TOOL_DATA[3]: the statements count"
    );
}

/// A call of what is nowhere is taken to leave frames in force.
#[test]
fn frames_stay_in_force_behind_calls_of_what_is_nowhere() {
    let base = |statements: &str| {
        let found = frames("BOOL ready\nINT n", statements, &ReadOptions::default());
        found.1.name
    };
    for statements in [
        "BAS(#BASE,4)\nelsewhere()",
        "BAS(#BASE,4)\nIF ready THEN\nelsewhere()\nENDIF",
        "BAS(#BASE,4)\nWHILE ready\nelsewhere()\nENDWHILE",
    ] {
        assert_eq!(base(statements), base("BAS(#BASE,4)"), "{statements}");
    }
    // In a routine that is called, and behind it.
    let text = format!(
        "DEF part()\nBAS(#BASE,0)\nelsewhere()\nsub()\n{HERE}\nEND\nDEF sub()\n{HERE}\nother()\n{HERE}\nEND\n"
    );
    let files = vec![SourceFile::new("part.src", text)];
    let program = read_krl(files, &ReadOptions::default()).unwrap();
    assert_eq!(program.motions.len(), 3);
    let mut motions = program.motions.iter();
    assert!(motions.all(|motion| motion.work_object.known().is_some()));
}
