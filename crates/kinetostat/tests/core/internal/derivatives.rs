//! Series, closed forms and derivatives of the numbers that spring laws are written for.

use kinetostat::internal::{Forward, Number, Real};

#[test]
fn series_and_closed_forms_meet() {
    let step = 1e-9;
    let (below, above) = (0.1 - step, 0.1 + step);
    let (a, b) = (
        below.angle_per_sine_and_rate(),
        above.angle_per_sine_and_rate(),
    );
    assert!((b[0] - a[0] - 2.0 * step * a[1]).abs() < 1e-13);
    assert!((b[1] - a[1]).abs() < 1e-7);
    let (below, above) = (1.0 - step, 1.0 + step);
    let (a, b) = (
        below.logarithm_factor_and_rates(),
        above.logarithm_factor_and_rates(),
    );
    for k in 0..3 {
        let change = if k < 2 { 2.0 * step * a[k + 1] } else { 0.0 };
        assert!((b[k] - a[k] - change).abs() < 1e-7 * a[k].abs());
    }
}

#[test]
fn rates_are_differences() {
    let f = |[x, y]: [Forward<f64, 2>; 2]| {
        let (s, c) = (x * y).sin_cos();
        let [factor, rate] = (x * x).logarithm_factor();
        (s / (c + y.same(3.0))) * y.angle_per_sine() * factor - rate * x.clamped(0.2)
    };
    for at in [[0.3, 0.05], [1.4, 0.6], [0.1, 0.2]] {
        let found = f(Forward::variables(&at));
        for k in 0..2 {
            let moved = |h: f64| {
                let mut to = at;
                to[k] += h;
                f(Forward::variables(&to)).value
            };
            let h = 1e-4;
            let slope =
                (8.0 * (moved(h) - moved(-h)) - (moved(2.0 * h) - moved(-2.0 * h))) / (12.0 * h);
            assert!((slope - found.rate[k]).abs() < 1e-10, "{slope} {found:?}");
        }
    }
}
