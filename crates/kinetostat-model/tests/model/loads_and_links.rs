//! Loads and links of a model file are those that the core builds from the same numbers in SI.

use kinetostat::{
    Anchor, BeamSection, LengthLaw, LinkSpec, Load, MechanismEquilibrium, PlatformLoad, Pose,
    Wrench,
    model::{LinkConvention, LinkMass, MassModel, SpringLaw},
};
use kinetostat_model::{Model, preset_text};
use kinetostat_testing::LargestEntry;
use nalgebra::{Matrix6, Rotation3, Unit, Vector3, vector};

fn model(text: &str) -> Model {
    Model::from_toml(text, "model.toml").unwrap_or_else(|e| panic!("{e}"))
}

/// An arm with one link; `link` is what is said of it, `more` comes after the limb.
fn arm(link: &str, more: &str) -> Model {
    model(&format!(
        r#"
schema = 1
[mechanism]
name = "arm"
gravity_m_per_s2 = [0, 0, -9.81]
[[platform]]
name = "tool"
home = {{ position_mm = [800, 0, 0] }}
[section.tube]
tube = {{ outer_diameter_mm = 40, inner_diameter_mm = 36 }}
youngs_modulus_gpa = 70
shear_modulus_gpa = 26
[stiffness.cantilever]
section = "tube"
length_mm = 600
[chain.arm]
elements = [
  {{ actuator = "revolute", name = "shoulder", axis = "z", stiffness_n_m_per_rad = 2e5 }},
  {{ rigid = {{ translation_mm = [200, 0, 0] }}, name = "console" }},
  {{ {link}, name = "boom" }},
  {{ node = "lug" }},
  {{ body = "ballast", mass_kg = 2, centre_of_mass_mm = [-100, 0, 0] }},
]
[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
{more}
"#
    ))
}

const STRAIGHT: &str = r#"link = "tube", length_mm = 600"#;

fn tube() -> BeamSection {
    BeamSection::tube(7e10, 2.6e10, 0.04, 0.036)
}

#[test]
fn every_kind_of_load_is_the_core_s() {
    let model = arm(
        STRAIGHT,
        r#"
[[limb.load]]
wrench = "hose"
node = "lug"
axes = "base"
force_n = [1, -2, 3]
moment_n_mm = [4000, 5000, -6000]
[[limb.load]]
wrench = "jet"
node = "ballast"
axes = "node"
force_n = [0, 7, 0]
[[limb.load]]
spring = "balancer"
from = { node = "base", position_mm = [0, 0, 500] }
to = { node = "console", position_m = [0.01, 0.02, 0.03] }
stiffness_n_per_mm = 5
free_length_mm = 100
preload_n = 12
[[limb.load]]
spring = "ideal"
from = { node = "shoulder", position_mm = [0, 50, 0] }
to = { node = "boom" }
stiffness_n_per_m = 300
free_length_m = 0
[[limb.load]]
gas_spring = "lifter"
from = { node = "base", position_mm = [0, 0, -400] }
to = { node = "tip" }
force_n = 200
length_mm = 500
column_mm = 900
exponent = 1.2
[[limb.load]]
constant_tension = "rope"
from = { node = "lug" }
to = { node = "base", position_mm = [0, 0, 2000] }
tension_n = 30
[[limb.load]]
counterweight = "counterweight"
at = { node = "console", position_mm = [-300, 0, 0] }
mass_kg = 4
assumption = "a guess"
"#,
    );
    let chain = &model.mechanism.limbs()[0].nominal;
    // Elements that loads name become nodes behind them, in the order of the chain.
    let nodes = ["shoulder", "console", "boom", "lug", "ballast", "tip"];
    assert_eq!(chain.nodes(), nodes);
    let node = |name: &str| chain.node(name).expect("node");
    let at = |name: &str, point| Anchor::Node {
        node: node(name),
        point,
    };
    let (zero, gravity) = (Vector3::zeros(), vector![0.0, 0.0, -9.81]);
    let hose = Wrench::new(vector![1.0, -2.0, 3.0], vector![4.0, 5.0, -6.0]);
    let balancer = LengthLaw::Linear {
        stiffness: 5e3,
        free_length: 0.1,
        preload: 12.0,
    };
    let lifter = LengthLaw::Gas {
        force: 200.0,
        length: 0.5,
        column: 0.9,
        exponent: 1.2,
    };
    let expected = [
        Load::dead(node("lug"), hose),
        Load::follower(node("ballast"), Wrench::new(vector![0.0, 7.0, 0.0], zero)),
        Load::strut(
            Anchor::Base(vector![0.0, 0.0, 0.5]),
            at("console", vector![0.01, 0.02, 0.03]),
            balancer,
        ),
        Load::spring_between(
            at("shoulder", vector![0.0, 0.05, 0.0]),
            at("boom", zero),
            300.0,
            0.0,
        ),
        Load::strut(
            Anchor::Base(vector![0.0, 0.0, -0.4]),
            at("tip", zero),
            lifter,
        ),
        Load::constant_tension(at("lug", zero), Anchor::Base(vector![0.0, 0.0, 2.0]), 30.0),
        Load::counterweight(node("console"), vector![-0.3, 0.0, 0.0], 4.0, gravity),
    ];
    let found = model.mechanism.loads(0);
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found, expected);
    }
    assert!(!model.mechanism.loads_conservative(0));
    // Written and read again they are the same.
    let again = Model::from_document(&model.document, "again.toml").expect("again");
    assert_eq!(again.mechanism, model.mechanism);
    assert_eq!(again.document, model.document);
    // Places are where their names say: at home behind the elements.
    let posture = model
        .mechanism
        .posture(&Pose::translation(0.8, 0.0, 0.0))
        .expect("home");
    let rest = posture.deflected_by(&Wrench::zero()).expect("rest");
    let x = |name: &str| rest.limbs[0].nodes[node(name)].translation.vector.x;
    for (name, place) in [
        ("shoulder", 0.0),
        ("console", 0.2),
        ("boom", 0.8),
        ("ballast", 0.7),
    ] {
        assert!((x(name) - place).abs() < 0.01, "{name}: {}", x(name));
    }
    assert!(!rest.conservative && rest.energy.is_none());
}

