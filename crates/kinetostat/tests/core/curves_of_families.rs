//! Round columns in space buckle in every direction alike: one family of shapes, one branch.

use crate::common::close;
use crate::curves_and_bifurcations::solved;
use crate::curves_of_columns::press;
use crate::fuzz_short::fuzz::rod::slender;
use kinetostat::{
    BeamSection, Chain, ChainProblem, CurveSettings, EndCondition, LinkSpec, MotionKind, Parameter,
    Pose, Prescribed, Twist, Wrench,
    continuation::{BranchEnd, Curves, SpecialKind},
    equilibria,
    equilibrium::{Bounds, SearchSettings},
    follow,
};
use kinetostat_testing::least;
use nalgebra::{Vector3, vector};

const EULER: f64 = std::f64::consts::PI * std::f64::consts::PI;

/// Slender, so that shortening and shear play no part: E I = 1, length 1.
fn round() -> BeamSection {
    BeamSection {
        youngs_modulus: 1.0,
        shear_modulus: 1.0 / 2.6,
        area: 4e4,
        second_moment_y: 1.0,
        second_moment_z: 1.0,
        torsion_constant: 2.0,
    }
}

fn clamped_rod() -> Chain {
    Chain::builder("round rod")
        .link_with("rod", &LinkSpec::beam(round(), 1.0).segments(8))
        .build()
        .unwrap()
}

fn points(c: &Curves<'_>) -> usize {
    c.branches.iter().map(|b| b.points.len()).sum()
}

#[test]
fn a_round_clamped_rod_buckles_into_one_family() {
    let chain = clamped_rod();
    let mut end = EndCondition::pose(Pose::translation(1.0, 0.0, 0.0));
    end.prescribed = [Prescribed::Wrench; 6];
    let problem = ChainProblem::new(&chain, end);
    let mut settings = CurveSettings::within(0.0, 1.5 * EULER);
    settings.branches = 12;
    settings.largest_change = Some(EULER / 40.0);
    let pushed = Parameter::end_wrench(press());
    let c = follow(&problem, &pushed, &solved(&problem), 0.0, &settings).unwrap();
    assert_eq!(c.specials.len(), 1, "the fork alone");
    let fork = &c.specials[0];
    assert_eq!(fork.kind, SpecialKind::Multiple { modes: 2 });
    let critical = 0.25 * EULER;
    close(
        "critical load",
        fork.point.parameter,
        critical,
        1e-3 * critical,
    );
    assert_eq!(
        c.branches.len(),
        2,
        "the straight rod and one pair of shapes"
    );
    let buckled = &c.branches[1];
    assert_eq!(buckled.ends, [BranchEnd::Range; 2]);
    for p in buckled
        .points
        .iter()
        .filter(|p| p.parameter > 1.001 * critical)
    {
        assert!(p.in_family());
        assert!(
            p.dead_load.stable && p.displacement_control.stable,
            "at {}",
            p.parameter
        );
        assert_eq!(p.unstable_modes(), [0, 0], "at {}", p.parameter);
        assert_eq!(p.dead_load.neutral, ["the whole shape"]);
        assert_eq!(p.dead_load.inertia.zero, 1);
    }
    // Elastica under a dead load, the tip turned by 60 deg: P / P_E = (2 K(k) / pi)^2, k = sin 30 deg.
    let turned = |p: &kinetostat::continuation::CurvePoint| p.equilibrium.tip.rotation.angle();
    let elastica = (2.0 * 1.685_750_354_812_596 / std::f64::consts::PI).powi(2) * critical;
    let there = c.at(elastica).unwrap();
    let bent: Vec<_> = there.iter().filter(|p| turned(p) > 0.1).collect();
    assert_eq!(bent.len(), 2, "one pair");
    for p in bent {
        let turn = turned(p).to_degrees();
        close("elastica", turn, 60.0, 0.6);
        assert!(p.dead_load.stable && p.displacement_control.stable);
    }
    assert!(points(&c) < 400, "{} points", points(&c));
}

#[test]
fn a_round_rod_pushed_along_its_axis_stays_on_few_branches() {
    let chain = clamped_rod();
    let end = EndCondition::pose(Pose::translation(1.0, 0.0, 0.0));
    let problem = ChainProblem::new(&chain, end);
    let mut settings = CurveSettings::within(0.0, 0.1);
    settings.branches = 12;
    settings.conjugate_range = (-6.0 * EULER, 6.0 * EULER);
    let along = Twist::new(vector![-1.0, 0.0, 0.0], Vector3::zeros());
    let parameter = Parameter::Displacement(along);
    let c = follow(&problem, &parameter, &solved(&problem), 0.0, &settings).unwrap();
    let forks: Vec<_> = c
        .specials
        .iter()
        .filter(|s| s.kind.is_bifurcation())
        .collect();
    close(
        "critical load",
        forks[0].point.conjugate.abs(),
        4.0 * EULER,
        4e-2 * EULER,
    );
    assert!(c.branches.len() <= 3 && points(&c) < 1000);
    let buckled = &c.branches[1];
    assert!(buckled.points.iter().filter(|p| p.in_family()).count() + 2 > buckled.points.len());
    let near = buckled.points.iter().filter(|p| p.in_family());
    for p in near {
        assert!(
            p.displacement_control.stable && p.unstable_modes()[0] == 0,
            "at {}",
            p.parameter
        );
        assert!(p.equilibrium.stability.stable, "at {}", p.parameter);
    }
}

