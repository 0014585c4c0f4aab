//! Random chains with every kind of element, random loads of every kind, random end conditions,
//! ordinary and extreme sizes, regular and singular postures.

use kinetostat::{
    ActuatorSpec, Anchor, BeamSection, Chain, ChainBuilder, ChainProblem, EndCondition, LengthLaw,
    LinkSpec, Load, MotionKind, NodeLoad, Pose, Prescribed, Result, Twist, Wrench,
    model::{
        FunctionLoad, Kinematics, LengthResponse, LinkConvention, NodeTangent, SpringLaw,
        unloaded_tip,
    },
    spatial::moved,
};
use nalgebra::{DMatrix, Matrix3, Rotation3, Vector3};

use super::random::Random;

/// Sizes of a case.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    /// m.
    pub length: f64,
    /// N/m.
    pub stiffness: f64,
    /// All axes and offsets along the coordinate axes: planar, parallel, straight chains.
    pub aligned: bool,
    /// Spread of the stiffnesses, decades to either side.
    pub spread: f64,
}

impl Sizes {
    pub fn random(random: &mut Random) -> Self {
        let extreme = random.once_in(4);
        let decades = if extreme { 9.0 } else { 0.7 };
        Self {
            length: random.power(-decades, decades),
            stiffness: 1e5_f64.powf(f64::from(u8::from(!extreme)))
                * random.power(-decades, decades),
            aligned: random.once_in(3),
            spread: [0.5, 0.5, 2.0, 6.0][random.below(4)],
        }
    }

    fn linear(&self, random: &mut Random) -> f64 {
        self.stiffness * random.power(-self.spread, self.spread)
    }

    fn angular(&self, random: &mut Random) -> f64 {
        self.linear(random) * self.length * self.length
    }
}

fn axis(random: &mut Random, sizes: &Sizes) -> Vector3<f64> {
    if sizes.aligned {
        [Vector3::x(), Vector3::z(), Vector3::z(), -Vector3::y()][random.below(4)]
    } else {
        random.axis()
    }
}

fn kind(random: &mut Random) -> MotionKind {
    if random.once_in(2) {
        MotionKind::Revolute
    } else {
        MotionKind::Prismatic
    }
}

fn offset(random: &mut Random, sizes: &Sizes) -> Pose {
    match (sizes.aligned, random.below(6)) {
        (_, 0) => Pose::identity(),
        (true, 1) => Pose::rotation(Vector3::z() * std::f64::consts::FRAC_PI_2),
        (true, _) => Pose::translation(sizes.length * random.between(0.2, 1.0), 0.0, 0.0),
        _ => Pose::new(
            random.axis() * (sizes.length * random.between(0.1, 1.0)),
            random.axis() * (3.0 * random.signed()),
        ),
    }
}

fn section(random: &mut Random, sizes: &Sizes, length: f64) -> BeamSection {
    let modulus = sizes.linear(random) / length;
    let slender = length * random.power(-2.5, -0.5);
    BeamSection {
        youngs_modulus: modulus,
        shear_modulus: modulus * random.between(0.3, 0.5),
        area: slender * slender,
        second_moment_y: slender.powi(4) * random.between(0.02, 0.2),
        second_moment_z: slender.powi(4) * random.between(0.02, 0.2),
        torsion_constant: slender.powi(4) * random.between(0.02, 0.2),
    }
}

const CONVENTIONS: [LinkConvention; 6] = [
    LinkConvention::Bowing,
    LinkConvention::TranslationsFirst,
    LinkConvention::RotationsFirst,
    LinkConvention::Middle,
    LinkConvention::Exponential,
    LinkConvention::ConstantStrain,
];

