//! Drilling: closed forms, a worked example of a catalogue, summation along the lip in space.

use std::f64::consts::TAU;

use kinetostat_cutting::*;
use nalgebra::Vector3;
use proptest::prelude::*;

fn near(found: f64, wanted: f64, share: f64) {
    assert!(
        (found - wanted).abs() <= share * wanted.abs(),
        "{found} is not {wanted}"
    );
}

/// ISCAR, catalogue Rotating Tools 2017, page 601 (docs.steelcam.org/iscar/katalog-vrashayushijsya-instrument-2017-page601):
/// DR 220-044-25-07-2D-N, D = 22 mm, k = 90 deg, k_c = 2200 N/mm^2, f = 0.15 mm, 2894 rpm, efficiency 0.75:
/// M_c = 20 N m, F_f = 0.63 D/2 f k_c = 2286 N, P_c = 8.06 kW.
#[test]
fn a_worked_example_of_a_catalogue() {
    let law = Kienzle::new([2200.0, 0.63 * 2200.0, 0.0], [0.0; 3]).unwrap();
    let drill = Drill::new(22.0, 2, 180_f64.to_radians()).unwrap();
    let force = drill.force(&law, 0.15).unwrap();
    near(1e-3 * force.torque_n_mm, 20.0, 2e-3);
    near(force.thrust_n, 2286.0, 1e-3);
    near(1e-3 * force.power_w(2894.0) / 0.75, 8.06, 2e-3);
}

/// `shared/theory/cutting.md`: with k_c at `h = f/2 sin k`, torque k_c f d^2/8, k_c f d/4 for each lip.
#[test]
fn closed_forms_of_two_lips() {
    let law = Kienzle::new([1780.0, 900.0, 0.0], [0.17, 0.3, 0.0]).unwrap();
    for (d, f, degrees) in [(10.0, 0.2, 118.0), (3.0, 0.05, 140.0), (40.0, 0.6, 90.0)] {
        let half = 0.5 * f64::to_radians(degrees);
        let force = Drill::new(d, 2, 2.0 * half)
            .unwrap()
            .force(&law, f)
            .unwrap();
        let h = 0.5 * f * half.sin();
        let (k_c, k_r) = (1780.0 * h.powf(-0.17), 900.0 * h.powf(-0.3));
        near(force.chip_mm, h, 1e-12);
        near(force.torque_n_mm, k_c * f * d * d / 8.0, 1e-12);
        near(force.cutting_per_lip_n, k_c * f * d / 4.0, 1e-12);
        near(force.thrust_n, k_r * f * d / 2.0 * half.sin(), 1e-12);
        assert_eq!(force.thrust_n, force.lips_thrust_n);
        // The work of a turn is the torque over it, or k_c times the volume of a turn.
        near(TAU * force.torque_n_mm, k_c * f * TAU * d * d / 8.0, 1e-12);
    }
}

/// Any law, for the plain summation.
fn law(k: [f64; 3], m: [f64; 3]) -> impl Fn(f64) -> [f64; 3] {
    move |h: f64| std::array::from_fn(|i| k[i] * h.powf(1.0 - m[i]))
}

