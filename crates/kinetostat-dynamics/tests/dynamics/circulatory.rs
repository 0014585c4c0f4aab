//! Loads without a potential: Beck's column, and dead moments on coarse links.

use crate::common::*;
use kinetostat::model::LinkMass;
use kinetostat::*;
use kinetostat_dynamics::{Held, LinearDynamics, Verdict};
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