#[test]
fn a_load_is_added_without_moving_what_exists() {
    let (without, with) = (
        arm(STRAIGHT, ""),
        arm(
            STRAIGHT,
            "[[limb.load]]\nwrench = \"w\"\nnode = \"console\"\naxes = \"base\"\nforce_n = [0, 0, 0]",
        ),
    );
    let rest = |m: &Model| {
        let posture = m.mechanism.posture(&Pose::translation(0.8, 0.0, 0.0));
        let e = posture.and_then(|p| p.deflected_by(&Wrench::zero()));
        e.expect("rest")
    };
    assert_eq!(rest(&without).tool, rest(&with).tool);
    assert_eq!(without.mechanism.loads(0), []);
}

#[test]
fn links_bow_unless_the_file_says_otherwise() {
    let law = |link: &str| {
        let chain = arm(link, "").mechanism.limbs()[0].nominal.clone();
        let springs = chain
            .springs()
            .iter()
            .filter(|s| s.name.starts_with("boom"));
        springs.map(|s| s.law.clone()).collect::<Vec<_>>()
    };
    let bowing = law(STRAIGHT);
    assert!(matches!(bowing.as_slice(), [SpringLaw::Bowing(_)]));
    let plain = law(&format!("{STRAIGHT}, convention = \"translations_first\""));
    assert!(matches!(plain.as_slice(), [SpringLaw::Linear(_)]));
    let divided = law(&format!("{STRAIGHT}, segments = 3"));
    assert_eq!(divided.len(), 3);
    // By its matrix: the same link, divided too.
    for more in ["", ", segments = 3"] {
        let by_section = law(&format!("{STRAIGHT}{more}"));
        let by_matrix = law(&format!("link = \"cantilever\", length_mm = 600{more}"));
        for (one, other) in by_section.iter().zip(&by_matrix) {
            let (SpringLaw::Bowing(one), SpringLaw::Bowing(other)) = (one, other) else {
                panic!("{one:?} {other:?}");
            };
            let (a, b) = (one.matrix, other.matrix);
            for i in 0..36 {
                let size = (a[(i % 6, i % 6)] * a[(i / 6, i / 6)]).sqrt();
                assert!((a[i] - b[i]).abs() < 1e-9 * size, "{a} {b}");
            }
        }
    }
    for (word, convention) in [
        ("bowing", LinkConvention::Bowing),
        ("translations_first", LinkConvention::TranslationsFirst),
        ("rotations_first", LinkConvention::RotationsFirst),
        ("middle", LinkConvention::Middle),
        ("exponential", LinkConvention::Exponential),
        ("constant_strain", LinkConvention::ConstantStrain),
    ] {
        let found = law(&format!(
            "{STRAIGHT}, segments = 2, convention = \"{word}\""
        ));
        let spec = LinkSpec::beam(tube(), 0.6)
            .segments(2)
            .convention(convention);
        let chain = kinetostat::Chain::builder("x")
            .link_with("boom", &spec)
            .build()
            .expect("chain");
        let expected: Vec<_> = chain.springs().iter().map(|s| s.law.clone()).collect();
        for (f, e) in found.iter().zip(&expected) {
            let matrix = |law: &SpringLaw| match law {
                SpringLaw::Linear(m) => Matrix6::from_fn(|i, j| m[(i, j)]),
                SpringLaw::Bowing(l) => l.matrix,
                SpringLaw::Logarithm(l) => l.matrix,
                _ => panic!("{law:?}"),
            };
            assert_eq!(
                std::mem::discriminant(f),
                std::mem::discriminant(e),
                "{word}"
            );
            let off = (matrix(f) - matrix(e)).largest_entry();
            assert!(off <= 1e-9 * matrix(e).largest_entry(), "{word}: {off:e}");
        }
    }
}

