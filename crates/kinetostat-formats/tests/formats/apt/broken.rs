//! Files that are refused: line, what is said, and all of it in one run.

use kinetostat_formats::*;

use super::read_with;

fn errors(text: &str) -> Vec<(usize, String)> {
    let found = read_with(text.as_bytes(), &ReadOptions::default()).expect_err("it is refused");
    found
        .iter()
        .map(|error| (error.line, error.to_string()))
        .collect()
}

#[test]
fn statements_that_move_the_tool_otherwise_are_refused_by_line() {
    let cases = [
        (
            "GOTO/1,2",
            "a place has 3 or 6 numbers, here are 2; let the CAM system write points",
        ),
        ("GOTO/1,2,3,0,0,1,7", "here are 7"),
        ("GOTO.5,2,3", "no slash stands behind the word"),
        ("GOTO/P1", "a place is stated by other than numbers"),
        ("GOTO/1,2,x3", "a place is stated by other than numbers"),
        ("GOTO/1,2,3,0,0,2", "the tool's axis has not the length 1"),
        ("GODLTA/5", "the step is not three numbers"),
        ("GOHOME/Z", "where home is, the file does not say"),
        (
            "CIRCLE/0,0,0,0,0,1\nGOTO/1,2,3",
            "in which sense the arc goes",
        ),
        (
            "TLON,GOFWD/(CIRCLE/0,0,0,$\n 4),ON,(LINE/0,0,0,1,0,0)",
            "the end of the arc is where it meets a line",
        ),
        (
            "CYCLE/DRILL,FEDTO,5\nGOTO/1,2,3\nCYCLE/OFF",
            "it is a hole of a cycle",
        ),
        ("CUTCOM/LEFT", "the controller moves the path aside"),
        ("TLCOMP / ON, LEFT", "the controller moves the path aside"),
        (
            "MSYS/0,0,0,1,0,0,1,0,0",
            "MSYS is not an origin and two axes at right angles",
        ),
        ("TRNTYP/LOCAL,0,0,0", "in other axes than the part's"),
        ("TLAXIS/1,2", "the tool's axis has not the length 1"),
        ("TRACUT/M1", "it moves or turns all places behind it"),
        (
            "COPY/1,TRANSL,5,0,0,3",
            "it moves or turns all places behind it",
        ),
        ("GOFWD/L1,PAST,L2", "it drives along geometry"),
        ("CALL/M1", "it runs statements again or elsewhere"),
        ("ROTABL/90,TABLE,CLW", "it turns the table or the head"),
        ("THREAD/TURN", "the controller's own cycle"),
        (
            "CYCLE81/10,0,2",
            "the word is not known, and may move the tool",
        ),
        ("Y43ewsdrj", "the word is not known"),
        ("FEDRAT", "the feed has no number"),
        (
            "UNITS/INCH",
            "the unit is not known, or another one than before",
        ),
        ("UNITS/FURLONGS", "the unit is not known"),
    ];
    for (text, part) in cases {
        let found = errors(&format!("UNITS/MM\nFROM/0,0,0\n{text}\nGOTO/9,9,9\n"));
        let hit = found
            .iter()
            .any(|(line, message)| (3..=4).contains(line) && message.contains(part));
        assert!(hit, "{text}: {found:?}");
        assert!(found.len() <= 2, "{text}: {found:?}");
    }
}

#[test]
fn circles_that_fit_nothing_are_refused() {
    let head = "TRNTYP/WORLD,0,0,0\nUNIT/MM\n";
    let cases = [
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,1.\nGOTO/0,2.,0",
            "radius 1.0000 at its start and 2.0000 at its end",
        ),
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,1.,5.\nGOTO/0,1.,0",
            "and 5.0000 is stated",
        ),
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,3.\nGOTO/0,1.,0",
            "not a centre and an axis of length 1",
        ),
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,1.\nRAPID/\nGOTO/0,1.,0",
            "no GOTO follows that ends the arc",
        ),
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,1.",
            "no GOTO follows that ends the arc",
        ),
        (
            "CIRCLE/0,0,0,0,0,1.\nGOTO/0,1.,0",
            "where its arc begins is not known",
        ),
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,1.,1.,.1,.5,4.,1.,TIMES,2\nGOTO/0,1.,-3.",
            "a helix of several turns",
        ),
    ];
    for (text, part) in cases {
        let found = errors(&format!("{head}{text}\n"));
        assert!(
            found.len() == 1 && found[0].1.contains(part),
            "{text}: {found:?}"
        );
    }
}

#[test]
fn all_problems_come_in_one_run_in_the_order_of_lines() {
    let found = errors("UNITS/MM\nGOTO/1\nDANCE\nCUTCOM/RIGHT\nGOTO/1,2,3\nUNITS/MM\n");
    let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [2, 3, 4, 6]);
}

#[test]
fn what_is_stated_is_taken() {
    let mut options = ReadOptions::default();
    options.cutter_compensation = CutterCompensation::CentrePath;
    options.unknown_targets = UnknownTargets::LeftAsWritten;
    let text = "UNITS/MM\nCUTCOM/LEFT\nGOTO/1,2,3\nCYCLE/DRILL,FEDTO,5\nGOTO/4,5,6\nCYCLE/OFF\nGOHOME/Z\nGODLTA/1,0,0\n";
    let program = read_with(text.as_bytes(), &options).unwrap();
    let known: Vec<bool> = program
        .motions
        .iter()
        .map(|motion| motion.target.pose().is_some())
        .collect();
    assert_eq!(known, [true, false, false, false]);
    let reasons: Vec<&str> = program
        .findings
        .iter()
        .map(|finding| finding.message.as_str())
        .collect();
    assert!(
        reasons[3].contains("where its step begins is not known"),
        "{reasons:?}"
    );
}

/// A table that is turned to zero, in a file that turns nothing else, stands where it stood.
#[test]
fn a_table_at_zero_turns_nothing() {
    let text = "UNITS/MM\nROTABL/ 0.000000,,TABLE,CLW\nGOTO/1,2,3\n";
    let program = read_with(text.as_bytes(), &ReadOptions::default()).unwrap();
    assert_eq!(program.motions.len(), 1);
    for turns in [
        "ROTABL/0.1,TABLE",
        "ROTABL/TABLE,CLW",
        "ROTABL/0,TABLE\nROTABL/5",
    ] {
        let found = errors(&format!("UNITS/MM\n{turns}\nGOTO/1,2,3\n"));
        assert!(
            found.len() == 1 && found[0].1.contains("it turns the table"),
            "{found:?}"
        );
    }
}

#[test]
fn words_stand_once_in_their_table() {
    let mut names: Vec<&str> = APT_STATEMENTS.iter().map(|row| row.name).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
}
