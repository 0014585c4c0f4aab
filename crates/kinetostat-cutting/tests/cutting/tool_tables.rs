//! Tables of tools: what is read, what is refused with its line, what a `tool.tbl` lacks.

use kinetostat_cutting::*;
use proptest::prelude::*;

const OURS: &str = r#"# my tools
[[tool]]
number = 3
name = "6 mm two-flute"
shape = "flat"
diameter_mm = 6
teeth = 2
helix_deg = 30
stick_out_mm = 30
flute_length_mm = 18
run_out_um = 10
run_out_angle_deg = 90
rake_deg = 12
max_chip_mm = 0.08

[[tool]]
number = 1
shape = "bull"
diameter_mm = 10.0
teeth = 4
corner_radius_mm = 0.5

[[tool]]
number = 20
shape = "face"
diameter_mm = 50
teeth = 5
lead_angle_deg = 45
length_mm = -120.5

[[tool]]
number = 7
shape = "ball"
diameter_mm = 8
teeth = 2
"#;

/// No type of a programming language stands in what a person is told.
#[test]
fn wrong_values_are_told_in_words() {
    for (from, to, words) in [
        (
            "teeth = 4",
            "teeth = 2.5",
            "the number `2.5`; expected a whole number",
        ),
        (
            "number = 1\n",
            "number = -1\n",
            "the number `-1`; expected a whole number",
        ),
        (
            "diameter_mm = 8",
            "diameter_mm = \"8\"",
            "the text \"8\"; expected a number",
        ),
        (
            "diameter_mm = 8",
            "diameter_mm = [8]",
            "a list; expected a number",
        ),
        (
            "name = \"6 mm two-flute\"",
            "name = true",
            "the word `true`; expected a text in quotes",
        ),
    ] {
        assert!(OURS.contains(from));
        let error = ToolTable::read("tools.toml", &OURS.replacen(from, to, 1)).unwrap_err();
        let said = error.to_string();
        assert!(
            error.line.is_some() && said.contains(words),
            "{words}: {said}"
        );
    }
}

