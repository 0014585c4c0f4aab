//! Runs that a controller makes otherwise than a glance at the text says.

use kinetostat_formats::*;

const FRAMES: &str = "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\nP={X 0,Y 0,Z 0,A 0,B 0,C 0}";

fn read(data: &str, statements: &str) -> Result<RobotProgram, Vec<ProgramError>> {
    let files = vec![
        SourceFile::new(
            "part.src",
            format!("DEF part()\nDECL E6POS P\n{FRAMES}\n{statements}\nEND\n"),
        ),
        SourceFile::new("part.dat", format!("DEFDAT part\n{data}\nENDDAT\n")),
    ];
    read_krl(files, &ReadOptions::default())
}

/// X of all ends.
fn places(data: &str, statements: &str) -> Vec<f64> {
    let program =
        read(data, statements).unwrap_or_else(|errors| panic!("{statements}\n{errors:#?}"));
    let ends = program
        .motions
        .iter()
        .map(|motion| motion.target.pose().unwrap().position_mm.x);
    ends.collect()
}

#[test]
fn whole_numbers_are_divided_and_stored_as_such() {
    let data = "DECL INT I\nDECL REAL R";
    for (value, wanted) in [
        ("I=5/2", 2.0),
        ("I=7\nI=I/2*2", 6.0),
        ("I=2.6", 3.0),
        ("R=5/2.0\nI=R*2", 5.0),
    ] {
        assert_eq!(
            places(data, &format!("{value}\nP.X=I\nLIN P")),
            [wanted],
            "{value}"
        );
    }
    assert_eq!(places(data, "R=5/2.0\nP.X=R\nLIN P"), [2.5]);
}

#[test]
fn a_counter_that_its_loop_changes_counts_on_from_there() {
    let found = places("DECL INT I", "FOR I=1 TO 6\nP.X=I\nLIN P\nI=I+1\nENDFOR");
    assert_eq!(found, [1.0, 3.0, 5.0]);
}

/// What only the controller knows, and what is given to a parameter in an arm that may run.
#[test]
fn values_that_may_be_others_are_not_taken() {
    for statements in [
        "F(P)\nLIN P\nEND\nDEF F(Q :OUT)\nDECL E6POS Q\nQ.X=30\nIF $IN[1] THEN\nQ.X=60\nENDIF",
        "$TIMER[1]=0\nWAIT SEC 3\nIF $TIMER[1]>5 THEN\nP.X=9\nENDIF\nLIN P",
        "TRIGGER WHEN DISTANCE=0 DELAY=0 DO P.X=60\nLIN P",
        "IF N==TRUE THEN\nP.X=9\nENDIF\nLIN P",
    ] {
        let refused = read("DECL INT N=1", statements);
        assert!(
            refused.is_err(),
            "{statements}: {:?}",
            refused.map(|program| program.motions.len())
        );
    }
}

#[test]
fn loops_without_an_end_go_to_the_same_places_in_each_pass() {
    let circle = "LIN {X 1,Y 0,Z 0,A 0,B 0,C 0}\nLIN {X 2,Y 0,Z 0,A 0,B 0,C 0}";
    assert_eq!(places("", &format!("LOOP\n{circle}\nENDLOOP")), [1.0, 2.0]);
    for last in [
        "LIN_REL {X 10}\nP=P",
        "$BASE={X 1,Y 0,Z 0,A 0,B 0,C 0}",
        "$VEL.CP=0.1",
    ] {
        let refused = read(
            "",
            &format!("LOOP\n{circle}\n{last}\nLIN_REL {{X 1}}\nENDLOOP"),
        );
        let ends_elsewhere = last.starts_with("LIN_REL");
        assert_eq!(refused.is_err(), !ends_elsewhere, "{last}");
    }
    let refused = read("", "LIN P\nLOOP\nLIN_REL {X 10}\nENDLOOP").unwrap_err();
    assert!(
        refused[0].reason.contains("second pass is another"),
        "{refused:?}"
    );
}
