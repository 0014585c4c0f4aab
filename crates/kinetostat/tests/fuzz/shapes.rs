//! Machines of several shapes: planar chains of three links from the base to a held tool. Each has one inner freedom, so
//! that its shapes are found by scanning a line, and those of the machine are their product.

use std::f64::consts::{PI, TAU};

use kinetostat::{
    Chain, EndCondition, Limb, Mechanism, MotionKind, Platform, Pose, PostureRequest,
    equilibrium::{FoundEquilibrium, SpreadSettings},
    machine::LimbPosture,
};
use nalgebra::{Vector2, Vector3, vector};

use super::random::Random;

/// Samples of every line.
const SAMPLES: usize = 4000;

/// Three links, hinged at both ends, with springs between them.
#[derive(Clone, Debug)]
pub struct ThreeLinks {
    pub links: [f64; 3],
    /// N m/rad.
    pub stiffness: [f64; 2],
    pub rest: [f64; 2],
    /// From the first hinge to the last one, m.
    pub span: f64,
    /// Of that line in the plane, rad.
    pub direction: f64,
}

/// Where the chain is along its inner freedom.
#[derive(Clone, Copy, Debug)]
struct Bent {
    /// First link to the span, first and second spring, rad.
    angles: [f64; 3],
    /// Change of the energy along the inner freedom.
    slope: f64,
    energy: f64,
}

/// A shape in equilibrium.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    angles: [f64; 3],
    pub energy: f64,
    pub stable: bool,
}

fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

fn cross(a: &Vector2<f64>, b: &Vector2<f64>) -> f64 {
    a.x * b.y - a.y * b.x
}

impl ThreeLinks {
    pub fn random(random: &mut Random) -> Self {
        let links = [(); 3].map(|()| random.between(0.3, 0.7));
        let longest = kinetostat_testing::largest(links.iter().copied());
        let all: f64 = links.iter().sum();
        let least = (2.0 * longest - all).max(0.0) + 0.1 * all;
        Self {
            links,
            stiffness: [(); 2].map(|()| random.power(-0.5, 0.5)),
            rest: match random.below(2) {
                0 => [0.0; 2],
                _ => [(); 2].map(|()| 1.2 * random.signed()),
            },
            span: random.between(least, 0.97 * all),
            direction: PI * random.signed(),
        }
    }

    fn bent(&self, first: f64, last: f64) -> Bent {
        let [l1, l2, l3] = self.links;
        let end = vector![self.span, 0.0];
        let v = end - l1 * vector![first.cos(), first.sin()];
        let second = v.y.atan2(v.x) - (l3 * last.sin()).atan2(l2 + l3 * last.cos());
        let w = v - l2 * vector![second.cos(), second.sin()];
        let angles = [first, wrapped(second - first), last];
        let strains = [angles[1] - self.rest[0], angles[2] - self.rest[1]];
        let torques = [0, 1].map(|i| self.stiffness[i] * strains[i]);
        Bent {
            angles,
            // The end stands still: da u + dt1 v + dt2 w = 0 for the arms of the three joints.
            slope: torques[1] * cross(&end, &v) - torques[0] * cross(&end, &w),
            energy: 0.5 * (torques[0] * strains[0] + torques[1] * strains[1]),
        }
    }

    /// The chain by the angle of its first link and the side of its last joint.
    fn by_first(&self, side: f64, first: f64) -> Option<Bent> {
        let [l1, l2, l3] = self.links;
        let left = vector![self.span - l1 * first.cos(), -l1 * first.sin()];
        let cosine = (left.norm_squared() - l2 * l2 - l3 * l3) / (2.0 * l2 * l3);
        (cosine.abs() < 1.0).then(|| self.bent(first, side * cosine.acos()))
    }

    /// The chain by the angle of its last spring and the side of its first link.
    fn by_last(&self, side: f64, last: f64) -> Option<Bent> {
        let [l1, l2, l3] = self.links;
        let strut = (l2 * l2 + l3 * l3 + 2.0 * l2 * l3 * last.cos()).sqrt();
        let cosine = (l1 * l1 + self.span.powi(2) - strut * strut) / (2.0 * l1 * self.span);
        (cosine.abs() < 1.0).then(|| self.bent(side * cosine.acos(), last))
    }

