//! `kinetostat deflect` of machines that swing, sag or snap under their load.

use crate::common::{Said, run};

const PENDULUM: &str = r#"schema = 1

[mechanism]
name = "pendulum"
gravity_m_per_s2 = [0, 0, -9.81]

[chain.bar]
elements = [
  { actuator = "prismatic", name = "trolley", axis = "x", stiffness_n_per_mm = 500, home_mm = 0 },
  { passive = "revolute", name = "pin", axis = "y" },
  { rigid = { translation_mm = [0, 0, -1000] } },
]

[[platform]]
name = "tool"
home = { position_mm = [0, 0, -1000] }
mass_kg = 20

[[limb]]
name = "bar"
from = "base"
to = "tool"
chain = "bar"
"#;

/// One joint, the tool in its middle.
const JOINT: &str = r#"schema = 1

[mechanism]
name = "joint"

[chain.joint]
elements = [
  { actuator = "revolute", name = "j", axis = "z", stiffness_n_m_per_rad = 5 },
]

[[platform]]
name = "tool"
home = { position_mm = [0, 0, 0] }

[[limb]]
name = "joint"
from = "base"
to = "tool"
chain = "joint"
"#;

/// Two bars of 100 N/mm from the sides to a pin in the middle, 1 m apart; deviation and mass extra.
fn truss(height: f64, mass: f64, deviation: &str) -> String {
    let (turn, length) = (500_f64.atan2(height).to_degrees(), 500_f64.hypot(height));
    let chain = |name: &str, side: f64| {
        format!(
            r#"
[chain.{name}]
elements = [
  {{ rigid = {{ translation_mm = [{x:?}, 0, 0] }} }},
  {{ passive = "revolute", name = "foot", axis = "y", home_deg = {home:?} }},
  {{ actuator = "prismatic", name = "bar", axis = "z", stiffness_n_per_m = 1e5, home_mm = {length:?} }},
  {{ passive = "revolute", name = "head", axis = "y", home_deg = {back:?} }},
]

[[limb]]
name = "{name}"
from = "base"
to = "pin"
chain = "{name}"
"#,
            x = side * 500.0,
            home = -side * turn,
            back = side * turn,
        )
    };
    format!(
        "schema = 1\n\n[mechanism]\nname = \"truss\"\ngravity_m_per_s2 = [0, 0, -9.81]\n\n[[platform]]\nname = \"pin\"\nhome = {{ position_mm = [0, 0, {height:?}] }}\nmass_kg = {mass:?}\n{}{}{deviation}",
        chain("left", -1.0),
        chain("right", 1.0)
    )
}

fn ask(model: &str, query: &[&str]) -> Said {
    let here = tempfile::tempdir().expect("a directory");
    std::fs::write(here.path().join("m.toml"), model).expect("a file");
    let line: Vec<&str> = query
        .iter()
        .map(|word| if *word == "M" { "m.toml" } else { *word })
        .collect();
    run(here.path(), &line)
}

/// What it says, on one line.
fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn a_pendulum_answers_where_it_hangs() {
    let said = ask(PENDULUM, &["deflect", "M", "--force", "50", "0", "0"]).answered();
    // sin and 1 - cos of atan(50 / 196.2), and 50 N on the trolley.
    assert!(said.out.contains("247.049"), "{}", said.out);
    assert!(said.out.contains("30.9715"), "{}", said.out);
    let said = ask(PENDULUM, &["deflect", "M", "--force", "0.5", "0", "0"]).answered();
    assert!(
        said.out.contains("against a force is 0.1961 N/mm"),
        "{}",
        said.out
    );
    let query = [
        "model", "draw", "M", "--force", "50", "0", "0", "--out", "a.svg",
    ];
    let said = ask(PENDULUM, &query).answered();
    assert!(said.out.contains("247.0491"), "{}", said.out);
}

#[test]
fn a_flat_truss_sags_and_goes_together() {
    let flat = truss(0.0, 0.0, "");
    let push = ["--force", "0", "0", "-1"];
    let said = ask(&flat, &[&["deflect", "M"][..], &push].concat()).answered();
    assert!(said.out.contains("-13.57458"), "{}", said.out);
    let range = ["--factor", "0", "1"];
    let said = ask(&flat, &[&["curve", "M"][..], &push, &range].concat()).answered();
    assert!(said.out.contains("13.57459"), "{}", said.out);
    assert!(!said.out.contains("limit of the load"), "{}", said.out);
    let error = "\n[[deviation]]\nlimb = \"right\"\nat = \"start\"\nmoved_by = { translation_mm = [2, 0, 0] }\n";
    let said = ask(&truss(0.0, 2.0, error), &["assemble", "M"]).answered();
    assert!(
        said.out.contains("From the commanded place"),
        "{}",
        said.out
    );
}

#[test]
fn a_limit_on_the_path_is_reported() {
    let push = ["--force", "0", "0", "-151"];
    let said = ask(
        &truss(100.0, 0.0, ""),
        &[&["deflect", "M"][..], &push].concat(),
    );
    assert_eq!(said.code, 2, "{said:?}");
    let reported = words(&said.err);
    for part in [
        "0.999718 of this load",
        "-42.6428] mm",
        "snaps",
        "kinetostat curve",
        "kinetostat equilibria",
    ] {
        assert!(reported.contains(part), "{reported}");
    }
    let push = ["--force", "0", "0", "-0.001"];
    let said = ask(
        &truss(0.1, 0.0, ""),
        &[&["deflect", "M"][..], &push].concat(),
    )
    .answered();
    let reported = words(&said.out);
    assert!(
        reported.contains("SNAPS on the way to this load"),
        "{reported}"
    );
    // The limit lies a little beyond this load.
    let push = ["--force", "0", "0", "-150.9"];
    let said = ask(
        &truss(100.0, 0.0, ""),
        &[&["deflect", "M"][..], &push].concat(),
    )
    .answered();
    let reported = words(&said.out);
    assert!(
        !reported.contains("SNAPS") && !reported.contains("NOT stay"),
        "{reported}"
    );
    let push = ["--force", "0", "0", "-100"];
    let said = ask(
        &truss(100.0, 0.0, ""),
        &[&["deflect", "M"][..], &push].concat(),
    )
    .answered();
    assert!(!said.out.contains("SNAPS"), "{}", said.out);
}

