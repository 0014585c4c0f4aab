//! Calls of what is in none of the files: they are taken to change nothing, unless the caller says that they move the tool.

use kinetostat_formats::*;

const FRAMES: &str =
    "$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}\n$VEL.CP=0.02";
const ONE: &str = "LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}";
const TWO: &str = "LIN {X 9,Y 2,Z 3,A 0,B 0,C 0}";

fn files(statements: &str) -> Vec<SourceFile> {
    let text = format!("DEF part()\n{statements}\nEND\n");
    vec![SourceFile::new("part.src", text)]
}

fn faults(statements: &str) -> Vec<String> {
    let all = all_faults(Language::Krl, files(statements), &ReadOptions::default());
    all.iter().map(ToString::to_string).collect()
}

/// They are taken to move nothing and to leave in force what is: the motion behind begins where the one before ended.
#[test]
fn calls_are_taken_to_change_nothing_and_named_once() {
    let text = format!(
        "{FRAMES}\n{ONE}\nspindle_on()\n{TWO}\nLIN_REL {{X 5}}\nFOR i=1 TO 3\nspindle_on()\nENDFOR\nLIN {{X 120}}"
    );
    assert_eq!(faults(&text), Vec::<String>::new());
    let program = read_krl(files(&text), &ReadOptions::default()).unwrap();
    let follows: Vec<Option<usize>> = program.motions.iter().map(|m| m.follows).collect();
    assert_eq!(follows, [None, Some(0), Some(1), Some(2)]);
    let last = &program.motions[3];
    assert_eq!(last.speed.mm_per_s, Some(20.0));
    assert!(last.tool.known().is_some() && last.work_object.known().is_some());
    let end = last.target.pose().unwrap().position_mm;
    assert_eq!((end.x, end.y), (120.0, 2.0));
    let notes: Vec<(usize, &str)> = (program.findings.iter())
        .map(|finding| (finding.line, finding.message.as_str()))
        .collect();
    let note = "`spindle_on` is in none of the files: taken not to move the tool and not to change speed, tool or frame, or how motions behind it go (`$ORI_TYPE`, `$CIRC_TYPE`, `$ACC`, `$APO`); state it under [calls] if it moves, or give its file (lines 6, 10)";
    assert_eq!(notes, [(6, note)]);
    assert_eq!(program.calls_taken_to_stay(), [("spindle_on", 6)]);
}

/// The caller says that it moves the tool: every call of it is a fault.
#[test]
fn calls_that_are_stated_to_move_the_tool_are_refused_by_line() {
    let text = format!("{FRAMES}\n{ONE}\nSpindle_On()\n{TWO}\nspindle_on()\nother()");
    let mut options = ReadOptions::default();
    options.moving_calls = ["SPINDLE_ON", "nowhere"].map(str::to_owned).into();
    let found = read_krl(files(&text), &options).unwrap_err();
    let found: Vec<(usize, &str)> = (found.iter())
        .map(|fault| (fault.line, fault.reason.as_str()))
        .collect();
    let reason = "`SPINDLE_ON` moves the tool, as is stated, and none of the files says where to";
    assert_eq!(found, [(6, reason), (8, reason)]);
    options.moving_calls = ["nowhere".to_owned()].into();
    let program = read_krl(files(&text), &options).unwrap();
    let unused = "`nowhere`, of which is stated that it moves the tool, is called nowhere, or its file is given: that changes nothing";
    assert!(program.findings.iter().any(|note| note.message == unused));
}

/// What an interrupt or a trigger calls runs at any time: what it sets would hold for some of the motions.
#[test]
fn what_interrupts_set_is_refused_and_what_they_call_outside_is_named() {
    let of = |call: &str, body: &str| {
        format!("{FRAMES}\n{call} DO mark()\n{ONE}\n{TWO}\nEND\nDEF mark()\n{body}")
    };
    let calls = [
        "INTERRUPT DECL 4 WHEN $IN[1]==TRUE",
        "TRIGGER WHEN DISTANCE=0 DELAY=0",
    ];
    for call in calls {
        for body in [
            "$BASE=$NULLFRAME",
            "$TOOL=$NULLFRAME\n$VEL.CP=0.1",
            "BAS(#VEL_CP,0.1)",
        ] {
            let found = faults(&of(call, body));
            assert_eq!(found.len(), 1, "{call} {body}: {found:#?}");
            let says = "at any time, or sets what the motions behind it go by";
            assert!(
                found[0].starts_with("part.src, line 5: ") && found[0].contains(says),
                "{found:#?}"
            );
        }
        assert_eq!(faults(&of(call, "$OUT[3]=TRUE")), Vec::<String>::new());
        let statements = format!("{FRAMES}\n{call} DO elsewhere()\n{ONE}\n{TWO}");
        let program = read_krl(files(&statements), &ReadOptions::default()).unwrap();
        assert_eq!(program.findings.len(), 1, "{:#?}", program.findings);
        let note = &program.findings[0];
        assert_eq!(note.line, 5);
        assert_eq!(
            note.message,
            "`elsewhere` is in none of the files: taken not to move the tool and not to change speed, tool or frame, or how motions behind it go (`$ORI_TYPE`, `$CIRC_TYPE`, `$ACC`, `$APO`); state it under [calls] if it moves, or give its file"
        );
        // Frames and speed are those of before.
        let last = &program.motions[1];
        assert_eq!(last.speed.mm_per_s, Some(20.0));
        assert!(last.tool.known().is_some());
    }
    let own = "GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM ( )";
    let program = read_krl(files(&format!("{own}\n{ONE}")), &ReadOptions::default()).unwrap();
    assert!(
        program
            .findings
            .iter()
            .all(|note| !note.message.contains("IR_STOPM")),
        "{:#?}",
        program.findings
    );
}
