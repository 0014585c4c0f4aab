//! Machines whose limbs have several shapes each: held, under a load, and along a curve. Against scans of single chains, and
//! an exhaustive search in absolute angles (Newton on the Lagrangian from random starts, by hand).

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

use kinetostat::{
    CurveSettings, EndCondition, Parameter, Pose, PostureRequest, Twist,
    equilibrium::SpreadSettings,
};
use nalgebra::Vector3;

use crate::fuzz_short::fuzz::shapes::{ThreeLinks, check, machine_of};

/// Pressed by 200 mm and, across, hardly stretched: two Z chains [R 5.5.1].
fn two_z_chains(pressed: f64) -> [ThreeLinks; 2] {
    let home = (5.0 + 4.0 * FRAC_PI_6.cos()).sqrt();
    [(home - pressed, 0.0), (home.hypot(pressed), FRAC_PI_2)].map(|(span, direction)| ThreeLinks {
        links: [1.0; 3],
        stiffness: [1.0; 2],
        rest: [-FRAC_PI_6, FRAC_PI_6],
        span,
        direction,
    })
}

#[test]
fn two_z_chains_have_the_product_of_their_shapes() {
    assert_eq!(check(&two_z_chains(0.2)), Some(8));
}

/// A Z chain leans over at 110.93 mm, its neighbour keeps its shape: a curve has three shapes beyond, as the search.
#[test]
fn curves_branch_inside_limbs_where_the_search_has_shapes() {
    let chains = two_z_chains(0.0);
    let (machine, mut joints) = machine_of(&chains);
    let lean = FRAC_PI_6.sin().atan2(2.0 + FRAC_PI_6.cos());
    for (limb, chain) in joints.iter_mut().zip(&chains) {
        let first = chain.direction + lean;
        limb.coordinates = vec![first, -FRAC_PI_6, FRAC_PI_6, -first];
    }
    let at = Pose::identity();
    let posture = machine.posture(PostureRequest::joints(&at, joints));
    let posture = posture.unwrap();
    let push = Parameter::Displacement(Twist::new(-Vector3::x(), Vector3::zeros()));
    let hold = EndCondition::pose(at);
    let settings = CurveSettings::within(0.0, 0.25).with_branches(4);
    let curves = posture.curves(&push, &hold, &settings).unwrap();
    assert_eq!(curves.branches.len(), 2);
    let on_curve = curves.at(0.2).unwrap();
    assert_eq!(on_curve.len(), 3);
    let there = EndCondition::pose(Pose::translation(-0.2, 0.0, 0.0));
    let all = posture.equilibria(&there, &SpreadSettings::default());
    let all = all.unwrap();
    assert_eq!((all.found.len(), all.stable_count()), (8, 2));
    for p in &on_curve {
        let energy = p.equilibrium.energy.expect("a potential");
        let same = (all.found.iter()).filter(|f| (f.energy() - energy).abs() < 1e-9);
        let stable: Vec<bool> = same.map(|f| f.stable).collect();
        assert!(stable.contains(&p.displacement_control.stable), "{energy}");
    }
    let holding = on_curve.iter().filter(|p| p.displacement_control.stable);
    assert_eq!(holding.count(), 2);
}
