//! Frames and directions in words: where base and tool are and how their axes point, where the machine
//! stands with all joints at zero, and which way it moves for a positive joint.

use kinetostat::{Mechanism, Pose, PostureRequest, Twist};
use kinetostat_analysis::joint_motion::{actuator_twist, point_on_axis};
use kinetostat_model::Model;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::machine::units::unit;
use crate::place::joints::{self, JointValue};
use crate::ui::layout::{item, wrapped};
use crate::ui::numbers::{fixed, short, triple};

/// Upper limit of the actuators that are listed one by one.
const MOST: usize = 40;

/// Frames and directions, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Frames {
    tool_frame: String,
    home_position_mm: [f64; 3],
    /// Columns: the tool's x, y and z axis in base axes, at home.
    home_axes: [[f64; 3]; 3],
    zero_position_mm: Option<[f64; 3]>,
    zero_axes: Option<[[f64; 3]; 3]>,
    zero_outside_limits: bool,
    /// Reason for which the machine has no posture with all joints at zero.
    zero_problem: Option<String>,
    joints: Vec<JointDirection>,
    /// Displayed values of the controller at home, in the order of its axes.
    #[serde(rename = "pendant_at_home")]
    on_controller_at_home: Vec<JointValue>,
    #[serde(rename = "pendant")]
    on_controller: Vec<ShownAxis>,
}

/// The tool's motion by a small positive motion of one joint, the others held, at home.
#[derive(Serialize, JsonSchema)]
struct JointDirection {
    name: String,
    unit: &'static str,
    home: f64,
    in_words: String,
    /// Motion of the tool's point, mm per mm or mm per degree.
    motion_mm: Option<[f64; 3]>,
    /// Degrees per mm or per degree.
    rotation_deg: Option<[f64; 3]>,
    /// Point on the axis nearest to the base's origin, for a revolute joint in a single chain.
    axis_through_mm: Option<[f64; 3]>,
}

/// An axis of the controller by the model's joints.
#[derive(Serialize, JsonSchema)]
struct ShownAxis {
    name: String,
    unit: &'static str,
    follows: String,
}

/// Up, forward and left where the machine stands.
struct Senses {
    up: Vector3<f64>,
    forward: Vector3<f64>,
}

impl Senses {
    fn new(m: &Mechanism, home: &Pose) -> Self {
        let up = -m.gravity();
        let up = up.try_normalize(1e-9).unwrap_or_else(Vector3::z);
        let flat = |v: Vector3<f64>| v - up * up.dot(&v);
        let out = flat(home.translation.vector);
        let forward = out
            .try_normalize(1e-3)
            .or_else(|| flat(Vector3::x()).try_normalize(1e-3))
            .unwrap_or_else(Vector3::x);
        Self { up, forward }
    }

    /// `forward and down`; shares below a fifth of the whole are left out.
    fn direction_of(&self, v: &Vector3<f64>) -> String {
        let left = self.up.cross(&self.forward);
        let names = [
            (self.forward, "forward", "back"),
            (left, "to the left", "to the right"),
            (self.up, "up", "down"),
        ];
        let words: Vec<&str> = names
            .iter()
            .filter(|(axis, ..)| axis.dot(v).abs() > 0.2 * v.norm())
            .map(|(axis, with, against)| if axis.dot(v) > 0.0 { *with } else { *against })
            .collect();
        words.join(" and ")
    }
}

/// `+z`, or the components of a direction.
fn direction(v: &Vector3<f64>) -> String {
    for (i, name) in ["x", "y", "z"].iter().enumerate() {
        if 1.0 - v[i].abs() < 1e-9 {
            let sign = if v[i] > 0.0 { "+" } else { "-" };
            return format!("{sign}{name}");
        }
    }
    triple((*v).into(), |x| fixed(x, 3))
}

fn axes(pose: &Pose) -> [[f64; 3]; 3] {
    let turn = pose.rotation;
    [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| (turn * axis).into())
}

fn mm(v: Vector3<f64>) -> [f64; 3] {
    (v * 1e3).into()
}

pub(crate) fn frames(model: &Model) -> Frames {
    let m = &model.mechanism;
    let tool = &m.platforms()[m.tool()];
    let count = m.actuator_count();
    let zero = m.posture(PostureRequest::commands(&vec![0.0; count]));
    let commands = joints::home(m);
    let (zero_pose, zero_problem) = match &zero {
        Ok(posture) => (Some(*posture.target()), None),
        Err(reason) => (None, Some(reason.to_string())),
    };
    let at_home = m.posture(&tool.home).map(|p| p.commands());
    Frames {
        tool_frame: tool.name.clone(),
        home_position_mm: mm(tool.home.translation.vector),
        home_axes: axes(&tool.home),
        zero_position_mm: zero_pose.map(|p| mm(p.translation.vector)),
        zero_axes: zero_pose.as_ref().map(axes),
        zero_outside_limits: zero.is_ok_and(|p| p.within_limits().is_err()),
        zero_problem,
        joints: match (&at_home, count <= MOST) {
            (Ok(commands), true) => directions(m, &tool.home, commands),
            _ => Vec::new(),
        },
        on_controller_at_home: joints::in_controller_coordinates(
            model.controller.as_ref(),
            at_home.as_deref().unwrap_or(&commands),
        ),
        on_controller: model
            .controller
            .iter()
            .flat_map(|c| controller_axes(m, c))
            .collect(),
    }
}

