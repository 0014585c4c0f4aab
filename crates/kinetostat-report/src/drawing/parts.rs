//! Parts of a machine in space: bars, joints, plates, ground marks and words, in metres and base axes.
//!
//! Drawings are painted from them, and the view shows them as JSON, in millimetres.

use kinetostat::Pose;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Serialize, Serializer};

/// A straight piece of a limb, or a curved one where it bends.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Bar {
    /// Index of the limb; none for what belongs to a platform or to a load.
    pub(super) limb: Option<usize>,
    #[serde(rename = "ends_mm", serialize_with = "pair_in_mm")]
    #[schemars(with = "[[f64; 3]; 2]")]
    pub(super) ends: [Vector3<f64>; 2],
    /// Directions of the bar at its ends, as long as the bar.
    #[serde(rename = "tangents_mm", serialize_with = "pair_in_mm")]
    #[schemars(with = "[[f64; 3]; 2]")]
    pub(super) tangents: [Vector3<f64>; 2],
    pub(super) kind: BarKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum BarKind {
    Rigid,
    /// A link with springs.
    Elastic,
    /// Rod that comes out of a sleeve.
    Rod,
    /// A rod with its sleeve, as one line of the drawn motion; the machine itself shows its parts.
    Ram,
    /// Goes where another bar is already: a side branch on its way back.
    Twice,
    /// Rail of a carriage.
    Rail,
    /// A compensator between two points, or a drawn line that pulls.
    Spring,
}

impl Bar {
    pub(super) fn straight(
        limb: Option<usize>,
        from: Vector3<f64>,
        to: Vector3<f64>,
        kind: BarKind,
    ) -> Self {
        Self {
            limb,
            ends: [from, to],
            tangents: [to - from; 2],
            kind,
        }
    }

    pub(super) fn length(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }

    /// Offset of the middle of the cubic with these ends and tangents from that of the chord.
    pub(super) fn bow(&self) -> Vector3<f64> {
        (self.tangents[0] - self.tangents[1]) / 8.0
    }

    pub(super) fn middle(&self) -> Vector3<f64> {
        0.5 * (self.ends[0] + self.ends[1]) + self.bow()
    }
}

/// A joint or a drive.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Blob {
    #[serde(rename = "at_mm", serialize_with = "in_mm")]
    #[schemars(with = "[f64; 3]")]
    pub(super) at: Vector3<f64>,
    /// Unit vector.
    #[serde(serialize_with = "plain")]
    #[schemars(with = "[f64; 3]")]
    pub(super) axis: Vector3<f64>,
    /// A second direction, square to the axis.
    #[serde(serialize_with = "plain")]
    #[schemars(with = "[f64; 3]")]
    pub(super) across: Vector3<f64>,
    /// Half of its length along the axis.
    #[serde(rename = "half_mm", serialize_with = "length_in_mm")]
    pub(super) half: f64,
    pub(super) kind: BlobKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum BlobKind {
    /// A drive that turns: a cylinder.
    Motor,
    /// A drive that slides: a box.
    Sleeve,
    /// A passive slide: an empty box.
    Slide,
    /// Passive: about one, two, three axes.
    Turn,
    Universal,
    Spherical,
    /// A joint that only a spring holds.
    Spring,
}

/// A body between limbs, or the base.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Plate {
    #[serde(rename = "points_mm", serialize_with = "all_in_mm")]
    #[schemars(with = "Vec<[f64; 3]>")]
    pub(super) points: Vec<Vector3<f64>>,
    pub(super) base: bool,
}

/// Attachment to the base.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Ground {
    #[serde(rename = "at_mm", serialize_with = "in_mm")]
    #[schemars(with = "[f64; 3]")]
    pub(super) at: Vector3<f64>,
    /// Direction into the ground.
    #[serde(serialize_with = "plain")]
    #[schemars(with = "[f64; 3]")]
    pub(super) away: Vector3<f64>,
}

/// A word beside a point.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Word {
    #[serde(rename = "at_mm", serialize_with = "in_mm")]
    #[schemars(with = "[f64; 3]")]
    pub(super) at: Vector3<f64>,
    /// Radius of the symbol at the point, pixels.
    #[serde(skip)]
    pub(super) radius: f64,
    pub(super) text: String,
}

/// A pose as pages show it: base from body.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ShownPose {
    /// Origin, mm.
    pub position_mm: [f64; 3],
    /// Rotation as a unit quaternion.
    pub quaternion_xyzw: [f64; 4],
}

impl From<&Pose> for ShownPose {
    fn from(pose: &Pose) -> Self {
        Self {
            position_mm: mm(&pose.translation.vector),
            quaternion_xyzw: pose.rotation.coords.into(),
        }
    }
}

/// A machine in one of its states, in space.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct Scene {
    pub(super) bars: Vec<Bar>,
    #[serde(rename = "joints")]
    pub(super) blobs: Vec<Blob>,
    pub(super) plates: Vec<Plate>,
    pub(super) grounds: Vec<Ground>,
    pub(super) words: Vec<Word>,
    #[serde(serialize_with = "shown_pose")]
    #[schemars(with = "ShownPose")]
    pub(super) tool: Pose,
    /// Diagonal of the box around it.
    #[serde(rename = "size_mm", serialize_with = "length_in_mm")]
    pub(super) size: f64,
    /// Length of about a pixel on the drawing, m.
    #[serde(skip)]
    pub(super) unit: f64,
}

impl Scene {
    /// Diagonal of the box around the machine, m.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.size
    }
}

fn mm(v: &Vector3<f64>) -> [f64; 3] {
    (v * 1e3).into()
}

/// Millimetres to the nanometre: what is drawn needs no more, and a scene is half as long.
fn drawn_mm(v: &Vector3<f64>) -> [f64; 3] {
    v.map(|x| (x * 1e9).round() / 1e6).into()
}

fn in_mm<S: Serializer>(v: &Vector3<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    drawn_mm(v).serialize(serializer)
}

fn pair_in_mm<S: Serializer>(v: &[Vector3<f64>; 2], serializer: S) -> Result<S::Ok, S::Error> {
    [drawn_mm(&v[0]), drawn_mm(&v[1])].serialize(serializer)
}

fn all_in_mm<S: Serializer>(v: &[Vector3<f64>], serializer: S) -> Result<S::Ok, S::Error> {
    v.iter()
        .map(drawn_mm)
        .collect::<Vec<_>>()
        .serialize(serializer)
}

fn shown_pose<S: Serializer>(pose: &Pose, serializer: S) -> Result<S::Ok, S::Error> {
    ShownPose::from(pose).serialize(serializer)
}

fn plain<S: Serializer>(v: &Vector3<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    <[f64; 3]>::from(v.map(|x| (x * 1e9).round() / 1e9)).serialize(serializer)
}

fn length_in_mm<S: Serializer>(length: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    (1e3 * length).serialize(serializer)
}
