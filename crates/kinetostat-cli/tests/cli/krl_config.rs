//! Tools and bases of a KUKA controller, from the `$config.dat` of its archive.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use crate::common::run;

/// The base is the second, the tool the third.
const PROGRAM: &str = "DEF part( )\n$BASE=BASE_DATA[2]\n$TOOL=TOOL_DATA[3]\n$VEL.CP=0.01\n\
    PTP {X 0,Y 0,Z 50,A 0,B 0,C 180,S 2,T 3}\nLIN {X 0,Y 0,Z 0,A 0,B 0,C 180}\nLIN {X 10,Y 0,Z 0,A 0,B 0,C 180}\nEND\n";

/// Among what a controller has there beside it.
const CONFIG: &str = "&ACCESS RV1\nDEFDAT  $CONFIG\nENUM MY_TYP NOT_KNOWN, OTHER\nSIGNAL GRIPPER $OUT[7]\nDECL FRAME BASE_DATA[32]\n\
    BASE_DATA[1]={FRAME: X 1.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}\nBASE_DATA[2]={FRAME: X 1700.0,Y 12.5,Z 900.0,A 0.0,B 0.0,C 0.0}\n\
    TOOL_DATA[3]={X 0.0,Y 0.0,Z 180.0,A 0.0,B 0.0,C 0.0}\nE6AXIS XHOME={A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 0.0,A6 0.0}\nENDDAT\n";

const MACHINE: &str =
    "--model heavy_6r --weight all --force 30 0 -20 --correct position --tool-axis -z";

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// As one line.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A program and the data of its controller in folders.
fn place(program: &str, config: Option<(&str, &str)>) -> tempfile::TempDir {
    let here = tempfile::tempdir().unwrap();
    let files = [Some((program, PROGRAM)), config];
    for (path, text) in files.into_iter().flatten() {
        let path = here.path().join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    here
}

/// What is said of the corrected program, and the program.
fn compensated(here: &Path, program: &str) -> (String, String) {
    let line = format!("compensate --program {program} {MACHINE} --out out.src");
    let said = flat(&run(here, &words(&line)).answered().out);
    let text = std::fs::read_to_string(here.join("out.src")).unwrap();
    std::fs::remove_file(here.join("out.src")).unwrap();
    (said, text)
}

/// `PTP XHOME` goes to where the data say; without them it is left as it is written, which is said.
#[test]
fn home_positions_are_taken_from_the_data_or_left() {
    let frame = |place: &str| format!("{{{place},A 0,B 0,C 0}}");
    let program = (PROGRAM.replace("PTP {", "PTP XHOME\nPTP {"))
        .replace("BASE_DATA[2]", &frame("X 1700,Y 12.5,Z 900"))
        .replace("TOOL_DATA[3]", &frame("X 0,Y 0,Z 180"));
    for (config, is_left) in [(Some(("$config.dat", CONFIG)), false), (None, true)] {
        let here = place("part.src", config);
        std::fs::write(here.path().join("part.src"), &program).unwrap();
        let (said, text) = compensated(here.path(), "part.src");
        assert!(text.contains("PTP XHOME\n"), "{text}");
        assert_eq!(said.contains("no `XHOME` is declared"), is_left, "{said}");
    }
}

#[test]
fn tools_and_bases_are_taken_from_the_controllers_data() {
    let in_program = PROGRAM.replace(
        "$BASE=",
        "TOOL_DATA[3]={X 0,Y 0,Z 180,A 0,B 0,C 0}\nBASE_DATA[2]={X 1700,Y 12.5,Z 900,A 0,B 0,C 0}\n$BASE=",
    );
    let here = place("part.src", None);
    std::fs::write(here.path().join("part.src"), in_program).unwrap();
    let (_, expected) = compensated(here.path(), "part.src");
    let motions = |text: &str| -> Vec<String> {
        let lines = text.lines().filter(|line| line.starts_with("LIN"));
        lines.map(str::to_owned).collect()
    };
    assert!(motions(&expected).len() >= 2);
    for (program, config) in [
        ("part.src", "$config.dat"),
        ("Program/part.src", "System/$config.dat"),
        (
            "KRC/R1/Program/Jobs/A/part.src",
            "KRC/R1/System/$CONFIG.DAT",
        ),
        ("part.src", "KRC/R1/System/$config.dat"),
        ("part.src", "R1/System/$Config.dat"),
    ] {
        let here = place(program, Some((config, CONFIG)));
        let (said, text) = compensated(here.path(), program);
        assert_eq!(motions(&text), motions(&expected), "{config}");
        let note = format!(
            "`BASE_DATA[2]`, `TOOL_DATA[3]`, which the program names, are taken from '{config}', where the program gives them no value itself"
        );
        assert!(said.contains(&note), "{config}: {said}");
        // It is read, and not written.
        let kept = std::fs::read_to_string(here.path().join(config)).unwrap();
        assert_eq!(kept, CONFIG);
        assert!(!said.contains("-compensated.dat"), "{said}");
    }
}

/// What the user states counts, and of a controller's data without the number nothing is taken.
#[test]
fn what_the_user_states_counts_before_the_controllers_data() {
    let here = place("part.src", Some(("$config.dat", CONFIG)));
    let here = here.path();
    let job = "schema = 1\nprogram = \"part.src\"\nmodel = \"heavy_6r\"\n[load]\nweight = \"all\"\nforce_n = [30, 0, -20]\n[robot]\ncorrect = \"position\"\ntool_axis = \"-z\"\n[robot.frames]\n\"BASE_DATA[2]\" = { position_mm = [1600, 0, 900] }\n";
    std::fs::write(here.join("job.toml"), job).unwrap();
    let said = run(here, &words("compensate job.toml --out out.src"));
    let text = flat(&format!("{}{}", said.out, said.err));
    assert!(
        text.contains("`TOOL_DATA[3]`, which the program names, is taken from"),
        "{text}"
    );
    assert!(!text.contains("`BASE_DATA[2]`, `TOOL"), "{text}");
    for config in [
        "DEFDAT $CONFIG\nENDDAT\n",
        "DEFDAT $CONFIG\nBASE_DATA[1]={X 0,Y 0,Z 0,A 0,B 0,C 0}\nENDDAT\n",
        "DEFDAT $CONFIG\nBASE_DATA[2]={X 0,Y 0\nTOOL_DATA[3]=OTHER\nENDDAT\n",
    ] {
        std::fs::write(here.join("$config.dat"), config).unwrap();
        let line = format!("compensate --program part.src {MACHINE} --out o.src");
        let said = run(here, &words(&line));
        assert_eq!(said.code, 1, "{said:?}");
        assert!(
            flat(&said.err)
                .contains("lay the controller's $config.dat, which states it, beside the program"),
            "{said:?}"
        );
    }
}
