//! A machine of closed loops under load against Exudyn: `validation/scripts/platform_exudyn.py`.
//!
//! Without weight: the tangent by which Exudyn finds its modes has that of the springs and their preload, but not that of
//! loads, so that a weight off the reference point is missing in it (7e-4 of `w^2` here). `platform.rs` has such a weight.

use kinetostat::*;
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, UnitQuaternion, Vector3, vector};
use serde_json::json;

use crate::platform::{ANCHOR, GROUND, REST, home, loaded};
use crate::scripts::{ask, numbers};

const STIFFNESS: f64 = 1e6;

fn centre() -> Vector3<f64> {
    vector![0.02, -0.03, 0.07]
}

fn inertia() -> Matrix3<f64> {
    Matrix3::new(1.1, 0.1, -0.05, 0.1, 1.3, 0.08, -0.05, 0.08, 1.9)
}

/// From the foot of a leg to its joint at home.
fn way(k: usize) -> Vector3<f64> {
    home() + Vector3::from(ANCHOR[k]) - Vector3::from(GROUND[k])
}

/// The platform on six massless struts.
fn machine(gravity: Vector3<f64>) -> Mechanism {
    let mut m = Mechanism::builder("struts").gravity(gravity);
    m.platform(Platform {
        mass: 35.0,
        centre_of_mass: centre(),
        inertia: inertia(),
        ..Platform::new("platform", Pose::translation(home().x, home().y, home().z))
    });
    for k in 0..6 {
        let way = way(k);
        let turn = UnitQuaternion::rotation_between(&Vector3::x(), &way).unwrap();
        let name = ["a", "b", "c", "d", "e", "f"][k];
        let chain = Chain::builder(name)
            .rigid(Pose::from_parts(Vector3::from(GROUND[k]).into(), turn))
            .passive_universal("foot", Vector3::y(), Vector3::z())
            .translation(vector![way.norm(), 0.0, 0.0])
            .spring(
                "strut",
                MotionKind::Prismatic,
                Vector3::x(),
                STIFFNESS,
                REST[k],
            )
            .passive_spherical("ball")
            .rigid(Pose::rotation(turn.scaled_axis()).inverse())
            .build()
            .unwrap();
        let [x, y, z] = ANCHOR[k];
        m = m.limb(Limb::between(name, 0, 1, chain).fixed_at(Pose::translation(x, y, z)));
    }
    m.build().unwrap()
}

#[test]
fn figure_loaded_struts_agree_with_exudyn() {
    let mut worst = Worst::new();
    for (gravity, force) in [
        (Vector3::zeros(), Vector3::zeros()),
        (Vector3::zeros(), vector![2500.0, -1800.0, -4000.0]),
        (Vector3::zeros(), vector![-9000.0, 14000.0, 30000.0]),
    ] {
        let rest: Vec<f64> = (0..6).map(|k| way(k).norm() + REST[k]).collect();
        let rows: Vec<Vec<f64>> = (inertia().row_iter())
            .map(|row| row.iter().copied().collect())
            .collect();
        let Some(answer) = ask(
            "platform_exudyn.py",
            "Exudyn",
            &json!({
                "ground": GROUND, "anchor": ANCHOR, "home": home().as_slice(), "stiffness": STIFFNESS, "rest": rest,
                "mass": 35.0, "centre": centre().as_slice(), "inertia": rows,
                "gravity": gravity.as_slice(), "force": force.as_slice(),
            }),
        ) else {
            return;
        };
        let (squared, position) = (numbers(&answer["squared"]), numbers(&answer["position"]));
        assert_eq!(squared.len(), 6);
        loaded(
            &machine(gravity),
            &Wrench::new(force, Vector3::zeros()),
            |_, at, dynamics| {
                let off = at.tool.translation.vector - Vector3::from_row_slice(&position);
                assert!(off.norm() < 1e-8, "the equilibria are {off:?} apart");
                let modes = dynamics.modes().unwrap();
                assert_eq!(modes.counts.vibrating, 6);
                for (mode, expected) in modes.modes.iter().zip(&squared) {
                    worst.add_at(mode.squared / expected - 1.0, || {
                        format!("{force:?}: {} {expected}", mode.squared)
                    });
                }
            },
        );
    }
    println!("struts, Exudyn: {worst}");
    // Exudyn's tangent is a difference of forces.
    assert!(worst.of(18) < 1e-5, "{worst}");
}
