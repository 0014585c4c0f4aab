//! A lane's bits depend on nothing but its own posture.

use kinetostat::batch::{Batch, BatchStiffness, Details, Status, Table, over_machines};
use kinetostat::internal::{
    InstructionSet, kernel_sine_and_cosine, kernel_tangent, kernel_torque, without_unloaded_kernels,
};
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, Directions, Error, Limb, Mechanism, MotionKind, Place,
    Platform, Pose, Wrench,
    model::{BowingLaw, Kinematics, LogarithmLaw, SpringLaw, unloaded_tip},
};
use kinetostat_testing::{LargestEntry, Worst, largest_size};
use nalgebra::{Matrix6, UnitQuaternion, Vector3};

use super::posture_at_joints;

/// Numbers between -1 and 1 with nothing special about them.
fn irregular(i: usize) -> f64 {
    2.0 * ((i + 1) as f64 * 0.618_033_988_749_895).fract() - 1.0
}

fn bar() -> Matrix6<f64> {
    BeamSection::tube(2.1e11, 8.1e10, 0.02, 0.012)
        .cantilever(0.3)
        .unwrap()
}

/// Three sliders with struts between universal joints, one strut longer than drawn.
pub(super) fn sliders() -> Mechanism {
    let mut builder = Mechanism::builder("sliders").gravity(Vector3::new(0.0, 0.0, -9.81));
    let tool = builder.platform(Platform {
        mass: 3.0,
        centre_of_mass: Vector3::new(0.01, -0.02, 0.03),
        ..Platform::new("tool", Pose::identity())
    });
    for i in 0..3 {
        let axes = UnitQuaternion::from_axis_angle(
            &nalgebra::Unit::new_normalize(Vector3::new(1.0, 1.0, 1.0)),
            f64::from(i) * std::f64::consts::TAU / 3.0,
        );
        let turned = Pose::from_parts(Vector3::zeros().into(), axes);
        let leg = |longer: f64| {
            let slide = ActuatorSpec {
                home: -0.33,
                ..ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 2.8e6)
            };
            Chain::builder(format!("leg {i}"))
                .rigid(turned)
                .actuator("slide", slide)
                .spring6("foot", &(bar() * 30.0), [0.0; 6])
                .passive("q1", MotionKind::Revolute, Vector3::z(), 0.0)
                .passive("q2", MotionKind::Revolute, Vector3::y(), 0.0)
                .translation(Vector3::new(0.3 + longer, 0.0, 0.0))
                .spring6("bar", &bar(), [0.0; 6])
                .passive("q3", MotionKind::Revolute, Vector3::y(), 0.0)
                .passive("q4", MotionKind::Revolute, Vector3::z(), 0.0)
                .translation(Vector3::new(0.03, 0.0, 0.0))
                .rigid(turned.inverse())
                .build()
                .expect("a leg")
        };
        builder = builder.limb(
            Limb::between(format!("leg {i}"), 0, tool, leg(0.0)).with_actual(leg(if i == 1 {
                2e-4
            } else {
                0.0
            })),
        );
    }
    builder.build().expect("a machine")
}

fn poses(count: usize) -> Vec<Pose> {
    (0..count)
        .map(|i| {
            let [x, y, z] = [0, 1, 2].map(|k| 0.06 * irregular(3 * i + k));
            Pose::translation(x, y, z)
        })
        .collect()
}

fn wrenches(count: usize) -> Vec<Wrench> {
    let vector = |i: usize| Vector3::new(irregular(i), irregular(i + 1), irregular(i + 2));
    (0..count)
        .map(|i| Wrench::new(200.0 * vector(5 * i), 5.0 * vector(7 * i)))
        .collect()
}

/// Bits of all numbers of all answers, found with one instruction set on this thread.
fn answers(machine: &Mechanism, joints: Option<&[f64]>, count: usize) -> Vec<u64> {
    let batch = Batch::new(machine);
    let (poses, wrenches) = (poses(count), wrenches(count));
    let (free, bent) = match joints {
        Some(commands) => (
            batch.stiffness_and_jacobian(commands),
            batch.equilibrium_at_joints(commands, &wrenches, Details::Stiffness),
        ),
        None => (
            Ok(batch.stiffness(&poses)),
            batch.equilibrium(&poses, &wrenches, Details::Stability),
        ),
    };
    let (free, bent) = (free.expect("sizes"), bent.expect("sizes"));
    let mut tables = vec![
        free.stiffness,
        free.jacobian,
        bent.tool,
        bent.coordinates,
        bent.commands,
        bent.actuator_forces,
        bent.stiffness,
        bent.stability,
    ];
    let mut found = [free.status, bent.status].concat();
    if joints.is_none() {
        let directions = Directions::POSITION;
        let targets = batch.targets_under_load(&poses, &wrenches, directions);
        let targets = targets.expect("sizes").equilibrium;
        tables.extend([targets.tool, targets.coordinates, targets.commands]);
        found.extend(targets.status);
    }
    assert!(found.iter().all(|f| *f == Status::Vectorised));
    let rows = |i: usize| tables.iter().flat_map(move |t| t.row(i));
    (0..count).flat_map(rows).map(f64::to_bits).collect()
}

