//! Compliance of a machine: the inverse of a regular stiffness; where the machine cannot move in
//! some directions, the derivative of its motion in the others and zero there.

use crate::common::{Orthoglide, Rng, orthoglide_point};
use kinetostat::{
    ActuatorSpec, Chain, DirectionKind, Mechanism, MotionKind, Pose, Twist, Wrench,
    spatial::pose_residual,
};
use kinetostat_testing::LargestEntry;
use nalgebra::{Matrix6, UnitQuaternion, Vector3, vector};

/// Three elastic drives with parallel axes and rigid links, turned anyhow.
fn planar(turn: UnitQuaternion<f64>) -> Mechanism {
    let mut builder =
        Chain::builder("planar").rigid(Pose::from_parts(Vector3::zeros().into(), turn));
    for (k, (home, stiffness)) in [(0.4, 900.0), (-0.9, 500.0), (0.3, 200.0)]
        .into_iter()
        .enumerate()
    {
        let mut drive = ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
        drive.home = home;
        builder = builder
            .actuator(&format!("a{k}"), drive)
            .translation(vector![0.5 - 0.1 * k as f64, 0.0, 0.0]);
    }
    let chain = builder.build().unwrap();
    let home = kinetostat::model::unloaded_tip(
        &chain,
        &Pose::identity(),
        &chain.home_coordinates(),
        &chain.home_commands(),
    );
    Mechanism::serial(chain, home, Vector3::zeros()).unwrap()
}

#[test]
fn the_compliance_of_a_planar_machine_is_the_derivative_of_its_motion() {
    let mut rng = Rng(5);
    for _ in 0..4 {
        let turn = rng.pose(1.0, 3.0).rotation;
        let machine = planar(turn);
        let posture = machine.posture(&machine.platforms()[1].home).unwrap();
        // In the plane, in its own axes.
        let load = |x: f64, y: f64, m: f64| {
            Wrench::new(turn * vector![x, y, 0.0], turn * vector![0.0, 0.0, m])
        };
        let here = load(40.0, -60.0, 8.0);
        let e = posture.deflected_by(&here).unwrap();
        let c = e.compliance();
        assert_eq!((c.rank(), c.rigid.len(), c.free.len()), (3, 3, 0));
        for (wrench, step) in [
            (load(1.0, 0.0, 0.0), 0.05),
            (load(0.0, 1.0, 0.0), 0.05),
            (load(0.0, 0.0, 1.0), 0.02),
        ] {
            let at = |share: f64| {
                let wrench = Wrench(here.0 + wrench.0 * (share * step));
                let moved = posture.deflected_by(&wrench).unwrap();
                pose_residual(&moved.tool, &e.tool).0
            };
            let found = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step);
            let expected = c.springs * wrench.0;
            let off = (found - expected).largest_entry() / expected.largest_entry();
            assert!(off < 1e-8, "{off:e}");
        }
        // Out of the plane nothing moves, whatever pushes.
        for axis in [
            Twist::new(turn * Vector3::z(), Vector3::zeros()),
            Twist::new(Vector3::zeros(), turn * Vector3::x()),
            Twist::new(Vector3::zeros(), turn * Vector3::y()),
        ] {
            let size = c.springs.largest_entry();
            assert!((c.springs * axis.0).largest_entry() < 1e-12 * size);
            assert!((c.springs.transpose() * axis.0).largest_entry() < 1e-12 * size);
        }
        // Unloaded: springs in series, J K^-1 J^T by hand.
        let unloaded = posture.stiffness().unwrap();
        let mut by_hand = Matrix6::zeros();
        let (mut angle, mut point) = (0.0, Vector3::zeros());
        let tip = turn.inverse() * machine.platforms()[1].home.translation.vector;
        for (k, (home, stiffness)) in [(0.4, 900.0), (-0.9, 500.0), (0.3, 200.0)]
            .into_iter()
            .enumerate()
        {
            let column = Twist::new(
                turn * Vector3::z().cross(&(tip - point)),
                turn * Vector3::z(),
            );
            by_hand += column.0 * column.0.transpose() / stiffness;
            angle += home;
            point += (0.5 - 0.1 * k as f64) * vector![f64::cos(angle), f64::sin(angle), 0.0];
        }
        let off =
            (unloaded.compliance().springs - by_hand).largest_entry() / by_hand.largest_entry();
        assert!(off < 1e-10, "{off:e}");
    }
}

#[test]
fn rigid_and_free_motions_are_reported_along_the_axes_where_they_lie_there() {
    let machine = planar(UnitQuaternion::identity());
    let posture = machine.posture(&machine.platforms()[1].home).unwrap();
    let words: Vec<String> = posture
        .stiffness()
        .unwrap()
        .directions
        .iter()
        .filter(|d| d.kind == DirectionKind::Rigid)
        .map(kinetostat::Direction::description)
        .collect();
    assert_eq!(
        words,
        [
            "rigid: nothing moves along z",
            "rigid: nothing turns about x",
            "rigid: nothing turns about y",
        ]
    );
}

#[test]
fn the_compliance_of_a_regular_machine_is_the_inverse() {
    let machine = Orthoglide::default().build();
    let posture = machine.posture(&orthoglide_point(1)).unwrap();
    let pull = Wrench::new(vector![120.0, -30.0, 50.0], vector![3.0, 1.0, -2.0]);
    let e = posture.deflected_by(&pull).unwrap();
    let k = posture.stiffness().unwrap();
    for (c, k) in [
        (e.compliance().springs, e.stiffness.matrix),
        (k.compliance().springs, k.cartesian.matrix),
    ] {
        let expected = k.try_inverse().unwrap();
        for i in 0..6 {
            for j in 0..6 {
                let size = (expected[(i, i)] * expected[(j, j)]).sqrt();
                assert!((c[(i, j)] - expected[(i, j)]).abs() < 1e-9 * size);
            }
        }
    }
}
