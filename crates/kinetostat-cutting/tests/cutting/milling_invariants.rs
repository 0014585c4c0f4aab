//! Closed forms, energy, symmetry, order of teeth.

use std::f64::consts::{PI, TAU};

use kinetostat_cutting::{
    Contact, Engagement, Feed, Kienzle, Linear, Milling, Rotation, RunOut, Shape, Side, Tool, Wall,
};
use kinetostat_testing::figure::at_most;
use kinetostat_testing::{Worst, largest_size};
use proptest::prelude::*;

const K_C: [f64; 3] = [796.0, 168.0, 222.0];
const K_E: [f64; 3] = [27.7, 30.8, 1.4];

/// Mean force of a cylinder with the linear law, `shared/theory/cutting.md`.
fn closed_form(teeth: usize, depth: f64, feed: f64, entry: f64, exit: f64) -> [f64; 3] {
    let (n, a, c) = (teeth as f64, depth, feed);
    let at = |phi: f64| {
        let (s2, c2) = (2.0 * phi).sin_cos();
        let (s, co) = phi.sin_cos();
        let cutting = n * a * c / (8.0 * PI);
        let edge = n * a / TAU;
        [
            cutting * (K_C[0] * c2 - K_C[1] * (2.0 * phi - s2))
                + edge * (-K_E[0] * s + K_E[1] * co),
            cutting * (K_C[0] * (2.0 * phi - s2) + K_C[1] * c2) - edge * (K_E[0] * co + K_E[1] * s),
            edge * (-K_C[2] * c * co + K_E[2] * phi),
        ]
    };
    let (from, to) = (at(entry), at(exit));
    [to[0] - from[0], to[1] - from[1], to[2] - from[2]]
}

