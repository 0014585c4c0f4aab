//! Targets that prescribe the position only, against closed forms: the orientation follows.

use kinetostat::{
    ActuatorSpec, Chain, ChainBuilder, Directions, Error, Mechanism, MotionKind, Platform, Pose,
    PostureRequest, Settings, Wrench, compensate, compensation::compensate_following,
    machine::SingularityKind,
};
use kinetostat_testing::{LargestEntry, least};
use nalgebra::{Rotation3, UnitQuaternion, Vector3, vector};
use proptest::prelude::*;

use crate::graphs::limb;

const R: MotionKind = MotionKind::Revolute;
const P: MotionKind = MotionKind::Prismatic;

fn drive(kind: MotionKind, axis: Vector3<f64>, home: f64) -> ActuatorSpec {
    let mut spec = ActuatorSpec::new(kind, axis, if kind == R { 2e4 } else { 1e6 });
    spec.home = home;
    spec
}

/// Small springs in all directions, so that the machine gives way out of its plane, too.
fn springs(builder: ChainBuilder, name: &str) -> ChainBuilder {
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut builder = builder;
    for (k, axis) in [x, y, z].into_iter().enumerate() {
        builder = builder
            .spring(&format!("{name} {k}"), P, axis, 4e6, 0.0)
            .spring(&format!("{name} {}", 3 + k), R, axis, 3e4, 0.0);
    }
    builder
}

/// Half the distance of the pivots, cranks and distal links of the five-bar, m.
const PIVOT: f64 = 0.15;
const CRANK: f64 = 0.3;
const DISTAL: f64 = 0.4;

/// Elbow of a crank about a pivot at `x`, bent outwards by `side`.
fn elbow(x: f64, side: f64, tip: (f64, f64)) -> (f64, f64) {
    let (dx, dy) = (tip.0 - x, tip.1);
    let d = dx.hypot(dy);
    let along = (CRANK * CRANK - DISTAL * DISTAL + d * d) / (2.0 * d);
    let across = (CRANK * CRANK - along * along).sqrt() * side;
    (
        x + (along * dx - across * dy) / d,
        (along * dy + across * dx) / d,
    )
}

/// Angles of the crank and of the distal link.
fn angles(x: f64, side: f64, tip: (f64, f64)) -> (f64, f64) {
    let e = elbow(x, side, tip);
    (e.1.atan2(e.0 - x), (tip.1 - e.1).atan2(tip.0 - e.0))
}

/// The tool sits at the end of the left distal link, off its axis by `offset` (axes of that link).
fn five_bar(frame: &Pose, offset: Vector3<f64>) -> Mechanism {
    let home = (0.0, 0.5);
    let (left, right) = (angles(-PIVOT, 1.0, home), angles(PIVOT, -1.0, home));
    let z = Vector3::z();
    let place = |x: f64| frame * Pose::translation(x, 0.0, 0.0);
    let arm = |name: &str, x: f64, angles: (f64, f64), joint_at_end: bool| {
        let builder = Chain::builder(name)
            .rigid(place(x))
            .actuator("crank", drive(R, z, angles.0))
            .translation(vector![CRANK, 0.0, 0.0])
            .passive("elbow", R, z, angles.1 - angles.0)
            .translation(vector![DISTAL, 0.0, 0.0]);
        let builder = springs(builder, "link");
        match joint_at_end {
            true => builder.passive("tip", R, z, left.1 - angles.1),
            false => builder,
        }
        .build()
        .unwrap()
    };
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), left.1);
    let tip = frame * Pose::from_parts(vector![home.0, home.1, 0.0].into(), turn);
    let mut machine = Mechanism::builder("five-bar");
    let tool = machine.platform(Platform::new("tool", tip));
    let machine = machine
        .limb(limb(
            "left",
            0,
            tool,
            Pose::identity(),
            arm("left", -PIVOT, left, false),
        ))
        .limb(limb(
            "right",
            0,
            tool,
            Pose::identity(),
            arm("right", PIVOT, right, true),
        ))
        .build()
        .unwrap();
    machine.with_tool(&Pose::from_parts(offset.into(), UnitQuaternion::identity()))
}

