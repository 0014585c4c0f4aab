//! Curves of spindles: between points, beyond them, and what a cut exceeds.

use std::f64::consts::TAU;

use kinetostat_cutting::*;
use proptest::prelude::*;

proptest! {
    /// Constant torque, then constant power: the smaller of the two at any speed.
    #[test]
    fn rated(power in 100.0..50_000.0_f64, base in 100.0..10_000.0_f64, times in 1.0..10.0_f64, share in 0.0..1.0_f64) {
        let most = base * times;
        let curve = SpindleCurve::rated(power, base, most).unwrap();
        let rpm = share * most;
        let limit = curve.limit_at(rpm).unwrap();
        let wanted = (power / (TAU * base / 60.0)).min(power / (TAU * rpm / 60.0));
        prop_assert!((limit.torque_n_m - wanted).abs() <= 1e-12 * wanted, "{} {}", limit.torque_n_m, wanted);
        prop_assert!((limit.power_w - wanted * TAU * rpm / 60.0).abs() <= 1e-9 * power);
        prop_assert_eq!(curve.most_rpm(), most);
        prop_assert!(curve.limit_at(most * (1.0 + 1e-9)).is_none());
        // A cut is within the limit or exceeds it.
        prop_assert_eq!(curve.exceeded_by(rpm, 1e3 * wanted * (1.0 - 1e-9)), None);
        let finding = curve.exceeded_by(rpm, 1e3 * wanted * (1.0 + 1e-9));
        prop_assert!(matches!(finding, Some(SpindleFinding::Torque { .. })), "{:?}", finding);
    }

    /// The torque of points is on the straight line between neighbours, found by search from the other end.
    #[test]
    fn points(steps in proptest::collection::vec((1.0..1000.0_f64, 0.0..100.0_f64), 1..20), share in 0.0..1.0_f64) {
        let mut rpm = 0.0;
        let points: Vec<SpindlePoint> = steps.iter().map(|(step, torque)| {
            rpm += step;
            SpindlePoint::of_torque(rpm, *torque)
        }).collect();
        let curve = SpindleCurve::new(&points).unwrap();
        let at = share * rpm;
        let after = points.iter().rposition(|point| point.speed_rpm <= at);
        let wanted = match after {
            None => points[0].torque_n_m,
            Some(i) if i + 1 == points.len() => points[i].torque_n_m,
            Some(i) => {
                let (a, b) = (points[i], points[i + 1]);
                (a.torque_n_m * (b.speed_rpm - at) + b.torque_n_m * (at - a.speed_rpm)) / (b.speed_rpm - a.speed_rpm)
            }
        };
        let found = curve.limit_at(at).unwrap().torque_n_m;
        prop_assert!((found - wanted).abs() <= 1e-9 * (1.0 + wanted), "{found} {wanted}");
        for point in &points {
            prop_assert_eq!(curve.limit_at(point.speed_rpm).unwrap().torque_n_m, point.torque_n_m);
        }
    }
}

#[test]
fn what_a_cut_exceeds_is_a_finding() {
    let curve = SpindleCurve::rated(7500.0, 1500.0, 12_000.0).unwrap();
    for rpm in [-1.0, 12_001.0, f64::NAN, f64::INFINITY] {
        assert!(curve.limit_at(rpm).is_none());
        let finding = curve.exceeded_by(rpm, 0.0).unwrap();
        assert!(
            matches!(
                finding,
                SpindleFinding::Speed {
                    most_rpm: 12_000.0,
                    ..
                }
            ),
            "{finding}"
        );
    }
    assert!(curve.exceeded_by(1500.0, f64::NAN).is_some());
    // 60 N m where 47.75 N m are.
    let finding = curve.exceeded_by(1000.0, 60_000.0).unwrap();
    assert_eq!(
        finding.to_string(),
        "the cut needs 60.000 N m (6283 W) at 1000 rpm, the spindle gives 47.746 N m (5000 W)"
    );
    // Power is torque times speed: 10 kW at 5000 rpm are 19.1 N m.
    let point = SpindlePoint::of_power(5000.0, 10_000.0);
    assert!((point.torque_n_m - 19.0986).abs() < 1e-4);
}

#[test]
fn what_is_no_curve_is_refused_by_point() {
    let points = |points: &[[f64; 2]]| {
        let points: Vec<SpindlePoint> = points
            .iter()
            .map(|[n, t]| SpindlePoint::of_torque(*n, *t))
            .collect();
        SpindleCurve::new(&points)
    };
    assert!(points(&[[0.0, 10.0], [8000.0, 0.0]]).is_ok());
    for (result, quantity) in [
        (points(&[]), "points of the spindle's curve"),
        (points(&[[0.0, 5.0]]), "speed of the last point"),
        (points(&[[100.0, 5.0], [100.0, 4.0]]), "speed of point 2"),
        (points(&[[100.0, 5.0], [90.0, 4.0]]), "speed of point 2"),
        (points(&[[f64::NAN, 5.0]]), "speed of point 1"),
        (points(&[[100.0, 5.0], [200.0, -4.0]]), "torque of point 2"),
        (points(&[[100.0, f64::INFINITY]]), "torque of point 1"),
        (
            points(&vec![[1.0, 1.0]; 10_001]),
            "points of the spindle's curve",
        ),
        (SpindleCurve::rated(0.0, 100.0, 200.0), "rated power"),
        (SpindleCurve::rated(1e3, 300.0, 200.0), "largest speed"),
        (SpindleCurve::rated(1e3, f64::NAN, 200.0), "base speed"),
        // Power at no speed is an endless torque.
        (
            SpindleCurve::new(&[SpindlePoint::of_power(0.0, 1e3)]),
            "torque of point 1",
        ),
    ] {
        let error = result.unwrap_err();
        assert_eq!(error.quantity, quantity, "{error}");
        assert_eq!(error.kind, CutErrorKind::Machine);
    }
}