fn controller_axes(m: &Mechanism, controller: &kinetostat_model::Controller) -> Vec<ShownAxis> {
    let names = m.actuator_names();
    let axes = controller.axes().iter().enumerate();
    axes.map(|(i, axis)| ShownAxis {
        name: axis.name.clone(),
        unit: axis.unit.word(),
        follows: controller.description(i, &names),
    })
    .collect()
}

fn directions(m: &Mechanism, home: &Pose, commands: &[f64]) -> Vec<JointDirection> {
    let senses = Senses::new(m, home);
    let values = joints::of_model(m, commands);
    let each = values.into_iter().zip(joints::kinds(m)).enumerate();
    each.map(|(i, (joint, kind))| {
        let twist = actuator_twist(m, commands, i);
        let size = unit(kind).1;
        let through = twist
            .as_ref()
            .filter(|_| m.limbs().len() == 1)
            .and_then(|t| point_on_axis(home, t));
        JointDirection {
            in_words: match &twist {
                Some(twist) => motion_description(&senses, twist, through.as_ref()),
                None => "cannot move alone: the other actuators hold it".to_owned(),
            },
            motion_mm: twist.as_ref().map(|t| (t.linear() * size * 1e3).into()),
            rotation_deg: twist
                .as_ref()
                .map(|t| (t.angular() * size).map(f64::to_degrees).into()),
            axis_through_mm: through.map(mm),
            name: joint.name,
            unit: joint.unit,
            home: joint.value,
        }
    })
    .collect()
}

fn motion_description(senses: &Senses, twist: &Twist, through: Option<&Vector3<f64>>) -> String {
    let (v, w) = (twist.linear(), twist.angular());
    let mut parts = Vec::new();
    // Per rad or m: what is smaller than a micrometre is rounding.
    if v.norm() > 1e-6 {
        parts.push(format!("the tool moves {}", senses.direction_of(&v)));
    } else {
        parts.push("the tool's point stays".to_owned());
    }
    if w.norm() > 1e-6 {
        parts.push(format!(
            "turns about {} of the base",
            direction(&w.normalize())
        ));
    } else if v.norm() > 1e-6 {
        parts.push(format!(
            "slides along {} of the base",
            direction(&v.normalize())
        ));
    }
    let mut text = parts.join("; ");
    if let Some(point) = through {
        let clean = |x: f64| short(if x.abs() < 1e-6 { 0.0 } else { x });
        text.push_str(&format!("; axis through {} mm", triple(mm(*point), clean)));
    }
    text
}

fn pointing(axes: &[[f64; 3]; 3]) -> String {
    let [x, y, z] = axes.map(|a| direction(&Vector3::from(a)));
    format!("its x points along {x}, y along {y}, z along {z} of the base")
}

/// The section of `check`, wrapped.
pub(crate) fn frames_text(f: &Frames) -> String {
    let mut out = String::from("\nFrames and directions\n");
    let place = |p: [f64; 3]| triple(p, |x| short(if x.abs() < 1e-9 { 0.0 } else { x }));
    out.push_str(&item(&format!(
        "base: all places are measured from its origin, in its axes; the tool's frame '{}' at home is at {} mm; {}",
        f.tool_frame,
        place(f.home_position_mm),
        pointing(&f.home_axes)
    )));
    out.push_str(&item(&match (f.zero_position_mm, &f.zero_axes, &f.zero_problem) {
        (Some(p), Some(axes), _) if f.joints.iter().any(|j| j.home != 0.0) => format!(
            "with every actuator at 0{} the tool's frame is at {} mm; {}",
            if f.zero_outside_limits { " (outside the limits)" } else { "" },
            place(p),
            pointing(axes)
        ),
        (Some(_), Some(_), _) => "home is where every actuator is at 0".to_owned(),
        (_, _, reason) => format!(
            "the machine cannot be assembled with every actuator at 0 ({}); directions are those at home",
            reason.as_deref().unwrap_or("out of reach")
        ),
    }));
    if f.joints.is_empty() {
        out.push_str(&item("directions of the joints are not listed here"));
    }
    for j in &f.joints {
        out.push_str(&item(&format!("'{}' +: {}", j.name, j.in_words)));
    }
    if !f.joints.is_empty() {
        out.push_str(&wrapped(
            "Directions at home, the other actuators held. Forward is away from the base's vertical through its origin, left and right as seen that way.",
            2,
        ));
    }
    if !f.on_controller.is_empty() {
        out.push_str("\nOn the controller\n");
        for axis in &f.on_controller {
            out.push_str(&item(&format!(
                "{} = {}, shown in {}",
                axis.name, axis.follows, axis.unit
            )));
        }
        out.push_str(&joints::values_text("  at home", &f.on_controller_at_home));
    }
    out
}
