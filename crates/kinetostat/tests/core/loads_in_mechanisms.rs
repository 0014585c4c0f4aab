//! Loads on the limbs of mechanisms: one limb is its chain, a chain cut at a platform is the chain
//! (so the reaction on a moving base and its derivative are right), the wrench that holds a tool is
//! the derivative of the energy, and links that bow do so in closed loops.

use crate::common::{Rng, block_error, cases, scaled_error};
use kinetostat::{
    ActuatorSpec, Anchor, BeamSection, Chain, ChainBuilder, ChainProblem, EndCondition, Error,
    LengthLaw, Limb, LinkSpec, Load, Mechanism, MechanismEquilibrium, MotionKind, Platform, Pose,
    Posture, PostureRequest, Settings, Twist, Wrench,
    chain::{is_conservative, load_energy},
    machine::LimbPosture,
    model::FunctionLoad,
    solve_chain,
    spatial::{moved, pose_residual},
};
use kinetostat_testing::{LargestEntry, largest_size};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6, vector};
use proptest::prelude::*;

const GRAVITY: Vector3<f64> = Vector3::new(1.3, -2.1, -9.4);

/// Numbers of a piece of a chain: an elastic drive, a spring with a full matrix, a node, a mass.
struct Piece {
    offsets: [Pose; 3],
    axis: Vector3<f64>,
    matrix: Matrix6<f64>,
    mass: f64,
    centre: Vector3<f64>,
}

impl Piece {
    fn new(rng: &mut Rng) -> Self {
        Self {
            offsets: std::array::from_fn(|_| rng.pose(0.4, 1.0)),
            axis: rng.axis(),
            matrix: rng.spring_matrix(2e5, 4e3),
            mass: rng.between(1.0, 8.0),
            centre: rng.vector(0.15),
        }
    }

    fn add(&self, builder: ChainBuilder, tag: &str) -> ChainBuilder {
        builder
            .rigid(self.offsets[0])
            .actuator(
                &format!("{tag} drive"),
                ActuatorSpec::new(MotionKind::Revolute, self.axis, 4e3),
            )
            .rigid(self.offsets[1])
            .spring6(&format!("{tag} link"), &self.matrix, [0.0; 6])
            .node(&format!("{tag} node"))
            .rigid(self.offsets[2])
            .body(
                &format!("{tag} mass"),
                self.mass,
                self.centre,
                Matrix3::identity(),
            )
    }
}

/// A load of every kind on two nodes; those without a potential only if asked for.
fn every_kind(seed: u64, a: usize, b: usize, all: bool) -> Vec<Load> {
    let mut rng = Rng(seed);
    let mut anchor = |node: usize| Anchor::Node {
        node,
        point: rng.vector(0.1),
    };
    let (from, to) = (anchor(a), anchor(b));
    let ground = Anchor::Base(vector![0.9, -0.7, 0.8] + rng.vector(0.1));
    let gas = LengthLaw::Gas {
        force: 150.0,
        length: 4.0,
        column: 6.0,
        exponent: 1.25,
    };
    let linear = LengthLaw::Linear {
        stiffness: 2e3,
        free_length: 0.4,
        preload: 30.0,
    };
    let mut loads = vec![
        Load::dead(a, Wrench::new(rng.vector(80.0), Vector3::zeros())),
        Load::counterweight(b, rng.vector(0.3), 6.0, GRAVITY),
        Load::strut(from, to, linear),
        Load::spring_between(ground, from, 2e3, 0.5),
        Load::strut(to, ground, gas),
        Load::constant_tension(ground, to, 70.0),
    ];
    if all {
        loads.push(Load::follower(b, rng.wrench(60.0, 6.0)));
        loads.push(Load::dead(a, rng.wrench(20.0, 5.0)));
        let (pull, home) = (rng.vector(60.0), rng.vector(0.5));
        loads.push(Load::function(FunctionLoad::new(
            "wind",
            vec![b],
            move |poses| {
                let away = poses[0].translation.vector - home;
                vec![Wrench::new(pull * away.norm_squared(), away.cross(&pull))]
            },
        )));
    }
    loads
}

