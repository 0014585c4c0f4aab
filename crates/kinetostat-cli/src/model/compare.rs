//! `kinetostat model compare`: which constant offsets make one model the other.

use std::path::Path;

use kinetostat::{Mechanism, MotionKind, Pose, Role, shift_matrix, turn_matrix, unloaded_tip};
use kinetostat_model::Model;
use serde::Serialize;

use crate::files::input::Files;
use crate::machine::units::unit;
use crate::model::compare_fit::{Fit, Mapping, Side};
use crate::place::joints::{self, JointValue};
use crate::ui::failure::{Answer, Failure};
use crate::ui::json;
use crate::ui::layout::{self, columns, item, wrapped};
use crate::ui::numbers::{fixed, number, short, triple};
use crate::ui::screen::{self, Stream};

/// Below this share of the machine's size two models are the same.
const SAME: f64 = 1e-7;

/// The answer, stable names with units.
#[derive(Serialize)]
struct Comparison {
    schema: u32,
    kinetostat_version: &'static str,
    a: String,
    b: String,
    /// The same machine but for constant offsets.
    same: bool,
    /// Joints of A and what they are in B: `b = sign * a + offset`.
    joints: Vec<JointMap>,
    /// Base of B in the base of A.
    base: FrameMap,
    /// Tool of A in the tool of B.
    tool: FrameMap,
    /// Largest differences that are left over all postures tried.
    left_mm: f64,
    left_deg: f64,
    postures: usize,
    /// Joints of A where the stiffnesses are compared; empty where a model is rigid or free.
    stiffness_at: Vec<JointValue>,
    /// Against a force, the tool free to turn, softest first.
    stiffness_a_n_per_mm: Option<[f64; 3]>,
    stiffness_b_n_per_mm: Option<[f64; 3]>,
}

#[derive(Serialize)]
struct JointMap {
    a: String,
    b: String,
    reversed: bool,
    offset: f64,
    unit: &'static str,
}

#[derive(Serialize)]
struct FrameMap {
    position_mm: [f64; 3],
    rotation_vector_deg: [f64; 3],
}

impl FrameMap {
    fn new(pose: &Pose) -> Self {
        let clean = |x: f64| if x.abs() < 1e-9 { 0.0 } else { x };
        Self {
            position_mm: (pose.translation.vector * 1e3).map(clean).into(),
            rotation_vector_deg: pose
                .rotation
                .scaled_axis()
                .map(f64::to_degrees)
                .map(clean)
                .into(),
        }
    }

    fn in_words(&self) -> String {
        let clean = |x: f64| short(if x.abs() < 1e-4 { 0.0 } else { x });
        let still = |v: &[f64; 3]| v.iter().all(|x| x.abs() < 1e-4);
        match (still(&self.position_mm), still(&self.rotation_vector_deg)) {
            (true, true) => "the same".to_owned(),
            (false, true) => format!("at {} mm, parallel", triple(self.position_mm, clean)),
            _ => format!(
                "at {} mm, turned by the rotation vector {} deg",
                triple(self.position_mm, clean),
                triple(self.rotation_vector_deg, |x| fixed(x, 4))
            ),
        }
    }
}

pub(crate) fn run(a: &str, b: &str, json: bool) -> Answer<()> {
    let read = |named: &str| Files::default().model(named, Path::new("")).map(|m| m.0);
    let (one, other) = (read(a)?, read(b)?);
    let answer = compare(&one, &other, a, b)?;
    let text = in_words(&answer);
    if json {
        screen::print(Stream::Err, &text)?;
        return screen::print_bytes(json::json(&answer)?.as_bytes());
    }
    screen::print(Stream::Out, &text)
}

