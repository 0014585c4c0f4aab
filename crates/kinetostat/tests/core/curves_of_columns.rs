//! Straight columns: where they fork, in which mode, and that none buckles in tension.

use crate::common::{close, planar_column};
use crate::curves_and_bifurcations::{assert_curves, held, of_kind, solved};
use kinetostat::{
    BeamSection, Chain, ChainProblem, CurveSettings, EndCondition, LinkSpec, MotionKind, Parameter,
    Pose, Prescribed, Wrench,
    continuation::{LoadPattern, SpecialKind},
    critical_load_factor,
    equilibrium::StabilityOf,
    follow,
};
use kinetostat_testing::{largest, largest_size};
use nalgebra::{Vector3, vector};

/// End on its line under a dead force along x, free to turn.
pub fn pressed(chain: &Chain, length: f64) -> ChainProblem<'_> {
    let mut problem = held(chain, length);
    problem.end.prescribed[0] = Prescribed::Wrench;
    problem
}

pub fn press() -> Wrench {
    Wrench::new(vector![-1.0, 0.0, 0.0], Vector3::zeros())
}

/// `2 (1 - cos(k pi / n))`, k = 1 .. n - 1, in spring stiffness per length of a link.
pub fn fork_loads(n: usize) -> Vec<f64> {
    let angle = |k: usize| k as f64 * std::f64::consts::PI / n as f64;
    (1..n).map(|k| 2.0 * (1.0 - angle(k).cos())).collect()
}

/// Loads of all pitchforks of a straight column up to a load.
pub fn forks(problem: &ChainProblem<'_>, up_to: f64) -> Vec<f64> {
    let pushed = Parameter::end_wrench(press());
    let settings = CurveSettings::within(0.0, up_to);
    let c = follow(problem, &pushed, &solved(problem), 0.0, &settings).unwrap();
    assert_curves(&c);
    let forks = of_kind(&c, SpecialKind::Pitchfork);
    forks.iter().map(|fork| fork.point.parameter).collect()
}

#[test]
fn straight_columns_fork_at_two_one_minus_cosine() {
    for n in 2..=6 {
        let (l, k) = (0.4, 50.0);
        let chain = planar_column(n, l, k);
        let problem = pressed(&chain, n as f64 * l);
        let loads: Vec<f64> = fork_loads(n).iter().map(|p| p * k / l).collect();
        let forks = forks(&problem, 5.0 * k / l);
        assert_eq!(forks.len(), n - 1, "{n} links");
        for (fork, load) in forks.iter().zip(&loads) {
            close(&format!("{n} links"), *fork, *load, 1e-9 * load);
        }
        let pattern = LoadPattern {
            end: press(),
            loads: vec![],
        };
        for stability_of in [StabilityOf::Shape, StabilityOf::ShapeAndEnd] {
            let label = format!("{n} links, {stability_of:?}");
            let limit = CurveSettings::within(0.0, f64::INFINITY);
            let critical = critical_load_factor(&problem, &pattern, stability_of, &limit).unwrap();
            close(&label, critical.linear.unwrap(), loads[0], 1e-9 * loads[0]);
            let exact = critical.exact.unwrap();
            close(&label, exact.factor, loads[0], 1e-9 * loads[0]);
            // Mode: joint i deflects by sin(i pi / n).
            let middle =
                largest((1..n).map(|i| (i as f64 * std::f64::consts::PI / n as f64).sin()));
            let own = &exact.mode[1..n];
            let most = largest_size(own.iter().copied());
            for mode in [&exact.mode, &critical.linear_mode] {
                let scale = largest_size(mode[1..n].iter().copied());
                for i in 1..n {
                    let s = (i as f64 * std::f64::consts::PI / n as f64).sin() / middle;
                    close(&label, mode[i].abs() / scale, s, 1e-6);
                }
            }
            assert!(most > 0.1);
        }
    }
}

#[test]
fn a_pulled_column_never_buckles() {
    let chain = planar_column(4, 1.0, 1.0);
    let problem = pressed(&chain, 4.0);
    let pattern = LoadPattern {
        end: press() * -1.0,
        loads: vec![],
    };
    let limit = CurveSettings::within(0.0, 50.0);
    let c = critical_load_factor(&problem, &pattern, StabilityOf::ShapeAndEnd, &limit).unwrap();
    assert!(c.linear.is_none() && c.exact.is_none());
    close("reached", c.reached, 50.0, 1e-9);
}