fn frame(turn: [f64; 3]) -> Pose {
    let at = vector![0.3, -0.2, 0.7];
    Pose::from_parts(at.into(), UnitQuaternion::new(Vector3::from(turn)))
}

fn home(m: &Mechanism) -> Pose {
    m.platforms()[m.tool()].home
}

/// Where the distal links lie in one line, turned by `phi`: there no locked crank holds the tool across it.
fn in_line(phi: f64) -> (f64, f64) {
    // Both cranks are as long as the way from the pivots, moved along the line by a link, to the tool.
    let (dx, dy) = (DISTAL * phi.cos() - PIVOT, DISTAL * phi.sin());
    let half = dx.hypot(dy);
    let height = (CRANK * CRANK - half * half).sqrt();
    (-dy / half * height, dx / half * height)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn a_five_bar_near_its_links_in_line_says_how_far_it_is(
        turn in prop::array::uniform3(-1.5..1.5_f64),
        phi in -0.25..0.25_f64,
        above in 3e-4..8e-3_f64,
        offset in prop::array::uniform3(-0.05..0.05_f64),
    ) {
        let frame = frame(turn);
        let offset = Vector3::from(offset);
        let machine = five_bar(&frame, offset);
        let line = in_line(phi);
        let start = (line.0, line.1 + above);
        let at = |place: (f64, f64)| {
            let angle = angles(-PIVOT, 1.0, place).1;
            let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
            let joint = frame * Pose::from_parts(vector![place.0, place.1, 0.0].into(), turn);
            joint * Pose::from_parts(offset.into(), UnitQuaternion::identity())
        };
        let pose = at(start);
        let posture = machine.posture(PostureRequest::position(&pose.translation.vector, &home(&machine).rotation));
        let posture = posture.unwrap();
        prop_assert!((posture.target().translation.vector - pose.translation.vector).norm() < 1e-10);
        let length = machine.size();
        let list = posture.near_singularities(0.1 * length).unwrap();
        let gained = list.iter().find(|s| s.kind == SingularityKind::Gained);
        let Some(gained) = gained else {
            return Err(TestCaseError::fail(format!("{above} above the line: {list:?}")));
        };
        prop_assert!(gained.followed);
        // Nearest of all, on a fine grid of the curve, and where the way leads.
        let curve = (-400..=400).map(|k| at(in_line(phi + f64::from(k) * 1e-4)).translation.vector);
        let curve: Vec<Vector3<f64>> = curve.collect();
        let nearest = |from: &Vector3<f64>| {
            least(curve.iter().map(|c| (c - from).norm()))
        };
        let here = pose.translation.vector;
        let there = here + gained.towards.linear() * gained.distance_m;
        let far = nearest(&here);
        prop_assert!(nearest(&there) < 0.1 * far + 3e-5, "{} of {far}: {}", nearest(&there), gained.description());
        let span = gained.distance_m * gained.towards.linear().norm();
        prop_assert!((0.9 * far - 3e-5..=3.0 * far).contains(&span), "{span} against {far}");
    }

    #[test]
    fn a_five_bar_turns_as_its_closed_form(
        turn in prop::array::uniform3(-1.5..1.5_f64),
        x in -0.2..0.2_f64,
        y in 0.35..0.58_f64,
        offset in prop::array::uniform3(-0.05..0.05_f64),
    ) {
        let frame = frame(turn);
        let offset = Vector3::from(offset);
        let machine = five_bar(&frame, offset);
        prop_assert!(machine.turns_as_it_moves());
        let expected = {
            let angle = angles(-PIVOT, 1.0, (x, y)).1;
            let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
            let joint = frame * Pose::from_parts(vector![x, y, 0.0].into(), turn);
            joint * Pose::from_parts(offset.into(), UnitQuaternion::identity())
        };
        let wanted = home(&machine).rotation;
        let posture = machine.posture(PostureRequest::position(&expected.translation.vector, &wanted)).unwrap();
        prop_assert!(posture.target().rotation.angle_to(&expected.rotation) < 1e-9);
        prop_assert_eq!(posture.target().translation, expected.translation);
        let full = std::f64::consts::TAU;
        let commands = [angles(-PIVOT, 1.0, (x, y)).0, angles(PIVOT, -1.0, (x, y)).0];
        for (own, closed) in posture.commands().iter().zip(commands) {
            let off = own - closed;
            prop_assert!((off - full * (off / full).round()).abs() < 1e-9, "{own} {closed}");
        }
        // It is a posture like any other.
        let same = machine.posture(PostureRequest::pose(posture.target()).near(&posture)).unwrap();
        for (a, b) in same.commands().iter().zip(posture.commands()) {
            prop_assert!((a - b).abs() < 1e-9);
        }
        // Beside its plane there is nothing, and the nearest place lies in the plane.
        let out = frame.rotation * Vector3::z() * 0.01;
        let beside = expected.translation.vector + out;
        match machine.posture(PostureRequest::position(&beside, &wanted)) {
            Err(Error::Unreachable { distance_m, nearest, .. }) => {
                prop_assert!((distance_m - 0.01).abs() < 1e-9, "{distance_m}");
                prop_assert!((nearest.translation.vector - expected.translation.vector).norm() < 1e-9);
            }
            other => prop_assert!(false, "{other:?}"),
        }
    }

    #[test]
    fn a_compensated_position_is_where_it_should_be(
        turn in prop::array::uniform3(-1.5..1.5_f64),
        x in -0.15..0.15_f64,
        force in prop::array::uniform3(-200.0..200.0_f64),
        offset in prop::array::uniform3(-0.05..0.05_f64),
    ) {
        let frame = frame(turn);
        let machine = five_bar(&frame, offset.into());
        let wanted = home(&machine).rotation;
        let inside = (frame * Pose::translation(x, 0.5, 0.0)).translation.vector;
        let angle = angles(-PIVOT, 1.0, (x, 0.5)).1;
        let arm = Rotation3::from_axis_angle(&Vector3::z_axis(), angle) * Vector3::from(offset);
        let position = inside + frame.rotation * arm;
        let near = machine.posture(PostureRequest::position(&position, &wanted)).unwrap();
        let wrench = Wrench::new(Vector3::from(force), vector![3.0, -4.0, 5.0]);
        let start = near.rest_state();
        let c = compensate_following(&near, &position, &wanted, &wrench, start).unwrap();
        // The general engine, solved anew for the modified target.
        let again = machine
            .posture(PostureRequest::position(&c.posture.target().translation.vector, &wanted))
            .unwrap()
            .deflected_by(&wrench)
            .unwrap();
        let before = near.deflected_by(&wrench).unwrap();
        let residual = |tool: &Pose| frame.rotation.inverse() * (tool.translation.vector - position);
        let (after, before) = (residual(&again.tool), residual(&before.tool));
        prop_assert!(before.xy().norm() > 1e-7, "{before}");
        prop_assert!(after.xy().norm() < 1e-11, "{after}");
        // What it cannot correct is said.
        let left = frame.rotation.inverse() * c.left_over.linear();
        prop_assert!((left - after).norm() < 1e-11);
    }

    #[test]
    fn an_arm_of_one_turn_and_two_slides_follows_its_bearing(
        turn in prop::array::uniform3(-1.5..1.5_f64),
        bearing in -2.5..2.5_f64,
        reach in -0.1..0.3_f64,
        height in -0.2..0.2_f64,
        offset in -0.1..0.1_f64,
    ) {
        let frame = frame(turn);
        let (x, z) = (Vector3::x(), Vector3::z());
        let chain = Chain::builder("arm")
            .rigid(frame)
            .actuator("turn", drive(R, z, 0.0))
            .actuator("lift", drive(P, z, 0.0))
            .actuator("reach", drive(P, x, 0.0))
            .translation(vector![0.5, offset, 0.1])
            .build()
            .unwrap();
        let tip = frame * Pose::translation(0.5, offset, 0.1);
        let mut builder = Mechanism::builder("arm");
        let tool = builder.platform(Platform::new("tool", tip));
        let machine = builder.limb(limb("arm", 0, tool, Pose::identity(), chain)).build().unwrap();
        prop_assert!(machine.turns_as_it_moves());
        let own = Pose::rotation(z * bearing) * Pose::translation(0.5 + reach, offset, 0.1 + height);
        let expected = frame * own;
        let wanted = home(&machine).rotation;
        let found = machine.posture(PostureRequest::position(&expected.translation.vector, &wanted)).unwrap();
        prop_assert!(found.target().rotation.angle_to(&expected.rotation) < 1e-9);
        for (own, closed) in found.commands().iter().zip([bearing, height, reach]) {
            prop_assert!((own - closed).abs() < 1e-9, "{own} {closed}");
        }
        // On the way from neighbour to neighbour it ends in the same place.
        let mut near = machine.posture(&home(&machine)).unwrap();
        for k in 1..=40 {
            let b = bearing * f64::from(k) / 40.0;
            let own = Pose::rotation(z * b) * Pose::translation(0.5 + reach, offset, 0.1 + height);
            let place = (frame * own).translation.vector;
            let next = machine.posture(PostureRequest::position(&place, &wanted).near(&near)).unwrap();
            prop_assert!((next.commands()[0] - b).abs() < 1e-9);
            near = next;
        }
    }

    #[test]
    fn what_is_free_turns_as_little_as_it_can(
        tilt in prop::array::uniform3(-0.5..0.5_f64),
        place in prop::array::uniform3(-0.2..0.2_f64),
    ) {
        // Three slides and a turn about z: of a rotation it can have the twist about z, which is the
        // nearest one (the part of the quaternion along z).
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
        let chain = Chain::builder("arm")
            .actuator("x", drive(P, x, 0.0))
            .actuator("y", drive(P, y, 0.0))
            .actuator("z", drive(P, z, 0.0))
            .actuator("turn", drive(R, z, 0.0))
            .translation(vector![0.1, 0.0, 0.0])
            .build()
            .unwrap();
        let mut builder = Mechanism::builder("arm");
        let tool = builder.platform(Platform::new("tool", Pose::translation(0.1, 0.0, 0.0)));
        let machine = builder.limb(limb("arm", 0, tool, Pose::identity(), chain)).build().unwrap();
        prop_assert!(!machine.turns_as_it_moves());
        let wanted = UnitQuaternion::new(Vector3::from(tilt));
        let found = machine.posture(PostureRequest::position(&Vector3::from(place), &wanted)).unwrap();
        let twist = 2.0 * wanted.k.atan2(wanted.w);
        let off = found.commands()[3] - twist;
        prop_assert!(off.abs() < 1e-7, "{off}");
        prop_assert_eq!(found.target().translation.vector, Vector3::from(place));
    }
}