fn limb(name: &str, from: usize, to: usize, tip: Pose, chain: &Chain) -> Limb {
    Limb::between(name, from, to, chain.clone()).fixed_at(tip)
}

fn home(chain: &Chain, base: &Pose) -> Pose {
    kinetostat::model::unloaded_tip(
        chain,
        base,
        &chain.home_coordinates(),
        &chain.home_commands(),
    )
}

/// Commanded as at home, whatever hangs on what.
fn at_home(machine: &Mechanism) -> Posture {
    let joints = machine.limbs().iter().map(|l| LimbPosture {
        commands: l.nominal.home_commands(),
        coordinates: l.nominal.home_coordinates(),
    });
    let tool = machine.platforms()[machine.tool()].home;
    machine
        .posture(PostureRequest::joints(&tool, joints.collect()))
        .unwrap()
}

fn same(what: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let size = largest_size(expected.iter().copied());
    for (f, e) in found.iter().zip(expected) {
        let off = (f - e).abs();
        assert!(off <= tolerance * size, "{what}: {found:?} {expected:?}");
    }
}

/// The chain with the same loads as a machine's limbs, and what the machine says.
fn compare(label: &str, machine: &Mechanism, chain: &Chain, loads: &[Load], wrench: &Wrench) {
    let tight = Settings::default().with_torque(1e-13);
    let posture = at_home(machine).with_settings(tight);
    let e = posture
        .deflected_by(wrench)
        .unwrap_or_else(|x| panic!("{label}: {x}"));
    let mut problem = ChainProblem::new(chain, EndCondition::wrench(*wrench));
    problem.loads = loads.to_vec();
    problem.loads.push(Load::gravity(GRAVITY));
    let alone = solve_chain(&problem, &tight).unwrap_or_else(|x| panic!("{label}: {x}"));

    let apart = pose_residual(&e.tool, &alone.tip).0.largest_entry();
    assert!(apart < 1e-10, "{label}: tool {apart:e}");
    let coordinates: Vec<f64> = e.state.coordinates.concat();
    same("coordinates", &coordinates, &alone.coordinates, 1e-10);
    let torques: Vec<f64> = e
        .limbs
        .iter()
        .flat_map(|l| l.spring_torques.clone())
        .collect();
    same("torques", &torques, &alone.spring_torques, 1e-10);
    let k = alone.stiffness.cartesian.matrix;
    let off = scaled_error(&e.stiffness.matrix, &k);
    assert!(off < 1e-9, "{label}: stiffness {off:e}");
    assert_eq!(e.conservative, is_conservative(&problem), "{label}");
    problem.end = EndCondition::pose(alone.tip);
    let potential = load_energy(&problem, &alone.coordinates).unwrap();
    let expected = potential.map(|v| v + alone.energy);
    assert_eq!(e.energy.is_some(), expected.is_some(), "{label}");
    if let (Some(found), Some(expected)) = (e.energy, expected) {
        let size = alone.energy + found.abs();
        assert!((found - expected).abs() < 1e-10 * size, "{label}: energy");
    }
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn one_limb_with_loads_is_its_chain(seed in any::<u64>(), all in any::<bool>()) {
        let mut rng = Rng(seed);
        let pieces = [Piece::new(&mut rng), Piece::new(&mut rng)];
        let chain = pieces[1].add(pieces[0].add(Chain::builder("arm"), "1"), "2").build().unwrap();
        let node = |name: &str| chain.node(name).unwrap();
        let mut loads = every_kind(seed, node("1 node"), node("2 mass"), all);
        loads.extend(every_kind(seed + 1, chain.tip(), node("1 mass"), all));
        let mut builder = Mechanism::builder("one").gravity(GRAVITY);
        let tool = builder.platform(Platform::new("tool", home(&chain, &Pose::identity())));
        builder = builder.limb(limb("arm", 0, tool, Pose::identity(), &chain));
        for load in &loads {
            builder = builder.load("arm", load.clone());
        }
        let machine = builder.build().unwrap();
        prop_assert_eq!(machine.loads(0), loads.as_slice());
        compare("one limb", &machine, &chain, &loads, &rng.wrench(100.0, 8.0));
    }

    #[test]
    fn a_chain_cut_at_a_platform_is_the_chain(seed in any::<u64>(), all in any::<bool>()) {
        let mut rng = Rng(seed);
        let pieces = [Piece::new(&mut rng), Piece::new(&mut rng)];
        let join = rng.pose(0.3, 1.0);
        let first = pieces[0].add(Chain::builder("1"), "1").build().unwrap();
        // Its first node stands on the platform, before anything moves.
        let second = Chain::builder("2").rigid(join.inverse()).node("2 foot");
        let second = pieces[1].add(second, "2").build().unwrap();
        let whole = pieces[0].add(Chain::builder("whole"), "1").node("2 foot");
        let whole = pieces[1].add(whole, "2").build().unwrap();

        let mut builder = Mechanism::builder("two").gravity(GRAVITY);
        let middle_home = home(&first, &Pose::identity()) * join;
        let middle = builder.platform(Platform::new("middle", middle_home));
        let tool = builder.platform(Platform::new("tool", home(&second, &middle_home)));
        builder = builder
            .limb(limb("first", 0, middle, join.inverse(), &first))
            .limb(limb("second", middle, tool, Pose::identity(), &second));
        let mut on_whole = Vec::new();
        for (k, (name, chain, a, b)) in [
            ("first", &first, "1 node", "1 mass"),
            ("second", &second, "2 node", "2 mass"),
            ("second", &second, "2 foot", "tip"),
        ].into_iter().enumerate() {
            let own = |c: &Chain| every_kind(
                seed.wrapping_add(k as u64),
                c.node(a).unwrap(),
                c.node(b).unwrap(),
                all,
            );
            on_whole.extend(own(&whole));
            for load in own(chain) {
                builder = builder.load(name, load);
            }
        }
        let machine = builder.build().unwrap();
        compare("cut", &machine, &whole, &on_whole, &rng.wrench(100.0, 8.0));
    }
}

