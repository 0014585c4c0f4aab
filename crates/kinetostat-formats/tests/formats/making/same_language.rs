//! What a program keeps that is made in the language of its source.

use kinetostat_formats::*;

use super::{read_made, text_of};

fn made_of(name: &str, text: &str, template: &Template, into: MakeLanguage) -> Made {
    let files = vec![SourceFile::new(name, text)];
    let options = ReadOptions::default();
    let program = match name.rsplit('.').next() {
        Some("mod") => read_rapid(files, &options),
        Some("src") => read_krl(files, &options),
        _ => read_ls(files, &options),
    };
    let program = program.unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    make_of_robot(&program, &robot, template, into).unwrap()
}

fn configurations(made: &Made, language: Language) -> Vec<String> {
    let again = read_made(made, language);
    let texts = again.motions.iter().map(|motion| {
        let pose = motion.target.pose().unwrap();
        pose.configuration.text.clone()
    });
    texts.collect()
}

fn says(made: &Made, part: &str) -> bool {
    made.findings.iter().any(|f| f.message.contains(part))
}

fn ls(configurations: [&str; 3]) -> String {
    let positions = configurations.iter().enumerate().map(|(index, text)| {
        format!(
            "P[{}]{{\n   GP1:\n\tUF : 1, UT : 1,\t\tCONFIG : '{text}',\n\tX = {}.000  mm,\tY = 0.000  mm,\tZ = 0.000  mm,\n\tW = 180.000 deg,\tP = 0.000 deg,\tR = 0.000 deg\n}};\n",
            index + 1,
            10 * (index + 1),
        )
    });
    format!(
        "/PROG  LSC\n/ATTR\nLINE_COUNT\t= 5;\n/MN\n   1:  UFRAME_NUM=1 ;\n   2:  UTOOL_NUM=1 ;\n   3:J P[1] 10% FINE    ;\n   4:L P[2] 10mm/sec FINE    ;\n   5:L P[3] 10mm/sec CNT20    ;\n/POS\n{}/END\n",
        positions.collect::<String>()
    )
}

const NONE: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";

fn rapid(body: &str) -> String {
    format!(
        "MODULE Slot\n  PERS tooldata tMill:=[TRUE,[[0,0,180],[1,0,0,0]],[5,[1,2,60],[0.6,0,0.8,0],0.1,0.2,0.003]];\n  PROC main()\n{body}  ENDPROC\nENDMODULE\n"
    )
}

fn target(x: u32, configuration: &str) -> String {
    format!("[[{x},0,20],[0,0,1,0],{configuration},{NONE}]")
}

/// Three poses with their own configurations each.
fn turning() -> String {
    rapid(&format!(
        "    MoveJ {},v500,z10,tMill;\n    MoveL {},v20,fine,tMill;\n    MoveC {},{},v20,fine,tMill;\n",
        target(0, "[0,-1, 0,1]"),
        target(60, "[-1,0,0,1]"),
        "[[65,5,20],[0,0,1,0],[-1,-2,0,1],[9E9,9E9,9E9,9E9,9E9,9E9]]",
        "[[70,0,20],[0,0,1,0],[0,0,-2,1],[9E9,9E9,9E9,9E9,9E9,9E9]]",
    ))
}

const KRL: &str = "DEF ev( )\n$BASE={X 1800,Y 0,Z 900,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 180,A 0,B 0,C 0}\nPTP {X 0,Y 0,Z 5,A 0,B 0,C 180,S 6,T 35}\n$VEL.CP=0.1\n\
    LIN {X 10,Y 0,Z 0,A 0,B 0,C 180}\nLIN {X 50,Y 0,Z 0,A 0,B 0,C 180,S 2,T 3}\nEND\n";

