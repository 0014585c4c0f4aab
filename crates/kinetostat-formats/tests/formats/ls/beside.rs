//! Programs that run beside the motions.

use kinetostat_formats::*;

use super::{read_with, with_lines};

const BESIDE: [&str; 8] = [
    "  ERROR_PROG=RECOVER ;",
    "  RESUME_PROG[1]=BACK_ON ;",
    "  MONITOR WATCHER ;",
    "L P[1] 100mm/sec FINE TB .10sec,CALL SPRAY ;",
    "L P[2] 100mm/sec FINE TA .10sec,CALL SPRAY2(1) ;",
    "L P[3] 100mm/sec CNT50 DB 10.0mm,CALL SPRAY3 ;",
    "L P[4] 100mm/sec FINE DB 10.0mm,DO[1]=ON ;",
    "  MONITOR END WATCHER ;",
];

fn named(program: &RobotProgram) -> Vec<String> {
    let all = program.findings.iter();
    let all = all.filter(|finding| finding.message.contains("is in none of the files"));
    all.map(|finding| {
        let name = finding.message.split('`').nth(1).unwrap_or_default();
        format!("{} {name}", finding.line)
    })
    .collect()
}

#[test]
fn programs_beside_the_motions_are_named() {
    let text = with_lines(&BESIDE);
    let program = read_with(text.as_bytes(), &ReadOptions::default()).unwrap();
    // The first instruction stands on the fifth line.
    assert_eq!(
        named(&program),
        [
            "5 RECOVER",
            "6 BACK_ON",
            "7 WATCHER",
            "8 SPRAY",
            "9 SPRAY2",
            "10 SPRAY3"
        ]
    );
    // Those that are given are not.
    let other = with_lines(&["  DO[1]=ON ;"]).replace("/PROG  PART", "/PROG  SPRAY");
    let files = vec![
        SourceFile::new("part.ls", text),
        SourceFile::new("spray.ls", other),
    ];
    let program = read_ls(files, &ReadOptions::default()).unwrap();
    assert_eq!(named(&program).len(), 5, "{:?}", named(&program));
    assert!(!named(&program).contains(&"8 SPRAY".to_owned()));
    // A condition handler.
    let text = with_lines(&["  WHEN DI[1]=ON,CALL HANDLER ;", "L P[1] 100mm/sec FINE ;"]);
    let program = read_with(text.as_bytes(), &ReadOptions::default()).unwrap();
    assert_eq!(named(&program), ["5 HANDLER"]);
}

/// What is in none of the files is taken not to move the tool; what a register names may be any program.
#[test]
fn calls_of_what_is_nowhere_keep_the_place_and_frames() {
    let lines = |call: &str| {
        with_lines(&[
            "  UFRAME_NUM=2 ;",
            "  UTOOL_NUM=1 ;",
            "L P[1] 20mm/sec FINE ;",
            call,
            "L P[2] 20mm/sec FINE ;",
        ])
    };
    let read = |call: &str, options: &ReadOptions| read_with(lines(call).as_bytes(), options);
    let mut options = ReadOptions::default();
    for (call, follows) in [
        ("  CALL SPINDLE_ON(12000) ;", Some(0)),
        ("  IF DI[1]=ON,CALL SPINDLE_ON ;", Some(0)),
        ("  CALL SR[1] ;", None),
    ] {
        let program = read(call, &options).unwrap();
        assert_eq!(program.motions[1].follows, follows, "{call}");
    }
    let program = read("  CALL SPINDLE_ON ;", &options).unwrap();
    let note = "`SPINDLE_ON` is in none of the files: taken not to move the tool and not to change speed, tool or frame; state it under [calls] if it moves, or give its file";
    assert!(program.findings.iter().any(|said| said.message == note));
    options.moving_calls = ["Spindle_On".to_owned()].into();
    for call in [
        "  CALL SPINDLE_ON ;",
        "  MONITOR SPINDLE_ON ;",
        "L P[3] 20mm/sec FINE TB .10sec,CALL SPINDLE_ON ;",
    ] {
        let errors = read(call, &options).unwrap_err();
        assert_eq!((errors.len(), errors[0].line), (1, 8), "{errors:?}");
    }
}

/// What a motion starts at its end, over several lines, as arc welding has it under both of its names.
#[test]
fn welds_start_and_end_with_motions() {
    for [start, end] in [
        ["Arc Start[1]", "Arc End[1]"],
        ["Weld Start[1,20]", "Weld End[1,20]"],
    ] {
        let text = with_lines(&[
            &format!("L P[1] 200mm/sec FINE\n    :  {start}    ;"),
            "  Weave Circle[0.8Hz,4.0mm,0.0s,0.0s] ;",
            &format!("L P[2] WELD_SPEED FINE\n    :  {end}    ;"),
            "L P[3] 200mm/sec FINE ;",
            &format!("  {end} ;"),
        ]);
        let program = read_with(text.as_bytes(), &ReadOptions::default()).unwrap();
        assert_eq!(program.motions.len(), 3, "{start}");
    }
}
