//! Any cut against plain summation, with run-out, on flats and balls.

use kinetostat_cutting::{
    Contact, Engagement, Exponential, Feed, ForceLaw, Kienzle, Linear, Milling, Rational, Rotation,
    RunOut, Shape, Tool,
};
use proptest::prelude::*;

use crate::plain::Plain;

fn law(kind: usize) -> Box<dyn ForceLaw> {
    match kind {
        0 => Box::new(Linear::new([796.0, 168.0, 222.0], [27.7, 30.8, 1.4]).unwrap()),
        1 => Box::new(Kienzle::new([780.0, 300.0, 120.0], [0.23, 0.4, 0.3]).unwrap()),
        2 => Box::new(Exponential::new([1700.0, 650.0, 300.0], [25.0, 35.0, 5.0], 0.008).unwrap()),
        _ => Box::new(
            Rational::new(
                [2000.0, 900.0, 300.0],
                [1e5, 3e4, 1e4],
                [100.0, 120.0, 80.0],
            )
            .unwrap(),
        ),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]
    #[test]
    fn means_and_instants(
        ball in any::<bool>(),
        radius in 1.0..12.0_f64,
        teeth in 1..6_usize,
        helix in prop_oneof![Just(0.0), 0.05..0.9_f64],
        out in prop_oneof![Just(0.0), 0.0..0.03_f64],
        angle in 0.0..std::f64::consts::TAU,
        arc in (0.0..3.1_f64, 0.0..3.1_f64),
        deep in 0.05..0.95_f64,
        feed in 0.01..0.2_f64,
        kind in 0..4_usize,
        turn in 0.0..std::f64::consts::TAU,
    ) {
        let law = law(kind);
        let (entry, exit) = if arc.0 < arc.1 { arc } else { (arc.1, arc.0) };
        let (shape, depth) = if ball { (Shape::Ball, deep * radius) } else { (Shape::Flat, 2.0 * deep * radius) };
        let tool = Tool::new(shape, 2.0 * radius, teeth).unwrap()
            .with_helix(helix).unwrap()
            .with_run_out(RunOut { offset_mm: out.min(0.1 * radius), angle }).unwrap();
        let engagement = Engagement { contacts: vec![Contact::side(0.0, depth, entry, exit)] };
        let cut = Milling::new(&tool, &*law, &engagement, Feed::level(feed).unwrap());
        let per_edge = |chip: f64| {
            let f = law.edge_force(chip);
            [f.tangential, f.radial, f.axial]
        };
        let plain = Plain {
            ball, radius, teeth, helix,
            run_out: (tool.run_out().offset_mm, angle),
            arc: (entry, exit), depth, feed, law: &per_edge,
        };
        // The mean does not depend on the helix: without it the summation needs few slices, and as many angles in a narrow arc.
        prop_assume!(exit - entry > 0.02);
        let angles = (1440.0 / (exit - entry).min(1.0)) as usize * teeth;
        let (mean, _, torque) = Plain { helix: 0.0, ..plain }.revolution(angles, if ball { 240 } else { 1 });
        let found = cut.mean();
        let scale = torque.max(1e-9) / radius;
        for i in 0..3 {
            prop_assert!((found.force_n[i] - mean.force[i]).abs() < 2e-3 * scale, "{:?} {:?}", found, mean);
        }
        for i in 0..2 {
            prop_assert!((found.moment_n_mm[i] - mean.moment[i]).abs() < 2e-3 * scale * (radius + depth), "{:?} {:?}", found, mean);
        }
        prop_assert!((found.moment_n_mm.z - mean.torque).abs() < 2e-3 * scale * radius);
        let at = plain.at(turn, 4000);
        let found = cut.at(turn);
        for i in 0..3 {
            prop_assert!((found.force_n[i] - at.force[i]).abs() < 4e-3 * scale, "{:?} {:?}", found, at);
        }
        prop_assert!((found.moment_n_mm.z - at.torque).abs() < 4e-3 * scale * radius);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]
    /// No angle has more than the peaks, and the plain summation at the angle of a peak has as much.
    #[test]
    fn peaks_are_reached_and_not_passed(
        shape in 0..4_usize, teeth in 1..5_usize, helix in prop_oneof![Just(0.0), Just(0.017), -0.7..0.9_f64],
        out in prop_oneof![Just(0.0), 0.0..0.03_f64], arc in (0.0..3.1_f64, 0.02..3.1_f64), depth in 0.05..9.0_f64,
        feed in 0.01..0.2_f64, kind in 0..4_usize, clockwise in any::<bool>(),
    ) {
        let law = law(kind);
        let shape = [Shape::Flat, Shape::Ball, Shape::Bull { corner_radius_mm: 2.0 }, Shape::Face { lead_angle: 0.8 }][shape];
        let tool = Tool::new(shape, 10.0, teeth).unwrap().with_helix(helix).unwrap()
            .with_run_out(RunOut { offset_mm: out, angle: 1.0 }).unwrap();
        let exit = (arc.0 + arc.1).min(std::f64::consts::PI);
        let engagement = Engagement { contacts: vec![Contact::side(0.0, depth, arc.0, exit)] };
        let rotation = if clockwise { Rotation::Clockwise } else { Rotation::CounterClockwise };
        let cut = Milling::new(&tool, &*law, &engagement, Feed::level(feed).unwrap()).turning(rotation);
        let peaks = cut.peaks();
        let mut largest = [0.0_f64; 2];
        for i in 0..2003 {
            let at = cut.at(std::f64::consts::TAU * (f64::from(i) + 0.37) / 2003.0);
            for (most, found) in largest.iter_mut().zip([at.in_plane_n(), at.torque_n_mm()]) {
                prop_assert!(found.is_finite());
                *most = kinetostat_testing::largest([*most, found]);
            }
        }
        for (peak, sampled) in [peaks.across.force.in_plane_n(), peaks.torque.force.torque_n_mm()].into_iter().zip(largest) {
            prop_assert!(peak >= sampled * (1.0 - 1e-9), "{} below {}", peak, sampled);
        }
        // Where teeth are straight the force jumps: its larger side is within a nanoradian of the angle.
        let beside = [-2e-9, 0.0, 2e-9].map(|by| cut.at(peaks.across.turn + by).in_plane_n());
        let reached = kinetostat_testing::largest(beside);
        let peak = peaks.across.force.in_plane_n();
        prop_assert!((reached - peak).abs() <= 1e-6 * peak, "{} at the angle of the peak {}", reached, peak);
    }
}