#[test]
fn each_pose_keeps_its_configuration_in_the_same_language() {
    let own = Template::default();
    let all = ["F D B, 0, 0, 0", "F D B, 0, -1, 0", "F D B, 0, 0, 1"];
    let made = made_of("a.ls", &ls(all), &own, MakeLanguage::FanucLs);
    assert_eq!(configurations(&made, Language::FanucLs), all);
    assert!(!says(&made, "configuration"), "{:?}", made.findings);

    let made = made_of("a.mod", &turning(), &own, MakeLanguage::Rapid);
    assert_eq!(
        configurations(&made, Language::Rapid),
        ["[0,-1,0,1]", "[-1,0,0,1]", "[0,0,-2,1]"]
    );
    let text = text_of(&made, 0);
    assert!(text.contains("MoveC [[65.000000,5.000000,20.000000],[0.0000000000,0.0000000000,1.0000000000,0.0000000000],[-1,-2,0,1],"), "{text}");
    assert!(!says(&made, "configuration"), "{:?}", made.findings);

    let made = made_of("a.src", KRL, &own, MakeLanguage::Krl);
    assert_eq!(
        configurations(&made, Language::Krl),
        ["S 6,T 35", "", "S 2,T 3"]
    );
    assert!(!says(&made, "configuration"), "{:?}", made.findings);
}

#[test]
fn configurations_that_another_language_does_not_take_are_named_with_their_lines() {
    let own = Template::default();
    for (into, title) in [
        (MakeLanguage::Krl, "KRL (S and T)"),
        (MakeLanguage::FanucLs, "a TP program (CONFIG)"),
        (MakeLanguage::Apt, "APT does not state it"),
        (MakeLanguage::Csv, "a table of poses does not state it"),
    ] {
        let made = made_of("a.mod", &turning(), &own, into);
        let lost: Vec<_> = (made.findings.iter())
            .filter(|finding| finding.message.contains("configurations of the source"))
            .collect();
        assert_eq!(lost.len(), 1, "{:?}", made.findings);
        assert_eq!(lost[0].line, Some(4));
        assert!(
            lost[0].message.contains("lines 4 to 6") && lost[0].message.contains(title),
            "{lost:?}"
        );
    }
    let made = made_of("a.src", KRL, &own, MakeLanguage::Rapid);
    assert!(
        says(&made, "source: lines 4, 7) is not kept"),
        "{:?}",
        made.findings
    );
    // What the template states holds.
    let mut stated = Template::default();
    stated.configuration = Some("S 2,T 10".to_owned());
    let made = made_of("a.src", KRL, &stated, MakeLanguage::Krl);
    assert_eq!(configurations(&made, Language::Krl), ["S 2,T 10", "", ""]);
    assert!(says(
        &made,
        "lines 4, 7) is not kept: the template states `S 2,T 10`"
    ));
}

/// Where the part is elsewhere, the arm may not reach it as it did.
#[test]
fn configurations_under_another_base_or_tool_are_warned_of() {
    let words = "stands elsewhere than there: check";
    let mut template = Template::default();
    template.base.pose = Some(nalgebra::Isometry3::translation(1800.0, 0.0, 900.0));
    let made = made_of("a.src", KRL, &template, MakeLanguage::Krl);
    assert!(!says(&made, words), "{:?}", made.findings);
    template.base.pose = Some(nalgebra::Isometry3::translation(1500.0, 0.0, 900.0));
    let made = made_of("a.src", KRL, &template, MakeLanguage::Krl);
    assert!(
        says(&made, &format!("the base of the template {words}")),
        "{:?}",
        made.findings
    );
    assert_eq!(configurations(&made, Language::Krl)[0], "S 6,T 35");
    template.tool.frame.pose = Some(nalgebra::Isometry3::translation(0.0, 0.0, 90.0));
    let made = made_of("a.src", KRL, &template, MakeLanguage::Krl);
    assert!(says(
        &made,
        &format!("the base with the tool of the template {words}")
    ));
    let made = made_of("a.src", KRL, &template, MakeLanguage::Rapid);
    assert!(!says(&made, words), "{:?}", made.findings);
}