proptest! {
    #[test]
    fn means_of_a_cylinder_are_the_closed_form(
        teeth in 1..9_usize, helix in 0.0..1.0_f64, depth in 0.1..30.0_f64, feed in 0.005..0.5_f64,
        arc in (0.0..PI, 0.0..PI),
    ) {
        let (entry, exit) = if arc.0 < arc.1 { arc } else { (arc.1, arc.0) };
        let tool = Tool::new(Shape::Flat, 16.0, teeth).unwrap().with_helix(helix).unwrap();
        let law = Linear::new(K_C, K_E).unwrap();
        let engagement = Engagement { contacts: vec![Contact::side(0.0, depth, entry, exit)] };
        let found = Milling::new(&tool, &law, &engagement, Feed::level(feed).unwrap()).mean().force_n;
        let exact = closed_form(teeth, depth, feed, entry, exit);
        let largest = largest_size(exact);
        for i in 0..3 {
            prop_assert!((found[i] - exact[i]).abs() <= 1e-6 * largest, "{} {:?}", found, exact);
        }
    }

    /// Work of a revolution: the torque times the turn is what the teeth do along their ways.
    #[test]
    fn torque_is_the_work_along_the_ways_of_the_teeth(
        ball in any::<bool>(), teeth in 1..5_usize, helix in 0.0..0.8_f64, out in 0.0..0.02_f64, depth in 0.2..2.9_f64,
        arc in (0.0..PI, 0.0..PI), feed in 0.02..0.2_f64,
    ) {
        let (entry, exit) = if arc.0 < arc.1 { arc } else { (arc.1, arc.0) };
        let shape = if ball { Shape::Ball } else { Shape::Flat };
        let tool = Tool::new(shape, 6.0, teeth).unwrap().with_helix(helix).unwrap()
            .with_run_out(RunOut { offset_mm: out, angle: 0.4 }).unwrap();
        let law = Kienzle::new([780.0, 300.0, 120.0], [0.23, 0.4, 0.3]).unwrap();
        let tangential = Kienzle::new([780.0, 0.0, 0.0], [0.23, 0.0, 0.0]).unwrap();
        let engagement = Engagement { contacts: vec![Contact::side(0.0, depth, entry, exit)] };
        let feed = Feed::level(feed).unwrap();
        let work = TAU * Milling::new(&tool, &law, &engagement, feed).mean().moment_n_mm.z;
        // The same with nothing but the force along the ways: a force across a way does no work.
        let along = TAU * Milling::new(&tool, &tangential, &engagement, feed).mean().moment_n_mm.z;
        prop_assert!((work - along).abs() <= 1e-9 * along.abs(), "{work} {along}");
    }

    /// The order in which teeth are counted is nobody's business.
    #[test]
    fn renumbered_teeth_cut_the_same(
        teeth in 2..6_usize, out in 0.001..0.03_f64, angle in 0.0..TAU, shift in 1..5_usize, turn in 0.0..TAU,
    ) {
        let pitch = TAU / teeth as f64;
        let tool = |angle: f64| Tool::new(Shape::Ball, 8.0, teeth).unwrap().with_helix(0.5).unwrap()
            .with_run_out(RunOut { offset_mm: out, angle }).unwrap();
        let law = Kienzle::new([780.0, 300.0, 120.0], [0.23, 0.4, 0.3]).unwrap();
        let engagement = Engagement { contacts: vec![Contact::side(0.0, 3.0, 0.3, 2.5)] };
        let feed = Feed::level(0.06).unwrap();
        let (one, other) = (tool(angle), tool(angle + pitch * shift as f64));
        let a = Milling::new(&one, &law, &engagement, feed);
        let b = Milling::new(&other, &law, &engagement, feed);
        let scale = a.revolution_at(30).peak_n();
        prop_assert!((a.mean().force_n - b.mean().force_n).norm() < 1e-9 * scale);
        // Tooth `shift` of the other is tooth 0 of the one.
        let turned = b.at(turn - pitch * shift as f64);
        prop_assert!((a.at(turn).force_n - turned.force_n).norm() < 1e-9 * scale);
    }

    /// M4 is the mirror image of M3.
    #[test]
    fn counter_clockwise_is_the_mirror_image(
        arc in (0.0..PI, 0.0..PI), helix in 0.0..0.8_f64, turn in 0.0..TAU, height in 0.0..4.0_f64,
    ) {
        let (entry, exit) = if arc.0 < arc.1 { arc } else { (arc.1, arc.0) };
        let tool = Tool::new(Shape::Flat, 10.0, 3).unwrap().with_helix(helix).unwrap();
        let law = Linear::new(K_C, K_E).unwrap();
        let engagement = Engagement { contacts: vec![Contact::side(0.0, 4.0, entry, exit)] };
        let mirror = engagement.mirrored();
        let feed = Feed::level(0.1).unwrap();
        let m3 = Milling::new(&tool, &law, &engagement, feed);
        let m4 = Milling::new(&tool, &law, &mirror, feed).turning(Rotation::CounterClockwise);
        for (a, b) in [
            (m3.mean(), m4.mean()),
            (m3.at(turn), m4.at(turn)),
            (m3.at_wall(Wall::Right, height), m4.at_wall(Wall::Left, height)),
        ] {
            prop_assert!((a.force_n.x - b.force_n.x).abs() < 1e-9 * (1.0 + a.force_n.norm()));
            prop_assert!((a.force_n.y + b.force_n.y).abs() < 1e-9 * (1.0 + a.force_n.norm()));
            prop_assert!((a.force_n.z - b.force_n.z).abs() < 1e-9 * (1.0 + a.force_n.norm()));
            prop_assert!((a.moment_n_mm.z + b.moment_n_mm.z).abs() < 1e-9 * (1.0 + a.moment_n_mm.norm()));
            prop_assert!((a.torque_n_mm() - b.torque_n_mm()).abs() < 1e-9 * (1.0 + a.moment_n_mm.norm()));
        }
    }

    /// Contacts add up: a patch that is cut in two bears the same.
    #[test]
    fn patches_add_up(height in 0.1..3.9_f64, at in 0.2..2.8_f64, turn in 0.0..TAU, ball in any::<bool>()) {
        let shape = if ball { Shape::Ball } else { Shape::Bull { corner_radius_mm: 1.5 } };
        let tool = Tool::new(shape, 10.0, 2).unwrap().with_helix(0.5).unwrap();
        let law = Kienzle::new([780.0, 300.0, 120.0], [0.23, 0.4, 0.3]).unwrap();
        let feed = Feed::ramp(0.1, 0.01).unwrap();
        let whole = Engagement { contacts: vec![Contact::side(0.0, 4.0, 0.1, 2.9)] };
        let parts = Engagement { contacts: vec![
            Contact::side(0.0, height, 0.1, at), Contact::side(height, 4.0, 0.1, at),
            Contact::side(0.0, height, at, 2.9), Contact::side(height, 4.0, at, 2.9),
        ] };
        let (a, b) = (Milling::new(&tool, &law, &whole, feed), Milling::new(&tool, &law, &parts, feed));
        let scale = a.revolution_at(60).peak_n();
        prop_assert!((a.mean().force_n - b.mean().force_n).norm() < 1e-5 * scale);
        prop_assert!((a.at(turn).force_n - b.at(turn).force_n).norm() < 1e-4 * scale);
    }
}

