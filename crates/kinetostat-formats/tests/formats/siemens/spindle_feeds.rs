//! Feeds by turns of the spindle (G95), axes whose way F counts (FGROUP), and blocks behind a slash.

use kinetostat_formats::*;

use super::{program, read_with};

const HEAD: &str = "G90 G71 G17 G54\nT1 D1\n";

fn speeds(text: &str) -> Vec<Option<f64>> {
    let program = program(&format!("{HEAD}{text}"));
    let motions = program.motions.iter();
    motions.map(|motion| motion.speed.mm_per_s).collect()
}

#[test]
fn a_feed_by_turns_is_known_while_the_spindle_turns() {
    let found = speeds(
        "S1000 M3\nG0 X0 Y0 Z10\nG95 G1 X40 F0.15\nG97 S200\nX90\nG94 X100 F300\nG95 F0.2 X10\nG96 S120\nX20\nG97\nX30\nS400\nX40\nM5\nX50\nM30\n",
    );
    // mm in a turn times turns in a second; of a cutting speed, behind it without S, and with the spindle off it is not known.
    let expected = [
        None,
        Some(0.15 * 1000.0 / 60.0),
        Some(0.15 * 200.0 / 60.0),
        Some(5.0),
        Some(0.2 * 200.0 / 60.0),
        None,
        None,
        Some(0.2 * 400.0 / 60.0),
        None,
    ];
    assert_eq!(found.len(), expected.len());
    for (index, (found, expected)) in found.iter().zip(expected).enumerate() {
        let same = match (found, expected) {
            (Some(a), Some(b)) => (a - b).abs() < 1e-12,
            (a, b) => a.is_none() && b.is_none(),
        };
        assert!(same, "{index}: {found:?} {expected:?}");
    }
    // A dwell by turns and a limit are no speed.
    let found = speeds("S600 M4\nG0 X0 Y0 Z1\nG4 S5\nG26 S9000\nG95 G1 X1 F0.1\nM30\n");
    assert!((found[1].unwrap() - 1.0).abs() < 1e-12);
}

#[test]
fn a_feed_by_turns_is_made_and_divided() {
    let text = format!("{HEAD}S1000 M3\nG0 X0 Y0 Z10\nG95 G1 X40 F0.1\nX80\nM30\n");
    let made = crate::making::of_robot(Language::Siemens, &text, MakeLanguage::Krl);
    let text_of_krl = crate::making::text_of(&made, 0);
    // 100 mm/min.
    assert!(
        text_of_krl.contains("$VEL.CP=0.001666666667\n"),
        "{text_of_krl}"
    );
    let program = program(&text);
    let mut piece = Piece::to(1, nalgebra::Vector3::new(40.0, 0.5, 10.0));
    piece.speed_factor = 1.01;
    let written = super::written(&program, &[piece]);
    // The feed of before is stated again, with its digits.
    assert!(
        written.contains("G95 G1 X40 Y0.500 F0.101\nX80 Y0.000 F0.1\n"),
        "{written}"
    );
}

#[test]
fn the_axes_whose_way_f_counts_are_followed_where_they_are_those_of_the_tip() {
    for word in ["FGROUP(X,Y,Z)", "FGROUP()", "FGROUP(Z,X,Y)", "FGREF[A]=10"] {
        let program = program(&format!("{HEAD}{word}\nG0 X0 Y0 Z0\nG1 X5 F100\nM30\n"));
        let said = program
            .findings
            .iter()
            .any(|one| one.message.contains("FGROUP"));
        assert!(program.motions.len() == 2 && !said, "{word}");
    }
    for (word, axes) in [("FGROUP(X,Y)", "X, Y"), ("FGROUP(X,Y,Z,A)", "X, Y, Z, A")] {
        let program = program(&format!("{HEAD}{word}\nG0 X0 Y0 Z0\nG1 X5 F100\nM30\n"));
        let mut said = program.findings.iter();
        let wanted = format!("F counts the way of the axes {axes} here");
        assert!(
            said.any(|one| one.line == 3 && one.message.contains(&wanted)),
            "{word}"
        );
    }
    // It is no subprogram, either.
    let text = format!("{HEAD}FGROUP(X,Y,Z)\nFOR R1=1 TO 2\nX=R1\nENDFOR\n");
    let flat = expand_siemens(&[SourceFile::new("a.mpf", text)]).unwrap();
    let flat = String::from_utf8(flat.file.bytes().to_vec()).unwrap();
    assert!(flat.contains("FGROUP(X,Y,Z)\nX=1\nX=2\n"), "{flat}");
}

#[test]
fn blocks_behind_a_slash_run_or_not_as_is_said() {
    let text =
        format!("{HEAD}G0 X0 Y0 Z0\n/N50 G1 X8 F100\n/2 R1=7\n/9 N60 G1 X9\nG1 X10 F50\nM30\n");
    let mut options = ReadOptions::default();
    let refused = read_with(text.as_bytes(), &options).unwrap_err();
    assert!(
        refused[0]
            .to_string()
            .contains("--block-delete run or skip"),
        "{}",
        refused[0]
    );
    let ends = |options: &ReadOptions, text: &str| -> Vec<f64> {
        let program = read_with(text.as_bytes(), options).unwrap();
        let said = program
            .findings
            .iter()
            .filter(|one| one.message.contains("behind a slash"));
        assert_eq!(said.map(|one| one.line).collect::<Vec<_>>(), [4]);
        let places = program
            .motions
            .iter()
            .map(|one| one.target.pose().unwrap().position_mm.x);
        places.collect()
    };
    options.slash_blocks = SlashBlocks::Run;
    assert_eq!(ends(&options, &text), [0.0, 8.0, 9.0, 10.0]);
    options.slash_blocks = SlashBlocks::Skipped;
    assert_eq!(ends(&options, &text), [0.0, 10.0]);
    // A flat program holds them as they stand, and they do nothing in it.
    let looped = text.replace("G1 X10", "FOR R2=1 TO 2\nG1 X=10*R2\nENDFOR\nG1 X10");
    let files = || vec![SourceFile::new("a.mpf", looped.as_str())];
    let flat = expand(Language::Siemens, files(), &options)
        .unwrap()
        .unwrap();
    let flat = String::from_utf8(flat.file.bytes().to_vec()).unwrap();
    assert!(
        flat.contains("\n/N50 G1 X8 F100\n/2 R1=7\n/9 N60 G1 X9\nG1 X=10\nG1 X=20\n"),
        "{flat}"
    );
    assert_eq!(ends(&options, &flat), [0.0, 10.0, 20.0, 10.0]);
    options.slash_blocks = SlashBlocks::Run;
    let flat = expand(Language::Siemens, files(), &options)
        .unwrap()
        .unwrap();
    let flat = String::from_utf8(flat.file.bytes().to_vec()).unwrap();
    assert_eq!(ends(&options, &flat), [0.0, 8.0, 9.0, 10.0, 20.0, 10.0]);
    // Without a word about the switch an assignment does not run, either.
    options.slash_blocks = SlashBlocks::Refused;
    let faults = expand(Language::Siemens, files(), &options).unwrap_err();
    let lines: Vec<usize> = faults.iter().map(|fault| fault.line).collect();
    assert!(lines.contains(&5), "{faults:?}");
}