#[test]
fn every_instruction_set_gives_the_same_bits() {
    let count = 11;
    let sets = InstructionSet::available();
    let commands: Vec<f64> = (0..3 * count).map(|i| 1.5 * irregular(i)).collect();
    for (machine, joints) in [(sliders(), None), (arm(), Some(commands.as_slice()))] {
        let single = InstructionSet::Single.during(|| answers(&machine, joints, count));
        for set in &sets {
            let same = set.during(|| answers(&machine, joints, count)) == single;
            assert!(same, "{}: {set:?}", machine.name());
        }
    }
    println!("{sets:?} compared with single numbers");
}

#[test]
fn neighbours_do_not_matter() {
    let machine = sliders();
    let batch = Batch::new(&machine);
    let count = 300;
    let (mut poses, mut wrenches) = (poses(count), wrenches(count));
    // One out of reach.
    poses[17] = Pose::translation(3.0, 0.0, 0.0);
    let forward = batch
        .equilibrium(&poses, &wrenches, Details::Rest)
        .expect("sizes");
    poses.reverse();
    wrenches.reverse();
    let backward = batch
        .equilibrium(&poses, &wrenches, Details::Rest)
        .expect("sizes");
    for i in 0..count {
        let mirror = count - 1 - i;
        assert_eq!(forward.status[i], backward.status[mirror]);
        if i == 17 {
            assert_eq!(forward.status[i], Status::Unsolved);
            assert!(forward.tool.row(i).all(f64::is_nan));
            continue;
        }
        assert_eq!(forward.status[i], Status::Vectorised);
        assert!(forward.tool.row(i).eq(backward.tool.row(mirror)));
        assert!(
            forward
                .coordinates
                .row(i)
                .eq(backward.coordinates.row(mirror))
        );
    }
}

#[test]
fn vectorised_postures_are_as_scalar_ones() {
    let machine = sliders();
    let batch = Batch::new(&machine);
    let count = 24;
    let (poses, wrenches) = (poses(count), wrenches(count));
    let all = batch
        .equilibrium(&poses, &wrenches, Details::Rest)
        .expect("sizes");
    for i in 0..count {
        let scalar = machine.posture(&poses[i]).expect("reachable");
        let scalar = scalar.deflected_by(&wrenches[i]).expect("an equilibrium");
        let p = Vector3::from_fn(|k, _| all.tool.get(i, 9 + k));
        assert!((p - scalar.tool.translation.vector).norm() < 1e-12);
        let own = scalar.limbs.iter().flat_map(|l| &l.coordinates);
        for (a, b) in all.coordinates.row(i).zip(own) {
            assert!((a - b).abs() < 1e-11, "{a} {b}");
        }
    }
}

#[test]
fn sines_are_those_of_the_library() {
    for i in 0..20_000 {
        let x = irregular(i) * [1.0, 4.0, 100.0, 3e4][i % 4];
        let (sine, cosine) = kernel_sine_and_cosine(x);
        assert!((sine - x.sin()).abs() < 3e-16, "sin {x}");
        assert!((cosine - x.cos()).abs() < 3e-16, "cos {x}");
    }
}

/// Three joints and three links, one joint's axis slanted.
fn arm() -> Mechanism {
    let mut chain = Chain::builder("arm");
    for (i, axis) in [Vector3::z(), Vector3::y(), Vector3::new(0.2, 0.9, -0.3)]
        .into_iter()
        .enumerate()
    {
        chain = chain
            .actuator(
                &format!("j{i}"),
                ActuatorSpec::new(MotionKind::Revolute, axis, 2e5),
            )
            .translation(Vector3::new(0.4, 0.05, 0.3))
            .spring6(&format!("l{i}"), &(bar() * 20.0), [0.0; 6])
            .body(
                &format!("m{i}"),
                20.0,
                Vector3::new(-0.2, 0.0, -0.1),
                nalgebra::Matrix3::zeros(),
            );
    }
    let chain = chain.build().expect("an arm");
    let gravity = Vector3::new(1.0, 2.0, -9.0);
    Mechanism::serial(chain, Pose::identity(), gravity).expect("a machine")
}

