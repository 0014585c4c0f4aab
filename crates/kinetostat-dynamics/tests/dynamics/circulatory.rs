//! Loads without a potential: Beck's column, and dead moments on coarse links.

use crate::common::*;
use kinetostat::model::LinkMass;
use kinetostat::*;
use kinetostat_dynamics::{Damping, Held, LinearDynamics, Verdict};
use nalgebra::{Vector3, vector};

/// Section with equal bending stiffnesses, torsion stiff, stretched stiff.
fn shaft(segments: usize) -> Chain {
    let mut own = section();
    own.second_moment_y = own.second_moment_z;
    let mass = LinkMass::of_section(&own, DENSITY).thin();
    own.area *= 1e5;
    own.torsion_constant *= 1e3;
    let spec = LinkSpec::beam(own, 1.0).segments(segments).with_mass(mass);
    Chain::builder("shaft")
        .link_with("shaft", &spec)
        .build()
        .unwrap()
}

#[test]
fn dead_end_moments_flutter_from_two_segments_on() {
    let w0: f64 = 196.425997;
    // The continuum. Links bend by the rotation vector of their turns, so that two segments are near it already; the table
    // of the reference values is that of turns one after the other, whose imaginary part is a third off there.
    for (moment, segments, re, im, most) in [
        (0.05, 2, 0.9999370, 0.0153270, 2e-3),
        (0.05, 4, 0.9999370, 0.0153270, 2e-4),
        (0.05, 8, 0.9999370, 0.0153270, 2e-5),
        (0.5, 2, 0.9936878, 0.1534009, 1e-2),
        (0.5, 4, 0.9936878, 0.1534009, 2e-3),
        (0.5, 8, 0.9936878, 0.1534009, 5e-4),
    ] {
        let chain = shaft(segments);
        let twist = Wrench::new(Vector3::zeros(), vector![moment * 14700.0, 0.0, 0.0]);
        let problem = ChainProblem::new(&chain, EndCondition::wrench(twist));
        let at = solve_chain(&problem, &Settings::default()).unwrap();
        let d = LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing())
            .unwrap();
        assert!(d.is_circulatory());
        let found = d.complex_modes(None, 2).unwrap();
        let squared = found.modes[0].squared() / (w0 * w0);
        println!(
            "{segments} {moment}: {squared} {:?} {}",
            found.verdict, found.complexity
        );
        let apart = (squared.re - re).hypot(squared.im.abs() - im);
        assert!(apart < most, "{squared}");
        assert_eq!(found.verdict, Verdict::Flutter);
    }
    let chain = shaft(1);
    let twist = Wrench::new(Vector3::zeros(), vector![0.5 * 14700.0, 0.0, 0.0]);
    let problem = ChainProblem::new(&chain, EndCondition::wrench(twist));
    let at = solve_chain(&problem, &Settings::default()).unwrap();
    let d =
        LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing()).unwrap();
    let found = d.complex_modes(None, 2).unwrap();
    assert_eq!(
        found.verdict,
        Verdict::NotJudged {
            links: vec!["shaft".to_owned()]
        }
    );
}

#[test]
fn becks_column_flutters() {
    for (segments, expected) in [(2, 20.192), (4, 20.098), (8, 20.054)] {
        let chain = Chain::builder("column")
            .link_with("column", &thin_link(1.0, segments, 1e5))
            .build()
            .unwrap();
        let flutters = |load: f64| {
            let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
            let push = Wrench::new(vector![-load * 14700.0, 0.0, 0.0], Vector3::zeros());
            problem.loads.push(Load::follower(chain.tip(), push));
            let mut x = vec![0.0; chain.coordinate_count()];
            for k in 0..segments {
                x[6 * k] = -load * 14700.0 / segments as f64 / (2.1e11 * 60.0);
            }
            let d =
                LinearDynamics::of_chain(&problem, &x, &Wrench::zero(), &Held::nothing()).unwrap();
            // The plane of the stiffer bending: of all complex pairs the one that moves along y.
            let found = d.complex_modes(None, 12).unwrap();
            let tip = d.motions(d.tool()).map(|v| nalgebra::Complex::new(v, 0.0));
            found.modes.iter().any(|m| {
                let t = &tip * &m.right;
                t[1].norm() > 10.0 * t[2].norm() && m.squared().im.abs() > 1e-5 * m.squared().norm()
            })
        };
        let (mut low, mut high) = (19.0, 21.0);
        assert!(!flutters(low) && flutters(high));
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            if flutters(middle) {
                high = middle
            } else {
                low = middle
            }
        }
        println!("{segments}: {low}");
        assert!((low - expected).abs() < 2e-3, "{low}");
    }
}

/// A column that bends alike in both planes has each pair twice: damping by ratios sees both. Figures by Euler and Bernoulli's
/// beam in 40 Hermite elements with `C = M V diag(2 zeta |lambda|) V^-1` (numpy).
#[test]
fn ratios_damp_the_pairs_of_both_planes_alike() {
    let chain = shaft(8);
    for (load, expected) in [
        (5.0, [(37.499_007, -2.356_250), (181.691_482, -11.416_583)]),
        (12.0, [(50.438_489, -3.169_302), (157.697_749, -9.908_937)]),
    ] {
        let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        let push = Wrench::new(vector![-load * 14700.0, 0.0, 0.0], Vector3::zeros());
        problem.loads.push(Load::follower(chain.tip(), push));
        let mut x = vec![0.0; chain.coordinate_count()];
        for k in 0..8 {
            x[6 * k] = -load * 14700.0 / 8.0 / (2.1e11 * 60.0);
        }
        let d = LinearDynamics::of_chain(&problem, &x, &Wrench::zero(), &Held::nothing()).unwrap();
        let modes = d.modes().unwrap();
        let law = Damping::Ratio(0.01);
        let matrix = d.damping_matrix(&modes, &law).unwrap();
        let by_matrix = d.complex_modes(Some(&matrix), 4).unwrap();
        let by_pairs = d.complex_modes_damped(&modes, &law, 4).unwrap();
        for found in [by_matrix, by_pairs] {
            assert_eq!(found.verdict, Verdict::Stable);
            assert_eq!(found.modes.len(), 4);
            for (k, mode) in found.modes.iter().enumerate() {
                let (hz, growth) = expected[k / 2];
                // Eight segments are 1.5e-4 from the continuum in the second pair.
                assert!(relative(mode.frequency_hz(), hz).abs() < 2.5e-4, "{hz}");
                assert!(
                    relative(mode.eigenvalue.re, growth).abs() < 2.5e-4,
                    "{growth}"
                );
            }
            // Two of a frequency are two shapes: neither is a share of the other.
            let [a, b] = [&found.modes[0].right, &found.modes[1].right];
            let along = a.dotc(b).norm() / (a.norm() * b.norm());
            assert!(along < 0.99, "{along}");
        }
    }
}
