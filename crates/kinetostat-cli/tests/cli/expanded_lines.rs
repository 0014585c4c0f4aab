//! Programs that are run once and written flat: messages, tables and JSON name the lines of the files that the user has.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use serde_json::Value;

use crate::common::run;

/// A program of each language with a loop and a subprogram in a file of its own, `{own}` in the one and `{called}` in the other.
struct Source {
    main: &'static str,
    text: &'static str,
    called: &'static str,
    text_called: &'static str,
    /// A motion that no model of three axes follows, and one out of reach.
    other_axis: &'static str,
    far: &'static str,
    /// Two short moves.
    short: &'static str,
}

const SOURCES: [Source; 3] = [
    Source {
        main: "a.ngc",
        text: "G21 G90 G17\n#1 = 0\nG0 X0 Y0 Z5\nO1 while [#1 LT 3]\nG1 Z-1 F300\n{own}O<slot> call [#1]\nG0 Z5\n#1 = [#1 + 1]\nO1 endwhile\nM2\n",
        called: "slot.ngc",
        text_called: "O<slot> sub\nG1 X[10 * #1] Y20\n{called}G1 Y5\nO<slot> endsub\n",
        other_axis: "G1 A10\n",
        far: "G1 X2000\n",
        short: "G1 X3.0001\nG1 X3.0002\n",
    },
    Source {
        main: "a.mpf",
        text: "G90 G71 G94 G17 G54\nR1=0\nG0 X0 Y0 Z5\nAA:\nG1 Z-1 F300\n{own}SLOT\nG0 Z5\nR1=R1+1\nIF R1<3 GOTOB AA\nM30\n",
        called: "SLOT.SPF",
        text_called: ";slot\nG1 X=10*R1 Y5\n{called}G1 Y7\nM17\n",
        other_axis: "G1 B10\n",
        far: "G1 X2000\n",
        short: "G1 X3.0001\nG1 X3.0002\n",
    },
    Source {
        main: "a.h",
        text: "BEGIN PGM A MM\nFN 0: Q1 = +0\nL X+0 Y+0 Z+5 R0 FMAX\nLBL 1\nL Z-1 F300\n{own}CALL PGM SLOT.H\nL Z+5 FMAX\nFN 1: Q1 = +Q1 + +10\nCALL LBL 1 REP 2\nM30\nEND PGM A MM\n",
        called: "SLOT.H",
        text_called: "BEGIN PGM SLOT MM\nL X+Q1 Y+15\n{called}L Y+3\nEND PGM SLOT MM\n",
        other_axis: "L B+10\n",
        far: "L X+2000\n",
        short: "L X+3.0001\nL X+3.0002\n",
    },
];

const JOB: &str = "schema = 1\nmodel = \"orthoglide\"\nprogram = \"{main}\"\n\n[placement]\npart_origin_mm = [0, 0, 0]\n\n[tool]\nlength_mm = 0\n\n[load]\nforce_n = [0, 0, 100]\n\n[tolerances]\nmin_block_mm = 0.5\n\n[expand]\n{expand}\n[output]\nprogram = \"out-{main}\"\npoints = \"points.csv\"\njson = \"out.json\"\n";

impl Source {
    fn put(&self, here: &Path, [own, called]: [&str; 2], expand: &str) {
        let put = |name: &str, text: String| std::fs::write(here.join(name), text).unwrap();
        put(self.main, self.text.replace("{own}", own));
        put(self.called, self.text_called.replace("{called}", called));
        let job = JOB.replace("{main}", self.main).replace("{expand}", expand);
        put("job.toml", job);
    }
}

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

fn one_line(text: &str) -> String {
    words(text).join(" ")
}