/// A platform on two arms, a second one hanging between it and the base, loads on all three limbs.
fn hybrid(seed: u64, all: bool) -> Mechanism {
    let mut rng = Rng(seed);
    let middle_home = rng.pose(0.5, 0.5);
    let tool_home = middle_home * rng.pose(0.5, 0.5);
    let mut builder = Mechanism::builder("hybrid").gravity(GRAVITY);
    let mut platform = Platform::new("middle", middle_home);
    (platform.mass, platform.centre_of_mass) = (7.0, rng.vector(0.1));
    let middle = builder.platform(platform);
    let mut platform = Platform::new("tool", tool_home);
    (platform.mass, platform.centre_of_mass) = (4.0, rng.vector(0.1));
    let tool = builder.platform(platform);
    for (name, from, to) in [("a", 0, middle), ("b", middle, tool), ("c", 0, tool)] {
        let homes = [Pose::identity(), middle_home, tool_home];
        let piece = Piece::new(&mut rng);
        let chain = piece.add(Chain::builder(name), name).build().unwrap();
        // The tip sits wherever the chain ends.
        let tip = homes[to].inverse() * home(&chain, &homes[from]);
        let node = |what: &str| chain.node(&format!("{name} {what}")).unwrap();
        let loads = every_kind(rng.next(), node("node"), node("mass"), all);
        builder = builder.limb(limb(name, from, to, tip, &chain));
        for load in loads {
            builder = builder.load(name, load);
        }
    }
    builder.build().unwrap()
}

