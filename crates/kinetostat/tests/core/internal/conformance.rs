//! One suite for every engine: the same machines, laws and loads, the same answers.
//!
//! Engines are the two algorithms of the chain (dense matrices, sweeps), the general engine of machines, and the
//! vectorised kernels for every instruction set of this computer and for single numbers. An engine answers or refuses;
//! where it answers, every number is compared, and a number that is none fails the comparison.

use kinetostat::batch::{Batch, Details, Status};
use kinetostat::internal::{ChainMethod, InstructionSet, solve_along};
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, ChainBuilder, ChainProblem, EndCondition, Limb, LinkSpec,
    Load, Mechanism, MotionKind, Platform, Pose, PostureRequest, Settings, Wrench,
    machine::LimbPosture,
    model::{BilinearLaw, LinkConvention, SpringLaw, unloaded_tip},
};
use nalgebra::{Matrix6, Vector3};

/// Where a machine comes to rest, and how it is held there.
struct Answer {
    /// Rotation row by row, position (m).
    tool: Vec<f64>,
    coordinates: Vec<f64>,
    stiffness: Vec<f64>,
    stable: bool,
    share_to_buckling: Option<f64>,
}

impl Answer {
    fn of(tool: &Pose, coordinates: &[f64], k: &Matrix6<f64>) -> Self {
        let (r, p) = (tool.rotation.to_rotation_matrix(), tool.translation.vector);
        let number = |i: usize| if i < 9 { r[(i / 3, i % 3)] } else { p[i - 9] };
        Self {
            tool: (0..12).map(number).collect(),
            coordinates: coordinates.to_vec(),
            stiffness: (0..36).map(|i| k[(i / 6, i % 6)]).collect(),
            stable: true,
            share_to_buckling: None,
        }
    }
}

/// A serial machine with its drives commanded to some values, loaded at its tool.
struct Case {
    name: String,
    machine: Mechanism,
    commands: Vec<f64>,
    wrench: Wrench,
}

trait Engine {
    fn name(&self) -> String;
    /// `None`: refused, or there is no equilibrium.
    fn answer(&self, case: &Case) -> Option<Answer>;
}

/// One of the two algorithms of a chain.
struct ChainBy(ChainMethod);

impl Engine for ChainBy {
    fn name(&self) -> String {
        format!("chain by {:?}", self.0)
    }

    fn answer(&self, case: &Case) -> Option<Answer> {
        let limb = &case.machine.limbs()[0];
        let mut problem = ChainProblem::new(&limb.actual, EndCondition::wrench(case.wrench));
        problem.base = case.machine.platforms()[0].home;
        problem.commands.clone_from(&case.commands);
        problem.loads = vec![Load::gravity(case.machine.gravity())];
        let found = solve_along(&problem, &Settings::default(), Some(self.0));
        let (found, method) = found
            .map_err(|e| eprintln!("{}: {:?}: {e}", case.name, self.0))
            .ok()?;
        // Sweeps answer stable states, dense matrices the rest.
        assert!(method == self.0 || !found.stability.stable, "{}", case.name);
        let matrix = &found.stiffness.cartesian.matrix;
        Some(Answer {
            stable: found.stability.stable,
            share_to_buckling: found.stability.share_to_buckling,
            ..Answer::of(&found.tip, &found.coordinates, matrix)
        })
    }
}

/// The general engine of machines.
struct General;

impl Engine for General {
    fn name(&self) -> String {
        "general".into()
    }

    fn answer(&self, case: &Case) -> Option<Answer> {
        let limb = &case.machine.limbs()[0];
        let joints = LimbPosture {
            commands: case.commands.clone(),
            coordinates: limb.nominal.home_coordinates(),
        };
        let base = case.machine.platforms()[0].home;
        let target = unloaded_tip(&limb.nominal, &base, &joints.coordinates, &joints.commands);
        let posture = case
            .machine
            .posture(PostureRequest::joints(&target, vec![joints]));
        let found = posture.ok()?.deflected_by(&case.wrench).ok()?;
        Some(Answer {
            stable: found.stable(),
            share_to_buckling: found.share_to_buckling(),
            ..Answer::of(
                &found.tool,
                &found.state.coordinates[0],
                &found.stiffness.matrix,
            )
        })
    }
}

