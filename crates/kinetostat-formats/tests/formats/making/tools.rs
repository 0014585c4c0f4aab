//! Tools of the source keep their numbers, and what gets a number is named.

use kinetostat_formats::*;

use super::{found, of_robot, text_of};

const APT: &str = "PARTNO/T\nUNITS/MM\nFEDRAT/300,MMPM\nRAPID\nGOTO/0,0,10\nGOTO/0,0,0\nRAPID\nGOTO/0,0,50\nLOADTL/5\n\
    RAPID\nGOTO/10,0,50\nGOTO/10,0,0\nFINI\n";

fn numbers(text: &str, word: &str) -> Vec<String> {
    let lines = text.lines().filter(|line| line.starts_with(word));
    lines.map(str::to_owned).collect()
}

#[test]
fn moves_before_the_first_change_have_no_number() {
    for (number, text) in [
        ("5", APT.to_owned()),
        ("1", APT.replace("LOADTL/5", "LOADTL/1")),
    ] {
        let apt = text_of(&of_robot(Language::Apt, &text, MakeLanguage::Apt), 0);
        assert_eq!(
            numbers(&apt, "LOADTL"),
            [format!("LOADTL/{number}")],
            "{apt}"
        );
        let gcode = text_of(&of_robot(Language::Apt, &text, MakeLanguage::Gcode), 0);
        assert_eq!(numbers(&gcode, "T"), [format!("T{number} M6")], "{gcode}");
        let made = of_robot(Language::Apt, &text, MakeLanguage::Krl);
        let krl = text_of(&made, 0);
        let other = if number == "1" { "2" } else { "1" };
        assert_eq!(
            numbers(&krl, "$TOOL"),
            [
                format!("$TOOL=TOOL_DATA[{other}]"),
                format!("$TOOL=TOOL_DATA[{number}]")
            ],
            "{krl}"
        );
        assert!(
            found(
                &made,
                &format!(
                    "before the first change of tools the source names none: TOOL_DATA[{other}] here"
                )
            ),
            "{:?}",
            made.findings
        );
    }
    let one = APT
        .replace("UNITS/MM\n", "UNITS/MM\nLOADTL/7\nSPINDL/8000,CLW\n")
        .replace("LOADTL/5\n", "");
    let gcode = text_of(&of_robot(Language::Apt, &one, MakeLanguage::Gcode), 0);
    let at = |words: &str| {
        gcode
            .find(words)
            .unwrap_or_else(|| panic!("{words}: {gcode}"))
    };
    assert!(
        at("T7 M6\n") < at("S8000 M3\n") && at("S8000 M3\n") < at("G0 X0"),
        "{gcode}"
    );
}

#[test]
fn numbers_of_krl_stay_and_a_literal_takes_a_free_one() {
    let text = "DEF a( )\n$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n$VEL.CP=0.02\n$TOOL={X 0,Y 0,Z 180,A 0,B 0,C 0}\nPTP {X 0,Y 0,Z 20,A 0,B 180,C 0}\n\
        $TOOL=TOOL_DATA[5]\nPTP {X 0,Y 9,Z 20,A 0,B 180,C 0}\n$TOOL=TOOL_DATA[1]\nPTP {X 5,Y 0,Z 20,A 0,B 180,C 0}\nEND\n";
    let made = of_robot(Language::Krl, text, MakeLanguage::FanucLs);
    let ls = text_of(&made, 0);
    let tools: Vec<&str> = (ls.lines())
        .filter_map(|line| {
            line.split_once("UTOOL_NUM=")
                .map(|(_, rest)| rest.trim_end_matches(" ;"))
        })
        .collect();
    // What is in force at the beginning is stated first, and again where the first motion takes it.
    assert_eq!(tools[1..], ["2", "5", "1"], "{ls}");
    assert!(
        found(&made, "has no number: it is UTOOL_NUM=2 here"),
        "{:?}",
        made.findings
    );
    assert!(!found(&made, "UTOOL_NUM=5 here"));
}

#[test]
fn names_of_rapid_that_become_numbers_are_named() {
    let tool = |name: &str, z: u32| {
        format!("PERS tooldata {name}:=[TRUE,[[0,0,{z}],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n")
    };
    let motion = |x: u32, tool: &str| {
        format!(
            "MoveJ [[{x},0,50],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,{tool};\n"
        )
    };
    let text = format!(
        "MODULE M\n{}{}PROC main()\n{}{}ENDPROC\nENDMODULE\n",
        tool("tDrill", 100),
        tool("tMill", 200),
        motion(0, "tDrill"),
        motion(9, "tMill")
    );
    let made = of_robot(Language::Rapid, &text, MakeLanguage::FanucLs);
    for words in [
        "the tool `tDrill` of the source has no number: it is UTOOL_NUM=1 here",
        "the tool `tMill` of the source has no number: it is UTOOL_NUM=2 here",
        "the work object `wobj0` of the source has no number",
    ] {
        let is_named = found(&made, words);
        assert_eq!(
            is_named,
            !words.contains("wobj0"),
            "{words} {:?}",
            made.findings
        );
    }
    let rapid = of_robot(Language::Rapid, &text, MakeLanguage::Rapid);
    assert!(
        !found(&rapid, "of the source has no number"),
        "{:?}",
        rapid.findings
    );
}

/// KRL states what tools weigh in an array beside theirs.
#[test]
fn loads_of_krl_are_those_of_rapid() {
    let krl = |more: &str| {
        format!(
            "DEF a( )\nTOOL_DATA[4]={{X 0,Y 0,Z 180,A 0,B 0,C 0}}\nLOAD_DATA[4]={{M 5.5,CM {{X 1,Y 2,Z 60,A 0,B 90,C 0}},J {{X 0.1,Y 0.2,Z 0.05}}}}\n{more}\
             $BASE=$NULLFRAME\n$TOOL=TOOL_DATA[4]\n$LOAD=LOAD_DATA[4]\n$VEL.CP=0.01\nPTP {{X 0,Y 0,Z 5,A 0,B 0,C 180}}\nLIN {{X 9,Y 0,Z 5,A 0,B 0,C 180}}\nEND\n"
        )
    };
    let stated = "[5.5,[1.000000,2.000000,60.000000],[0.7071067812,0.0000000000,0.7071067812,0.0000000000],0.1,0.2,0.05]]";
    let made = of_robot(Language::Krl, &krl(""), MakeLanguage::Rapid);
    let text = text_of(&made, 0);
    assert!(
        text.contains("PERS tooldata tool4:=[TRUE,[[0.000000,0.000000,180.000000],")
            && text.contains(stated),
        "{text}"
    );
    assert!(!found(&made, "1 kg is written"), "{:?}", made.findings);
    // Not where the program says two things, or another load altogether.
    for more in [
        "LOAD_DATA[4].M=7\n",
        "$LOAD={M 3,CM {X 0,Y 0,Z 9,A 0,B 0,C 0},J {X 0,Y 0,Z 0}}\n",
        "LOAD_DATA[4]={M -1,CM {X 1,Y 2,Z 60,A 0,B 90,C 0},J {X 0.1,Y 0.2,Z 0.05}}\n",
    ] {
        let made = of_robot(Language::Krl, &krl(more), MakeLanguage::Rapid);
        assert!(
            found(&made, "1 kg is written"),
            "{more}: {:?}",
            made.findings
        );
    }
}
