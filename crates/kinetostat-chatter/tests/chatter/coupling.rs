//! Mode coupling against the reference values, section D5, and against eigenvalues.

use kinetostat_chatter::{
    Coupled, Mode, Process, ToolResponse, coupled_limit, coupled_roots, two_axis_limit,
};
use kinetostat_testing::Worst;
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use proptest::prelude::*;

use crate::support::{X, Y};

const K: [f64; 2] = [1e6, 1.4e6];
const MASS: f64 = 50.0;

/// Chip and force direction, degrees; undamped limit, limit with 2 % damping, N/m.
const TABLE: [(f64, f64, f64, f64); 4] = [
    (45.0, -45.0, 200000.0, 210969.23),
    (60.0, -20.0, 264524.386, 279561.571),
    (30.0, -30.0, 214359.354, 227782.417),
    (20.0, -70.0, 311144.765, 328209.858),
];

fn tool(damping: f64, k: [f64; 2]) -> ToolResponse {
    let mode = |direction, k: f64| {
        Mode::along(
            direction,
            MASS,
            (k / MASS).sqrt() / std::f64::consts::TAU,
            damping,
        )
        .unwrap()
    };
    ToolResponse::new(vec![mode(X, k[0]), mode(Y, k[1])]).unwrap()
}

fn process(chip: f64, force: f64) -> Process {
    let at = |angle: f64| Vector3::new(angle.cos(), angle.sin(), 0.0);
    Process::new(at(chip.to_radians()), at(force.to_radians())).unwrap()
}

#[test]
fn thresholds_of_the_table() {
    let (mut undamped, mut damped) = (Worst::new(), Worst::new());
    for (chip, force, closed, with_damping) in TABLE {
        let found = two_axis_limit(K[0], K[1], chip.to_radians(), force.to_radians());
        undamped.add(found.unwrap().unwrap() / closed - 1.0);
        let found = coupled_limit(&tool(0.02, K), &process(chip, force))
            .unwrap()
            .unwrap();
        assert_eq!(found.kind, Coupled::Flutter);
        damped.add(found.factor / with_damping - 1.0);
        // On either side, by eigenvalues.
        for (factor, stable) in [(0.999, true), (1.001, false)] {
            let roots = coupled_roots(&tool(0.02, K), &process(chip, force), factor * found.factor);
            assert_eq!(roots.unwrap()[0].0 < 0.0, stable);
        }
    }
    assert!(undamped.of(4) < 2e-9, "{undamped}");
    assert!(damped.of(4) < 1e-8, "{damped}");
    let (a, b) = (45_f64.to_radians(), 10_f64.to_radians());
    assert_eq!(two_axis_limit(K[0], K[1], a, b).unwrap(), None);
    assert_eq!(
        coupled_limit(&tool(0.02, K), &process(45.0, 10.0)).unwrap(),
        None
    );
}

#[test]
fn a_process_that_pulls_is_a_static_loss() {
    // Force along the displacement: a negative spring of 1e6 N/m.
    let found = coupled_limit(&tool(0.02, K), &process(0.0, 180.0))
        .unwrap()
        .unwrap();
    assert_eq!(found.kind, Coupled::StaticLoss);
    assert!((found.factor / 1e6 - 1.0).abs() < 1e-9, "{found:?}");
}

/// Trap 4: the flexibility of modes that are left out shifts the limit; with it, few modes give the limit of all.
#[test]
fn residual_flexibility_counts() {
    let stiff = [(0.3, 0.9, 900.0), (-0.8, 0.5, 1300.0), (0.6, 0.6, 1700.0)];
    let mut modes = tool(0.02, K).modes().to_vec();
    for (x, y, f) in stiff {
        modes.push(Mode::along(Vector3::new(x, y, 0.2), 0.02, f, 0.02).unwrap());
    }
    let all = ToolResponse::new(modes).unwrap();
    let few = all.with_modes_up_to(100.0).unwrap();
    let bare = few.clone().with_residual(Matrix3::zeros()).unwrap();
    let limit = |tool: &ToolResponse| {
        coupled_limit(tool, &process(60.0, -20.0))
            .unwrap()
            .unwrap()
            .factor
    };
    let (exact, with, without) = (limit(&all), limit(&few), limit(&bare));
    assert!((with / exact - 1.0).abs() < 1e-3, "{exact} {with}");
    assert!((without / exact - 1.0).abs() > 0.02, "{exact} {without}");
    let roots = coupled_roots(&few, &process(60.0, -20.0), with).unwrap();
    assert!(roots[0].0.abs() < 1e-6 * roots[0].1.abs(), "{roots:?}");
}

proptest! {
    /// The closed form against the eigenvalues of `diag(k1, k2) + Kc f n^T`, and the bound of half the difference.
    #[test]
    fn closed_form_is_where_eigenvalues_become_complex(a in -1.5..1.5_f64, b in -1.5..1.5_f64, ratio in 1.05..3.0_f64) {
        let k = [1e6, 1e6 * ratio];
        let discriminant = |kc: f64| {
            let at = |angle: f64| Vector2::new(angle.cos(), angle.sin());
            let m = Matrix2::from_diagonal(&Vector2::new(k[0], k[1])) + kc * at(b) * at(a).transpose();
            (m.trace().powi(2) - 4.0 * m.determinant()) / (k[1] - k[0]).powi(2)
        };
        match two_axis_limit(k[0], k[1], a, b).unwrap() {
            Some(limit) => {
                prop_assert!(limit >= 0.5 * (k[1] - k[0]) * (1.0 - 1e-12));
                prop_assert!(discriminant(limit * (1.0 - 1e-6)) > 0.0);
                prop_assert!(discriminant(limit).abs() < 1e-8 * (1.0 + (limit / (k[1] - k[0])).powi(2)));
            }
            None => for step in 1..200 {
                prop_assert!(discriminant(2e5 * f64::from(step)) >= -1e-9);
            },
        }
    }
}