#[test]
fn a_hinge_that_nothing_holds_does_not_keep_a_curve_from_ending() {
    let z = Vector3::z();
    let chain = Chain::builder("pinned column")
        .passive("a", MotionKind::Revolute, z, 0.0)
        .link_with("rod", &LinkSpec::beam(round(), 1.0).segments(8))
        .passive("b", MotionKind::Revolute, z, 0.0)
        .build()
        .unwrap();
    let mut end = EndCondition::pose(Pose::translation(1.0, 0.0, 0.0));
    for k in [0, 5] {
        end.prescribed[k] = Prescribed::Wrench;
    }
    let problem = ChainProblem::new(&chain, end);
    let mut settings = CurveSettings::within(0.0, 3.0 * EULER);
    settings.branches = 12;
    for pull in [-1.0, 1.0] {
        let parameter = Parameter::end_wrench(press() * pull);
        let c = follow(&problem, &parameter, &solved(&problem), 0.0, &settings).unwrap();
        assert!(points(&c) < 1000);
        if pull < 0.0 {
            assert_eq!(
                (c.branches.len(), c.specials.len()),
                (1, 0),
                "no fork in tension"
            );
        } else {
            close("Euler", c.specials[0].point.parameter, EULER, 1e-3 * EULER);
        }
    }
}

/// Complete elliptic integrals `K(k)` and `E(k)` by the arithmetic-geometric mean.
fn elliptic(k: f64) -> (f64, f64) {
    let (mut a, mut b, mut c) = (1.0_f64, (1.0 - k * k).sqrt(), k);
    let (mut sum, mut power) = (0.5 * c * c, 1.0);
    for _ in 0..12 {
        (a, b, c) = (0.5 * (a + b), (a * b).sqrt(), 0.5 * (a - b));
        sum += power * c * c;
        power *= 2.0;
    }
    let first = std::f64::consts::FRAC_PI_2 / a;
    (first, first * (1.0 - sum))
}

/// How far the tip of a clamped elastica of unit length and stiffness has come down under a dead load.
pub fn came_down(load: f64) -> f64 {
    let (mut low, mut high) = (0.0, 0.999_f64);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        match elliptic(middle).0 < load.sqrt() {
            true => low = middle,
            false => high = middle,
        }
    }
    let (first, second) = elliptic(low);
    2.0 * (1.0 - second / first)
}

/// One family of shapes, however stiff the axis is.
#[test]
fn a_round_rod_that_hardly_stretches_buckles_into_one_family() {
    assert!((came_down(3.0) - 0.3466).abs() < 1e-3);
    for (segments, coarse) in [(4, 0.03), (8, 0.01)] {
        for axial in [1e4, 1e7, 1e8, 1e9, 1e10] {
            let case = format!("{segments} segments, EA {axial:e}");
            let link = LinkSpec::beam(slender(axial), 1.0).segments(segments);
            let chain = Chain::builder("rod").link_with("rod", &link);
            let chain = chain.build().unwrap();
            let end = EndCondition::wrench(Wrench::zero());
            let problem = ChainProblem::new(&chain, end);
            let mut settings = CurveSettings::within(0.0, 3.0);
            settings.branches = 12;
            let pushed = Parameter::end_wrench(press());
            let c = follow(&problem, &pushed, &solved(&problem), 0.0, &settings).unwrap();
            assert_eq!(c.specials.len(), 1, "{case}: the fork alone");
            let fork = &c.specials[0];
            assert_eq!(fork.kind, SpecialKind::Multiple { modes: 2 }, "{case}");
            assert!(!fork.lost_branch, "{case}");
            assert_eq!(c.branches.len(), 2, "{case}");
            assert!(points(&c) < 200, "{case}: {}", points(&c));
            let buckled = &c.branches[1];
            assert_eq!(buckled.ends, [BranchEnd::Range; 2], "{case}");
            for p in buckled.points.iter().filter(|p| p.parameter > 2.5) {
                assert!(p.in_family(), "{case}");
                assert!(
                    p.dead_load.stable && p.displacement_control.stable,
                    "{case} at {}",
                    p.parameter
                );
                let down = 1.0 - p.equilibrium.tip.translation.x;
                let expected = came_down(p.parameter);
                assert!(
                    (down / expected - 1.0).abs() < 3.0 * coarse,
                    "{case}: {down} {expected}"
                );
            }
        }
    }
}

/// All shapes of the same rod: straight, and bent in any direction.
#[test]
fn a_round_rod_that_hardly_stretches_has_two_shapes() {
    for segments in [3, 4, 6] {
        for axial in [1e4, 1e7, 1e9, 1e11] {
            let case = format!("{segments} segments, EA {axial:e}");
            let link = LinkSpec::beam(slender(axial), 1.0).segments(segments);
            let chain = Chain::builder("rod").link_with("rod", &link);
            let chain = chain.build().unwrap();
            let load = Wrench::new(vector![-3.0, 0.0, 0.0], Vector3::zeros());
            let problem = ChainProblem::new(&chain, EndCondition::wrench(load));
            let bounds = Bounds::of(&chain);
            let all = equilibria(&problem, &bounds, &SearchSettings::default()).unwrap();
            assert_eq!(all.found.len(), 2, "{case}");
            assert!(all.exhausted && all.hits > 20, "{case}");
            let [bent, straight] = [0, 1].map(|i| &all.found[i]);
            assert!(bent.stable && bent.singular, "{case}");
            assert!(!straight.stable && !straight.singular, "{case}");
            let down = 1.0 - bent.equilibrium.tip.translation.x;
            assert!((down / came_down(3.0) - 1.0).abs() < 0.06, "{case}: {down}");
            // The stiffness of the bent shape is known to be finite but for its turn.
            let free = bent.equilibrium.stiffness.directions.iter();
            let soft = least(free.map(|d| d.stiffness_n_per_m));
            assert!(soft.abs() < 1e-4, "{case}: {soft}");
        }
    }
}
