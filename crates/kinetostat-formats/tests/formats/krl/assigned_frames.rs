//! Tools and bases that the program puts into the arrays of the controller itself.

use kinetostat_formats::*;

use super::main_with;

const HERE: &str = "LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}";
const FOUR: &str = "TOOL_DATA[4]={X 0,Y 0,Z 180,A 0,B 0,C 0}";

/// Z of the tool of the last motion, or why it is not known.
fn tool(data: &str, statements: &str) -> Result<f64, String> {
    let program = main_with(data, statements);
    match &program.motions.last().unwrap().tool.frame {
        Frame::Known(frame) => Ok(frame.translation.z),
        Frame::Unknown { reason } => Err(reason.clone()),
    }
}

#[test]
fn a_literal_counts_from_where_it_is_assigned() {
    for (data, statements) in [
        ("", format!("{FOUR}\n$TOOL=TOOL_DATA[4]\n{HERE}")),
        ("", format!("{FOUR}\nBAS(#TOOL,4)\n{HERE}")),
        (
            "",
            format!("{FOUR}\nSLIN {{X 1,Y 2,Z 3,A 0,B 0,C 0}} WITH $TOOL=STOOL2(F1)"),
        ),
        ("", format!("{FOUR}\nFDAT_ACT=F1\nBAS(#FRAMES)\n{HERE}")),
        ("", format!("TOOL_DATA[4]=TC\n$TOOL=TOOL_DATA[4]\n{HERE}")),
        (
            "TOOL_DATA[4]={X 0,Y 0,Z 180,A 0,B 0,C 0}\n",
            format!("$TOOL=TOOL_DATA[4]\n{HERE}"),
        ),
        // What was in the file before does not matter behind it.
        (
            "DECL FRAME TOOL_DATA[16]\nTOOL_DATA[4]={X 0,Y 0,Z 5,A 0,B 0,C 0}\n",
            format!("{FOUR}\n$TOOL=TOOL_DATA[4]\n{HERE}"),
        ),
        // The routine that is called finds what its caller gave, and the other way round.
        (
            "",
            format!("{FOUR}\nSUB()\nEND\nDEF SUB()\n$TOOL=TOOL_DATA[4]\n{HERE}"),
        ),
        (
            "",
            format!("SUB()\n$TOOL=TOOL_DATA[4]\n{HERE}\nEND\nDEF SUB()\n{FOUR}"),
        ),
    ] {
        let data = format!(
            "DECL FRAME TC={{X 0,Y 0,Z 180,A 0,B 0,C 0}}\nDECL FDAT F1={{TOOL_NO 4,BASE_NO 0,IPO_FRAME #BASE}}\n{data}"
        );
        assert_eq!(tool(&data, &statements), Ok(180.0), "{data}{statements}");
    }
}

#[test]
fn what_is_not_certain_stays_unknown_with_its_line() {
    for (statements, words) in [
        // Before it.
        (
            format!("$TOOL=TOOL_DATA[4]\n{FOUR}\n{HERE}"),
            "whether that ran before is not certain",
        ),
        (
            format!("IF $IN[1] THEN\n{FOUR}\nENDIF\n$TOOL=TOOL_DATA[4]\n{HERE}"),
            "in line 3, and whether that ran before",
        ),
        (
            format!(
                "{FOUR}\nTOOL_DATA[4]={{X 0,Y 0,Z 190,A 0,B 0,C 0}}\n$TOOL=TOOL_DATA[4]\n{HERE}"
            ),
            "in lines 2 and 3, and not the same in both",
        ),
        (
            format!("{FOUR}\nTOOL_DATA[4].Z=190\n$TOOL=TOOL_DATA[4]\n{HERE}"),
            "in lines 2 and 3",
        ),
        (
            format!("{FOUR}\nTOOL_DATA[N]=TC\n$TOOL=TOOL_DATA[4]\n{HERE}"),
            "in lines 2 and 3",
        ),
        (
            format!("{FOUR}\nMEASURE(TOOL_DATA[4])\n$TOOL=TOOL_DATA[4]\n{HERE}"),
            "in lines 2 and 3",
        ),
        (
            format!("TOOL_DATA[4]=OTHER\n$TOOL=TOOL_DATA[4]\n{HERE}"),
            "in line 2, and not in numbers",
        ),
        (
            format!("{FOUR}\n$TOOL=TOOL_DATA[N]\n{HERE}"),
            "computed while the program runs",
        ),
        (
            format!("{FOUR}\n$TOOL=TOOL_DATA[5]\n{HERE}"),
            "none of these files states it",
        ),
    ] {
        let data = "DECL INT N\nDECL FRAME TC={X 0,Y 0,Z 180,A 0,B 0,C 0}\nDECL FRAME OTHER";
        let found = tool(data, &statements);
        assert!(
            found.as_ref().is_err_and(|reason| reason.contains(words)),
            "{statements}: {found:?}"
        );
    }
}

/// A frame that the program declares and gives numbers: the last value before, where that is certain.
#[test]
fn declared_frames_are_followed() {
    let z = |z: f64| format!("TC={{X 0,Y 0,Z {z},A 0,B 0,C 0}}");
    let (one, two) = (z(150.0), z(160.0));
    for (statements, wanted) in [
        (format!("{one}\n$TOOL=TC\n{HERE}"), 150.0),
        (format!("{one}\n{two}\n$TOOL=TC\n{HERE}"), 160.0),
        (format!("{one}\n$TOOL=TC\n{two}\n{HERE}"), 150.0),
        (
            format!("{one}\n$TOOL=TC:{{X 0,Y 0,Z 1,A 0,B 0,C 0}}\n{HERE}"),
            151.0,
        ),
    ] {
        let found = tool("DECL FRAME TC", &statements);
        assert!((found.unwrap() - wanted).abs() < 1e-9, "{statements}");
    }
    for statements in [
        format!("$TOOL=TC\n{one}\n{HERE}"),
        format!("{one}\nTC.Z=7\n$TOOL=TC\n{HERE}"),
        format!("{one}\nTC=OTHER\n$TOOL=TC\n{HERE}"),
        format!("{one}\nIF ready THEN\n{two}\nENDIF\n$TOOL=TC\n{HERE}"),
        format!("{one}\nLOOP\n$TOOL=TC\n{HERE}\n{two}\nENDLOOP"),
        format!("{one}\nchange(TC)\n$TOOL=TC\n{HERE}"),
        format!("{one}\nTC={{Z 5}}\n$TOOL=TC\n{HERE}"),
    ] {
        let found = tool("DECL FRAME TC\nDECL FRAME OTHER\nBOOL ready", &statements);
        assert!(found.is_err(), "{statements}: {found:?}");
    }
}

/// Two values of one name are two frames, also where neither is known.
#[test]
fn two_values_of_a_name_are_not_one_frame() {
    let statements = format!(
        "BC=a()\n$BASE=BC\n$TOOL=$NULLFRAME\n{HERE}\nBC=b()\n$BASE=BC\n$TOOL=$NULLFRAME\n{HERE}"
    );
    let program = main_with("DECL FRAME BC", &statements);
    let names: Vec<&str> = (program.motions.iter())
        .map(|motion| motion.work_object.name.as_str())
        .collect();
    assert_eq!(names, ["BC of line 3", "BC of line 7"]);
    let faults = path_of(&program, &PathOptions::default()).unwrap_err();
    assert!(
        faults[0]
            .reason
            .contains("is not known, and the program has another one")
    );
}
