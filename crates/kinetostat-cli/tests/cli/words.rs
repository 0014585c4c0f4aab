//! Words: all faults of a job at once, messages that name their option, examples that can be copied.

use crate::common::{JOB, command, contents, run, shell, workplace};

fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A whole job with many keys, so that much can be wrong in it.
fn job() -> String {
    format!(
        "{JOB}report = \"report.html\"\n\n[reading]\narc_tolerance_mm = 0.01\n\n[tolerances]\npath_um = 0.5\ndecimals = 4\n"
    )
}

/// What is written, what goes there instead, a word of the message.
const FAULTS: [(&str, &str, &str); 17] = [
    ("schema = 1", "schema = 7", "version 7"),
    ("schema = 1\n", "", "'schema' is missing"),
    ("\"orthoglide\"", "\"orthoglid\"", "orthoglid"),
    ("\"part.ngc\"", "\"absent.ngc\"", "absent.ngc"),
    ("[0, 0, 100]", "[0, 0]", "3 values are needed"),
    ("[0, 0, 100]", "[0, 0, nan]", "no finite number"),
    (
        "length_mm = 100",
        "length = 100",
        "write the unit in the key",
    ),
    (
        "length_mm = 100",
        "length_mm = \"100\"",
        "a number is needed",
    ),
    ("radial_n = 215, ", "", "'radial_n' is missing"),
    (
        "program = \"out.ngc\"",
        "program = \"../out.ngc\"",
        "outside the job's directory",
    ),
    (
        "report = \"report.html\"",
        "reprot = \"report.html\"",
        "did you mean 'report'?",
    ),
    (
        "arc_tolerance_mm = 0.01",
        "arc_tolerance_mm = -1",
        "0.000001 to 2 mm are allowed",
    ),
    (
        "arc_tolerance_mm = 0.01",
        "arc_tolerance_mm = 50",
        "controllers take arcs",
    ),
    ("schema = 1\n", "schema = 1.0\n", "a whole number is needed"),
    (
        "tangential_n = -10",
        "tangential_n = nan",
        "no finite number",
    ),
    ("path_um = 0.5", "path_um = 0", "0.001 to 10000"),
    ("decimals = 4", "decimals = 40", "3 to 8 decimals"),
];

#[test]
fn all_faults_of_a_job_are_shown_in_one_run_in_the_order_of_lines() {
    let here = workplace();
    let good = job();
    let check = |faults: &[(&str, &str, &str)]| {
        let bad = faults.iter().fold(good.clone(), |text, (from, to, _)| {
            assert!(text.contains(from), "{from}: {text}");
            text.replacen(from, to, 1)
        });
        std::fs::write(here.path().join("job.toml"), &bad).expect("a job");
        for command in ["compensate job.toml", "deflect job.toml", "check job.toml"] {
            let words: Vec<&str> = command.split(' ').collect();
            let said = run(here.path(), &words);
            assert_eq!(said.code, 1, "{command}: {said:?}\n{bad}");
            let text = flat(&said.err);
            for (_, _, word) in faults {
                assert!(
                    text.contains(word),
                    "{command}: {word} is missing\n{}\n{bad}",
                    said.err
                );
            }
            assert_eq!(
                said.err.matches("error: ").count(),
                faults.len(),
                "{command}:\n{}\n{bad}",
                said.err
            );
            // `--> job.toml:LINE:COLUMN`
            let lines: Vec<usize> = said
                .err
                .split("job.toml:")
                .skip(1)
                .filter_map(|rest| rest.split(':').next()?.parse().ok())
                .collect();
            assert!(lines.is_sorted(), "{lines:?}\n{}", said.err);
        }
    };
    // Every two; the file is read in milliseconds.
    for (i, one) in FAULTS.iter().enumerate() {
        for other in &FAULTS[i + 1..] {
            if good.find(one.0) != good.find(other.0) {
                check(&[*one, *other]);
            }
        }
    }
    let mut places = std::collections::BTreeSet::new();
    let many: Vec<_> = FAULTS
        .into_iter()
        .filter(|fault| places.insert(good.find(fault.0)))
        .collect();
    assert_eq!(many.len(), 12);
    check(&many);
}