proptest! {
    /// Force and torque of all lips as vectors in space: z from the tip to the spindle, the drill turns clockwise seen from
    /// there. The chip is the gap, across the lip, between the surfaces of two lips that follow each other.
    #[test]
    fn summation_along_the_lips(
        d in 1.0..40.0_f64, hole in 0.0..0.9_f64, lips in 1..5_usize, degrees in 60.0..179.0_f64, f in 0.01..0.6_f64,
        k in [500.0..3000.0_f64, 0.0..1500.0_f64, -300.0..300.0_f64], m in [0.0..0.5_f64, 0.0..0.5_f64, 0.0..0.5_f64],
    ) {
        let half = 0.5 * degrees.to_radians();
        let drill = Drill::new(d, lips, 2.0 * half).unwrap().in_hole(hole * d).unwrap();
        let found = drill.force(&Kienzle::new(k, m).unwrap(), f).unwrap();
        let plain = law(k, m);
        let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
        let pieces = 2000;
        let (inner, outer) = (0.5 * hole * d, 0.5 * d);
        for lip in 0..lips {
            let angle = 0.3 + TAU * lip as f64 / lips as f64;
            let out = Vector3::new(angle.cos(), angle.sin(), 0.0);
            let up = Vector3::z();
            // A point of the lip at radius r stands r/tan(half) above the tip.
            let at = |r: f64| out * r + up * (r / half.tan());
            let way = -up.cross(&out);
            for i in 0..pieces {
                let r = |share: f64| inner + (outer - inner) * (i as f64 + share) / pieces as f64;
                let piece = at(r(1.0)) - at(r(0.0));
                let along = piece.normalize();
                let normal = way.cross(&along);
                let normal = if normal.z < 0.0 { normal } else { -normal };
                let chip = (-up * (f / lips as f64)).dot(&normal);
                let [t, n, a] = plain(chip);
                let on_tool = (-way * t - normal * n + along * a) * piece.norm();
                force += on_tool;
                torque += at(r(0.5)).cross(&on_tool);
            }
        }
        prop_assert!((force.z - found.thrust_n).abs() <= 1e-9 * (k[0] + k[1] + 300.0) * d, "{} {}", force.z, found.thrust_n);
        // Against a drill that turns clockwise the torque on it is counter-clockwise.
        prop_assert!((torque.z - found.torque_n_mm).abs() <= 1e-6 * found.torque_n_mm, "{} {}", torque.z, found.torque_n_mm);
    }
}

#[test]
fn the_chisel_counts_in_full_material_only() {
    let law = Linear::new([1800.0, 900.0, 0.0], [0.0; 3]).unwrap();
    let drill = Drill::new(10.0, 2, 118_f64.to_radians())
        .unwrap()
        .with_chisel_factor(2.0)
        .unwrap();
    let full = drill.force(&law, 0.2).unwrap();
    assert_eq!(full.thrust_n, 2.0 * full.lips_thrust_n);
    let wider = drill.in_hole(3.0).unwrap().force(&law, 0.2).unwrap();
    assert_eq!(wider.thrust_n, wider.lips_thrust_n);
    near(wider.lip_mm, 0.7 * full.lip_mm, 1e-12);
}

#[test]
fn what_is_no_drill_is_refused_by_name() {
    let angle = 118_f64.to_radians();
    let drill = Drill::new(10.0, 2, angle).unwrap();
    let law = Linear::new([1800.0, 900.0, 0.0], [0.0; 3]).unwrap();
    let refused = [
        (Drill::new(0.0, 2, angle).unwrap_err(), "diameter"),
        (Drill::new(f64::NAN, 2, angle).unwrap_err(), "diameter"),
        (Drill::new(10.0, 0, angle).unwrap_err(), "lips"),
        (Drill::new(10.0, 2, 118.0).unwrap_err(), "point angle"),
        (drill.in_hole(10.0).unwrap_err(), "hole"),
        (drill.in_hole(-1.0).unwrap_err(), "hole"),
        (drill.with_chisel_factor(0.5).unwrap_err(), "chisel factor"),
        (drill.force(&law, 0.0).unwrap_err(), "feed"),
        (drill.force(&law, f64::NAN).unwrap_err(), "feed"),
        (drill.force(&Broken, 0.1).unwrap_err(), "torque of the law"),
    ];
    for (error, quantity) in refused {
        assert_eq!(error.quantity, quantity, "{error}");
    }
}

#[derive(Debug)]
struct Broken;

impl ForceLaw for Broken {
    fn edge_force(&self, _chip_mm: f64) -> EdgeForce {
        EdgeForce::new(f64::NAN, 1.0, 1.0)
    }
}