#[test]
fn every_key_arrives_in_its_unit() {
    let table = ToolTable::read("tools.toml", OURS).unwrap();
    let numbers: Vec<u32> = table.entries().map(|entry| entry.number).collect();
    assert_eq!(numbers, [1, 3, 7, 20]);
    let entry = table.tool(3).unwrap();
    assert_eq!(entry.name, "6 mm two-flute");
    assert_eq!(
        (
            entry.tool.shape(),
            entry.tool.diameter_mm(),
            entry.tool.teeth()
        ),
        (Shape::Flat, 6.0, 2)
    );
    assert!((entry.tool.helix() - std::f64::consts::FRAC_PI_6).abs() < 1e-15);
    assert!((entry.tool.run_out().offset_mm - 0.01).abs() < 1e-15);
    assert!((entry.tool.run_out().angle - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert_eq!(
        (entry.stick_out_mm, entry.flute_length_mm),
        (Some(30.0), Some(18.0))
    );
    assert_eq!(
        (entry.rake_deg, entry.max_chip_mm, entry.length_mm),
        (Some(12.0), Some(0.08), None)
    );
    assert_eq!(
        table.tool(1).unwrap().tool.shape(),
        Shape::Bull {
            corner_radius_mm: 0.5
        }
    );
    assert_eq!(table.tool(7).unwrap().tool.shape(), Shape::Ball);
    let face = table.tool(20).unwrap();
    assert_eq!(face.length_mm, Some(-120.5));
    assert!((face.tool.side_angle().to_degrees() - 45.0).abs() < 1e-12);
    // Neither helix nor run-out where none is given.
    assert_eq!(
        (face.tool.helix(), face.tool.run_out()),
        (0.0, RunOut::default())
    );
    assert_eq!(table.tool(4).unwrap_err().quantity, "tool 4");
    assert_eq!(ToolTable::read("t", "").unwrap().entries().count(), 0);
}

/// A change of one line of the table, the line that is named, and words of the message.
#[test]
fn each_mistake_is_named_with_its_line_and_key() {
    let cases = [
        (
            "diameter_mm = 6\n",
            "diameter_mm = 0\n",
            6,
            "diameter_mm: 0 mm",
        ),
        ("diameter_mm = 6\n", "diameter_mm = nan\n", 6, "diameter_mm"),
        (
            "diameter_mm = 6\n",
            "diameter_mm = \"6\"\n",
            6,
            "expected a number",
        ),
        (
            "diameter_mm = 6\n",
            "diameter = 6\n",
            6,
            "did you mean `diameter_mm`?",
        ),
        (
            "diameter_mm = 6\n",
            "diametr_mm = 6\n",
            6,
            "did you mean `diameter_mm`?",
        ),
        (
            "diameter_mm = 6\n",
            "colour = 6\n",
            6,
            "one of number, name, shape",
        ),
        ("diameter_mm = 6\n", "\n", 2, "no `diameter_mm`"),
        ("teeth = 2\nhelix", "teeth = 0\nhelix", 7, "teeth: 0"),
        ("teeth = 2\nhelix", "teeth = -2\nhelix", 7, "-2"),
        ("teeth = 2\nhelix", "teeth = 2.5\nhelix", 7, "2.5"),
        ("teeth = 2\nhelix", "helix", 2, "no `teeth`"),
        ("helix_deg = 30", "helix_deg = 80", 8, "helix: 80"),
        ("\"flat\"", "\"flt\"", 5, "did you mean `flat`?"),
        (
            "flute_length_mm = 18",
            "flute_length_mm = 31",
            10,
            "at most the 30 mm of stick_out_mm",
        ),
        (
            "stick_out_mm = 30",
            "stick_out_mm = -3",
            9,
            "stick_out_mm: -3 mm",
        ),
        ("run_out_um = 10", "run_out_um = 700", 11, "run-out: 0.7"),
        ("run_out_um = 10", "run_out_um = -1", 11, "run_out_um: -1"),
        (
            "run_out_angle_deg = 90",
            "run_out_angle_deg = 1e9",
            12,
            "run_out_angle_deg",
        ),
        ("rake_deg = 12", "rake_deg = 60", 13, "rake_deg: 60 deg"),
        (
            "max_chip_mm = 0.08",
            "max_chip_mm = 0",
            14,
            "max_chip_mm: 0 mm",
        ),
        (
            "max_chip_mm = 0.08",
            "corner_radius_mm = 1",
            14,
            "only shape \"bull\" has it",
        ),
        (
            "max_chip_mm = 0.08",
            "lead_angle_deg = 45",
            14,
            "only shape \"face\" has it",
        ),
        (
            "max_chip_mm = 0.08",
            "max_chip_mm 0.08",
            14,
            "table of tools",
        ),
        ("max_chip_mm = 0.08", "teeth = 4", 14, "duplicate key"),
        ("number = 1\n", "number = 3\n", 17, "the tool of line 3"),
        ("number = 1\n", "number = -1\n", 17, "-1"),
        (
            "corner_radius_mm = 0.5",
            "corner_radius_mm = 5.5",
            21,
            "corner radius: 5.5",
        ),
        ("corner_radius_mm = 0.5", "", 18, "shape \"bull\" needs it"),
        (
            "lead_angle_deg = 45",
            "lead_angle_deg = 2",
            28,
            "lead angle",
        ),
        (
            "length_mm = -120.5",
            "length_mm = 1e5",
            29,
            "length_mm: 100000 mm",
        ),
        (
            "[[tool]]\nnumber = 7",
            "[[tools]]\nnumber = 7",
            31,
            "did you mean `tool`?",
        ),
    ];
    for (from, to, line, words) in cases {
        assert_eq!(OURS.matches(from).count(), 1, "{from}");
        let error = ToolTable::read("tools.toml", &OURS.replace(from, to)).expect_err(to);
        let text = error.to_string();
        assert_eq!(error.line, Some(line), "{to}: {text}");
        assert!(
            text.starts_with(&format!("tools.toml:{line}: ")) && text.contains(words),
            "{to}: {text}"
        );
    }
}

const TABLE: &str = "; tools of the mill\r
T1 P1 D+10.000000 Z+51.25 ;bull nose\r
\tt3  p17 x0 y0 z-50.2 d-6 I0 J0 Q0\t; six; two flutes \r
\r
  ; a remark after blanks\r
T20 P3\r
T04 P2 D0 ;spot drill";

#[test]
fn a_table_of_linuxcnc_is_read_in_the_units_of_the_machine() {
    let table =
        LinuxCncTable::read("tool.tbl", TABLE.as_bytes(), MachineUnit::Millimetres).unwrap();
    let rows: Vec<_> = table
        .tools()
        .iter()
        .map(|t| {
            (
                t.number,
                t.pocket,
                t.diameter_mm,
                t.length_mm,
                t.comment.as_str(),
                t.line,
            )
        })
        .collect();
    assert_eq!(
        rows,
        [
            (1, 1, Some(10.0), Some(51.25), "bull nose", 2),
            (3, 17, Some(6.0), Some(-50.2), "six; two flutes", 3),
            (4, 2, None, None, "spot drill", 7),
            (20, 3, None, None, "", 6),
        ]
    );
    let inches = LinuxCncTable::read("tool.tbl", b"T1 P1 D0.25 Z1\n", MachineUnit::Inches).unwrap();
    let tool = inches.get(1).unwrap();
    assert_eq!((tool.diameter_mm, tool.length_mm), (Some(6.35), Some(25.4)));
    assert!(inches.get(2).is_none());
}

#[test]
fn a_line_that_is_no_tool_is_refused_by_number() {
    for (line, words) in [
        ("1 1 0.5 0.125", "`1`"),
        ("T1 D6", "no P"),
        ("P1 D6", "no T"),
        ("T1.5 P1", "whole number"),
        ("T-1 P1", "number of the tool: -1"),
        ("T1 P1 D", "`D`"),
        ("T1 P1 Dinf", "`Dinf`"),
        ("T1 P1 DNaN", "`DNaN`"),
        ("T1 P1 D5000", "diameter D: 5000 mm"),
        ("T1 P1 Z1e9", "length offset Z"),
        ("T1 P1 D6 D7", "`D` twice"),
        ("T1 P1 R6", "`R6`"),
        ("T1P1", "`T1P1`"),
        ("T1 P1 bull nose", "`bull`"),
        ("T1 P1 \u{1b}[31m", "`\\u{1b}[31m`"),
        ("T9 P2", "T9, which is the tool of line 1"),
    ] {
        let text = format!("T9 P1\n{line}\nT8 P1\n");
        let error = LinuxCncTable::read("tool.tbl", text.as_bytes(), MachineUnit::default())
            .expect_err(line);
        let message = error.to_string();
        assert_eq!(error.line, Some(2), "{line}: {message}");
        assert!(
            message.starts_with("tool.tbl:2: ") && message.contains(words),
            "{line}: {message}"
        );
    }
}

fn machine() -> LinuxCncTable {
    LinuxCncTable::read("tool.tbl", TABLE.as_bytes(), MachineUnit::Millimetres).unwrap()
}

#[test]
fn our_table_completes_that_of_the_machine() {
    let table = ToolTable::completing("tools.toml", OURS, machine()).unwrap();
    let of = |number: u32| table.tool(number).unwrap();
    // Lengths come from the machine where ours gives none, names too.
    assert_eq!(
        [1, 3, 20, 7].map(|n| of(n).length_mm),
        [Some(51.25), Some(-50.2), Some(-120.5), None]
    );
    assert_eq!(
        [1, 3, 20].map(|n| of(n).name.as_str()),
        ["bull nose", "6 mm two-flute", ""]
    );
    let stated = OURS.replace("rake_deg = 12", "length_mm = -49");
    let table_stated = ToolTable::completing("tools.toml", &stated, machine()).unwrap();
    assert_eq!(table_stated.tool(3).unwrap().length_mm, Some(-49.0));
    // What both lack is asked for by name, with the line of the machine's table.
    let text = table.tool(4).unwrap_err().to_string();
    assert_eq!(
        text,
        "tool.tbl:7: tool 4 (spot drill): no diameter, no shape, no teeth; expected [[tool]] with number = 4, diameter_mm, shape, teeth in tools.toml"
    );
    assert_eq!(
        table.tool(99).unwrap_err().file.as_deref(),
        Some("tools.toml")
    );
    // The diameter may come from the machine; where it has none it is asked for.
    let bare = "[[tool]]\nnumber = 3\nshape = 'flat'\nteeth = 2\n";
    let table = ToolTable::completing("tools.toml", bare, machine()).unwrap();
    assert_eq!(table.tool(3).unwrap().tool.diameter_mm(), 6.0);
    let error =
        ToolTable::completing("tools.toml", &bare.replace('3', "20"), machine()).unwrap_err();
    assert_eq!(
        (error.line, error.found.as_str()),
        (Some(1), "no `diameter_mm`")
    );
}

/// D is the measured diameter or, near zero, the difference to the nominal one (LinuxCNC, tool-compensation.adoc).
#[test]
fn two_diameters_must_be_of_one_tool() {
    let ours = "[[tool]]\nnumber = 1\nshape = 'flat'\ndiameter_mm = 10\nteeth = 2\n";
    let with = |d: &str| {
        let text = format!("T1 P1 D{d}\n");
        let machine =
            LinuxCncTable::read("tool.tbl", text.as_bytes(), MachineUnit::Millimetres).unwrap();
        ToolTable::completing("tools.toml", ours, machine)
    };
    for d in ["10", "9.2", "10.9", "-9.98", "0", "0.02", "-0.02"] {
        assert_eq!(
            with(d).unwrap().tool(1).unwrap().tool.diameter_mm(),
            10.0,
            "{d}"
        );
    }
    for d in ["5", "8", "12", "1.5", "100"] {
        let error = with(d).expect_err(d);
        assert_eq!(
            (error.line, error.quantity.as_str()),
            (Some(4), "diameter_mm")
        );
        assert!(error.expected.contains("tool 1 in tool.tbl:1"), "{error}");
    }
}

#[test]
fn files_without_end_are_refused() {
    let many = "[[tool]]\nnumber=1\nshape='flat'\ndiameter_mm=1\nteeth=1\n".repeat(10_001);
    assert_eq!(ToolTable::read("t", &many).unwrap_err().quantity, "tools");
    let lines: String = (0..10_001).map(|i| format!("T{i} P1\n")).collect();
    let error = LinuxCncTable::read("t", lines.as_bytes(), MachineUnit::default()).unwrap_err();
    assert_eq!(
        (error.quantity.as_str(), error.line),
        ("tools", Some(10_001))
    );
    let long = vec![b';'; 10_000_001];
    assert!(LinuxCncTable::read("t", &long, MachineUnit::default()).is_err());
    let long = "#".repeat(10_000_001);
    assert!(ToolTable::read("t", &long).is_err());
    let deep = format!("tool = {}", "[".repeat(100_000));
    assert!(ToolTable::read("t", &deep).is_err());
}

fn bytes_of(words: &'static [&'static str]) -> impl Strategy<Value = Vec<u8>> {
    let word = prop_oneof![
        4 => proptest::sample::select(words).prop_map(|word| word.as_bytes().to_vec()),
        1 => proptest::collection::vec(any::<u8>(), 0..4),
    ];
    proptest::collection::vec(word, 0..40).prop_map(|words| words.concat())
}

const TBL_WORDS: &[&str] = &[
    "T", "P", "D", "Z", "1", "2", "-", ".", " ", "\t", "\n", ";", "T3 P4", "e9", "\r\n", "é",
];
const TOML_WORDS: &[&str] = &[
    "[[tool]]\n",
    "number = ",
    "3\n",
    "shape = ",
    "\"flat\"\n",
    "'bull'\n",
    "diameter_mm = ",
    "6\n",
    "teeth = ",
    "2\n",
    "nan\n",
    "1e400\n",
    "-1\n",
    "corner_radius_mm = 1\n",
    "{",
    "}",
    "[",
    "]",
    "\n",
    "é",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// No bytes make the readers panic, and an error of a line names one that the file has.
    #[test]
    fn any_bytes_are_read_or_refused(table in bytes_of(TBL_WORDS), toml in bytes_of(TOML_WORDS)) {
        let lines = |bytes: &[u8]| 1 + bytes.iter().filter(|byte| **byte == b'\n').count();
        let machine = LinuxCncTable::read("tool.tbl", &table, MachineUnit::Inches);
        if let Err(error) = &machine {
            prop_assert!((1..=lines(&table)).contains(&error.line.unwrap()));
        }
        let text = String::from_utf8_lossy(&toml);
        let known = machine.unwrap_or_else(|_| self::machine());
        if let Err(error) = ToolTable::completing("tools.toml", &text, known) {
            prop_assert!((1..=lines(text.as_bytes())).contains(&error.line.unwrap()), "{error}");
        }
    }

    /// Any table that could be written is read back.
    #[test]
    fn what_is_written_is_read(tools in proptest::collection::btree_map(0..100_000_u32, (0..1000_u32, -300.0..300.0_f64, 0.1..100.0_f64, "[a-z ]{0,12}"), 0..30)) {
        let text: String = tools.iter().rev().map(|(t, (p, z, d, note))| format!("T{t}  P{p} D{d:+.6} Z{z:+.6} ;{note}\n")).collect();
        let table = LinuxCncTable::read("tool.tbl", text.as_bytes(), MachineUnit::Millimetres).unwrap();
        prop_assert_eq!(table.tools().len(), tools.len());
        for (number, (pocket, z, d, note)) in &tools {
            let tool = table.get(*number).unwrap();
            prop_assert_eq!((tool.pocket, tool.comment.as_str()), (*pocket, note.trim()));
            prop_assert!((tool.length_mm.unwrap() - z).abs() <= 6e-7 && (tool.diameter_mm.unwrap() - d).abs() <= 6e-7);
        }
    }
}

/// A `tool.tbl` in place of our table is known as that.
#[test]
fn a_table_of_linuxcnc_is_not_ours() {
    let error = ToolTable::read("tool.tbl", "; of the mill\nT1 P1 D6 Z60 ;flat\n").unwrap_err();
    let said = error.to_string();
    assert!(
        said.contains("tool.tbl") && said.contains("tool_tbl under [cutters]"),
        "{said}"
    );
}