/// Means and work of a revolution against closed forms, over tools, depths, arcs and feeds.
#[test]
fn figure_closed_forms_and_energy() {
    let (mut mean, mut work) = (Worst::new(), Worst::new());
    let law = Linear::new(K_C, K_E).unwrap();
    let arcs = [(0.0, PI), (0.0, 0.7), (2.2, PI), (0.4, 2.9), (1.0, 1.01)];
    for (teeth, helix) in [(1, 0.0), (2, 0.5), (3, 0.26), (5, 0.79), (8, 1.0)] {
        for (entry, exit) in arcs {
            for (share, feed) in [(0.02, 0.01), (0.3, 0.1), (0.95, 0.4)] {
                let engagement = |depth| Engagement {
                    contacts: vec![Contact::side(0.0, depth, entry, exit)],
                };
                let (radius, depth) = (8.0, share * 8.0);
                let tool = |shape| {
                    let tool = Tool::new(shape, 2.0 * radius, teeth).unwrap();
                    tool.with_helix(helix).unwrap()
                };
                let mean_of = |shape| {
                    let (tool, feed) = (tool(shape), Feed::level(feed).unwrap());
                    Milling::new(&tool, &law, &engagement(depth), feed).mean()
                };
                let flat = mean_of(Shape::Flat);
                let exact = closed_form(teeth, depth, feed, entry, exit);
                for i in 0..3 {
                    mean.add((flat.force_n[i] - exact[i]) / largest_size(exact));
                }
                // Tangential force along the ways: of the chips, K_tc times what is removed; of the edges, K_te times the
                // way of each. On a ball the edge is longer by what its way is shorter.
                let n = teeth as f64;
                let chord = depth * (2.0 * radius - depth);
                let segment = radius * radius * (1.0 - depth / radius).acos()
                    - (radius - depth) * chord.sqrt();
                let areas = [(Shape::Flat, radius * depth), (Shape::Ball, 0.5 * segment)];
                for (shape, area) in areas {
                    let chips = K_C[0] * n * feed * (entry.cos() - exit.cos()) * area;
                    let edges = K_E[0] * n * (exit - entry) * radius * depth;
                    work.add(TAU * mean_of(shape).torque_n_mm() / (chips + edges) - 1.0);
                }
            }
        }
    }
    let name = "mean force of a cylinder against its closed form, share";
    assert!(at_most(name, mean.of(225), 1e-6, "1"), "{mean}");
    let name =
        "energy: torque over a turn against the work along the teeth's ways, flat and ball, share";
    assert!(at_most(name, work.of(150), 1e-9, "1"), "{work}");
}

/// `N a tan(beta)/(2 pi r)` whole: the force of a slot does not change over the revolution.
#[test]
fn the_special_slot_has_a_constant_force() {
    let (teeth, radius, helix) = (4, 6.0, 38_f64.to_radians());
    let depth = TAU * radius / (teeth as f64 * helix.tan());
    let tool = Tool::new(Shape::Flat, 2.0 * radius, teeth)
        .unwrap()
        .with_helix(helix)
        .unwrap();
    let law = Linear::new(K_C, K_E).unwrap();
    let slot = Engagement::straight(radius, 2.0 * radius, depth, Side::Left).unwrap();
    let cut = Milling::new(&tool, &law, &slot, Feed::level(0.1).unwrap());
    let mean = cut.mean().force_n;
    let mut compared = 0;
    for force in cut.revolution_at(100).forces {
        assert!((force.force_n - mean).norm() < 1e-6 * mean.norm());
        compared += 1;
    }
    assert_eq!(compared, 400);
}