/// Where commands lead the drawn arm with its tool, by products of rotations and translations.
#[test]
fn commands_tell_where_the_tool_is_commanded() {
    let tool = Pose::from_parts(
        nalgebra::vector![0.05, -0.02, 0.2].into(),
        nalgebra::UnitQuaternion::from_scaled_axis(nalgebra::vector![0.3, -0.5, 0.2]),
    );
    let batch = Batch::new(&arm().with_tool(&tool));
    let count = 21;
    let commands: Vec<f64> = (0..3 * count).map(|i| 1.5 * irregular(i)).collect();
    let mut wrenches = wrenches(count);
    // One that no arm bears.
    wrenches[13] = Wrench::new(Vector3::new(1e12, -2e12, 3e12), Vector3::zeros());
    let found = batch
        .equilibrium_at_joints(&commands, &wrenches, Details::Rest)
        .expect("sizes");
    let targets = batch.targets_at_joints(&commands).expect("sizes");
    for i in 0..count {
        if i == 13 {
            assert_eq!(found.status[i], Status::Unsolved);
        }
        let mut wanted = Pose::identity();
        for (axis, angle) in [Vector3::z(), Vector3::y(), Vector3::new(0.2, 0.9, -0.3)]
            .into_iter()
            .zip(&commands[3 * i..])
        {
            let turn = nalgebra::UnitQuaternion::new(axis.normalize() * *angle);
            wanted = wanted * turn * Pose::translation(0.4, 0.05, 0.3);
        }
        wanted *= tool;
        let off = (targets[i].to_homogeneous() - wanted.to_homogeneous()).largest_entry();
        assert!(off < 1e-14, "posture {i} is off by {off}");
    }
    assert_eq!(batch.targets_at_joints(&[]).expect("none"), []);
    assert!(batch.targets_at_joints(&commands[1..]).is_err());
    // Commands beyond what sines of kernels are exact for, and one that is none.
    let odd = [1e6, 0.2, 0.3, f64::NAN, 0.2, 0.3];
    let odd = batch.targets_at_joints(&odd).expect("sizes");
    let near = batch.targets_at_joints(&[1e6_f64.rem_euclid(std::f64::consts::TAU), 0.2, 0.3]);
    let off = (odd[0].to_homogeneous() - near.expect("sizes")[0].to_homogeneous()).largest_entry();
    assert!(off < 1e-9, "off by {off}");
    assert!(odd[1].translation.vector.iter().all(|x| x.is_nan()));
}

#[test]
fn a_serial_arm_has_its_tangent() {
    let machine = arm();
    let batch = Batch::new(&machine);
    let count = 16;
    let commands: Vec<f64> = (0..3 * count).map(|i| 1.5 * irregular(i)).collect();
    let wrenches = wrenches(count);
    let all = batch
        .equilibrium_at_joints(&commands, &wrenches, Details::Stiffness)
        .expect("sizes");
    let free = batch.stiffness_and_jacobian(&commands).expect("sizes");
    for i in 0..count {
        assert_eq!(all.status[i], Status::Vectorised);
        let posture = posture_at_joints(&machine, &commands[3 * i..3 * i + 3]);
        let scalar = posture.deflected_by(&wrenches[i]).expect("an equilibrium");
        let same = |table: &Table, matrix: &Matrix6<f64>| {
            let own = Matrix6::from_fn(|r, c| table.get(i, 6 * r + c));
            (own - matrix).largest_entry() / matrix.largest_entry()
        };
        assert!(same(&all.stiffness, &scalar.stiffness.matrix) < 1e-12);
        let unloaded = posture.stiffness().expect("a stiffness");
        assert!(same(&free.stiffness, &unloaded.cartesian.matrix) < 1e-12);
        let at = Kinematics::new(
            &machine.limbs()[0].nominal,
            &Pose::identity(),
            &[0.0; 21],
            &commands[3 * i..3 * i + 3],
        );
        let jacobian = at.jacobian(machine.limbs()[0].nominal.tip());
        for (k, x) in free.jacobian.row(i).enumerate() {
            assert!((x - jacobian[(k / 21, k % 21)]).abs() < 1e-14);
        }
    }
}