/// The kernels on one instruction set; refuses what it would leave to the general engine.
struct Kernels(InstructionSet);

impl Engine for Kernels {
    fn name(&self) -> String {
        format!("kernels {:?}", self.0)
    }

    fn answer(&self, case: &Case) -> Option<Answer> {
        let batch = Batch::new(&case.machine);
        let wrenches = std::slice::from_ref(&case.wrench);
        let found = self
            .0
            .during(|| batch.equilibrium_at_joints(&case.commands, wrenches, Details::Stiffness))
            .ok()?;
        (found.status == [Status::Vectorised]).then(|| Answer {
            tool: found.tool.row(0).collect(),
            coordinates: found.coordinates.row(0).collect(),
            stiffness: found.stiffness.row(0).collect(),
            stable: true,
            share_to_buckling: None,
        })
    }
}

fn kernels() -> Vec<Box<dyn Engine>> {
    let boxed = |set| Box::new(Kernels(set)) as Box<dyn Engine>;
    InstructionSet::available().into_iter().map(boxed).collect()
}

/// Largest difference; a number that is none, or a row of another length, fails.
fn apart(place: &str, a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len(), "{place}");
    let mut most = 0.0;
    for (x, y) in a.iter().zip(b) {
        let apart = (x - y).abs();
        assert!(apart.is_finite(), "{place}: {x} {y}");
        if apart > most {
            most = apart;
        }
    }
    most
}

fn agree(place: &str, one: &Answer, other: &Answer) {
    let gone = apart(place, &one.tool, &other.tool);
    assert!(gone < 1e-9, "{place}: the tool is {gone} apart");
    let gone = apart(place, &one.coordinates, &other.coordinates);
    assert!(gone < 1e-9, "{place}: coordinates are {gone} apart");
    let size = apart(place, &one.stiffness, &[0.0; 36]);
    let gone = apart(place, &one.stiffness, &other.stiffness) / size;
    assert!(gone < 1e-7, "{place}: stiffnesses are {gone} apart");
}

/// Numbers between -1 and 1 with nothing special about them.
fn irregular(i: usize) -> f64 {
    2.0 * ((i + 1) as f64 * 0.618_033_988_749_895).fract() - 1.0
}

fn vector(i: usize) -> Vector3<f64> {
    Vector3::new(irregular(3 * i), irregular(3 * i + 1), irregular(3 * i + 2))
}

/// What stands between two joints of an arm: one of each law.
fn member(builder: ChainBuilder, name: &str, law: usize) -> ChainBuilder {
    let bar = BeamSection::tube(2.1e11, 8.1e10, 0.08, 0.06);
    let link = |convention| LinkSpec::beam(bar, 0.4).segments(2).convention(convention);
    match law {
        0 => builder.link_with(name, &link(LinkConvention::Bowing)),
        1 => builder.link_with(name, &link(LinkConvention::Exponential)),
        2 => builder.link_with(name, &link(LinkConvention::ConstantStrain)),
        3 => builder.link_with(name, &link(LinkConvention::TranslationsFirst)),
        4 => builder.link_with(name, &link(LinkConvention::Middle)),
        _ => {
            let knee = SpringLaw::Bilinear(BilinearLaw {
                stiffness: 1e5,
                beyond: if law == 5 { 3e5 } else { 4e4 },
                knee: 4e-4,
            });
            builder
                .spring_with_law(
                    &format!("{name} gear"),
                    MotionKind::Revolute,
                    Vector3::y(),
                    knee,
                    0.0,
                )
                .link_with(name, &link(LinkConvention::Bowing))
        }
    }
}

const LAWS: usize = 7;

/// An arm of three joints off all axes with these laws, some of its masses off its members.
fn arm(laws: [usize; 3], seed: usize) -> Mechanism {
    let mut chain = Chain::builder("arm");
    for (k, law) in laws.into_iter().enumerate() {
        let axis = vector(seed + k).normalize();
        let (name, mass) = (format!("l{k}"), format!("m{k}"));
        chain = chain
            .rigid(Pose::new(
                vector(seed + 10 + k) * 0.1,
                vector(seed + 20 + k),
            ))
            .actuator(
                &format!("j{k}"),
                ActuatorSpec::new(MotionKind::Revolute, axis, 2e5),
            );
        chain = member(chain, &name, law).body(
            &mass,
            8.0,
            vector(seed + 30 + k) * 0.1,
            nalgebra::Matrix3::zeros(),
        );
    }
    let chain = chain.build().expect("an arm");
    let gravity = Vector3::new(1.0, 2.0, -9.0);
    Mechanism::serial(chain, Pose::identity(), gravity).expect("a machine")
}

