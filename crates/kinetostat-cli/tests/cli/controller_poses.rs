//! Poses jogged on the machine, compared by `check --pose`: signs, zeros, couplings and frames of a model that count
//! otherwise than the controller.

use crate::common::{Said, run, workplace};
use crate::controller::{CONTROLLER, NAMES, POSES, model, plain, tool};
use nalgebra::{Isometry3, vector};
use serde_json::Value as Json;
use toml::{Table, Value};

/// A table of the poses: `shown` says what the controller shows, `seen` where the tool is measured.
fn table(
    names: [&str; 6],
    shown: impl Fn([f64; 6]) -> [f64; 6],
    seen: impl Fn(Isometry3<f64>) -> Isometry3<f64>,
) -> String {
    let mut text = format!("{},x_mm,y_mm,z_mm,a_b_c_kuka_deg\n", names.join(","));
    for q in POSES {
        let pose = seen(tool(q));
        let cells: Vec<String> = shown(q).iter().map(f64::to_string).collect();
        let p = pose.translation.vector;
        // Rz(A) Ry(B) Rx(C).
        let (c, b, a) = pose.rotation.euler_angles();
        let turn = [a, b, c].map(|x| x.to_degrees().to_string()).join(" ");
        text.push_str(&format!(
            "{},{},{},{},{turn}\n",
            cells.join(","),
            p.x,
            p.y,
            p.z
        ));
    }
    text
}

fn same(pose: Isometry3<f64>) -> Isometry3<f64> {
    pose
}

/// Runs `check --pose` on a model and a table.
fn compared(model: &str, table: &str) -> (Said, Json) {
    let here = workplace();
    std::fs::write(here.path().join("arm.toml"), model).expect("written");
    std::fs::write(here.path().join("poses.csv"), table).expect("written");
    let said = run(
        here.path(),
        &["check", "arm.toml", "--pose", "poses.csv", "--json"],
    )
    .answered();
    let json = serde_json::from_str(&said.out).expect("JSON");
    (said, json)
}

fn explanations(json: &Json) -> Vec<String> {
    let list = json["explanations"].as_array().expect("a list");
    list.iter()
        .map(|e| e.as_str().expect("words").to_owned())
        .collect()
}

#[test]
fn poses_that_agree_are_reported_to_agree() {
    let (said, json) = compared(&model(plain, ""), &table(NAMES, |q| q, same));
    assert_eq!(json["agrees"], true, "{}", said.err);
    for pose in json["poses"].as_array().expect("poses") {
        assert!(pose["difference_mm"].as_f64().expect("mm") < 1e-9, "{pose}");
        assert!(
            pose["difference_deg"].as_f64().expect("deg") < 1e-9,
            "{pose}"
        );
    }
    // In the controller's coordinates too.
    let shown = |q: [f64; 6]| [q[0], q[1], q[2] - q[1], -q[3], q[4], q[5]];
    let axes = ["J1", "J2", "J3", "J4", "J5", "J6"];
    let (said, json) = compared(&model(plain, CONTROLLER), &table(axes, shown, same));
    assert_eq!(json["agrees"], true, "{}", said.err);
    assert!(
        said.err.contains("joint values of the controller"),
        "{}",
        said.err
    );
}

