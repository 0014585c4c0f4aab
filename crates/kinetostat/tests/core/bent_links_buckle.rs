//! How far a bent link is from buckling, and whether it goes away, does not depend on how stiff its axis
//! is or how finely it is divided.

use std::f64::consts::{PI, TAU};

use kinetostat::{model::LinkConvention, *};
use nalgebra::{Vector3, vector};

use crate::fuzz_short::fuzz::rod::slender;

/// Of unit length and bending stiffness.
fn rod(segments: usize, axial: f64, convention: LinkConvention) -> Chain {
    let link = LinkSpec::beam(slender(axial), 1.0)
        .segments(segments)
        .convention(convention);
    Chain::builder("rod")
        .link_with("rod", &link)
        .build()
        .unwrap()
}

fn straight() -> Pose {
    Pose::new(vector![1.0, 0.0, 0.0], Vector3::zeros())
}

/// Shares of a chain and of a machine at the same equilibrium.
fn shares(chain: &Chain, force: [f64; 3], moment: [f64; 3]) -> [f64; 2] {
    let wrench = Wrench::new(Vector3::from(force), Vector3::from(moment));
    let problem = ChainProblem::new(chain, EndCondition::wrench(wrench));
    let alone = solve_chain(&problem, &Settings::default());
    let alone = alone.unwrap_or_else(|e| panic!("{force:?}, {moment:?}: {e}"));
    let machine = Mechanism::serial(chain.clone(), straight(), Vector3::zeros()).unwrap();
    let posture = machine.posture(&straight()).unwrap();
    let loaded = posture.deflected_by(&wrench).unwrap();
    [
        alone.stability.share_to_buckling,
        loaded.share_to_buckling(),
    ]
    .map(|s| s.expect("a share"))
}

/// Equal planes, few segments: eigenvalues in pairs.
#[test]
fn shares_of_a_short_round_column_are_known() {
    for axial in [1e4, 1e7, 1e8, 1e9, 1e11, 1e13] {
        for segments in [3, 4, 5, 6, 7, 12] {
            let chain = rod(segments, axial, LinkConvention::Bowing);
            for force in [0.5, 1.0, 2.0] {
                let column = force / (4.0 * PI * PI);
                let coarse = 0.001 + 0.2 / (segments * segments) as f64;
                for share in shares(&chain, [-force, 0.0, 0.0], [0.0; 3]) {
                    let off = (share / column - 1.0).abs();
                    assert!(off < coarse, "EA {axial:e}, {segments} segments: {share}");
                }
            }
        }
    }
}

/// A ring that is just closed turns about its fixed end for nothing: its share is one. A column that is
/// held at both ends buckles at `4 pi^2`.
#[test]
fn shares_of_a_ring_and_of_a_column_are_known() {
    for (convention, axial) in [
        (LinkConvention::Bowing, &[1e6, 1e7, 1e9, 1e11][..]),
        (LinkConvention::ConstantStrain, &[1e6, 1e7]),
    ] {
        for &axial in axial {
            for segments in [8, 32, 64] {
                let chain = rod(segments, axial, convention);
                let case = format!("{convention:?}, {segments} segments, EA {axial:e}");
                let column = 2.0 / (4.0 * PI * PI);
                for share in shares(&chain, [-2.0, 0.0, 0.0], [0.0; 3]) {
                    let coarse = 0.001 + 6.0 / (segments * segments) as f64;
                    assert!((share / column - 1.0).abs() < coarse, "{case}: {share}");
                }
                for share in shares(&chain, [0.0; 3], [0.0, TAU, 0.0]) {
                    assert!((share - 1.0).abs() < 1e-6, "{case}: {share}");
                }
            }
        }
    }
}

/// Across, bent far: the axis' stiffness and the division tell in the third digit at most.
#[test]
fn shares_of_bent_links_do_not_depend_on_the_axis() {
    for (force, moment) in [
        ([0.0, 1.2, 0.0], [0.0; 3]),
        ([0.3, 10.0, 4.0], [0.0; 3]),
        ([-1.0, 0.5, 0.2], [0.3, 0.0, 0.8]),
        ([0.0, -2.0, 30.0], [0.0, 1.0, 0.0]),
    ] {
        let fine = shares(&rod(64, 1e6, LinkConvention::Bowing), force, moment)[0];
        assert!(fine > 0.0 && fine < 0.6, "{force:?}: {fine}");
        for axial in [1e5, 1e8, 1e11] {
            for segments in [8_u32, 16, 48] {
                let coarse = 0.002 + 13.0 / f64::from(segments * segments);
                let chain = rod(segments as usize, axial, LinkConvention::Bowing);
                for share in shares(&chain, force, moment) {
                    assert!(
                        (share / fine - 1.0).abs() < coarse,
                        "{force:?}, {moment:?}, {segments} segments, EA {axial:e}: {share}, {fine}"
                    );
                }
            }
        }
    }
}

