//! Columns under forces that follow them: divergence where the tangent's determinant is zero, not
//! where its symmetric part is indefinite, and what is left open.

use kinetostat::{
    Chain, ChainProblem, CurveSettings, EndCondition, Limb, Load, Mechanism, MotionKind, Parameter,
    Platform, Pose, Settings, Wrench,
    continuation::LoadPattern,
    critical_load_factor, equilibria,
    equilibrium::{Bounds, SearchSettings, SpreadSettings, StabilityOf},
    follow, solve_chain,
};
use nalgebra::{Matrix2, Vector2, Vector3, vector};

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
        critical_load_factor(&problem, &pattern, StabilityOf::ShapeAndEnd, &settings(4.0)).unwrap();
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
        let expected = (3.0 * d - (9.0 * d * d - 4.0 * d).sqrt()) / (2.0 * d);
        let found = critical_load_factor(
            &problem,
            &pattern,
            StabilityOf::ShapeAndEnd,
            &settings(most),
        )
        .unwrap();
        assert_eq!(found.conservative, follows == 0.0);
        assert_eq!(found.caution().is_none(), follows == 0.0);
        let exact = found.exact.expect("divergence").factor;
        assert!(
            (exact - expected).abs() < 1e-6,
            "{follows}: {exact} {expected}"
        );
        let linear = found.linear.expect("a linear prediction");
        assert!(
            (linear - expected).abs() < 1e-9,
            "{follows}: {linear} {expected}"
        );
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
            critical_load_factor(&problem, &pattern, StabilityOf::ShapeAndEnd, &settings(3.0))
                .unwrap();
        // Absolute angles: [[2 - F - p, F - 1], [-1, 1 - p]] has the determinant p^2 - (3 - F) p + 1.
        let half: f64 = 0.5 * (3.0 - stays);
        let expected = (half >= 1.0).then(|| half - (half * half - 1.0).sqrt());
        let exact = found.exact.map(|e| e.factor);
        let linear = found.linear;
        assert_eq!(
            exact.is_some(),
            expected.is_some(),
            "{stays}: {exact:?} {expected:?}"
        );
        assert_eq!(
            linear.is_some(),
            expected.is_some(),
            "{stays}: {linear:?} {expected:?}"
        );
        if let (Some(exact), Some(linear), Some(expected)) = (exact, linear, expected) {
            assert!(
                (exact - expected).abs() < 1e-6,
                "{stays}: {exact} {expected}"
            );
            assert!(
                (linear - expected).abs() < 1e-9,
                "{stays}: {linear} {expected}"
            );
        }
        assert!(!found.conservative);
    }
}

/// A machine of that chain alone, pressed by a follower at its tip.
fn machine_of(chain: &Chain, follower: f64) -> Mechanism {
    let home = Pose::translation(2.0, 0.0, 0.0);
    let mut builder = Mechanism::builder("column");
    let tool = builder.platform(Platform::new("tool", home));
    let press = Wrench::new(vector![-follower, 0.0, 0.0], Vector3::zeros());
    builder
        .limb(Limb::between("column", 0, tool, chain.clone()))
        .load("column", Load::follower(chain.tip(), press))
        .build()
        .unwrap()
}

/// Stiffness of the straight column in the angles of its joints, under a follower and a dead force.
fn straight_stiffness(springs: [f64; 2], follower: f64, dead: f64) -> Matrix2<f64> {
    Matrix2::from_diagonal(&Vector2::from(springs)) + Matrix2::new(0.0, follower, 0.0, 0.0)
        - Matrix2::new(2.0, 1.0, 1.0, 1.0) * dead
}

/// Stays, and may swing; `None` at a boundary.
fn by_hand(t: &Matrix2<f64>) -> Option<(bool, bool)> {
    let own = (0.5 * (t + t.transpose())).symmetric_eigenvalues();
    let lost = t.determinant() < 0.0 || own.max() < 0.0;
    let clear = t.determinant().abs() > 1e-3 && own.iter().all(|x| x.abs() > 1e-3);
    clear.then_some((!lost, !lost && own.min() < 0.0))
}

