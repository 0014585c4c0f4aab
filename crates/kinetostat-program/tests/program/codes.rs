//! Every code: known exactly or refused with its line, and written in the piece where it acts.

// Helpers of tests, which clippy does not count as tests.
use crate::code_programs::{AFTER, BEFORE, READ, exclude_each_other};
use kinetostat_program::*;
use nalgebra::Vector3;
use proptest::prelude::*;

/// Bends z by 1 um at 10 mm, 100 um at 100 mm.
fn bend(request: &Request) -> Result<Vector3<f64>, FieldFailure> {
    Ok(Vector3::new(
        0.0,
        0.0,
        1e-5 * request.position_mm.norm_squared(),
    ))
}

fn read(text: &str) -> Result<(Program, Path), ProgramError> {
    let program = Program::read(text)?;
    let path = interpret(&program, &ReadOptions::default())?;
    Ok((program, path))
}

/// The lines that stand for line 3 of a program of four lines.
fn pieces_of_line_3(text: &str) -> Result<Vec<String>, ProgramError> {
    let (program, path) = read(text)?;
    let writing = {
        let mut writing = WriteOptions::default();
        writing.header = None;
        writing
    };
    let written = write_corrected(&program, &path, &bend, &writing, &Unwatched).unwrap();
    let reading = ReadOptions::default();
    verify_written(&program, &path, &written, &reading, &writing).unwrap();
    let output = String::from_utf8(written.bytes).unwrap();
    let lines: Vec<&str> = output.lines().collect();
    Ok(lines[2..lines.len() - 1]
        .iter()
        .map(|line| (*line).to_owned())
        .collect())
}

fn has_word(line: &str, word: &str) -> bool {
    line.split(' ').any(|other| other == word)
}

#[test]
fn each_m_code_of_a_divided_block_stands_in_the_piece_where_it_acts() {
    let mut placed = 0;
    for code in 0..1000 {
        for motion in ["G1 X100 F200", "G2 X100 Y0 I50 J0 F200"] {
            let word = format!("M{code}");
            // After an M2 or M30 no motion may follow, and the last line is a comment.
            let text = format!("G21 G90\nG0 X0 Y0 Z0\n{motion} {word}\n(end)\n");
            let result = pieces_of_line_3(&text);
            let (first, last) = (BEFORE.contains(&code), AFTER.contains(&code));
            if !first && !last {
                let error = result.expect_err(&text);
                assert_eq!(error.line, 3, "{error}");
                continue;
            }
            let lines = result.unwrap_or_else(|error| panic!("{error}"));
            assert!(lines.len() > 2, "{text} is not divided");
            for (index, line) in lines.iter().enumerate() {
                let here = if first {
                    index == 0
                } else {
                    index + 1 == lines.len()
                };
                assert_eq!(
                    has_word(line, &word),
                    here,
                    "{word} in piece {index}:\n{lines:#?}"
                );
            }
            placed += 1;
        }
    }
    assert_eq!(placed, 2 * (BEFORE.len() + AFTER.len()));
}

