//! The same suite for each language: bytes that come back, ends that do not change, random programs whole and broken, and files of
//! nothing but one word.

use kinetostat_formats::*;
use proptest::prelude::any;
use proptest::test_runner::{Config, TestCaseError, TestRunner};

use crate::harness::{self, Kind};

/// Bytes of a text.
type Change<'c> = &'c dyn Fn(&str) -> Vec<u8>;

/// A program with most of what a language has.
struct Example {
    files: &'static [(&'static str, &'static str)],
    /// A remark behind its last line, in no coding.
    remark: &'static [u8],
    /// Values that the caller states.
    values: &'static [(&'static str, f64)],
    /// Lines of motions that state only a part of their ends, state them otherwise than in X, Y and Z, or go elsewhere each time.
    partial: &'static [usize],
    /// Ends that are stated again as they are; arcs stay.
    ends: usize,
    /// Openings of blocks, brackets, calls and signs, each with what stands before the first of them.
    nests: &'static [(&'static str, &'static str)],
    /// True for an example that can be written flat.
    is_flat: bool,
}

impl Example {
    fn options(&self) -> ReadOptions {
        let mut options = ReadOptions::default();
        let values = self.values.iter();
        options.values = values
            .map(|(name, value)| ((*name).to_owned(), StatedValue::Number(*value)))
            .collect();
        options
    }

    fn read(&self, language: Language, change: Change<'_>) -> RobotProgram {
        let files = self.files.iter();
        let files = files.map(|(name, text)| SourceFile::new(*name, change(text)));
        let read = read(language, files.collect(), &self.options());
        read.unwrap_or_else(|errors| panic!("{errors:#?}"))
    }
}

/// Without pieces every byte comes back, with any line ending and any coding.
fn every_byte_comes_back(language: Language, example: &Example) {
    let changes: [Change<'_>; 6] = [
        &|text| text.as_bytes().to_vec(),
        &|text| text.replace('\n', "\r\n").into_bytes(),
        &|text| text.trim_end().as_bytes().to_vec(),
        &|text| [b"\xef\xbb\xbf", text.as_bytes()].concat(),
        &|text| [text.as_bytes(), b"\n", example.remark, b"\n\n"].concat(),
        &|text| {
            let latin = text.replace("first", "prem\u{e9}re");
            latin.chars().map(|letter| letter as u8).collect()
        },
    ];
    for change in changes {
        let program = example.read(language, change);
        let files = write(&program, &[], &WriteOptions::default()).unwrap();
        for ((name, text), written) in example.files.iter().zip(files) {
            assert!(written == ((*name).to_owned(), change(text)), "{name}");
        }
    }
}

/// Ends that are stated as they were change no byte.
fn unchanged_ends_change_no_byte(kind: &Kind, example: &Example) {
    let program = example.read(kind.language, &|text| text.as_bytes().to_vec());
    let mut pieces = Vec::new();
    for (index, motion) in program.motions.iter().enumerate() {
        let is_arc = matches!(motion.kind, MotionKind::Arc { .. });
        let end = motion.target.pose().filter(|_| !is_arc);
        let Some(end) = end.filter(|_| !example.partial.contains(&motion.line)) else {
            continue;
        };
        let mut piece = Piece::to(index, end.position_mm);
        piece.orientation = kind.turns.then_some(end.orientation);
        if let MotionKind::Circular { via } = &motion.kind {
            piece.via_mm = via.pose().map(|pose| pose.position_mm);
        }
        pieces.push(piece);
    }
    assert_eq!(pieces.len(), example.ends);
    let files = write(&program, &pieces, &WriteOptions::default()).unwrap();
    for ((name, text), (_, written)) in example.files.iter().zip(files) {
        assert_eq!(String::from_utf8_lossy(&written), *text, "{name}");
    }
}

fn random(check: impl Fn(u64) -> Result<(), String>) {
    let mut runner = TestRunner::new(Config::with_cases(200));
    let found = runner.run(&any::<u64>(), |seed| {
        check(seed).map_err(TestCaseError::fail)
    });
    found.unwrap_or_else(|error| panic!("{error}"));
}