fn compare(one: &Model, other: &Model, a: &str, b: &str) -> Answer<Comparison> {
    let (m, n) = (&one.mechanism, &other.mechanism);
    let kinds = joints::kinds(m);
    if kinds.is_empty() {
        return Err(Failure::input(format!("{a} has no actuator")));
    }
    if kinds != joints::kinds(n) {
        let list = |m: &Mechanism| {
            let kinds = joints::kinds(m);
            let slides = kinds
                .iter()
                .filter(|k| **k == MotionKind::Prismatic)
                .count();
            format!(
                "{} that slide and {} that turn",
                slides,
                kinds.len() - slides
            )
        };
        return Err(Failure::input(format!(
            "the actuators differ, or their order: {a} has {}, {b} has {}; only machines of the same joints in the same order can be mapped on each other",
            list(m),
            list(n)
        )));
    }
    let quick = product(m) && product(n);
    let length = m.size().max(1e-3);
    let forward = |m: &Mechanism, q: &[f64]| match product(m) {
        true => plain(m, q),
        false => m.posture_at(q).ok().map(|p| *p.target()),
    };
    let (forward_a, forward_b) = (|q: &[f64]| forward(m, q), |q: &[f64]| forward(n, q));
    let postures = postures(m, &kinds, length, if quick { 24 } else { 6 });
    let found: Vec<(Vec<f64>, Pose)> = postures
        .into_iter()
        .filter_map(|q| forward_a(&q).map(|pose| (q, pose)))
        .collect();
    if found.len() < 3 {
        return Err(Failure::unanswered(format!(
            "{a}: its loops close at too few postures around home to compare them"
        )));
    }
    let (postures, targets): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    let fit = Fit {
        a: Side {
            forward: &forward_a,
        },
        b: Side {
            forward: &forward_b,
        },
        kinds: &kinds,
        postures: &postures,
        targets,
        length,
        same: SAME,
        quick,
    };
    let best = fit.run().ok_or_else(|| {
        Failure::unanswered(format!(
            "{b} cannot stand where {a} stands, with no sign of its joints"
        ))
    })?;
    let same = best.left.0.max(length * best.left.1) < SAME * length;
    // Home may be singular, or one of the two rigid.
    let home = joints::home(m);
    let stiffness = std::iter::once(&home)
        .chain(postures.iter().take(3))
        .filter(|_| same)
        .find_map(|q| Some((q.clone(), stiffness(m, n, &best, q)?)));
    Ok(Comparison {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        a: a.to_owned(),
        b: b.to_owned(),
        same,
        joints: maps(m, n, &best, &kinds),
        base: FrameMap::new(&best.base),
        tool: FrameMap::new(&best.tool),
        left_mm: best.left.0 * 1e3,
        left_deg: best.left.1.to_degrees(),
        postures: postures.len(),
        stiffness_at: stiffness
            .as_ref()
            .map(|(q, _)| joints::of_model(m, q))
            .unwrap_or_default(),
        stiffness_a_n_per_mm: stiffness.as_ref().map(|(_, s)| s.0),
        stiffness_b_n_per_mm: stiffness.as_ref().map(|(_, s)| s.1),
    })
}

fn maps(m: &Mechanism, n: &Mechanism, best: &Mapping, kinds: &[MotionKind]) -> Vec<JointMap> {
    let names = m.actuator_names().into_iter().zip(n.actuator_names());
    let numbers = best.signs.iter().zip(&best.offsets).zip(kinds);
    names
        .zip(numbers)
        .map(|((a, b), ((sign, offset), kind))| {
            let (unit, size) = unit(*kind);
            let offset = offset / size;
            JointMap {
                a,
                b,
                reversed: *sign < 0.0,
                offset: if offset.abs() < 1e-6 { 0.0 } else { offset },
                unit,
            }
        })
        .collect()
}

fn product(m: &Mechanism) -> bool {
    m.limbs().len() == 1 && m.limbs()[0].nominal.indices_of(Role::Passive).is_empty()
}

fn plain(m: &Mechanism, q: &[f64]) -> Option<Pose> {
    let limb = &m.limbs()[0];
    let base = &m.platforms()[limb.from].home;
    let tip = unloaded_tip(&limb.nominal, base, &limb.nominal.home_coordinates(), q);
    Some(tip * limb.platform_from_tip.inverse())
}

/// Irregular postures around home: a serial arm in all its range, a parallel machine near home.
fn postures(m: &Mechanism, kinds: &[MotionKind], length: f64, count: usize) -> Vec<Vec<f64>> {
    let home = joints::home(m);
    let limits = m
        .limbs()
        .iter()
        .flat_map(|l| l.nominal.actuators().iter().map(|a| a.limits));
    let limits: Vec<Option<(f64, f64)>> = limits.collect();
    let wide = product(m);
    (0..count)
        .map(|k| {
            (0..kinds.len())
                .map(|i| {
                    // Golden ratio's multiples, one sequence per joint.
                    let share = ((k * kinds.len() + i + 1) as f64 * 0.618_033_988_75
                        + 0.377 * i as f64)
                        .fract()
                        - 0.5;
                    let reach = match (kinds[i], wide) {
                        (MotionKind::Revolute, true) => 3.0,
                        (MotionKind::Revolute, false) => 0.2,
                        (MotionKind::Prismatic, true) => length,
                        (MotionKind::Prismatic, false) => 0.1 * length,
                    };
                    let value = home[i] + share * reach;
                    match limits[i] {
                        Some((low, high)) => value.clamp(low, high),
                        None => value,
                    }
                })
                .collect()
        })
        .collect()
}

