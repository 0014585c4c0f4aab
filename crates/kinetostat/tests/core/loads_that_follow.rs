//! Columns under forces that follow them: divergence where the tangent's determinant is zero, not
//! where its symmetric part is indefinite, and what is left open.

use kinetostat::{
    Chain, ChainProblem, CurveSettings, EndCondition, Judged, Load, LoadPattern, MotionKind,
    Wrench, critical_load_factor,
};
use nalgebra::{Vector3, vector};

/// Two links of length one on springs of stiffness `first` and `second` (N m/rad), along x, pressed at
/// the end by a force that turns with the last link by a share (1: a follower, 0: dead).
fn ziegler(first: f64, second: f64) -> Chain {
    Chain::builder("Ziegler")
        .spring("s1", MotionKind::Revolute, Vector3::z(), first, 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .spring("s2", MotionKind::Revolute, Vector3::z(), second, 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .build()
        .unwrap()
}

fn settings(most: f64) -> CurveSettings {
    let mut settings = CurveSettings::within(0.0, most);
    settings.largest_change = Some(0.1);
    settings
}

#[test]
fn zieglers_column_does_not_diverge() {
    let chain = ziegler(1.0, 1.0);
    let press = Wrench::new(vector![-1.0, 0.0, 0.0], Vector3::zeros());
    let pattern = LoadPattern {
        end: Wrench::zero(),
        loads: vec![Load::follower(chain.tip(), press)],
    };
    let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
    let found =
        critical_load_factor(&problem, &pattern, Judged::ShapeAndEnd, &settings(4.0)).unwrap();
    // K - P G = [[2 - P, P - 1], [-1, 1]] with determinant 1, whatever P is.
    assert!(found.exact.is_none(), "{:?}", found.exact.map(|e| e.factor));
    assert!(found.linear.is_none(), "{:?}", found.linear);
    assert!(found.reached >= 4.0 - 1e-9, "{}", found.reached);
    assert!(!found.conservative);
    // Symmetric part [[2 - P, P / 2 - 1], [P / 2 - 1, 1]]: 2 - P = (P / 2 - 1)^2 at P = 2.
    let until = found.definite_until.unwrap();
    assert!((until - 2.0).abs() < 1e-6, "{until}");
    let words = found.caution().unwrap();
    assert!(
        words.contains("flutter") && words.contains("masses"),
        "{words}"
    );
}

/// Half dead, half following: divergence where the closed form says, and a dead load as before.
#[test]
fn partly_following_columns_diverge_by_the_determinant() {
    let (first, second) = (1.0, 1.0);
    let chain = ziegler(first, second);
    let press = Wrench::new(vector![-1.0, 0.0, 0.0], Vector3::zeros());
    let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
    for (follows, most) in [(0.0, 2.0), (0.1, 2.0), (0.3, 2.5), (0.4, 3.0)] {
        let mut loads = Vec::new();
        if follows > 0.0 {
            loads.push(Load::follower(chain.tip(), Wrench(press.0 * follows)));
        }
        let pattern = LoadPattern {
            end: Wrench(press.0 * (1.0 - follows)),
            loads,
        };
        // Absolute angles a, b: [[2 - P, f P - 1], [-1, 1 - (1 - f) P]] has determinant zero at
        // (1 - f) P^2 - 3 (1 - f) P + 1 = 0: real for (1 - f) >= 4 / 9.
        let d = 1.0 - follows;
        let asked = (3.0 * d - (9.0 * d * d - 4.0 * d).sqrt()) / (2.0 * d);
        let found =
            critical_load_factor(&problem, &pattern, Judged::ShapeAndEnd, &settings(most)).unwrap();
        assert_eq!(found.conservative, follows == 0.0);
        assert_eq!(found.caution().is_none(), follows == 0.0);
        let exact = found.exact.expect("divergence").factor;
        assert!((exact - asked).abs() < 1e-6, "{follows}: {exact} {asked}");
        let linear = found.linear.expect("a linear prediction");
        assert!((linear - asked).abs() < 1e-9, "{follows}: {linear} {asked}");
        if let Some(until) = found.definite_until {
            assert!(until <= exact + 1e-9, "{until} {exact}");
        }
    }
}

/// A follower that stays, and a dead load that grows beside it: divergence by the closed form or none, also
/// where eigenvalues of the springs' inverse times the loads turn real above one.
#[test]
fn a_dead_load_beside_a_follower_diverges_by_the_determinant() {
    let chain = ziegler(1.0, 1.0);
    let press = Wrench::new(vector![-1.0, 0.0, 0.0], Vector3::zeros());
    let pattern = LoadPattern {
        end: press,
        loads: Vec::new(),
    };
    for stays in [1e-4, 0.2, 0.5, 0.9, 1.1, 1.5, 2.5] {
        let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        let follower = Load::follower(chain.tip(), Wrench(press.0 * stays));
        problem.loads.push(follower);
        let found =
            critical_load_factor(&problem, &pattern, Judged::ShapeAndEnd, &settings(3.0)).unwrap();
        // Absolute angles: [[2 - F - p, F - 1], [-1, 1 - p]] has the determinant p^2 - (3 - F) p + 1.
        let half: f64 = 0.5 * (3.0 - stays);
        let asked = (half >= 1.0).then(|| half - (half * half - 1.0).sqrt());
        let exact = found.exact.map(|e| e.factor);
        let linear = found.linear;
        assert_eq!(
            exact.is_some(),
            asked.is_some(),
            "{stays}: {exact:?} {asked:?}"
        );
        assert_eq!(
            linear.is_some(),
            asked.is_some(),
            "{stays}: {linear:?} {asked:?}"
        );
        if let (Some(exact), Some(linear), Some(asked)) = (exact, linear, asked) {
            assert!((exact - asked).abs() < 1e-6, "{stays}: {exact} {asked}");
            assert!((linear - asked).abs() < 1e-9, "{stays}: {linear} {asked}");
        }
        assert!(!found.conservative);
    }
}