/// Laws of arms: Newton's iteration of chains fails on arms with constant strain, from small loads on; kernels and the
/// engine of machines find most of them. [`every_law_holds_a_platform_as_in_the_general_engine`] has all laws.
const OF_ARMS: [usize; 6] = [0, 1, 3, 4, 5, 6];

fn cases() -> Vec<Case> {
    let (mut cases, count) = (Vec::new(), OF_ARMS.len());
    for seed in 0..3 * count {
        let laws = [0, 1, 2].map(|k| OF_ARMS[(seed + k * (1 + seed / count)) % count]);
        // From little to enough to bend the arm by centimetres.
        let size = [20.0, 200.0, 800.0][seed % 3];
        cases.push(Case {
            name: format!("arm {seed} of laws {laws:?}, {size} N"),
            machine: arm(laws, 7 * seed),
            commands: (0..3).map(|k| 1.5 * irregular(5 * seed + k)).collect(),
            wrench: Wrench::new(vector(seed + 40) * size, vector(seed + 50) * size * 0.1),
        });
    }
    cases
}

#[test]
fn every_engine_finds_the_same_equilibrium() {
    let kernels = kernels();
    let (dense, sweep) = (ChainBy(ChainMethod::Dense), ChainBy(ChainMethod::Sweep));
    let (mut refused, mut missing) = (0, Vec::new());
    for case in cases() {
        let Some(general) = General.answer(&case) else {
            missing.push(case.name);
            continue;
        };
        for engine in [&dense, &sweep] {
            let place = format!("{}: {}", case.name, engine.name());
            let Some(own) = engine.answer(&case) else {
                missing.push(place);
                continue;
            };
            agree(&place, &own, &general);
            assert_eq!(own.stable, general.stable, "{place}");
            let shares = (own.share_to_buckling, general.share_to_buckling);
            let (Some(a), Some(b)) = shares else {
                panic!("{place}: {shares:?}");
            };
            assert!((a - b).abs() < 1e-7, "{place}: {a} {b}");
        }
        let mut first: Option<Answer> = None;
        for engine in &kernels {
            let place = format!("{}: {}", case.name, engine.name());
            let own = engine.answer(&case);
            if own.is_none() {
                // Left over alike by every instruction set.
                assert!(first.is_none(), "{place}");
                refused += 1;
                continue;
            }
            let own = own.expect(&place);
            agree(&place, &own, &general);
            if let Some(first) = &first {
                let same = |a: &[f64], b: &[f64]| {
                    a.iter()
                        .map(|x| x.to_bits())
                        .eq(b.iter().map(|x| x.to_bits()))
                };
                assert!(same(&own.tool, &first.tool), "{place}");
                assert!(same(&own.coordinates, &first.coordinates), "{place}");
                assert!(same(&own.stiffness, &first.stiffness), "{place}");
            }
            first = Some(own);
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
    // Kernels know all of these laws; a few postures bend beyond their series.
    assert!(refused <= 2 * kernels.len(), "{refused} refused");
    println!("{refused} refused");
}

#[test]
fn no_engine_answers_numbers_that_are_none() {
    let spoilt = |i: usize| {
        let mut case = cases().swap_remove(3);
        match i {
            0 => case.wrench.0[4] = f64::NAN,
            1 => case.wrench.0[1] = f64::INFINITY,
            _ => case.commands[1] = f64::NAN,
        }
        case
    };
    for i in 0..3 {
        let case = spoilt(i);
        for engine in kernels() {
            assert!(engine.answer(&case).is_none(), "{i}: {}", engine.name());
        }
        assert!(General.answer(&case).is_none(), "{i}");
        for method in [ChainMethod::Dense, ChainMethod::Sweep] {
            assert!(ChainBy(method).answer(&case).is_none(), "{i}: {method:?}");
        }
    }
}

/// Kernels leave a machine that is rigid in some direction, or nearly, to the general engine: what comes back is its
/// answer.
#[test]
fn singular_machines_get_the_general_answer() {
    let drive = ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), 2e5);
    for beside in [0.0, 1e-16] {
        let mut chain = Chain::builder("crank").actuator("j", drive.clone());
        if beside > 0.0 {
            chain = chain.spring6(
                "hub",
                &Matrix6::from_diagonal_element(1.0 / beside),
                [0.0; 6],
            );
        }
        let chain = chain
            .translation(Vector3::new(0.5, 0.0, 0.0))
            .build()
            .expect("a crank");
        let machine =
            Mechanism::serial(chain, Pose::identity(), Vector3::zeros()).expect("a machine");
        let case = Case {
            name: format!("crank, {beside}"),
            machine,
            commands: vec![0.3],
            wrench: Wrench::new(Vector3::new(10.0, 20.0, 30.0), Vector3::zeros()),
        };
        let general = General.answer(&case).expect(&case.name);
        let batch = Batch::new(&case.machine);
        let found = batch
            .equilibrium_at_joints(&case.commands, &[case.wrench], Details::Stiffness)
            .expect("sizes");
        assert_ne!(found.status[0], Status::Unsolved, "{}", case.name);
        let tool: Vec<f64> = found.tool.row(0).collect();
        assert!(
            apart(&case.name, &tool, &general.tool) < 1e-9,
            "{}",
            case.name
        );
    }
}

