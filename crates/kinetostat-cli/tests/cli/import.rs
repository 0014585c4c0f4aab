//! `kinetostat import urdf`: from a file of another program to a model that `check` describes.

use crate::common::{run, workplace};
use serde_json::Value;

/// A turning and a sliding joint, a counterweight that a mimic joint moves.
pub(crate) const URDF: &str = r#"<robot name="crane">
  <link name="post"/>
  <link name="boom"><inertial><origin xyz="0.8 0 0"/><mass value="40"/><inertia ixx="1" ixy="0" ixz="0" iyy="9" iyz="0" izz="9"/></inertial></link>
  <link name="weight"><inertial><origin xyz="0 0 -0.2"/><mass value="35"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1.5"/></inertial></link>
  <link name="trolley"/>
  <joint name="lift" type="revolute"><origin xyz="0 0 2"/><parent link="post"/><child link="boom"/><axis xyz="0 -1 0"/><limit lower="-0.5" upper="1.2" effort="0" velocity="1"/></joint>
  <joint name="level" type="continuous"><origin xyz="-0.5 0 0"/><parent link="boom"/><child link="weight"/><axis xyz="0 1 0"/><mimic joint="lift"/></joint>
  <joint name="run" type="prismatic"><origin xyz="1.5 0 0"/><parent link="boom"/><child link="trolley"/><axis xyz="1 0 0"/><limit lower="-1" upper="0" effort="0" velocity="1"/></joint>
</robot>
"#;

#[test]
fn a_urdf_becomes_a_model_that_check_describes() {
    let here = workplace();
    std::fs::write(here.path().join("crane.urdf"), URDF).expect("a file");
    std::fs::write(
        here.path().join("k.csv"),
        "name,value,unit\nlift,2e6,N m/rad\nrun,5e4,N/mm\n",
    )
    .expect("a file");
    std::fs::write(
        here.path().join("tube.toml"),
        "tube = { outer_diameter_mm = 200, inner_diameter_mm = 180 }\nyoungs_modulus_gpa = 210\npoissons_ratio = 0.3\n",
    )
    .expect("a file");
    let line = "import urdf crane.urdf --base post --tip trolley --joint-stiffness k.csv --link-section tube.toml --home lift=20deg -o crane.toml";
    let words: Vec<&str> = line.split(' ').collect();
    let said = run(here.path(), &words).answered();
    for needle in [
        "lift, run",
        "follow them",
        "level",
        "75.0 kg in 2 bodies",
        "kinetostat check crane.toml",
    ] {
        assert!(said.out.contains(needle), "{needle}: {}", said.out);
    }
    let checked = run(here.path(), &["check", "crane.toml", "--json"]).answered();
    let found: Value = serde_json::from_str(&checked.out).expect("JSON");
    assert_eq!(found["mass_kg"], 75.0);
    assert_eq!(found["limbs"][0]["actuators"][0]["name"], "lift");
    let home = found["limbs"][0]["actuators"][0]["home"]
        .as_f64()
        .expect("a number");
    assert!((home - 20.0).abs() < 1e-9);
    assert!(found["home_problem"].is_null(), "{}", checked.out);
    // Nothing is overwritten without leave.
    let again = run(here.path(), &words);
    assert_eq!(again.code, 1);
    assert!(again.err.contains("it exists already"), "{}", again.err);
    // The inputs least of all.
    let words: Vec<&str> = "import urdf crane.urdf --tip trolley -o crane.urdf --force-overwrite"
        .split(' ')
        .collect();
    let said = run(here.path(), &words);
    assert_eq!(said.code, 1);
    assert!(
        said.err.contains("inputs are never overwritten"),
        "{}",
        said.err
    );
}

