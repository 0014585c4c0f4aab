//! Tools of the source keep their numbers, and what gets a number is named.

use kinetostat_formats::*;
use kinetostat_testing::Worst;

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

/// Moves, another tool, and moves with that.
const TWO_TOOLS: &str =
    "G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG0 Z50\nT2 M6\nG0 X3 Y0\nG0 Z5\nG1 Z-1 F300\nM30\n";

fn tip(number: Option<u32>, z: f64) -> StatedTool {
    let mut tool = StatedTool::default();
    tool.frame.number = number;
    tool.frame.pose = Some(nalgebra::Isometry3::translation(10.0, -20.0, z));
    tool.mass_kg = Some(2.0);
    tool
}

/// The tip of every motion of a made program, as its reader finds it.
fn tips(made: &Made, language: Language) -> Vec<f64> {
    let files = made.files.iter();
    let files = files.map(|(name, bytes)| SourceFile::new(name.clone(), bytes.clone()));
    let mut options = ReadOptions::default();
    for (number, z) in [(2, 180.0), (4, 120.0)] {
        let frame = nalgebra::Isometry3::translation(10.0, -20.0, z);
        options.frames.insert(format!("UT:{number}"), frame);
    }
    let program = read(language, files.collect(), &options).unwrap();
    let tips = program.motions.iter().map(|motion| {
        let tool = motion.tool.known();
        tool.unwrap_or_else(|| panic!("{:?}", motion.tool))
            .translation
            .z
    });
    tips.collect()
}