/// A thin climb cut of little helix: samples a degree apart miss 2.3 % of its peak. Plain summation in steps of 1e-5 rad finds it.
#[test]
fn the_peak_between_two_samples() {
    let (shape, teeth, helix) = (Shape::Flat, 1, 1_f64.to_radians());
    let (width, depth, feed) = (0.173, 2.91, 0.1);
    let law = Linear::new([2448.9, 135.4, 393.7], [21.44, 4.81, 1.28]).unwrap();
    let tool = Tool::new(shape, 6.0, teeth)
        .unwrap()
        .with_helix(helix)
        .unwrap();
    let engagement =
        Engagement::straight(3.0, width, depth, kinetostat_cutting::Side::Right).unwrap();
    let found = Milling::new(&tool, &law, &engagement, Feed::level(feed).unwrap())
        .peaks()
        .across;
    let per_edge = |chip: f64| {
        let f = law.edge_force(chip);
        [f.tangential, f.radial, f.axial]
    };
    let entry = std::f64::consts::PI - (1.0 - width / 3.0_f64).acos();
    let plain = Plain {
        ball: false,
        radius: 3.0,
        teeth,
        helix,
        run_out: (0.0, 0.0),
        arc: (entry, std::f64::consts::PI),
        depth,
        feed,
        law: &per_edge,
    };
    // From where the tip enters to where the top of the edge has entered.
    let forces = (0..3000).map(|i| {
        let [x, y, _] = plain.at(entry + 1e-5 * f64::from(i), 4000).force;
        x.hypot(y)
    });
    let summed = kinetostat_testing::largest(forces);
    assert!((summed - 296.41).abs() < 0.02, "{summed}");
    assert!(
        (found.force.in_plane_n() / summed - 1.0).abs() < 5e-4,
        "{found:?} {summed}"
    );
}

/// Row 4 of the table in equal angles.
#[test]
fn a_ball_in_a_slot() {
    let law = Linear::new([1700.0, 650.0, 300.0], [25.0, 35.0, 5.0]).unwrap();
    let tool = Tool::new(Shape::Ball, 6.0, 3).unwrap();
    let engagement = Engagement {
        contacts: vec![Contact::side(0.0, 2.03, 0.0, std::f64::consts::PI)],
    };
    let cut = Milling::new(&tool, &law, &engagement, Feed::level(0.067).unwrap());
    let found = cut.mean().force_n;
    for (found, summed) in found.iter().zip([-79.882, 262.332, 247.061]) {
        assert!((found - summed).abs() < 2e-3, "{found} for {summed}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, ..ProptestConfig::default() })]
    /// The table of means against the sums without one.
    #[test]
    fn means_by_table(
        kind in 0..4_usize, shape in 0..4_usize, teeth in 1..5_usize, out in prop_oneof![Just(0.0), 0.0..0.03_f64],
        feed in 0.02..0.2_f64, clockwise in any::<bool>(),
        patches in prop::collection::vec((0.0..4.0_f64, 0.01..3.0_f64, 0.0..3.0_f64, 0.01..3.0_f64), 1..4),
    ) {
        use kinetostat_cutting::{MeanTable, Rotation};
        let law = law(kind);
        let shape = [Shape::Flat, Shape::Ball, Shape::Bull { corner_radius_mm: 2.0 }, Shape::Face { lead_angle: 0.8 }][shape];
        let tool = Tool::new(shape, 10.0, teeth).unwrap().with_helix(0.5).unwrap()
            .with_run_out(RunOut { offset_mm: out, angle: 1.0 }).unwrap();
        let contacts = patches.iter().map(|(z, height, entry, length)| {
            Contact::side(*z, z + height, *entry, (entry + length).min(std::f64::consts::PI))
        }).collect();
        let engagement = Engagement { contacts };
        let rotation = if clockwise { Rotation::Clockwise } else { Rotation::CounterClockwise };
        let cut = Milling::new(&tool, &*law, &engagement, Feed::level(feed).unwrap()).turning(rotation);
        let table = MeanTable::new(&tool, &*law, feed, rotation).unwrap();
        let (a, b) = (table.mean(&engagement), cut.mean());
        // Against the force of a slot of the same depth.
        let slot = Engagement { contacts: vec![Contact::side(0.0, engagement.depth_mm(), 0.0, std::f64::consts::PI)] };
        let scale = Milling::new(&tool, &*law, &slot, Feed::level(feed).unwrap()).mean().moment_n_mm.norm();
        prop_assert!((a.force_n - b.force_n).norm() < 5e-4 * scale / 5.0, "{:?} {:?}", a, b);
        prop_assert!((a.moment_n_mm - b.moment_n_mm).norm() < 5e-4 * scale, "{:?} {:?}", a, b);
    }
}