    /// All shapes with springs within half a turn; `None` if two nearly coincide or one is nearly out of these bounds.
    pub fn shapes(&self) -> Option<Vec<Shape>> {
        let mut list: Vec<Shape> = Vec::new();
        let ways: [&dyn Fn(f64, f64) -> Option<Bent>; 2] =
            [&|side, x| self.by_first(side, x), &|side, x| {
                self.by_last(side, x)
            }];
        for (way, side) in ways.iter().flat_map(|way| [(way, 1.0), (way, -1.0)]) {
            let at = |x: f64| way(side, x);
            let step = TAU / SAMPLES as f64;
            for i in 0..SAMPLES {
                let (mut low, mut high) = (step * i as f64 - PI, step * (i + 1) as f64 - PI);
                let (Some(a), Some(b)) = (at(low), at(high)) else {
                    continue;
                };
                // A spring is not turned over from half a turn to minus half a turn.
                if a.slope * b.slope > 0.0 || (a.angles[1] - b.angles[1]).abs() > PI {
                    continue;
                }
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    match at(middle)?.slope * a.slope > 0.0 {
                        true => low = middle,
                        false => high = middle,
                    }
                }
                let (x, h) = (0.5 * (low + high), 1e-4);
                let (Some(here), Some(before), Some(after)) = (at(x), at(x - h), at(x + h)) else {
                    // Next to where this way turns back; the other way has it.
                    continue;
                };
                let second = (before.energy + after.energy - 2.0 * here.energy) / (h * h);
                let twice = list.iter().any(|own| {
                    let apart = own.angles.iter().zip(&here.angles);
                    kinetostat_testing::largest_size(apart.map(|(a, b)| wrapped(a - b))) < 1e-6
                });
                if twice {
                    continue;
                }
                let near_bounds = here.angles[1..].iter().any(|x| x.abs() > PI - 0.05);
                if second.abs() < 0.02 || near_bounds {
                    return None;
                }
                list.push(Shape {
                    angles: here.angles,
                    energy: here.energy,
                    stable: second > 0.0,
                });
            }
        }
        Some(list)
    }

    /// The chain from its own foot to a tool at the origin.
    fn chain(&self, name: &str) -> Chain {
        let z = Vector3::z();
        let along = |length: f64| vector![length, 0.0, 0.0];
        let foot = -self.span * vector![self.direction.cos(), self.direction.sin(), 0.0];
        Chain::builder(name)
            .translation(foot)
            .passive("q", MotionKind::Revolute, z, self.direction)
            .translation(along(self.links[0]))
            .node("first joint")
            .spring(
                "t1",
                MotionKind::Revolute,
                z,
                self.stiffness[0],
                self.rest[0],
            )
            .translation(along(self.links[1]))
            .node("second joint")
            .spring(
                "t2",
                MotionKind::Revolute,
                z,
                self.stiffness[1],
                self.rest[1],
            )
            .translation(along(self.links[2]))
            .passive("e", MotionKind::Revolute, z, 0.0)
            .build()
            .expect("a chain")
    }
}

/// A machine of such chains with its tool where their last hinges meet, and their joints with all links in line.
pub fn machine_of(limbs: &[ThreeLinks]) -> (Mechanism, Vec<LimbPosture>) {
    let mut builder = Mechanism::builder("several shapes");
    let tool = builder.platform(Platform::new("tool", Pose::identity()));
    let mut joints = Vec::new();
    for (i, limb) in limbs.iter().enumerate() {
        let name = format!("limb {i}");
        let chain = limb.chain(&name);
        joints.push(LimbPosture {
            commands: Vec::new(),
            coordinates: chain.home_coordinates(),
        });
        builder = builder.limb(Limb::between(&name, 0, tool, chain));
    }
    (builder.build().expect("a machine"), joints)
}

/// A machine of such chains, their tool held where the last hinges meet: every combination of their shapes and no other is
/// an equilibrium.
pub fn check(limbs: &[ThreeLinks]) -> Option<usize> {
    let own: Vec<Vec<Shape>> = limbs
        .iter()
        .map(ThreeLinks::shapes)
        .collect::<Option<_>>()?;
    let (machine, joints) = machine_of(limbs);
    let at = Pose::identity();
    let posture = machine.posture(PostureRequest::joints(&at, joints));
    let all = posture
        .expect("a posture")
        .equilibria(&EndCondition::pose(at), &SpreadSettings::default())
        .expect("an answer");
    let numbers: Vec<_> = own
        .iter()
        .map(|list| (list.len(), list.iter().filter(|s| s.stable).count()))
        .collect();
    let found: Vec<_> = all.limbs.iter().map(|l| (l.shapes, l.stable)).collect();
    assert_eq!(found, numbers, "shapes and stable ones of {limbs:?}");
    let count: usize = numbers.iter().map(|(all, _)| all).product();
    assert_eq!(all.count(), count, "{limbs:?}");
    assert_eq!(
        all.stable_count(),
        numbers.iter().map(|(_, stable)| stable).product::<usize>()
    );
    assert!(!all.incomplete && all.found.len() == count.min(1000));
    let mut energies = own.iter().fold(vec![0.0], |sums, list| {
        let each = sums
            .iter()
            .flat_map(|sum| list.iter().map(move |s| sum + s.energy));
        each.collect()
    });
    energies.sort_by(f64::total_cmp);
    for (found, energy) in all.found.iter().map(FoundEquilibrium::energy).zip(energies) {
        assert!(
            (found - energy).abs() < 1e-6 * (1.0 + energy),
            "{found} is not {energy} J"
        );
    }
    Some(count)
}

pub fn case(random: &mut Random) {
    let count = 2 + random.below(3);
    let limbs: Vec<_> = (0..count).map(|_| ThreeLinks::random(random)).collect();
    check(&limbs);
}
