//! Struts between joints that turn freely, in whole-number directions, and machines on six of them:
//! redundant joints and equal singular values are the rule here. What must come out is written down
//! from statics: a strut carries an axial force only.

use kinetostat::{
    ActuatorSpec, Chain, ChainBuilder, DirectionKind, Limb, Mechanism, MotionKind, Platform, Pose,
    reference::ChainBlocks, unloaded_stiffness,
};
use kinetostat_testing::Worst;
use nalgebra::{Matrix6, Vector3, Vector6};

use super::random::Random;

/// Not zero, whole numbers, often with zeros and equal ones among them.
fn whole(random: &mut Random, most: usize) -> Vector3<f64> {
    loop {
        let mut part = || random.below(2 * most + 1) as f64 - most as f64;
        let v = Vector3::new(part(), part(), part());
        if v.norm() > 0.0 {
            return v;
        }
    }
}

/// A joint at the lower end: spherical, or universal with axes square to the strut.
fn lower(builder: ChainBuilder, spherical: bool, along: &Vector3<f64>) -> ChainBuilder {
    if spherical {
        return builder.passive_spherical("low");
    }
    let helper = if along.x.abs() < 0.9 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let first = along.cross(&helper).normalize();
    builder.passive_universal("low", first, along.cross(&first))
}

/// A strut along `way` and its axial stiffness (N/m).
fn strut(random: &mut Random, name: &str, foot: Vector3<f64>, span: Vector3<f64>) -> (Chain, f64) {
    let along = span.normalize();
    let k = [1.0, 3.0, 1e3, 1e6, 2e8][random.below(5)];
    let builder = Chain::builder(name).translation(foot);
    let spherical = !random.once_in(3);
    let (builder, axial) = match random.below(3) {
        0 => {
            // A drive between the joints.
            let mut drive = ActuatorSpec::new(MotionKind::Prismatic, along, k);
            drive.home = span.norm();
            (
                lower(builder, spherical, &along).actuator("slide", drive),
                k,
            )
        }
        1 => {
            // A slide with a spring, offsets on both sides.
            let builder = lower(builder, spherical, &along).translation(0.5 * span);
            let builder = builder.spring("slide", MotionKind::Prismatic, along, k, 0.0);
            (builder.translation(0.5 * span), k)
        }
        _ => {
            // A link that gives in all directions, its six stiffnesses at its far end.
            let matrix = random.stiffness(k, k * span.norm_squared());
            let give = matrix.try_inverse().expect("regular");
            let axial = 1.0 / along.dot(&(give.fixed_view::<3, 3>(0, 0) * along));
            let builder = lower(builder, spherical, &along).translation(span);
            (builder.spring6("link", &matrix, [0.0; 6]), axial)
        }
    };
    (
        builder.passive_spherical("top").build().expect("a strut"),
        axial,
    )
}

#[track_caller]
fn same(what: &str, found: &Matrix6<f64>, expected: &Matrix6<f64>, length: f64, most: f64) {
    let unit = |i: usize| if i < 3 { 1.0 } else { length };
    for i in 0..6 {
        for j in 0..6 {
            let off = (found[(i, j)] - expected[(i, j)]) / (unit(i) * unit(j));
            assert!(
                off.abs() <= 1e-9 * most,
                "{what}[{i}, {j}] is off by {off:e} of {most:e}"
            );
        }
    }
}

/// One strut and one machine.
pub fn case(random: &mut Random) {
    let (foot, span) = (whole(random, 3), whole(random, 6));
    let (chain, axial) = strut(random, "strut", foot, span);
    let along = span.normalize();
    let mut expected = Matrix6::zeros();
    expected
        .fixed_view_mut::<3, 3>(0, 0)
        .copy_from(&(axial * along * along.transpose()));
    let home = (chain.home_coordinates(), chain.home_commands());
    let base = Pose::identity();
    let k = unloaded_stiffness(&chain, &base, &home.0, &home.1).expect("a stiffness");
    let length = span.norm();
    same("strut", &k.cartesian.matrix, &expected, length, axial);
    let kinds = (k.count(DirectionKind::Finite), k.count(DirectionKind::Free));
    assert_eq!((k.rank, kinds), (1, (1, 5)), "directions of a strut");
    let blocks = ChainBlocks::unloaded(&chain, &base, &home.0, &home.1).expect("blocks");
    let inverse = blocks.block_inverse().expect("springs that hold");
    same("block inverse", &inverse, &expected, length, axial);
    let give = blocks.compliance();
    assert_eq!(
        (give.rank(), give.free.len()),
        (1, 5),
        "compliance of a strut"
    );
    machine(random);
}

fn machine(random: &mut Random) {
    let home = Pose::translation(0.0, 0.0, 6.0);
    let mut builder = Mechanism::builder("six struts");
    let tool = builder.platform(Platform::new("tool", home));
    let mut expected = Matrix6::zeros();
    let mut most = Worst::new();
    for i in 0..6 {
        let (mut foot, mut hand) = (whole(random, 5), whole(random, 2));
        (foot.z, hand.z) = (0.0, -hand.z.abs());
        let span = hand + Vector3::new(0.0, 0.0, 6.0) - foot;
        let name = format!("leg {i}");
        let (chain, axial) = strut(random, &name, foot, span);
        let (along, arm) = (span.normalize(), hand.cross(&span.normalize()));
        let wrench = Vector6::new(along.x, along.y, along.z, arm.x, arm.y, arm.z);
        expected += axial * wrench * wrench.transpose();
        most.add(axial);
        builder = builder.limb(
            Limb::between(name, 0, tool, chain).fixed_at(Pose::translation(hand.x, hand.y, hand.z)),
        );
    }
    let most = most.of(6);
    let machine = builder.build().expect("a machine");
    let posture = machine.posture(&home).expect("home");
    let k = posture.stiffness().expect("a stiffness");
    same("six struts", &k.cartesian.matrix, &expected, 2.0, most);
    let held = posture.wrench_at(&home).expect("home without load");
    same(
        "six struts held",
        &held.stiffness.matrix,
        &expected,
        2.0,
        most,
    );
    let push = held.wrench.force().norm() + held.wrench.moment().norm();
    assert!(push <= 1e-9 * most, "a wrench {push:e} at rest");
}
