//! Platforms in series: those in between move while the tool stays, which brings no singular posture
//! nearer; real ones are found, as far away as a direct search finds them.

use crate::common::Rng;
use crate::graphs::{legs, limb};
use kinetostat::{
    ActuatorSpec, Chain, Mechanism, MotionKind, Platform, Pose, Posture, PostureRequest, Twist,
    machine::SingularityKind, spatial::moved,
};
use kinetostat_testing::least as least_of;
use nalgebra::{Matrix3, RowVector3, Vector2, Vector3, Vector6, vector};

/// Feet and heads of the legs of one planar stage, and its platform seen from the one below.
#[derive(Clone)]
struct Stage {
    legs: Vec<[Vector2<f64>; 2]>,
    at: [f64; 3],
}

fn planar([x, y, turn]: [f64; 3]) -> Pose {
    Pose::new(vector![x, y, 0.0], vector![0.0, 0.0, turn])
}

fn point(pose: &Pose, p: &Vector2<f64>) -> Vector2<f64> {
    let p = pose * nalgebra::Point3::new(p.x, p.y, 0.0);
    Vector2::new(p.x, p.y)
}

impl Stage {
    fn random(rng: &mut Rng) -> Self {
        let mut near =
            |x: f64, y: f64| Vector2::new(x + 0.15 * rng.signed(), y + 0.1 * rng.signed());
        let legs = vec![
            [near(-1.0, 0.0), near(-0.3, 0.0)],
            [near(1.0, 0.0), near(0.3, 0.0)],
            [near(-0.5, 0.0), near(0.3, 0.0)],
        ];
        let at = [
            0.1 * rng.signed(),
            1.0 + 0.1 * rng.signed(),
            0.1 * rng.signed(),
        ];
        Self { legs, at }
    }

    /// Determinant of the lines of the first three legs: zero where they meet in one point or are
    /// parallel. `above` as seen from below.
    fn lines(&self, above: &Pose) -> f64 {
        let rows: Vec<RowVector3<f64>> = (self.legs[..3].iter())
            .map(|[foot, head]| {
                let span = (point(above, head) - foot).normalize();
                RowVector3::new(span.x, span.y, foot.perp(&span))
            })
            .collect();
        Matrix3::from_rows(&rows).determinant()
    }

    /// The same with its platform turned to where the legs meet, and turned on from there.
    fn singular_but_for(&self, turn: f64) -> Option<Self> {
        let at = |t: f64| [self.at[0], self.at[1], t];
        let value = |t: f64| self.lines(&planar(at(t)));
        let grid: Vec<f64> = (-12..=12).map(|k| 0.1 * f64::from(k)).collect();
        let pair = grid.windows(2).find(|w| value(w[0]) * value(w[1]) < 0.0)?;
        let (mut low, mut high) = (pair[0], pair[1]);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            match value(low) * value(middle) > 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        Some(Self {
            legs: self.legs.clone(),
            at: at(low + turn),
        })
    }
}

fn stack(stages: &[Stage]) -> Mechanism {
    let mut builder = Mechanism::builder("stack");
    let mut home = Pose::identity();
    let mut below = 0;
    for (s, stage) in stages.iter().enumerate() {
        let step = planar(stage.at);
        home *= step;
        let above = builder.platform(Platform::new(format!("p{s}"), home));
        for (k, [foot, head]) in stage.legs.iter().enumerate() {
            let span = point(&step, head) - foot;
            let along = span.y.atan2(span.x);
            let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 3e7);
            drive.home = span.norm();
            let name = format!("leg {s}{k}");
            let chain = Chain::builder(&name)
                .rigid(planar([foot.x, foot.y, along]))
                .passive("foot", MotionKind::Revolute, Vector3::z(), 0.0)
                .actuator("drive", drive)
                .passive("head", MotionKind::Revolute, Vector3::z(), 0.0)
                .build()
                .unwrap();
            let tip = planar([head.x, head.y, along - stage.at[2]]);
            builder = builder.limb(limb(&name, below, above, tip, chain));
        }
        below = above;
    }
    builder.build().unwrap()
}

fn at_home(machine: &Mechanism) -> Posture {
    let home = machine.platforms()[machine.tool()].home;
    machine.posture(&home).unwrap()
}

/// The determinants of all stages.
fn lines(stages: &[Stage], posture: &Posture) -> Vec<f64> {
    let places = posture.platforms().windows(2);
    let both = stages.iter().zip(places);
    both.map(|(s, p)| s.lines(&(p[0].inverse() * p[1])))
        .collect()
}

fn natural_length(machine: &Mechanism) -> f64 {
    let limbs = machine.limbs().iter();
    limbs.map(|l| l.actual.scale().length).sum::<f64>() / machine.limbs().len() as f64
}