/// Every motion goes with the tip of the tool that is in the spindle, and RAPID declares each.
#[test]
fn the_tool_before_the_first_change_keeps_its_tip() {
    for number in [None, Some(1), Some(2), Some(7)] {
        let mut template = super::cell();
        template.tool = tip(number, 180.0);
        template.tools.insert(2, tip(Some(4), 120.0));
        template.start_joints_deg = Some(vec![0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
        for (made_in, language) in super::ROBOTS {
            if language == Language::FanucLs && number != Some(2) {
                continue;
            }
            let made = super::made(TWO_TOOLS, &template, made_in);
            let found = tips(&made, language);
            let wanted = [180.0, 180.0, 180.0, 180.0, 120.0, 120.0, 120.0];
            let mut apart = Worst::new();
            apart.all_apart(&found, &wanted);
            assert!(apart.holds(1e-9), "{language:?}: {found:?}");
            if language == Language::Rapid {
                let text = text_of(&made, 0);
                let own = format!("PERS tooldata tool{}:=", number.unwrap_or(1));
                assert!(
                    text.contains(&own) && text.contains("PERS tooldata tool4:="),
                    "{text}"
                );
            }
        }
    }
}

/// KRL takes the load with the tool, from the controller's list where the mass is not stated; nothing is said where none is.
#[test]
fn krl_takes_the_load_with_the_tool() {
    let mut template = super::cell();
    template.tool = tip(Some(2), 180.0);
    template.tool.centre_of_mass_mm = Some(nalgebra::Vector3::new(0.0, 0.0, 60.0));
    let mut other = tip(Some(4), 120.0);
    other.mass_kg = None;
    template.tools.insert(2, other);
    template.start_joints_deg = Some(vec![0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let text = text_of(&super::made(TWO_TOOLS, &template, MakeLanguage::Krl), 0);
    let loads = text.lines().filter(|line| line.starts_with("$LOAD"));
    let loads: Vec<&str> = loads.collect();
    let [own, other] = loads.as_slice() else {
        panic!("{text}");
    };
    let begin = "$LOAD={M 2,CM {X 0.000000,Y 0.000000,Z 60.000000,A 0.0";
    assert!(
        own.starts_with(begin) && own.ends_with("},J {X 0,Y 0,Z 0}}"),
        "{own}"
    );
    assert_eq!(*other, "$LOAD=LOAD_DATA[4]");
    template.tool.mass_kg = None;
    let text = text_of(&super::made(TWO_TOOLS, &template, MakeLanguage::Krl), 0);
    assert!(!text.contains("$LOAD"), "{text}");
}

/// Each of them is refused, with its line where it has one.
#[test]
fn tools_that_a_template_does_not_tell_are_refused() {
    let refused = |text: &str, template: &Template, language: MakeLanguage| {
        let (program, path) = super::gcode(text);
        let faults = make(&path, &events_of_gcode(&program, &path), template, language);
        let faults = faults.expect_err("it is refused");
        (faults[0].line, faults[0].reason.clone())
    };
    let mut own = super::cell();
    own.tool = tip(Some(2), 180.0);
    let mut numbered = super::cell();
    numbered.tools.insert(1, tip(Some(4), 120.0));
    numbered.tools.insert(2, tip(Some(4), 120.0));
    for (language, _) in super::ROBOTS {
        let (line, reason) = refused(TWO_TOOLS, &own, language);
        assert_eq!(line, Some(5));
        assert!(
            reason.contains("takes the tool 2 after moves at feed"),
            "{reason}"
        );
        let (line, reason) = refused(TWO_TOOLS, &numbered, language);
        assert_eq!(line, Some(2));
        assert!(reason.contains("has taken no tool here"), "{reason}");
        let (line, reason) = refused(&TWO_TOOLS.replace("G21", "T5 M6\nG21"), &numbered, language);
        assert_eq!(line, Some(1));
        assert!(
            reason.contains("takes the tool 5, one of several"),
            "{reason}"
        );
    }
    // Rapids before it: the finding says which tip they go with.
    let rapids = TWO_TOOLS.replace("G1 Z-1 F300\nG0 Z50", "G0 Z50");
    let made = super::made(&rapids, &own, MakeLanguage::Krl);
    assert!(
        found(&made, "takes the tool 2 here after rapids"),
        "{:?}",
        made.findings
    );
    // Two tips under one number.
    let mut alike = own.clone();
    alike.tools.insert(2, tip(Some(2), 120.0));
    for language in [MakeLanguage::Rapid, MakeLanguage::FanucLs] {
        let (_, reason) = refused(TWO_TOOLS, &alike, language);
        assert!(
            reason.contains("[tool] and in_program = 2 under [[tools]] are both"),
            "{reason}"
        );
    }
    assert!(
        tips(
            &super::made(TWO_TOOLS, &alike, MakeLanguage::Krl),
            Language::Krl
        )
        .len()
            == 6
    );
}

/// Another edge of a tool has a tip of its own.
#[test]
fn another_edge_is_refused_by_line() {
    let text = "G90 G71 G17 G54\nT1 D1 M6\nG0 X0 Y0 Z10\nG1 X10 F100\nD2\nG0 X0 Y0 Z10\nG1 X20 F100\nM30\n";
    let made = |text: &str| {
        let files = vec![SourceFile::new("edges.mpf", text)];
        let program = read(Language::Siemens, files, &ReadOptions::default()).unwrap();
        let robot = path_of(&program, &PathOptions::default()).unwrap();
        make_of_robot(&program, &robot, &super::cell(), MakeLanguage::Krl)
    };
    let faults = made(text).unwrap_err();
    assert_eq!((faults.len(), faults[0].line), (1, Some(5)));
    assert!(
        faults[0]
            .reason
            .starts_with("D2 is another edge of the tool than D1 before")
    );
    made(&text.replace("D2", "D1")).unwrap();
    made(&text.replace("D2", "; D2")).unwrap();
}

/// A table of several tools names them in a column, which readers follow, and says whose axes the places are in.
#[test]
fn tables_name_several_tools() {
    let krl = "DEF a( )\n$BASE=BASE_DATA[3]\n$VEL.CP=0.02\n$TOOL=TOOL_DATA[5]\nPTP {X 0,Y 9,Z 20,A 0,B 180,C 0}\nLIN {X 4,Y 9,Z 20,A 0,B 180,C 0}\n\
        $TOOL=TOOL_DATA[1]\nPTP {X 5,Y 0,Z 20,A 0,B 180,C 0}\nLIN {X 8,Y 9,Z 20,A 0,B 180,C 0}\nEND\n";
    let tools = |text: &str| {
        let made = of_robot(Language::Krl, text, MakeLanguage::Csv);
        assert!(
            found(&made, "in axes of the work object `BASE_DATA[3]`"),
            "{:?}",
            made.findings
        );
        let files = vec![SourceFile::new("part.csv", made.files[0].1.clone())];
        let again = read(Language::Poses, files, &ReadOptions::default()).unwrap();
        let tools = again.motions.iter().map(|motion| motion.tool.name.clone());
        tools.collect::<Vec<String>>()
    };
    assert_eq!(tools(krl), ["5", "5", "1", "1"]);
    // One tool has no column.
    assert_eq!(tools(&krl.replace("[5]", "[1]")), ["tool"; 4]);
}