/// One more element; returns the number of coordinates that it brings.
fn element(
    builder: ChainBuilder,
    random: &mut Random,
    sizes: &Sizes,
    k: usize,
    known: &mut Vec<(String, MotionKind)>,
) -> (ChainBuilder, usize) {
    let name = format!("e{k}");
    match random.below(14) {
        0 => {
            let kind = kind(random);
            let axis = axis(random, sizes);
            let (unit, own) = match kind {
                MotionKind::Prismatic => (sizes.length, sizes.linear(random)),
                MotionKind::Revolute => (1.0, sizes.angular(random)),
            };
            let mut spec = ActuatorSpec::new(kind, axis, own);
            spec.rest = 0.2 * unit * random.signed() * f64::from(u8::from(random.once_in(3)));
            spec.home = unit * random.signed();
            if random.once_in(3) {
                spec.stiffness = None;
                return (builder.actuator(&name, spec), 0);
            }
            known.push((name.clone(), kind));
            (builder.actuator(&name, spec), 1)
        }
        1 | 2 => {
            let kind = kind(random);
            let unit = if kind == MotionKind::Prismatic {
                sizes.length
            } else {
                1.0
            };
            let home = unit * random.signed() * f64::from(u8::from(random.once_in(2)));
            known.push((name.clone(), kind));
            let axis = axis(random, sizes);
            let mut b = builder.passive(&name, kind, axis, home);
            if random.once_in(4) {
                // Once more about the same axis: redundant.
                b = b.passive(&format!("{name}r"), kind, axis, 0.0);
                return (b, 2);
            }
            (b, 1)
        }
        3 => {
            let (a, b) = (axis(random, sizes), axis(random, sizes));
            (builder.passive_universal(&name, a, b), 2)
        }
        4 => (builder.passive_spherical(&name), 3),
        5 | 6 => {
            let kind = kind(random);
            let (unit, own) = match kind {
                MotionKind::Prismatic => (sizes.length, sizes.linear(random)),
                MotionKind::Revolute => (1.0, sizes.angular(random)),
            };
            let rest = 0.5 * unit * random.signed() * f64::from(u8::from(random.once_in(3)));
            known.push((name.clone(), kind));
            let axis = axis(random, sizes);
            (builder.spring(&name, kind, axis, own, rest), 1)
        }
        7 => {
            let (linear, angular) = (sizes.linear(random), sizes.angular(random));
            let matrix = random.stiffness(linear, angular);
            let preload = 0.1 * f64::from(u8::from(random.once_in(3)));
            let rest = std::array::from_fn(|i| {
                preload * random.signed() * if i < 3 { sizes.length } else { 1.0 }
            });
            (builder.spring6(&name, &matrix, rest), 6)
        }
        8 => {
            let directions: Vec<usize> = (0..6).filter(|_| random.once_in(2)).collect();
            if directions.is_empty() {
                return (builder, 0);
            }
            let (linear, angular) = (sizes.linear(random), sizes.angular(random));
            let full = random.stiffness(linear, angular);
            let n = directions.len();
            let law = SpringLaw::Linear(DMatrix::from_fn(n, n, |i, j| {
                full[(directions[i], directions[j])]
            }));
            (builder.springs(&name, &directions, law, vec![0.0; n]), n)
        }
        9 | 10 => {
            let length = sizes.length * random.between(0.2, 1.5);
            let section = section(random, sizes, length);
            let spec = if random.once_in(3) {
                LinkSpec::matrix(section.cantilever(length).unwrap(), length)
            } else {
                LinkSpec::beam(section, length)
            };
            let convention = if random.once_in(2) {
                0
            } else {
                random.below(6)
            };
            let segments = 1 + random.below(3);
            let spec = spec.segments(segments).convention(CONVENTIONS[convention]);
            (builder.link_with(&name, &spec), 6 * segments)
        }
        11 => {
            let length = sizes.length * random.between(0.3, 1.0);
            let bar = section(random, sizes, length).cantilever(length).unwrap();
            let width = length * random.between(0.1, 0.5);
            let home = random.signed() * f64::from(u8::from(random.once_in(2)));
            (builder.parallelogram(&name, length, width, &bar, home), 6)
        }
        12 => match known.len() {
            0 => (builder, 0),
            n => {
                let (to, own) = known[random.below(n)].clone();
                let ratio = [-1.0, 1.0, 2.0, -0.3][random.below(4)];
                let (kind, axis) = (kind(random), axis(random, sizes));
                let unit = |kind| match kind {
                    MotionKind::Prismatic => sizes.length,
                    MotionKind::Revolute => 1.0,
                };
                let ratio = ratio * unit(kind) / unit(own);
                (builder.coupled(&to, kind, axis, ratio), 0)
            }
        },
        _ => {
            let mass = sizes.stiffness * sizes.length * random.power(-6.0, -2.0);
            let place = random.vector(0.3 * sizes.length);
            (builder.body(&name, mass, place, Matrix3::identity()), 0)
        }
    }
}

