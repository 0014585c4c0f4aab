//! `kinetostat check --pose`: the model against poses that were jogged on the machine.

mod file;
mod fit;

use std::path::Path;

use kinetostat::{MotionKind, Pose, unloaded_tip};
use kinetostat_model::Model;
use nalgebra::UnitQuaternion;
use serde::Serialize;

use crate::check::poses::file::read;
use crate::check::poses::fit::{
    Axis, Coupling, Explained, Explanation, Forward, Frame, Gap, Jogged, Tolerance, explain, left,
};
use crate::files::input::Files;
use crate::machine::units::unit;
use crate::place::joints::{self, Named};
use crate::ui::failure::{Answer, Failure};
use crate::ui::json;
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{fixed, short, triple};
use crate::ui::screen::{self, Stream};

/// Explanations shown where several fit.
const SHOWN: usize = 6;

/// The answer, stable names with units.
#[derive(Serialize)]
struct Comparison {
    schema: u32,
    kinetostat_version: &'static str,
    model: String,
    model_source: String,
    poses_file: String,
    /// Whether the joints of the file are those of the pendant or of the model.
    joints_are: &'static str,
    tolerance_mm: f64,
    tolerance_deg: f64,
    poses: Vec<PoseFinding>,
    agrees: bool,
    /// What explains the differences within the tolerance, the simplest; several are equally good.
    explanations: Vec<String>,
    ambiguous: bool,
    /// What comes nearest where nothing explains them, and the largest differences that it leaves.
    nearest: Option<Nearest>,
}

#[derive(Serialize)]
struct PoseFinding {
    name: String,
    line: usize,
    measured_position_mm: [f64; 3],
    computed_position_mm: [f64; 3],
    difference_mm: f64,
    /// None where no orientation was measured.
    difference_deg: Option<f64>,
}

#[derive(Serialize)]
struct Nearest {
    in_words: String,
    difference_mm: f64,
    difference_deg: Option<f64>,
}

/// The model and where it came from, for one file of poses.
pub(crate) fn run(
    model: &Model,
    source: &str,
    file: &Path,
    tolerance_mm: f64,
    json: bool,
) -> Answer<()> {
    if !(tolerance_mm > 0.0 && tolerance_mm <= 1e4) {
        return Err(Failure::input(format!(
            "--pose-tolerance-mm is {tolerance_mm}; a length from above 0 to 10000 mm is needed"
        )));
    }
    let names = axes(model);
    let poses = read(&Files::default(), file, &names)?;
    let rows: Vec<Jogged> = poses.iter().map(|p| p.jogged.clone()).collect();
    let forward = |shown: &[f64]| forward(model, shown);
    let tolerance = Tolerance {
        distance: 1e-3 * tolerance_mm,
        angle: (0.1 * tolerance_mm).to_radians(),
    };
    let mut findings = Vec::new();
    for pose in &poses {
        let computed = at(model, &pose.jogged.joints)
            .map_err(|reason| Failure::input(format!("line {}: {reason}", pose.line)))
            .map_err(|f| f.within(&file.display().to_string()))?;
        let gap = crate::check::poses::fit::gap(&pose.jogged, &computed);
        findings.push(PoseFinding {
            name: pose.name.clone(),
            line: pose.line,
            measured_position_mm: (pose.jogged.position * 1e3).into(),
            computed_position_mm: (computed.translation.vector * 1e3).into(),
            difference_mm: gap.distance * 1e3,
            difference_deg: gap.angle.map(f64::to_degrees),
        });
    }
    let declared = declared(model, &names);
    let words = Words {
        names: &names,
        axes: &declared,
        joints: &joints_of(model),
    };
    let explained = explain(&forward, &rows, &declared, quick(model), tolerance);
    let agrees = explained.fitting.first() == Some(&Explanation::default());
    let explanations: Vec<String> = match agrees {
        true => Vec::new(),
        false => explained
            .fitting
            .iter()
            .map(|e| words.of(e, true))
            .collect(),
    };
    let answer = Comparison {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: model.name().to_owned(),
        model_source: source.to_owned(),
        poses_file: file.display().to_string(),
        joints_are: match model.controller {
            Some(_) => "of the pendant",
            None => "of the model",
        },
        tolerance_mm,
        tolerance_deg: tolerance.angle.to_degrees(),
        poses: findings,
        agrees,
        ambiguous: explanations.len() > 1,
        explanations,
        nearest: nearest(&explained, &forward, &rows, &words),
    };
    let text = in_words(&answer, rows.len());
    if json {
        screen::print(Stream::Err, &text)?;
        return screen::print_bytes(json::json(&answer)?.as_bytes());
    }
    screen::print(Stream::Out, &text)
}

