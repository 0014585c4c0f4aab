//! Machines whose limbs have several shapes each: held, under a load, and along a curve. Against scans of single chains, and
//! an exhaustive search in absolute angles (Newton on the Lagrangian from random starts, by hand).

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, PI};

use kinetostat::{
    CurveSettings, EndCondition, Parameter, Pose, PostureRequest, Twist, Wrench,
    equilibrium::SpreadSettings,
};
use nalgebra::{Vector3, vector};

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

/// Two minima with a maximum on either way between them, which hardly any start finds.
#[test]
fn maxima_between_two_minima_are_found() {
    let limb = ThreeLinks {
        links: [0.43324, 0.30651, 0.31551],
        stiffness: [0.40759, 1.77783],
        rest: [0.1942, 0.58557],
        span: 0.44943,
        direction: -0.8974,
    };
    assert_eq!(check(&[limb.clone(), limb]), Some(16));
}

/// Figure 5.2 of the report, its tool let go under a force: energies and how many shapes have them.
#[test]
fn a_loaded_machine_has_no_shape_twice() {
    let chains = [([1.0, 1.3], PI), ([0.8, 0.9], -2.0 * FRAC_PI_6)];
    let (machine, joints) = machine_of(&chains.map(|(stiffness, direction)| ThreeLinks {
        links: [0.5; 3],
        stiffness,
        rest: [0.0; 2],
        span: 1.35,
        direction,
    }));
    let at = Pose::identity();
    let posture = machine
        .posture(PostureRequest::joints(&at, joints))
        .unwrap();
    for (force, energies) in [
        (
            vector![0.0, -3.0, 0.0],
            &[
                (-0.687833679, 1),
                (4.195236564, 1),
                (4.287798124, 2),
                (6.267496170, 4),
                (6.421341982, 2),
                (6.803861706, 2),
            ][..],
        ),
        (
            vector![0.5, 0.5, 0.0],
            &[
                (-1.102892921, 1),
                (0.180825773, 1),
                (0.924243752, 4),
                (0.926739592, 2),
                (1.210616464, 2),
                (3.535855871, 4),
                (3.550405731, 2),
                (4.839747913, 2),
            ][..],
        ),
    ] {
        let load = EndCondition::wrench(Wrench::new(force, Vector3::zeros()));
        let all = posture.equilibria(&load, &SpreadSettings::default());
        let all = all.unwrap();
        let alike = |energy: f64| {
            let near = |own: f64| (own - energy).abs() < 1e-7;
            all.found.iter().filter(|f| near(f.energy())).count()
        };
        let found: Vec<_> = energies.iter().map(|&(e, n)| (alike(e), n)).collect();
        assert!(found.iter().all(|(own, n)| own <= n), "{force}: {found:?}");
        let listed: usize = found.iter().map(|(own, _)| own).sum();
        assert_eq!(listed, all.found.len(), "{force}");
        let stable = all.found.iter().filter(|f| f.stable).count();
        assert_eq!(stable, if force.x == 0.0 { 1 } else { 2 });
    }
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
