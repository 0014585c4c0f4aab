//! Poses jogged on the machine, compared by `check --pose`: signs, zeros, couplings and frames of a model that count
//! otherwise than the controller.

use crate::common::{Said, run, workplace};
use crate::controller::{CONTROLLER, NAMES, POSES, model, plain, tool};
use nalgebra::{Isometry3, vector};
use serde_json::Value;

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
fn compared(model: &str, table: &str) -> (Said, Value) {
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

fn explanations(json: &Value) -> Vec<String> {
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