/// Held at a small twist from a pose.
fn held(posture: &Posture, pose: &Pose, axis: usize, size: f64) -> MechanismEquilibrium {
    let mut twist = Twist::zero();
    twist.0[axis] = size;
    posture.wrench_at(&moved(pose, &twist)).unwrap()
}

/// Fourth-order differences over motions of the held tool: energy, and wrench (6 x 6).
fn by_differences(posture: &Posture, pose: &Pose, step: f64) -> (Vector6<f64>, Matrix6<f64>) {
    let (mut energy, mut stiffness) = (Vector6::zeros(), Matrix6::zeros());
    for k in 0..6 {
        let at = |share: f64| held(posture, pose, k, share * step);
        let [a, b, c, d] = [at(1.0), at(-1.0), at(2.0), at(-2.0)];
        let value = |e: &MechanismEquilibrium| e.energy.unwrap_or(f64::NAN);
        energy[k] = (8.0 * (value(&a) - value(&b)) - (value(&c) - value(&d))) / (12.0 * step);
        let change = 8.0 * (a.wrench.0 - b.wrench.0) - (c.wrench.0 - d.wrench.0);
        stiffness.set_column(k, &(change / (12.0 * step)));
    }
    (energy, stiffness)
}

#[test]
fn the_wrench_that_holds_a_loaded_machine_is_the_derivative_of_its_energy() {
    for seed in 0..6 {
        let machine = hybrid(seed, false);
        let posture = at_home(&machine);
        let pose = moved(
            &machine.platforms()[2].home,
            &Twist::new(vector![2e-3, -1e-3, 1e-3], vector![2e-3, 1e-3, -3e-3]),
        );
        let here = posture.wrench_at(&pose).unwrap();
        assert!(here.conservative);
        let (gradient, _) = by_differences(&posture, &pose, 2e-3);
        let off = (gradient - here.wrench.0).largest_entry() / here.wrench.0.largest_entry();
        assert!(off < 1e-7, "{seed}: {off:e}\n{gradient}\n{:?}", here.wrench);
    }
}

#[test]
fn the_stiffness_of_a_loaded_machine_is_the_derivative_of_its_wrench() {
    for seed in 0..6 {
        let machine = hybrid(seed, true);
        let posture = at_home(&machine);
        let here = posture.deflected_by(&Wrench::zero()).unwrap();
        assert!(!here.conservative && here.energy.is_none());
        assert!(
            here.limbs
                .iter()
                .all(|l| !l.conservative && l.load_energy.is_none())
        );
        let (_, found) = by_differences(&posture, &here.tool, 1e-3);
        let off = block_error(&here.stiffness.matrix, &found);
        assert!(off < 1e-7, "{seed}: {off:e}");
    }
}

/// A 3-PUU whose struts bow, in segments.
fn bowing_puu(segments: usize) -> Mechanism {
    let bar = BeamSection::tube(2.1e11, 8.1e10, 0.008, 0.006);
    let third = 2.0 * std::f64::consts::FRAC_PI_3;
    let mut machine = Mechanism::builder("3-PUU");
    let tool = machine.platform(Platform::new("tool", Pose::identity()));
    for (name, turns) in [("x", 0.0), ("y", 1.0), ("z", 2.0)] {
        let turned = Pose::rotation(Vector3::repeat(1.0).normalize() * (third * turns));
        let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 2.8e6);
        drive.home = -0.54;
        let chain = Chain::builder(name)
            .rigid(turned)
            .actuator("drive", drive)
            .passive_universal("foot joint", Vector3::z(), Vector3::y())
            .link_with("bar", &LinkSpec::beam(bar, 0.51).segments(segments))
            .passive_universal("head joint", Vector3::y(), Vector3::z())
            .translation(vector![0.03, 0.0, 0.0])
            .rigid(turned.inverse())
            .build()
            .unwrap();
        machine = machine.limb(limb(name, 0, tool, Pose::identity(), &chain));
    }
    machine.build().unwrap()
}

