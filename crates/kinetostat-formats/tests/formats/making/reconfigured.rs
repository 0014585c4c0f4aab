//! Joint motions that take the arm to another configuration, and speeds of turning.

use kinetostat_formats::*;

use super::{found, of_robot, read_made, text_of};

const KRL: &str = "DEF a( )\n$BASE={X 1700,Y 0,Z 900,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 180,A 0,B 0,C 0}\n$VEL.CP=0.01\n\
    PTP {X 0,Y 0,Z 50,A 0,B 0,C 180,S 2,T 3}\nLIN {X 0,Y 0,Z 0,A 0,B 0,C 180} C_DIS\n\
    PTP {X 10,Y 0,Z 50,A 0,B 0,C 180,S 6,T 27}\nLIN {X 10,Y 0,Z 0,A 0,B 0,C 180}\n\
    PTP {X 20,Y 0,Z 50,A 0,B 0,C 180,S 6,T 27}\nEND\n";

const NONE: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";

fn kinds(made: &Made, language: Language) -> Vec<bool> {
    let again = read_made(made, language);
    let motions = again.motions.iter();
    motions
        .map(|motion| motion.kind == MotionKind::Joint)
        .collect()
}

#[test]
fn in_the_same_language_they_stay_joint_motions() {
    let made = of_robot(Language::Krl, KRL, MakeLanguage::Krl);
    let text = text_of(&made, 0);
    // It stops before and behind: no corner is rounded from one configuration into another.
    assert!(
        text.contains("LIN {X 0.000000,Y 0.000000,Z 0.000000,A 0.00000000,B 0.00000000,C 180.00000000}\nPTP {X 10.000000,Y 0.000000,Z 50.000000,A 0.00000000,B 0.00000000,C 180.00000000,S 6,T 27}\n"),
        "{text}"
    );
    // The last one keeps the configuration, and is a straight rapid as the template says.
    assert_eq!(
        kinds(&made, Language::Krl),
        [true, false, true, false, false]
    );
    assert!(
        found(&made, "so joint motions stay joint motions there (line 7)"),
        "{:?}",
        made.findings
    );
}

#[test]
fn a_turn_of_the_arm_in_place_is_a_motion() {
    let text = KRL.replace("PTP {X 10,Y 0,Z 50", "PTP {X 0,Y 0,Z 0");
    let made = of_robot(Language::Krl, &text, MakeLanguage::Krl);
    assert_eq!(
        kinds(&made, Language::Krl),
        [true, false, true, false, false]
    );
}

#[test]
fn in_another_language_they_are_named_with_their_lines() {
    for into in [MakeLanguage::Rapid, MakeLanguage::FanucLs] {
        let made = of_robot(Language::Krl, KRL, into);
        let finding = (made.findings.iter()).find(|finding| {
            finding
                .message
                .contains("takes the arm to another configuration")
        });
        let finding = finding.unwrap_or_else(|| panic!("{:?}", made.findings));
        assert_eq!(finding.line, Some(7));
        assert!(
            finding.message.contains("(line 7)")
                && finding.message.contains("divide the source there"),
            "{finding:?}"
        );
    }
    // A template's configuration is that of the first pose alone.
    let mut template = Template::default();
    template.configuration = Some("S 2,T 10".to_owned());
    let files = vec![SourceFile::new("a.src", KRL)];
    let program = read_krl(files, &ReadOptions::default()).unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let made = make_of_robot(&program, &robot, &template, MakeLanguage::Krl).unwrap();
    assert!(
        found(&made, "divide the source there"),
        "{:?}",
        made.findings
    );
    // Machines have none.
    let made = of_robot(Language::Krl, KRL, MakeLanguage::Csv);
    assert!(!found(&made, "another configuration"));
}

fn rapid(switch: &str) -> String {
    let target =
        |x: u32, configuration: &str| format!("[[{x},0,50],[0,0,1,0],{configuration},{NONE}]");
    format!(
        "MODULE b\nPROC main()\n{switch}MoveJ {},v100,z10,tool0;\nMoveL {},v20,fine,tool0;\nMoveJ {},v100,fine,tool0;\nMoveL {},v20,fine,tool0;\nENDPROC\nENDMODULE\n",
        target(0, "[0,0,0,0]"),
        target(5, "[0,0,0,0]"),
        target(10, "[-1,1,-2,1]"),
        target(20, "[-1,1,-2,1]"),
    )
}