/// Stiffness against a force with joints of A at `q`, seen at A's tool, softest first, N/mm.
fn stiffness(
    m: &Mechanism,
    n: &Mechanism,
    best: &Mapping,
    q: &[f64],
) -> Option<([f64; 3], [f64; 3])> {
    let (one, other) = (m.posture_at(q).ok()?, n.posture_at(&best.joints(q)).ok()?);
    let compliance = |k: kinetostat::UnloadedStiffness| {
        (k.rank() == 6).then(|| k.cartesian.compliance()).flatten()
    };
    let a = compliance(one.stiffness().ok()?)?;
    let b = compliance(other.stiffness().ok()?)?;
    // To A's axes, then from B's tool to A's.
    let turn = turn_matrix(&best.base.rotation.to_rotation_matrix());
    let arm = one.target().translation.vector - (best.base * other.target()).translation.vector;
    let shift = shift_matrix(&arm);
    let b = shift * turn * b * turn.transpose() * shift.transpose();
    let sizes = |c: &nalgebra::Matrix6<f64>| {
        let block = c.fixed_view::<3, 3>(0, 0).into_owned();
        let mut values: Vec<f64> = block.symmetric_eigenvalues().iter().copied().collect();
        values.sort_by(|x, y| y.total_cmp(x));
        (values[2] > 1e-9 * values[0]).then(|| [0, 1, 2].map(|i| 1e-3 / values[i]))
    };
    Some((sizes(&a)?, sizes(&b)?))
}

fn in_words(c: &Comparison) -> String {
    let mut out = wrapped(&format!("A: {}, B: {}", c.a, c.b), 0);
    out.push('\n');
    let plain = c.joints.iter().all(|j| !j.reversed && j.offset == 0.0);
    let left = format!(
        "up to {} mm and {} deg over {} postures",
        number(c.left_mm, 2),
        number(c.left_deg, 2),
        c.postures
    );
    if c.same {
        out.push_str(&wrapped(
            &format!("The same machine, but for constant offsets ({left} are left: rounding)."),
            0,
        ));
    } else {
        out.push_str(&wrapped(
            &format!(
                "No constant offsets map one on the other. The best ones found, which follow, leave {left}: lengths or angles of the links differ."
            ),
            0,
        ));
    }
    out.push('\n');
    let frames = [
        ("base of B in the base of A", &c.base),
        ("tool of A in the tool of B", &c.tool),
    ];
    for (name, frame) in frames {
        out.push_str(&item(&format!("{name}: {}", frame.in_words())));
    }
    if plain {
        out.push_str(&item("all joints: the same signs and zeros"));
    }
    out.push('\n');
    let mut rows = vec![
        ["joint of A", "joint of B", "B shows"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for j in &c.joints {
        let sign = if j.reversed { "-" } else { "" };
        let offset = match j.offset {
            0.0 => String::new(),
            o if o < 0.0 => format!(" - {} {}", joints::plain(-o), j.unit),
            o => format!(" + {} {}", joints::plain(o), j.unit),
        };
        rows.push(vec![
            j.a.clone(),
            j.b.clone(),
            format!("{sign}{}{offset}", j.a),
        ]);
    }
    out.push_str(&layout::listed(&rows, 2));
    if let (Some(a), Some(b)) = (&c.stiffness_a_n_per_mm, &c.stiffness_b_n_per_mm) {
        let ratio = b[0] / a[0];
        let words = if (ratio - 1.0).abs() < 1e-6 {
            "equally stiff in the softest direction".to_owned()
        } else if ratio > 1.0 {
            format!(
                "B is {} times as stiff in the softest direction",
                number(ratio, 3)
            )
        } else {
            format!(
                "A is {} times as stiff in the softest direction",
                number(1.0 / ratio, 3)
            )
        };
        out.push('\n');
        out.push_str(&wrapped(
            &format!("Against a force on the tool: {words}."),
            0,
        ));
        let row = |name: &str, v: &[f64; 3]| {
            let mut cells = vec![name.to_owned()];
            cells.extend(v.iter().map(|x| number(*x, 4)));
            cells
        };
        out.push_str(&columns(
            &[
                ["N/mm", "softest", "middle", "stiffest"]
                    .map(str::to_owned)
                    .to_vec(),
                row("A", a),
                row("B", b),
            ],
            2,
        ));
        out.push_str(&joints::in_words(
            "with the joints of A at",
            &c.stiffness_at,
        ));
    }
    out
}