/// MoveJ goes to the configuration of its target under `ConfJ\On` alone.
#[test]
fn a_stated_configuration_counts_in_rapid() {
    let own = Template::default();
    let body = |made: &Made| {
        let text = text_of(made, 0);
        let lines = text.lines().map(str::trim);
        let lines = lines.filter(|line| line.starts_with("Conf") || line.starts_with("Move"));
        lines
            .map(|line| line.split([' ', ';']).next().unwrap_or_default().to_owned())
            .collect::<Vec<_>>()
    };
    let stated = [
        "ConfJ\\On",
        "ConfL\\Off",
        "MoveJ",
        "ConfJ\\Off",
        "MoveL",
        "MoveC",
    ];
    let taken = ["ConfJ\\Off", "ConfL\\Off", "MoveJ", "MoveL", "MoveC"];
    let made = made_of("a.mod", &turning(), &own, MakeLanguage::Rapid);
    assert_eq!(body(&made), stated);
    let made = made_of("a.src", KRL, &own, MakeLanguage::Rapid);
    assert_eq!(body(&made)[..3], taken[..3]);
    let mut template = Template::default();
    template.configuration = Some("[0,-1,0,1]".to_owned());
    let made = made_of("a.src", KRL, &template, MakeLanguage::Rapid);
    assert_eq!(body(&made)[..4], stated[..4]);
    assert!(text_of(&made, 0).contains("[0,-1,0,1]"));
    // A source that switches it off goes by none.
    let off = turning().replace("    MoveJ", "    ConfJ\\Off;\n    MoveJ");
    let made = made_of("a.mod", &off, &own, MakeLanguage::Rapid);
    assert_eq!(body(&made), taken);
    let on = turning().replace("    MoveJ", "    ConfJ\\Off;\n    ConfJ \\On;\n    MoveJ");
    let made = made_of("a.mod", &on, &own, MakeLanguage::Rapid);
    assert_eq!(body(&made), stated);
    // Joint rapids further on, too.
    let mut template = Template::default();
    template.rapids = Rapids::Joint;
    let joints = turning().replace(
        "  ENDPROC",
        &format!(
            "    MoveJ {},v500,fine,tMill;\n  ENDPROC",
            target(80, "[0,0,-2,1]")
        ),
    );
    let made = made_of("a.mod", &joints, &template, MakeLanguage::Rapid);
    assert_eq!(body(&made)[..6], stated);
    assert_eq!(body(&made)[6..], ["ConfJ\\On", "MoveJ"]);
}

#[test]
fn tools_of_rapid_keep_their_load() {
    let load = "[5,[1.000000,2.000000,60.000000],[0.6000000000,0.0000000000,0.8000000000,0.0000000000],0.1,0.2,0.003]]";
    let own = Template::default();
    let made = made_of("a.mod", &turning(), &own, MakeLanguage::Rapid);
    assert!(text_of(&made, 0).contains(load), "{}", text_of(&made, 0));
    assert!(!says(&made, "mass"), "{:?}", made.findings);
    // The template goes before, and leaves what it does not state.
    let mut template = Template::default();
    template.tool.mass_kg = Some(7.0);
    let made = made_of("a.mod", &turning(), &template, MakeLanguage::Rapid);
    let text = text_of(&made, 0);
    assert!(
        text.contains("PERS tooldata tMill:=[TRUE,[[0.000000,0.000000,180.000000],")
            && text.contains("[7,[0.000000,0.000000,1.000000],[1,0,0,0],0,0,0]]"),
        "{text}"
    );
    let mut template = Template::default();
    template.tool.frame.name = Some("tOther".to_owned());
    template.tool.frame.pose = Some(nalgebra::Isometry3::translation(0.0, 0.0, 150.0));
    let made = made_of("a.mod", &turning(), &template, MakeLanguage::Rapid);
    let text = text_of(&made, 0);
    assert!(
        text.contains("PERS tooldata tOther:=[TRUE,[[0.000000,0.000000,150.000000],")
            && text.contains(load),
        "{text}"
    );
    assert!(says(
        &made,
        "5 kg and what else of its load is not stated are those of the source"
    ));
    // A tool without a load has -1 kg.
    let without = turning().replace("[5,[1,2,60]", "[-1,[0,0,0]");
    let made = made_of("a.mod", &without, &own, MakeLanguage::Rapid);
    assert!(says(&made, "1 kg is written"), "{:?}", made.findings);
    // Two tools keep two loads.
    let two = turning()
        .replace(
            "  PROC",
            "  PERS tooldata tDrill:=[TRUE,[[0,0,90],[1,0,0,0]],[2,[0,0,40],[1,0,0,0],0,0,0]];\n  PROC",
        )
        .replace("v20,fine,tMill;\n    MoveC", "v20,fine,tDrill;\n    MoveC")
        .replace("v20,fine,tMill;\n  ENDPROC", "v20,fine,tDrill;\n  ENDPROC");
    let made = made_of("a.mod", &two, &own, MakeLanguage::Rapid);
    let text = text_of(&made, 0);
    assert!(
        text.contains(load) && text.contains("[2,[0.000000,0.000000,40.000000],"),
        "{text}"
    );
}