#[test]
fn the_summary_is_json_and_the_model_can_go_to_the_standard_output() {
    let here = workplace();
    std::fs::write(here.path().join("crane.urdf"), URDF).expect("a file");
    let words: Vec<&str> = "import urdf crane.urdf --tip trolley -o m.toml --json"
        .split(' ')
        .collect();
    let said = run(here.path(), &words).answered();
    let found: Value = serde_json::from_str(&said.out).expect("JSON");
    assert_eq!(found["schema"], 1);
    assert_eq!(found["kinetostat_version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(found["rigid_drives"], serde_json::json!(["lift", "run"]));
    assert_eq!(found["mass_kg"], 75.0);
    assert!(found["notices"].as_array().is_some_and(|n| !n.is_empty()));
    let words: Vec<&str> = "import urdf crane.urdf --tip trolley".split(' ').collect();
    let said = run(here.path(), &words).answered();
    let file = std::fs::read_to_string(here.path().join("m.toml")).expect("the model");
    assert_eq!(said.out, file);
    assert!(said.err.contains("FILL IN"), "{}", said.err);
}

/// Limits of the URDF hold in the model: a pose that needs more is refused with the joint and its limits.
#[test]
fn limits_are_checked_when_a_pose_is_requested() {
    let here = workplace();
    std::fs::write(here.path().join("crane.urdf"), URDF).expect("a file");
    let line = "import urdf crane.urdf --tip trolley --joint-stiffness 1e6 -o crane.toml";
    run(here.path(), &line.split(' ').collect::<Vec<_>>()).answered();
    // Along the boom: 1 m inwards is possible, half a metre outwards is not.
    let inside = ["stiffness", "crane.toml", "--at", "600", "0", "2000"];
    run(here.path(), &inside).answered();
    let outside = ["stiffness", "crane.toml", "--at", "2000", "0", "2000"];
    let said = run(here.path(), &outside);
    assert_eq!(said.code, 2, "{said:?}");
    for needle in ["'run'", "500 mm", "-1000 .. 0 mm"] {
        assert!(said.err.contains(needle), "{needle}: {}", said.err);
    }
}

#[test]
fn wrong_questions_end_with_one() {
    let here = workplace();
    std::fs::write(here.path().join("crane.urdf"), URDF).expect("a file");
    std::fs::write(
        here.path().join("bad.urdf"),
        URDF.replace("0 -1 0", "0 0 0"),
    )
    .expect("a file");
    for (line, needle) in [
        (
            "import urdf none.urdf --tip trolley",
            "there is no such file",
        ),
        ("import urdf crane.urdf", "which link carries the tool?"),
        (
            "import urdf crane.urdf --tip troley",
            "did you mean 'trolley'?",
        ),
        (
            "import urdf bad.urdf --tip trolley",
            "the axis has no direction",
        ),
        (
            "import urdf crane.urdf --tip trolley --joint-stiffness -5",
            "no number above zero",
        ),
        (
            "import urdf crane.urdf --tip trolley --joint-stiffness none.csv",
            "there is no such file",
        ),
        (
            "import urdf crane.urdf --tip trolley --link-section crane.urdf",
            "this is no section",
        ),
        (
            "import urdf crane.urdf --tip trolley --home lift=20",
            "with a unit",
        ),
        (
            "import urdf crane.urdf --tip trolley --home lift=200deg",
            "outside the limits",
        ),
        (
            "import urdf crane.urdf --tip trolley --passive level",
            "follows another",
        ),
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let said = run(here.path(), &words);
        assert_eq!(said.code, 1, "{line}: {said:?}");
        assert!(said.err.contains(needle), "{line}: {}", said.err);
        assert!(said.out.is_empty(), "{line}: {}", said.out);
    }
    // JSON takes the place of the model where no file is requested.
    let words = ["import", "urdf", "crane.urdf", "--tip", "trolley", "--json"];
    let said = run(here.path(), &words).answered();
    let found: serde_json::Value = serde_json::from_str(&said.out).expect("JSON");
    assert_eq!(found["output"], serde_json::Value::Null);
}