#[test]
fn links_bow_in_closed_loops() {
    for segments in [1, 3] {
        let machine = bowing_puu(segments);
        let posture = machine
            .posture(&Pose::translation(0.02, -0.01, 0.03))
            .unwrap();
        let pull = Wrench::new(vector![-500.0, 80.0, -150.0], vector![0.3, -0.5, 0.4]);
        let e = posture.deflected_by(&pull).unwrap();
        assert!(e.residual.iterations <= 12, "{:?}", e.residual);
        assert!(e.platform.stable);
        // The strut of the pressed leg carries a good share of its Euler load.
        let pressed = &e.limbs[0].link_loads[0];
        assert!((0.1..1.0).contains(&pressed.share), "{pressed:?}");
        let (gradient, stiffness) = by_differences(&posture, &e.tool, 1e-5);
        let unit = |i: usize| if i < 3 { 1.0 } else { 0.3 };
        let size = largest_size((0..6).map(|i| pull.0[i] / unit(i)));
        for i in 0..6 {
            let off = (gradient[i] - pull.0[i]).abs() / unit(i);
            assert!(off < 1e-6 * size, "{segments}: {i} {off:e}");
        }
        let off = scaled_error(&e.stiffness.matrix, &stiffness);
        assert!(off < 1e-6, "{segments}: stiffness {off:e}");
    }
}

/// A machine without drives stands at home and nowhere else.
#[test]
fn a_machine_with_platforms_in_between_is_commanded_at_home() {
    let machine = hybrid(3, false);
    let home = machine.platforms()[2].home;
    let posture = machine.posture(&home).unwrap();
    for (found, limb) in posture.limbs().iter().zip(machine.limbs()) {
        for (a, b) in found.commands.iter().zip(limb.nominal.home_commands()) {
            assert!((a - b).abs() < 1e-9);
        }
    }
    let e = posture.deflected_by(&Wrench::zero()).unwrap();
    let by_joints = at_home(&machine).deflected_by(&Wrench::zero()).unwrap();
    assert!(pose_residual(&e.tool, &by_joints.tool).0.largest_entry() < 1e-9);
    // Newton: the last correction is a small share of the one before.
    assert!(e.residual.rate.unwrap() < 1e-2, "{:?}", e.residual);
    let elsewhere = home * Pose::translation(0.01, 0.0, 0.0);
    let error = machine.posture(&elsewhere).unwrap_err().to_string();
    assert!(error.contains("cannot be reached"), "{error}");
}

#[test]
fn loads_that_do_not_fit_say_why() {
    let chain = Piece::new(&mut Rng(1))
        .add(Chain::builder("arm"), "1")
        .build()
        .unwrap();
    let build = |limb_name: &str, load: Load| {
        let mut builder = Mechanism::builder("one");
        let tool = builder.platform(Platform::new("tool", Pose::identity()));
        builder
            .limb(limb("arm", 0, tool, Pose::identity(), &chain))
            .load(limb_name, load)
            .build()
    };
    let good = Load::dead(0, Wrench::zero());
    assert!(build("arm", good.clone()).is_ok());
    assert!(matches!(build("leg", good), Err(Error::UnknownName { .. })));
    for (load, reason) in [
        (Load::dead(9, Wrench::zero()), "node 9"),
        (Load::gravity(GRAVITY), "gravity"),
        (
            Load::dead(
                0,
                Wrench::new(vector![f64::NAN, 0.0, 0.0], Vector3::zeros()),
            ),
            "finite",
        ),
        (
            Load::spring_between(Anchor::node(0), Anchor::node(1), 1.0, -1.0),
            "not below zero",
        ),
    ] {
        let error = build("arm", load).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
    // Written to a file it would lose its loads.
    let machine = build("arm", Load::dead(0, Wrench::zero())).unwrap();
    assert!(serde_json::to_string(&machine).is_err());
}
