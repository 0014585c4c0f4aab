//! Damping and rotors in model files.

use kinetostat_dynamics::Damping;
use kinetostat_model::{Model, ModelError};

const DRIVE: &str =
    r#"{ actuator = "revolute", name = "drive", axis = "z", stiffness_n_m_per_rad = 1e5 }"#;
const HINGE: &str = r#"{ passive = "universal", name = "hinge", axes = ["y", "z"] }"#;

/// Two limbs of one chain, with what is put in place of parts of the file.
fn read(changes: &[(&str, &str)], behind: &str) -> Result<Model, ModelError> {
    let mut text = format!(
        r#"schema = 1
[mechanism]
name = "pair"
gravity_m_per_s2 = [0, 0, 0]
[[platform]]
name = "tool"
home = {{ position_m = [1, 0, 0] }}
mass_kg = 3
[chain.leg]
elements = [
  {DRIVE},
  {{ rigid = {{ translation_m = [1, 0, 0] }} }},
  {HINGE},
]
[[limb]]
name = "left"
from = "base"
to = "tool"
chain = "leg"
[[limb]]
name = "right"
from = "base"
to = "tool"
chain = "leg"
"#
    );
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    Model::from_toml(&(text + behind), "pair.toml")
}

#[test]
fn a_law_is_read_and_written_again() {
    for (table, law) in [
        ("ratio = 0.03", Damping::Ratio(0.03)),
        ("ratios = [0.02, 0.05]", Damping::Ratios(vec![0.02, 0.05])),
        (
            "rayleigh = { mass_per_s = 1.5, stiffness_s = 2e-5 }",
            Damping::Rayleigh {
                mass_per_s: 1.5,
                stiffness_s: 2e-5,
            },
        ),
        (
            "loss_factor = 0.04",
            Damping::Structural { loss_factor: 0.04 },
        ),
    ] {
        let model = read(&[], &format!("[damping]\n{table}\nsource = \"test\"\n")).unwrap();
        assert_eq!(model.damping(), law);
        let again = Model::from_toml(&model.to_toml().unwrap(), "again.toml").unwrap();
        assert_eq!(again.damping(), law);
    }
    assert_eq!(read(&[], "").unwrap().damping(), Damping::Undamped);
}

#[test]
fn dampers_have_the_names_of_their_coordinates() {
    let drive = DRIVE.replace("1e5", "1e5, damping_n_m_s_per_rad = 40");
    let hinge = HINGE.replace("axes", "damping_n_m_s_per_rad = 0.5, axes");
    let model = read(&[(DRIVE, &drive), (HINGE, &hinge)], "").unwrap();
    let Damping::Viscous(found) = model.damping() else {
        panic!("{:?}", model.damping());
    };
    let expected = [
        ("left.drive", 40.0),
        ("left.hinge.1", 0.5),
        ("left.hinge.2", 0.5),
        ("right.drive", 40.0),
        ("right.hinge.1", 0.5),
        ("right.hinge.2", 0.5),
    ];
    let found: Vec<(&str, f64)> = found.iter().map(|(name, c)| (name.as_str(), *c)).collect();
    assert_eq!(found, expected);
}

#[test]
fn a_rotor_is_read_in_si() {
    let with =
        "1e5, rotor = { inertia_kg_m2 = 1e-3, ratio = -100, servo_stiffness_n_mm_per_rad = 3e8 }";
    let model = read(&[("1e5", with)], "").unwrap();
    for limb in model.mechanism.limbs() {
        let rotor = limb.actual.actuators()[0].rotor.expect("a rotor");
        assert_eq!(rotor.inertia, 1e-3);
        assert_eq!(rotor.ratio, 100.0);
        assert!((rotor.servo_stiffness - 3e5).abs() < 1e-9);
    }
    let slide = DRIVE.replace("revolute", "prismatic").replace(
        "stiffness_n_m_per_rad = 1e5",
        "stiffness_n_per_m = 1e7, rotor = { inertia_kg_m2 = 1e-3, lead_mm_per_turn = 10, servo_stiffness_n_per_mm = 2e4 }",
    );
    let model = read(&[(DRIVE, &slide)], "").unwrap();
    let rotor = model.mechanism.limbs()[0].actual.actuators()[0]
        .rotor
        .unwrap();
    assert!((rotor.ratio - std::f64::consts::TAU / 0.01).abs() < 1e-9);
    assert!((rotor.servo_stiffness - 2e7).abs() < 1e-6);
}

#[test]
fn what_no_machine_has_is_refused_at_its_line() {
    let rotor = |inner: &str| format!("1e5, rotor = {{ {inner} }}");
    let damper = DRIVE.replace("1e5", "1e5, damping_n_m_s_per_rad = 40");
    let rigid = DRIVE.replace(
        "stiffness_n_m_per_rad = 1e5",
        "rigid_drive = true, damping_n_m_s_per_rad = 40",
    );
    for (from, to, behind, line, words) in [
        ("1e5", "1e5", "[damping]\nratio = 3\n", 25, "critical"),
        ("1e5", "1e5", "[damping]\nratio = -0.1\n", 25, "below zero"),
        (
            "1e5",
            "1e5",
            "[damping]\nsource = \"x\"\n",
            25,
            "no law of damping",
        ),
        (
            "1e5",
            "1e5",
            "[damping]\nratio = 0.1\nloss_factor = 0.1\n",
            25,
            "two laws",
        ),
        (
            DRIVE,
            damper.as_str(),
            "[damping]\nratio = 0.1\n",
            25,
            "'left.drive' has a damper of its own",
        ),
        (
            "1e5",
            "1e5, damping_n_m_s_per_rad = -3",
            "",
            11,
            "takes energy out",
        ),
        (
            "1e5",
            "1e5, damping_n_s_per_m = 3",
            "",
            11,
            "write damping_n_m_s_per_rad",
        ),
        (DRIVE, rigid.as_str(), "", 11, "the drive is rigid"),
        (
            "1e5",
            &rotor("inertia_kg_m2 = 0, ratio = 9, servo_stiffness_n_m_per_rad = 3e5"),
            "",
            11,
            "above zero",
        ),
        (
            "1e5",
            &rotor("inertia_kg_m2 = 1, servo_stiffness_n_m_per_rad = 3e5"),
            "",
            11,
            "ratio of the transmission is missing",
        ),
        (
            "1e5",
            &rotor("inertia_kg_m2 = 1, ratio = 9"),
            "",
            11,
            "stiffness of the servo is missing",
        ),
        (
            "1e5",
            &rotor("inertia_kg_m2 = 1, ratio = 9, servo_stiffness_n_m_per_rad = 1e5"),
            "",
            11,
            "in series are softer",
        ),
        (
            "1e5",
            &rotor("inertia_kg_m2 = 1, lead_mm_per_turn = 9, servo_stiffness_n_m_per_rad = 3e5"),
            "",
            11,
            "it turns about its axis",
        ),
    ] {
        let error = read(&[(from, to)], behind).expect_err(words);
        let problem = &error.problems()[0];
        assert_eq!(problem.line, Some(line), "{words}: {error}");
        assert!(error.to_string().contains(words), "{words}: {error}");
    }
}
