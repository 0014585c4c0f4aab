//! `kinetostat expand`: programs with macros as plain blocks, from files to files.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use crate::common::{contents, run};

const MACRO: &str = "G21 G90\nS1000 M3\n#1 = 0\nO1 while [#1 LT 2]\nO<hole> call [10 * #1] [#100]\n#1 = [#1 + 1]\nO1 endwhile\nM2\n";
const HOLE: &str = "O<hole> sub\nG0 X#1 Y0 Z5\nG99 G81 X#1 Z-#2 R1 F100\nG80\nO<hole> endsub\n";

#[test]
fn a_program_is_written_flat_and_compensated() {
    let here = tempfile::tempdir().unwrap();
    std::fs::write(here.path().join("part.ngc"), MACRO).unwrap();
    std::fs::create_dir(here.path().join("macros")).unwrap();
    std::fs::write(here.path().join("macros/hole.ngc"), HOLE).unwrap();
    let words = "expand part.ngc --subprograms macros --parameter 100=3 --no-comments";
    let said = run(here.path(), &words.split(' ').collect::<Vec<_>>());
    assert_eq!(said.code, 0, "{said:?}");
    let hole = |x: &str| format!("G0 X{x} Y0 Z5\nG99 F100\nG0 Z1\nG1 Z-3\nG0 Z1\nG80\n");
    assert_eq!(
        said.out,
        format!("G21 G90\nS1000 M3\n{}{}M2\n", hole("0"), hole("10"))
    );
    let words = "expand part.ngc --subprograms macros --parameter 100=3 --out flat.ngc";
    let said = run(here.path(), &words.split(' ').collect::<Vec<_>>());
    assert_eq!(said.code, 0, "{said:?}");
    let flat = std::fs::read_to_string(here.path().join("flat.ngc")).unwrap();
    assert!(flat.contains("G1 Z-3 (hole, line 3)\n"), "{flat}");
    let job = "schema = 1\nmodel = \"orthoglide\"\nprogram = \"flat.ngc\"\n[placement]\npart_origin_mm = [0, 0, 100]\n[load]\nforce_n = [10, 0, 0]\n[output]\nprogram = \"out.ngc\"\n";
    std::fs::write(here.path().join("job.toml"), job).unwrap();
    run(here.path(), &["compensate", "job.toml"]).answered();
}

#[test]
fn what_cannot_be_run_is_named_and_nothing_is_written() {
    let here = tempfile::tempdir().unwrap();
    std::fs::write(here.path().join("part.ngc"), MACRO).unwrap();
    for (more, needle) in [
        ("", "line 5: `O<hole> call"),
        ("--parameter 100", "there is no ="),
        (
            "--tool-diameter-mm 1=6 --tool-diameter-mm 1=8",
            "comes twice",
        ),
        ("--out part.ngc --force-overwrite", "part.ngc"),
    ] {
        let words = format!("expand part.ngc --out flat.ngc {more}")
            .replace("--out flat.ngc --out", "--out");
        let said = run(here.path(), &words.split_whitespace().collect::<Vec<_>>());
        assert_eq!(said.code, 1, "{said:?}");
        assert!(said.err.contains(needle), "{needle}: {said:?}");
        let names: Vec<_> = contents(here.path()).into_keys().collect();
        assert_eq!(names.len(), 1, "{names:?}");
    }
}

#[test]
fn the_line_endings_of_the_file_stay() {
    let here = tempfile::tempdir().unwrap();
    std::fs::write(here.path().join("part.ngc"), MACRO.replace('\n', "\r\n")).unwrap();
    std::fs::write(here.path().join("hole.ngc"), HOLE).unwrap();
    let said = run(here.path(), &["expand", "part.ngc", "--parameter", "100=3"]).answered();
    let lines: Vec<&str> = said.out.split_inclusive('\n').collect();
    assert!(lines.len() > 10, "{said:?}");
    assert!(lines.iter().all(|line| line.ends_with("\r\n")), "{said:?}");
}