/// A model that is not there hides nothing: neither what else is wrong in the job, nor in the program.
#[test]
fn faults_of_a_program_are_shown_beside_those_of_its_job() {
    let here = workplace();
    let gone = job().replacen("orthoglide", "gone.toml", 1);
    std::fs::write(here.path().join("job.toml"), gone).expect("a job");
    let program = "G21 G90\nG1 X10 F100\nG2.7 X20\nG1 X30 Q\nM2\n";
    std::fs::write(here.path().join("part.ngc"), program).expect("a program");
    for command in ["compensate", "check"] {
        let said = run(here.path(), &[command, "job.toml"]);
        assert_eq!(said.code, 1, "{command}: {said:?}");
        let text = flat(&said.err);
        for word in ["gone.toml", "2 lines are refused", "G2.7", "line 4"] {
            assert!(
                text.contains(word),
                "{command}: {word} is missing\n{}",
                said.err
            );
        }
    }
}

#[test]
fn check_of_a_job_says_what_it_asks() {
    let here = workplace();
    let said = run(here.path(), &["check", "job.toml"]).answered();
    let text = flat(&said.out);
    for word in [
        "job.toml: a job",
        "Model: orthoglide",
        "part.ngc",
        "100 mm along z of the flange",
        "reaches the ends of the program",
        "out.ngc new",
        "kinetostat compensate job.toml",
    ] {
        assert!(text.contains(word), "{word}: {}", said.out);
    }
    assert!(
        said.out.lines().all(|l| l.chars().count() <= 80),
        "{}",
        said.out
    );
    assert!(!here.path().join("out.ngc").exists());
    let said = run(here.path(), &["check", "job.toml", "--json"]).answered();
    let found: serde_json::Value = serde_json::from_str(&said.out).expect("JSON");
    assert_eq!(found["schema"], 1);
    assert_eq!(found["ends"].as_array().map(Vec::len), Some(6));
    assert_eq!(
        found["program"]["largest_mm"],
        serde_json::json!([20.0, 20.0, 5.0])
    );
    assert_eq!(found["outputs"][0]["exists"], false);
    // Beside the machine.
    let far = JOB.replace("[0, 0, 100]", "[0, 0, 5000]");
    std::fs::write(here.path().join("far.toml"), far).expect("a job");
    let said = run(here.path(), &["check", "far.toml"]);
    assert_eq!(said.code, 2, "{said:?}");
    assert!(
        said.out.contains("Not reached") && said.err.contains("cannot be reached"),
        "{said:?}"
    );
}

#[test]
fn text_of_megabytes_from_a_job_is_not_echoed_whole() {
    let here = workplace();
    let long = "k".repeat(900_000);
    let spaced = "k k ".repeat(225_000);
    for text in [long, spaced] {
        for bad in [
            format!("{JOB}\"{text}\" = 1\n"),
            JOB.replace("\"orthoglide\"", &format!("\"{text}\"")),
            JOB.replace("\"part.ngc\"", &format!("\"{text}\"")),
            JOB.replace("\"out.ngc\"", &format!("\"{text}/../../x\"")),
            JOB.replace("length_mm = 100", &format!("length_mm = \"{text}\"")),
        ] {
            std::fs::write(here.path().join("job.toml"), bad).expect("a job");
            let said = run(here.path(), &["compensate", "job.toml"]);
            assert_eq!(said.code, 1, "{} bytes", said.err.len());
            assert!(said.err.len() < 30_000, "{} bytes", said.err.len());
        }
    }
}

