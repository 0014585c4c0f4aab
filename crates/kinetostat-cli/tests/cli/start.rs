//! `start`: answers become a job that every command reads, and its first result.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use serde_json::{Value, json};

use crate::common::served::Served;
use crate::common::{PROGRAM, Said, command, contents, run, workplace};

/// A slot in KRL whose tool and base only the controller knows.
const SLOT: &str = "\
DEF part()
$BASE=BASE_DATA[3]
$TOOL=TOOL_DATA[2]
$VEL.CP=0.2
LIN {X 0,Y 0,Z 50,A 0,B 0,C 180,S 2,T 35}
$VEL.CP=0.01
LIN {X 0,Y 0,Z -1,A 0,B 0,C 180}
LIN {X 60,Y 0,Z -1,A 0,B 0,C 180}
$VEL.CP=0.2
LIN {X 60,Y 0,Z 50,A 0,B 0,C 180}
END
";

/// Answers for it, one a line: an empty one takes what is usual.
const ANSWERS: [&str; 11] = [
    "heavy_6r",
    "part.src",
    "0 0 180",
    "-z",
    "20",
    "1800 0 900 30 0 0",
    "touch-off",
    "",
    "300 -100 -50",
    "100",
    "0.05",
];

/// Types the answers; `words` stand behind the command.
fn start(here: &Path, answers: &[&str], words: &[&str]) -> Said {
    let mut process = command(here)
        .arg("start")
        .args(words)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command runs");
    let mut input = process.stdin.take().expect("a pipe");
    // The command may end before it has read all of them.
    let _ = input.write_all((answers.join("\n") + "\n").as_bytes());
    drop(input);
    Said::of(process.wait_with_output().expect("it ends"))
}

fn with_slot() -> tempfile::TempDir {
    let here = workplace();
    std::fs::write(here.path().join("part.src"), SLOT).expect("written");
    here
}

fn json(here: &Path, words: &[&str]) -> Value {
    let said = run(here, words);
    assert!([0, 4].contains(&said.code), "{words:?}: {}", said.err);
    serde_json::from_str(&said.out).expect("JSON")
}

#[test]
fn answers_become_a_job_that_every_command_reads() {
    let here = with_slot();
    let here = here.path();
    let said = start(here, &ANSWERS, &["--out", "cell"]);
    // The load at a corner is an assumption, which the first result states.
    assert_eq!(said.code, 4, "{}{}", said.out, said.err);
    assert!(here.join("cell/compensated/part.src").is_file());
    assert!(here.join("cell/part.html").is_file());

    let error = |result: &Value| {
        let error = result["summary"]["max_position_error_before_mm"].as_f64();
        error.expect("an error")
    };
    let of_job = json(here, &["deflect", "cell/job.toml", "--json"]);
    std::fs::write(
        here.join("by_hand.toml"),
        "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"part.src\"\n[tool]\nmass_kg = 20\n[robot]\ntool_axis = \"-z\"\n[robot.frames]\n\"TOOL_DATA[2]\" = { position_mm = [0, 0, 180] }\n\"BASE_DATA[3]\" = { position_mm = [1800, 0, 900], a_b_c_kuka_deg = [30, 0, 0] }\n",
    )
    .expect("written");
    let line = "deflect by_hand.toml --weight touch-off --touch-off 0 0 0 --milling 300 -100 -50 --rapid-from-mm-per-s 100 --json";
    let by_hand = json(here, &line.split(' ').collect::<Vec<_>>());
    assert_eq!(error(&of_job), error(&by_hand));
    assert!(error(&of_job) > 0.1);

    for line in [
        "check cell/job.toml",
        "compensate cell/job.toml --force-overwrite",
        "verify cell/compensated/part.src --job cell/job.toml",
        "place cell/job.toml --x-mm 1700 1800 --samples 4",
    ] {
        let said = run(here, &line.split(' ').collect::<Vec<_>>());
        assert!([0, 4].contains(&said.code), "{line}: {}", said.err);
    }
}