/// Numbers of lines in a text that no file stands beside: neither `line 3 of a.ngc`, nor `a.ngc, line 3`, nor listed below.
fn without_file(text: &str) -> Vec<String> {
    let text = one_line(text);
    let mut found = Vec::new();
    for word in ["line ", "lines "] {
        for (at, _) in text.match_indices(word) {
            let behind = &text[at + word.len()..];
            let list = behind.trim_start_matches(|c: char| c.is_ascii_digit() || ", ".contains(c));
            let list = match list.strip_prefix("and ") {
                Some(rest) => rest
                    .trim_start_matches(|c: char| c.is_ascii_digit())
                    .trim_start(),
                None => list,
            };
            let number: String = behind.chars().take_while(char::is_ascii_digit).collect();
            let is_word = !text[..at].ends_with(|c: char| c.is_alphanumeric());
            let of_file =
                list.starts_with("of ") || text[..at].ends_with(", ") || text[..at].ends_with(": ");
            let listed = text.contains(&format!("line {number} line "));
            if is_word && !number.is_empty() && !of_file && !listed {
                found.push(text[at.saturating_sub(60)..text.len().min(at + 60)].to_owned());
            }
        }
    }
    found
}

#[test]
fn refusals_and_notes_name_lines_of_the_files() {
    for source in &SOURCES {
        for in_called in [false, true] {
            let here = tempfile::tempdir().unwrap();
            let here = here.path();
            let at = |text: &'static str| match in_called {
                true => ["", text],
                false => [text, ""],
            };
            // The line is the sixth of the program, or the third of the subprogram.
            let line = match in_called {
                true => format!("3 of {}", source.called),
                false => format!("6 of {}", source.main),
            };
            for (text, says) in [(source.other_axis, ""), (source.far, "no correction at")] {
                source.put(here, at(text), "");
                for command in ["compensate job.toml", "deflect job.toml"] {
                    let said = run(here, &words(command));
                    assert_ne!(said.code, 0, "{command}: {said:?}");
                    let err = one_line(&said.err);
                    let of_flat = format!("line {line} (line ");
                    assert!(
                        err.contains(&of_flat) && err.contains(says)
                            || command.starts_with("deflect"),
                        "{command}: {err}"
                    );
                    assert_eq!(
                        without_file(&said.err),
                        Vec::<String>::new(),
                        "{command}: {err}"
                    );
                    assert!(
                        !err.contains("line 6)`") && !err.contains("line 3)`"),
                        "{err}"
                    );
                }
            }
            // A robot needs to know how the tool stands: what is said of all of the template and of a line.
            source.put(here, ["", ""], "");
            // A job with a model says how it stands there.
            let job = std::fs::read_to_string(here.join("job.toml")).unwrap();
            let lines = job.lines().filter(|line| !line.starts_with("model"));
            std::fs::write(here.join("job.toml"), lines.collect::<Vec<_>>().join("\n")).unwrap();
            let said = run(
                here,
                &words("convert --job job.toml --to rapid --out P.mod"),
            );
            assert_eq!(said.code, 1, "{said:?}");
            assert!(
                one_line(&said.err).contains(&format!(
                    "line 3 of {} (line 2 of the flat program)",
                    source.main
                )),
                "{said:?}"
            );
            // Notes with a list of lines.
            source.put(here, at(source.short), "");
            let said = run(here, &words("compensate job.toml")).answered();
            assert_eq!(without_file(&said.out), Vec::<String>::new(), "{said:?}");
            let of_file = line.split(" of ").nth(1).unwrap();
            let lists = format!(" of {of_file} (lines ");
            assert!(one_line(&said.out).contains(&lists), "{said:?}");
        }
    }
}