/// A column along a slanted vector, hinged at its foot, pushed along itself by its platform.
fn slanted(convention: &str, along: Vector3<f64>) -> Model {
    let [x, y, z]: [f64; 3] = (along * 1e3).into();
    let axes = Rotation3::rotation_between(&Vector3::x(), &along).expect("axes");
    let side = axes * Vector3::y();
    let other = axes * Vector3::z();
    model(&format!(
        r#"
schema = 1
[mechanism]
name = "column"
[[platform]]
name = "tool"
home = {{ position_mm = [{x}, {y}, {z}] }}
[section.tube]
tube = {{ outer_diameter_mm = 40, inner_diameter_mm = 36 }}
youngs_modulus_gpa = 70
shear_modulus_gpa = 26
[chain.column]
elements = [
  {{ link = "tube", name = "column", vector_mm = [{x}, {y}, {z}], segments = 8, convention = "{convention}" }},
  {{ passive = "revolute", name = "a", axis = [{}, {}, {}] }},
  {{ passive = "revolute", name = "b", axis = [{}, {}, {}] }},
]
[[limb]]
name = "column"
from = "base"
to = "tool"
chain = "column"
"#,
        side.x, side.y, side.z, other.x, other.y, other.z
    ))
}

/// Clamped at the foot, hinged at the head, which stays on its line: critical at 2.0457 Euler loads.
#[test]
fn a_slanted_link_buckles_at_its_euler_load() {
    let along = vector![0.7, -0.5, 1.1];
    let length = along.norm();
    let axis = Unit::new_normalize(along);
    let m = slanted("bowing", along);
    let home = Pose::from_parts(along.into(), nalgebra::UnitQuaternion::identity());
    let posture = m.mechanism.posture(&home).expect("home");
    let euler = std::f64::consts::PI.powi(2) * 7e10 * tube().second_moment_y / length.powi(2);
    let pressed = |share: f64| -> MechanismEquilibrium {
        let shortened = share * euler * length / (7e10 * tube().area);
        let moved = along - axis.into_inner() * shortened;
        posture
            .wrench_at(&Pose::from_parts(moved.into(), home.rotation))
            .expect("held")
    };
    // The platform is held whole; the hinges let the column's head turn below it.
    let share_to_buckling = |share: f64| {
        pressed(share).limbs[0]
            .stability
            .share_to_buckling
            .expect("a share")
    };
    let (low, high) = (share_to_buckling(1.0), share_to_buckling(2.0));
    assert!((low - 1.0 / 2.0457).abs() < 2e-3, "{low}");
    assert!((high - 2.0 / 2.0457).abs() < 3e-3, "{high}");
    let load = &pressed(1.0).limbs[0].link_loads[0];
    assert_eq!(load.link, "column");
    assert!((load.share - 1.0).abs() < 2e-3, "{load:?}");
    assert!((load.euler_load / euler - 1.0).abs() < 1e-9, "{load:?}");
}