#[test]
fn no_force_moves_a_joint_in_its_middle() {
    let said = ask(JOINT, &["deflect", "M", "--force", "1", "0", "0"]).answered();
    assert!(said.out.contains("no force moves it"), "{}", said.out);
    let said = ask(JOINT, &["check", "M"]).answered();
    assert!(
        !words(&said.out).contains("against a force the tool is stiff"),
        "{}",
        said.out
    );
    assert!(
        words(&said.out).contains("against a moment the tool is stiff with 5.000 N m/rad"),
        "{}",
        said.out
    );
}

/// Two links of 1 m on springs of 1 N m/rad, along x, pressed by a jet that turns with the tip.
fn column(jet: f64) -> String {
    format!(
        r#"schema = 1

[mechanism]
name = "column"

[[platform]]
name = "tool"
home = {{ position_m = [2, 0, 0] }}

[chain.c]
elements = [
  {{ spring = "revolute", name = "a", axis = "z", stiffness_n_m_per_rad = 1.0 }},
  {{ rigid = {{ translation_m = [1, 0, 0] }} }},
  {{ spring = "revolute", name = "b", axis = "z", stiffness_n_m_per_rad = 1.0 }},
  {{ rigid = {{ translation_m = [1, 0, 0] }} }},
]

[[limb]]
name = "l"
from = "base"
to = "tool"
chain = "c"

[[limb.load]]
wrench = "jet"
node = "tip"
force_n = [{:?}, 0, 0]
axes = "node"
"#,
        -jet
    )
}

/// A moment turns the tip by `2 - P` rad/(N m), a force across moves it by `5 - 2 P` m/N: beyond, against
/// itself, which is no stiffness. Nothing buckles under a jet alone.
#[test]
fn what_a_jet_takes_from_the_stiffness_is_reported_and_called_no_buckling() {
    for jet in [0.0, 0.5, 1.0, 1.7, 1.9, 2.1, 2.4, 2.6, 3.0, 7.0] {
        let said = ask(&column(jet), &["check", "M", "--json"]).answered();
        let found: serde_json::Value = serde_json::from_str(&said.out).expect("JSON");
        let a = &found["assumptions"];
        for (name, kind, yields) in [
            ("against_moment_n_m_per_rad", "moment", 2.0 - jet),
            ("against_force_n_per_mm", "force", 1e3 * (5.0 - 2.0 * jet)),
        ] {
            let none = format!("no stiffness against a {kind} is reported");
            let words = words(&ask(&column(jet), &["check", "M"]).answered().out);
            assert_eq!(words.contains(&none), yields < 0.0, "{jet}: {words}");
            match yields > 0.0 {
                true => {
                    let reported = a[name][0].as_f64().expect(name);
                    assert!(
                        (reported * yields - 1.0).abs() < 1e-6,
                        "{jet}: {name} {reported}"
                    );
                }
                false => assert!(a[name].is_null(), "{jet}: {name} {}", a[name]),
            }
            assert!(!words.contains("NEAR BUCKLING"), "{jet}: {words}");
            let swings = words.contains("Warning") && words.contains("may swing");
            assert_eq!(swings, jet > 2.0, "{jet}: {words}");
        }
    }
}

/// The same question, asked in three ways: what `deflect` calls lost, `equilibria` and `curve` call lost.
#[test]
fn deflect_equilibria_and_curve_agree_on_a_column_under_a_jet() {
    let model = column(2.6);
    // The symmetric part is negative in every motion from here on.
    let lost = 0.2 + 0.73_f64.sqrt();
    for force in [0.5, 1.0, 1.04, 1.07, 1.5, 2.0] {
        let push = format!("{:?}", -force);
        let push = ["--force", &push, "0", "0"];
        let deflect = ask(&model, &[&["deflect", "M"][..], &push].concat()).answered();
        let reported = words(&format!("{}{}", deflect.out, deflect.err));
        assert_eq!(
            reported.contains("does NOT stay"),
            force > lost,
            "{reported}"
        );
        let said = ask(&model, &[&["equilibria", "M"][..], &push].concat()).answered();
        let reported = words(&said.out);
        assert_eq!(reported.contains("may swing"), force < lost, "{reported}");
        assert_eq!(
            reported.contains("it is NOT stable"),
            force > lost,
            "{reported}"
        );
    }
    let line = [
        "curve", "M", "--force", "-1", "0", "0", "--factor", "0", "3", "--json",
    ];
    let said = ask(&model, &line).answered();
    let found: serde_json::Value = serde_json::from_str(&said.out).expect("JSON");
    let points = found["branches"][0]["points"].as_array().expect("points");
    assert!(points.len() > 10);
    for p in points {
        let factor = p["factor"].as_f64().expect("a factor");
        let stays = p["stable_under_dead_load"] == true;
        assert_eq!(stays, factor < lost, "{factor}");
        assert_eq!(p["may_flutter"] == true, factor < lost, "{factor}");
    }
}
