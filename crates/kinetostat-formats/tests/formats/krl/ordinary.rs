//! What ordinary programs have: status words, literals of inline forms, home positions of the controller.

use kinetostat_formats::*;
use nalgebra::Vector3;

use super::{main_with, written};

const END: &str = "LIN {X 60,Y 0,Z 0,A 0,B 0,C 180}";

/// Digits in quotation marks need no blank before them, numbers have signs and exponents.
#[test]
fn status_words_and_numbers_are_read_as_they_are_written() {
    for (written_as, numbers) in [
        ("S'B010',T'B000010'", vec![2.0, 2.0]),
        ("S 'B110', T 'B100011'", vec![6.0, 35.0]),
        ("S'H2',T'h23'", vec![2.0, 35.0]),
        ("S 2,T 35", vec![2.0, 35.0]),
    ] {
        let start = format!("PTP {{X +1.25e1,Y -.5,Z 3E+1,A -0,B 0.,C +180,{written_as}}} C_PTP");
        let program = main_with("", &format!("{start}\n{END}"));
        let pose = program.motions[0].target.pose().unwrap();
        assert_eq!(pose.position_mm, Vector3::new(12.5, -0.5, 30.0));
        assert_eq!(pose.configuration.numbers, numbers, "{written_as}");
        assert!(written(&program, &[]).contains(&start));
    }
    // A number could grow into a name.
    let files = vec![SourceFile::new(
        "part.src",
        "DEF part()\nLIN {X+5,Y 0,Z 0}\nEND\n",
    )];
    assert!(read_krl(files, &ReadOptions::default()).is_err());
}

/// `FDAT_ACT={TOOL_NO 1,BASE_NO 2}` says of BAS what data of that name say.
#[test]
fn literals_of_inline_forms_are_what_data_would_be() {
    let data = "TOOL_DATA[1]={X 0,Y 0,Z 250,A 0,B 0,C 0}\n\
        BASE_DATA[2]={X 1500,Y 0,Z 700,A 0,B 0,C 0}\n";
    let literal = "FDAT_ACT={TOOL_NO 1,BASE_NO 2,IPO_FRAME #BASE}";
    for form in [
        format!(
            "PDAT_ACT={{VEL 15,ACC 100,APO_DIST 50}}\n{literal}\nBAS(#PTP_PARAMS,15)\n$APO.CDIS=3\n$VEL.CP=0.2"
        ),
        format!(
            "LDAT_ACT={{VEL 2,ACC 100,APO_DIST 3,ORI_TYP #VAR}}\n{literal}\nBAS(#CP_PARAMS,0.2)"
        ),
        "BAS(#TOOL,1)\nBAS(#BASE,2)\nBAS(#VEL_CP,0.2)\n$APO.CDIS=3".to_owned(),
        format!("{literal}\nBAS(#FRAMES)\nBAS(#VEL_CP,0.2)\n$APO.CDIS=3"),
    ] {
        let program = main_with(data, &format!("BAS(#INITMOV,0)\n{form}\n{END} C_DIS"));
        let motion = &program.motions[0];
        let place = |frame: &FrameUse| frame.known().map(|frame| frame.translation.vector);
        assert_eq!(
            place(&motion.tool),
            Some(Vector3::new(0.0, 0.0, 250.0)),
            "{form}"
        );
        assert_eq!(
            place(&motion.work_object),
            Some(Vector3::new(1500.0, 0.0, 700.0)),
            "{form}"
        );
        assert_eq!(
            (motion.speed.mm_per_s, motion.zone),
            (Some(200.0), Zone::Radius(3.0)),
            "{form}"
        );
    }
    let files = vec![SourceFile::new(
        "part.src",
        format!(
            "DEF part()\nFDAT_ACT={{TOOL_NO 1,BASE_NO 2,IPO_FRAME #TCP}}\nBAS(#FRAMES)\n{END}\nEND\n"
        ),
    )];
    let faults = read_krl(files, &ReadOptions::default()).unwrap_err();
    assert!(
        faults[0].reason.contains("the robot holds the part"),
        "{faults:?}"
    );
}

const CONFIG: &str = "&ACCESS RV1\nDEFDAT $CONFIG PUBLIC\nINT USER=3\nDECL E6AXIS XHOME={A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 45.0,A6 0.0,E1 0.0}\n\
    DECL FDAT FHOME={TOOL_NO 0,BASE_NO 0,IPO_FRAME #BASE,POINT2[] \" \"}\n;DECL E6AXIS XHOME={A1 7}\nGLOBAL FRAME PLACE = {X 1,Y 2,Z 3,A 0,B 0,C 0}\nENDDAT\n";

/// `PTP XHOME`: what $config.dat says, and where it is not given it is left as written, with a finding.
#[test]
fn home_positions_are_those_of_the_controller() {
    let source = format!(
        "DEF part()\nFDAT_ACT=FHOME\nBAS(#PTP_PARAMS,100)\n$H_POS=XHOME\nPTP XHOME\n{END}\nPTP XHOME\nEND\n"
    );
    let part = SourceFile::new("part.src", source);
    assert!(krl_needs_config(std::slice::from_ref(&part)));
    let config = SourceFile::new("$config.dat", CONFIG);
    let positions = krl_frames_of_config(&config).unwrap();
    let kept = String::from_utf8_lossy(positions.bytes()).into_owned();
    assert!(
        !kept.contains("USER") && kept.contains("PLACE") && kept.lines().count() == 8,
        "{kept}"
    );
    for config in [config, positions] {
        let program = read_krl(vec![part.clone(), config], &ReadOptions::default()).unwrap();
        let joints = vec![0.0, -90.0, 90.0, 0.0, 45.0, 0.0];
        assert_eq!(
            program.motions[0].target,
            Target::Joints { values_deg: joints }
        );
        assert_eq!(program.motions[1].tool.name, "TOOL_DATA[0]");
    }
    let program = read_krl(vec![part], &ReadOptions::default()).unwrap();
    assert!(matches!(program.motions[0].target, Target::Unknown { .. }));
    let said = (program.findings.iter())
        .filter(|finding| finding.message.contains("no `XHOME` is declared"));
    assert_eq!(
        said.map(|finding| finding.line).collect::<Vec<usize>>(),
        [5, 7]
    );
    // What goes on from it must say all of its end, and other motions than those of joints are no matter of the controller.
    for statements in [
        "PTP XHOME\nLIN {X 60,Y 0,Z 0}",
        "PTP XHOME\nLIN_REL {X 5}",
        "LIN XHOME",
        "PTP $POS_RET",
    ] {
        let files = vec![SourceFile::new(
            "part.src",
            format!("DEF part()\n{statements}\nEND\n"),
        )];
        assert!(
            read_krl(files, &ReadOptions::default()).is_err(),
            "{statements}"
        );
    }
}