/// Unloaded stiffness does not depend on convention and segments, and the axial load of a plain
/// spring in the frame's axes is reported as well.
#[test]
fn the_heavy_arm_is_as_stiff_when_its_links_bow() {
    let text = preset_text("heavy_6r").expect("preset");
    let plain = model(text);
    assert_eq!(
        text.matches(", convention = \"translations_first\"")
            .count(),
        6
    );
    let bowing = model(&text.replace(", convention = \"translations_first\"", ", segments = 3"));
    let home = plain.mechanism.platforms()[1].home;
    let pull = Wrench::new(vector![500.0, 200.0, -900.0], vector![20.0, 0.0, 30.0]);
    let [plain, bowing] = [&plain, &bowing].map(|m| {
        let posture = m.mechanism.posture(&home).expect("home");
        let k = posture.stiffness().expect("stiffness").cartesian.matrix;
        (k, posture.deflected_by(&pull).expect("equilibrium"))
    });
    let off = (plain.0 - bowing.0).largest_entry() / plain.0.largest_entry();
    assert!(off < 1e-9, "{off:e}");
    let apart = (plain.1.displacement.linear() - bowing.1.displacement.linear()).norm();
    assert!(
        apart < 2e-3 * plain.1.displacement.linear().norm(),
        "{apart:e}"
    );
    for (one, other) in plain.1.limbs[0]
        .link_loads
        .iter()
        .zip(&bowing.1.limbs[0].link_loads)
    {
        assert_eq!(one.link, other.link);
        assert!((one.euler_load / other.euler_load - 1.0).abs() < 1e-9);
        // Weights hang on the ends, so that one piece carries what three do.
        let size = one.axial_force.abs().max(100.0);
        assert!(
            (one.axial_force - other.axial_force).abs() < 0.01 * size,
            "{one:?} {other:?}"
        );
    }
}

#[test]
fn the_compensator_carries_the_shoulder() {
    let with = Model::preset("compensated_arm").expect("preset");
    let mut document = with.document.clone();
    document.limb[0].load.clear();
    let without = Model::from_document(&document, "without").expect("without");
    let home = with.mechanism.platforms()[1].home;
    let [with, without] = [&with, &without].map(|m| {
        let e = m
            .mechanism
            .posture(&home)
            .and_then(|p| p.deflected_by(&Wrench::zero()));
        e.expect("rest")
    });
    assert!(with.conservative && with.energy.is_some());
    let shoulder = |e: &MechanismEquilibrium| e.limbs[0].actuator_forces[0];
    // By hand: 80, 50 and 20 kg at 225, 731.9 and 1182.8 mm in front of the shoulder.
    let by_hand = 9.81 * (80.0 * 0.225 + 50.0 * 0.7319 + 20.0 * 1.1828);
    assert!(
        (shoulder(&without) / by_hand - 1.0).abs() < 2e-3,
        "{}",
        shoulder(&without)
    );
    assert!(
        shoulder(&with).abs() < 0.05 * by_hand,
        "{}",
        shoulder(&with)
    );
    // Elbow and wrist feel nothing of it.
    for k in [1, 2] {
        let (a, b) = (
            with.limbs[0].actuator_forces[k],
            without.limbs[0].actuator_forces[k],
        );
        assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
    }
}

/// An arm of two parts with a platform between them; `loads` act on platforms.
fn two_parts(loads: &str) -> String {
    format!(
        r#"
schema = 1
[mechanism]
name = "arm of two parts"
gravity_m_per_s2 = [0, 0, -9.81]
[[platform]]
name = "elbow"
home = {{ position_mm = [600, 0, 0] }}
mass_kg = 4
[[platform]]
name = "tool"
home = {{ position_mm = [1200, 0, 0] }}
[section.tube]
tube = {{ outer_diameter_mm = 60, inner_diameter_mm = 50 }}
youngs_modulus_gpa = 70
shear_modulus_gpa = 26
[chain.part]
elements = [
  {{ actuator = "revolute", name = "drive", axis = "-y", stiffness_n_m_per_rad = 2e5 }},
  {{ link = "tube", length_mm = 600, name = "boom" }},
]
[[limb]]
name = "upper"
from = "base"
to = "elbow"
chain = "part"
[[limb]]
name = "fore"
from = "elbow"
to = "tool"
chain = "part"
{loads}
"#
    )
}

const ON_PLATFORMS: &str = r#"
[[load]]
spring = "compensator"
from = { platform = "base", position_mm = [0, 0, 500] }
to = { platform = "tool", position_mm = [-200, 10, 40] }
stiffness_n_per_mm = 4
free_length_mm = 750
preload_n = 30
[[load]]
gas_spring = "strut"
from = { platform = "elbow", position_m = [-0.1, 0, 0.1] }
to = { platform = "tool" }
force_n = 300
length_mm = 800
column_mm = 1500
exponent = 1.2
[[load]]
constant_tension = "rope"
from = { platform = "elbow" }
to = { platform = "base", position_mm = [0, 200, 900] }
tension_n = 80
[[load]]
wrench = "hose"
platform = "elbow"
position_mm = [20, 0, 30]
axes = "base"
force_n = [0, 5, -12]
[[load]]
wrench = "jet"
platform = "tool"
axes = "platform"
force_n = [0, 7, 0]
moment_n_mm = [500, 0, 100]
"#;