/// A program without an end is run once for its fault, and the fault of a job file is found with it, not because of it.
#[test]
fn a_fault_of_the_program_is_said_once_in_a_job_too() {
    let here = tempfile::tempdir().unwrap();
    let endless =
        "G21 G90\nG0 X0 Y0 Z0\nO1 while [1]\nO2 repeat [0]\nO2 endrepeat\nO1 endwhile\nM2\n";
    std::fs::write(here.path().join("part.ngc"), endless).unwrap();
    let job = "schema = 1\nmodel = \"orthoglide\"\nprogram = \"part.ngc\"\n[expand]\n[load]\nforce_n = [1, 0, 0]\n";
    for (job, others) in [(job.to_owned(), 0), (job.replace("[1, 0, 0]", "[1, 0]"), 1)] {
        std::fs::write(here.path().join("job.toml"), job).unwrap();
        let said = run(here.path(), &["compensate", "job.toml"]);
        assert_eq!(said.code, 1, "{said:?}");
        let ends = said.err.matches("does not end").count();
        assert_eq!(ends, 1 - others, "{said:?}");
        assert_eq!(said.err.matches("3 values").count(), others, "{said:?}");
    }
}

/// Main program and subprogram of a control, with the flat text and the names of the files.
const CONTROLS: [(&str, &str, &str, &str, &str); 2] = [
    (
        "main.mpf",
        "G0 X0 Y0 Z5\nHOLE(3)\nM30\n",
        "Hole.spf",
        "PROC HOLE(REAL DEPTH)\nG1 Z=-DEPTH F100\nG0 Z5\nRET\n",
        "G0 X0 Y0 Z5\nG1 Z=-3 F100\nG0 Z5\nM30\n",
    ),
    (
        "MAIN.H",
        "BEGIN PGM MAIN MM\nL X+0 Y+0 Z+5 FMAX\nCALL PGM TNC:\\HOLES\\HOLE.H\nEND PGM MAIN MM\n",
        "hole.h",
        "BEGIN PGM HOLE MM\nL Z-3 F100\nL Z+5 FMAX\nEND PGM HOLE MM\n",
        "BEGIN PGM MAIN MM\nL X+0 Y+0 Z+5 FMAX\nL Z-3 F100\nL Z+5 FMAX\nEND PGM MAIN MM\n",
    ),
];

#[test]
fn programs_of_controls_find_their_subprograms_in_folders() {
    for (main, text, name, subprogram, flat) in CONTROLS {
        let here = tempfile::tempdir().unwrap();
        std::fs::write(here.path().join(main), text).unwrap();
        let expand = |more: &[&str]| {
            run(
                here.path(),
                &[&["expand", main, "--no-comments"][..], more].concat(),
            )
        };
        let said = expand(&[]);
        assert_eq!(said.code, 0, "{said:?}");
        assert!(said.err.contains("in none of the files"), "{said:?}");
        assert!(said.err.contains("line "), "{said:?}");
        std::fs::create_dir(here.path().join("parts")).unwrap();
        std::fs::write(here.path().join("parts").join(name), subprogram).unwrap();
        let said = expand(&["--subprograms", "parts"]);
        assert_eq!((said.code, said.out.as_str()), (0, flat), "{said:?}");
        // The folder of the program is one, too; what is read is never overwritten.
        std::fs::write(here.path().join(name), subprogram).unwrap();
        let said = expand(&[]);
        assert_eq!((said.code, said.out.as_str()), (0, flat), "{said:?}");
        let said = expand(&["--out", name, "--force-overwrite"]);
        assert_eq!(said.code, 1, "{said:?}");
        assert_eq!(
            std::fs::read_to_string(here.path().join(name)).unwrap(),
            subprogram
        );
        // Another one of the same name is not left out in silence.
        let other = subprogram.replace("F100", "F200");
        std::fs::write(here.path().join("parts").join(name), other).unwrap();
        let said = expand(&["--subprograms", "parts"]);
        assert_eq!(said.code, 1, "{said:?}");
        let both = [
            format!("{name}', line 1, and 'parts/{name}', line 1"),
            "rename one".to_owned(),
        ];
        assert!(both.iter().all(|part| said.err.contains(part)), "{said:?}");
        let said = expand(&["--subprograms", "nowhere"]);
        assert!(
            said.err.contains("--subprograms: 'nowhere' is no folder"),
            "{said:?}"
        );
        let said = expand(&["--parameter", "1=2"]);
        assert!(
            said.err.contains("--parameter is for programs in G-code"),
            "{said:?}"
        );
    }
}
