//! Words of Fanuc's dialect: G65, vacant parameters, fine boring, repeats by K, levels of a row of cycles.

use kinetostat_program::{
    Dialect, ExpandOptions, NoSubprograms, OriginComments, ProgramError, expand,
};

use super::flat;

pub(super) const BEGIN: &str = "G21 G90 G17 F200\nG0 X0 Y0 Z15\n";

pub(super) fn run(text: &str, dialect: Dialect) -> Result<String, ProgramError> {
    let mut options = ExpandOptions::default();
    options.dialect = dialect;
    let flat = expand(format!("{BEGIN}{text}"), &options, &NoSubprograms)?;
    let bytes = String::from_utf8(flat.program.bytes().to_vec()).unwrap();
    Ok(bytes.strip_prefix(BEGIN).unwrap().to_owned())
}

pub(super) fn fanuc(text: &str) -> String {
    run(text, Dialect::Fanuc).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[test]
fn g65_gives_letters_as_numbers_to_a_subprogram() {
    let letters = "A1 B2 C3 D7 E8 F9 H11 I4 J5 K6 M13 Q17 R18 S19 T20 U21 V22 W23 X24 Y25 Z26";
    let sums = "O9\n#100=[#1+#2+#3+#4+#5+#6+#7+#8+#9+#11+#13+#17+#18+#19+#20+#21+#22+#23+#24+#25+#26]\nG0 X#100 Y#24 Z#7\nM99\n";
    // Each letter has its number as its value.
    let sum = 1 + 2 + 3 + 4 + 5 + 6 + 7 + 8 + 9 + 11 + 13 + (17..=26).sum::<i32>();
    let made = fanuc(&format!("G65 P9 {letters}\nM30\n{sums}"));
    assert_eq!(made, format!("G0 X{sum} Y24 Z7\nM30\n"));
    // It has values of its own; repeats begin with the arguments.
    let text = "#1=5\nG65 P9 L2 A1\nG0 X#1\nM30\nO9\nG0 Y#1\n#1=[#1+1]\n#33=4\nM99\n";
    for dialect in [Dialect::Fanuc, Dialect::Undecided] {
        assert_eq!(run(text, dialect).unwrap(), "G0 Y1\nG0 Y1\nG0 X5\nM30\n");
    }
    assert_eq!(fanuc("G67\nG65 P9\nM30\nO9\nG0 X1\nM99\n"), "G0 X1\nM30\n");
    assert_eq!(
        fanuc("M98 P9\nG0 X2\nN7 G0 X3\nM30\nO9\nM99 P7\n"),
        "N7 G0 X3\nM30\n"
    );
}

#[test]
fn vacant_parameters_are_left_out() {
    let text = "G65 P9 X1\nM30\nO9\nG0 X#24 Y#25\nIF [#25 EQ #0] THEN #25=3\nG0 Y#25\n#25=#0\nIF [#25 NE #0] GOTO 5\nG0 Z1\nN5 G0 X[#25+9]\nM99\n";
    assert_eq!(fanuc(text), "G0 X1\nG0 Y3\nG0 Z1\nN5 G0 X9\nM30\n");
    // In the order of the line; FIX and FUP by the size of the number.
    assert_eq!(
        fanuc("#1=2 #2=[#1+1]\nG0 X#2 Y[FIX[-2.5]] Z[FUP[-2.5]]\n"),
        "G0 X3 Y-2 Z-3\n"
    );
    let linuxcnc = run("#1=2 #2=[#1+1]\nG0 X#2 Y[FIX[-2.5]]\n", Dialect::LinuxCnc).unwrap();
    assert_eq!(linuxcnc, "G0 X1 Y-3\n");
}

#[test]
fn what_is_assigned_needs_no_brackets() {
    // 2 + 3 * 4 - 1, by the usual precedence; then each block with what was assigned before.
    let text =
        "#1=2+3*4-1\n#2=-#1\n#3=#1-#2/2\nG0 X#1 Y#2 Z#3\nIF [#1 GT 0] THEN #1=#1+1\nG0 X#1\n";
    assert_eq!(fanuc(text), "G0 X13 Y-13 Z19.5\nG0 X14\n");
    assert_eq!(fanuc("#1=1 M8 #2=#1+1\nG0 X#2\n"), "M8\nG0 X2\n");
}

#[test]
fn fine_boring_and_repeats_of_cycles() {
    let made = fanuc("M3 S100\nG76 X5 Y5 Z-10 R2 I0.5 P1\nG80\n");
    assert_eq!(
        made,
        "M3 S100\nG0 X5 Y5\nG0 Z2\nG1 Z-10\nG4 P1\nM5\nM19\nG0 X5.5\nG0 Z15\nG0 X5\nM3\nG80\n"
    );
    // K0 keeps the words; with G91 the levels stay where they were.
    let made = fanuc("G99 G81 X1 Z-3 R1 K0\nG91 X2 K2\n");
    assert_eq!(
        made,
        "G99\nG91\nG0 X2\nG0 Z-14\nG1 Z-4\nG0 Z4\nG0 X2\nG1 Z-4\nG0 Z4\n"
    );
    // LinuxCNC reads the numbers anew: R 1 above the start, 3 deep from there.
    let made = run("G99 G81 X1 Z-3 R1\nG91 X2\n", Dialect::LinuxCnc).unwrap();
    assert_eq!(
        made,
        "G99\nG0 X1\nG0 Z1\nG1 Z-3\nG0 Z1\nG91\nG0 Z15\nG0 X2\nG1 Z-3\nG0 Z3\n"
    );
}

#[test]
fn what_dialects_disagree_on_is_refused_with_both_readings() {
    let row = "G99 G81 X1 Z-3 R1\nG91 X2\n";
    for (text, dialect, needles) in [
        (
            "G98 M3\nG76 X1 Z-1 R1 Q1\n",
            Dialect::Undecided,
            ["thread", "boring"],
        ),
        (
            "G76 X1 Z-1 R1 I1\n",
            Dialect::LinuxCnc,
            ["thread", "spindle"],
        ),
        (
            "G81 X1 Z-1 R1\n",
            Dialect::Undecided,
            ["LinuxCNC begins with G99", "Fanuc with G98"],
        ),
        (row, Dialect::Undecided, ["Fanuc keeps", "LinuxCNC reads"]),
        (
            "G92 X0\nG52 X1\n",
            Dialect::Undecided,
            ["takes its place", "Fanuc adds"],
        ),
        ("G65 P9\n", Dialect::LinuxCnc, ["LinuxCNC has no G65", ""]),
        ("G65 P9\n", Dialect::Undecided, ["no subprogram O9", ""]),
        ("G65 A1\n", Dialect::Fanuc, ["calls no subprogram", ""]),
        ("G65 P9 I1 I2\n", Dialect::Fanuc, ["comes twice", "II"]),
        ("G66 P9\n", Dialect::Fanuc, ["G66", "every move"]),
        (
            "IF [#1 EQ #0] GOTO 1\n",
            Dialect::LinuxCnc,
            ["#0 is no parameter", ""],
        ),
    ] {
        let error = run(text, dialect).unwrap_err();
        for needle in needles {
            assert!(error.reason.contains(needle), "{text}: {error}");
        }
    }
}

/// A controller that is sent a program takes its number from its first line, and waits for the closing tape mark.
#[test]
fn number_and_tape_marks_of_the_program_stay() {
    let text = "%\nO0001 (PART)\nG21 G90\nG0 X0 Y0 Z0\nM98 P2\nM30\nO0002\nG1 X5 F100\nM99\n%\n";
    let expected = "%\nO0001 (PART)\nG21 G90\nG0 X0 Y0 Z0\nG1 X5 F100\nM30\n%\n";
    let mut options = ExpandOptions::default();
    options.dialect = Dialect::Fanuc;
    let expanded = expand(text, &options, &NoSubprograms).unwrap();
    assert_eq!(String::from_utf8_lossy(expanded.program.bytes()), expected);
    let lines: Vec<usize> = expanded.origins.iter().map(|origin| origin.line).collect();
    assert_eq!(lines, [1, 2, 3, 4, 8, 6, 10]);
    // The number is carried once, and what is not there is not added.
    let text = "O5\nG21 G90\nG0 X0 Y0 Z0\nM30\n";
    assert_eq!(flat(text), text);
    for text in [
        "%\nG21 G90\nG0 X0 Y0 Z0\nM30\n",
        "G21 G90\nG0 X0 Y0 Z0\nM30\n%\n",
    ] {
        assert_eq!(flat(text), text);
    }
    // The number is no block with a line behind it: what stands there is the program's name.
    options.origin_comments = OriginComments::Written;
    let expanded = expand("O5 (NAME)\nG21 G90\nM30\n", &options, &NoSubprograms).unwrap();
    assert_eq!(
        String::from_utf8_lossy(expanded.program.bytes()),
        "O5 (NAME)\nG21 G90 (line 2)\nM30 (line 3)\n"
    );
}

/// Numbers of blocks are sought in the program that jumps, not in another one of its file.
#[test]
fn jumps_stay_in_their_program() {
    let other = "M30\nO400\nG0 X1\nN10 G0 X99\nM99\n";
    for dialect in [Dialect::Fanuc, Dialect::Undecided] {
        for (text, line) in [
            (format!("GOTO 10\nG0 X5\n{other}"), 3),
            (format!("M98 P400\n{}", other.replace("M99", "M99 P10")), 8),
        ] {
            let error = run(&text, dialect).unwrap_err();
            assert!(
                error.reason.contains("no block N10 in this program"),
                "{error}"
            );
            assert!(line == 8 || error.line == line, "{error}");
        }
        // Each in its own; the number of the program itself begins it.
        let own = format!("G0 X5\nGOTO 10\nG0 X6\nN10 G0 X7\n{other}");
        assert_eq!(run(&own, dialect).unwrap(), "G0 X5\nN10 G0 X7\nM30\n");
        let back = format!(
            "M98 P400\nG0 X6\nN10 G0 X7\n{}",
            other.replace("M99", "M99 P10")
        );
        assert!(
            run(&back, dialect)
                .unwrap()
                .ends_with("N10 G0 X99\nN10 G0 X7\nM30\n")
        );
        let numbered = "O1\nG21 G90\nG0 X0 Y0 Z0\nGOTO 10\nG0 X5\nN10 G0 X7\nM30\nO2\nN10 M99\n";
        let mut options = ExpandOptions::default();
        options.dialect = dialect;
        let flat = expand(numbered, &options, &NoSubprograms).unwrap();
        assert!(flat.program.bytes().ends_with(b"Z0\nN10 G0 X7\nM30\n"));
    }
}

/// Where a contour begins in another direction than the way to it, Fanuc leads the tool in otherwise.
#[test]
fn the_way_to_a_contour_is_that_of_the_controller_or_refused() {
    let cut = |contour: &str, dialect| {
        let mut options = ExpandOptions::default();
        options.dialect = dialect;
        options.tool_diameters_mm.insert(1, 6.0);
        let text = format!("{BEGIN}G41 D1 G1 X10. Y0. F100.\n{contour}G40 X40. Y0.\nM30\n");
        expand(text, &options, &NoSubprograms)
    };
    let square = "Y20.\nX30.\n";
    assert!(cut(square, Dialect::LinuxCnc).unwrap().warnings.is_empty());
    let warned = cut(square, Dialect::Undecided).unwrap().warnings;
    assert!(
        warned
            .iter()
            .any(|warning| warning.text.contains("way to a contour")),
        "{warned:?}"
    );
    let error = cut(square, Dialect::Fanuc).unwrap_err();
    assert!(error.reason.contains("another direction"), "{error}");
    // Straight on, or along an arc that begins so: both are beside the same place.
    for contour in [
        "X20.\nY20.\nX30.\n",
        "G3 X20. Y10. I0. J10.\nG1 Y20.\nX30.\n",
    ] {
        let fanuc = cut(contour, Dialect::Fanuc).unwrap();
        assert!(
            fanuc
                .warnings
                .iter()
                .all(|warning| !warning.text.contains("way to a contour"))
        );
        let linuxcnc = cut(contour, Dialect::LinuxCnc).unwrap();
        assert_eq!(fanuc.program.bytes(), linuxcnc.program.bytes());
    }
}

/// The modes hold before the shift, in which G15 ends polar coordinates.
#[test]
fn modes_beside_g52_and_both_distance_modes_beside_g28() {
    for dialect in [Dialect::Fanuc, Dialect::Undecided] {
        let made = run("G15 G52 X0 Y0\nG90 G52 X5.\nG1 X0.\n", dialect).unwrap();
        assert_eq!(made, "G15\nG90\nG1 X5\n");
        assert!(run("G52 X0 M8 G91\n", dialect).is_err());
    }
    let made = run("G90 G52 X5\nG1 X0\n", Dialect::LinuxCnc).unwrap();
    assert_eq!(made, "G90\nG92 X-5\nG1 X0\n");
    assert_eq!(
        fanuc("G91 G28 X0 Y0 Z100. G90\nG0 X1.\n"),
        " G28 X0 Y0 Z100. G90\nG0 X1.\n"
    );
    for dialect in [Dialect::LinuxCnc, Dialect::Undecided] {
        let error = run("G91 G28 Z0 G90\n", dialect).unwrap_err();
        assert!(
            error.reason.contains("another code of its group"),
            "{error}"
        );
    }
    // Fanuc's controllers pass over G53 under G91: where the tool is then is not known.
    let made = fanuc("G91\nG53 G0 Z0\nG90\nG0 X1.\n");
    assert_eq!(made, "G91\nG53 G0 Z0\nG90\nG0 X1.\n");
    assert_eq!(fanuc("G80\nG53 Z0.\n"), "G80\nG53 Z0.\n");
    assert!(run("G80\nG53 Z0.\n", Dialect::LinuxCnc).is_err());
}

#[test]
fn brackets_within_a_comment() {
    let text = "( holes at (0, 69) to (100, 69) )\n(cut(s) at 0.286mm per cut )\nG0 X1 (a (b))\n";
    for dialect in [Dialect::Fanuc, Dialect::Undecided] {
        assert_eq!(run(text, dialect).unwrap(), text);
    }
    let error = run(text, Dialect::LinuxCnc).unwrap_err();
    assert!(error.reason.contains("within a comment"), "{error}");
    // What a control that ends it at the first bracket would run is no comment.
    for text in [
        "(a (b) G0 X5 )\n",
        "(a (b) GOTO 5 )\n",
        "(a (b) X[1] )\n",
        "(a (b) c\n",
        "(a) )\n",
    ] {
        assert!(run(text, Dialect::Fanuc).is_err(), "{text}");
    }
    assert_eq!(fanuc("(a ( b) G0 X5\n"), "(a ( b) G0 X5\n");
}
