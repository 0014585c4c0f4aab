//! Endings of written programs: that of another language is refused before the run, whatever command writes.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use crate::common::{contents, run, workplace};

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

const POSES: &str = "x_mm,y_mm,z_mm,a_kuka_deg,b_kuka_deg,c_kuka_deg\n0,0,100,0,0,180\n";

#[test]
fn the_ending_of_another_language_is_refused_before_the_run() {
    for (line, needles) in [
        (
            "compensate job.toml --out x.src",
            [
                ".src is the ending of another language",
                "the compensated program is G-code: name it 'x.ngc'",
            ],
        ),
        (
            "compensate job.toml --out x.CSV",
            [".CSV is the ending", "name it 'x.ngc'"],
        ),
        (
            "compensate job.toml --expand --flat-program flat.mod",
            [
                "'flat.mod'",
                "the flat program is G-code: name it 'flat.ngc'",
            ],
        ),
        (
            "compensate job.toml --no-compensation --out x.apt",
            ["'x.apt'", "name it 'x.ngc'"],
        ),
        (
            "expand part.ngc --out flat.h",
            ["'flat.h'", "the flat program is G-code: name it 'flat.ngc'"],
        ),
        (
            "convert part.ngc --to krl --out x.ngc --tool-orientation a_b_c_kuka_deg=0,0,180",
            ["'x.ngc'", "the made program is KRL: name it 'x.src'"],
        ),
        (
            "convert part.ngc --to csv --out x.parquet --tool-orientation a_b_c_kuka_deg=0,0,180",
            [
                "'x.parquet'",
                "the made program is a table as text: name it 'x.csv'",
            ],
        ),
        (
            "convert part.ngc --to krl --expand --flat-program f.src --out x.src",
            ["'f.src'", "the flat program is G-code: name it 'f.ngc'"],
        ),
        (
            "compensate --model heavy_6r --weight all --program poses.csv --force 0 0 -100 --tool-length-mm 0 --out x.yaml",
            ["'x.yaml'", "a table as text: name it 'x.csv'"],
        ),
        (
            "compensate --model heavy_6r --weight all --program poses.csv --force 0 0 -100 --tool-length-mm 0 --out x.parquet",
            ["'x.parquet'", "name it 'x.csv'"],
        ),
        (
            "check named.toml",
            [
                "'out.src'",
                "the compensated program is G-code: name it 'out.ngc'",
            ],
        ),
    ] {
        let here = workplace();
        let job = std::fs::read_to_string(here.path().join("job.toml")).unwrap();
        std::fs::write(
            here.path().join("named.toml"),
            job.replace("out.ngc", "out.src"),
        )
        .unwrap();
        std::fs::write(here.path().join("poses.csv"), POSES).unwrap();
        let before = contents(here.path());
        let said = run(here.path(), &words(line));
        assert_eq!(said.code, 1, "{line}: {said:?}");
        let text = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        for needle in needles {
            assert!(text.contains(needle), "{line}: {needle}: {text}");
        }
        assert_eq!(contents(here.path()), before, "{line}");
    }
}

#[test]
fn an_ending_that_is_no_languages_and_that_of_the_source_stay_allowed() {
    for (line, out) in [
        ("compensate job.toml --out x.txt", "x.txt"),
        ("compensate job.toml --out x.NC", "x.NC"),
        ("compensate job.toml --out x", "x"),
        (
            "compensate job.toml --program part.sub --out y.sub",
            "y.sub",
        ),
        ("expand part.sub --out y.sub", "y.sub"),
        ("expand part.ngc --out flat.eia", "flat.eia"),
        (
            "convert part.ngc --to krl --out x.txt --tool-orientation a_b_c_kuka_deg=0,0,180",
            "x.txt",
        ),
    ] {
        let here = workplace();
        std::fs::copy(here.path().join("part.ngc"), here.path().join("part.sub")).unwrap();
        run(here.path(), &words(line)).answered();
        assert!(here.path().join(out).is_file(), "{line}");
    }
}