/// A word of the command line is cut like one of a file: where it stands, what is wrong with it stays.
#[test]
fn text_of_kilobytes_from_the_command_line_is_not_echoed_whole() {
    let here = workplace();
    let long = "o".repeat(100_000);
    for (line, word) in [
        (format!("compensate --{long}"), "unexpected argument"),
        (
            format!("compensate job.toml --{long}=1"),
            "unexpected argument",
        ),
        (long.clone(), "unrecognized subcommand"),
        (format!("stiffness orthoglide --at {long} 0 0"), "--at"),
        (format!("compensate job.toml --units {long}"), "--units"),
        (format!("compensate job.toml --limit {long}=1"), "--limit"),
        (
            format!("compensate job.toml --limit correction_mm={long}"),
            "--limit",
        ),
        (
            format!("compensate job.toml --work-offset {long}"),
            "--work-offset",
        ),
        (format!("compensate job.toml --model {long}"), "model"),
        (format!("check {long}"), "ooo"),
        (format!("model show {long}"), "ooo"),
        (format!("reproduce {long}"), "ooo"),
        (format!("completions {long}"), "bash"),
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let said = run(here.path(), &words);
        assert_eq!(said.code, 1, "{}", &line[..60.min(line.len())]);
        assert!(
            said.err.len() < 3_000 && said.out.is_empty(),
            "{}: {} bytes",
            &line[..40],
            said.err.len()
        );
        assert!(said.err.contains(word), "{word}: {}", said.err);
    }
}

/// A limit that would allow nothing, or is no size, is refused where it stands, with the range.
#[test]
fn limits_out_of_their_range_are_refused_with_option_or_line() {
    let here = workplace();
    for (name, range) in [
        ("correction_mm", "0.000001 to 1000000 mm can be allowed"),
        ("own_weight_mm", "0.000001 to 1000000 mm can be allowed"),
        ("tilt_deg", "0.000001 to 180 deg can be allowed"),
        ("force_n", "0.001 to 1000000000 N can be allowed"),
        ("moment_n_m", "0.001 to 1000000000 N m can be allowed"),
        ("share_of_rating", "0.001 to 1000 can be allowed"),
        ("share_of_buckling", "0.001 to 1000 can be allowed"),
        ("blocks_per_second", "0.1 to 1000000 1/s can be allowed"),
        ("shortest_tool_mm", "-200000 to 200000 mm can be allowed"),
        ("longest_tool_mm", "-200000 to 200000 mm can be allowed"),
    ] {
        let tool = name.ends_with("tool_mm");
        let wrong: &[&str] = match tool {
            true => &["-1e6", "1e6"],
            false => &["-2", "-1", "0", "-0.0", "1e-30", "1e30"],
        };
        for value in wrong {
            let option = format!("{name}={value}");
            for command in ["compensate", "deflect"] {
                let said = run(here.path(), &[command, "job.toml", "--limit", &option]);
                assert_eq!(said.code, 1, "{option}: {said:?}");
                let text = flat(&said.err);
                assert!(
                    text.contains(&format!("--limit '{option}': {range}")),
                    "{text}"
                );
            }
            // Beside another fault of the job: both are said, in the order of lines.
            let job = JOB.replace("length_mm = 100", "lenght_mm = 100");
            let job = format!("{job}\n[limits]\n{name} = {value}\n");
            std::fs::write(here.path().join("bad.toml"), &job).expect("a job");
            for command in ["compensate", "deflect", "check"] {
                let said = run(here.path(), &[command, "bad.toml"]);
                assert_eq!(said.code, 1, "{job}: {said:?}");
                let text = flat(&said.err);
                let line = job.lines().count();
                for word in ["bad.toml:9", &format!("bad.toml:{line}"), name, range] {
                    assert!(text.contains(word), "{command} {word}: {text}");
                }
            }
        }
    }
}

#[test]
fn tiny_negative_numbers_are_numbers() {
    let here = workplace();
    let at = |x: &str, y: &str| {
        let words = ["stiffness", "orthoglide", "--at", x, y, "0", "--json"];
        run(here.path(), &words).answered().out
    };
    assert_eq!(at("-25", "-5e-12"), at("-25", "-0.000000000005"));
    assert_eq!(at("-2.5E+1", "0"), at("-25", "0"));
}

