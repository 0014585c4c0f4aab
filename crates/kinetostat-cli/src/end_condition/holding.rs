//! Displacement control of the tool, direction by direction.

use kinetostat::{EndCondition, Pose, Prescribed, Wrench, spatial::turn_matrix};
use kinetostat_diagnostic::ErrorCode;
use nalgebra::{Rotation3, Vector3, Vector6};
use schemars::JsonSchema;
use serde::Serialize;

use crate::end_condition::arguments::EndArgs;
use crate::end_condition::moves::Moves;
use crate::place::orientation;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::{short, triple};

pub(crate) const DIRECTIONS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// End condition of the tool.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct Holding {
    /// Directions in which it is held.
    pub(crate) held: Vec<&'static str>,
    /// Directions in which a load acts on it (none is a load of zero).
    pub(crate) free: Vec<&'static str>,
    /// Directions in which the chain cannot move its end at all.
    pub(crate) rigid: Vec<&'static str>,
    /// Rotation vector of the axes of these directions, degrees.
    pub(crate) axes_rotation_vector_deg: [f64; 3],
    #[serde(skip)]
    pub(crate) end: EndCondition,
    /// `chain` or `machine`.
    #[serde(skip)]
    pub(crate) subject: &'static str,
}

/// Prescribed motion, base axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Driven {
    pub(crate) axis: Vector3<f64>,
    pub(crate) turns: bool,
}

impl Driven {
    pub(crate) fn twist(&self) -> Vector6<f64> {
        let zero = Vector3::zeros();
        let (v, w) = if self.turns {
            (zero, self.axis)
        } else {
            (self.axis, zero)
        };
        Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z)
    }

    pub(crate) fn description(&self) -> String {
        let word = if self.turns { "about" } else { "along" };
        format!("{word} {}", axis_description(&self.axis))
    }
}

/// `x`, `-y` or the components.
pub(crate) fn axis_description(axis: &Vector3<f64>) -> String {
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        if axis[k].abs() > 1.0 - 1e-12 {
            let sign = if axis[k] < 0.0 { "-" } else { "" };
            return format!("{sign}{name}");
        }
    }
    triple((*axis).into(), short)
}

/// Names of directions, with words for groups of them.
pub(crate) fn list(option: &str, text: &str, driven: Option<usize>) -> Answer<[bool; 6]> {
    let mut set = [false; 6];
    for word in text.split([',', ' ']).filter(|w| !w.is_empty()) {
        match word.to_ascii_lowercase().as_str() {
            "none" => {}
            "all" => set = [true; 6],
            "translations" => set[..3].fill(true),
            "rotations" => set[3..].fill(true),
            "others" => {
                let Some(driven) = driven else {
                    return Err(ErrorCode::Value.failure(format!(
                            "{option} {text}: 'others' means all directions but the one along which the tool is pushed, and here it is pushed along none; name the directions"
                        ),
                    ));
                };
                for (k, free) in set.iter_mut().enumerate() {
                    *free |= k != driven;
                }
            }
            name => match DIRECTIONS.iter().position(|d| *d == name) {
                Some(k) => set[k] = true,
                None => {
                    return Err(ErrorCode::UnknownName.failure(format!(
                            "{option} {text}: '{word}' is no direction; there are x, y, z (moves along) and rx, ry, rz (turns about), and the words all, none, translations, rotations, others"
                        ),
                    ));
                }
            },
        }
    }
    Ok(set)
}

