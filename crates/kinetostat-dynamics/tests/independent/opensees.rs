//! Frequencies after a loaded step against OpenSees: `validation/scripts/frame_opensees.py`.
//!
//! Its corotational beams converge in second order under axial load, and so do our segments where a frame bends far; both
//! sides are extrapolated from two subdivisions before they are compared.

use kinetostat::chain::Prescribed;
use kinetostat::model::LinkMass;
use kinetostat::*;
use kinetostat_dynamics::{Held, LinearDynamics};
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, UnitQuaternion, Vector3, vector};
use serde_json::{Value, json};

use crate::common::{DENSITY, section};
use crate::scripts::{ask, numbers};

/// Of squares of frequencies at two subdivisions, one half of the other, whose error falls with the square.
fn extrapolated(coarse: &[f64], fine: &[f64]) -> Vec<f64> {
    let squared = coarse
        .iter()
        .zip(fine)
        .map(|(c, f)| (4.0 * f * f - c * c) / 3.0);
    squared.map(f64::sqrt).collect()
}

fn by_opensees(request: impl Fn(usize) -> Value) -> Option<(Vec<f64>, Vec<f64>)> {
    let run = |elements| {
        ask(
            "frame_opensees.py",
            "OpenSees (openseespy)",
            &request(elements),
        )
    };
    let (coarse, fine) = (run(16)?, run(32)?);
    let list = |v: &Value| numbers(&v["frequencies_hz"]);
    Some((
        extrapolated(&list(&coarse), &list(&fine)),
        numbers(&fine["tip"]),
    ))
}

fn dynamics(chain: &Chain, end: EndCondition) -> (LinearDynamics, Vector3<f64>) {
    let held = Held::of_end(&end);
    let mut problem = ChainProblem::new(chain, end);
    problem.posture = chain.home_coordinates();
    let at = solve_chain(&problem, &Settings::default()).unwrap();
    let d = LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &held).unwrap();
    let tip = d.position(d.tool());
    (d, tip)
}

/// Frequencies of the modes that bend in the plane x-y.
fn in_plane(d: &LinearDynamics, place: &str) -> Vec<f64> {
    let point = d.place(place).unwrap();
    let modes = d.modes().unwrap().modes;
    let bends = modes.iter().filter(|mode| {
        let motion = d.motions(point) * &mode.shape;
        let across = motion[1].abs() + motion[5].abs();
        let out = motion[2].abs() + motion[3].abs() + motion[4].abs();
        across > 1e3 * out && across > motion[0].abs()
    });
    bends.map(|mode| mode.frequency_hz()).collect()
}

#[test]
fn figure_columns_under_axial_load_agree_with_opensees() {
    // Bending theory without stretch: area and density together keep the mass.
    let stretch = 1e5;
    let own = BeamSection {
        area: section().area * stretch,
        ..section()
    };
    let euler = std::f64::consts::PI.powi(2) * 14700.0;
    let mut worst = Worst::new();
    for share in [0.6, 0.9, -1.0] {
        let force = [-share * euler, 0.0, 0.0];
        let Some((expected, _)) = by_opensees(|elements| {
            json!({
                "section": {"E": 2.1e11, "G": 8e10, "A": own.area, "Iy": 3e-8, "Iz": 7e-8, "J": 9e-8, "density": DENSITY / stretch},
                "points": [[0, 0, 0], [1, 0, 0]], "elements": elements, "ends": "pinned", "plane": true,
                "force": force, "count": 2,
            })
        }) else {
            return;
        };
        let mass = LinkMass::of_section(&section(), DENSITY).thin();
        let chain = Chain::builder("column")
            .passive("pin", MotionKind::Revolute, Vector3::z(), 0.0)
            .link_with(
                "beam",
                &LinkSpec::beam(own, 1.0).segments(8).with_mass(mass),
            )
            .build()
            .unwrap();
        let mut end = EndCondition::wrench(Wrench::new(force.into(), Vector3::zeros()));
        end.pose = Pose::translation(1.0, 0.0, 0.0);
        for k in 1..5 {
            end.prescribed[k] = Prescribed::Pose;
        }
        let (d, _) = dynamics(&chain, end);
        let found = in_plane(&d, "beam.3.far");
        for k in 0..2 {
            worst.add_at(found[k] / expected[k] - 1.0, || {
                format!("{share} {k}: {} {}", found[k], expected[k])
            });
        }
    }
    println!("columns, OpenSees: {worst}");
    assert!(worst.of(6) < 5e-4, "{worst}");
}

fn frame(segments: usize) -> Chain {
    let beam = |length| {
        // OpenSees gives its elements the torsion constant for their polar moment, and no other rotary inertia.
        let mut mass = LinkMass::of_section(&section(), DENSITY).thin();
        mass.rotary[0] = DENSITY * section().torsion_constant;
        LinkSpec::beam(section(), length)
            .segments(segments)
            .with_mass(mass)
    };
    let corner = UnitQuaternion::from_scaled_axis(vector![0.0, 0.0, -1.2]);
    Chain::builder("frame")
        .link_with("first", &beam(0.8))
        .rigid(Pose::rotation(corner.scaled_axis()))
        .link_with("second", &beam(0.6))
        .body("tip mass", 4.0, Vector3::zeros(), Matrix3::zeros())
        .build()
        .unwrap()
}

#[test]
fn figure_a_loaded_frame_agrees_with_opensees() {
    let (c, s) = (1.2_f64.cos(), (-1.2_f64).sin());
    for (force, most) in [([0.0; 3], 2e-4), ([-1500.0, 800.0, -600.0], 1e-3)] {
        let Some((expected, tip)) = by_opensees(|elements| {
            json!({
                "section": {"E": 2.1e11, "G": 8e10, "A": 6e-4, "Iy": 3e-8, "Iz": 7e-8, "J": 9e-8, "density": DENSITY},
                "points": [[0.0, 0.0, 0.0], [0.8, 0.0, 0.0], [0.8 + 0.6 * c, 0.6 * s, 0.0]],
                "elements": elements, "ends": "free", "force": force, "tip_mass": 4.0, "count": 5,
            })
        }) else {
            return;
        };
        let of = |segments| {
            let end = EndCondition::wrench(Wrench::new(force.into(), Vector3::zeros()));
            let (d, place) = dynamics(&frame(segments), end);
            (d.modes().unwrap().frequencies_hz(), place)
        };
        let ((coarse, _), (fine, place)) = (of(4), of(8));
        let found = extrapolated(&coarse[..5], &fine[..5]);
        let mut worst = Worst::new();
        for k in 0..5 {
            worst.add_at(found[k] / expected[k] - 1.0, || {
                format!("mode {k}: {} {}", found[k], expected[k])
            });
        }
        println!("frame under {force:?}, OpenSees: {worst}; tips {place:?} {tip:?}");
        assert!(worst.of(5) < most, "{worst}");
        // The tip sinks by some 7 cm: the places agree to a thousandth of that.
        assert!((place - Vector3::from_row_slice(&tip)).norm() < 7e-5);
    }
}
