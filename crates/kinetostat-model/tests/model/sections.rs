//! Sections by shape, shear, taper and materials in model files: against the matrices that
//! `kinetostat-links` (tested against closed forms) gives for the same numbers.

use kinetostat::{
    ChainProblem, CurveSettings, EndCondition, Pose, Prescribed, Wrench, continuation::LoadPattern,
    critical_load_factor, equilibrium::StabilityOf,
};
use kinetostat_links::{SectionShape, Shear, cantilever, in_n_mm};
use kinetostat_model::Model;
use nalgebra::{Matrix6, Vector3};

fn model(link: &str, tables: &str) -> String {
    format!(
        "schema = 1\n\n[mechanism]\nname = \"arm\"\n\n[[platform]]\nname = \"tool\"\nhome = {{ position_mm = [500, 0, 0] }}\n\n{tables}\n\n[chain.arm]\nelements = [\n  {{ actuator = \"revolute\", name = \"q\", axis = \"z\", rigid_drive = true }},\n  {{ {link} }},\n]\n\n[[limb]]\nname = \"arm\"\nfrom = \"base\"\nto = \"tool\"\nchain = \"arm\"\n"
    )
}

/// Stiffness of the tool, N/m and so on.
fn stiffness(link: &str, tables: &str) -> Matrix6<f64> {
    let model =
        Model::from_toml(&model(link, tables), "arm.toml").unwrap_or_else(|e| panic!("{e}"));
    let home = model.mechanism.platforms()[1].home;
    let posture = model.mechanism.posture(&home).expect("posture");
    posture.stiffness().expect("stiffness").cartesian.matrix
}

fn same(found: &Matrix6<f64>, wanted: &Matrix6<f64>) {
    for i in 0..6 {
        for j in 0..6 {
            let unit = (wanted[(i, i)] * wanted[(j, j)]).sqrt();
            let apart = (found[(i, j)] - wanted[(i, j)]).abs() / unit;
            assert!(apart < 1e-9, "{i} {j}: {found} {wanted}");
        }
    }
}

const BOOM: &str = "link = \"boom\", name = \"boom\", length_mm = 500";

#[test]
fn shapes_shear_taper_and_materials() {
    let section = |keys: &str| stiffness(BOOM, &format!("[section.boom]\n{keys}"));
    let i = SectionShape::IBeam {
        width: 0.06,
        height: 0.1,
        flange: 0.008,
        web: 0.005,
    };
    let wanted = |a: &SectionShape, b: &SectionShape, shear| {
        cantilever(a, b, 0.5, 210e9, 0.3, shear).expect("beam")
    };
    let i_keys = "i_beam = { width_mm = 60, height_mm = 100, flange_mm = 8, web_mm = 5 }\n";
    same(
        &section(&format!("{i_keys}material = \"steel\"")),
        &wanted(&i, &i, Shear::None),
    );
    same(
        &section(&format!(
            "{i_keys}material = \"steel\"\nshear = \"timoshenko\""
        )),
        &wanted(&i, &i, Shear::Timoshenko),
    );
    let root = SectionShape::HollowBox {
        width: 0.08,
        height: 0.12,
        side_wall: 0.005,
        top_wall: 0.005,
    };
    let tip = SectionShape::HollowBox {
        width: 0.05,
        height: 0.06,
        side_wall: 0.004,
        top_wall: 0.006,
    };
    let taper = "hollow_box = { width_mm = 80, height_mm = 120, wall_mm = 5 }\n\
        tip = { hollow_box = { width_mm = 50, height_mm = 60, side_wall_mm = 4, top_wall_mm = 6 } }\n\
        youngs_modulus_gpa = 210\npoissons_ratio = 0.3\nshear = \"timoshenko\"";
    same(&section(taper), &wanted(&root, &tip, Shear::Timoshenko));
    // The same link in another direction is the same link.
    let up = stiffness(
        "link = \"boom\", name = \"boom\", vector_mm = [500, 0, 0]",
        &format!("[section.boom]\n{taper}"),
    );
    same(&up, &wanted(&root, &tip, Shear::Timoshenko));
    // Divided, unloaded, it is the same link, by every convention that is exact without segments.
    for convention in [
        "bowing",
        "translations_first",
        "rotations_first",
        "middle",
        "exponential",
    ] {
        let divided = stiffness(
            &format!("{BOOM}, segments = 5, convention = \"{convention}\""),
            &format!("[section.boom]\n{taper}"),
        );
        same(&divided, &wanted(&root, &tip, Shear::Timoshenko));
    }
    // Timoshenko's beam in four segments is the same beam, unloaded.
    let four = stiffness(
        &format!("{BOOM}, segments = 4"),
        &format!("[section.boom]\n{i_keys}material = \"steel\"\nshear = \"timoshenko\""),
    );
    same(&four, &wanted(&i, &i, Shear::Timoshenko));
}