/// Irregular motions of the tool in the plane, scaled, of size one.
fn motions(length: f64) -> Vec<Vector6<f64>> {
    let mut rng = Rng(5);
    let mut some = || {
        let v = rng.axis();
        Vector6::new(v.x, v.y, 0.0, 0.0, 0.0, v.z / length)
    };
    (0..60).map(|_| some()).collect()
}

/// Whether a stage changes the side of its singular posture, the tool moved by `far` in any way.
fn crossed(machine: &Mechanism, stages: &[Stage], far: f64) -> bool {
    let here = at_home(machine);
    let before = lines(stages, &here);
    let side = |span: &Vector6<f64>| {
        let there = moved(here.target(), &Twist(span * far));
        let Ok(there) = machine.posture(PostureRequest::pose(&there).near(&here)) else {
            return true;
        };
        let after = lines(stages, &there);
        before.iter().zip(after).any(|(a, b)| a * b <= 0.0)
    };
    motions(natural_length(machine)).iter().any(side)
}

#[test]
fn platforms_in_series_are_not_singular_because_they_are_in_series() {
    let mut rng = Rng(11);
    let mut reported = 0;
    for count in [2, 2, 2, 2, 3] {
        for extra in [0, 1] {
            let mut stages: Vec<Stage> = (0..count).map(|_| Stage::random(&mut rng)).collect();
            let fourth = [Vector2::new(0.7, 0.0), Vector2::new(-0.2, 0.0)];
            stages[count - 1].legs.extend(vec![fourth; extra]);
            let machine = stack(&stages);
            let within = 0.05 * natural_length(&machine);
            if crossed(&machine, &stages, 1.5 * within) {
                continue;
            }
            reported += 1;
            let list = at_home(&machine).near_singularities(within).unwrap();
            assert!(list.is_empty(), "{}", list[0].description());
        }
    }
    assert!(
        reported >= 5,
        "{reported} stacks are far from a singular posture"
    );
}

#[test]
fn two_hexapods_in_series_are_far_from_singular() {
    let mut builder = Mechanism::builder("two hexapods");
    let (lower, upper) = (
        Pose::new(vector![0.05, 0.02, 0.6], vector![0.05, -0.04, 0.1]),
        Pose::new(vector![-0.03, 0.04, 0.5], vector![-0.06, 0.03, -0.12]),
    );
    let middle = builder.platform(Platform::new("middle", lower));
    let tool = builder.platform(Platform::new("tool", lower * upper));
    let builder = legs(builder, "lower", 0, middle, 0.6, 0.4, &lower);
    let builder = legs(builder, "upper", middle, tool, 0.4, 0.25, &upper);
    let machine = builder.build().unwrap();
    let within = 0.05 * natural_length(&machine);
    let list = at_home(&machine).near_singularities(within).unwrap();
    assert!(list.is_empty(), "{}", list[0].description());
}

#[test]
fn a_stage_of_a_stack_near_its_singular_posture_is_reported() {
    let mut rng = Rng(23);
    let mut reported = 0;
    for _ in 0..6 {
        let (first, second) = (Stage::random(&mut rng), Stage::random(&mut rng));
        for near in [0.0, 0.003, -0.01] {
            let Some(second) = second.singular_but_for(near) else {
                continue;
            };
            for stages in [
                [first.clone(), second.clone()],
                [second.clone(), first.clone()],
            ] {
                let machine = stack(&stages);
                let length = natural_length(&machine);
                let posture = at_home(&machine);
                let list = posture.near_singularities(0.05 * length).unwrap();
                let found = list.first().expect("a singular posture");
                assert_eq!(
                    found.kind,
                    SingularityKind::Gained,
                    "{}",
                    found.description()
                );
                reported += 1;
                if near == 0.0 {
                    assert_eq!(found.distance_m, 0.0, "{}", found.description());
                    continue;
                }
                assert!(found.followed, "{}", found.description());
                // There the legs of that stage meet.
                let target = moved(posture.target(), &Twist(found.towards.0 * found.distance_m));
                let there = machine
                    .posture(PostureRequest::pose(&target).near(&posture))
                    .unwrap();
                let least = |p: &Posture| {
                    let sizes = lines(&stages, p).into_iter().map(f64::abs);
                    least_of(sizes)
                };
                assert!(
                    least(&there) < 1e-3 * least(&posture),
                    "{:e} {:e}",
                    least(&there),
                    least(&posture)
                );
                // And nowhere much nearer, on any way of the tool.
                let scaled =
                    Vector6::from_fn(|i, _| found.towards.0[i] * if i < 3 { 1.0 } else { length });
                let far = found.distance_m * scaled.norm();
                assert!(!crossed(&machine, &stages, 0.85 * far), "{far}");
            }
        }
    }
    assert!(reported >= 12, "{reported}");
}