/// A chain of about `size` coordinates.
pub fn chain(random: &mut Random, sizes: &Sizes, size: usize) -> Result<Chain> {
    let mut builder = Chain::builder("random");
    let (mut count, mut known) = (0, Vec::new());
    for k in 0..4 * size + 2 {
        if count >= size {
            break;
        }
        builder = builder.rigid(offset(random, sizes));
        let before = builder.clone();
        let (next, more) = element(builder, random, sizes, k, &mut known);
        if count + more > 40 {
            builder = before;
            known.retain(|(n, _)| *n != format!("e{k}"));
            continue;
        }
        (builder, count) = (next, count + more);
        if random.once_in(3) {
            builder = builder.node(&format!("n{k}"));
        }
    }
    builder.rigid(offset(random, sizes)).build()
}

/// A load of any kind on any nodes.
fn load(random: &mut Random, sizes: &Sizes, chain: &Chain) -> Load {
    let nodes = chain.nodes().len();
    let force = sizes.stiffness * sizes.length * random.power(-5.0, 0.5);
    let (a, b) = (random.below(nodes), random.below(nodes));
    let mut wrench = || {
        let f = random.axis() * force;
        Wrench::new(f, random.axis() * (force * sizes.length))
    };
    let (first, second) = (wrench(), wrench());
    let arm = random.vector(0.3 * sizes.length);
    let gravity = random.axis() * 9.81;
    let node = |node, point| Anchor::Node { node, point };
    let from = match random.below(3) {
        0 => Anchor::Base(random.vector(sizes.length)),
        1 => Anchor::node(a),
        _ => node(a, arm),
    };
    let to = node(b, random.vector(0.2 * sizes.length));
    let own = sizes.stiffness * random.power(-4.0, 0.0);
    let l = sizes.length;
    let law = match random.below(5) {
        0 => LengthLaw::Linear {
            stiffness: own,
            free_length: l * random.between(0.0, 1.0),
            preload: force * random.signed(),
        },
        1 => LengthLaw::Linear {
            stiffness: own,
            free_length: 0.0,
            preload: 0.0,
        },
        2 => LengthLaw::Gas {
            force,
            length: 3.0 * l,
            column: l * random.between(1.0, 5.0),
            exponent: random.between(1.0, 1.4),
        },
        3 => LengthLaw::Constant { tension: force },
        _ => LengthLaw::function(move |x| LengthResponse {
            tension: own * x * x / l,
            slope: 2.0 * own * x / l,
            energy: own * x.powi(3) / (3.0 * l),
        }),
    };
    match random.below(9) {
        0 => Load::dead(a, Wrench::new(first.force(), Vector3::zeros())),
        1 => Load::dead(a, first),
        2 => Load::gravity(gravity),
        3 => Load::follower(a, first),
        4 => Load::point_force(a, arm, first.force()),
        5 => Load::counterweight(a, arm, force / 9.81, gravity),
        6 | 7 => Load::strut(from, to, law),
        _ => {
            let steps = 1e-4 * l;
            Load::function(
                FunctionLoad::new("swirl", vec![a, b], move |poses| {
                    let turn = poses[1].rotation;
                    let place = poses[0].translation.vector / l;
                    let f = turn * first.force() + place.cross(&second.force());
                    vec![
                        Wrench::new(f, turn * second.moment()),
                        Wrench::new(-f, Vector3::zeros()),
                    ]
                })
                .with_steps(steps, 1e-4),
            )
        }
    }
}