/// A work object is calibrated by its user frame, and moved by its object frame.
#[test]
fn work_objects_of_rapid_keep_both_frames() {
    let both = "[[1800.000000,0.000000,900.000000],[1.0000000000,0.0000000000,0.0000000000,0.0000000000]],[[10.000000,20.000000,30.000000],[0.7071067812,0.0000000000,0.0000000000,0.7071067812]]";
    let text = turning().replace(",tMill;", ",tMill\\WObj:=wPart;").replace(
        "  PROC",
        "  PERS wobjdata wPart:=[FALSE,TRUE,\"\",[[1800,0,900],[1,0,0,0]],[[10,20,30],[0.7071067812,0,0,0.7071067812]]];\n  PROC",
    );
    let own = Template::default();
    let made = made_of("a.mod", &text, &own, MakeLanguage::Rapid);
    let words = text_of(&made, 0);
    assert!(
        words.contains(&format!("PERS wobjdata wPart:=[FALSE,TRUE,\"\",{both}];")),
        "{words}"
    );
    let again = read_made(&made, Language::Rapid);
    let place = again.motions[1].base_pose().unwrap().translation.vector;
    assert!(
        (place - nalgebra::Vector3::new(1810.0, 80.0, 950.0)).norm() < 1e-5,
        "{place}"
    );
    let made = made_of("a.mod", &text, &own, MakeLanguage::Krl);
    assert!(text_of(&made, 0).contains("$BASE={X 1810.000000,Y 20.000000,Z 930.000000,"));
}

/// How fast the arm turns and speeds up is stated by no made program.
#[test]
fn accelerations_of_the_source_are_named() {
    let own = Template::default();
    let krl = KRL.replace(
        "$VEL.CP=0.1",
        "$VEL.CP=0.1\n$ACC.CP=1\n$VEL.ORI1=50\nBAS(#VEL_PTP,30)",
    );
    let made = made_of("a.src", &krl, &own, MakeLanguage::Krl);
    assert!(
        says(&made, "are not those of the source (lines 6 to 8)"),
        "{:?}",
        made.findings
    );
    let all = ["N U T, 0, 0, 0"; 3];
    let tp = ls(all).replace("CNT20    ;", "CNT20 ACC50    ;");
    let made = made_of("a.ls", &tp, &own, MakeLanguage::FanucLs);
    assert!(
        says(&made, "are not those of the source (line 9)"),
        "{:?}",
        made.findings
    );
    for (name, text) in [
        ("a.src", KRL.to_owned()),
        ("a.ls", ls(all)),
        ("a.mod", turning()),
    ] {
        let made = made_of(name, &text, &own, MakeLanguage::Apt);
        assert!(!says(&made, "accelerations"), "{:?}", made.findings);
    }
}
