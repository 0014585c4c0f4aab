//! What is singular and what that means [R 3.16, 3.17; equations.md section 3].

use crate::common::{
    Recipe, Rng, assert_chain_equilibrium, cases, close, planar_column, random_chain, rank,
};
use crate::oracle::Frames;
use kinetostat::{
    BeamSection, Chain, ChainProblem, DirectionKind, EndCondition, MotionKind, Pose, Settings,
    solve_chain, unloaded_stiffness,
};
use kinetostat_testing::LargestEntry;
use nalgebra::vector;
use proptest::prelude::*;

proptest! {
    #![proptest_config(cases(48))]
    #[test]
    fn each_passive_joint_removes_one_rank(seed in any::<u64>(), joints in 1_usize..=5) {
        let mut rng = Rng(seed);
        let mut b = Chain::builder("c");
        let mut left = joints;
        for k in 0..2 {
            b = b.rigid(rng.pose(0.4, 1.0));
            let here = if k == 1 { left } else { rng.below(left + 1) };
            left -= here;
            for i in 0..here {
                let kind = if rng.below(3) == 0 { MotionKind::Prismatic } else { MotionKind::Revolute };
                b = b.passive(&format!("q{k}{i}"), kind, rng.axis(), 0.0).rigid(rng.pose(0.4, 1.0));
            }
            let m = rng.spring_matrix(1e6, 2e4);
            b = b.spring6(&format!("s{k}"), &m, [0.0; 6]);
        }
        let chain = b.rigid(rng.pose(0.4, 1.0)).build().unwrap();
        let home = chain.home_coordinates();
        let base = rng.pose(1.0, 2.0);
        let k = unloaded_stiffness(&chain, &base, &home, &[]).unwrap();
        // Independent axes only: more than three slides, say, cannot all count.
        let frames = Frames::new(&chain, &base, &home, &[]);
        let j = frames.jacobian(frames.tip());
        let passive = chain.indices_of(kinetostat::model::Role::Passive);
        let own = j.select_columns(&passive);
        let gram = (own.transpose() * &own).symmetric_eigenvalues();
        let independent = gram.iter().filter(|x| **x > 1e-9).count();
        prop_assume!(gram.iter().all(|x| *x > 1e-5 || *x < 1e-14));
        prop_assert_eq!(k.rank, 6 - independent);
        prop_assert_eq!(k.count(DirectionKind::Free), independent);
        prop_assert_eq!(rank(&k.cartesian.matrix, 0.3), 6 - independent);
        prop_assert_eq!(k.redundant_passive.is_empty(), independent == joints);
        // What a passive joint moves costs nothing.
        let push = k.cartesian.matrix * own;
        prop_assert!(push.largest_entry() < 1e-8 * k.cartesian.matrix.largest_entry());
        let again = k.cartesian.matrix;
        prop_assert!((again - again.transpose()).largest_entry() < 1e-9 * again.largest_entry());
    }

    #[test]
    fn motions_of_joints_and_springs_follow_the_end(seed in any::<u64>()) {
        let mut rng = Rng(seed);
        let r = random_chain(&mut rng, &Recipe { stages: 3, passive: 4, ..Recipe::default() });
        let k = unloaded_stiffness(&r.chain, &r.base, &r.posture, &r.commands).unwrap();
        let frames = Frames::new(&r.chain, &r.base, &r.posture, &r.commands);
        let j = frames.jacobian(frames.tip());
        let q = j.select_columns(&r.chain.indices_of(kinetostat::model::Role::Passive));
        let t = j.select_columns(&r.chain.indices_of(kinetostat::model::Role::Spring));
        // J_q K_Cq + J_theta K_Ctheta = I on the motions that exist (all six here).
        let identity = q * &k.passive + t * &k.springs;
        prop_assert!((identity - nalgebra::DMatrix::identity(6, 6)).largest_entry() < 1e-9);
    }
}

fn strut(first: &str, last: &str) -> Chain {
    let section = BeamSection::tube(2.1e11, 8e10, 0.03, 0.02);
    Chain::builder("strut")
        .passive_spherical(first)
        .link("rod", &section, 0.8)
        .passive_spherical(last)
        .build()
        .unwrap()
}