/// A problem on a chain.
pub fn problem<'a>(random: &mut Random, sizes: &Sizes, chain: &'a Chain) -> ChainProblem<'a> {
    let mut problem = ChainProblem::new(chain, EndCondition::wrench(Wrench::zero()));
    let unit = |kind| match kind {
        MotionKind::Prismatic => sizes.length,
        MotionKind::Revolute => 1.0,
    };
    if !random.once_in(3) {
        problem.base = Pose::new(
            random.vector(sizes.length),
            random.axis() * random.between(0.0, 3.0),
        );
    }
    let far = [0.0, 0.0, 0.3, 3.0, 10.0][random.below(5)];
    for (x, c) in problem.posture.iter_mut().zip(chain.coordinates()) {
        if c.role == kinetostat::model::Role::Passive {
            *x += far * random.signed() * unit(c.kind);
        }
    }
    for (x, a) in problem.commands.iter_mut().zip(chain.actuators()) {
        *x += 0.5 * random.signed() * unit(a.kind);
    }
    let tip = unloaded_tip(chain, &problem.base, &problem.posture, &problem.commands);
    let span = random.power(-7.0, 0.3) * f64::from(u8::from(!random.once_in(5)));
    let twist = Twist::new(random.axis() * (span * sizes.length), random.axis() * span);
    let mut end = EndCondition::pose(moved(&tip, &twist));
    let force = sizes.stiffness * sizes.length * random.power(-6.0, 0.0);
    match random.below(4) {
        0 => {}
        1 => end.prescribed = [Prescribed::Wrench; 6],
        _ => {
            for p in &mut end.prescribed {
                if random.once_in(2) {
                    *p = Prescribed::Wrench;
                }
            }
        }
    }
    if !random.once_in(3) {
        end.wrench = Wrench::new(
            random.axis() * force,
            random.axis() * (force * sizes.length * random.power(-3.0, 0.0)),
        );
    }
    if random.once_in(2) {
        end.axes = Rotation3::new(random.axis() * random.between(0.0, 3.0));
    }
    problem.end = end;
    for _ in 0..random.below(4) {
        problem.loads.push(load(random, sizes, chain));
    }
    problem
}

/// A description with one mistake; the mistake in words.
pub fn wrong_chain(random: &mut Random, sizes: &Sizes) -> (&'static str, Result<Chain>) {
    let bad = [f64::NAN, f64::INFINITY, 0.0, -1.0][random.below(4)];
    let infinite = [f64::NAN, f64::NEG_INFINITY][random.below(2)];
    let b = Chain::builder("wrong").spring(
        "s",
        kind(random),
        axis(random, sizes),
        sizes.stiffness,
        0.0,
    );
    let x = Vector3::x();
    let (what, builder) = match random.below(11) {
        0 => ("a stiffness", b.spring("t", kind(random), x, bad, 0.0)),
        1 => (
            "an axis",
            b.passive("p", kind(random), Vector3::zeros(), 0.0),
        ),
        2 => ("a name", b.passive("s", kind(random), x, 0.0)),
        3 => ("an offset", b.translation(Vector3::repeat(infinite))),
        4 => {
            let mut matrix = random.stiffness(1.0, 1.0);
            matrix[(1, 2)] += 0.5;
            ("an unsymmetric matrix", b.spring6("k", &matrix, [0.0; 6]))
        }
        5 => {
            let mut matrix = random.stiffness(1.0, 1.0);
            (matrix[(0, 5)], matrix[(5, 0)]) = (9.0, 9.0);
            ("an indefinite matrix", b.spring6("k", &matrix, [0.0; 6]))
        }
        6 => {
            let section = section(random, sizes, sizes.length);
            ("the length of a link", b.link("l", &section, bad))
        }
        7 => {
            let mut section = section(random, sizes, sizes.length);
            section.area = bad;
            ("the area of a section", b.link("l", &section, sizes.length))
        }
        8 => ("a coupling", b.coupled("nobody", kind(random), x, 1.0)),
        9 => {
            let mass = if bad == 0.0 { -2.0 } else { bad };
            ("a mass", b.body("m", mass, x, Matrix3::identity()))
        }
        _ => ("a rest", b.spring("t", kind(random), x, 1.0, infinite)),
    };
    (what, builder.build())
}

