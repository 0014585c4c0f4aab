//! The order of the words in a block says nothing: every order is accepted or refused alike, and gives the same motions.

use kinetostat_program::{
    Dialect, ExpandOptions, NoSubprograms, Path, Program, ReadOptions, expand, interpret,
};
use proptest::prelude::*;
use proptest::sample::{select, subsequence};

/// Words that a block may have, each with numbers that fit some of the codes.
const WORDS: &[&str] = &[
    "G0", "G1", "G2", "G3", "G4", "G10", "G17", "G18", "G20", "G28", "G40", "G43", "G49", "G53",
    "G52", "G54", "G55", "G5", "G33.1", "G41", "G42", "G43.1", "G51", "G69", "G76", "G84", "G86",
    "G92.1", "M98", "M66", "M30", "M29", "B5", "V2", "W1", "X4", "K2", "P2", "G61", "G64", "G68",
    "G73", "G80", "G81", "G82", "G83", "G89", "G90", "G91", "G92", "G93", "G94", "G95", "G98",
    "G99", "M0", "M3", "M4", "M5", "M6", "M8", "M9", "X4", "X-3", "Y2", "Y7", "Z-1", "Z5", "I2",
    "J-2.5", "K1", "R1", "R6", "P1", "P-1", "P0", "Q1", "Q0", "L2", "L0", "H1", "D1", "F300", "F0",
    "S500", "T1", "A10", "U1", "E2",
];

/// Words of programs that are run once.
const OF_MACROS: &[&str] = &[
    "@[2 + 1]",
    "^30",
    "G#1",
    "X[#1 + 1]",
    "Y#1",
    "P#1",
    "#1 = 3",
    "#2 = [#1 * 2]",
    "(said)",
];

/// What stands before the block: other modes.
const BEFORE: &[&str] = &[
    "",
    "G1 X2",
    "G2 X3 I1",
    "G91",
    "G98 G81 X2 Z-1 R1",
    "G99 G82 X2 Z-1 R1 P1",
    "G80",
    "G18",
    "G93 G1 X2 F5",
    "M3 S100",
    "G90.1",
    "G68 X0 Y0 R30",
    "G51 X0 Y0 Z0 P2",
    "G41 D1 G1 X2",
    "G33.1 Z2 K1 S10",
    "G92 X5",
];

fn program(before: &str, words: &[&str]) -> String {
    format!(
        "G21 G90 G17 G94 F200\n#1 = 1\nG0 X1 Y2 Z3\n{before}\n{}\nG80 G90 G94 G0 X9 Y9 Z9\nM2\n",
        words.join(" ")
    )
}

/// The motions of a path, where they go and how.
fn motions(path: &Path) -> Vec<String> {
    let say = |motion: &kinetostat_program::Move| {
        format!(
            "{:?} {:?} {:?} {:?} {:?} {:?} {:?}",
            motion.kind,
            motion.known,
            motion.start,
            motion.end,
            motion.curve,
            motion.feed,
            motion.extra
        )
    };
    path.moves.iter().map(say).collect()
}

fn read(text: &str) -> Option<Vec<String>> {
    let program = Program::read(text.replace("#1 = 1\n", "")).ok()?;
    let path = interpret(&program, &ReadOptions::default()).ok()?;
    let pauses = format!("{:?}", path.pauses);
    let mut all = motions(&path);
    all.push(pauses);
    Some(all)
}

fn flat(text: &str, dialect: Dialect) -> Option<Vec<String>> {
    let mut options = ExpandOptions::default();
    options.dialect = dialect;
    options.tool_diameters_mm.insert(1, 1.0);
    let done = expand(text, &options, &NoSubprograms).ok()?;
    Some(motions(&done.path))
}

fn block(words: &'static [&'static str]) -> impl Strategy<Value = Vec<&'static str>> {
    subsequence(words, 1..7)
}

fn shuffled(
    words: Vec<&'static str>,
) -> impl Strategy<Value = (Vec<&'static str>, Vec<&'static str>)> {
    (Just(words.clone()), Just(words).prop_shuffle())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5000))]

    #[test]
    fn any_order_of_words_reads_alike(
        (one, other) in block(WORDS).prop_flat_map(shuffled),
        before in select(BEFORE),
    ) {
        let [a, b] = [&one, &other].map(|words| program(before, words));
        prop_assert_eq!(read(&a), read(&b), "{}\n{}", a, b);
    }

    #[test]
    fn any_order_of_words_is_written_flat_alike(
        (one, other) in (block(WORDS), subsequence(OF_MACROS, 0..3))
            .prop_flat_map(|(words, more)| shuffled([words, more].concat())),
        before in select(BEFORE),
        dialect in select(&[Dialect::LinuxCnc, Dialect::Fanuc, Dialect::Undecided][..]),
    ) {
        // Of G90 and G91 the last one holds on Fanuc.
        prop_assume!(dialect != Dialect::Fanuc || !(one.contains(&"G90") && one.contains(&"G91")));
        // Fanuc assigns where the assignment stands, LinuxCNC behind the block.
        let fits = |word: &&&str| dialect == Dialect::LinuxCnc || !word.contains('=');
        let [a, b] = [&one, &other].map(|words| {
            let words: Vec<&str> = words.iter().filter(fits).copied().collect();
            program(before, &words)
        });
        prop_assert_eq!(flat(&a, dialect), flat(&b, dialect), "{:?}\n{}\n{}", dialect, a, b);
    }
}