/// What comes nearest, if it is worth a word.
fn nearest(
    explained: &Explained,
    forward: &Forward<'_>,
    rows: &[Jogged],
    words: &Words<'_>,
) -> Option<Nearest> {
    let (explanation, gaps) = explained.nearest.as_ref()?;
    if *explanation == Explanation::default() {
        return None;
    }
    let (distance, angle) = largest(gaps);
    let before = left(forward, rows, words.axes, &Explanation::default())?;
    if distance > 0.5 * largest(&before).0 {
        return None;
    }
    Some(Nearest {
        in_words: words.of(explanation, false),
        difference_mm: distance * 1e3,
        difference_deg: angle.map(f64::to_degrees),
    })
}

fn largest(gaps: &[Gap]) -> (f64, Option<f64>) {
    let distance = gaps.iter().map(|g| g.distance).fold(0.0, f64::max);
    let angle = gaps.iter().filter_map(|g| g.angle).fold(None, |most, a| {
        Some(most.map_or(a, |most: f64| most.max(a)))
    });
    (distance, angle)
}

/// The joints of the file: the pendant's axes, or the model's actuators.
fn axes(model: &Model) -> Vec<Named> {
    match &model.controller {
        Some(controller) => joints::on_axes(controller),
        None => {
            let m = &model.mechanism;
            let named = m.actuator_names().into_iter().zip(joints::kinds(m));
            named
                .map(|(name, kind)| (name, kind, unit(kind).1))
                .collect()
        }
    }
}

/// What the file says of each of them.
fn declared(model: &Model, names: &[Named]) -> Vec<Axis> {
    let turns = |i: usize| names[i].1 == MotionKind::Revolute;
    let Some(controller) = &model.controller else {
        let plain = |i| Axis {
            turns: turns(i),
            zero: 0.0,
            ratio: 1.0,
            coupled: Vec::new(),
        };
        return (0..names.len()).map(plain).collect();
    };
    let (axes, map) = (controller.axes(), controller.map());
    let zeros = controller
        .pendant(&vec![0.0; axes.len()])
        .unwrap_or_else(|| vec![0.0; axes.len()]);
    let plain = |i: usize| (0..axes.len()).all(|j| j == axes[i].joint || map[(i, j)] == 0.0);
    let declared = axes.iter().enumerate().map(|(i, axis)| Axis {
        turns: turns(i),
        zero: zeros[i] * axis.unit.in_si(),
        ratio: map[(i, axis.joint)],
        coupled: (0..axes.len())
            .filter(|&j| j != i && plain(j) && map[(i, axes[j].joint)] != 0.0)
            .map(|j| (j, map[(i, axes[j].joint)]))
            .collect(),
    });
    declared.collect()
}

/// The model's joint of each axis.
fn joints_of(model: &Model) -> Vec<String> {
    let names = model.mechanism.actuator_names();
    match &model.controller {
        Some(c) => c.axes().iter().map(|a| names[a.joint].clone()).collect(),
        None => names,
    }
}

/// A plain product: no passive joint has to be found.
fn quick(model: &Model) -> bool {
    let limbs = model.mechanism.limbs();
    limbs.len() == 1
        && limbs[0]
            .nominal
            .indices_of(kinetostat::Role::Passive)
            .is_empty()
}

fn model_joints(model: &Model, shown: &[f64]) -> Option<Vec<f64>> {
    match &model.controller {
        None => Some(shown.to_vec()),
        Some(controller) => {
            let in_units = shown.iter().zip(controller.axes());
            let pendant: Vec<f64> = in_units.map(|(x, a)| x / a.unit.in_si()).collect();
            controller.joints(&pendant)
        }
    }
}

