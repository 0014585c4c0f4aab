//! Drawings of every preset: what is shown can be seen, and what moves stays together.

use kinetostat::{Twist, Wrench, spatial::moved};
use kinetostat_model::{Model, preset_names};
use kinetostat_testing::Worst;
use nalgebra::{Vector3, Vector6};

use crate::drawing::parts::{BarKind, BlobKind, Scene};
use crate::drawing::view::Camera;
use crate::drawing::{Drawing, Magnified, Moved, Placed, View};

fn model(name: &str) -> Model {
    Model::preset(name).expect("a preset")
}

/// Every limb can be seen: a good part of its bars' length lies on paper, not along the line of sight.
#[test]
fn no_limb_of_a_preset_points_to_the_eye() {
    for preset in preset_names() {
        let model = model(preset.name);
        let m = &model.mechanism;
        let home = m.platforms()[m.tool()].home;
        let posture = m.posture(&home).expect("home");
        let scene = Scene::of(m, &Placed::at(&posture));
        let camera = Camera::of(None, &scene, &[]);
        for (i, limb) in m.limbs().iter().enumerate() {
            let own = scene.bars.iter().filter(|b| b.limb == Some(i));
            let own: Vec<_> = own.filter(|b| b.kind != BarKind::Rail).collect();
            let long: f64 = own.iter().map(|b| b.length()).sum();
            let seen: f64 = own
                .iter()
                .map(|b| {
                    let [a, b] = b.ends.map(|p| camera.project(&p));
                    (a - b).xy().norm()
                })
                .sum();
            if long == 0.0 {
                // A joint between two platforms, or a carriage on a rail, has no length of its own.
                let start = limb_start(limb, &posture.platforms()[limb.from]);
                let near = |at: &Vector3<f64>| (at - start).norm() < 1e-6 * scene.size;
                let rail = scene.bars.iter().any(|b| b.limb == Some(i));
                assert!(
                    rail || scene.blobs.iter().any(|b| near(&b.at)),
                    "{}: nothing of '{}'",
                    preset.name,
                    limb.name
                );
                continue;
            }
            assert!(seen > 0.3 * long, "{}: '{}'", preset.name, limb.name);
        }
    }
}

/// Position of the first joint of a limb without lengths, base axes, m.
fn limb_start(limb: &kinetostat::Limb, from: &kinetostat::Pose) -> Vector3<f64> {
    let home = limb.nominal.home_coordinates();
    kinetostat::model::unloaded_tip(&limb.nominal, from, &home, &limb.nominal.home_commands())
        .translation
        .vector
}

/// A motion is drawn from two scenes: their bars are the same ones, and the ends of limbs go where
/// the platform goes.
#[test]
fn limbs_move_with_their_platform() {
    for name in ["stewart_gough_b", "orthoglide", "puu3"] {
        let model = model(name);
        let m = &model.mechanism;
        let home = m.platforms()[m.tool()].home;
        let twist = Twist(Vector6::new(1e-5, -2e-5, 1e-5, 0.0, 0.0, 0.0));
        let (here, there) = (
            m.posture(&home).expect("home"),
            m.posture(&moved(&home, &twist)).expect("near home"),
        );
        let a = Scene::with_unit(m, &Placed::at(&here), 1e-3);
        let b = Scene::with_unit(m, &Placed::at(&there), 1e-3);
        assert_eq!(a.bars.len(), b.bars.len());
        let shift: Vector3<f64> = twist.linear();
        for (a, b) in a.plates.iter().zip(&b.plates).filter(|(a, _)| !a.base) {
            for (p, q) in a.points.iter().zip(&b.points) {
                assert!((q - p - shift).norm() < 1e-9, "{name}");
            }
        }
        let mut still = Worst::new();
        for (a, b) in a.blobs.iter().zip(&b.blobs) {
            if matches!(a.kind, BlobKind::Turn | BlobKind::Universal) {
                still.add((b.at - a.at).norm());
            }
        }
        assert!(still.holds(1e-4), "{name}: {still}");
    }
}

#[test]
fn passive_turns_at_one_point_are_one_joint() {
    let model = model("stewart_gough_b");
    let m = &model.mechanism;
    let posture = m.posture(&m.platforms()[m.tool()].home).expect("home");
    let scene = Scene::of(m, &Placed::at(&posture));
    let count = |kind| scene.blobs.iter().filter(|b| b.kind == kind).count();
    assert_eq!(count(BlobKind::Universal), 6);
    assert_eq!(count(BlobKind::Spherical), 6);
    assert_eq!(count(BlobKind::Sleeve), 6);
    assert_eq!(scene.plates.len(), 2);
    assert_eq!(scene.grounds.len(), 6);
}