/// The job file that a help shows, cut out as it stands on a terminal of 80 columns and run; false where the help shows none.
fn the_job_of_a_help_can_be_copied(of: &str, help: &str) -> bool {
    let shown = help
        .lines()
        .skip_while(|line| *line != "A job file:")
        .skip(1);
    let job: Vec<&str> = shown
        .take_while(|line| line.is_empty() || line.starts_with("  "))
        .collect();
    let text = format!("{}\n", job.join("\n"));
    if job.is_empty() {
        assert!(!help.contains("schema ="), "{of}: {help}");
        return false;
    }
    // What a line of a comment goes on to say would have no # before it, or be cut off.
    assert!(
        text.lines().all(|line| line.chars().count() <= 80),
        "{of}: {help}"
    );
    let here = workplace();
    std::fs::write(here.path().join("shown.toml"), &text).expect("a job");
    let said = run(here.path(), &[of, "shown.toml"]);
    assert!(matches!(said.code, 0 | 4), "{of}: {}\n{text}", said.err);
    true
}

/// Every command line in every help, run as it stands where the files that it names exist.
#[test]
fn examples_in_the_help_can_be_copied() {
    let here = workplace();
    let put = |name: &str, text: &str| {
        std::fs::write(here.path().join(name), text).expect("a file");
    };
    // The names that the examples use.
    for (preset, name) in [
        ("heavy_6r", "my_robot.toml"),
        ("orthoglide", "my_machine.toml"),
    ] {
        let text = run(here.path(), &["model", "show", preset]).answered().out;
        put(name, &text);
    }
    put(
        "measured.csv",
        "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n-100,-100,-100,0,0,0\n100,-100,-100,0.01,0,0\n-100,100,-100,0,0,0\n100,100,-100,0.01,0,0\n-100,-100,100,0,0,0\n100,-100,100,0.01,0,0\n-100,100,100,0,0,0\n100,100,100,0.01,0,0\n",
    );
    put(
        "forearm.csv",
        "stiffness_n_mm_rad,x,y,z,rx,ry,rz\nx,1e5,0,0,0,0,0\ny,0,1e4,0,0,0,-1e6\nz,0,0,1e4,0,1e6,0\nrx,0,0,0,1e8,0,0\nry,0,0,1e6,0,2e8,0\nrz,0,-1e6,0,0,0,2e8\n",
    );
    put(
        "milling.toml",
        "schema = 1\nprogram = \"part.ngc\"\n[tool]\ncutter = { shape = \"flat\", diameter_mm = 6, teeth = 2 }\n[material]\nname = \"C45\"\n[stock]\nblock_mm = [[-30, -30, -5], [30, 30, 0]]\n[spindle]\nrpm = 8000\nrotation = \"clockwise\"\n",
    );
    put(
        "tools.toml",
        "[[tool]]\nnumber = 3\nshape = \"flat\"\ndiameter_mm = 12\nteeth = 4\n",
    );
    put(
        "means.csv",
        "feed_mm_per_tooth,fx_n,fy_n,fz_n\n0.05,75,-140,-24\n0.1,97,-190,-44\n0.15,119,-239,-63\n0.2,141,-291,-84\n",
    );
    let commands = [
        "",
        "compensate",
        "deflect",
        "stiffness",
        "map",
        "assemble",
        "curve",
        "equilibria",
        "force",
        "engagement",
        "check",
        "import",
        "import urdf",
        "import matrix",
        "import link-displacements",
        "reproduce",
        "model",
        "model draw",
        "model compare",
        "model show",
        "demo",
        "completions",
        "man",
    ];
    let mut examples: Vec<String> = Vec::new();
    let mut jobs = 0;
    for of in commands {
        let help = shell(here.path(), &format!("COLUMNS=80 $K {of} --help-all"))
            .answered()
            .out;
        // A longer line would be broken where nobody can copy it.
        let mut examples_of = help.lines().filter(|l| l.starts_with("  kinetostat "));
        assert!(examples_of.all(|l| l.chars().count() <= 80), "{of}: {help}");
        jobs += usize::from(the_job_of_a_help_can_be_copied(of, &help));
        let joined = help.replace("\\\n", " ");
        let found = joined
            .lines()
            .filter_map(|line| line.strip_prefix("  kinetostat "))
            .filter(|line| !line.starts_with(' '));
        for example in found {
            let example = example.split_whitespace().collect::<Vec<_>>().join(" ");
            if !examples.contains(&example) {
                examples.push(example);
            }
        }
    }
    assert!(examples.len() >= 28, "{}: {examples:#?}", examples.len());
    assert_eq!(jobs, 2);
    let mut skipped = Vec::new();
    let given: Vec<_> = contents(here.path()).into_keys().collect();
    for example in &examples {
        // Meshes of other programs are not at hand here; their reader has tests of its own.
        if ["link.sti", "link.pch"]
            .iter()
            .any(|file| example.contains(file))
        {
            skipped.push(example);
            let words = example.split_whitespace();
            let said = command(here.path()).args(words).output().expect("it runs");
            let err = flat(&String::from_utf8_lossy(&said.stderr));
            assert!(err.contains("does not exist"), "{example}: {err}");
            continue;
        }
        // It asks; its own tests answer.
        if example == "start" {
            continue;
        }
        // Outputs of the examples before: some share a name.
        for path in contents(here.path()).into_keys() {
            if path.is_file() && !given.contains(&path) {
                std::fs::remove_file(path).expect("removed");
            }
        }
        let said = shell(here.path(), &format!("$K {example}"));
        assert!(matches!(said.code, 0 | 4), "{example}\n{}", said.err);
    }
    assert_eq!(skipped.len(), 2);
}

