//! What blocks of SINUMERIK and Heidenhain programs do beside their motions: before the motion or behind it, or named.

use kinetostat_formats::*;

use super::{found, of_robot, text_of};

fn in_order(text: &str, words: &[&str]) {
    let mut at = 0;
    for own in words {
        let found = text[at..].find(own);
        at += found.unwrap_or_else(|| panic!("{own} behind {at}: {text}")) + own.len();
    }
}

/// The lines of a program that are no notes, behind those of its head.
fn acts(text: &str, note: &str) -> Vec<String> {
    let first = text.find("GOTO").or(text.find("\nT")).or(text.find("\nS"));
    let behind = first.map_or(text, |at| &text[at.min(text.len())..]);
    let lines = behind.lines().map(str::trim);
    lines
        .filter(|line| !line.is_empty() && !line.starts_with(note))
        .map(str::to_owned)
        .collect()
}

const SIEMENS: &str = "G90 G71 G94 G17 G54\nT1 D1\nM6\nS1000 M3\nG0 X0 Y0 Z5 M8\nG1 Z-5 F100 M7\nG1 X20 M9\nG4 F2\nM0\nG1 X30 M0\n\
    G1 X40 H5\nG1 X50 S500 M4\nMSG(\"x\")\nG0 Z50 M5\nM30\n";

#[test]
fn sinumerik_to_g_code() {
    let made = of_robot(Language::Siemens, SIEMENS, MakeLanguage::Gcode);
    let text = text_of(&made, 0);
    assert_eq!(
        acts(&text, "("),
        [
            "T1 M6",
            "S1000 M3",
            "M8",
            "G0 X0.000000 Y0.000000 Z5.000000",
            "M7",
            "G1 X0.000000 Y0.000000 Z-5.000000 F100",
            "G1 X20.000000 Y0.000000 Z-5.000000",
            "M9",
            "G4 X2.0",
            "M0",
            "G1 X30.000000 Y0.000000 Z-5.000000",
            "M0",
            "G1 X40.000000 Y0.000000 Z-5.000000",
            "S500 M4",
            "G1 X50.000000 Y0.000000 Z-5.000000",
            "G0 X50.000000 Y0.000000 Z50.000000",
            "M5",
            "M2"
        ],
        "{text}"
    );
    assert!(
        found(
            &made,
            "other statements: 2 lines are notes now, and do nothing there (line 11: H5)"
        ),
        "{:?}",
        made.findings
    );
    assert!(
        !found(&made, "spindle:")
            && !found(&made, "coolant:")
            && found(
                &made,
                "tools: 1 line is a note now, and does nothing there (line 2: T1 D1)"
            )
    );
    in_order(
        &text,
        &["(line 11: H5)", "G1 X40", "(line 13: MSG", "G0 X50"],
    );
}

#[test]
fn sinumerik_to_robots_and_apt() {
    let krl = of_robot(Language::Siemens, SIEMENS, MakeLanguage::Krl);
    in_order(
        &text_of(&krl, 0),
        &[
            "; line 2: T1 D1\n",
            "; line 4: S1000 M3\n",
            "; line 5: M8\n",
            "PTP {",
            "; line 6: M7\n",
            "LIN {X 0.0",
            "LIN {X 20.0",
            "; line 7: M9\n",
            "WAIT SEC 2",
            "HALT\n",
            "LIN {X 30.0",
            "HALT\n",
            "; line 11: H5\n",
            "LIN {X 40.0",
            "; line 12: S500 M4\n",
            "LIN {X 50.0",
            "Z 50.0",
            "; line 14: M5\n",
            "; line 15: M30\n",
        ],
    );
    for lost in [
        "spindle: 3 lines",
        "coolant: 3 lines",
        "tools: 2 lines",
        "other statements: 2",
    ] {
        assert!(found(&krl, lost), "{lost}: {:?}", krl.findings);
    }
    // The tool stands still where the program stops.
    let line = text_of(&krl, 0);
    let before = line.lines().filter(|line| line.starts_with("LIN {X 30.0"));
    assert!(before.clone().count() == 1 && before.clone().all(|line| !line.contains("C_DIS")));
    let apt = text_of(&of_robot(Language::Siemens, SIEMENS, MakeLanguage::Apt), 0);
    in_order(
        &apt,
        &[
            "LOADTL/1\n",
            "SPINDL/1000,RPM,CLW\n",
            "COOLNT/FLOOD\n",
            "GOTO/0",
            "COOLNT/MIST\n",
            "GOTO/0",
            "GOTO/20",
            "COOLNT/OFF\n",
            "DELAY/2",
            "STOP\n",
            "GOTO/30",
            "STOP\n",
            "GOTO/40",
            "SPINDL/500,RPM,CCLW\n",
            "GOTO/50",
            "GOTO/50",
            "SPINDL/OFF\n",
        ],
    );
    let ls = text_of(
        &of_robot(Language::Siemens, SIEMENS, MakeLanguage::FanucLs),
        0,
    );
    assert_eq!(ls.matches("PAUSE").count(), 2, "{ls}");
    assert_eq!(ls.matches("WAIT   2.00(sec)").count(), 1, "{ls}");
}