#[test]
fn drawings_hold_numbers_only_and_escape_names() {
    let model = model("heavy_6r");
    let m = &model.mechanism;
    let posture = m.posture(&m.platforms()[m.tool()].home).expect("home");
    let force = Wrench::new(Vector3::new(0.0, 500.0, -1000.0), Vector3::zeros());
    let loaded = posture.deflected_by(&force).expect("an equilibrium");
    let mut drawing = Drawing::of(m, Placed::at(&posture));
    drawing.title = "<script>".to_owned();
    for magnified in [
        Magnified::Round,
        Magnified::Times(1e300),
        Magnified::Times(f64::NAN),
    ] {
        drawing.moved = Some(Moved {
            from: Placed::at(&posture),
            to: Placed::solved(&posture, &loaded.state),
            magnified,
            name: "bent".to_owned(),
        });
        for view in [None, Some(View::Top), Some(View::Side), Some(View::Front)] {
            drawing.view = view;
            let (svg, _) = drawing.svg();
            assert!(
                !svg.contains("NaN") && !svg.contains("inf"),
                "{magnified:?}"
            );
            assert!(!svg.contains("<script>"));
            assert_eq!(svg, drawing.svg().0, "the same drawing twice");
        }
    }
}

/// Modes that are compared are seen from one side, in one size.
#[test]
fn drawings_of_a_set_have_one_camera_and_one_scale() {
    let model = model("heavy_6r");
    let m = &model.mechanism;
    let posture = m.posture(&m.platforms()[m.tool()].home).expect("home");
    let moved = |force: Vector3<f64>| {
        let loaded = posture.deflected_by(&Wrench::new(force, Vector3::zeros()));
        Moved {
            from: Placed::at(&posture),
            to: Placed::solved(&posture, &loaded.expect("an equilibrium").state),
            magnified: Magnified::Direction,
            name: "mode".to_owned(),
        }
    };
    let set = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| moved(1000.0 * axis));
    let axes_of = |set: &[Moved], of: &[Moved]| -> Vec<String> {
        let drawn = of.iter().map(|own| {
            let mut drawing = Drawing::of(m, own.from.clone());
            (drawing.moved, drawing.set) = (Some(own.clone()), set);
            let svg = drawing.svg().0;
            // The axes of base and tool.
            let axes = svg.split("<path class=\"").skip(1);
            let axes = axes.filter(|rest| rest.starts_with("ax"));
            axes.map(|rest| rest.split("/>").next().unwrap_or_default())
                .collect()
        });
        drawn.collect()
    };
    let together = axes_of(&set, &set);
    assert!(!together[0].is_empty() && together.iter().all(|own| *own == together[0]));
    let alone = axes_of(&[], &set);
    assert!(
        alone.iter().any(|own| *own != alone[0]),
        "each alone has its own view"
    );
}

/// The factor is round, and the drawn motion is neither too small nor too large.
#[test]
fn deflections_are_drawn_by_a_round_factor() {
    let model = model("stewart_gough_b");
    let m = &model.mechanism;
    let posture = m.posture(&m.platforms()[m.tool()].home).expect("home");
    for force in [1.0, 300.0, 2e4] {
        let wrench = Wrench::new(Vector3::new(0.0, force, 0.0), Vector3::zeros());
        let loaded = posture.deflected_by(&wrench).expect("an equilibrium");
        let mut drawing = Drawing::of(m, Placed::at(&posture));
        drawing.moved = Some(Moved {
            from: Placed::at(&posture),
            to: Placed::solved(&posture, &loaded.state),
            magnified: Magnified::Round,
            name: "bent".to_owned(),
        });
        let factor = drawing.svg().1;
        let digits = factor / 10_f64.powf(factor.log10().floor());
        assert!(
            [1.0, 2.0, 5.0].iter().any(|d| (d - digits).abs() < 1e-9),
            "{factor}"
        );
        let shown = factor * loaded.displacement.linear().norm();
        assert!((0.03..0.3).contains(&shown), "{force} N: {shown} m");
    }
}