#[test]
fn loads_on_platforms_are_the_core_s() {
    let model = model(&two_parts(ON_PLATFORMS));
    let linear = LengthLaw::Linear {
        stiffness: 4e3,
        free_length: 0.75,
        preload: 30.0,
    };
    let gas = LengthLaw::Gas {
        force: 300.0,
        length: 0.8,
        column: 1.5,
        exponent: 1.2,
    };
    let zero = Vector3::zeros();
    let expected = [
        PlatformLoad::strut(
            Anchor::on_platform(0, vector![0.0, 0.0, 0.5]),
            Anchor::on_platform(2, vector![-0.2, 0.01, 0.04]),
            linear,
        ),
        PlatformLoad::strut(
            Anchor::on_platform(1, vector![-0.1, 0.0, 0.1]),
            Anchor::on_platform(2, zero),
            gas,
        ),
        PlatformLoad::strut(
            Anchor::on_platform(1, zero),
            Anchor::on_platform(0, vector![0.0, 0.2, 0.9]),
            LengthLaw::Constant { tension: 80.0 },
        ),
        PlatformLoad::Wrench {
            platform: 1,
            point: vector![0.02, 0.0, 0.03],
            wrench: Wrench::new(vector![0.0, 5.0, -12.0], zero),
            turns: false,
        },
        PlatformLoad::Wrench {
            platform: 2,
            point: zero,
            wrench: Wrench::new(vector![0.0, 7.0, 0.0], vector![0.5, 0.0, 0.1]),
            turns: true,
        },
    ];
    assert_eq!(model.mechanism.platform_loads(), expected);
    // They act: the compensator and the rope lift the arm.
    let home = model.mechanism.platforms()[2].home;
    let bare = self::model(&two_parts(""));
    let rest = |model: &Model| {
        let posture = model.mechanism.posture(&home).expect("reachable");
        let e = posture.deflected_by(&Wrench::zero()).expect("it rests");
        e.displacement.linear().z
    };
    assert!(rest(&model) > rest(&bare));
    // Written again, it is the same machine.
    let again = model.to_toml().expect("a document");
    assert_eq!(self::model(&again).document, model.document);
    let words: Vec<String> = model
        .document
        .load
        .iter()
        .map(|l| l.description())
        .collect();
    assert!(words[0].starts_with("spring of 4 N/mm from the base at (0, 0, 500) mm to 'tool'"));
    assert!(words[4].contains("turns with it"), "{}", words[4]);
}

#[test]
fn loads_on_platforms_that_do_not_fit_are_refused_in_words() {
    for (written, replaced, words) in [
        ("platform = \"tool\", pos", "platform = \"tol\", pos", "tol"),
        (
            "platform = \"elbow\"\nposition",
            "platform = \"base\"\nposition",
            "does not move",
        ),
        ("\"rope\"", "\"strut\"", "already"),
        ("wrench = \"jet\"", "wrench = \"hose\"", "already"),
        ("free_length_mm = 750", "free_length_mm = -1", "below zero"),
        (
            "from = { platform = \"elbow\" }",
            "from = { platform = \"base\" }",
            "does nothing",
        ),
        ("axes = \"platform\"", "axes = \"node\"", "axes"),
    ] {
        let text = two_parts(ON_PLATFORMS);
        assert!(text.contains(written), "{written}");
        let text = text.replacen(written, replaced, 1);
        let refused = Model::from_toml(&text, "model.toml").expect_err(replaced);
        assert!(refused.to_string().contains(words), "{refused}");
    }
}

