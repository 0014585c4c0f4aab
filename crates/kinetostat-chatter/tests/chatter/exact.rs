//! Exact lobes against the reference values, section D5.

use kinetostat_chatter::{Coefficients, Mode, Regeneration, ToolResponse, TurningCut};
use kinetostat_testing::Worst;

use crate::support::{
    ONE_DIRECTION, SPEEDS, TWO_DIRECTIONS, TWO_MODES, X, aluminium, arc, cut, one_direction,
    regeneration, two_directions, two_modes,
};

#[test]
fn multipliers_of_slotting() {
    let slot = regeneration(one_direction(), cut(2, arc("slot", 1.0), aluminium()));
    let mut worst = Worst::new();
    for (depth, expected) in [
        (0.2e-3, 0.81974278),
        (0.5e-3, 1.07397559),
        (1e-3, 1.40647353),
    ] {
        worst.apart(slot.multiplier(5000.0, depth).unwrap().size(), expected);
        // The whole spectrum by another way.
        let all = slot.multipliers(5000.0, depth).unwrap();
        worst.apart(all[0].0.hypot(all[0].1), expected);
    }
    assert!(worst.of(6) < 1e-7, "{worst}");
}

#[test]
fn limits_in_one_direction() {
    let mut worst = Worst::new();
    for (name, immersion, exact, _) in ONE_DIRECTION {
        let tool = regeneration(one_direction(), cut(2, arc(name, immersion), aluminium()));
        for (speed, expected) in SPEEDS.into_iter().zip(exact) {
            let found = tool.stability_at(speed, 0.02).unwrap();
            let limit = found.limit().map_or(f64::NAN, |limit| 1e3 * limit.depth);
            worst.add_at(limit / expected - 1.0, || {
                format!("{name} {immersion} {speed}: {limit} {expected}")
            });
        }
    }
    assert!(worst.of(49) < 2e-6, "{worst}");
}

#[test]
fn limits_in_two_directions() {
    let mut worst = Worst::new();
    for (name, immersion, speed, expected, _) in TWO_DIRECTIONS {
        let tool = regeneration(two_directions(), cut(2, arc(name, immersion), aluminium()));
        let found = tool.stability_at(speed, 0.01).unwrap();
        let limit = found.limit().map_or(f64::NAN, |limit| 1e3 * limit.depth);
        worst.add_at(limit / expected - 1.0, || {
            format!("{name} {immersion} {speed}: {limit}")
        });
    }
    let coefficients = Coefficients::with_ratios(6e8, 0.07, 0.0).unwrap();
    for (name, immersion, speed, expected, ..) in TWO_MODES {
        let tool = regeneration(two_modes(), cut(3, arc(name, immersion), coefficients));
        let found = tool.stability_at(speed, 0.01).unwrap();
        let limit = found.limit().map_or(f64::NAN, |limit| 1e3 * limit.depth);
        worst.add_at(limit / expected - 1.0, || {
            format!("{name} {immersion} {speed}: {limit}")
        });
    }
    assert!(worst.of(9) < 2e-5, "{worst}");
}

/// Closed form: `G = -1/(2 Kf a) - i ...`: the limits of a constant matrix at three speeds, and the absolute minimum.
#[test]
fn turning_as_in_the_closed_form() {
    let mode = Mode::along(X, 0.5, 60.0, 0.03).unwrap();
    let tool = ToolResponse::new(vec![mode]).unwrap();
    let turning = Regeneration::new(tool, TurningCut::new(X, X, 1.2e9).unwrap().into()).unwrap();
    let mut worst = Worst::new();
    for (speed, expected) in [
        (1000.0, 3.7171235e-6),
        (2500.0, 7.1756459e-6),
        (4000.0, 6.5646838e-6),
    ] {
        let found = turning.stability_at(speed, 5e-5).unwrap();
        worst.add(found.limit().map_or(f64::NAN, |limit| limit.depth) / expected - 1.0);
    }
    assert!(worst.of(3) < 1e-7, "{worst}");
}