/// Returns the end condition of the tool at `place`, with the constant wrench if it is free.
pub(crate) fn holding(
    moves: &Moves,
    args: &EndArgs,
    place: &Pose,
    constant: Wrench,
    held_by_default: bool,
    driven: Option<&Driven>,
) -> Answer<Holding> {
    let others = |text: &Option<String>| {
        text.as_ref().is_some_and(|t| {
            t.split([',', ' '])
                .any(|w| w.eq_ignore_ascii_case("others"))
        })
    };
    let mut axes = match &args.axes {
        Some(text) => orientation::option("--axes", text)?.to_rotation_matrix(),
        None => Rotation3::identity(),
    };
    // The direction of the six along which the tool is driven, if it is one of them.
    let driven_axis = |axes: &Rotation3<f64>| {
        let d = driven?;
        let local = axes.inverse() * d.axis;
        let k = local.iamax();
        (local[k].abs() > 1.0 - 1e-9).then(|| k + if d.turns { 3 } else { 0 })
    };
    if others(&args.free)
        && args.axes.is_none()
        && driven_axis(&axes).is_none()
        && let Some(d) = driven
    {
        axes = Rotation3::rotation_between(&Vector3::x(), &d.axis).unwrap_or_default();
    }
    let free = match (&args.hold, &args.free) {
        (Some(text), _) => list("--hold", text, driven_axis(&axes))?.map(|held| !held),
        (None, Some(text)) => {
            if others(&args.free) && driven.is_some() && driven_axis(&axes).is_none() {
                return Err(ErrorCode::Unused.failure("--free others: with these --axes the tool is not pushed along one of the axes; leave --axes out, then they follow the direction",
                ));
            }
            list("--free", text, driven_axis(&axes))?
        }
        (None, None) => [!held_by_default; 6],
    };
    let turn = turn_matrix(&axes);
    let rigid: [bool; 6] =
        std::array::from_fn(|k| moves.directions.share(&turn.column(k).into_owned()) < 1e-6);
    if let Some(d) = driven {
        let twist = d.twist();
        if moves.directions.share(&twist) < 1.0 - 1e-6 {
            return Err(ErrorCode::RigidDirection.failure(format!(
                    "the tool cannot be moved {}: the {} is rigid {}. Choose a direction in which it can move",
                    d.description(),
                    moves.subject,
                    motion_list(&rigid, "along or about a skew direction"),
                ),
            ));
        }
        let local = turn.transpose() * twist;
        if let Some(k) = (0..6).find(|&k| free[k] && local[k].abs() > 1e-9) {
            return Err(ErrorCode::Conflict.failure(format!(
                    "the tool is pushed {}, and is to be free in '{}', which is a part of that: hold it there, or write --free others to free all that is across",
                    d.description(),
                    DIRECTIONS[k]
                ),
            ));
        }
    }
    let holding = Holding {
        subject: moves.subject,
        held: names(|k| !free[k] && !rigid[k]),
        free: names(|k| free[k] && !rigid[k]),
        rigid: names(|k| rigid[k]),
        axes_rotation_vector_deg: axes.scaled_axis().map(f64::to_degrees).into(),
        end: EndCondition {
            axes,
            prescribed: free.map(|f| {
                if f {
                    Prescribed::Wrench
                } else {
                    Prescribed::Pose
                }
            }),
            pose: *place,
            wrench: constant,
        },
    };
    holding.accepts("the constant load", &constant)?;
    Ok(holding)
}

fn names(of: impl Fn(usize) -> bool) -> Vec<&'static str> {
    (0..6).filter(|&k| of(k)).map(|k| DIRECTIONS[k]).collect()
}

fn motion_list(set: &[bool; 6], otherwise: &str) -> String {
    let list = names(|k| set[k]);
    if list.is_empty() {
        otherwise.to_owned()
    } else {
        format!("in {}", list.join(", "))
    }
}

impl Holding {
    /// Refuses a wrench on a held tool: it acts only on a free one.
    pub(crate) fn accepts(&self, what: &str, wrench: &Wrench) -> Answer<()> {
        let local = turn_matrix(&self.end.axes).transpose() * wrench.0;
        let most = local.amax();
        let wrong = (0..6)
            .find(|&k| self.end.prescribed[k] == Prescribed::Pose && local[k].abs() > 1e-9 * most);
        match wrong {
            Some(k) => Err(ErrorCode::Conflict.failure(format!(
                    "{what} has a part in '{}', where the tool is held: it would change nothing. Free that direction (--free {}), or leave that part out",
                    DIRECTIONS[k], DIRECTIONS[k]
                ),
            )),
            None => Ok(()),
        }
    }

    /// Describes the end condition in words.
    pub(crate) fn description(&self) -> String {
        let mut text = match (self.held.as_slice(), self.free.as_slice()) {
            ([], []) => format!("The end of this {} cannot move at all", self.subject),
            ([], _) => "The tool is free".to_owned(),
            (held, []) => format!("The tool is held in {}", held.join(", ")),
            (held, free) => format!(
                "The tool is held in {} and free in {}",
                held.join(", "),
                free.join(", ")
            ),
        };
        let turned = Vector3::from(self.axes_rotation_vector_deg);
        if turned.norm() > 1e-9 {
            text.push_str(&format!(
                " (axes turned from the base by the rotation vector {} deg)",
                triple(turned.into(), short)
            ));
        }
        let moves = !self.held.is_empty() || !self.free.is_empty();
        if moves && !self.rigid.is_empty() {
            text.push_str(&format!(
                "; the {} cannot move in {}",
                self.subject,
                self.rigid.join(", ")
            ));
        }
        text.push('.');
        text
    }
}
