//! Turning: closed forms, a formula of a maker, the edge in the plane of the tool.

use kinetostat_cutting::*;
use proptest::prelude::*;

proptest! {
    /// Sandvik Coromant, Silent Tools application guide, page 91 (manualsdir.com/manuals/407503, page 93):
    /// `F_t = k_c0.4 (0.4/(f sin KAPR))^0.29 f a_p`, `k_c0.4` the specific force at a chip of 0.4 mm.
    #[test]
    fn tangential_force_of_a_makers_guide(depth in 0.1..10.0_f64, feed in 0.02..1.0_f64, degrees in 45.0..95.0_f64, specific in 500.0..4000.0_f64) {
        let law = Kienzle::new([specific * 0.4_f64.powf(0.29), 0.0, 0.0], [0.29, 0.0, 0.0]).unwrap();
        let found = Turning::new(depth, feed, degrees.to_radians()).unwrap().force(&law).unwrap();
        let wanted = specific * (0.4 / (feed * degrees.to_radians().sin())).powf(0.29) * feed * depth;
        prop_assert!((found.cutting_n - wanted).abs() <= 1e-12 * wanted);
    }

    /// The edge as a line in the plane (x along the feed, y away from the part): it runs from the corner at the finished
    /// surface to the old one, `depth` higher, and leans towards the feed. What the part presses on it is `radial` along
    /// the normal away from the material and `axial` along the edge from the corner.
    #[test]
    fn the_edge_in_its_plane(depth in 0.1..10.0_f64, feed in 0.02..1.0_f64, degrees in 10.0..140.0_f64, radial in 100.0..2000.0_f64, axial in -500.0..500.0_f64) {
        let law = Linear::new([2000.0, radial, axial], [0.0; 3]).unwrap();
        let found = Turning::new(depth, feed, degrees.to_radians()).unwrap().force(&law).unwrap();
        let end = [depth / degrees.to_radians().tan(), depth];
        let length = end[0].hypot(end[1]);
        let along = [end[0] / length, end[1] / length];
        // A quarter turn: away from the material, which is ahead of the edge and below it.
        let away = [-along[1], along[0]];
        // The area between two places of the edge is that of a parallelogram.
        let chip = feed * depth / length;
        let force: Vec<f64> = (0..2).map(|i| (radial * away[i] + axial * along[i]) * chip * length).collect();
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (radial + 500.0) * feed * depth;
        prop_assert!(close(found.feed_n, -force[0]), "{} {}", found.feed_n, force[0]);
        prop_assert!(close(found.passive_n, force[1]), "{} {}", found.passive_n, force[1]);
        prop_assert!((found.cutting_n - 2000.0 * feed * depth).abs() <= 1e-9 * found.cutting_n);
        prop_assert!((found.width_mm - length).abs() <= 1e-12 * length);
        prop_assert!((found.chip_mm - chip).abs() <= 1e-12 * chip);
    }
}

#[test]
fn what_is_no_cut_is_refused_by_name() {
    let right = 90_f64.to_radians();
    let law = Linear::new([2000.0, 0.0, 0.0], [0.0; 3]).unwrap();
    let cut = Turning::new(2.0, 0.3, right).unwrap();
    assert!((cut.force(&law).unwrap().cutting_n - 1200.0).abs() < 1e-9);
    for (error, quantity) in [
        (Turning::new(0.0, 0.3, right).unwrap_err(), "depth of cut"),
        (Turning::new(2.0, f64::NAN, right).unwrap_err(), "feed"),
        (Turning::new(2.0, 0.3, 90.0).unwrap_err(), "approach angle"),
        (Turning::new(2.0, 0.3, 0.0).unwrap_err(), "approach angle"),
        (cut.force(&Broken).unwrap_err(), "feed force of the law"),
    ] {
        assert_eq!(error.quantity, quantity, "{error}");
    }
}

#[derive(Debug)]
struct Broken;

impl ForceLaw for Broken {
    fn edge_force(&self, _chip_mm: f64) -> EdgeForce {
        // At 90 degrees the cosine is not quite zero: both components are infinite.
        EdgeForce::new(1.0, 0.0, f64::INFINITY)
    }
}
