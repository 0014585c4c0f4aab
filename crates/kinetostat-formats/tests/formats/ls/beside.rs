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
    let all = all.filter(|finding| finding.message.contains("is in none of these files"));
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
