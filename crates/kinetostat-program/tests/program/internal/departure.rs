//! How far a polynomial and a function depart from a chord.

use kinetostat_program::internal::{Values, departure, parabola, polynomial, remainder};
use kinetostat_testing::{Worst, largest_size};
use nalgebra::Vector6;

fn values(f: impl Fn(f64) -> f64) -> Values {
    std::array::from_fn(|i| Vector6::x() * f(0.25 * i as f64))
}

#[test]
fn a_quartic_is_met_and_its_departure_is_bounded_closely() {
    let f = |t: f64| 0.3 - t + 2.0 * t * t - 5.0 * t.powi(3) + 1.7 * t.powi(4);
    let known = values(f);
    let chord = [Vector6::x() * 0.1, Vector6::x() * -2.0];
    let mut largest = Worst::new();
    for i in 0..=5000 {
        let t = f64::from(i) / 5000.0;
        assert!((polynomial(&known, t).x - f(t)).abs() < 1e-12);
        largest.add(f(t) - chord[0].lerp(&chord[1], t).x);
    }
    let (largest, bound) = (largest.of(5001), departure(&known, chord));
    assert!(
        bound >= largest && bound < 1.1 * largest,
        "{bound} {largest}"
    );
}

#[test]
fn a_parabola_is_bounded_to_half_a_percent() {
    let f = |t: f64| t * t;
    let chord = [Vector6::zeros(), Vector6::x() * 1.0];
    let bound = departure(&values(f), chord);
    assert!((0.25..0.251_3).contains(&bound), "{bound}");
    let middle = Vector6::x() * 0.25;
    assert!((parabola(chord[0], middle, chord[1])[1].x - 0.0625).abs() < 1e-15);
}

#[test]
fn the_remainder_holds_for_functions_with_a_pole_at_that_distance() {
    // 1 / (r + x) has its pole at -r; at half that distance it is at most 2/r = twice its value at 0.
    for radius in [0.5, 1.0, 3.0] {
        let f = |x: f64| 1.0 / (radius + x);
        for length in [0.05_f64, 0.2, 0.4] {
            let known = values(|t| f(t * length));
            let three = parabola(known[0], known[2], known[4]);
            let missed = |values: &Values| {
                let shares = (0..=400).map(|i| f64::from(i) / 400.0);
                largest_size(shares.map(|t| polynomial(values, t).x - f(t * length)))
            };
            let bound = |points| remainder(points, f(0.0), length, 0.5 * radius);
            assert!(missed(&known) <= bound(5) + 1e-15, "{radius} {length}");
            assert!(missed(&three) <= bound(3) + 1e-15, "{radius} {length}");
        }
    }
}
