//! Masses along links in the kernels, which take them as halves at the ends of segments and what the weight bends these by,
//! against the general engine, which sums up slices.

use kinetostat::batch::{Batch, BatchEquilibrium, Details, Engine, Status};
use kinetostat::internal::InstructionSet;
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, Limb, LinkSpec, Mechanism, MechanismEquilibrium, MotionKind,
    Platform, Pose, Wrench,
    model::{LinkConvention, LinkMass},
    spatial::pose_residual,
};
use kinetostat_testing::{LargestEntry, Worst, largest_size};
use nalgebra::{Matrix6, UnitQuaternion, Vector3};

use super::posture_at_joints;

/// Those whose springs slide before they turn.
pub(super) const CONVENTIONS: [LinkConvention; 5] = [
    LinkConvention::Bowing,
    LinkConvention::Exponential,
    LinkConvention::ConstantStrain,
    LinkConvention::TranslationsFirst,
    LinkConvention::Middle,
];

/// Numbers between -1 and 1 with nothing special about them.
fn irregular(i: usize) -> f64 {
    2.0 * ((i + 1) as f64 * 0.618_033_988_749_895).fract() - 1.0
}

fn vector(i: usize) -> Vector3<f64> {
    Vector3::new(irregular(3 * i), irregular(3 * i + 1), irregular(3 * i + 2))
}

/// A tube that differs in its two bending stiffnesses and gives way to shear, of a material much heavier than steel:
/// weights count in all that is compared.
fn heavy(
    youngs_modulus: f64,
    length: f64,
    segments: usize,
    convention: LinkConvention,
) -> LinkSpec {
    let shear_modulus = youngs_modulus / 2.6;
    let mut bar = BeamSection::tube(youngs_modulus, shear_modulus, 0.08, 0.06);
    bar.second_moment_z *= 1.4;
    let slender = bar.cantilever(length).expect("a bar");
    let mut compliance = slender.try_inverse().expect("a bar");
    for k in [1, 2] {
        compliance[(k, k)] += length / (0.5 * shear_modulus * bar.area);
    }
    let stiffness = compliance.try_inverse().expect("a bar");
    let mass = LinkMass::of_section(&bar, 1e5); // kg/m^3
    let spec = LinkSpec::matrix(stiffness, length).segments(segments);
    spec.convention(convention).with_mass(mass)
}

/// Three sliders with struts between universal joints on feet, all with masses along them, and bodies besides; gravity
/// along no axis.
fn sliders(convention: LinkConvention, segments: usize) -> Mechanism {
    let mut builder = Mechanism::builder("sliders").gravity(Vector3::new(3.0, -4.0, -8.0));
    let tool = builder.platform(Platform {
        mass: 3.0,
        centre_of_mass: Vector3::new(0.01, -0.02, 0.03),
        ..Platform::new("tool", Pose::identity())
    });
    for i in 0..3 {
        let diagonal = Vector3::repeat(1.0).normalize();
        let turned = Pose::rotation(diagonal * (f64::from(i) * std::f64::consts::TAU / 3.0));
        let slide = ActuatorSpec {
            home: -0.53,
            ..ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 2.8e6)
        };
        let leg = Chain::builder(format!("leg {i}"))
            .rigid(turned)
            .actuator("slide", slide)
            .link_with(
                "foot",
                &heavy(2.1e11, 0.1, 1, LinkConvention::TranslationsFirst),
            )
            .body(
                "motor",
                4.0,
                Vector3::new(0.0, 0.03, 0.02),
                nalgebra::Matrix3::zeros(),
            )
            .passive("q1", MotionKind::Revolute, Vector3::z(), 0.0)
            .passive("q2", MotionKind::Revolute, Vector3::y(), 0.0)
            .link_with("strut", &heavy(2.1e11, 0.4, segments, convention))
            .passive("q3", MotionKind::Revolute, Vector3::y(), 0.0)
            .passive("q4", MotionKind::Revolute, Vector3::z(), 0.0)
            .translation(Vector3::new(0.03, 0.0, 0.0))
            .rigid(turned.inverse())
            .build()
            .expect("a leg");
        builder = builder.limb(Limb::between(format!("leg {i}"), 0, tool, leg));
    }
    builder.build().expect("a machine")
}

fn poses(count: usize) -> Vec<Pose> {
    let place = |i: usize| Pose::from_parts((vector(i) * 0.05).into(), UnitQuaternion::identity());
    (0..count).map(place).collect()
}

fn wrenches(count: usize, force: f64) -> Vec<Wrench> {
    let own = |i: usize| Wrench::new(vector(60 + i) * force, vector(80 + i) * (0.06 * force));
    (0..count).map(own).collect()
}