/// Under an end moment a rod has one equilibrium, an arc of a circle: nothing can diverge, although
/// the symmetric part of its tangent turns indefinite at half a circle.
#[test]
fn a_moment_at_the_end_makes_nothing_go_away() {
    let wrench = Wrench::new(Vector3::zeros(), vector![0.0, 0.0, 6.2]);
    // Short chains by dense matrices, long ones by sweeps.
    for (segments, axial) in [(6, 1e4), (24, 1e7)] {
        let chain = rod(segments, axial, LinkConvention::Bowing);
        let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        let settings = CurveSettings::within(0.0, 1.0);
        let start = solve_chain(&problem, &settings.solver).unwrap();
        let parameter = Parameter::end_wrench(wrench);
        let curves = follow(&problem, &parameter, &start, 0.0, &settings).unwrap();
        let points = &curves.branches[0].points;
        assert!(
            points
                .iter()
                .all(|p| p.dead_load.stable && p.displacement_control.stable)
        );
        assert!(curves.specials.is_empty(), "{segments} segments");
        let first = points.iter().find(|p| p.dead_load.may_flutter()).unwrap();
        assert!(
            (first.parameter * 6.2 - PI).abs() < 0.6,
            "{}",
            first.parameter
        );
        assert!(points[points.len() - 1].parameter > 0.999);
    }
}

/// A column that is pushed and twisted a little: the twist has no potential, and the column goes away at
/// Euler's load of its softer plane, at twice the modes at that of the other.
#[test]
fn a_column_that_is_pushed_and_twisted_goes_away_at_eulers_load() {
    for segments in [6, 24] {
        let section = BeamSection {
            youngs_modulus: 1.0,
            shear_modulus: 1.0,
            area: 1e5,
            second_moment_y: 1.0,
            second_moment_z: 1.4,
            torsion_constant: 0.8,
        };
        let link = LinkSpec::beam(section, 1.0).segments(segments);
        let chain = Chain::builder("rod")
            .link_with("rod", &link)
            .build()
            .unwrap();
        let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        let mut settings = CurveSettings::within(0.0, 4.0);
        settings.branches = 1;
        let start = solve_chain(&problem, &settings.solver).unwrap();
        let wrench = Wrench::new(vector![-1.0, 0.0, 0.0], vector![0.01, 0.0, 0.0]);
        let parameter = Parameter::end_wrench(wrench);
        let curves = follow(&problem, &parameter, &start, 0.0, &settings).unwrap();
        let euler = PI * PI / 4.0;
        let mut seen = [0; 3];
        for p in &curves.branches[0].points {
            let modes = p.dead_load.unstable_modes;
            let awaited = usize::from(p.parameter > euler) + usize::from(p.parameter > 1.4 * euler);
            let off = [euler, 1.4 * euler].map(|f| (p.parameter / f - 1.0).abs());
            if off.iter().all(|x| *x > 2e-3) {
                assert_eq!(modes, awaited, "{segments} segments at {}", p.parameter);
                assert_eq!(p.dead_load.stable, awaited == 0);
                seen[awaited] += 1;
            }
        }
        assert!(seen.iter().all(|n| *n > 2), "{segments} segments: {seen:?}");
    }
}

/// A machine's path says the same by the stiffness at its tool, whose determinant is that of the whole
/// while the limbs keep their shapes.
#[test]
fn paths_of_machines_go_away_where_the_determinant_says() {
    let mut swinging = 0;
    for (force, moment) in [
        ([0.0; 3], [0.0, 0.0, 3.1]),
        ([-1.0, 0.0, 0.0], [0.0, 0.0, 2.5]),
        ([-2.0, 0.0, 0.3], [0.0, 0.0, 2.0]),
        ([0.0; 3], [2.0, 0.0, 2.5]),
    ] {
        let chain = rod(8, 1e4, LinkConvention::Bowing);
        let machine = Mechanism::serial(chain, straight(), Vector3::zeros()).unwrap();
        let posture = machine.posture(&straight()).unwrap();
        let wrench = Wrench::new(Vector3::from(force), Vector3::from(moment));
        let free = EndCondition::wrench(Wrench::zero());
        let settings = CurveSettings::within(0.0, 1.0);
        let path = posture
            .curves(&Parameter::end_wrench(wrench), &free, &settings)
            .unwrap();
        for p in &path.branches[0].points {
            let k = &p.equilibrium.stiffness.matrix;
            let odd = k.determinant() < 0.0;
            assert_eq!(
                p.dead_load.stable, !odd,
                "{force:?}, {moment:?} at {}",
                p.parameter
            );
            swinging += usize::from(p.dead_load.may_flutter);
            println!(
                "{force:?} {moment:?} {} {} {}",
                p.parameter, p.dead_load.stable, p.dead_load.may_flutter
            );
        }
    }
    assert!(swinging > 5, "{swinging} points beyond the symmetric part");
}