#[test]
fn a_spring_may_have_a_knee() {
    let file = |spring: &str| {
        format!(
            r#"
schema = 1
[mechanism]
name = "an arm on a wave gear"
[[platform]]
name = "tool"
home = {{ position_mm = [500, 0, 0] }}
[chain.arm]
elements = [
  {{ actuator = "revolute", name = "shoulder", axis = "z", rigid_drive = true }},
  {{ spring = "revolute", name = "gear", axis = "z", stiffness_n_m_per_rad = 2.0e5, {spring} }},
  {{ rigid = {{ translation_mm = [500, 0, 0] }} }},
]
[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
"#
        )
    };
    let read = |spring: &str| Model::from_toml(&file(spring), "arm.toml");
    let model = read("knee = { at_deg = 0.1, then_n_mm_per_rad = 6.0e8 }").expect("a model");
    let law = &model.mechanism.limbs()[0].nominal.springs()[0].law;
    let SpringLaw::Bilinear(law) = law else {
        panic!("{law:?}");
    };
    assert_eq!((law.stiffness, law.beyond), (2e5, 6e5));
    assert!((law.knee - 0.1_f64.to_radians()).abs() < 1e-15);
    for (wrong, says) in [
        (
            "knee = { at_deg = 0.1 }",
            "stiffness beyond the knee is missing",
        ),
        (
            "knee = { then_n_m_per_rad = 1.0 }",
            "deflection at the knee is missing",
        ),
        (
            "knee = { at_mm = 0.1, then_n_m_per_rad = 1.0 }",
            "turns about its axis",
        ),
        (
            "knee = { at_deg = -0.1, then_n_m_per_rad = 1.0 }",
            "a number above zero is needed",
        ),
    ] {
        let error = read(wrong).expect_err(wrong).to_string();
        assert!(error.contains(says), "{error}");
    }
}

/// Masses along the links of a model's limb, written in a file and built in the core.
#[test]
fn mass_along_a_link_is_the_core_s() {
    let halves = MassModel::HalvesAtEnds;
    let thin = |per_length| LinkMass {
        per_length,
        rotary: [0.0; 3],
        model: MassModel::Consistent,
    };
    for (written, segments, mass) in [
        (
            "density_kg_m3 = 2700",
            1,
            LinkMass::of_section(&tube(), 2700.0),
        ),
        (
            "density_kg_m3 = 2700, segments = 3, mass_model = \"halves_at_ends\"",
            3,
            LinkMass::of_section(&tube(), 2700.0).with_model(halves),
        ),
        ("mass_kg_per_m = 4.5, segments = 2", 2, thin(4.5)),
        (
            "mass_kg_per_m = 4.5, convention = \"translations_first\", mass_model = \"along_the_link\"",
            1,
            thin(4.5),
        ),
    ] {
        let model = arm(&format!("{STRAIGHT}, {written}"), "");
        let chain = &model.mechanism.limbs()[0].nominal;
        let spec = LinkSpec::beam(tube(), 0.6)
            .segments(segments)
            .with_mass(mass);
        let built = kinetostat::Chain::builder("arm")
            .link_with("boom", &spec)
            .build()
            .expect("chain");
        let along = |c: &kinetostat::Chain| -> Vec<f64> {
            c.segment_masses().iter().map(|m| m.total()).collect()
        };
        let at_ends = |c: &kinetostat::Chain| -> Vec<f64> {
            (c.bodies().iter().filter(|b| b.name == "boom"))
                .map(|b| b.mass)
                .collect()
        };
        let found = [along(chain), at_ends(chain)];
        let ends = if mass.model == halves {
            2 * segments
        } else {
            0
        };
        let pieces = if mass.model == halves { 0 } else { segments };
        assert_eq!(found.each_ref().map(Vec::len), [pieces, ends], "{written}");
        for (found, expected) in found.iter().zip([along(&built), at_ends(&built)]) {
            assert_eq!(found.len(), expected.len(), "{written}");
            for (f, e) in found.iter().zip(&expected) {
                assert!((f - e).abs() <= 1e-14 * e, "{written}: {f} {e}");
            }
        }
        // By hand, of a tube of 40 and 36 mm: pi (0.02^2 - 0.018^2) 2700 0.6.
        let by_hand = if written.starts_with("density") {
            std::f64::consts::PI * (0.02_f64.powi(2) - 0.018_f64.powi(2)) * 2700.0 * 0.6
        } else {
            4.5 * 0.6
        };
        let total: f64 = found.iter().flatten().sum();
        assert!((total - by_hand).abs() <= 1e-12 * by_hand, "{written}");
        // Written and read again, it is the same.
        let text = model.to_toml().expect("written");
        assert_eq!(
            Model::from_toml(&text, "again.toml")
                .expect("read")
                .mechanism,
            model.mechanism
        );
    }
    assert!(
        arm(STRAIGHT, "").mechanism.limbs()[0]
            .nominal
            .segment_masses()
            .is_empty()
    );
}