/// A changed way of counting and the one sentence that must come out.
type Case = (fn([f64; 6]) -> [f64; 6], &'static str);

#[test]
fn three_poses_tell_signs_zeros_and_couplings() {
    let cases: [Case; 7] = [
        (
            |q| [q[0], q[1], -q[2], q[3], q[4], q[5]],
            "sign of joint_3 is reversed",
        ),
        (
            |q| [-q[0], q[1], q[2], -q[3], q[4], -q[5]],
            "signs of joint_1, joint_4, joint_6 are reversed",
        ),
        (
            |q| [q[0], q[1] - 90.0, q[2], q[3], q[4], q[5]],
            "zero of joint_2 is off: 90 deg have to be added",
        ),
        (
            |q| [q[0], q[1] - 90.0, q[2] + 90.0, q[3], q[4], q[5]],
            "zero of joint_2 is off: 90 deg have to be added to what is shown; zero of joint_3 is off: -90 deg",
        ),
        (
            |q| [q[0], q[1], q[2] - q[1], q[3], q[4], q[5]],
            "joint_3 is coupled with joint_2: the model needs joint_3 + joint_2",
        ),
        (
            |q| [q[0], q[1], -q[2] - q[1], q[3], q[4], q[5]],
            "sign of joint_3 is reversed",
        ),
        (
            |q| [q[0], q[1], q[2] + 3.7, q[3], q[4], q[5]],
            "zero of joint_3 is off: -3.7 deg have to be added",
        ),
    ];
    for (shown, expected) in cases {
        let (said, json) = compared(&model(plain, ""), &table(NAMES, shown, same));
        assert_eq!(json["agrees"], false);
        let found = explanations(&json);
        assert_eq!(found.len(), 1, "{}", said.err);
        assert!(found[0].contains(expected), "{expected}: {}", said.err);
    }
}

/// The coupling that the file declares may be wrong too: its sign, or that there is one at all.
#[test]
fn couplings_that_are_declared_wrongly_are_reported_with_what_to_write() {
    let axes = ["J1", "J2", "J3", "J4", "J5", "J6"];
    // As FANUC arms count, and as CONTROLLER says.
    let right: fn([f64; 6]) -> [f64; 6] = |q| [q[0], q[1], q[2] - q[1], -q[3], q[4], q[5]];
    let other = CONTROLLER.replace("ratio = -1", "ratio = 1");
    let absent: fn([f64; 6]) -> [f64; 6] = |q| [q[0], q[1], q[2], -q[3], q[4], q[5]];
    let none = CONTROLLER.replace(", coupled = [{ joint = \"joint_2\", ratio = -1 }]", "");
    // The coupled joint is itself shown the other way, with a zero, and its sign is wrong as well.
    let far = CONTROLLER.replace("ratio = -1", "ratio = 1").replace(
        "joint = \"joint_2\" }",
        "joint = \"joint_2\", reversed = true, zero_offset_deg = 90 }",
    );
    let both: fn([f64; 6]) -> [f64; 6] = |q| [q[0], q[1] + 90.0, q[2] - q[1], -q[3], q[4], q[5]];
    // Only 'reversed' of the coupled axis is wrong.
    let turned: fn([f64; 6]) -> [f64; 6] = |q| [q[0], q[1], -q[2] - q[1], -q[3], q[4], q[5]];
    let cases = [
        (
            other.clone(),
            right,
            "coupling of J3 with 'joint_2' has the wrong sign (in the section [controller], in 'coupled' of J3, write for 'joint_2' ratio = -1)",
        ),
        (
            CONTROLLER.to_owned(),
            absent,
            "J3 is declared to be coupled with 'joint_2', but the controller shows it without (in the section [controller], remove 'joint_2' from 'coupled' of J3)",
        ),
        (
            none,
            right,
            "the model needs J3 + J2 (write in the section [controller], at J3: coupled = [{ joint = \"joint_2\", ratio = -1 }])",
        ),
        (
            far,
            both,
            "sign of J2 is reversed; the coupling of J3 with 'joint_2' has the wrong sign",
        ),
        (
            CONTROLLER.to_owned(),
            turned,
            "sign of J3 is reversed (change",
        ),
    ];
    for (controller, shown, expected) in cases {
        let (said, json) = compared(&model(plain, &controller), &table(axes, shown, same));
        assert_eq!(json["agrees"], false);
        let found = explanations(&json);
        assert_eq!(found.len(), 1, "{}", said.err);
        assert!(found[0].contains(expected), "{expected}: {}", said.err);
    }
}

#[test]
fn frames_that_are_elsewhere_are_reported_with_their_place() {
    let base = Isometry3::new(vector![100.0, -50.0, 300.0], vector![0.0, 0.2, 0.4]);
    let (said, json) = compared(&model(plain, ""), &table(NAMES, |q| q, |pose| base * pose));
    let found = explanations(&json);
    assert!(
        found.len() == 1 && found[0].contains("base frame is another one"),
        "{}",
        said.err
    );
    assert!(found[0].contains("(100, -50, 300) mm"), "{}", said.err);
    let flange = Isometry3::new(vector![0.0, 20.0, 180.0], vector![0.0, -1.2, 0.5]);
    let (said, json) = compared(
        &model(plain, ""),
        &table(NAMES, |q| q, |pose| pose * flange),
    );
    let found = explanations(&json);
    assert!(
        found.len() == 1 && found[0].contains("tool frame is another one"),
        "{}",
        said.err
    );
    assert!(found[0].contains("(0, 20, 180) mm"), "{}", said.err);
}

/// The first joint's zero and a base turned about its axis cannot be distinguished, and are not.
#[test]
fn what_the_poses_do_not_decide_is_reported_so() {
    let shown = |q: [f64; 6]| [q[0] - 25.0, q[1], q[2], q[3], q[4], q[5]];
    let (said, json) = compared(&model(plain, ""), &table(NAMES, shown, same));
    assert_eq!(json["ambiguous"], true, "{}", said.err);
    let found = explanations(&json).join("\n");
    assert!(found.contains("zero of joint_1 is off: 25 deg"), "{found}");
    assert!(found.contains("base frame"), "{found}");
    // Links of other lengths are no matter of counting.
    let seen = |mut pose: Isometry3<f64>| {
        pose.translation.vector.x *= 1.1;
        pose
    };
    let (said, json) = compared(&model(plain, ""), &table(NAMES, |q| q, seen));
    assert!(explanations(&json).is_empty(), "{}", said.err);
    assert!(
        said.err.contains("Lengths of the links may differ"),
        "{}",
        said.err
    );
}

/// A model with printed tables pasted into it: keys of a table replace those of the table with its name.
fn pasted(model: &str, tables: &str) -> String {
    let mut whole: Table = model.parse().expect("a model");
    let new: Table = tables.parse().expect("TOML");
    for (key, value) in new {
        match value {
            Value::Array(rows) => {
                let old = whole[&key].as_array_mut().expect("tables");
                for row in &rows {
                    let own = old.iter_mut().find(|r| r["name"] == row["name"]);
                    let own = own.expect("a table of this name").as_table_mut();
                    own.expect("a table")
                        .extend(row.as_table().expect("a table").clone());
                }
            }
            Value::Table(keys) if key == "mechanism" => {
                whole[&key].as_table_mut().expect("a table").extend(keys);
            }
            value => {
                whole.insert(key, value);
            }
        }
    }
    whole.to_string()
}

/// Compares, pastes what is printed and compares again.
fn agrees_with_its_tables(model: &str, table: &str) -> (Said, Json) {
    let (said, json) = compared(model, table);
    assert_eq!(json["agrees"], false, "{}", said.err);
    let tables = &json["tables"];
    let text = tables["toml"].as_str().expect("tables");
    assert!(said.err.contains(text), "{}", said.err);
    assert!(
        tables["difference_mm"].as_f64().expect("mm") < 1e-3,
        "{tables}"
    );
    let (again, after) = compared(&pasted(model, text), table);
    assert_eq!(after["agrees"], true, "{text}{}", again.err);
    (said, json)
}

#[test]
fn pasted_tables_make_the_poses_agree() {
    let axes = ["J1", "J2", "J3", "J4", "J5", "J6"];
    let flange = Isometry3::new(vector![0.0, 20.0, 180.0], vector![0.0, -1.2, 0.5]);
    let base = Isometry3::new(vector![100.0, -50.0, 300.0], vector![0.0, 0.2, 0.4]);
    // Signs, zeros and a tool at once.
    let shown = |q: [f64; 6]| [-q[0], q[1] - 90.0, q[2] + 90.0, -q[3], q[4], -q[5]];
    let arm = model(plain, "");
    let poses = table(NAMES, shown, |pose| pose * flange);
    let (_, json) = agrees_with_its_tables(&arm, &poses);
    let tables = &json["tables"];
    assert_eq!(tables["poses"], 3);
    assert_eq!(tables["controller"]["axis"][1]["zero_offset_deg"], -90.0);
    assert_eq!(tables["controller"]["axis"][3]["reversed"], true);
    assert_eq!(
        tables["tool_in_flange"]["position_mm"],
        serde_json::json!([0.0, 20.0, 180.0])
    );
    // A coupling of the wrong sign and a sign, in a declared controller.
    let wrong = CONTROLLER.replace("ratio = -1", "ratio = 1");
    let shown = |q: [f64; 6]| [q[0], q[1], q[2] - q[1], q[3], q[4], q[5]];
    let (_, json) = agrees_with_its_tables(&model(plain, &wrong), &table(axes, shown, same));
    let coupled = &json["tables"]["controller"]["axis"][2]["coupled"][0];
    assert_eq!(
        (&coupled["joint"], &coupled["ratio"]),
        (&"joint_2".into(), &(-1.0).into())
    );
    // Any zero, and a base whose axes are others: gravity is turned with it.
    let shown = |q: [f64; 6]| [q[0], q[1], q[2] + 3.7, q[3], q[4], q[5]];
    agrees_with_its_tables(&arm, &table(NAMES, shown, same));
    let heavy = arm.replace(
        "name = \"arm\"\n[[platform]]\n",
        "name = \"arm\"\ngravity_m_per_s2 = [0, 0, -9.81]\n[[platform]]\nmass_kg = 5\n",
    );
    let (_, json) = agrees_with_its_tables(&heavy, &table(NAMES, |q| q, |pose| base * pose));
    let down = base.rotation * vector![0.0, 0.0, -9.81];
    let text = json["tables"]["toml"].as_str().expect("tables");
    let gravity = text.parse::<Table>().expect("TOML")["mechanism"]["gravity_m_per_s2"].clone();
    for (i, g) in gravity.as_array().expect("three").iter().enumerate() {
        assert!(
            (g.as_float().expect("a number") - down[i]).abs() < 1e-6,
            "{text}"
        );
    }
}

/// A preset as another controller counts it, with a tool, measured along the program's own kinematics.
#[test]
fn a_preset_becomes_the_machine_of_its_poses() {
    let here = workplace();
    let arm = include_str!("../../../kinetostat-model/models/kuka_kr270_like.toml");
    let tool = Isometry3::new(vector![20.0, -5.0, 230.0], vector![0.0, 0.0, 0.8]);
    let mut text = "A1,A2,A3,A4,A5,A6,x_mm,y_mm,z_mm,rotation_vector_deg\n".to_owned();
    for [a, b, c, d, e, f] in [
        [12.0, -75.0, 80.0, 41.0, -52.0, 63.0],
        [-37.0, -100.0, 110.0, -64.0, 35.0, -81.0],
        [71.0, -60.0, 95.0, 27.0, 66.0, 19.0],
    ] {
        let joints = format!("A1={a},A2={b},A3={c},A4={d},A5={e},A6={f}");
        let line = [
            "stiffness",
            "kuka_kr270_like",
            "--json",
            "--joints",
            &joints,
        ];
        let said = run(here.path(), &line).answered();
        let json: Json = serde_json::from_str(&said.out).expect("JSON");
        let [p, turn] = ["position_mm", "rotation_vector_deg"].map(|key| {
            let list = &json["place"][key];
            vector![0, 1, 2].map(|i: usize| list[i].as_f64().expect("a number"))
        });
        let seen = Isometry3::new(p, turn.map(f64::to_radians)) * tool;
        let (p, turn) = (
            seen.translation.vector,
            seen.rotation.scaled_axis().map(f64::to_degrees),
        );
        text.push_str(&format!(
            "{},{},{},{},{e},{},{},{},{},{} {} {}\n",
            -a,
            b + 90.0,
            c - 90.0,
            -d,
            -f,
            p.x,
            p.y,
            p.z,
            turn.x,
            turn.y,
            turn.z
        ));
    }
    agrees_with_its_tables(arm, &text);
}

#[test]
fn what_measured_poses_cannot_tell_is_said_beside_the_tables() {
    // The second joint rests, and no orientation was measured.
    let shown = |q: [f64; 6]| [q[0], q[1], q[2] - 90.0, q[3], q[4], q[5]];
    let poses = table(NAMES, shown, same);
    let bare: String = poses
        .lines()
        .map(|line| line.rsplit_once(',').expect("cells").0.to_owned() + "\n")
        .collect();
    let (said, json) = compared(&model(plain, ""), &bare);
    let undecided = json["tables"]["undecided"].to_string();
    assert!(
        undecided.contains("no orientation was measured"),
        "{}",
        said.err
    );
    let one = poses.lines().take(2).collect::<Vec<_>>().join("\n");
    let (said, json) = compared(&model(plain, ""), &one);
    let undecided = json["tables"]["undecided"].to_string();
    for words in [
        "joint_2 has one value in all poses",
        "an offset of the tool and one of the base are the same",
    ] {
        assert!(undecided.contains(words), "{words}: {}", said.err);
    }
    // Deviations at the flange are stated in its frame.
    let deviation = "[[deviation]]\nlimb = \"arm\"\nat = \"end\"\nmoved_by = { translation_mm = [0.1, 0, 0] }\n";
    let flange = Isometry3::new(vector![0.0, 20.0, 180.0], vector![0.0, -1.2, 0.5]);
    let poses = table(NAMES, |q| q, |pose| pose * flange);
    let (said, json) = compared(&model(plain, deviation), &poses);
    assert!(json["tables"].is_null(), "{}", said.err);
    assert_eq!(
        json["tables_missing"],
        "the model has deviations, stated in a frame that changes"
    );
}

#[test]
fn orientations_without_a_convention_are_refused() {
    let here = workplace();
    std::fs::write(here.path().join("arm.toml"), model(plain, "")).expect("written");
    let good = table(NAMES, |q| q, same);
    let toml = "schema = 1\n[[pose]]\njoints = { joint_1 = 0, joint_2 = 0, joint_3 = 0, joint_4 = 0, joint_5 = 0, joint_6 = 0 }\ntool = { position_mm = [1680, 20, 1945] }\n";
    std::fs::write(here.path().join("poses.toml"), toml).expect("written");
    let said = run(here.path(), &["check", "arm.toml", "--pose", "poses.toml"]).answered();
    assert!(said.out.contains("The model agrees"), "{}", said.out);
    for (text, needle) in [
        (good.replace("a_b_c_kuka_deg", "abc"), "is not known"),
        (
            good.replace("a_b_c_kuka_deg", "a_deg"),
            "whose convention is not named",
        ),
        (good.replace("joint_6", "joint_5"), "appears in two columns"),
        (
            good.replace("joint_6,", ""),
            "no column for the joint 'joint_6'",
        ),
        (good.replace("y_mm", "b"), "whose convention is not named"),
        (good.replace("12,", "zwölf,"), "line 2"),
        (
            "joint_1,x_mm\n".to_owned(),
            "no column for the joint 'joint_2'",
        ),
        (String::new(), "poses.csv"),
    ] {
        std::fs::write(here.path().join("poses.csv"), &text).expect("written");
        let said = run(here.path(), &["check", "arm.toml", "--pose", "poses.csv"]);
        assert_eq!(said.code, 1, "{text}: {said:?}");
        assert!(said.err.contains(needle), "{needle}: {said:?}");
    }
    // Three columns of one convention are fine; so is none.
    let split = good.replace(
        "a_b_c_kuka_deg",
        "a_b_c_kuka_deg_1,a_b_c_kuka_deg_2,a_b_c_kuka_deg_3",
    );
    let split: String = split
        .lines()
        .map(|line| line.replace(' ', ",") + "\n")
        .collect();
    let bare: String = good
        .lines()
        .map(|line| line.rsplit_once(',').expect("cells").0.to_owned() + "\n")
        .collect();
    for text in [split, bare] {
        std::fs::write(here.path().join("poses.csv"), &text).expect("written");
        let said = run(here.path(), &["check", "arm.toml", "--pose", "poses.csv"]).answered();
        assert!(said.out.contains("The model agrees"), "{}", said.out);
    }
}
