//! The zeroth-order approximation against the reference values, section D5.

use kinetostat_chatter::{
    Coefficients, Mode, Regeneration, ToolResponse, TurningCut, zeroth_order,
};
use kinetostat_testing::Worst;

use crate::support::{
    ONE_DIRECTION, SPEEDS, TWO_DIRECTIONS, TWO_MODES, X, aluminium, arc, cut, one_direction,
    regeneration, two_directions, two_modes,
};

/// Half a unit of the sixth decimal of a millimetre, and a little.
const PRINTED: f64 = 0.51;

fn limit(tool: &Regeneration, speed: f64) -> (f64, f64) {
    let found = zeroth_order::limit(tool, speed).unwrap();
    found.map_or((f64::NAN, f64::NAN), |l| (1e3 * l.depth, l.frequency_hz))
}

#[test]
fn limits_as_printed() {
    let mut worst = Worst::new();
    let mut compare = |tool: &Regeneration, speed: f64, expected: f64, name: &str| {
        let (found, _) = limit(tool, speed);
        worst.add_at((found - expected) / 1e-6, || {
            format!("{name} {speed}: {found} {expected}")
        });
    };
    for (name, immersion, _, printed) in ONE_DIRECTION {
        let tool = regeneration(one_direction(), cut(2, arc(name, immersion), aluminium()));
        for (speed, expected) in SPEEDS.into_iter().zip(printed) {
            compare(&tool, speed, expected, name);
        }
    }
    for (name, immersion, speed, _, expected) in TWO_DIRECTIONS {
        let tool = regeneration(two_directions(), cut(2, arc(name, immersion), aluminium()));
        compare(&tool, speed, expected, name);
    }
    let coefficients = Coefficients::with_ratios(6e8, 0.07, 0.0).unwrap();
    for (name, immersion, speed, _, expected, _) in TWO_MODES {
        let tool = regeneration(two_modes(), cut(3, arc(name, immersion), coefficients));
        compare(&tool, speed, expected, name);
    }
    assert!(worst.of(58) < PRINTED, "{worst}");
}

#[test]
fn chatter_frequencies_as_printed() {
    let coefficients = Coefficients::with_ratios(6e8, 0.07, 0.0).unwrap();
    let mut worst = Worst::new();
    for (name, immersion, speed, .., frequency) in TWO_MODES {
        let tool = regeneration(two_modes(), cut(3, arc(name, immersion), coefficients));
        worst.apart(limit(&tool, speed).1, frequency);
    }
    assert!(worst.of(5) < 0.51e-4, "{worst}");
}

/// Constant matrix: the zeroth order is exact.
#[test]
fn turning_is_exact() {
    let mode = Mode::along(X, 0.5, 60.0, 0.03).unwrap();
    let tool = ToolResponse::new(vec![mode]).unwrap();
    let turning = Regeneration::new(tool, TurningCut::new(X, X, 1.2e9).unwrap().into()).unwrap();
    let mut worst = Worst::new();
    for speed in [1000.0, 2500.0, 4000.0] {
        let exact = turning.stability_at(speed, 5e-5).unwrap();
        let exact = exact.limit().map_or(f64::NAN, |limit| limit.depth);
        worst.add(1e-3 * limit(&turning, speed).0 / exact - 1.0);
    }
    assert!(worst.of(3) < 1e-8, "{worst}");
}
