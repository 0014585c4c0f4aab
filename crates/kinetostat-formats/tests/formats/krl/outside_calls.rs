//! Calls of what is in none of the files: what they may have set, before motions that need it.

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

fn said(line: usize, name: &str, sets: &str, needs: usize) -> String {
    format!(
        "part.src, line {line}: `{name}()`: `{name}` is in none of these files, and may set {sets}, which line {needs} needs; give its file as well, or state them again behind the call"
    )
}

/// All calls in one run, each once, with what stands beside them.
#[test]
fn calls_before_motions_are_refused_where_they_stand() {
    let found = faults(&format!(
        "{FRAMES}\n{ONE}\nspindle_on()\n{TWO}\nNOT A STATEMENT\nLIN {{X 120}}\ncool_on()\n{ONE}\n{TWO}"
    ));
    let all = "$BASE, $TOOL, $VEL";
    assert_eq!(found.len(), 3, "{found:#?}");
    assert_eq!(found[0], said(6, "spindle_on", all, 7));
    assert!(found[1].starts_with("part.src, line 8: `NOT A STATEMENT`"));
    assert_eq!(found[2], said(10, "cool_on", all, 11));
    // Two calls before one motion.
    let found = faults(&format!("{FRAMES}\n{ONE}\none()\ntwo()\n{TWO}"));
    assert_eq!(found, [said(6, "one", all, 8), said(7, "two", all, 8)]);
    // What is stated again is not lost.
    let found = faults(&format!("{FRAMES}\n{ONE}\none()\n$VEL.CP=0.1\n{TWO}"));
    assert_eq!(found, [said(6, "one", "$BASE, $TOOL", 8)]);
    // A routine that the call stands in, and one that is called behind it.
    let in_routine = format!("{FRAMES}\n{ONE}\nsub()\n{TWO}\nEND\nDEF sub()\none()");
    assert_eq!(faults(&in_routine), [said(10, "one", all, 7)]);
    let behind = format!("{FRAMES}\n{ONE}\none()\nsub()\nEND\nDEF sub()\ntwo()\n{TWO}");
    assert_eq!(
        faults(&behind),
        [said(6, "one", all, 11), said(10, "two", all, 11)]
    );
}

#[test]
fn what_is_stated_again_makes_a_note_of_the_call() {
    for again in [
        FRAMES,
        "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n$VEL={CP 0.1,ORI1 100,ORI2 100}",
    ] {
        let statements = format!("{FRAMES}\n{ONE}\nspindle_on()\n{again}\n{TWO}");
        assert_eq!(faults(&statements), Vec::<String>::new());
        let program = read_krl(files(&statements), &ReadOptions::default()).unwrap();
        let notes: Vec<(usize, &str)> = (program.findings.iter())
            .map(|finding| (finding.line, finding.message.as_str()))
            .collect();
        let note = "`spindle_on` is in none of these files: it is carried, and if it moves the tool, or states how motions behind it go (`$ORI_TYPE`, `$CIRC_TYPE`, `$ACC`, `$APO`), that is not seen";
        assert_eq!(notes, [(6, note)]);
    }
    // The caller states them; or all places are behind the call, in one base that nobody needs to know.
    let mut options = ReadOptions::default();
    for name in ["$BASE", "$TOOL"] {
        let frame = nalgebra::Isometry3::identity();
        options.frames.insert(name.to_owned(), frame);
    }
    let statements = format!("{FRAMES}\n{ONE}\nspindle_on()\n{TWO}");
    assert!(all_faults(Language::Krl, files(&statements), &options).is_empty());
    let statements = format!("{FRAMES}\nspindle_on()\n{ONE}\n{TWO}");
    assert_eq!(faults(&statements), Vec::<String>::new());
}

/// The end of a step, where the call may have moved the tool; and the speed, which only another language needs.
#[test]
fn reasons_name_the_call() {
    let found = faults(&format!(
        "{FRAMES}\n{ONE}\nspindle_on()\n{FRAMES}\nLIN_REL {{X 5}}"
    ));
    assert_eq!(found.len(), 1, "{found:#?}");
    assert!(
        found[0].starts_with("part.src, line 10: ")
            && found[0].contains(
                "`spindle_on`, which line 6 calls and none of these files holds, may move it"
            ),
        "{found:#?}"
    );
    let statements =
        format!("{FRAMES}\nspindle_on()\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n{ONE}\n{TWO}");
    let program = read_krl(files(&statements), &ReadOptions::default()).unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let made = make_of_robot(&program, &robot, &Template::default(), MakeLanguage::Rapid);
    let found: Vec<String> = made.unwrap_err().iter().map(ToString::to_string).collect();
    assert_eq!(found.len(), 2, "{found:#?}");
    for (fault, line) in found.iter().zip([8, 9]) {
        let says = format!(
            "line {line}: the speed of this motion is not known: `spindle_on`, which line 5 calls, is in none of these files"
        );
        assert!(fault.starts_with(&says), "{fault}");
    }
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
        for (body, sets) in [
            ("$BASE=$NULLFRAME", "$BASE"),
            ("$TOOL=$NULLFRAME\n$VEL.CP=0.1", "$TOOL, $VEL"),
            ("BAS(#VEL_CP,0.1)", "$BASE, $TOOL, $VEL, $APO"),
        ] {
            let found = faults(&of(call, body));
            assert_eq!(found.len(), 1, "{call} {body}: {found:#?}");
            let says = format!("`mark` sets {sets} at any time");
            assert!(
                found[0].starts_with("part.src, line 5: ") && found[0].contains(&says),
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
            "`elsewhere` is in none of these files: it is carried, and if it moves the tool, or states how motions behind it go (`$ORI_TYPE`, `$CIRC_TYPE`, `$ACC`, `$APO`), that is not seen"
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