#[test]
fn g_code_for_a_robot_asks_for_the_cell_and_for_the_cut() {
    let here = workplace();
    let here = here.path();
    std::fs::write(
        here.join("part.ngc"),
        PROGRAM.replace("G17", "G17 S8000 M3"),
    )
    .expect("written");
    let answers = [
        "heavy_6r",
        "part.ngc",
        "krl",
        "$ANOUT[1]={rpm}/24000.0 | $OUT[12]=TRUE",
        "$OUT[12]=FALSE",
        "180",
        "20",
        "1800 0 900",
        "all",
        "AlMg4.5Mn",
        "8 2 30",
        "-40 -40 -20 40 40 0",
        "0.1",
    ];
    let said = start(here, &answers, &["--out", "cell"]);
    assert_eq!(said.code, 4, "{}{}", said.out, said.err);
    let program = std::fs::read_to_string(here.join("cell/compensated/part.src")).expect("KRL");
    for words in [
        "X 1800.000000",
        "CM {X 0.000000,Y 0.000000,Z 90.000000",
        "$ANOUT[1]=8000/24000.0",
        "$OUT[12]=TRUE",
    ] {
        assert!(program.contains(words), "{words}: {program}");
    }
    for line in [
        "check cell/job.toml",
        "engagement cell/job.toml",
        "chatter cell/job.toml --damping 0.03",
    ] {
        let said = run(here, &line.split(' ').collect::<Vec<_>>());
        assert_eq!(said.code, 0, "{line}: {}", said.err);
    }
}

#[test]
fn a_urdf_becomes_a_model_with_the_stiffness_that_is_answered() {
    let here = with_slot();
    let here = here.path();
    let urdf = r#"<robot name="slide"><link name="base"/><link name="carriage"><inertial><mass value="10"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="swing" type="revolute"><parent link="base"/><child link="carriage"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint></robot>"#;
    std::fs::write(here.join("slide.urdf"), urdf).expect("written");
    let said = start(here, &["slide.urdf", "z", "-5"], &["--out", "cell"]);
    assert_eq!(said.code, 1);
    let said = start(
        here,
        &["slide.urdf", "z", "5e5", "part.src"],
        &["--out", "cell"],
    );
    let table = "name,value,unit\nother,1e6,N m/rad\n";
    std::fs::write(here.join("stiff.csv"), table).expect("written");
    let rigid = start(here, &["slide.urdf", "z", "stiff.csv"], &["--out", "cell"]);
    assert_eq!(rigid.code, 1);
    assert!(
        rigid.err.contains("swing") || rigid.err.contains("other"),
        "{}",
        rigid.err
    );
    // One joint holds a chain only about its axis, and the questions end here: what counts is that the program was asked for.
    assert!(
        said.out.contains("KRL, 12 lines, 4 moves"),
        "{}{}",
        said.out,
        said.err
    );
    assert!(said.out.contains("carriage"), "{}", said.out);
    assert!(!here.join("cell").exists());
}

#[test]
fn an_answer_that_cannot_be_writes_nothing() {
    let here = with_slot();
    let here = here.path();
    let before = contents(here);
    let wrong: [(usize, &str, &str); 13] = [
        (0, "heavy_7r", "heavy_6r"),
        (1, "nowhere.src", "nowhere.src"),
        (2, "0 0", "X Y Z"),
        (2, "0 0 nan", "no number"),
        (3, "up", "none of"),
        (4, "-3", "mass"),
        (5, "9000 0 900", "reached"),
        (5, "1800,5 100,0 0,0", "point"),
        (6, "perhaps", "touch-off"),
        (8, "cheese", "cheese"),
        (8, "AlMg4.5Mn", "G-code"),
        (10, "50000", "allowed"),
        (10, "1e-9", "allowed"),
    ];
    for (at, answer, said_of) in wrong {
        let mut answers = ANSWERS;
        answers[at] = answer;
        let said = start(here, &answers, &["--out", "cell"]);
        assert_eq!(said.code, 1, "{answer}: {}{}", said.out, said.err);
        assert!(said.err.contains(said_of), "{answer}: {}", said.err);
    }
    let said = start(here, &ANSWERS[..4], &["--out", "cell"]);
    assert!(said.err.contains("Mass of spindle"), "{}", said.err);
    assert_eq!(contents(here), before);
}

#[test]
fn one_goes_back_and_asks_for_more() {
    let here = with_slot();
    let here = here.path();
    std::fs::remove_file(here.join("job.toml")).expect("removed");
    let mut answers = vec!["?", "orthoglide", "<"];
    answers.extend(ANSWERS);
    let said = start(here, &answers, &[]);
    assert_eq!(said.code, 4, "{}{}", said.out, said.err);
    assert!(said.out.contains("kuka_kr270_like"), "{}", said.out);
    let job = std::fs::read_to_string(here.join("job.toml")).expect("a job");
    assert!(job.contains("program = \"part.src\""), "{job}");
    // A job that is there is refused before the first question.
    let said = start(here, &["heavy_6r"], &[]);
    assert_eq!(said.code, 1);
    assert!(
        said.err.contains("job.toml") && said.out.is_empty(),
        "{}",
        said.err
    );
}