#[test]
fn a_strut_between_spherical_joints_spins_and_says_so() {
    let chain = strut("lower", "upper");
    let home = chain.home_coordinates();
    let k = unloaded_stiffness(&chain, &Pose::identity(), &home, &[]).unwrap();
    assert_eq!(k.rank, 1);
    assert_eq!(k.redundant_passive, ["lower.x", "upper.x"]);
    let section = BeamSection::tube(2.1e11, 8e10, 0.03, 0.02);
    let axial = 2.1e11 * section.area / 0.8;
    close("axial", k.cartesian.matrix[(0, 0)], axial, 1e-6 * axial);
    assert!((k.cartesian.matrix.abs().sum() - axial).abs() < 1e-6 * axial);

    // Stretched: only an axial force, and the spin is neutral, not unstable.
    for stretch in [1e-4, -1e-5] {
        let mut problem = ChainProblem::new(&chain, EndCondition::pose(Pose::identity()));
        problem.end.pose = Pose::new(vector![0.8 + stretch, 0.0, 0.0], vector![0.3, 0.1, -0.2]);
        let e = solve_chain(&problem, &Settings::default()).unwrap();
        assert_chain_equilibrium(&problem, &e);
        close(
            "force",
            e.wrench.0[0],
            axial * stretch,
            1e-6 * axial * stretch.abs(),
        );
        assert!(e.wrench.0.rows(1, 5).largest_entry() < 1e-7 * axial * stretch.abs());
        assert!(e.stability.stable, "{:?}", e.stability);
        assert!(
            e.coordinates.iter().all(|x| x.abs() < 1.0),
            "the spin ran away: {:?}",
            e.coordinates
        );
        assert!(!e.stability.neutral.is_empty());
    }
}

#[test]
fn a_planar_chain_of_rigid_links_is_rigid_out_of_its_plane() {
    let chain = planar_column(3, 0.5, 10.0);
    for (posture, rigid) in [([0.0; 4], 4), ([0.4, -0.5, -0.3, 0.2], 3)] {
        let k = unloaded_stiffness(&chain, &Pose::identity(), &posture, &[]).unwrap();
        assert_eq!(k.count(DirectionKind::Rigid), rigid, "{posture:?}");
        assert!(
            k.directions[..rigid]
                .iter()
                .all(|d| d.stiffness_n_per_m.is_infinite())
        );
        // The free direction: a hinge at each end leaves no moment.
        assert_eq!(k.rank, 6 - rigid - 2, "{:?}", k.directions);
        assert!(k.cartesian.matrix.iter().all(|x| x.is_finite()));
        for d in &k.directions[..rigid] {
            let j = Frames::new(&chain, &Pose::identity(), &posture, &[]);
            let j = j.jacobian(j.tip());
            let (length, t) = (chain.scale().length, d.twist.0);
            // Orthogonal to every motion of the chain, rotations measured at the natural length.
            let dot = |c: usize| {
                (0..6)
                    .map(|i| j[(i, c)] * t[i] * if i < 3 { 1.0 } else { length * length })
                    .sum::<f64>()
            };
            for c in 0..4 {
                assert!(dot(c).abs() < 1e-9, "{posture:?}: {d:?}");
            }
        }
    }
}

/// Six legs, universal or spherical below, spherical above; base and platform angles as in case B
/// of [R 3.35], or A, which is architecturally singular.
fn six_legs(spherical: bool, singular: bool) -> kinetostat::Mechanism {
    use kinetostat::{ActuatorSpec, Limb, Mechanism, Platform};
    let section = BeamSection::tube(2.1e11, 8e10, 0.03, 0.02);
    let mut builder = Mechanism::builder("legs");
    let tool = builder.platform(Platform::new("tool", Pose::translation(0.0, 0.0, 0.6)));
    let base = [0.0_f64, 120.0, 120.0, 240.0, 240.0, 360.0];
    let top = [60.0_f64, 60.0, 180.0, 180.0, 300.0, 300.0];
    for i in 0..6 {
        let (f, s) = if singular {
            let angle = (60.0 * i as f64).to_radians();
            (angle, angle)
        } else {
            (base[i].to_radians(), top[i].to_radians())
        };
        let b = vector![0.5 * f.cos(), 0.5 * f.sin(), 0.0];
        let a = vector![0.3 * s.cos(), 0.3 * s.sin(), 0.0];
        let span = a - b + vector![0.0, 0.0, 0.6];
        // Local x along the leg, so that a strut's spin is about x.
        let turn =
            nalgebra::UnitQuaternion::rotation_between(&nalgebra::Vector3::x(), &span).unwrap();
        let mut drive = ActuatorSpec::new(MotionKind::Prismatic, nalgebra::Vector3::x(), 4e7);
        drive.home = span.norm() - 0.4;
        let mut chain = Chain::builder(format!("leg {i}"))
            .translation(b)
            .rigid(Pose::from_parts(nalgebra::Vector3::zeros().into(), turn));
        chain = if spherical {
            chain.passive_spherical("low")
        } else {
            chain.passive_universal("low", nalgebra::Vector3::y(), nalgebra::Vector3::z())
        };
        let chain = chain
            .actuator("drive", drive)
            .link("rod", &section, 0.4)
            .passive_spherical("top")
            .rigid(Pose::from_parts(
                nalgebra::Vector3::zeros().into(),
                turn.inverse(),
            ))
            .build()
            .unwrap();
        builder = builder.limb(
            Limb::between(format!("leg {i}"), 0, tool, chain)
                .fixed_at(Pose::translation(a.x, a.y, a.z)),
        );
    }
    builder.build().unwrap()
}