/// An arm of three joints off all axes; its links lie in frames that are turned and shifted.
fn arm(youngs_modulus: f64, convention: LinkConvention, segments: usize) -> Mechanism {
    let mut chain = Chain::builder("arm");
    for k in 0..3 {
        let drive = ActuatorSpec::new(
            MotionKind::Revolute,
            vector(7 + k).normalize(),
            youngs_modulus * 2e-6,
        );
        chain = chain
            .rigid(Pose::new(vector(17 + k) * 0.1, vector(27 + k)))
            .actuator(&format!("j{k}"), drive)
            .link_with(
                &format!("l{k}"),
                &heavy(youngs_modulus, 0.4, segments, convention),
            )
            .body(
                &format!("m{k}"),
                8.0,
                vector(37 + k) * 0.1,
                nalgebra::Matrix3::zeros(),
            );
    }
    let chain = chain.build().expect("an arm");
    let gravity = Vector3::new(1.0, 2.0, -9.0);
    Mechanism::serial(chain, Pose::identity(), gravity).expect("a machine")
}

/// Largest difference as a share of the largest number.
fn share_apart(own: &[f64], other: &[f64]) -> f64 {
    assert_eq!(own.len(), other.len());
    let size = largest_size(other.iter().copied());
    largest_size(own.iter().zip(other).map(|(a, b)| a - b)) / size
}

/// How far coordinates, forces of actuators, stiffness and share to buckling are apart.
fn apart(found: &BatchEquilibrium, i: usize, general: &MechanismEquilibrium) -> [f64; 4] {
    let coordinates: Vec<f64> = found.coordinates.row(i).collect();
    let forces: Vec<f64> = found.actuator_forces.row(i).collect();
    let own = Matrix6::from_fn(|r, c| found.stiffness.get(i, 6 * r + c));
    let matrix = general.stiffness.matrix;
    let stability = found.stability(i).expect("asked for");
    assert_eq!(stability.stable, general.stable(), "{i}");
    let shares = (stability.share_to_buckling, general.share_to_buckling());
    let (Some(a), Some(b)) = shares else {
        panic!("{i}: {shares:?}");
    };
    [
        share_apart(&coordinates, &general.state.coordinates.concat()),
        share_apart(&forces, &general.actuator_forces()),
        (own - matrix).largest_entry() / matrix.largest_entry(),
        (a / b - 1.0).abs(),
    ]
}

fn checked(name: &str, worst: [Worst; 4], count: usize) -> String {
    let worst = worst.map(|w| w.of_all(count));
    let [coordinates, forces, stiffness, share] = worst;
    assert!(coordinates < 1e-9 && forces < 1e-9, "{name}: {worst:?}");
    assert!(stiffness < 1e-10 && share < 1e-9, "{name}: {worst:?}");
    format!("{name}: coordinates, forces, stiffness, share apart by {worst:?}")
}

#[test]
fn heavy_struts_hold_a_platform_as_in_the_general_engine() {
    let count = 9;
    for (k, convention) in CONVENTIONS.into_iter().enumerate() {
        let machine = sliders(convention, 1 + k % 3);
        let batch = Batch::new(&machine);
        assert_eq!(batch.engine(), Engine::Vectorised);
        assert_eq!(batch.engine_unloaded(), Engine::Vectorised);
        let (poses, wrenches) = (poses(count), wrenches(count, 300.0));
        let found = batch
            .equilibrium(&poses, &wrenches, Details::Stability)
            .expect("sizes");
        let mut worst = <[Worst; 4]>::default();
        for i in 0..count {
            assert_eq!(found.status[i], Status::Vectorised, "{convention:?}, {i}");
            let general = machine.posture(&poses[i]).expect("reachable");
            let general = general.deflected_by(&wrenches[i]).expect("an equilibrium");
            for (w, x) in worst.iter_mut().zip(apart(&found, i, &general)) {
                w.add(x);
            }
        }
        println!("{}", checked(&format!("{convention:?}"), worst, count));
    }
}

#[test]
fn heavy_arms_are_as_in_the_general_engine() {
    let count = 9;
    let commands: Vec<f64> = (0..3 * count).map(|i| 1.5 * irregular(i)).collect();
    // Links that give way to their weight by millimetres, and by centimetres, where passes do not contract and kernels have
    // Newton's iteration for springs of constant matrices alone. That of chains, the reference, fails on arms with
    // constant strain.
    let (stiff, soft) = (&[0, 1, 3, 4][..], &[3, 4][..]);
    for (modulus, conventions) in [(2.1e11, stiff), (2.1e10, soft)] {
        for k in conventions.iter().copied() {
            let convention = CONVENTIONS[k];
            let machine = arm(modulus, convention, 1 + k % 3);
            let wrenches = wrenches(count, 800.0);
            let found = Batch::new(&machine)
                .equilibrium_at_joints(&commands, &wrenches, Details::Stability)
                .expect("sizes");
            let (mut worst, mut most) = (<[Worst; 4]>::default(), Worst::new());
            for i in 0..count {
                let place = format!("{modulus:e} {convention:?} {i}");
                let posture = posture_at_joints(&machine, &commands[3 * i..3 * i + 3]);
                let general = posture.deflected_by(&wrenches[i]).expect(&place);
                assert_eq!(found.status[i], Status::Vectorised, "{place}");
                for (w, x) in worst.iter_mut().zip(apart(&found, i, &general)) {
                    w.add(x);
                }
                most.add(largest_size(found.coordinates.row(i)));
            }
            let name = format!("arm {convention:?}, deflected by {:.3}", most.value());
            println!("{}", checked(&name, worst, count));
        }
    }
}