/// A column of universal joints buckles in two planes at once.
#[test]
fn a_column_in_space_has_two_modes_at_once() {
    let (y, z) = (Vector3::y(), Vector3::z());
    let mut b = Chain::builder("column in space").passive_universal("foot", y, z);
    for i in 1..3 {
        b = b.translation(vector![1.0, 0.0, 0.0]);
        b = b
            .spring(&format!("y{i}"), MotionKind::Revolute, y, 1.0, 0.0)
            .spring(&format!("z{i}"), MotionKind::Revolute, z, 1.0, 0.0);
    }
    let chain = b.translation(vector![1.0, 0.0, 0.0]).build().unwrap();
    let mut end = EndCondition::pose(Pose::translation(3.0, 0.0, 0.0));
    for k in [0, 3, 4, 5] {
        end.prescribed[k] = Prescribed::Wrench;
    }
    let problem = ChainProblem::new(&chain, end);
    let mut settings = CurveSettings::within(0.0, 1.8);
    settings.branches = 3;
    let parameter = Parameter::end_wrench(press());
    let c = follow(&problem, &parameter, &solved(&problem), 0.0, &settings).unwrap();
    let fork = &c.specials[0];
    assert_eq!(fork.kind, SpecialKind::Multiple { modes: 2 });
    close("load", fork.point.parameter, 1.0, 1e-8);
    assert!(c.branches.len() > 1, "buckled shapes are followed");
    let buckled = c.branches[1].points.last().unwrap();
    assert!(buckled.parameter > 1.05 && buckled.conjugate > 0.1);
    let pattern = LoadPattern {
        end: press(),
        loads: vec![],
    };
    let r = critical_load_factor(
        &problem,
        &pattern,
        StabilityOf::ShapeAndEnd,
        &CurveSettings::within(0.0, 9.0),
    );
    close("critical", r.unwrap().exact.unwrap().factor, 1.0, 1e-8);
}

/// Euler columns of the default link, in the plane of least stiffness: critical loads within 0.1 % at 8
/// segments, linear and on the path, and never unstable in tension.
#[test]
fn euler_columns_have_their_critical_loads() {
    let section = BeamSection {
        youngs_modulus: 1.0,
        shear_modulus: 0.5,
        area: 1e5,
        second_moment_y: 1.0,
        second_moment_z: 2.0,
        torsion_constant: 1.0,
    };
    let euler = std::f64::consts::PI.powi(2);
    // Smallest root of tan x = x.
    let tangent = 4.493_409_457_909_064_f64.powi(2) / euler;
    // Foot hinged; head: held sideways, held against rotation.
    for (name, hinged, sideways, turning, expected) in [
        ("pinned", true, true, false, 1.0),
        ("clamped-free", false, false, false, 0.25),
        ("clamped-clamped", false, true, true, 4.0),
        ("clamped-pinned", false, true, false, tangent),
    ] {
        let mut b = Chain::builder(name);
        if hinged {
            b = b.passive("q", MotionKind::Revolute, Vector3::y(), 0.0);
        }
        let chain = b
            .link_with("link", &LinkSpec::beam(section, 1.0).segments(8))
            .build()
            .unwrap();
        let mut end = EndCondition::pose(Pose::translation(1.0, 0.0, 0.0));
        end.prescribed = [Prescribed::Wrench; 6];
        for k in [1, 2, 3, 5] {
            if sideways {
                end.prescribed[k] = Prescribed::Pose;
            }
        }
        if turning {
            end.prescribed[4] = Prescribed::Pose;
        }
        let problem = ChainProblem::new(&chain, end);
        let settings = CurveSettings::within(0.0, 10.0 * euler);
        let critical = |force: f64| {
            let pattern = LoadPattern {
                end: press() * force,
                loads: vec![],
            };
            critical_load_factor(&problem, &pattern, StabilityOf::ShapeAndEnd, &settings).unwrap()
        };
        let pressed = critical(1.0);
        let exact = pressed.exact.unwrap();
        close(name, exact.factor / euler, expected, 1e-3 * expected);
        close(
            name,
            pressed.linear.unwrap() / euler,
            expected,
            1e-3 * expected,
        );
        assert_eq!(exact.kind, Some(SpecialKind::Pitchfork), "{name}");
        let pulled = critical(-1.0);
        assert!(pulled.exact.is_none() && pulled.linear.is_none(), "{name}");
    }
}