/// A 3-RPS: hinges square to the planes of the legs, slides, balls on a ring of the platform; the tip of a
/// tool below it.
fn three_rps(base: f64, ring: f64, height: f64, tool: f64) -> Mechanism {
    let home = Pose::translation(0.0, 0.0, height - tool);
    let mut builder = Mechanism::builder("3-RPS");
    let platform = builder.platform(Platform::new("head", home));
    for leg in 0..3 {
        let turn = Pose::rotation(Vector3::z() * (f64::from(leg) * std::f64::consts::TAU / 3.0));
        let lean = (ring - base).atan2(height);
        let length = (ring - base).hypot(height);
        let name = format!("leg {leg}");
        let chain = Chain::builder(&name)
            .rigid(turn * Pose::translation(base, 0.0, 0.0))
            .passive("hinge", R, Vector3::y(), lean)
            .actuator("slide", drive(P, Vector3::z(), length))
            .passive_spherical("ball")
            .build()
            .unwrap();
        let tip = turn * Pose::translation(ring, 0.0, height) * Pose::rotation(Vector3::y() * lean);
        builder = builder.limb(limb(&name, 0, platform, home.inverse() * tip, chain));
    }
    builder.build().unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// The head tilts about any level axis and moves sideways by nothing else; its centre stays at its
    /// height, beside the axis by second order (Lee and Shah 1988: every ball stays in its plane).
    #[test]
    fn a_three_rps_moves_its_tip_by_tilting_alone(
        about in 0.0..std::f64::consts::TAU,
        tilt in 0.02..0.35_f64,
        base in 0.35..0.6_f64,
        ring in 0.15..0.3_f64,
        height in 0.7..1.2_f64,
        tool in 0.1..0.4_f64,
    ) {
        let machine = three_rps(base, ring, height, tool);
        prop_assert!(machine.turns_as_it_moves());
        let turn = UnitQuaternion::new(vector![about.cos(), about.sin(), 0.0] * tilt);
        let m = turn.to_rotation_matrix();
        let aside = vector![0.5 * ring * (m[(0, 0)] - m[(1, 1)]), -ring * m[(1, 0)], 0.0];
        let head = aside + vector![0.0, 0.0, height];
        let tip = head + turn * vector![0.0, 0.0, -tool];
        let wanted = home(&machine).rotation;
        let found = machine.posture(PostureRequest::position(&tip, &wanted)).unwrap();
        let off = found.target().rotation.angle_to(&turn);
        prop_assert!(off < 1e-9, "{off}");
        prop_assert_eq!(found.target().translation.vector, tip);
        for (leg, own) in found.commands().into_iter().enumerate() {
            let angle = leg as f64 * std::f64::consts::TAU / 3.0;
            let out = vector![angle.cos(), angle.sin(), 0.0];
            let closed = (head + turn * (out * ring) - out * base).norm();
            prop_assert!((own - closed).abs() < 1e-9, "leg {leg}: {own} {closed}");
        }
        // From neighbour to neighbour along the tilt it comes to the same place.
        let mut near = machine.posture(&home(&machine)).unwrap();
        for k in 1..=20 {
            let share = f64::from(k) / 20.0;
            let place = home(&machine).translation.vector.lerp(&tip, share);
            near = machine.posture(PostureRequest::position(&place, &wanted).near(&near)).unwrap();
        }
        let off = near.target().rotation.angle_to(&turn);
        prop_assert!(off < 1e-9, "{off}");
    }
}

