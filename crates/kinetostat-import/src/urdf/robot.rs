//! Content of a URDF, as numbers in its own units (m, rad, kg), each with its place in the file.

use kinetostat::{MotionKind, Pose};
use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};

use crate::log::{At, suggestion};

/// `<origin>`: translation (m), then roll, pitch, yaw (rad): Rz(yaw) Ry(pitch) Rx(roll).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Origin {
    pub(crate) xyz: [f64; 3],
    pub(crate) rpy: [f64; 3],
}

impl Origin {
    pub(crate) fn pose(&self) -> Pose {
        let [r, p, y] = self.rpy;
        Isometry3::from_parts(
            Translation3::from(Vector3::from(self.xyz)),
            UnitQuaternion::from_euler_angles(r, p, y),
        )
    }
}

/// Mass, its centre and its inertia about that centre.
#[derive(Clone, Debug)]
pub(crate) struct Inertial {
    pub(crate) at: At,
    /// kg.
    pub(crate) mass: f64,
    /// Centre and axes in the link's frame.
    pub(crate) origin: Origin,
    /// About the centre, axes of `origin`, kg m^2.
    pub(crate) inertia: Matrix3<f64>,
    /// The file has an inertia that no model can have, and zero stands for it.
    pub(crate) left_out: bool,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Link {
    pub(crate) at: At,
    pub(crate) name: String,
    pub(crate) inertial: Option<Inertial>,
    /// `<inertial>` stands in the file (it may have been wrong).
    pub(crate) has_inertial: bool,
    /// Mesh files as written, `package://...` included.
    pub(crate) meshes: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum JointType {
    Fixed,
    /// Turns (`revolute` and `continuous`) or slides.
    Moving(MotionKind),
    /// `floating` and `planar`.
    Several(&'static str),
}

/// Follows another joint: `multiplier * q + offset`.
#[derive(Clone, Debug)]
pub(crate) struct Mimic {
    pub(crate) at: At,
    pub(crate) joint: String,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}

#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) at: At,
    pub(crate) name: String,
    pub(crate) kind: JointType,
    pub(crate) word: String,
    pub(crate) origin: Origin,
    pub(crate) parent: (At, String),
    pub(crate) child: (At, String),
    /// Axis as written; unit x if not given.
    pub(crate) axis: [f64; 3],
    pub(crate) limits: Option<(f64, f64)>,
    pub(crate) limit_at: Option<At>,
    pub(crate) mimic: Option<Mimic>,
}

/// One side of a `<constraint>`.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    pub(crate) at: At,
    pub(crate) link: String,
    pub(crate) origin: Origin,
    pub(crate) axis: Option<[f64; 3]>,
}

/// Joint by which a loop is closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Closure {
    /// Slides or turns about the parent's axis.
    Single(MotionKind),
    /// Turns about the parent's axis, then about the child's.
    Universal,
    /// Turns about x, y, z of the parent's origin.
    Spherical,
}

/// The joint at which a loop was cut.
#[derive(Clone, Debug)]
pub(crate) struct Constraint {
    pub(crate) at: At,
    pub(crate) name: String,
    pub(crate) closure: Closure,
    pub(crate) parent: Side,
    pub(crate) child: Side,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Robot {
    pub(crate) at: At,
    pub(crate) name: String,
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<Joint>,
    pub(crate) constraints: Vec<Constraint>,
    /// Links that joints name and nothing describes; they are among `links`.
    pub(crate) missing: Vec<Missing>,
}

/// A link that a joint names and nothing describes.
#[derive(Clone, Debug)]
pub(crate) struct Missing {
    pub(crate) at: At,
    /// Index of the joint.
    pub(crate) joint: usize,
    pub(crate) name: String,
    /// Suggestion.
    pub(crate) help: String,
}

impl Robot {
    /// Adds the links that are missing, without a mass: beside the chain that is asked for they do not matter.
    pub(crate) fn add_missing_links(&mut self) {
        let known: Vec<String> = self.links.iter().map(|link| link.name.clone()).collect();
        for (joint, found) in self.joints.iter().enumerate() {
            for (at, name) in [&found.parent, &found.child] {
                if known.contains(name) {
                    continue;
                }
                self.missing.push(Missing {
                    at: at.clone(),
                    joint,
                    name: name.clone(),
                    help: suggestion(name, known.iter().map(String::as_str)),
                });
                if !self.links.iter().any(|link| link.name == *name) {
                    self.links.push(Link {
                        at: at.clone(),
                        name: name.clone(),
                        ..Link::default()
                    });
                }
            }
        }
    }
}