/// Run once and written flat, a program goes through the same places, each statement once.
fn flat_programs_go_the_same_way(kind: &Kind, example: &Example) {
    let way = |program: &RobotProgram| -> Vec<String> {
        let motions = program.motions.iter();
        let main = motions.filter(|motion| motion.runs != Runs::Elsewhere);
        let ends = main.map(|motion| {
            let place = motion.base_pose().map(|pose| {
                let numbers = pose.to_homogeneous();
                numbers.map(|number| (1e6 * number).round() as i64)
            });
            format!("{place:?} {:?} {:?}", motion.zone, motion.speed.mm_per_s)
        });
        ends.collect()
    };
    let same = |files: Vec<SourceFile>, options: &ReadOptions| -> Result<bool, String> {
        let said = |errors: Vec<ProgramError>| format!("{errors:?}");
        let program = read(kind.language, files.clone(), options).map_err(said)?;
        let Ok(Some(flat)) = expand(kind.language, files.clone(), options) else {
            return Ok(false);
        };
        let text = String::from_utf8_lossy(flat.file.bytes()).into_owned();
        let first = files[0].clone();
        let beside = files[1..]
            .iter()
            .filter(|file| stays_beside_flat(kind.language, file));
        let files = std::iter::once(flat.file).chain(beside.cloned()).collect();
        let again = read(kind.language, files, options).map_err(|errors| {
            format!(
                "{errors:?}\n{text}\n----\n{}",
                String::from_utf8_lossy(first.bytes())
            )
        })?;
        match way(&program) == way(&again) {
            true => Ok(true),
            false => Err(format!(
                "{:#?}\n{:#?}\n{text}\n----\n{}",
                way(&program),
                way(&again),
                String::from_utf8_lossy(first.bytes())
            )),
        }
    };
    let files = (example.files.iter()).map(|(name, text)| SourceFile::new(*name, *text));
    let is_flat = same(files.collect(), &example.options()).unwrap();
    random(|seed| {
        let texts = (kind.whole)(&mut harness::Chance::new(seed)).into_iter();
        let files = kind.names.iter().zip(texts);
        let files = files
            .map(|(name, text)| SourceFile::new(*name, text))
            .collect();
        same(files, &kind.options).map(|_| ())
    });
    assert_eq!(is_flat, example.is_flat);
}

/// A word that stands ten thousand times in a program: it is read, or refused with bounded words.
fn one_word_again_and_again(kind: &Kind, example: &Example) {
    let more = ["(", "[", "{", "-", "IF ", "9", "\"", "\n"];
    for word in kind.words.iter().chain(&more) {
        let files = example.files.iter().map(|(name, text)| {
            let middle = text.len() / 2;
            let at = text[middle..]
                .find('\n')
                .map_or(text.len(), |at| middle + at + 1);
            SourceFile::new(
                *name,
                [&text[..at], &word.repeat(10_000), &text[at..]].concat(),
            )
        });
        if let Err(errors) = read(kind.language, files.collect(), &example.options()) {
            let words: usize = errors.iter().map(|error| error.to_string().len()).sum();
            assert!((1..40_000_000).contains(&words), "{word:?}: {words} bytes");
        }
    }
}

/// Blocks and expressions 20 000 deep, in any line of the first file: refused with bounded words, or carried as text.
fn deep_nesting_ends_in_words(kind: &Kind, example: &Example) {
    for (before, open) in example.nests {
        let (name, text) = example.files[0];
        for (end, _) in text.match_indices('\n').step_by(40) {
            let nest = open.repeat(20_000);
            let deep = [&text[..=end], before, &nest, &text[end..]].concat();
            let mut files = vec![SourceFile::new(name, deep)];
            let others = example.files[1..].iter();
            files.extend(others.map(|(name, text)| SourceFile::new(*name, *text)));
            if let Err(errors) = read(kind.language, files, &example.options()) {
                let words: usize = errors.iter().map(|error| error.to_string().len()).sum();
                assert!((1..40_000_000).contains(&words), "{open:?}: {words} bytes");
            }
        }
    }
}

/// The suite for a language: its folder, and its example.
macro_rules! conforms {
    ($($language:ident: $example:expr;)*) => {$(
        mod $language {
            use super::Example;
            use crate::$language::random::kind;

            const EXAMPLE: Example = $example;

            #[test]
            fn every_byte_comes_back_with_any_line_ending_and_any_coding() {
                super::every_byte_comes_back(kind().language, &EXAMPLE);
            }

            #[test]
            fn ends_that_do_not_change_change_no_byte() {
                super::unchanged_ends_change_no_byte(&kind(), &EXAMPLE);
            }

            #[test]
            fn whole_programs_come_back_and_take_corrections() {
                super::random(|seed| super::harness::whole(seed, &kind()));
            }

            #[test]
            fn broken_programs_are_refused_with_a_place_or_come_back() {
                super::random(|seed| super::harness::case(seed, kind()).map(|_| ()));
            }

            #[test]
            fn flat_programs_go_the_same_way() {
                super::flat_programs_go_the_same_way(&kind(), &EXAMPLE);
            }

            #[test]
            fn a_word_again_and_again_ends_in_words() {
                super::one_word_again_and_again(&kind(), &EXAMPLE);
            }

            #[test]
            fn deep_nesting_ends_in_words() {
                super::deep_nesting_ends_in_words(&kind(), &EXAMPLE);
            }
        }
    )*

    /// No language is left out.
    #[test]
    fn all_languages_conform() {
        let all = [$(crate::$language::random::kind().language),*];
        for language in Language::ALL {
            assert!(all.contains(&language), "{language:?}");
        }
    }
    };
}