fn at(model: &Model, shown: &[f64]) -> Result<Pose, String> {
    let joints = model_joints(model, shown).ok_or("the number of joints does not fit")?;
    let posture = model.mechanism.posture_at(&joints);
    posture.map(|p| *p.target()).map_err(|e| e.to_string())
}

/// As [`at`], without detours: it is asked thousands of times.
fn forward(model: &Model, shown: &[f64]) -> Option<Pose> {
    if !quick(model) {
        return at(model, shown).ok();
    }
    let joints = model_joints(model, shown)?;
    let m = &model.mechanism;
    let limb = &m.limbs()[0];
    let base = &m.platforms()[limb.from].home;
    let coordinates = limb.nominal.home_coordinates();
    let tip = unloaded_tip(&limb.nominal, base, &coordinates, &joints);
    Some(tip * limb.platform_from_tip.inverse())
}

/// What words are made of: the axes, what the file says of them, and their joints in the model.
struct Words<'a> {
    names: &'a [Named],
    axes: &'a [Axis],
    joints: &'a [String],
}

impl Words<'_> {
    /// `sign of A3 is reversed; A2 is shifted by 90 deg`. With `advice`, what to write.
    fn of(&self, e: &Explanation, advice: bool) -> String {
        let names = self.names;
        let name = |i: usize| names[i].0.as_str();
        let mut parts = Vec::new();
        match e.reversed.as_slice() {
            [] => {}
            [one] => parts.push(format!("sign of {} is reversed", name(*one))),
            several => {
                let list: Vec<&str> = several.iter().map(|&i| name(i)).collect();
                parts.push(format!("signs of {} are reversed", list.join(", ")));
            }
        }
        for &(i, by) in &e.offsets {
            let (unit, size) = unit(names[i].1);
            // What has to be added to the shown value: the model's zero is there.
            parts.push(format!(
                "zero of {} is off: {} {unit} have to be added to what is shown",
                name(i),
                joints::plain(by / size)
            ));
        }
        parts.extend(e.coupling.map(|c| self.coupling(e, c, advice)));
        match &e.frame {
        Some(Frame::Base(pose)) => parts.push(format!(
            "the base frame is another one: the model's base is at {}",
            place(pose)
        )),
        Some(Frame::Tool(pose)) => parts.push(format!(
            "the tool frame is another one: the measured one is, in the model's tool frame, at {}",
            place(pose)
        )),
        None => {}
    }
        let text = parts.join("; ");
        if advice && !e.reversed.is_empty() && e.offsets.is_empty() && e.coupling.is_none() {
            return format!("{text} (change 'reversed' of it in the section [controller])");
        }
        text
    }

    /// `J3 is coupled with J2: the model needs J3 + J2`. With `advice`, what to write.
    fn coupling(&self, e: &Explanation, coupling: Coupling, advice: bool) -> String {
        let name = |i: usize| self.names[i].0.as_str();
        let share_of = |i: usize, j: usize| {
            let declared = self.axes[i].coupled.iter().find(|c| c.0 == j);
            declared.map_or(0.0, |c| c.1)
        };
        // A share between a slide and a turn has a unit of its own; it is not written as a number.
        let ratio = |i: usize, j: usize, share: f64| {
            if self.axes[i].turns == self.axes[j].turns {
                format!(" ratio = {}", joints::plain(share))
            } else {
                " the ratio with the other sign".to_owned()
            }
        };
        match coupling {
            Coupling::Missing { axis, other, share } => {
                let sign = if share < 0.0 { "-" } else { "+" };
                let (own, theirs) = (name(axis), name(other));
                let text = format!(
                    "{own} is coupled with {theirs}: the model needs {own} {sign} {theirs}"
                );
                if !advice {
                    return text;
                }
                let turned = if e.reversed.contains(&axis) {
                    1.0
                } else {
                    -1.0
                };
                format!(
                    "{text} (write in the section [controller], at {own}: coupled = [{{ joint = \"{}\", ratio = {} }}])",
                    self.joints[other],
                    joints::plain(turned * share * self.axes[other].ratio)
                )
            }
            Coupling::Reversed { axis, other } => {
                let text = format!(
                    "the coupling of {} with '{}' has the wrong sign",
                    name(axis),
                    self.joints[other]
                );
                if !advice {
                    return text;
                }
                format!(
                    "{text} (in the section [controller], in 'coupled' of {}, write for '{}'{})",
                    name(axis),
                    self.joints[other],
                    ratio(axis, other, -share_of(axis, other))
                )
            }
            Coupling::Absent { axis, other } => {
                let text = format!(
                    "{} is declared to be coupled with '{}', but the pendant shows it without",
                    name(axis),
                    self.joints[other]
                );
                if !advice {
                    return text;
                }
                format!(
                    "{text} (in the section [controller], remove '{}' from 'coupled' of {})",
                    self.joints[other],
                    name(axis)
                )
            }
        }
    }
}