/// A column that is lost whatever its masses are (the determinant negative, or the symmetric part of the
/// stiffness negative in every motion) is reported so by every way of asking, and as swinging by none.
#[test]
fn every_way_of_asking_says_the_same_of_a_column_under_a_follower() {
    let (mut seen, mut expected) = ([0; 4], [0; 2]);
    let (mut few, mut some) = (SpreadSettings::default(), SearchSettings::default());
    (few.starts, few.fruitless) = (10, 5);
    (some.starts, some.fruitless) = (20, 10);
    for springs in [[1.0, 1.0], [1.0, 0.4], [0.5, 2.0]] {
        let chain = ziegler(springs[0], springs[1]);
        for follower in [0.3, 1.0, 1.7, 2.6, 3.5] {
            let machine = machine_of(&chain, follower);
            let home = machine.platforms()[machine.tool()].home;
            let posture = machine.posture(&home).unwrap();
            let press = Wrench::new(vector![-1.0, 0.0, 0.0], Vector3::zeros());
            let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
            problem
                .loads
                .push(Load::follower(chain.tip(), Wrench(press.0 * follower)));
            let start = solve_chain(&problem, &Settings::default()).unwrap();
            let grows = Parameter::end_wrench(press);
            let mut along = settings(4.0);
            along.branches = 1;
            let curves = follow(&problem, &grows, &start, 0.0, &along).unwrap();
            let straight = |x: &[f64]| x.iter().all(|x| x.abs() < 1e-7);
            for p in &curves.branches[0].points {
                if !straight(&p.equilibrium.coordinates) {
                    continue;
                }
                let t = straight_stiffness(springs, follower, p.parameter);
                let Some(awaited) = by_hand(&t) else { continue };
                let case = format!("{springs:?}, {follower}, {}", p.parameter);
                let reported = (p.dead_load.stable, p.dead_load.may_flutter());
                assert_eq!(reported, awaited, "curve, {case}");
                let both = t.determinant() > 0.0;
                seen[match awaited {
                    (true, swings) => usize::from(swings),
                    (false, _) => 2 + usize::from(both),
                }] += 1;
            }
            for dead in [0.0, 0.3, 0.7, 1.1, 1.5, 2.5] {
                let t = straight_stiffness(springs, follower, dead);
                let Some(awaited) = by_hand(&t) else { continue };
                let case = format!("{springs:?}, {follower}, {dead}");
                let push = Wrench(press.0 * dead);
                let loaded = posture.deflected_by(&push).unwrap();
                if straight(&loaded.limbs[0].coordinates) {
                    let reported = (loaded.stable(), loaded.may_flutter());
                    assert_eq!(reported, awaited, "deflected, {case}");
                }
                let free = EndCondition::wrench(push);
                let all = posture.equilibria(&free, &few).unwrap();
                let all = all.found.iter();
                let own = |limbs: &[kinetostat::machine::LimbEquilibrium]| {
                    straight(&limbs[0].coordinates)
                };
                for f in all.filter(|f| own(&f.equilibrium.limbs)) {
                    expected[0] += 1;
                    let reported = (f.stable, f.may_flutter);
                    assert_eq!(reported, awaited, "equilibria of the machine, {case}");
                }
                let mut one = problem.clone();
                one.end = free;
                let bounds = Bounds::of(&chain);
                let all = equilibria(&one, &bounds, &some).unwrap();
                let all = all.found.iter();
                for f in all.filter(|f| straight(&f.equilibrium.coordinates)) {
                    expected[1] += 1;
                    let reported = (f.stable, f.may_flutter);
                    assert_eq!(reported, awaited, "equilibria of the chain, {case}");
                }
            }
        }
    }
    assert!(seen.iter().all(|n| *n > 20), "{seen:?}");
    assert!(expected.iter().all(|n| *n > 40), "{expected:?}");
}
