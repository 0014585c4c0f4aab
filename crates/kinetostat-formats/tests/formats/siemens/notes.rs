//! What is remarked of programs: blocks behind the end, steps behind frames.

use super::program;

fn notes(text: &str) -> Vec<(usize, String)> {
    let program = program(text);
    let all = program.findings.into_iter();
    all.map(|finding| (finding.line, finding.message)).collect()
}

const BEGUN: &str = "G90 G17 G71 G54\nT1 D1\nM6\nG0 X0 Y0 Z50\nG1 Z0 F500\nX100\n";
const BEHIND: &str = "what stands from here on does not run: it stays as it is written";

#[test]
fn blocks_behind_the_end_are_named() {
    for end in ["M30", "M17", "M2", "RET"] {
        let found = notes(&format!("{BEGUN}{end}\n\n; nothing\nG1 X120\nX150\n"));
        assert_eq!(found, [(10, BEHIND.to_owned())], "{end}");
        let found = notes(&format!("{BEGUN}{end}\n; nothing\n\n%\n"));
        assert_eq!(found, [], "{end}");
    }
}

#[test]
fn steps_behind_a_frame_name_the_setting() {
    let open = |text: &str| {
        let found = notes(&format!("{BEGUN}{text}M30\n"));
        let named = found.iter().all(|(_, message)| {
            message.contains(
                "SD42440 $SC_FRAME_OFFSET_INCR_PROG. With 1 it goes the step and the offset of the frame: controls come with it as far as is known here, and it is what is taken",
            )
        });
        assert!(named, "{found:?}");
        found.iter().map(|(line, _)| *line).collect::<Vec<_>>()
    };
    assert_eq!(open("TRANS X10\nG91\nX10\nX10\n"), [9]);
    assert_eq!(open("TRANS X10\nX=IC(10)\n"), [8]);
    assert_eq!(open("ATRANS Y10\nG91\nX10\n"), [0; 0]);
    assert_eq!(open("TRANS X10\nX20\nG91\nX10\n"), [0; 0]);
    assert_eq!(open("TRANS\nG91\nX10\n"), [0; 0]);
    // The offset is taken back before the step.
    let found = notes(&format!(
        "{BEGUN}TRANS X10\nG91\nX10\nG90\nATRANS X5\nG91\nX1\nM30\n"
    ));
    assert_eq!(found.len(), 1);
    assert!(found[0].1.ends_with("(lines 9, 13)"), "{found:?}");
}

#[test]
fn a_unit_that_is_not_stated_is_said_to_be_assumed() {
    let assumed = "no G70, G71, G700 or G710 states the unit up to here: it is assumed to be mm";
    let begun = BEGUN.replace(" G71", "");
    let found = notes(&format!("{begun}X120\nM30\n"));
    assert_eq!(found, [(4, assumed.to_owned())]);
    // A place of the machine says nothing of the part's unit, and what is stated behind the first place comes late.
    let found = notes(&format!("G0 SUPA Z0\n{BEGUN}M30\n"));
    assert_eq!(found, []);
    let found = notes(&format!("{begun}G71\nX120\nM30\n"));
    assert_eq!(found, [(4, assumed.to_owned())]);
    for unit in ["G70", "G71", "G700", "G710"] {
        assert_eq!(notes(&BEGUN.replace("G71", unit)), [], "{unit}");
    }
}
