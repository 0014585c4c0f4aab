//! All faults of a program that is run once: each once, none because of another.

use kinetostat_program::*;

struct File;

impl Subprograms for File {
    fn find(&self, name: &str) -> Option<Vec<u8>> {
        let text = "O100\nG38.2 Z-1\nG1 X2 F100\nG33 Z1 K1\nM99\n";
        (name == "100").then(|| text.as_bytes().to_vec())
    }
}

fn lines_in(text: &str, dialect: Dialect) -> Vec<usize> {
    let mut options = ExpandOptions::default();
    options.dialect = dialect;
    let found = expansion_faults(text, &options, &NoSubprograms);
    let lines = found.iter().map(|fault| fault.line).collect();
    let first = expand(text, &options, &NoSubprograms).err();
    // The first line that the run refuses is one of them, for the same reason.
    match &first {
        None => assert!(found.is_empty(), "{found:?}"),
        Some(first) => assert!(
            found
                .iter()
                .any(|fault| (fault.line, &fault.reason) == (first.line, &first.reason)),
            "{first:?}: {found:?}"
        ),
    }
    lines
}

#[test]
fn lines_behind_a_refused_one_are_run() {
    let cases: [(&str, &[usize]); 8] = [
        (
            "G38.2 Z-10\nG1 X5 X6 F100\nG1 X7\nG33 Z1 K1\nM2",
            &[3, 4, 6],
        ),
        // The arc begins where the refused line ends.
        ("G41 D1 G1 X10 F100\nG3 X20 Y10 J10\nG38.2 Z1\nM2", &[3, 5]),
        // Where the tool is behind a call nobody knows, until the program states it.
        (
            "M98 P77\nG2 X20 Y0 I7 F100\nG1 X0 Y0\nG2 X10 Y0 I4\nM98 P78\nM2",
            &[3, 6, 7],
        ),
        ("O<a> call\nO<b> call [1]\nM2", &[3, 4]),
        ("G1 X[1/0] F100\nX[SQRT[-1]] Y5\nX4\nM2", &[3, 4]),
        // Each line once, however often it is run.
        (
            "#1=3\nO1 while [#1 GT 0]\n#1=[#1-1]\nG1 X#1 X2 F100\nO1 endwhile\nG33 Z1 K1\nM2",
            &[6, 8],
        ),
        // What is behind the end is not run.
        ("G38.2 Z-10\nM2\nG38.2 Z-10", &[3]),
        ("G1 X5 F100\nM2", &[]),
    ];
    for (text, expected) in cases {
        let text = format!("G21 G90 G17\nG0 X0 Y0 Z5\n{text}\n");
        assert_eq!(lines_in(&text, Dialect::LinuxCnc), expected, "{text}");
    }
}

#[test]
fn a_line_on_which_the_rest_depends_ends_the_list_and_says_so() {
    let rest = [
        "O1 if [1/0]\nG38.2 Z-1\nO1 endif",
        "#1=[1/0]\nG38.2 Z-1",
        "O1 whale [1]\nG38.2 Z-1\nO1 endwhile",
        "O1 while [0]\nG38.2 Z-1",
        "#1=\nG38.2 Z-1",
        "N20 IF [1 GOTO 3\nG38.2 Z-1",
    ];
    for text in rest {
        let text = format!("G21 G90\nG38.2 Z-5\n{text}\nM2\n");
        let found = expansion_faults(text.as_str(), &ExpandOptions::default(), &NoSubprograms);
        let lines: Vec<usize> = found.iter().map(|fault| fault.line).collect();
        assert_eq!(lines, [2, 3], "{text}");
        assert!(found[1].remedy.contains("were not run"), "{}", found[1]);
        assert!(!found[0].remedy.contains("were not run"), "{}", found[0]);
    }
}

#[test]
fn faults_of_subprograms_stand_behind_those_of_the_program() {
    let text = "G21 G90\nG0 X0 Y0 Z5\nM98 P100\nG1 X5 X6 F100\nM98 P100\nM2\n";
    let found = expansion_faults(text, &ExpandOptions::default(), &File);
    let said: Vec<(usize, bool)> = found
        .iter()
        .map(|fault| (fault.line, fault.reason.contains("in the subprogram '100'")))
        .collect();
    assert_eq!(said, [(4, false), (2, true), (4, true)]);
}

#[test]
fn what_is_quoted_stands_in_the_file() {
    let mut options = ExpandOptions::default();
    options.origin_comments = OriginComments::Written;
    let text = "G21 G90\nG0 X0 Y0 Z5\nG1 X5 X6 F100 (here)\nG38.2 Z1\nM2\n";
    for fault in expansion_faults(text, &options, &NoSubprograms) {
        assert!(text.contains(&fault.found), "{fault}");
    }
}

#[test]
fn programs_without_an_end_are_bounded() {
    let mut options = ExpandOptions::default();
    options.most_blocks = 1000;
    for text in [
        "G21 G90\nG38.2 Z1\nO1 while [1]\nG38.2 Z2\nO1 endwhile\nM2\n",
        "G21 G90\nG38.2 Z1\nN10 G38.2 Z2\nGOTO 10\nM2\n",
        "G21 G90\nG38.2 Z1\nO1 sub\nG38.2 Z1\nO1 call\nO1 endsub\nO1 call\nM2\n",
    ] {
        let found = expansion_faults(text, &options, &NoSubprograms);
        assert!((2..=4).contains(&found.len()), "{text}: {found:?}");
    }
}

/// A library that counts how often it is asked.
#[derive(Default)]
struct Counted(std::cell::Cell<usize>);

impl Subprograms for Counted {
    fn find(&self, name: &str) -> Option<Vec<u8>> {
        self.0.set(self.0.get() + 1);
        File.find(name)
    }
}

#[test]
fn one_run_gives_the_program_or_all_its_faults() {
    let options = ExpandOptions::default();
    let (refused, library) = ("G21 G90\nG0 X0\nM98 P100\nM2\n", Counted::default());
    let found = expand_or_faults(refused, &options, &library).unwrap_err();
    assert_eq!(found, expansion_faults(refused, &options, &File));
    assert_eq!(library.0.get(), 1);
    // Without an end.
    let endless = "G21 G90\nO1 while [1]\nO2 repeat [0]\nO2 endrepeat\nO1 endwhile\nM2\n";
    let found = expand_or_faults(endless, &options, &NoSubprograms).unwrap_err();
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].reason.contains("does not end"), "{found:?}");
}

/// Lines of the file keep their ending, those of a subprogram take it.
#[test]
fn the_flat_program_ends_its_lines_as_the_file_does() {
    let text =
        "G21 G90\n#1 = 2\nO1 repeat [2]\nG0 X#1 Y0\nO1 endrepeat\nM98 P5\nM2\nO5\nG0 Z5\nM99\n";
    let options = ExpandOptions::default();
    let flat = |text: &str| {
        let made = expand(text, &options, &NoSubprograms).unwrap();
        String::from_utf8(made.program.bytes().to_vec()).unwrap()
    };
    let plain = flat(text);
    assert!(
        plain.lines().count() == 5 && !plain.contains('\r'),
        "{plain}"
    );
    for ending in ["\r\n", "\r"] {
        assert_eq!(
            flat(&text.replace('\n', ending)),
            plain.replace('\n', ending)
        );
    }
    assert_eq!(flat("G21 G90 G0 X1"), "G21 G90 G0 X1\n");
}