conforms! {
    rapid: Example {
        files: &[("everything.mod", include_str!("fixtures/everything.mod"))],
        remark: b"! \xff\xfe",
        values: &[("diReady", 1.0)],
        partial: &[],
        ends: 16,
        nests: &[("", "IF TRUE THEN\n"), ("", "FOR i FROM 1 TO 2 DO\n"), ("i:=", "Abs("), ("i:=", "-"), ("MoveL ", "Offs("), ("MoveL ", "["), ("", "TEST 1\nCASE 1:\n")],
        is_flat: true,
    };
    krl: Example {
        files: &[
            ("R1/everything.src", include_str!("fixtures/everything.src")),
            ("R1/Everything.DAT", include_str!("fixtures/everything.dat")),
            ("$config.dat", include_str!("fixtures/$config.dat")),
        ],
        remark: b"; \xff\xfe",
        values: &[],
        partial: &[49],
        ends: 16,
        nests: &[("", "IF TRUE THEN\n"), ("", "LOOP\n"), ("count=", "("), ("count=", "ABS("), ("count=", "-"), ("LIN ", "{X "), ("count=", "row["), ("", "SWITCH 1\nCASE 1\n")],
        is_flat: true,
    };
    ls: Example {
        files: &[("part.ls", include_str!("fixtures/everything.ls"))],
        remark: b"\t \xff\xfe",
        values: &[("DI[1]", 1.0), ("R[1]", 3.0)],
        partial: &[],
        ends: 14,
        nests: &[("", "  1:  IF (R[1]=0) THEN ;\n"), ("", "  1:  FOR R[1]=1 TO 2 ;\n"), ("", "R["), ("", "("), ("", "!")],
        is_flat: true,
    };
    apt: Example {
        files: &[("part.apt", include_str!("fixtures/solidworks.apt"))],
        remark: b"$$ \xff\xfe",
        values: &[],
        partial: &[],
        ends: 6,
        nests: &[("", "LOOPST\n"), ("", "("), ("", "/")],
        is_flat: true,
    };
    poses: Example {
        files: &[("a.csv", crate::poses::TABLE)],
        remark: b"# \xff\xfe",
        values: &[],
        partial: &[],
        ends: 4,
        nests: &[("", "("), ("", "\""), ("", "[")],
        is_flat: false,
    };
    siemens: Example {
        files: &[("part.mpf", include_str!("fixtures/everything.mpf"))],
        remark: b"; \xff\xfe",
        values: &[],
        partial: &[30],
        ends: 15,
        nests: &[("", "IF R1==1\n"), ("", "LOOP\n"), ("R1=", "("), ("R1=", "-"), ("R1=", "ABS("), ("R1=", "R[")],
        is_flat: true,
    };
    heidenhain: Example {
        files: &[("part.h", include_str!("fixtures/everything.h"))],
        remark: b"; \xff\xfe",
        values: &[],
        partial: &[23, 24],
        ends: 10,
        nests: &[("Q1 = ", " ("), ("Q1 = ", " -"), ("Q1 = ", " SIN "), ("", "LBL 1\n")],
        is_flat: true,
    };
    urscript: Example {
        files: &[("part.script", include_str!("fixtures/everything.script"))],
        remark: b"# \xff\xfe",
        values: &[],
        partial: &[11, 32, 41],
        ends: 8,
        nests: &[("", "if True:\n"), ("", "while True:\n"), ("", "def f():\n"), ("x=", "("), ("x=", "["), ("x=", "p["), ("x=", "not "), ("x=", "cos(")],
        is_flat: true,
    };
    val3: Example {
        files: &[
            ("start.pgx", include_str!("fixtures/everything.pgx")),
            ("cell.dtx", include_str!("fixtures/everything.dtx")),
        ],
        remark: b"<!-- behind -->",
        values: &[("bGo", 1.0)],
        partial: &[],
        ends: 6,
        nests: &[("", "if true\n"), ("", "while true\n"), ("nCount=", "("), ("nCount=", "-"), ("nCount=", "abs("), ("nCount=", "nCount["), ("movel(", "appro(")],
        is_flat: true,
    };
}