#[test]
fn a_scalar_jacobian_is_the_vectorised_one() {
    let machine = arm();
    let batch = Batch::new(&machine);
    let commands: Vec<f64> = (0..30).map(irregular).collect();
    let vectorised = batch.stiffness_and_jacobian(&commands).expect("sizes");
    let batch = without_unloaded_kernels(batch);
    let mut scalar = BatchStiffness::default();
    // Room for more postures than the second call has.
    let more: Vec<f64> = (0..300).map(irregular).collect();
    batch
        .stiffness_and_jacobian_into(&more, &mut scalar)
        .expect("sizes");
    batch
        .stiffness_and_jacobian_into(&commands, &mut scalar)
        .expect("sizes");
    assert_eq!(scalar.status, vec![Status::Scalar; scalar.status.len()]);
    assert_eq!(scalar.jacobian.len(), vectorised.jacobian.len());
    for i in 0..scalar.status.len() {
        for (a, b) in scalar.jacobian.row(i).zip(vectorised.jacobian.row(i)) {
            assert!((a - b).abs() < 1e-14, "{a} {b}");
        }
        let largest = largest_size(vectorised.stiffness.row(i));
        for (a, b) in scalar.stiffness.row(i).zip(vectorised.stiffness.row(i)) {
            assert!((a - b).abs() < 1e-12 * largest, "{a} {b}");
        }
    }
}

#[test]
fn machines_do_not_matter_to_each_other() {
    let count = 40;
    // Every arm is a little softer than the one before; one of them is none.
    let machine = |i: usize| {
        if i == 7 {
            return Err(Error::Model {
                place: Place::mechanism("7"),
                reason: "is left out".into(),
            });
        }
        let drive = ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), 2e5 - 1e3 * i as f64);
        let chain = Chain::builder("arm")
            .actuator("joint", drive)
            .translation(Vector3::new(0.4, 0.05, 0.3))
            .spring6("link", &(bar() * 20.0), [0.0; 6])
            .build()?;
        Mechanism::serial(chain, Pose::identity(), Vector3::zeros())
    };
    let ask = |_: usize, batch: &Batch| {
        let commands: Vec<f64> = (0..5).map(irregular).collect();
        let found = batch.stiffness_at_joints(&commands)?;
        Ok(found.stiffness.row(3).collect::<Vec<_>>())
    };
    let many = over_machines(count, machine, ask);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let one = pool
        .expect("a pool")
        .install(|| over_machines(count, machine, ask));
    for i in 0..count {
        let Ok(own) = machine(i) else {
            assert!(many[i].is_err() && one[i].is_err());
            continue;
        };
        let many = many[i].as_ref().expect("a stiffness");
        assert_eq!(many, one[i].as_ref().expect("a stiffness"));
        let scalar = posture_at_joints(&own, &[irregular(3)]);
        let scalar = scalar.stiffness().expect("a stiffness").cartesian.matrix;
        for (k, x) in many.iter().enumerate() {
            assert!((x - scalar[(k / 6, k % 6)]).abs() < 1e-12 * scalar.largest_entry());
        }
    }
}

#[test]
fn the_tangent_of_a_bent_beam_is_the_difference_of_its_torques() {
    let matrix = bar();
    let bowing = BowingLaw {
        matrix,
        length: 0.3,
    };
    let logarithm = |length| LogarithmLaw { matrix, length };
    for law in [
        SpringLaw::Bowing(Box::new(bowing)),
        SpringLaw::Logarithm(Box::new(logarithm(0.0))),
        SpringLaw::Logarithm(Box::new(logarithm(0.3))),
    ] {
        tangent_of(&law, &matrix);
    }
}

fn tangent_of(law: &SpringLaw, k: &Matrix6<f64>) {
    for i in 0..20 {
        let at: [f64; 6] =
            std::array::from_fn(|d| irregular(6 * i + d) * if d < 3 { 0.02 } else { 0.2 });
        let tangent = kernel_tangent(law, &at);
        for column in 0..6 {
            let step = if column < 3 { 1e-6 } else { 1e-5 };
            let (mut more, mut less) = (at, at);
            more[column] += step;
            less[column] -= step;
            let (more, less) = (kernel_torque(law, &more), kernel_torque(law, &less));
            for row in 0..6 {
                let slope = (more[row] - less[row]) / (2.0 * step);
                let own = tangent[row][column];
                let size = (k[(row, row)] * k[(column, column)]).sqrt();
                assert!((slope - own).abs() < 1e-7 * size, "{row} {column}");
            }
        }
    }
}

