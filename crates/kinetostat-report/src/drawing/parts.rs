//! Parts of a drawing in space: bars, joints, plates, ground marks and words, in metres and base axes.

use kinetostat::Pose;
use nalgebra::Vector3;

/// A straight piece of a limb, or a curved one where it bends.
#[derive(Clone, Debug)]
pub(super) struct Bar {
    /// Index of the limb; none for what belongs to a platform or to a load.
    pub(super) limb: Option<usize>,
    pub(super) ends: [Vector3<f64>; 2],
    /// Directions of the bar at its ends, as long as the bar.
    pub(super) tangents: [Vector3<f64>; 2],
    pub(super) kind: BarKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
#[derive(Clone, Debug)]
pub(super) struct Blob {
    pub(super) at: Vector3<f64>,
    /// Unit vector.
    pub(super) axis: Vector3<f64>,
    /// A second direction, square to the axis.
    pub(super) across: Vector3<f64>,
    /// Half of its length along the axis, m.
    pub(super) half: f64,
    pub(super) kind: BlobKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
#[derive(Clone, Debug)]
pub(super) struct Plate {
    pub(super) points: Vec<Vector3<f64>>,
    pub(super) base: bool,
}

/// Attachment to the base.
#[derive(Clone, Debug)]
pub(super) struct Ground {
    pub(super) at: Vector3<f64>,
    /// Direction into the ground.
    pub(super) away: Vector3<f64>,
}

/// A word beside a point.
#[derive(Clone, Debug)]
pub(super) struct Word {
    pub(super) at: Vector3<f64>,
    /// Radius of the symbol at the point, pixels.
    pub(super) radius: f64,
    pub(super) text: String,
}

/// Everything, at one state of the machine.
#[derive(Clone, Debug, Default)]
pub(super) struct Scene {
    pub(super) bars: Vec<Bar>,
    pub(super) blobs: Vec<Blob>,
    pub(super) plates: Vec<Plate>,
    pub(super) grounds: Vec<Ground>,
    pub(super) words: Vec<Word>,
    pub(super) tool: Pose,
    /// Diagonal of the box around it, m.
    pub(super) size: f64,
    /// Length of about a pixel on the drawing, m.
    pub(super) unit: f64,
}