/// The mean over the revolution is the mean, whatever the helix, and the energy is there.
#[test]
fn the_mean_of_the_revolution_is_the_mean() {
    let law = Kienzle::new([780.0, 300.0, 120.0], [0.23, 0.4, 0.3]).unwrap();
    let mut compared = 0;
    for shape in [
        Shape::Flat,
        Shape::Ball,
        Shape::Bull {
            corner_radius_mm: 2.0,
        },
        Shape::Face { lead_angle: 0.8 },
    ] {
        let tool = Tool::new(shape, 12.0, 3)
            .unwrap()
            .with_helix(0.6)
            .unwrap()
            .with_run_out(RunOut {
                offset_mm: 0.015,
                angle: 1.0,
            })
            .unwrap();
        let engagement = Engagement {
            contacts: vec![Contact::side(0.0, 3.0, 0.7, 2.6)],
        };
        let cut = Milling::new(&tool, &law, &engagement, Feed::level(0.08).unwrap());
        let (mean, revolution) = (cut.mean(), cut.revolution_at(720));
        let count = revolution.forces.len() as f64;
        let zero = revolution.harmonic(0).amplitude_n;
        let summed = revolution
            .forces
            .iter()
            .map(|f| f.force_n)
            .sum::<nalgebra::Vector3<f64>>()
            / count;
        let torque = revolution
            .forces
            .iter()
            .map(|f| f.moment_n_mm.z)
            .sum::<f64>()
            / count;
        assert!(
            (summed - mean.force_n).norm() < 1e-4 * mean.force_n.norm(),
            "{shape:?}: {summed} {}",
            mean.force_n
        );
        assert!((zero - summed.abs()).norm() < 1e-9 * zero.norm());
        assert!((torque / mean.moment_n_mm.z - 1.0).abs() < 1e-4);
        compared += 1;
    }
    assert_eq!(compared, 4);
}

/// What one tooth misses, the next one takes: the mean of the part without the edge stays.
#[test]
fn missed_teeth_leave_their_chips_to_the_next() {
    let engagement = Engagement::straight(5.0, 10.0, 2.0, Side::Left).unwrap();
    let mean = |out: f64, edge: [f64; 3]| {
        let law = Linear::new(K_C, edge).unwrap();
        let tool = Tool::new(Shape::Flat, 10.0, 4)
            .unwrap()
            .with_run_out(RunOut {
                offset_mm: out,
                angle: 0.3,
            })
            .unwrap();
        let cut = Milling::new(&tool, &law, &engagement, Feed::level(0.03).unwrap());
        let forces = cut.revolution_at(90).forces;
        let idle = forces.iter().filter(|f| f.force_n.norm() < 1e-12).count();
        (cut.mean(), idle)
    };
    let (true_running, idle) = mean(0.0, [0.0; 3]);
    assert_eq!(idle, 0);
    let (missed, _) = mean(0.06, [0.0; 3]);
    assert!((missed.force_n - true_running.force_n).norm() < 1e-6 * true_running.force_n.norm());
    // The edges of teeth that miss do not rub: with edge forces the mean falls.
    assert!(mean(0.06, K_E).0.torque_n_mm() < 0.95 * mean(0.0, K_E).0.torque_n_mm());
}

/// A plunge: the end bears, the side does not, nothing goes sideways.
#[test]
fn a_plunge_pushes_along_the_axis() {
    let tool = Tool::new(Shape::Flat, 10.0, 2).unwrap();
    let law = Linear::new([796.0, 168.0, 222.0], [0.0; 3]).unwrap();
    let engagement = Engagement::plunge(tool.end_radius_mm());
    let force = Milling::new(&tool, &law, &engagement, Feed::ramp(0.0, 0.02).unwrap()).mean();
    // Thrust: two lips of 5 mm with a chip of 0.02 mm; torque: the same with the lever of half the radius.
    assert!((force.force_n - nalgebra::Vector3::z() * (2.0 * 5.0 * 168.0 * 0.02)).norm() < 1e-9);
    assert!((force.moment_n_mm.z - 2.0 * 796.0 * 0.02 * 12.5).abs() < 1e-9);
    // Rising, or level, the end does not cut.
    let up = Milling::new(&tool, &law, &engagement, Feed::ramp(0.1, -0.01).unwrap()).mean();
    assert_eq!(up.force_n.norm(), 0.0);
}