/// Numbers inside the text of an option: each refused with the option's name.
#[test]
fn numbers_inside_texts_are_refused_with_their_option() {
    let here = workplace();
    let shown = "\n[controller]\naxis = [{ name = \"J1\", joint = \"shoulder\" }]\n";
    std::fs::write(
        here.path().join("shown.toml"),
        format!("{}{shown}", crate::common::MODEL),
    )
    .expect("a model");
    let urdf = "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent link='a'/><child link='b'/><origin xyz='0 0 1'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint></robot>";
    std::fs::write(here.path().join("r.urdf"), urdf).expect("a robot");
    let mut count = 0;
    for wrong in ["nan", "inf", "1e400", "text", "1;5", ""] {
        for (line, option) in [
            ("curve two_link --factor 0 1 --grow elbow=@,0,0", "--grow"),
            (
                "curve two_link --factor 0 1 --force 1 0 0 --load elbow=@,0,0",
                "--load",
            ),
            (
                "curve two_link --factor 0 1 --force 1 0 0 --hold y --axes a_b_c_kuka_deg=@,0,0",
                "--axes",
            ),
            (
                "equilibria two_link --force 1 0 0 --load elbow=0,@,0",
                "--load",
            ),
            (
                "compensate job.toml --work-offset G54=@,0,0",
                "--work-offset",
            ),
            ("compensate job.toml --limit correction_mm=@", "--limit"),
            (
                "compensate job.toml --part-orientation a_b_c_kuka_deg=0,@,0",
                "--part-orientation",
            ),
            (
                "compensate job.toml --tool-orientation a_b_c_kuka_deg=0,0,@",
                "--tool-orientation",
            ),
            (
                "stiffness orthoglide --rotation a_b_c_kuka_deg=@,0,0",
                "--rotation",
            ),
            (
                "map orthoglide --x 0 1 2 --rotation a_b_c_kuka_deg=@,0,0",
                "--rotation",
            ),
            (
                "map orthoglide --x 0 1 2 --y 0 1 2 --z 0 1 2 --plot p.svg --section z=@",
                "--section",
            ),
            ("modes heavy_6r --viscous axis=@", "--viscous"),
            (
                "plan-measurement heavy_6r --pull-n 1000 --force 1 0 0 --work J1=@",
                "--work",
            ),
            ("stiffness model.toml --joints shoulder=@", "--joints"),
            ("stiffness shown.toml --controller J1=@", "--controller"),
            (
                "import urdf r.urdf --base a --tip b --home j=@deg",
                "--home",
            ),
        ] {
            let line = line.replace('@', wrong);
            let words: Vec<&str> = line.split(' ').collect();
            let said = run(here.path(), &words);
            assert_eq!(said.code, 1, "{line}: {said:?}");
            assert!(said.err.contains(option), "{line}: {}", said.err);
            count += 1;
        }
    }
    assert_eq!(count, 96);
}

