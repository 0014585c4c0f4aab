//! PTC Creo's files, and text for the controller.

use kinetostat_formats::*;

const TEXT: &str = "$$*         Pro/CLfile  Version 8.0 - F000\n$$-> MFGNO / MFG0001\nPARTNO / MFG0001\nMACHIN / UNCX01, 1\nUNITS / MM\n\
    $$-> CSYS / 1.0, 0.0, 0.0, 0.0, $\n         0.0, 1.0, 0.0, 0.0, $\n         0.0, 0.0, 1.0, 0.0\nINSERT / G0 X500\n\
    GOTO / 1, 2, 3\nINSERT / M8\nGOTO / 4, 2, 3\n";

#[test]
fn comments_go_on_where_a_sign_ends_their_lines() {
    let program = super::program(TEXT);
    assert_eq!(super::place(&program, 0), [1.0, 2.0, 3.0]);
    assert_eq!(super::place(&program, 1), [4.0, 2.0, 3.0]);
    assert_eq!(program.motions.len(), 2);
    let written = write(&program, &[], &WriteOptions::default()).unwrap();
    assert_eq!(written[0].1, TEXT.as_bytes());
    // The file ends in such a comment.
    let open = format!("{TEXT}$$-> CSYS / 1.0, $");
    assert_eq!(super::program(&open).motions.len(), 2);
}

#[test]
fn text_for_the_controller_is_named() {
    let program = super::program(TEXT);
    let raw: Vec<&Finding> = (program.findings.iter())
        .filter(|finding| finding.message.starts_with("INSERT"))
        .collect();
    assert_eq!(raw.len(), 1, "{raw:?}");
    assert_eq!(raw[0].line, 9);
    assert!(raw[0].message.ends_with("(lines 9, 11)"), "{raw:?}");
}

#[test]
fn arcs_are_refused_with_what_creo_can_do() {
    let text = format!("{TEXT}CIRCLE / 4, 3, 3, 0, 0, 1, 1\nGOTO / 5, 3, 3\n");
    let faults = super::read_with(text.as_bytes(), &ReadOptions::default()).unwrap_err();
    let fault = faults[0].to_string();
    assert!(
        fault.contains("line 13") && fault.contains("POINTS_ONLY"),
        "{fault}"
    );
}