/// A serial arm with a heavy tool, whose limb holds the platform as limbs of a parallel machine do.
#[test]
fn a_heavy_tool_at_given_joints_does_not_remember_its_neighbours() {
    let light = arm();
    let mut builder = Mechanism::builder("heavy").gravity(light.gravity());
    let tool = builder.platform(Platform {
        mass: 40.0,
        centre_of_mass: Vector3::new(0.02, 0.01, -0.05),
        ..light.platforms()[light.tool()].clone()
    });
    let machine = builder
        .limb(Limb::between(
            "arm",
            0,
            tool,
            light.limbs()[0].nominal.clone(),
        ))
        .build()
        .expect("a machine");
    let batch = Batch::new(&machine);
    let count = 21;
    let commands: Vec<f64> = (0..3 * count).map(|i| 1.5 * irregular(i)).collect();
    let wrenches = wrenches(count);
    let all = batch
        .equilibrium_at_joints(&commands, &wrenches, Details::Rest)
        .expect("sizes");
    for i in 0..count {
        let one = batch
            .equilibrium_at_joints(&commands[3 * i..3 * i + 3], &wrenches[i..=i], Details::Rest)
            .expect("sizes");
        assert_eq!(all.status[i], Status::Vectorised);
        assert!(all.tool.row(i).eq(one.tool.row(0)));
        let scalar = posture_at_joints(&machine, &commands[3 * i..3 * i + 3]);
        let scalar = scalar.deflected_by(&wrenches[i]).expect("an equilibrium");
        let own = all.tool_pose(i).translation.vector;
        assert!((own - scalar.tool.translation.vector).norm() < 1e-11);
    }
}

#[test]
fn what_is_no_number_is_not_found() {
    for machine in [sliders(), arm()] {
        let batch = Batch::new(&machine);
        let home = machine.platforms()[machine.tool()].home;
        let poses = vec![home; 9];
        let mut wrenches = wrenches(9);
        wrenches[2].0[1] = f64::NAN;
        wrenches[5].0[4] = 1e160;
        let found = batch
            .equilibrium(&poses, &wrenches, Details::Rest)
            .expect("sizes");
        assert_ne!(found.status[2], Status::Vectorised);
        assert_ne!(found.status[5], Status::Vectorised);
    }
}

/// Near a stretched arm the way left of a search says little about the joints.
#[test]
fn nearly_stretched_arms_have_the_joints_of_the_general_engine() {
    let mut chain = Chain::builder("arm");
    for (name, axis, length) in [
        ("a", Vector3::z(), 0.4),
        ("b", Vector3::y(), 0.4),
        ("c", Vector3::y(), 0.4),
        ("d", Vector3::x(), 0.05),
        ("e", Vector3::y(), 0.05),
        ("f", Vector3::x(), 0.05),
    ] {
        let drive = ActuatorSpec {
            home: 0.4,
            ..ActuatorSpec::new(MotionKind::Revolute, axis, 2e5)
        };
        chain = chain
            .actuator(name, drive)
            .translation(Vector3::new(length, 0.0, 0.0))
            .spring6(&format!("l{name}"), &(bar() * 20.0), [0.0; 6]);
    }
    let chain = chain.build().expect("an arm");
    let machine = Mechanism::serial(chain, Pose::identity(), Vector3::zeros()).expect("a machine");
    let batch = Batch::new(&machine);
    let base = machine.platforms()[0].home;
    let springs = machine.limbs()[0].nominal.home_coordinates();
    for elbow in [0.3, 1e-2, 1e-3] {
        let joints = [0.3, 0.5, elbow, 0.2, 0.5, 0.3];
        let pose = unloaded_tip(&machine.limbs()[0].nominal, &base, &springs, &joints);
        let found = batch.stiffness(&[pose; 8]);
        let Ok(posture) = machine.posture(&pose) else {
            continue;
        };
        let scalar = posture.stiffness().expect("a stiffness").cartesian.matrix;
        let mut off = Worst::new();
        for (k, x) in found.stiffness.row(0).enumerate() {
            off.apart(x, scalar[(k / 6, k % 6)]);
        }
        let off = off.of(36);
        assert!(
            off < 1e-9 * scalar.largest_entry(),
            "{elbow}: {off} of {}",
            scalar.largest_entry()
        );
    }
}
