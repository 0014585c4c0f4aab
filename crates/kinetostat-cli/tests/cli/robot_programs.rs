//! Programs in the language of a robot through the commands.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use serde_json::Value;

use crate::common::run;

/// A slot with an arc; tool and work object are in the program.
const SLOT: &str = r#"MODULE Slot
  PERS tooldata tMill:=[TRUE,[[0,0,180],[1,0,0,0]],[5,[0,0,60],[1,0,0,0],0,0,0]];
  PERS wobjdata wPart:=[FALSE,TRUE,"",[[1800,0,900],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget pIn:=[[0,0,20],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ pIn,v500,z10,tMill\WObj:=wPart;
    MoveL [[0,0,-1],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tMill\WObj:=wPart;
    MoveL [[60,0,-1],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tMill\WObj:=wPart; ! along
    MoveC [[70,10,-1],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[[60,20,-1],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tMill\WObj:=wPart;
    MoveL Offs(pIn,0,20,0),v200,fine,tMill\WObj:=wPart;
  ENDPROC
ENDMODULE
"#;

const RUN: &str = "compensate --model heavy_6r --weight all --program slot.mod --milling 300 -100 -50 --rapid-from-mm-per-s 100 --tolerance-um 10";

fn place(text: &str) -> tempfile::TempDir {
    let here = tempfile::tempdir().unwrap();
    std::fs::write(here.path().join("slot.mod"), text).unwrap();
    here
}

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

fn read(here: &Path, name: &str) -> String {
    std::fs::read_to_string(here.join(name)).unwrap()
}

#[test]
fn a_program_in_rapid_is_compensated_and_is_one_again() {
    let here = place(SLOT);
    let here = here.path();
    let line = format!("{RUN} --correct pose --json out.json --points points.csv --report r.html");
    let said = run(here, &words(&line)).answered();
    assert!(!said.out.contains("no tool is given"), "{said:?}");
    let output = read(here, "compensated/slot.mod");
    // What is no motion is there as it was; what is new says where it is from.
    assert!(
        output.starts_with("MODULE Slot\n  ! kinetostat: compensated program")
            || output.starts_with("MODULE Slot\n! kinetostat: compensated program")
    );
    for kept in [
        "PERS tooldata tMill",
        "PERS wobjdata wPart",
        "! along",
        "CONST robtarget pIn:=",
    ] {
        assert!(output.contains(kept), "{kept}");
    }
    let out: Value = serde_json::from_str(&read(here, "out.json")).unwrap();
    let summary = &out["summary"];
    assert!(summary["max_position_error_before_mm"].as_f64().unwrap() > 1.0);
    assert!(summary["max_position_error_after_mm"].as_f64().unwrap() < 0.02);
    let tilt = summary["max_residual_rotation_deg"].as_f64();
    // Along the circle the tolerances of path and chords (10 and 8 um) hold at a lever of 50 mm: 0.0206 deg.
    assert!(tilt.is_none_or(|tilt| tilt < 0.0206), "{tilt:?}");
    let table = read(here, "points.csv");
    let columns: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let w = columns
        .iter()
        .position(|name| *name == "orientation_w")
        .unwrap();
    for row in table.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let parts: Vec<f64> = cells[w..w + 4]
            .iter()
            .map(|cell| cell.parse().unwrap())
            .collect();
        let size: f64 = parts.iter().map(|part| part * part).sum();
        assert!((size - 1.0).abs() < 1e-6, "{row}");
    }
    assert!(read(here, "r.html").contains("of the orientation in the program"));
    let quaternion = &out["points"][0]["tool_orientation"];
    assert_eq!(quaternion.as_array().map(Vec::len), Some(4));
    // It can be looked at again, and is not compensated a second time.
    let again =
        "compensate --model heavy_6r --weight all --program compensated/slot.mod --milling 1 1 1";
    let refused = run(here, &words(again));
    assert_eq!(refused.code, 1);
    assert!(refused.err.contains("compensated already"), "{refused:?}");
}

#[test]
fn the_job_states_what_the_program_does_not() {
    let text = SLOT
        .lines()
        .filter(|line| !line.contains("PERS"))
        .collect::<Vec<_>>()
        .join("\n");
    let here = place(&text);
    let here = here.path();
    let job = "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"slot.mod\"\n[load]\nweight = \"all\"\nforce_n = [0, 0, 100]\n";
    let put = |more: &str| std::fs::write(here.join("job.toml"), format!("{job}{more}")).unwrap();
    put("");
    let refused = run(here, &["check", "job.toml"]);
    assert_eq!(refused.code, 1);
    assert!(
        refused
            .err
            .contains("does not say what its tool `tMill` is"),
        "{refused:?}"
    );
    put(
        "[robot]\ncorrect = \"pose\"\nrapid_from_mm_per_s = 100\n[robot.frames]\ntMill = { position_mm = [0, 0, 180] }\nwPart = { position_mm = [1800, 0, 900] }\n",
    );
    let stated = run(here, &["compensate", "job.toml"]).answered();
    let output = read(here, "compensated/slot.mod");
    std::fs::write(here.join("slot.mod"), SLOT).unwrap();
    std::fs::remove_file(here.join("compensated/slot.mod")).unwrap();
    put("[robot]\ncorrect = \"pose\"\nrapid_from_mm_per_s = 100\n");
    run(here, &["compensate", "job.toml"]).answered();
    let own = read(here, "compensated/slot.mod");
    let moves = |text: &str| -> Vec<String> {
        let moves = text.lines().filter(|line| line.contains("Move"));
        moves.map(str::to_owned).collect()
    };
    assert_eq!(moves(&output), moves(&own), "{stated:?}");
}

#[test]
fn contradictions_and_what_belongs_to_g_code_are_refused_with_what_to_do() {
    let here = place(SLOT);
    let here = here.path();
    for (more, expected) in [
        ("--tool-length-mm 200", "the tool is stated twice"),
        (
            "--part-origin-mm 0 0 0",
            "the place of the part is stated twice",
        ),
        (
            "--parameter 1=2",
            "says something about an expanded program",
        ),
        ("--units mm", "--units is for G-code"),
        ("--work-offset G54=0,0,0", "--work-offset is for G-code"),
        ("--scale 2", "is for G-code"),
        (
            "--tool-orientation a_b_c_kuka_deg=0,0,0",
            "the program states the orientation of its tool",
        ),
        ("--no-compensation", "would be its own copy"),
    ] {
        // A copy takes no options of a correction.
        let line = match more {
            "--no-compensation" => "compensate --program slot.mod",
            _ => RUN,
        };
        let said = run(here, &words(&format!("{line} {more}")));
        assert_eq!(said.code, 1, "{more}");
        assert!(
            said.err.replace('\n', " ").contains(expected),
            "{more}: {said:?}"
        );
        assert!(!here.join("compensated/slot.mod").exists());
    }
    std::fs::write(here.join("part.ngc"), "G21 G90\nG0 X0 Y0 Z1\nG1 X9 F100\n").unwrap();
    let said = run(
        here,
        &words("deflect heavy_6r --program part.ngc --force 0 0 1 --correct pose"),
    );
    assert_eq!(said.code, 1);
    assert!(said.err.contains("--correct"), "{said:?}");
}

#[test]
fn another_configuration_than_the_model_s_is_warned_of() {
    // The model's arm mills in front, with the elbow up, throughout.
    for (stated, expected) in [
        (
            SLOT.replace("[0,0,0,0],[9E9", "[0,0,0,4],[9E9"),
            "line 6: the program states the configuration `[0,0,0,4]`",
        ),
        (
            SLOT.replacen(
                "[[60,0,-1],[0,0,1,0],[0,0,0,0]",
                "[[60,0,-1],[0,0,1,0],[0,0,0,2]",
                1,
            ),
            "the program states the configuration `[0,0,0,2]`, and the model's arm is solved front, elbow up, wrist not flipped",
        ),
        (
            SLOT.replace("[0,0,0,0],[9E9", "[0,0,0,3],[9E9"),
            "which is another elbow and wrist",
        ),
        // Where the controller takes what is near, elbow and wrist are not those that are stated.
        (
            SLOT.replace("[0,0,0,0],[9E9", "[0,0,0,3],[9E9").replace(
                "    MoveJ pIn,",
                "    ConfJ\\Off;\n    ConfL\\Off;\n    MoveJ pIn,",
            ),
            "",
        ),
        (SLOT.to_owned(), ""),
    ] {
        let here = place(&stated);
        let said = run(here.path(), &words(RUN)).answered();
        let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
        match expected {
            "" => assert!(!flat.contains("states the configuration"), "{flat}"),
            expected => assert!(flat.contains(expected), "{flat}"),
        }
    }
}

#[test]
fn frames_of_the_job_that_fit_no_motion_or_contradict_the_program_are_warned_of() {
    let here = place(SLOT);
    let here = here.path();
    let job = "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"slot.mod\"\n[load]\nweight = \"all\"\nforce_n = [0, 0, 100]\n[robot.frames]\ntMil = { position_mm = [0, 0, 180] }\nwPart = { position_mm = [1800, 0, 910] }\n";
    std::fs::write(here.join("job.toml"), job).unwrap();
    let said = run(here, &["compensate", "job.toml"]).answered();
    let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    for expected in [
        "frames.\"tMil\" under [robot] is no tool or work object",
        "`wPart` of the job, under [robot.frames], is not what the program says it is, 10 mm away",
    ] {
        assert!(flat.contains(expected), "{flat}");
    }
}

#[test]
fn files_that_are_no_program_say_what_they_are() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    for (name, text, expected) in [
        ("slot.mod", "", "no `MODULE` stands in it"),
        ("slot.txt", SLOT, "it looks like RAPID"),
        ("slot.dat", "DEFDAT SLOT\nENDDAT\n", "give its .src"),
    ] {
        std::fs::write(here.join(name), text).unwrap();
        let line = format!("deflect heavy_6r --program {name} --force 0 0 1");
        let said = run(here, &words(&line));
        assert_eq!(said.code, 1);
        assert!(said.err.replace('\n', " ").contains(expected), "{said:?}");
    }
}

#[test]
fn remedies_name_the_keys_of_the_job_file() {
    let text = SLOT.replace("    MoveJ pIn,", "    MoveJ pOut,");
    let here = place(&text.replace(
        "PROC main()",
        "VAR robtarget pOut;\n  PROC main()\n    pOut:=CRobT();",
    ));
    let said = run(here.path(), &words(RUN));
    assert_eq!(said.code, 1);
    assert!(
        said.err.contains("unknown_targets = \"left_as_written\""),
        "{said:?}"
    );
    assert!(!said.err.contains("slot.mod: slot.mod"), "{said:?}");
}

#[test]
fn all_faults_of_a_program_come_at_once_with_their_lines() {
    let text = SLOT.replace("    MoveJ pIn,", "    MoveJ pOut,").replace(
        "v20,z1,tMill\\WObj:=wPart; ! along",
        "v20,z1,tMill\\WObj:=wPart; SearchL di1,p9,pIn,v10,tMill;",
    );
    let here = place(&text);
    let said = run(here.path(), &words(RUN));
    assert_eq!(said.code, 1);
    let flat = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    for expected in ["line 6: `", "pOut", "line 8", "SearchL"] {
        assert!(flat.contains(expected), "{expected}: {flat}");
    }
}

#[test]
fn dialects_are_shown_as_the_readers_have_them() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let listed = run(here, &["dialect", "list"]).answered();
    for name in ["gcode", "rapid"] {
        assert!(listed.out.contains(name));
        let shown = run(here, &["dialect", "show", name, "--json"]).answered();
        let table: Value = serde_json::from_str(&shown.out).unwrap();
        let words = table["words"].as_array().unwrap();
        assert!(words.len() > 60, "{name}: {}", words.len());
        for word in words.iter().filter(|word| word["treatment"] == "refused") {
            assert!(word["remedy"].as_str().unwrap().len() > 5, "{word}");
        }
        let followed = |of: &str| {
            let one = words.iter().find(|word| word["word"] == of);
            one.is_some_and(|word| word["treatment"] == "followed")
        };
        if name == "gcode" {
            for of in ["G1", "M3", "M5", "M6", "F", "S", "T"] {
                assert!(followed(of), "{of}");
            }
            let coolant = words.iter().find(|word| word["word"] == "M8").unwrap();
            assert_eq!(
                (&coolant["treatment"], &coolant["piece"]),
                (&"carried".into(), &"first".into())
            );
        }
    }
    let wrong = run(here, &["dialect", "show", "fortran"]);
    assert_eq!(wrong.code, 1);
    assert!(wrong.err.contains("there are: gcode, rapid"), "{wrong:?}");
}

#[test]
fn a_data_list_is_written_beside_its_program_and_an_axis_along_the_cut_is_warned_of() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let put = |name: &str, text: &str| std::fs::write(here.join(name), text).unwrap();
    let pose =
        |x: f64, z: f64| format!("{{X {x:.3},Y 0.000,Z {z:.3},A 0.0,B 0.0,C 180.0,S 2,T 35}}");
    put(
        "slot.src",
        &format!(
            "DEF slot( )\n$BASE={{X 1800,Y 0,Z 900,A 0,B 0,C 0}}\n$TOOL={{X 0,Y 0,Z 180,A 0,B 0,C 0}}\n$VEL.CP=0.02\nPTP XIN\nLIN XDOWN C_DIS\nLIN {}\nEND\n",
            pose(60.0, -1.0)
        ),
    );
    put(
        "slot.dat",
        &format!(
            "DEFDAT SLOT\nDECL E6POS XIN={}\nDECL E6POS XDOWN={}\nENDDAT\n",
            pose(0.0, 20.0),
            pose(0.0, -1.0)
        ),
    );
    let line = "compensate --model heavy_6r --weight all --program slot.src --milling 300 -100 -50";
    let open = run(here, &words(line));
    assert_eq!(open.code, 1);
    assert!(open.err.contains("--tool-axis"), "{open:?}");
    let said = run(here, &words(&format!("{line} --tool-axis -x"))).answered();
    // x of the tool lies along this cut.
    let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(flat.contains("the tool goes along its own axis"), "{flat}");
    let data = read(here, "compensated/slot.dat");
    assert!(data.starts_with("DEFDAT SLOT\nDECL E6POS XIN={X "));
    assert!(!data.contains(&pose(0.0, -1.0)), "{data}");
    put(
        "job.toml",
        "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"slot.src\"\n[load]\nweight = \"all\"\nmilling = { radial_n = 300, tangential_n = -100, axial_n = -50 }\n[robot]\ntool_axis = \"-z\"\n[output]\nprogram = \"z.src\"\n",
    );
    let said = run(here, &["compensate", "job.toml"]).answered();
    assert!(!said.out.contains("along its own axis"), "{said:?}");
    assert!(here.join("z.dat").is_file());
}

/// Slots that a loop moves on.
const CONTROLS: [(&str, &str, &str); 3] = [
    (
        "loop.h",
        "0 BEGIN PGM LOOP MM\n1 TOOL CALL 1 Z S3000 F500\n2 L X+0 Y+0 Z+50 R0 FMAX M3\n3 FN 0: Q1 = +0\n4 LBL 1\n5 L X+Q1 Y+0 FMAX\n6 L Z-1 F300\n7 L Y+30 F500\n8 L Z+10 FMAX\n9 FN 1: Q1 = +Q1 + +10\n10 CALL LBL 1 REP 1\n11 L Z+50 FMAX M30\n12 END PGM LOOP MM\n",
        "CALL LBL 1 REP 1",
    ),
    (
        "loop.mpf",
        "N10 G90 G71 G17 G54\nN30 R1=0\nN40 G0 X0 Y0 Z50\nN50 WHILE R1<20\nN60 G0 X=R1 Y0\nN70 G1 Z-1 F300\nN80 Y30\nN90 G0 Z10\nN100 R1=R1+10\nN110 ENDWHILE\nN120 G0 Z50\nN130 M30\n",
        "WHILE R1<20",
    ),
    // With the ending of G-code.
    (
        "loop.nc",
        "N5 DEF REAL FREE\nN10 G90 G71 G17 G54\nN30 R1=0\nN40 G0 X0 Y0 Z50\nN50 WHILE R1<20\nN60 G0 X=R1 Y0\nN70 G1 Z-1 F300\nN80 Y30\nN90 G0 Z10\nN100 R1=R1+10\nN110 ENDWHILE\nN120 G0 Z50\nN130 M30\n",
        "WHILE R1<20",
    ),
];

#[test]
fn programs_of_controls_with_loops_are_run_once_and_compensated_flat() {
    for (name, text, looped) in CONTROLS {
        let here = tempfile::tempdir().unwrap();
        let here = here.path();
        std::fs::write(here.join(name), text).unwrap();
        let line = format!(
            "compensate --model heavy_6r --weight all --program {name} --force 100 50 -80 --part-origin-mm 1800 0 900 --tool-length-mm 150 --points points.csv"
        );
        let refused = run(here, &words(&line));
        assert_eq!(refused.code, 1, "{refused:?}");
        let flat = refused.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(flat.contains(looped) && flat.contains("--expand"), "{flat}");
        let said = run(here, &words(&format!("{line} --expand"))).answered();
        let text = words(&said.out).join(" ");
        assert!(text.contains("was run once and written flat"), "{said:?}");
        let named = format!("lines are those of the flat program, flat/{name}");
        assert!(text.contains(&named), "{said:?}");
        let flat = read(here, &format!("flat/{name}"));
        assert!(!flat.contains(looped), "{flat}");
        let printed = run(here, &["expand", name, "--no-comments"]).answered();
        assert_eq!(printed.out, flat);
        // Both slots are there, each line of points with the line of the program that it came from.
        let output = read(here, &format!("compensated/{name}"));
        assert!(output.lines().count() > flat.lines().count(), "{output}");
        let table = read(here, "points.csv");
        assert!(
            table.lines().next().unwrap().contains("source_line"),
            "{table}"
        );
        let odd = run(here, &words(&format!("{line} --expand --parameter 1=2")));
        assert_eq!(odd.code, 1);
        assert!(odd.err.contains("--parameter is for G-code"), "{odd:?}");
        let pose = run(
            here,
            &words(&format!("{line} --expand --correct pose --force-overwrite")),
        );
        assert_eq!(pose.code, 1);
        let said = pose.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            said.contains("does not state how its tool stands"),
            "{said}"
        );
    }
}

/// The reason is that of the language: RAPID states the turn of the tool, and a corrected program keeps it.
#[test]
fn a_program_that_states_the_turn_of_its_tool_keeps_it() {
    let here = place(SLOT);
    let said = run(here.path(), &words(&format!("{RUN} --free-turn")));
    let text = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        text.contains("the program states how the tool is turned about its own axis"),
        "{said:?}"
    );
    assert!(!text.contains("no words"), "{said:?}");
}

/// Speeds and places that are written in another unit, most likely.
#[test]
fn speeds_and_extents_in_a_wrong_unit_are_warned_of() {
    let part = "DEF part()\n $BASE={X 1300,Y 50,Z 900,A 0,B 0,C 0}\n $TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}\n $VEL.CP=0.2\n\
        LIN {X 0,Y 0,Z 30,A 0,B 0,C 180}\n $VEL.CP=0.02\n LIN {X 0,Y 0,Z 0,A 0,B 0,C 180}\n LIN {X 120,Y 0,Z 0,A 0,B 0,C 180}\nEND\n";
    let in_metres = part.replace("X 120", "X 0.12").replace("Z 30", "Z 0.03");
    for (program, rapid_from, said) in [
        (
            part.replace("CP=0.2\n", "CP=20\n"),
            "150",
            "a speed of 20000 mm/s is unusual",
        ),
        (
            part.replace("CP=0.02", "CP=0.00002"),
            "150",
            "a speed of 0.02 mm/s is unusual",
        ),
        (
            part.replace("CP=0.02", "CP=1.2"),
            "2000",
            "a speed of 1200 mm/s is unusual",
        ),
        (in_metres, "150", "are its lengths in metres or centimetres"),
    ] {
        let here = crate::common::workplace();
        std::fs::write(here.path().join("part.src"), program).unwrap();
        let line = format!(
            "compensate --program part.src --out out.src --model heavy_6r --weight all --force 200 -150 300 --rapid-from-mm-per-s {rapid_from}"
        );
        let found = crate::common::run(here.path(), &line.split(' ').collect::<Vec<_>>());
        let text = format!("{}{}", found.out, found.err);
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(said), "{said}: {text}");
    }
}