#[test]
fn legs_that_spin_change_nothing_for_the_platform() {
    let (u, s) = (six_legs(false, false), six_legs(true, false));
    for (position, turn) in [
        (vector![0.0, 0.0, 0.6], vector![0.0, 0.0, 0.0]),
        (vector![0.05, -0.03, 0.63], vector![0.1, -0.05, 0.12]),
    ] {
        let target = Pose::new(position, turn);
        let (p, q) = (u.posture(&target).unwrap(), s.posture(&target).unwrap());
        let (a, b) = (p.stiffness().unwrap(), q.stiffness().unwrap());
        crate::common::same_stiffness("unloaded", &b.cartesian.matrix, &a.cartesian.matrix, 1e-9);
        assert_eq!(a.rank(), 6);
        for limb in &a.limbs {
            assert_eq!(limb.rank, 1);
            assert!(limb.redundant_passive.is_empty());
        }
        for limb in &b.limbs {
            assert_eq!(limb.rank, 1);
            assert!(
                limb.redundant_passive.iter().any(|n| n.starts_with("low")),
                "{:?}",
                limb.redundant_passive
            );
            assert!(
                limb.redundant_passive.iter().any(|n| n.starts_with("top")),
                "{:?}",
                limb.redundant_passive
            );
        }
        let wrench =
            kinetostat::Wrench::new(vector![300.0, -200.0, -900.0], vector![20.0, -10.0, 15.0]);
        let (e, o) = (
            p.deflected_by(&wrench).unwrap(),
            q.deflected_by(&wrench).unwrap(),
        );
        crate::common::assert_equilibrium(&p, &e);
        crate::common::assert_equilibrium(&q, &o);
        assert!(e.stable() && o.stable());
        let residual = kinetostat::spatial::pose_residual(&e.tool, &o.tool);
        assert!(residual.0.norm() < 1e-11, "{residual:?}");
        crate::common::same_stiffness("loaded", &o.stiffness.matrix, &e.stiffness.matrix, 1e-8);
    }
}

#[test]
fn a_singular_platform_names_the_push_it_cannot_take() {
    // All legs meet in one apex: no turning about z, and two more directions.
    let machine = six_legs(false, true);
    let home = Pose::translation(0.0, 0.0, 0.6);
    let posture = machine.posture(&home).unwrap();
    assert_eq!(posture.stiffness().unwrap().rank(), 3);
    let moment = kinetostat::Wrench::new(nalgebra::Vector3::zeros(), vector![0.0, 0.0, 5.0]);
    match posture.deflected_by(&moment) {
        Err(kinetostat::Error::FreeDirection { .. }) => {}
        // It may also swing until the legs hold: then it is an honest equilibrium, far away.
        Ok(e) => {
            crate::common::assert_equilibrium(&posture, &e);
            assert!(e.displacement.angular().norm() > 0.01);
        }
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn a_planar_machine_carries_what_pushes_it_out_of_its_plane() {
    use kinetostat::{ActuatorSpec, Chain, DirectionKind, Mechanism, MotionKind, Pose, Wrench};
    use nalgebra::{Vector3, vector};
    let z = Vector3::z();
    let mut drive = ActuatorSpec::new(MotionKind::Revolute, z, 500.0);
    drive.home = -0.6;
    let chain = Chain::builder("two links")
        .passive("shoulder", MotionKind::Revolute, z, 0.3)
        .translation(vector![1.0, 0.0, 0.0])
        .actuator("elbow", drive)
        .translation(vector![1.0, 0.0, 0.0])
        .passive("wrist", MotionKind::Revolute, z, 0.3)
        .build()
        .unwrap();
    let machine = Mechanism::serial(chain, Pose::identity(), Vector3::zeros()).unwrap();
    let home = Pose::translation(2.0 * 0.3_f64.cos(), 0.0, 0.0);
    let posture = machine.posture(&home).unwrap();
    let k = posture.stiffness().unwrap();
    let count = |kind| k.directions.iter().filter(|d| d.kind == kind).count();
    // z, rx, ry are blocked by the joints; across and about z the passive joints are free.
    assert_eq!(count(DirectionKind::Rigid), 3);
    assert_eq!(count(DirectionKind::Free), 2);
    assert_eq!(count(DirectionKind::Finite), 1);
    let push = Wrench::new(vector![20.0, 0.0, 70.0], vector![5.0, -3.0, 0.0]);
    // (The identity of K - K^T speaks of motions that exist; here some do not.)
    let e = posture.deflected_by(&push).unwrap();
    assert!(e.residual.torque < 1e-9 && e.residual.closure_m < 1e-11);
    assert!((e.limbs[0].wrench.0 - push.0).norm() < 1e-6);
    assert!(e.displacement.0[2].abs() < 1e-15 && e.displacement.0[0] > 0.0);
    let in_plane = Wrench::new(vector![20.0, 0.0, 0.0], Vector3::zeros());
    let flat = posture.deflected_by(&in_plane).unwrap();
    assert!((flat.displacement.0 - e.displacement.0).norm() < 1e-12);
}