#[test]
fn a_program_that_is_run_once_is_written_flat() {
    let here = workplace();
    let here = here.path();
    let program = "G21 G90 G17\n#1=20\nG0 X[#1] Y0 Z5\nG1 Z-1 F300\nG1 X0 Y20 F600\nG0 Z5\nM2\n";
    std::fs::write(here.join("part.ngc"), program).expect("written");
    let answers = [
        "orthoglide",
        "part.ngc",
        "g-code",
        "100",
        "20 20 120",
        "215 -10 -25",
        "0.05",
    ];
    let said = start(here, &answers, &["--out", "cell"]);
    assert!([0, 4].contains(&said.code), "{}{}", said.out, said.err);
    assert!(
        said.out.contains("run once and written flat"),
        "{}",
        said.out
    );
    run(here, &["check", "cell/job.toml"]).answered();
}

#[test]
fn the_page_asks_the_same_and_writes_the_same_files() {
    let with_slot = || {
        let here = tempfile::tempdir().expect("a directory");
        std::fs::write(here.path().join("part.src"), SLOT).expect("written");
        here
    };
    let (typed, shown) = (with_slot(), with_slot());
    start(typed.path(), &ANSWERS, &[]);
    let served = Served::of(shown.path(), &[]);
    assert_eq!(served.post("machine", &json!({})), (200, Value::Null));
    assert_eq!(served.post("state", &json!({})).0, 404);
    let (_, first) = served.post("start", &json!({}));
    let choices = first["question"]["choices"].as_array().expect("a list");
    assert!(choices.contains(&json!("heavy_6r")), "{first}");
    // What cannot be taken leaves the question, and one can go back.
    let (_, wrong) = served.post("start", &json!({ "answer": "no_such_robot" }));
    assert_eq!(wrong["question"]["words"], first["question"]["words"]);
    assert!(wrong["refused"].is_string(), "{wrong}");
    let (_, robot) = served.post("start", &json!({ "answer": ANSWERS[0] }));
    assert!(
        robot["question"]["choices"]
            .as_array()
            .expect("a list")
            .contains(&json!("part.src"))
    );
    let (_, back) = served.post("start", &json!({ "back": true }));
    assert_eq!(back["question"]["words"], first["question"]["words"]);
    let mut last = back;
    for answer in ANSWERS {
        last = served.post("start", &json!({ "answer": answer })).1;
        assert_eq!(last["refused"], Value::Null, "{answer}");
    }
    assert_eq!(last["question"], Value::Null, "{last}");
    assert_eq!(last["given"].as_array().map(Vec::len), Some(ANSWERS.len()));
    let (_, written) = served.post("start", &json!({ "write": true }));
    assert_eq!(written["refused"], Value::Null, "{written}");
    let [files, wanted] = [&shown, &typed].map(|folder| {
        let within = |file: PathBuf| file.strip_prefix(folder.path()).map(Path::to_owned);
        let all = contents(folder.path()).into_iter();
        all.map(|(file, bytes)| (within(file).expect("a file in it"), bytes))
            .collect::<BTreeMap<_, _>>()
    });
    assert!(files.len() >= 6 && files.keys().eq(wanted.keys()));
    // The report has the time at which it was written.
    let texts = files
        .iter()
        .filter(|(file, _)| file.extension() != Some("html".as_ref()));
    for (file, bytes) in texts {
        assert!(bytes == &wanted[file], "{}", file.display());
    }
    // The machine stands there, with its program.
    assert_eq!(served.post("machine", &json!({})).1["has_path"], true);
    assert!(served.post("path", &json!({})).1["places"].is_array());
    assert_eq!(served.post("state", &json!({ "place": 0 })).0, 200);
    // Where a job is already there is nothing to ask.
    let said = run(shown.path(), &["view", "--no-browser"]);
    assert_eq!(said.code, 1);
    assert!(
        said.err.contains("kinetostat view job.toml"),
        "{}",
        said.err
    );
}