/// A KRL program with a loop and a data list: its runs need different corrections, and its flat program takes them.
#[test]
fn a_krl_program_with_a_loop_is_compensated_flat_and_verified() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let source = "DEF part()\nINT i\n$TOOL={X 0,Y 0,Z 180,A 0,B 0,C 0}\n$BASE={X 1800,Y 0,Z 900,A 0,B 0,C 0}\n$VEL.CP=0.02\nPTP XP1\nFOR i=1 TO 2\nLIN XP2\n\
        LIN {X 80,Y 0,Z 0,A 0,B 0,C 180}\nENDFOR\nIF $IN[1] THEN\nLIN {X 90,Y 0,Z 0,A 0,B 0,C 180}\nENDIF\nEND\n";
    std::fs::write(here.join("part.src"), source).unwrap();
    let data = "DEFDAT part\nDECL E6POS XP1={X 0,Y 0,Z 50,A 0,B 0,C 180}\nDECL E6POS XP2={X 50,Y 10,Z 0,A 0,B 0,C 180}\nENDDAT\n";
    std::fs::write(here.join("part.dat"), data).unwrap();
    let job = |more: &str| {
        let text = format!(
            "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"part.src\"\n[load]\nforce_n = [100, 50, -80]\nweight = \"all\"\n{more}"
        );
        std::fs::write(here.join("job.toml"), text).unwrap();
    };
    job("");
    let refused = run(here, &["compensate", "job.toml"]);
    let said = words(&refused.err).join(" ");
    assert!(
        refused.code == 1 && said.contains("part.src, line 11") && said.contains("--set"),
        "{said}"
    );
    job("[values]\n\"$IN[1]\" = true\n[expand]\n");
    let done = run(here, &["compensate", "job.toml"]).answered();
    assert!(
        words(&done.out)
            .join(" ")
            .contains("was run once and written flat"),
        "{done:?}"
    );
    let output = read(here, "compensated/part.src");
    assert!(
        !output.contains("FOR") && output.contains("LIN {X 90"),
        "{output}"
    );
    assert_ne!(read(here, "compensated/part.dat"), data, "{output}");
    let verified = run(
        here,
        &["verify", "compensated/part.src", "--job", "job.toml"],
    )
    .answered();
    assert!(verified.out.contains("VERIFIED"), "{verified:?}");
}