/// What `kinetostat import matrix` writes is read as it was meant.
#[test]
fn an_imported_table_is_read() {
    let shape = SectionShape::Rectangle {
        width: 0.04,
        height: 0.06,
    };
    let k = cantilever(&shape, &shape, 0.5, 70e9, 0.3, Shear::Timoshenko).expect("beam");
    let table = kinetostat_links::stiffness_table("boom", &k, "a test", None);
    assert!(in_n_mm(&k)[(0, 0)] > 0.0);
    same(&stiffness(BOOM, &table), &k);
}

#[test]
fn what_is_wrong_is_reported() {
    let steel = "material = \"steel\"\n";
    for (link, keys, needle) in [
        (BOOM, "round = { diameter_mm = 50 }\nmaterial = \"steal\"".to_owned(), "did you mean 'steel'"),
        (BOOM, format!("{steel}youngs_modulus_gpa = 210\nround = {{ diameter_mm = 50 }}"), "gives the moduli already"),
        (BOOM, format!("{steel}i_beam = {{ width_mm = 60, height_mm = 10, flange_mm = 8, web_mm = 5 }}"), "leave room"),
        (BOOM, format!("{steel}i_beam = {{ width_mm = 60, height_mm = 100, flange_mm = 8 }}"), "web"),
        (BOOM, format!("{steel}round = {{ diameter_mm = 50 }}\ntip = {{ rectangle = {{ width_mm = 5, height_mm = 5 }} }}"), "same kind"),
        (BOOM, format!("{steel}round = {{ diameter_mm = 50 }}\ntip = {{ }}"), "far end has no shape"),
        (BOOM, "rigidities = { axial_n = 1e8, bending_y_n_m2 = 1e4, bending_z_n_m2 = 1e4, torsion_n_m2 = 1e4 }\nshear = \"timoshenko\"".to_owned(), "need a shape"),
    ] {
        let written = model(link, &format!("[section.boom]\n{keys}"));
        let error = Model::from_toml(&written, "arm.toml").expect_err(needle).to_string();
        assert!(error.contains(needle), "'{needle}' is not in {error}");
    }
}

/// A solid cone between pinned ends buckles at `pi^2 E sqrt(I_root I_tip) / L^2`: with the second moment
/// growing with the fourth power of the distance `x` from the apex, `y = x sin(k / x)` solves
/// `E I y'' + P y = 0` exactly.
#[test]
fn a_tapered_column_in_segments_buckles_where_the_closed_form_says() {
    let (root, tip, length) = (0.04_f64, 0.02_f64, 1.0_f64);
    let second_moment = |d: f64| std::f64::consts::PI * d.powi(4) / 64.0;
    let wanted =
        std::f64::consts::PI.powi(2) * 210e9 * (second_moment(root) * second_moment(tip)).sqrt()
            / length.powi(2);
    let mut errors = Vec::new();
    for segments in [4, 8, 16] {
        let text = format!(
            r#"schema = 1
[mechanism]
name = "column"
[[platform]]
name = "tool"
home = {{ position_mm = [1000, 0, 0] }}
[section.cone]
round = {{ diameter_mm = 40 }}
tip = {{ round = {{ diameter_mm = 20 }} }}
youngs_modulus_gpa = 210
poissons_ratio = 0.3
[chain.column]
elements = [
  {{ passive = "revolute", name = "foot", axis = "z" }},
  {{ link = "cone", name = "cone", length_mm = 1000, segments = {segments} }},
  {{ passive = "revolute", name = "head", axis = "z" }},
]
[[limb]]
name = "column"
from = "base"
to = "tool"
chain = "column"
"#
        );
        let model = Model::from_toml(&text, "column.toml").unwrap_or_else(|e| panic!("{e}"));
        let chain = &model.mechanism.limbs()[0].actual;
        // Held everywhere but along x, where it is pressed.
        let mut end = EndCondition::pose(Pose::translation(length, 0.0, 0.0));
        end.prescribed[0] = Prescribed::Wrench;
        let problem = ChainProblem::new(chain, end);
        let pattern = LoadPattern {
            end: Wrench::new(-Vector3::x(), Vector3::zeros()),
            loads: Vec::new(),
        };
        let settings = CurveSettings::within(0.0, 1.0);
        let found = critical_load_factor(&problem, &pattern, StabilityOf::Shape, &settings)
            .unwrap_or_else(|e| panic!("{e}"));
        let load = found.linear.expect("a critical load");
        errors.push(load / wanted - 1.0);
    }
    // Fourth order in the pieces, as for a uniform column.
    assert!(errors[2].abs() < 2e-5, "{errors:?}");
    for k in 1..errors.len() {
        assert!(errors[k].abs() < errors[k - 1].abs() / 12.0, "{errors:?}");
    }
}