/// Weights under which passes do not contract, beside the forces.
#[test]
fn arms_that_their_links_bend_far_are_solved_vectorised() {
    let count = 16;
    let commands: Vec<f64> = (0..3 * count).map(|i| 1.5 * irregular(i)).collect();
    for convention in [LinkConvention::TranslationsFirst, LinkConvention::Middle] {
        let machine = arm(1.2e9, convention, 2);
        let wrenches = wrenches(count, 30.0);
        let found = Batch::new(&machine)
            .equilibrium_at_joints(&commands, &wrenches, Details::Stiffness)
            .expect("sizes");
        let (mut vectorised, mut far) = (0, 0);
        for i in 0..count {
            let posture = posture_at_joints(&machine, &commands[3 * i..3 * i + 3]);
            let Ok(general) = posture.deflected_by(&wrenches[i]) else {
                assert_eq!(found.status[i], Status::Unsolved);
                continue;
            };
            let own: Vec<f64> = found.coordinates.row(i).collect();
            let off = share_apart(&own, &general.state.coordinates.concat());
            assert!(off < 1e-8, "{convention:?} {i}: {off:e}");
            let matrix = general.stiffness.matrix;
            let own = Matrix6::from_fn(|r, c| found.stiffness.get(i, 6 * r + c));
            let off = (own - matrix).largest_entry() / matrix.largest_entry();
            assert!(off < 1e-8, "{convention:?} {i}: {off:e}");
            if found.status[i] == Status::Vectorised {
                vectorised += 1;
                far += usize::from(largest_size(found.coordinates.row(i)) > 0.12);
            }
        }
        println!("{convention:?}: {vectorised} of {count} vectorised, {far} of them far from rest");
        assert!(vectorised > count / 2 && far > count / 4);
    }
}

/// The stored stiffness by differences of where the tool goes: kernels' equilibria know nothing of their tangent.
#[test]
fn stiffness_under_heavy_links_is_the_difference_of_wrenches() {
    let machine = sliders(LinkConvention::Bowing, 2);
    let (batch, load) = (Batch::new(&machine), wrenches(1, 300.0)[0]);
    let step = |k: usize| if k < 3 { 20.0 } else { 2.0 }; // N, N m
    let mut loads = vec![load];
    for k in 0..6 {
        for sign in [-1.0, 1.0] {
            let mut own = load;
            own.0[k] += sign * step(k);
            loads.push(own);
        }
    }
    let places = vec![poses(3)[2]; loads.len()];
    let found = batch
        .equilibrium(&places, &loads, Details::Stiffness)
        .expect("sizes");
    let stiffness = Matrix6::from_fn(|r, c| found.stiffness.get(0, 6 * r + c));
    let compliance = Matrix6::from_columns(&[0, 1, 2, 3, 4, 5].map(|k| {
        let moved = pose_residual(&found.tool_pose(2 * k + 2), &found.tool_pose(2 * k + 1));
        moved.0 / (2.0 * step(k))
    }));
    let length = 0.5;
    let unit = |k: usize| if k < 3 { 1.0 } else { length };
    let product = stiffness * compliance;
    let scaled = Matrix6::from_fn(|r, c| product[(r, c)] / unit(r) * unit(c));
    let off = (scaled - Matrix6::identity()).largest_entry();
    println!("stiffness times difference is off by {off:.1e}");
    assert!(off < 1e-6, "{off:e}");
}

#[test]
fn heavy_links_have_the_same_bits_on_every_instruction_set() {
    let count = 11;
    let (parallel, serial) = (
        sliders(LinkConvention::Bowing, 2),
        arm(2.1e10, LinkConvention::Middle, 2),
    );
    let commands: Vec<f64> = (0..3 * count).map(|i| 1.5 * irregular(i)).collect();
    let bits = |set: InstructionSet| -> Vec<u64> {
        let wrenches = wrenches(count, 300.0);
        let (a, b) = set.during(|| {
            let (one, other) = (Batch::new(&parallel), Batch::new(&serial));
            (
                one.equilibrium(&poses(count), &wrenches, Details::Stability),
                other.equilibrium_at_joints(&commands, &wrenches, Details::Stability),
            )
        });
        let mut all = Vec::new();
        for found in [a.expect("sizes"), b.expect("sizes")] {
            assert!(found.status.iter().all(|s| *s == Status::Vectorised));
            for table in [
                &found.tool,
                &found.coordinates,
                &found.actuator_forces,
                &found.stiffness,
                &found.stability,
            ] {
                all.extend((0..count).flat_map(|i| table.row(i)).map(f64::to_bits));
            }
        }
        all
    };
    let single = bits(InstructionSet::Single);
    for set in InstructionSet::available() {
        assert!(bits(set) == single, "{set:?}");
    }
}