/// Extended addresses are those of spindles, limits and turns of the spindle are no speeds, variables have values.
#[test]
fn numbers_of_sinumerik_that_are_no_speeds() {
    let head = "G90 G71 G94 G17 G54\nG0 X0 Y0 Z5\n";
    let cases: [(&str, &[&str], &str); 11] = [
        ("G25 S100\nG26 S6000\nG1 X1 F60\n", &[], "spindle: 2 lines"),
        (
            "S900 M3\nG4 S30\nG1 X1 F60\n",
            &["S900 M3"],
            "dwells: 1 line",
        ),
        ("S1=700 M1=3\nG1 X1 F60\n", &["S700 M3"], ""),
        ("S2=700 M2=3\nG1 X1 F60\n", &[], "spindle: 1 line"),
        (
            "SETMS(2)\nS2=700 M2=3\nG1 X1 F60\n",
            &["S700 M3"],
            "spindle: 1 line",
        ),
        ("M0=3 S0=700\nG1 X1 F60\n", &["S700 M3"], ""),
        (
            "R1=350\nDEF INT WAY=4\nS=2*R1 M=WAY\nG1 X1 F60\n",
            &["S700 M4"],
            "other statements: 1 line",
        ),
        (
            "G961 S120 M4 LIMS=3000\nG1 X1 F60\n",
            &[],
            "spindle: 1 line",
        ),
        (
            "S700 M3\nSPOS=90\nS800\nG1 X1 F60\nM3\n",
            &["S700 M3", "S800 M3"],
            "spindle: 1 line",
        ),
        (
            "S700 M3\n/S800 M4\nS900\nG1 X1 F60\n",
            &["S700 M3"],
            "spindle: 2 lines",
        ),
        (
            "H1=7 H2=3.5\nM100 M1=50\nG1 X1 F60\n",
            &[],
            "other statements: 2 lines",
        ),
    ];
    for (body, spindle, lost) in cases {
        let text = format!("{head}{body}");
        let made = of_robot(Language::Siemens, &text, MakeLanguage::Gcode);
        let gcode = text_of(&made, 0);
        let own: Vec<&str> = gcode.lines().filter(|line| line.starts_with('S')).collect();
        assert_eq!(own, spindle, "{gcode}");
        match lost {
            "" => assert!(!found(&made, "are notes now") && !found(&made, "is a note now")),
            lost => assert!(found(&made, lost), "{lost}: {:?}", made.findings),
        }
    }
}

/// What begins like a motion or a mode hides no word behind it.
#[test]
fn no_word_hides_behind_another() {
    let text = "G90 G71 G94 G17 G54 M8\nF100 M3 S200\nG64 H3\nG0 X0 Y0 Z5\nG9 M9\nG40 M19\nG1 X1 ; rough\nX2 M100 SOFT\nM30\n";
    let made = of_robot(Language::Siemens, text, MakeLanguage::Rapid);
    in_order(
        &text_of(&made, 0),
        &[
            "line 1: M8",
            "line 2: M3 S200",
            "line 3: H3",
            "MoveJ",
            "line 5: M9",
            "line 6: M19",
            "line 7: rough",
            "MoveL [[1.0",
            "line 8: M100 SOFT",
            "MoveL [[2.0",
            "line 9: M30",
        ],
    );
    for lost in [
        "coolant: 2 lines",
        "spindle: 2 lines",
        "other statements: 2 lines",
    ] {
        assert!(found(&made, lost), "{lost}: {:?}", made.findings);
    }
}

const HEIDENHAIN: &str = "0 BEGIN PGM m5 MM\n1 TOOL CALL 1 Z S1000\n2 L X+0 Y+0 Z+5 R0 FMAX M3\n3 L Z-5 F100 M8\n4 L X+20 M9\n5 L X+30 M5\n\
    6 STOP M9\n7 CYCL DEF 9.0 DWELL TIME\n8 CYCL DEF 9.1 DWELL 2.5\n9 M13\n10 TOOL CALL S800\n11 L X+40 F200 M1 ; look\n12 FUNCTION DWELL TIME0.5\n\
    13 L Z+50 FMAX M0\n14 L X+0 FMAX M2\n15 END PGM m5 MM\n";