fn place(pose: &Pose) -> String {
    let clean = |x: f64| short(if x.abs() < 1e-6 { 0.0 } else { x });
    let position = triple((pose.translation.vector * 1e3).into(), clean);
    let turn = pose.rotation.scaled_axis().map(f64::to_degrees);
    if UnitQuaternion::angle(&pose.rotation) < 1e-6 {
        return format!("{position} mm, parallel");
    }
    format!(
        "{position} mm, turned by the rotation vector {} deg",
        triple(turn.into(), |x| fixed(x, 3))
    )
}

fn in_words(a: &Comparison, count: usize) -> String {
    let mut out = wrapped(
        &format!(
            "{} ({}) against {} ({} {}), joint values {}",
            a.model,
            a.model_source,
            a.poses_file,
            count,
            if count == 1 { "pose" } else { "poses" },
            a.joints_are
        ),
        0,
    );
    out.push('\n');
    let mut rows = vec![
        [
            "pose",
            "measured at, mm",
            "computed at, mm",
            "apart, mm",
            "deg",
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    for p in &a.poses {
        rows.push(vec![
            p.name.clone(),
            triple(p.measured_position_mm, |x| fixed(x, 2)),
            triple(p.computed_position_mm, |x| fixed(x, 2)),
            fixed(p.difference_mm, 3),
            p.difference_deg
                .map_or_else(|| "-".to_owned(), |x| fixed(x, 3)),
        ]);
    }
    out.push_str(&columns(&rows, 2));
    out.push('\n');
    let within = format!(
        "{} mm and {} deg",
        joints::plain(a.tolerance_mm),
        joints::plain(a.tolerance_deg)
    );
    if a.agrees {
        out.push_str(&wrapped(
            &format!("The model agrees with all of them within {within}."),
            0,
        ));
        return out;
    }
    match a.explanations.as_slice() {
        [] => {
            out.push_str(&wrapped(
                &format!(
                    "The model does not agree, and no reversed sign, quarter turn, single offset, coupling or frame explains the differences within {within}."
                ),
                0,
            ));
            if let Some(n) = &a.nearest {
                out.push_str(&item(&format!(
                    "nearest: {}; then up to {} mm{} are left",
                    n.in_words,
                    joints::plain(n.difference_mm),
                    n.difference_deg
                        .map_or_else(String::new, |d| format!(" and {} deg", joints::plain(d)))
                )));
            }
            out.push_str(&wrapped(
                "Lengths of the links may differ; compare a data sheet's figures with the model's.",
                0,
            ));
        }
        [only] => {
            out.push_str(&wrapped(
                &format!(
                    "The differences are systematic. This explains all of them within {within}:"
                ),
                0,
            ));
            out.push_str(&item(only));
            if count < 3 {
                out.push_str(&wrapped(
                    "That is few poses: jog a third one, with every joint elsewhere, to be sure.",
                    0,
                ));
            }
        }
        several => {
            out.push_str(&wrapped(
                &format!(
                    "The differences are systematic, but these poses do not decide: {} explanations are equally simple and explain all within {within}:",
                    several.len()
                ),
                0,
            ));
            for text in several.iter().take(SHOWN) {
                out.push_str(&item(text));
            }
            if several.len() > SHOWN {
                out.push_str(&item(&format!("and {} more", several.len() - SHOWN)));
            }
            out.push_str(&wrapped(
                "Jog one more pose with every joint away from zero and from the other poses. Some always look alike: an offset of the first joint and a turned base, an offset of the last one and a turned tool.",
                0,
            ));
        }
    }
    out
}