/// Spoils one number or length of a problem; what was spoilt, in words.
pub fn spoil(random: &mut Random, problem: &mut ChainProblem<'_>) -> &'static str {
    let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][random.below(3)];
    let nodes = problem.chain.nodes().len();
    match random.below(9) {
        7 => {
            problem.base.translation.vector[random.below(3)] = bad;
            "base"
        }
        8 => {
            let own = problem.end.pose.rotation.into_inner() * bad;
            problem.end.pose.rotation = nalgebra::UnitQuaternion::new_unchecked(own);
            "rotation of the end pose"
        }
        0 if !problem.posture.is_empty() => {
            let i = random.below(problem.posture.len());
            problem.posture[i] = bad;
            "posture"
        }
        1 if !problem.commands.is_empty() => {
            let i = random.below(problem.commands.len());
            problem.commands[i] = bad;
            "command"
        }
        2 => {
            problem.posture.push(0.0);
            "length of the posture"
        }
        3 => {
            problem.end.wrench.0[random.below(6)] = bad;
            "end wrench"
        }
        4 => {
            problem.end.pose.translation.vector[random.below(3)] = bad;
            "end pose"
        }
        5 => {
            let force = Wrench::new(Vector3::repeat(bad), Vector3::zeros());
            problem.loads.push(Load::dead(random.below(nodes), force));
            "load"
        }
        _ => {
            problem.loads.push(Load::dead(nodes, Wrench::zero()));
            "node of a load"
        }
    }
}

/// A load multiplied by a factor.
pub fn scaled(load: &Load, factor: f64) -> Load {
    match load {
        Load::Dead { node, wrench } => Load::dead(*node, *wrench * factor),
        Load::Gravity(gravity) => Load::gravity(gravity * factor),
        Load::Custom(inner) => Load::custom(Scaled {
            inner: inner.clone(),
            factor,
        }),
        _ => load.clone(),
    }
}

#[derive(Debug)]
struct Scaled {
    inner: std::sync::Arc<dyn NodeLoad>,
    factor: f64,
}

impl NodeLoad for Scaled {
    fn wrenches(&self, kinematics: &Kinematics, out: &mut Vec<(usize, Wrench)>) {
        let first = out.len();
        self.inner.wrenches(kinematics, out);
        for (_, wrench) in &mut out[first..] {
            *wrench = *wrench * self.factor;
        }
    }

    fn tangents(&self, kinematics: &Kinematics, out: &mut Vec<NodeTangent>) {
        let first = out.len();
        self.inner.tangents(kinematics, out);
        for tangent in &mut out[first..] {
            tangent.matrix *= self.factor;
        }
    }

    fn energy(&self, kinematics: &Kinematics) -> Option<f64> {
        self.inner.energy(kinematics).map(|e| e * self.factor)
    }

    fn conservative(&self) -> bool {
        self.inner.conservative()
    }

    fn nodes(&self) -> Vec<usize> {
        self.inner.nodes()
    }
}