#[test]
fn heidenhain_to_g_code() {
    let made = of_robot(Language::Heidenhain, HEIDENHAIN, MakeLanguage::Gcode);
    let text = text_of(&made, 0);
    assert_eq!(
        acts(&text, "("),
        [
            "T1 M6",
            "S1000 M3",
            "G0 X0.000000 Y0.000000 Z5.000000",
            "M8",
            "G1 X0.000000 Y0.000000 Z-5.000000 F100",
            "G1 X20.000000 Y0.000000 Z-5.000000",
            "M9",
            "G1 X30.000000 Y0.000000 Z-5.000000",
            "M5",
            "M9",
            "M0",
            "G4 X2.5",
            "S1000 M3",
            "M8",
            "S800 M3",
            "G1 X40.000000 Y0.000000 Z-5.000000 F200",
            "M1",
            "G4 X0.5",
            "G0 X40.000000 Y0.000000 Z50.000000",
            "M0",
            "G0 X0.000000 Y0.000000 Z50.000000",
            "M2"
        ],
        "{text}"
    );
    assert!(
        !found(&made, "notes now") && !found(&made, "a note now"),
        "{:?}",
        made.findings
    );
    let ls = text_of(
        &of_robot(Language::Heidenhain, HEIDENHAIN, MakeLanguage::FanucLs),
        0,
    );
    in_order(
        &ls,
        &[
            "PAUSE",
            "WAIT   2.50(sec)",
            "PAUSE",
            "WAIT   0.50(sec)",
            "PAUSE",
        ],
    );
}

#[test]
fn heidenhain_to_robots_and_apt() {
    let krl = of_robot(Language::Heidenhain, HEIDENHAIN, MakeLanguage::Krl);
    in_order(
        &text_of(&krl, 0),
        &[
            "; line 2: TOOL CALL 1 Z S1000\n",
            "; line 3: M3\n",
            "PTP {",
            "; line 4: M8\n",
            "LIN {X 0.0",
            "LIN {X 20.0",
            "; line 5: M9\n",
            "LIN {X 30.0",
            "; line 6: M5\n",
            "HALT\n",
            "WAIT SEC 2.5",
            "; line 10: M13\n",
            "; line 11: TOOL CALL S800\n",
            "LIN {X 40.0",
            "; line 12: M1 look\n",
            "HALT\n",
            "WAIT SEC 0.5",
            "HALT\n",
            "; line 15: M2\n",
        ],
    );
    for lost in ["spindle: 5 lines", "coolant: 4 lines", "tools: "] {
        assert!(found(&krl, lost), "{lost}: {:?}", krl.findings);
    }
    let apt = text_of(
        &of_robot(Language::Heidenhain, HEIDENHAIN, MakeLanguage::Apt),
        0,
    );
    in_order(
        &apt,
        &[
            "LOADTL/1",
            "SPINDL/1000,RPM,CLW",
            "GOTO/0",
            "COOLNT/FLOOD",
            "GOTO/0",
            "GOTO/20",
            "COOLNT/OFF",
            "GOTO/30",
            "SPINDL/OFF",
            "COOLNT/OFF",
            "STOP\n",
            "DELAY/2.5",
            "SPINDL/1000,RPM,CLW",
            "COOLNT/FLOOD",
            "SPINDL/800,RPM,CLW",
            "GOTO/40",
            "OPSTOP",
            "DELAY/0.5",
            "GOTO/40",
            "STOP\n",
        ],
    );
}

/// Labels that are called are followed: their words stand where they run.
#[test]
fn words_of_labels_stand_where_they_run() {
    let text = "BEGIN PGM A MM\nTOOL CALL 3 Z S500\nL X+0 Y+0 Z+5 R0 FMAX M3\nCALL LBL 1\nL X+9 M9\nL X+10 F100 M30\nLBL 1\nL X+5 F100 M8\nM50\nLBL 0\n\
        LBL 2\nM51\nLBL 0\nEND PGM A MM\n";
    let made = of_robot(Language::Heidenhain, text, MakeLanguage::Gcode);
    in_order(
        &text_of(&made, 0),
        &[
            "T3 M6",
            "S500 M3",
            "G0 X0",
            "M8\n",
            "G1 X5",
            "(line 9: M50)",
            "G1 X9",
            "M9\n",
            "G1 X10",
            "(line 6: M30)",
        ],
    );
    assert!(
        found(&made, "have no place among the motions") && found(&made, "line 12: M51"),
        "{:?}",
        made.findings
    );
}

/// A tool with a name has no number, and a part of one is none.
#[test]
fn tools_with_names_are_named() {
    for (call, is_tool) in [("3", true), ("\"MILL_D10\"", false), ("5.2", false)] {
        let text = format!(
            "BEGIN PGM A MM\nTOOL CALL {call} Z S500\nL X+0 Y+0 Z+5 FMAX M3\nL X+9 F100\nEND PGM A MM\n"
        );
        let made = of_robot(Language::Heidenhain, &text, MakeLanguage::Gcode);
        let gcode = text_of(&made, 0);
        assert_eq!(gcode.contains("T3 M6\n"), is_tool, "{gcode}");
        assert_eq!(gcode.contains("\nT"), is_tool, "{gcode}");
        assert_eq!(
            found(&made, "tools: 1 line"),
            !is_tool,
            "{:?}",
            made.findings
        );
    }
}
