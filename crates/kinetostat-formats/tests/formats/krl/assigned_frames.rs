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
        // The last one counts.
        (
            "",
            format!(
                "TOOL_DATA[4]={{X 0,Y 0,Z 190,A 0,B 0,C 0}}\n{FOUR}\n$TOOL=TOOL_DATA[4]\n{HERE}"
            ),
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
            "none of these files states it",
        ),
        (
            format!("IF $IN[1] THEN\n{FOUR}\nENDIF\n$TOOL=TOOL_DATA[4]\n{HERE}"),
            "is changed while the program runs (line 2)",
        ),
        (
            format!(
                "{FOUR}\nIF $IN[1] THEN\nTOOL_DATA[4]={{X 0,Y 0,Z 190,A 0,B 0,C 0}}\nENDIF\n$TOOL=TOOL_DATA[4]\n{HERE}"
            ),
            "is changed while the program runs (line 3)",
        ),
        (
            format!("{FOUR}\nTOOL_DATA[N]=TC\n$TOOL=TOOL_DATA[4]\n{HERE}"),
            "is changed while the program runs (line 3)",
        ),
        (
            format!("{FOUR}\nMEASURE(TOOL_DATA[4])\n$TOOL=TOOL_DATA[4]\n{HERE}"),
            "is changed while the program runs (line 3)",
        ),
        (
            format!("TOOL_DATA[4]=OTHER\n$TOOL=TOOL_DATA[4]\n{HERE}"),
            "none of these files states it",
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
        (format!("{one}\nTC.Z=7\n$TOOL=TC\n{HERE}"), 7.0),
        (format!("{one}\nTC.Z=TC.Z+1.5\n$TOOL=TC\n{HERE}"), 151.5),
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
        format!("{one}\nTC.Z=OTHER.Z\n$TOOL=TC\n{HERE}"),
        format!("{one}\nTC=OTHER\n$TOOL=TC\n{HERE}"),
        format!("{one}\nIF ready THEN\n{two}\nENDIF\n$TOOL=TC\n{HERE}"),
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

/// An element of an array is taken as it is where the frame is set: two values of it are two frames, each followed where it is certain.
#[test]
fn an_element_that_changes_is_another_frame() {
    let places = |statements: &str, options: &ReadOptions| {
        let source = format!("DEF part()\n$TOOL=$NULLFRAME\n{statements}\nEND\n");
        let files = vec![SourceFile::new("part.src", source)];
        let program = read_krl(files, options).unwrap_or_else(|errors| panic!("{errors:#?}"));
        let all = program.motions.iter().map(|motion| {
            let base = &motion.work_object;
            let place = base.known().map(|frame| frame.translation.vector.into());
            (base.name.clone(), place)
        });
        let all: Vec<(String, Option<[f64; 3]>)> = all.collect();
        (all, program)
    };
    let given = |y: f64| format!("BASE_DATA[1]={{X 1800,Y {y},Z 900,A 0,B 0,C 0}}");
    let used = format!("$TOOL=$NULLFRAME\n$BASE=BASE_DATA[1]\n{HERE}");
    let twice = format!("{}\n{used}\n{}\n{used}", given(0.0), given(100.0));
    let mut options = ReadOptions::default();
    let (found, _) = places(&twice, &options);
    let values = [0.0, 100.0].map(|y| Some([1800.0, y, 900.0]));
    assert_eq!([found[0].1, found[1].1], values);
    // What the caller states for the element cannot be both: the program counts, and says so.
    options.frames.insert(
        "BASE_DATA[1]".into(),
        nalgebra::Isometry3::translation(1800.0, 0.0, 900.0),
    );
    let (found, program) = places(&twice, &options);
    assert_eq!([found[0].1, found[1].1], values);
    let findings: Vec<usize> = (program.findings.iter())
        .filter(|finding| finding.message.contains("gets other numbers here"))
        .map(|finding| finding.line)
        .collect();
    assert_eq!(findings, [7]);
    // What is not certain is refused where the other one is used, with what is stated for the element and without it.
    for change in [
        "BASE_DATA[1].Y=100".to_owned(),
        format!("IF $IN[1] THEN\n{}\nENDIF", given(100.0)),
        "MEASURE(BASE_DATA[1])".to_owned(),
    ] {
        for options in [&ReadOptions::default(), &options] {
            let (found, program) = places(&format!("{used}\n{change}\n{used}"), options);
            assert_eq!(found[0].0, "BASE_DATA[1]", "{change}");
            assert!(found[1].1.is_none(), "{change}: {found:?}");
            assert_ne!(found[0].0, found[1].0, "{change}");
            let faults = path_of(&program, &PathOptions::default()).unwrap_err();
            let said = faults.iter().any(|fault| {
                (fault.reason).contains("is not known, and the program has another one")
            });
            assert!(said, "{change}: {faults:?}");
        }
    }
    // In a routine that is called between them.
    let sub = format!(
        "{}\n{used}\nshift()\n{used}\nEND\nDEF shift()\n{}",
        given(0.0),
        given(100.0)
    );
    let (found, _) = places(&sub, &options);
    assert_eq!([found[0].1, found[1].1], values);
    // Parts that are given before the first use are one frame, which the caller may state.
    let parts = format!(
        "BASE_DATA[1].X=1\nBASE_DATA[1].Y=SHIFT\n{used}\n{used}\n$BASE=BASE_DATA[1]\n{HERE}"
    );
    let (found, _) = places(&parts, &options);
    assert!(
        found.iter().all(|one| one.1 == Some([1800.0, 0.0, 900.0])),
        "{found:?}"
    );
}

/// `HOME={AXIS: A1 0, ..}` before `PTP HOME`, as programs of CAM systems begin.
#[test]
fn ends_that_are_assigned_before_are_followed() {
    let home = "{AXIS: A1 5,A2 -90,A3 90,A4 0,A5 45,A6 0}";
    let read = |statements: &str| {
        let source = format!(
            "DEF part()\nDECL AXIS HOME\nDECL FRAME P1\nDECL BOOL ready\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n{statements}\nEND\nDEF sub()\nEND\n"
        );
        read_krl(
            vec![SourceFile::new("part.src", source)],
            &ReadOptions::default(),
        )
    };
    let point = "P1={X 10,Y 20,Z 30,A 10,B 20,C 30}";
    let program = read(&format!("HOME={home}\nPTP HOME\n{point}\nLIN P1\nP1={{X 1,Y 2,Z 3,A 0,B 0,C 0}}\nLIN P1:{{X 0,Y 0,Z 5,A 0,B 0,C 0}}")).unwrap();
    let Target::Joints { values_deg } = &program.motions[0].target else {
        panic!("{:?}", program.motions[0]);
    };
    assert_eq!(values_deg, &[5.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let places = program.motions[1..].iter().map(|motion| {
        let place: [f64; 3] = motion.target.pose().unwrap().position_mm.into();
        place
    });
    let places: Vec<[f64; 3]> = places.collect();
    assert_eq!(places[0], [10.0, 20.0, 30.0]);
    assert_eq!(places[1], [1.0, 2.0, 8.0]);
    for statements in [
        format!("PTP HOME\nHOME={home}"),
        format!("IF ready THEN\nHOME={home}\nENDIF\nPTP HOME"),
        format!("HOME={home}\nLOOP\nPTP HOME\nHOME.A1=HOME.A1+7\nENDLOOP"),
        format!("HOME={home}\nsub(HOME)\nPTP HOME"),
        "P1={X 10}\nLIN P1".to_owned(),
    ] {
        assert!(read(&statements).is_err(), "{statements}");
    }
}

/// `PTP $AXIS_ACT` goes to where the arm is: nowhere.
#[test]
fn motions_to_where_the_arm_is_go_nowhere() {
    let program = main_with(
        "",
        "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\nPTP $AXIS_ACT\nLIN {X 1,Y 2,Z 3,A 10,B 20,C 30}\nPTP $POS_ACT\nLIN {X 5}",
    );
    assert_eq!(program.motions.len(), 2);
    let last = program.motions[1].target.pose().unwrap();
    assert_eq!(<[f64; 3]>::from(last.position_mm), [5.0, 2.0, 3.0]);
    let lines = program
        .findings
        .iter()
        .filter(|finding| finding.message.contains("goes nowhere"));
    assert_eq!(
        lines.map(|finding| finding.line).collect::<Vec<usize>>(),
        [4, 6]
    );
    // Other values of the run are not known.
    let files = vec![SourceFile::new(
        "part.src",
        "DEF part()\nPTP $AXIS_ACT_MEAS\nEND\n",
    )];
    assert!(read_krl(files, &ReadOptions::default()).is_err());
}

/// Members that are given (`P1.X=10`), copies (`P1=P2`), and what other routines or later runs may have left there.
#[test]
fn members_and_copies_that_are_assigned_are_followed() {
    let places = |statements: &str| {
        let files = vec![
            SourceFile::new(
                "part.src",
                format!(
                    "DEF part()\nDECL E6POS own\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n{statements}\nEND\n"
                ),
            ),
            SourceFile::new(
                "part.dat",
                "DEFDAT part\nDECL E6POS P1={X 1,Y 2,Z 3,A 0,B 0,C 0,S 2,T 35}\nDECL E6POS P2={X 4,Y 5,Z 6,A 0,B 0,C 0}\nENDDAT\n",
            ),
        ];
        read_krl(files, &ReadOptions::default()).map(|program| {
            let all = program
                .motions
                .iter()
                .filter_map(|motion| motion.target.pose());
            all.map(|pose| <[f64; 3]>::from(pose.position_mm))
                .collect::<Vec<_>>()
        })
    };
    let six = "own.X=1\nown.Y=2\nown.Z=-3\nown.A=0\nown.B=0\nown.C=180";
    assert_eq!(
        places(&format!("{six}\nLIN own\nown.Z=9\nLIN own")),
        Ok(vec![[1.0, 2.0, -3.0], [1.0, 2.0, 9.0]])
    );
    assert_eq!(
        places("own=P2\nLIN own\nown.X=7\nLIN own"),
        Ok(vec![[4.0, 5.0, 6.0], [7.0, 5.0, 6.0]])
    );
    assert_eq!(
        places("P2.X=8\nLIN P2\nP2.X=9\nLIN P2"),
        Ok(vec![[8.0, 5.0, 6.0], [9.0, 5.0, 6.0]])
    );
    assert_eq!(
        places("own=P2\nown.X=own.Y\nLIN own\nown=own:{X 1,Y 0,Z 0,A 0,B 0,C 0}\nLIN own"),
        Ok(vec![[5.0, 5.0, 6.0], [6.0, 5.0, 6.0]])
    );
    assert_eq!(
        places(
            "P1={X 1,Y 1,Z 1,A 0,B 0,C 0}\nsub()\nP1={X 2,Y 1,Z 1,A 0,B 0,C 0}\nsub()\nEND\nDEF sub()\nLIN P1"
        ),
        Ok(vec![[1.0, 1.0, 1.0], [2.0, 1.0, 1.0]])
    );
    // In a routine that is called behind them, too.
    assert_eq!(
        places("P2={X 1,Y 1,Z 1,A 0,B 0,C 0}\nsub()\nEND\nDEF sub()\nLIN P2"),
        Ok(vec![[1.0, 1.0, 1.0]])
    );
    for statements in [
        "P2={X 1,Y 1,Z 1,A 0,B 0,C 0}\nEND\nDEF late()\nLIN P2",
        // The last run left its 9 in Y.
        "P2.X=8\nLIN P2\nP2.Y=9",
        "P2.X=8\nLIN P2\nP2={X 1,Y 1,Z 1,A 0,B 0,C 0}",
        "own.X=1\nLIN own",
        "own=P2\nown.Q=1\nLIN own",
        "IF $IN[1] THEN\nown=P2\nENDIF\nLIN own",
        "own=P2\nLOOP\nLIN own\nown.X=7\nENDLOOP",
    ] {
        assert!(places(statements).is_err(), "{statements}");
    }
}

/// What a run leaves in a data list is what the next one begins with, element by element.
#[test]
fn elements_that_end_with_another_value_are_refused_where_they_were_used() {
    let data = "DECL FRAME BASE_DATA[4]\nBASE_DATA[1]={X 1,Y 0,Z 0,A 0,B 0,C 0}\nBASE_DATA[2]={X 2,Y 0,Z 0,A 0,B 0,C 0}";
    let read = |statements: &str| {
        let files = vec![
            SourceFile::new(
                "part.src",
                format!("DEF part()\n$TOOL=$NULLFRAME\n{statements}\nEND\n"),
            ),
            SourceFile::new("part.dat", format!("DEFDAT part\n{data}\nENDDAT\n")),
        ];
        read_krl(files, &ReadOptions::default())
    };
    let other = "{X 9,Y 0,Z 0,A 0,B 0,C 0}";
    for statements in [
        format!("$BASE=BASE_DATA[1]\n{HERE}\nBASE_DATA[2]={other}\n$BASE=BASE_DATA[2]\n{HERE}"),
        format!("BASE_DATA[1]={other}\n$BASE=BASE_DATA[1]\n{HERE}\nBASE_DATA[1]=$NULLFRAME"),
        // One of its members, in each run before it is used.
        format!("BASE_DATA[1].Y=7\n$BASE=BASE_DATA[1]\n{HERE}\nBASE_DATA[1].Y=8"),
    ] {
        assert!(read(&statements).is_ok(), "{statements}");
    }
    for change in [
        format!("BASE_DATA[1]={other}"),
        "BASE_DATA[1].X=8".to_owned(),
    ] {
        let statements = format!("BASE_DATA[1].Y=7\n$BASE=BASE_DATA[1]\n{HERE}\n{change}");
        let refused = read(&statements).unwrap_err();
        assert_eq!(refused[0].file, "part.dat", "{refused:?}");
        assert_eq!(refused[0].line, 2, "{refused:?}");
    }
}
