//! Craig-Bampton reduction: the stiffness of the statics, frequencies from above, bounds that hold.

use crate::common::*;
use kinetostat::model::LinkMass;
use kinetostat::*;
use kinetostat_dynamics::{Held, LinearDynamics};
use nalgebra::{Matrix3, Vector3, vector};

#[test]
fn more_modes_come_from_above_and_bounds_hold() {
    let mass = LinkMass::of_section(&section(), DENSITY);
    let link = |length| {
        LinkSpec::beam(section(), length)
            .segments(3)
            .with_mass(mass)
    };
    let chain = Chain::builder("limb")
        .link_with("one", &link(0.7))
        .spring("knee", MotionKind::Revolute, Vector3::z(), 5e3, 0.6)
        .link_with("two", &link(0.5))
        .body(
            "head",
            3.0,
            vector![0.02, 0.0, 0.05],
            Matrix3::identity() * 0.01,
        )
        .build()
        .unwrap();
    let force = Wrench::new(vector![-300.0, 200.0, 150.0], Vector3::zeros());
    let mut problem = ChainProblem::new(&chain, EndCondition::wrench(force));
    problem.posture[18] = 0.6;
    problem.loads.push(Load::gravity(down()));
    let at = solve_chain(&problem, &Settings::default()).unwrap();
    let d =
        LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing()).unwrap();
    let exact = d.modes().unwrap().frequencies_hz();
    let mut last = f64::INFINITY;
    for kept in [0, 2, 4, 8, 16, 100] {
        let reduced = d.reduced(d.tool(), kept).unwrap();
        let k = &reduced.stiffness;
        let k_c = &at.stiffness.cartesian.matrix;
        for i in 0..6 {
            for j in 0..6 {
                let unit = (k_c[(i, i)] * k_c[(j, j)]).sqrt();
                assert!((k[(i, j)] - k_c[(i, j)]).abs() < 1e-9 * unit);
            }
            for j in 6..k.nrows() {
                assert!(k[(i, j)].abs() < 1e-7 * (k_c[(i, i)] * k[(j, j)]).sqrt());
            }
        }
        let found = reduced.frequencies(&d).unwrap();
        let off = found[0].hz / exact[0] - 1.0;
        println!(
            "{kept}: {off:e} bound {:e}, third {:e}",
            found[0].relative_bound,
            found[2].hz / exact[2] - 1.0
        );
        assert!(
            off > -1e-11 && off < last + 1e-11,
            "from above, and nearer with more modes"
        );
        last = off;
        for (own, exact) in found.iter().zip(&exact).take(3) {
            assert!(own.hz / exact - 1.0 < own.relative_bound + 1e-10);
        }
    }
    assert!(last.abs() < 1e-10);
}