#[test]
fn rapid_goes_by_its_configurations_unless_it_is_switched_off() {
    let made = of_robot(Language::Rapid, &rapid(""), MakeLanguage::Rapid);
    assert_eq!(kinds(&made, Language::Rapid), [true, false, true, false]);
    let text = text_of(&made, 0);
    let at = text.find("MoveJ [[10.000000").unwrap();
    assert!(text[..at].contains("ConfJ\\On;"), "{text}");
    let off = rapid("ConfJ\\Off;\n");
    for into in [MakeLanguage::Rapid, MakeLanguage::Krl] {
        let made = of_robot(Language::Rapid, &off, into);
        assert!(
            !found(&made, "another configuration"),
            "{:?}",
            made.findings
        );
    }
}

#[test]
fn tp_programs_keep_theirs() {
    let position = |number: u32, stated: &str| {
        format!(
            "P[{number}]{{\n   GP1:\n\tUF : 1, UT : 2,\t\tCONFIG : '{stated}',\n\tX = {number}.000  mm,\tY = 0.000  mm,\tZ = 50.000  mm,\n\tW = 180.000 deg,\tP = 0.000 deg,\tR = 10.000 deg\n}};\n"
        )
    };
    let text = format!(
        "/PROG  C\n/ATTR\nDEFAULT_GROUP\t= 1,*,*,*,*;\n/MN\n   1:  UFRAME_NUM=1 ;\n   2:  UTOOL_NUM=2 ;\n   3:J P[1] 50% FINE    ;\n   4:L P[2] 20mm/sec CNT10    ;\n   5:J P[3] 50% CNT50    ;\n   6:L P[4] 20mm/sec FINE    ;\n/POS\n{}{}{}{}/END\n",
        position(1, "N U T, 0, 0, 0"),
        position(2, "N U T,  0, 0, 0"),
        position(3, "F U T, 0, 0, 1"),
        position(4, "F U T, 0, 0, 1"),
    );
    let made = of_robot(Language::FanucLs, &text, MakeLanguage::FanucLs);
    assert_eq!(kinds(&made, Language::FanucLs), [true, false, true, false]);
    assert!(text_of(&made, 0).contains("CONFIG : 'F U T, 0, 0, 1'"));
    let made = of_robot(Language::FanucLs, &text, MakeLanguage::Krl);
    assert!(
        found(&made, "(line 9), and the arm keeps"),
        "{:?}",
        made.findings
    );
}

#[test]
fn speeds_of_turning_are_kept_in_rapid_and_named_elsewhere() {
    let text = rapid("").replace("v20,fine", "[20,15,77,1000],fine");
    let made = of_robot(Language::Rapid, &text, MakeLanguage::Rapid);
    let own = text_of(&made, 0);
    assert!(own.contains(":=[20,15,77,1000];"), "{own}");
    let made = of_robot(Language::Rapid, &text, MakeLanguage::Krl);
    assert!(
        found(&made, "(15,77,1000; lines 4, 6) are not kept"),
        "{:?}",
        made.findings
    );
    let made = of_robot(Language::Rapid, &rapid(""), MakeLanguage::Krl);
    assert!(!found(&made, "speeds of turning"), "{:?}", made.findings);
    // The speed of the tip may be stated beside the data.
    let text = rapid("").replace("v20,fine", "[20,15,77,1000]\\V:=30,fine");
    let made = of_robot(Language::Rapid, &text, MakeLanguage::Rapid);
    let own = text_of(&made, 0);
    assert!(own.contains(":=[30,15,77,1000];"), "{own}");
    let made = of_robot(Language::Rapid, &text, MakeLanguage::Krl);
    assert!(
        found(&made, "(15,77,1000; lines 4, 6) are not kept"),
        "{:?}",
        made.findings
    );
    // What data of another module state is not known, in any language.
    let text = rapid("").replace("v20,fine", "vElsewhere\\V:=30,fine");
    for into in [MakeLanguage::Rapid, MakeLanguage::Krl] {
        let made = of_robot(Language::Rapid, &text, into);
        let said =
            "are not known: its data of the speed are declared elsewhere, or change (lines 4, 6)";
        assert!(found(&made, said), "{:?}", made.findings);
    }
}