#[test]
fn a_machine_that_holds_its_orientation_gives_the_same_correction_either_way() {
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    let builder = Chain::builder("arm")
        .actuator("x", drive(P, x, 0.0))
        .actuator("y", drive(P, y, 0.0))
        .actuator("z", drive(P, z, 0.0));
    let chain = springs(builder, "head")
        .translation(vector![0.1, 0.2, -0.3])
        .build()
        .unwrap();
    let tip = Pose::translation(0.1, 0.2, -0.3);
    let mut builder = Mechanism::builder("gantry");
    let tool = builder.platform(Platform::new("tool", tip));
    let machine = builder
        .limb(limb("arm", 0, tool, Pose::identity(), chain))
        .build()
        .unwrap();
    assert!(!machine.turns_as_it_moves());
    let wanted = Pose::translation(0.3, 0.1, -0.4);
    let wrench = Wrench::new(vector![100.0, -200.0, 300.0], vector![1.0, 2.0, 3.0]);
    let near = machine.posture(&wanted).unwrap();
    let follows = compensate_following(
        &near,
        &wanted.translation.vector,
        &wanted.rotation,
        &wrench,
        near.rest_state(),
    )
    .unwrap();
    let positions = Directions::POSITION;
    let held = compensate(&machine, &wanted, &wrench, positions, &Settings::default()).unwrap();
    let apart = (follows.correction.0 - held.correction.0).largest_entry();
    assert!(
        held.correction.0.largest_entry() > 1e-5 && apart < 1e-12,
        "{apart}"
    );
}

#[test]
fn numbers_that_are_none_are_refused() {
    let machine = five_bar(&Pose::identity(), Vector3::zeros());
    let wanted = UnitQuaternion::identity();
    let place = vector![0.0, f64::NAN, 0.0];
    let error = machine
        .posture(PostureRequest::position(&place, &wanted))
        .unwrap_err();
    assert!(matches!(error, Error::NotFinite { .. }), "{error}");
}
