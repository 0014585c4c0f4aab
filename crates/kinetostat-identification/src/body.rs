//! What is loaded and read: the tool, or a node of a limb, whose motion is that of the joints and springs before it.

use kinetostat::machine::{LinearisedMachine, MachineMotion, MachineResidual, MechanismState};
use kinetostat::model::Kinematics;
use kinetostat::{Mechanism, Pose, Posture, Wrench};
use nalgebra::{Matrix6xX, Vector3, Vector6};

/// A body that carries a load or a marker.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Body {
    /// The tool.
    #[default]
    Tool,
    /// A node of a limb, or one of its bodies.
    Node {
        /// Index of the limb.
        limb: usize,
        /// Index of the node in its chain.
        node: usize,
    },
}

/// A point of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyPoint {
    /// The body.
    pub on: Body,
    /// Place in its frame, m.
    pub at: Vector3<f64>,
}

impl From<Vector3<f64>> for BodyPoint {
    /// A point of the tool.
    fn from(at: Vector3<f64>) -> Self {
        Self { on: Body::Tool, at }
    }
}

impl Body {
    /// The body of a name: `NODE`, or `LIMB:NODE` where several limbs have a node of that name.
    ///
    /// # Errors
    /// No such node, or several: what to write instead.
    pub fn named(mechanism: &Mechanism, name: &str) -> Result<Self, String> {
        let (of, wanted) = match name.split_once(':') {
            Some((limb, node)) => (Some(limb.trim()), node.trim()),
            None => (None, name),
        };
        let limbs = || {
            let all = mechanism.limbs().iter().enumerate();
            all.filter(|(_, limb)| of.is_none_or(|of| of == limb.name))
        };
        let found: Vec<(usize, usize)> = limbs()
            .filter_map(|(i, limb)| Some((i, limb.actual.node(wanted).ok()?)))
            .collect();
        match found[..] {
            [(limb, node)] => Ok(Self::Node { limb, node }),
            [] => {
                let known = limbs().flat_map(|(_, limb)| {
                    limb.actual
                        .nodes()
                        .iter()
                        .map(|node| written(mechanism, &limb.name, node))
                });
                let known: Vec<String> = known.collect();
                Err(match known.is_empty() {
                    true => {
                        let limbs: Vec<&str> =
                            mechanism.limbs().iter().map(|l| l.name.as_str()).collect();
                        format!("no limb has this name; there are {}", limbs.join(", "))
                    }
                    false => format!(
                        "no node of the model has this name; without one the tool is meant, and there are {}. `{{ node = \"NAME\" }}` among the elements of a chain adds one",
                        known.join(", ")
                    ),
                })
            }
            _ => {
                let each = found
                    .iter()
                    .map(|(limb, _)| format!("{}:{wanted}", mechanism.limbs()[*limb].name));
                Err(format!(
                    "several limbs have a node of this name: write {}",
                    each.collect::<Vec<_>>().join(" or ")
                ))
            }
        }
    }
}

/// Name of a node as a table has it.
fn written(mechanism: &Mechanism, limb: &str, node: &str) -> String {
    match mechanism.limbs().len() {
        1 => node.to_owned(),
        _ => format!("{limb}:{node}"),
    }
}

/// A body of a machine in a state: its pose, and how the motions of the machine move it.
#[derive(Clone)]
pub(crate) struct PlacedBody {
    /// Base from body; of the tool the frame of the posture, at the point of the load.
    pub pose: Pose,
    moves: Moves,
}

#[derive(Clone)]
enum Moves {
    Platform(usize),
    Node {
        limb: usize,
        /// Platform at which the limb starts.
        from: usize,
        /// By coordinates, commands and base.
        jacobian: Matrix6xX<f64>,
    },
}

impl PlacedBody {
    /// A body in a state of the posture's machine.
    pub fn of(body: Body, posture: &Posture, state: &MechanismState) -> Self {
        let mechanism = posture.mechanism();
        match body {
            Body::Tool => Self {
                pose: state.platforms[mechanism.tool()],
                moves: Moves::Platform(mechanism.tool()),
            },
            Body::Node { limb, node } => {
                let own = &mechanism.limbs()[limb];
                let kinematics = Kinematics::with_moving_base(
                    &own.actual,
                    &state.platforms[own.from],
                    &state.coordinates[limb],
                    &posture.limbs()[limb].commands,
                );
                Self {
                    pose: kinematics.node_pose(node),
                    moves: Moves::Node {
                        limb,
                        from: own.from,
                        jacobian: kinematics.jacobian(node),
                    },
                }
            }
        }
    }

    /// Motion of the body's origin, base axes, m and rad, in a motion of the machine.
    pub fn twist(&self, motion: &MachineMotion) -> Vector6<f64> {
        match &self.moves {
            Moves::Platform(platform) => motion.platforms[*platform].0,
            Moves::Node {
                limb,
                from,
                jacobian,
            } => {
                let own = &motion.coordinates[*limb];
                let last = jacobian.ncols() - 6;
                let by_joints = own.iter().zip(jacobian.column_iter());
                by_joints
                    .map(|(x, column)| column * *x)
                    .sum::<Vector6<f64>>()
                    + jacobian.fixed_columns::<6>(last) * motion.platforms[*from].0
            }
        }
    }

    /// Motion of the machine under a small wrench on the body, about its origin, base axes; `zero` is a residual of nothing.
    pub fn motion_under(
        &self,
        wrench: &Wrench,
        tangent: &mut LinearisedMachine<'_>,
        zero: &MachineResidual,
    ) -> Option<MachineMotion> {
        let mut push = zero.clone();
        match &self.moves {
            Moves::Platform(platform) => push.platforms[*platform] = *wrench,
            Moves::Node {
                limb,
                from,
                jacobian,
            } => {
                let pushed = jacobian.tr_mul(&wrench.0);
                let joints = push.torques[*limb].iter_mut();
                joints
                    .zip(pushed.iter())
                    .for_each(|(into, own)| *into = *own);
                let base = pushed.fixed_rows::<6>(pushed.len() - 6);
                push.platforms[*from].0.copy_from(&base);
            }
        }
        tangent.removing(&push)
    }
}