#[test]
fn tables_and_json_say_both_lines() {
    for source in &SOURCES {
        let here = tempfile::tempdir().unwrap();
        let here = here.path();
        source.put(here, ["", source.short], "");
        run(here, &words("compensate job.toml")).answered();
        let points = std::fs::read_to_string(here.join("points.csv")).unwrap();
        let mut rows = points.lines();
        assert!(rows.next().unwrap().ends_with(",source_line,source_file"));
        let mut seen = 0;
        for row in rows {
            let mut cells = row.rsplit(',');
            let (file, line) = (cells.next().unwrap(), cells.next().unwrap());
            let text = std::fs::read_to_string(here.join(file)).unwrap();
            // Motions stand there, and nothing else.
            let block = text
                .lines()
                .nth(line.parse::<usize>().unwrap() - 1)
                .unwrap();
            assert!(
                block.starts_with('G') || block.starts_with("L "),
                "{row}: {block}"
            );
            seen += usize::from(file == source.called);
        }
        assert!(seen > 5, "{points}");
        let json = std::fs::read_to_string(here.join("out.json")).unwrap();
        let result: Value = serde_json::from_str(&json).unwrap();
        let lines = |list: &Value| {
            let all = list.as_array().unwrap().iter();
            all.filter(|one| one["line"].is_number()).count()
        };
        let sources = |list: &Value| {
            let all = list.as_array().unwrap().iter();
            all.filter(|one| one["source_line"].is_number() && one["source_file"].is_string())
                .count()
        };
        for list in ["warnings", "worst_points"] {
            assert!(lines(&result[list]) > 0, "{list}");
            assert_eq!(lines(&result[list]), sources(&result[list]), "{list}");
        }
    }
}

#[test]
fn programs_of_controls_are_converted_with_expand() {
    for source in &SOURCES[1..] {
        let here = tempfile::tempdir().unwrap();
        let here = here.path();
        source.put(here, ["", ""], "comments = true");
        // On the command line, and in the job.
        let line = format!("convert {} --expand --to gcode --out one.nc", source.main);
        run(here, &words(&line)).answered();
        let line = "convert --job job.toml --to gcode --out two.nc --flat-program flat.{end}";
        let end = source.main.rsplit('.').next().unwrap();
        run(here, &words(&line.replace("{end}", end))).answered();
        let [one, two] = ["one.nc", "two.nc"].map(|name| {
            let text = std::fs::read_to_string(here.join(name)).unwrap();
            text.replace("one", "").replace("two", "")
        });
        assert_eq!(one, two);
        // A run has the comments that the job asks for, in which nothing moves.
        run(here, &words("compensate job.toml")).answered();
        let flat = std::fs::read_to_string(here.join("flat").join(source.main)).unwrap();
        assert!(
            flat.contains(" ;line 3\n") && flat.contains(&format!(";{}, line 2\n", source.called)),
            "{flat}"
        );
        // Stated by the user, where it means nothing.
        let command = format!(
            "convert {} --expand --no-comments --to gcode --out three.nc",
            source.main
        );
        let said = run(here, &words(&command));
        assert!(
            said.code == 1 && said.err.contains("--no-comments is for"),
            "{said:?}"
        );
        // Every block of what is written flat says its line, unless that is not wanted.
        let shown = |more: &str| {
            let line = format!("expand {}{more}", source.main);
            run(here, &words(&line)).answered().out
        };
        let (with, without) = (shown(""), shown(" --no-comments"));
        assert!(
            with.contains(" ;line 3\n") && with.contains(&format!(";{}, line 2\n", source.called)),
            "{with}"
        );
        let bare: Vec<&str> = with
            .lines()
            .map(|l| l.split(" ;").next().unwrap())
            .collect();
        let plain: Vec<&str> = without
            .lines()
            .map(|l| l.split(" ;").next().unwrap())
            .collect();
        assert_eq!(bare, plain);
        assert!(!without.contains(" ;line 3\n"), "{without}");
    }
}

/// What is quoted of a faulty line is what stands in the file, not the numbers of the flat block.
#[test]
fn excerpts_are_those_of_the_files() {
    let source = SOURCES.iter().find(|own| own.main == "a.h").unwrap();
    for (at, line) in [
        (["L X+Q1 RL\n", ""], "6 of a.h"),
        (["", "L X+Q1 RL\n"], "3 of SLOT.H"),
    ] {
        let here = tempfile::tempdir().unwrap();
        let here = here.path();
        source.put(here, at, "");
        let said = run(here, &words("compensate job.toml"));
        assert_eq!(said.code, 1, "{said:?}");
        let err = one_line(&said.err);
        assert!(err.contains(&format!("line {line} (line ")), "{err}");
        assert!(
            err.contains(": `L X+Q1 RL`: ") && !err.contains("`L X+0"),
            "{err}"
        );
    }
}