/// Three sliders with struts between universal joints; the struts are one of each law.
fn sliders(law: usize) -> Mechanism {
    let mut builder = Mechanism::builder("sliders").gravity(Vector3::new(0.0, 0.0, -9.81));
    let tool = builder.platform(Platform {
        mass: 3.0,
        centre_of_mass: Vector3::new(0.01, -0.02, 0.03),
        ..Platform::new("tool", Pose::identity())
    });
    for i in 0..3 {
        let diagonal = Vector3::repeat(1.0).normalize();
        let turned = Pose::rotation(diagonal * (f64::from(i) * std::f64::consts::TAU / 3.0));
        let slide = ActuatorSpec {
            home: -0.43,
            ..ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 2.8e6)
        };
        let start = Chain::builder(format!("leg {i}"))
            .rigid(turned)
            .actuator("slide", slide)
            .passive("q1", MotionKind::Revolute, Vector3::z(), 0.0)
            .passive("q2", MotionKind::Revolute, Vector3::y(), 0.0);
        let leg = member(start, "strut", law)
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

#[test]
fn every_law_holds_a_platform_as_in_the_general_engine() {
    for law in 0..LAWS {
        let machine = sliders(law);
        let count = 9;
        let poses: Vec<Pose> = (0..count)
            .map(|i| {
                Pose::from_parts(
                    (vector(i) * 0.05).into(),
                    nalgebra::UnitQuaternion::identity(),
                )
            })
            .collect();
        let wrenches: Vec<Wrench> = (0..count)
            .map(|i| Wrench::new(vector(60 + i) * 300.0, vector(80 + i) * 20.0))
            .collect();
        let found = Batch::new(&machine)
            .equilibrium(&poses, &wrenches, Details::Stability)
            .expect("sizes");
        for i in 0..count {
            let place = format!("law {law}, posture {i}");
            assert_eq!(found.status[i], Status::Vectorised, "{place}");
            let general = machine.posture(&poses[i]).expect(&place);
            let general = general.deflected_by(&wrenches[i]).expect(&place);
            let coordinates = general.state.coordinates.concat();
            let own = Answer {
                tool: found.tool.row(i).collect(),
                coordinates: found.coordinates.row(i).collect(),
                stiffness: found.stiffness.row(i).collect(),
                stable: true,
                share_to_buckling: None,
            };
            agree(
                &place,
                &own,
                &Answer::of(&general.tool, &coordinates, &general.stiffness.matrix),
            );
            let stability = found.stability(i).expect(&place);
            assert_eq!(stability.stable, general.stable(), "{place}");
            let shares = (stability.share_to_buckling, general.share_to_buckling());
            let (Some(a), Some(b)) = shares else {
                panic!("{place}: {shares:?}");
            };
            assert!((a - b).abs() < 1e-7, "{place}: {a} {b}");
        }
    }
}