#[test]
fn an_exact_stop_of_one_block_is_in_its_last_piece_and_modes_are_in_the_first() {
    for (word, first) in [
        ("G9", false),
        ("G61", true),
        ("G64", true),
        ("G96", true),
        ("G17", true),
        ("G94", true),
        ("S500", true),
        ("T3", true),
        ("H3", true),
        ("D3", true),
    ] {
        let text = format!("G21 G90\nG0 X0 Y0 Z0\n{word} G1 X100 F200\n(end)\n");
        let lines = pieces_of_line_3(&text).unwrap();
        assert!(lines.len() > 2, "{text} is not divided");
        for (index, line) in lines.iter().enumerate() {
            let here = if first {
                index == 0
            } else {
                index + 1 == lines.len()
            };
            assert_eq!(has_word(line, word), here, "{word}: {lines:#?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Any number of codes in any order between the other words: each once, in the piece where it acts.
    #[test]
    fn codes_in_any_number_and_order_reach_their_pieces(
        codes in proptest::collection::btree_set(prop::sample::select([BEFORE.as_slice(), AFTER.as_slice()].concat()), 1..6),
        order in any::<prop::sample::Index>(),
        slot in proptest::collection::vec(any::<prop::sample::Index>(), 6),
        zero in any::<bool>(),
    ) {
        // Codes that exclude each other are refused by a test of their own.
        let codes: Vec<u32> = codes.iter().fold(Vec::new(), |mut kept, code| {
            if !kept.iter().any(|other| exclude_each_other(*code, *other)) {
                kept.push(*code);
            }
            kept
        });
        let mut words = vec!["G1".to_owned(), "X100".to_owned(), "F200".to_owned()];
        let written = |code: u32| if zero && code < 10 { format!("M0{code}") } else { format!("M{code}") };
        for (code, slot) in codes.iter().zip(&slot) {
            words.insert(slot.index(words.len() + 1), written(*code));
        }
        let count = words.len();
        words.rotate_left(order.index(count));
        let text = format!("G21 G90\nG0 X0 Y0 Z0\n{}\n(end)\n", words.join(" "));
        let lines = pieces_of_line_3(&text).unwrap_or_else(|error| panic!("{error}"));
        prop_assert!(lines.len() > 2);
        for code in &codes {
            let places: Vec<usize> = (0..lines.len()).filter(|&index| has_word(&lines[index], &written(*code))).collect();
            let wanted = if AFTER.contains(code) { lines.len() - 1 } else { 0 };
            prop_assert_eq!(places, vec![wanted], "M{} of {}: {:#?}", code, text, lines);
        }
    }
}

#[test]
fn where_controllers_disagree_the_line_is_named() {
    let (_, path) =
        read("G21 G90\nG0 X0 Y0 Z0\nG1 X10 F200 M8\nX20 M9\nX30 M5\nX0 M9\nG0 Z5 M5\nM9\n")
            .unwrap();
    let found: Vec<(usize, &str)> = path
        .warnings
        .iter()
        .map(|warning| (warning.line, warning.text.split(' ').next().unwrap()))
        .collect();
    assert_eq!(found, [(4, "M9"), (5, "M5")], "{:?}", path.warnings);
    for (warning, lines) in path
        .warnings
        .iter()
        .zip(["; so on lines 4 and 6", "is meant"])
    {
        assert!(warning.text.ends_with(lines), "{}", warning.text);
    }
}

/// A path tolerance of the control above a hundredth of a millimetre is a warning, in millimetres.
#[test]
fn a_path_tolerance_is_told() {
    let told = |mode: &str, units: &str| {
        let (_, path) = read(&format!("{units} G90\n{mode}\nG0 X0 Y0 Z0\nG1 X1 F20\n")).unwrap();
        let found = path.warnings.into_iter().map(|w| (w.line, w.text));
        found.collect::<Vec<_>>()
    };
    let [(line, text)] = &told("G64 P0.5", "G21")[..] else {
        panic!("one warning");
    };
    assert_eq!(*line, 2);
    assert!(
        text.starts_with("the control may leave the path by 0.5 mm"),
        "{text}"
    );
    let [(_, text)] = &told("G64 P0.002", "G20")[..] else {
        panic!("one warning");
    };
    assert!(text.contains("by 0.0508 mm"), "{text}");
    for quiet in ["G64", "G64 P0.005", "G61", "G4 P0.5"] {
        assert_eq!(told(quiet, "G21"), [], "{quiet}");
    }
}

/// A warning that concerns many lines names the first of them and their number, and a warning of one line
/// only that.
#[test]
fn a_warning_names_all_lines_that_it_concerns() {
    for count in 1..20_usize {
        for (block, system) in [
            ("G1 Y1 F50 M5", ""),
            ("/G1 Y1 F50", ""),
            ("G1 Y1 F50", "G55 "),
        ] {
            let mut text = format!("G21 G90\nG0 X0 Y0 Z0 F50\n{system}\n");
            let mut lines = Vec::new();
            for k in 0..count {
                // At uneven distances.
                text.push_str(&"M8\n".repeat(k % 3));
                lines.push(text.lines().count() + 1);
                text.push_str(block);
                text.push('\n');
            }
            let (_, path) = read(&text).unwrap();
            let [warning] = &path.warnings[..] else {
                panic!("{text}{:?}", path.warnings)
            };
            assert_eq!(warning.line, lines[0]);
            let said = warning.text.rsplit_once("; so on ").map(|(_, said)| said);
            let named: Vec<String> = lines.iter().take(6).map(ToString::to_string).collect();
            match count {
                1 => assert_eq!(said, None),
                2..=6 => {
                    let (last, rest) = named.split_last().unwrap();
                    let wanted = format!("lines {} and {last}", rest.join(", "));
                    assert_eq!(said, Some(wanted.as_str()));
                }
                _ => {
                    let wanted =
                        format!("{count} lines: {} and {} more", named.join(", "), count - 6);
                    assert_eq!(said, Some(wanted.as_str()));
                }
            }
        }
    }
}

#[test]
fn every_g_code_is_known_exactly_or_refused_with_its_line() {
    for tenths in 0..1000 {
        let number = format!("{}.{}", tenths / 10, tenths % 10);
        let mut spellings = vec![
            format!("G{number}"),
            format!("g0{number}"),
            format!("G{number}0"),
        ];
        if tenths % 10 == 0 {
            spellings.push(format!("G{}", tenths / 10));
        }
        for word in spellings {
            // Alone in its block: some are refused beside a motion, and G92 needs an axis.
            let axis = if tenths == 920 { " X5" } else { "" };
            let text = format!("G21\nG0 X0 Y0 Z0\n{word}{axis}\n");
            let result = read(&text);
            assert_eq!(result.is_ok(), READ.contains(&tenths), "{word}: {result:?}");
            if let Err(error) = result {
                assert_eq!(error.line, 3, "{error}");
                assert!(!error.reason.is_empty() && !error.remedy.is_empty());
            }
        }
    }
}

#[test]
fn no_coordinate_changes_in_a_block_with_an_unknown_code() {
    let known_m = |tenths: u32| {
        tenths.is_multiple_of(10)
            && (BEFORE.contains(&(tenths / 10))
                || AFTER.contains(&(tenths / 10))
                || [60, 190].contains(&tenths))
    };
    for tenths in 0..10_000 {
        let number = format!("{}.{}", tenths / 10, tenths % 10);
        for letter in ['G', 'M'] {
            if letter == 'G' && tenths >= 1_500 {
                continue;
            }
            for motion in ["G0 X5", "G1 X5 F100"] {
                let text = format!("G21\nG0 X0 Y0 Z0\n{letter}{number} {motion}\nG0 X6\n");
                let known = if letter == 'G' {
                    READ.contains(&tenths)
                } else {
                    known_m(tenths)
                };
                let result = read(&text);
                assert!(known || result.is_err(), "{text}");
                if let Err(error) = result {
                    // M2 and M30 end the program before line 4; the tool length must be followed by Z.
                    assert!(error.line == 3 || error.line == 4 && known, "{error}");
                }
            }
        }
    }
    // A builder's own code in a block of its own is the controller's matter and carried as it is.
    let text = "G21\nG0 X0 Y0 Z0\nM10\nM117 P3\nM777\nG1 X5 F100\n";
    let (program, path) = read(text).unwrap();
    let writing = {
        let mut writing = WriteOptions::default();
        writing.header = None;
        writing
    };
    let written = write_corrected(&program, &path, &NoCorrection, &writing, &Unwatched).unwrap();
    assert_eq!(written.bytes, text.as_bytes());
}

#[test]
fn codes_that_exclude_each_other_are_refused_in_one_block() {
    let all: Vec<u32> = [BEFORE.as_slice(), AFTER.as_slice(), &[19]].concat();
    for a in &all {
        for b in &all {
            for motion in ["", "G1 X5 F100 "] {
                if *a == 19 && !motion.is_empty() || *b == 19 && !motion.is_empty() {
                    continue;
                }
                let text = format!("G21 G90\nG0 X0 Y0 Z0\n{motion}M{a} M{b}\n(end)\n");
                let result = read(&text);
                if exclude_each_other(*a, *b) {
                    let error = result.expect_err(&text);
                    assert_eq!(error.line, 3, "{error}");
                    assert!(error.to_string().contains("group"), "{error}");
                } else if a != b {
                    assert!(result.is_ok(), "{text}{result:?}");
                }
            }
        }
    }
    for (words, allowed) in [
        ("G61 G64", false),
        ("G96 G97", false),
        ("G98 G99", false),
        ("M3 M8", true),
        ("M7 M8", true),
        ("M5 M9", true),
    ] {
        let text = format!("G21 G90\nG0 X0 Y0 Z0\n{words}\n");
        assert_eq!(read(&text).is_ok(), allowed, "{text}");
    }
}

/// The table of the book is the table of the code.
#[test]
fn the_book_has_the_table_of_moments() {
    let page = include_str!("../../../../book/src/machines/codes.md");
    let shown = |acts: Acts| match acts {
        Acts::Before => "before",
        Acts::During => "with its begin",
        Acts::After => "after",
        Acts::OwnBlock => "own block",
        Acts::Builder => "builder",
        Acts::Absent => "-",
        Acts::Unsaid => "?",
    };
    for moment in MOMENTS {
        let acts: Vec<&str> = moment.acts.into_iter().map(shown).collect();
        let placed = match moment.placed {
            Placed::First => "first",
            Placed::Last => "last",
            Placed::Refused => "refused",
        };
        let row = format!(
            "| M{} | {} | {} | {placed} |",
            moment.code,
            moment.meaning,
            acts.join(" | ")
        );
        assert!(page.contains(&row), "the page has no row\n{row}");
    }
    let rows = page.lines().filter(|line| line.starts_with("| M")).count();
    assert_eq!(rows, MOMENTS.len());
    for (controller, source) in CONTROLLERS {
        assert!(
            page.contains(controller) && page.contains(source),
            "{controller}: {source}"
        );
    }
}

/// The generator of `cargo xtask fuzz`, for a moment.
#[test]
fn random_programs_with_every_code_keep_each_in_its_place() {
    let mut all = crate::code_programs::CaseOutcome::default();
    let mut taken = 0;
    for seed in 0..1500 {
        let found = crate::code_programs::check(seed).unwrap_or_else(|what| panic!("{what}"));
        taken += usize::from(found.taken);
        all.refused += found.refused;
        all.divided += found.divided;
        all.placed += found.placed;
    }
    assert!(
        taken > 300 && all.refused > 300 && all.divided > 300 && all.placed > 300,
        "{taken} {all:?}"
    );
}
