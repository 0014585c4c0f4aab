//! `kinetostat model compare`: which constant offsets make one model the other.

use std::path::Path;

use kinetostat::{Mechanism, Pose};
use kinetostat_analysis::comparison;
use kinetostat_analysis::comparison::{ActuatorCounts, ComparisonError, Mapping};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_model::Model;
use schemars::JsonSchema;
use serde::Serialize;

use crate::files::input_files::InputFiles;
use crate::machine::units::unit;
use crate::place::joints::{self, JointValue};
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::json;
use crate::ui::layout::{self, columns, item, wrapped};
use crate::ui::numbers::{fixed, number, short, triple};

/// The answer, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Comparison {
    schema: u32,
    kinetostat_version: &'static str,
    a: String,
    b: String,
    /// True if the machines are equal but for constant offsets.
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
    /// Stiffness against a force, the tool free to turn, softest first.
    stiffness_a_n_per_mm: Option<[f64; 3]>,
    stiffness_b_n_per_mm: Option<[f64; 3]>,
}

#[derive(Serialize, JsonSchema)]
struct JointMap {
    a: String,
    b: String,
    reversed: bool,
    offset: f64,
    unit: &'static str,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct FrameMap {
    position_mm: [f64; 3],
    rotation_vector_deg: [f64; 3],
}

impl FrameMap {
    pub(crate) fn new(pose: &Pose) -> Self {
        let clean = |x: f64| (x * 1e9).round() / 1e9 + 0.0;
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

    pub(crate) fn description(&self) -> String {
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
    let read = |named: &str| {
        InputFiles::default()
            .model(named, Path::new(""))
            .map(|m| m.0)
    };
    let (one, other) = (read(a)?, read(b)?);
    let answer = compare(&one, &other, a, b)?;
    let text = answer_text(&answer);
    json::print_answer(&text, &answer, json)
}

fn compare(one: &Model, other: &Model, a: &str, b: &str) -> Answer<Comparison> {
    let (m, n) = (&one.mechanism, &other.mechanism);
    let found = comparison::compare(m, n).map_err(|error| cannot_be_compared(&error, a, b))?;
    let best = &found.mapping;
    let (distance, angle) = best.largest_difference;
    Ok(Comparison {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        a: a.to_owned(),
        b: b.to_owned(),
        same: found.same,
        joints: maps(m, n, best),
        base: FrameMap::new(&best.base),
        tool: FrameMap::new(&best.tool),
        left_mm: distance * 1e3,
        left_deg: angle.to_degrees(),
        postures: found.postures,
        stiffness_at: found
            .stiffness
            .as_ref()
            .map(|s| joints::of_model(m, &s.commands))
            .unwrap_or_default(),
        stiffness_a_n_per_mm: found.stiffness.as_ref().map(|s| s.a_n_per_mm),
        stiffness_b_n_per_mm: found.stiffness.as_ref().map(|s| s.b_n_per_mm),
    })
}

fn cannot_be_compared(error: &ComparisonError, a: &str, b: &str) -> Failure {
    let list = |counts: &ActuatorCounts| {
        format!(
            "{} that slide and {} that turn",
            counts.prismatic, counts.revolute
        )
    };
    match error {
        ComparisonError::NoActuator => {
            ErrorCode::ModelUnsuited.failure(format!("{a} has no actuator"))
        }
        ComparisonError::DifferentActuators { a: of_a, b: of_b } => ErrorCode::ModelUnsuited.failure(format!(
                "the actuators differ, or their order: {a} has {}, {b} has {}; only machines of the same joints in the same order can be mapped on each other",
                list(of_a),
                list(of_b)
            ),
        ),
        ComparisonError::TooFewPostures => ErrorCode::NoAnswer.failure(format!("{a}: its loops close at too few postures around home to compare them"),
        ),
        ComparisonError::NoMapping => ErrorCode::NoAnswer.failure(format!("{b} cannot take the posture of {a}, with no sign of its joints"),
        ),
        other => ErrorCode::NoAnswer.failure(other),
    }
}

fn maps(m: &Mechanism, n: &Mechanism, best: &Mapping) -> Vec<JointMap> {
    let names = m.actuator_names().into_iter().zip(n.actuator_names());
    let numbers = best.signs.iter().zip(&best.offsets).zip(joints::kinds(m));
    names
        .zip(numbers)
        .map(|((a, b), ((sign, offset), kind))| {
            let (unit, size) = unit(kind);
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

fn answer_text(c: &Comparison) -> String {
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
        out.push_str(&item(&format!("{name}: {}", frame.description())));
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
            o if o < 0.0 => format!(" - {} {}", short(-o), j.unit),
            o => format!(" + {} {}", short(o), j.unit),
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
        out.push_str(&joints::values_text(
            "with the joints of A at",
            &c.stiffness_at,
        ));
    }
    out
}