/// One of something is reported as one, in summaries, reports and warnings.
#[test]
fn one_is_not_written_in_the_plural() {
    const MANY: [&str; 24] = [
        "blocks",
        "lines",
        "moves",
        "places",
        "points",
        "pieces",
        "steps",
        "branches",
        "numbers",
        "nodes",
        "cases",
        "warnings",
        "platforms",
        "limbs",
        "directions",
        "entries",
        "errata",
        "poses",
        "joints",
        "segments",
        "tools",
        "faults",
        "iterations",
        "places",
    ];
    let here = workplace();
    let put = |name: &str, text: &str| {
        std::fs::write(here.path().join(name), text).expect("a file");
    };
    // One feed move and one rapid; one sharp corner; one block before the tool's place is stated; one fault.
    put("one.ngc", "G21 G0 X0 Y0 Z0\nG1 X10 F300\n");
    put("corner.ngc", "G21 G90 G17\nG0 X0 Y0 Z0\nG1 X20 F300\nY20\n");
    put("unstated.ngc", "G21 G0 Z5\nX0 Y0\nG1 X10 F300\n");
    put("line.ngc", "G21 G0 X0 Y0 Z0");
    put(
        "one.csv",
        "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n0,0,0,0.01,0,0\n",
    );
    let job = "--model orthoglide --part-origin-mm 0 0 100 --tool-length-mm 100 --force-overwrite --out o.ngc";
    let mut corners = 0;
    for line in [
        format!("compensate {job} --milling 215 -10 -25 --program corner.ngc --report r.html"),
        format!("compensate {job} --milling 2 0 0 --program corner.ngc --report r.html"),
        format!("compensate {job} --milling 215 -10 -25 --program one.ngc --report r.html"),
        format!("compensate {job} --milling 215 -10 -25 --program unstated.ngc --report r.html"),
        "compensate --model heavy_6r --weight all --part-origin-mm 1050 0 1000 --tool-length-mm 150 --milling 215 -10 -25 --program one.ngc --out o.ngc --report r.html --force-overwrite".to_owned(),
        "compensate --no-compensation --program line.ngc --out o.ngc --force-overwrite".to_owned(),
        "compensate --map one.csv --program one.ngc --out o.ngc --force-overwrite".to_owned(),
        "deflect orthoglide --program one.ngc --force 0 0 200 --part-origin-mm 0 0 100 --tool-length-mm 100 --report r.html --force-overwrite".to_owned(),
        "map orthoglide --x 0".to_owned(),
        "map orthoglide --x 900".to_owned(),
        "check model.toml".to_owned(),
        "check job.toml".to_owned(),
        "reproduce eq-3.34".to_owned(),
        "curve two_link --factor 0 1 --force 1 0 0 --points 1".to_owned(),
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let said = run(here.path(), &words);
        let report = std::fs::read_to_string(here.path().join("r.html")).unwrap_or_default();
        let mut text = format!("{} {} ", said.out, said.err);
        // What stands between the tags.
        let body = report.split_once("</style>").map_or("", |(_, body)| body);
        text.extend(body.split('<').filter_map(|part| Some(part.split_once('>')?.1.to_owned() + "\n")));
        corners += usize::from(flat(&text).contains("1 corner step,"));
        let words: Vec<&str> = text.split_whitespace().collect();
        for three in words.windows(3).filter(|three| three[0] == "1") {
            let plural = |word: &str| MANY.contains(&word.trim_end_matches([',', '.', ':', ';']));
            let adjective = ["feed", "rapid", "corner", "load"].contains(&three[1]);
            assert!(
                !(plural(three[1]) || adjective && plural(three[2])),
                "{line}: {three:?}\n{text}"
            );
        }
    }
    assert!(corners > 0, "a program with one corner step");
}
