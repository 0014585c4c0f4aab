//! The compiled form of a limb: a list of steps with constants folded, which the kernels go along.

use crate::model::chain::Chain;
use crate::model::springs::block::{SpringBlock, SpringLaw};
use crate::model::springs::parallelogram::ParallelogramLaw;
use crate::spatial::MotionKind;

/// Displacement of a motion: `fixed + ratio * command + ratio * coordinate`, m or rad.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Amount {
    pub fixed: f64,
    pub command: Option<(usize, f64)>,
    pub coordinate: Option<(usize, f64)>,
}

/// Support of the coordinate of one motion.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Support {
    /// Support that moves by the command only, or has a fixed coordinate here.
    Fixed,
    /// A passive joint; its place among the plan's passive joints.
    Passive(usize),
    /// A spring of this compliance at rest, m/N or rad/(N m).
    Spring(f64),
}

/// One motion about or along a coordinate axis of the frame reached.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub kind: MotionKind,
    /// 0, 1, 2: x, y, z.
    pub axis: usize,
    pub amount: Amount,
    pub support: Support,
    /// Spring law, if it is not linear, see [`crate::model::springs::bilinear::SingleLaw`].
    pub law: Option<Box<SpringLaw>>,
    /// Index in [`Plan::screws`].
    pub screw: usize,
}

/// A motion that a coordinate or a command drives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Screw {
    pub kind: MotionKind,
    pub coordinate: Option<(usize, f64)>,
    pub command: Option<(usize, f64)>,
}

/// A motion that an unknown of a search, or a passive joint, drives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drive {
    pub unknown: usize,
    pub screw: usize,
    pub ratio: f64,
}

/// Equations of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rows {
    Position,
    Rotation,
    Both,
}

/// A search for joints of the unloaded limb: some of the passive joints, then the commands.
#[derive(Clone, Debug)]
pub(crate) struct Search {
    pub rows: Rows,
    /// Passive joints, by their place among the plan's.
    pub passive: std::ops::Range<usize>,
    /// Commands: all or none.
    pub commands: usize,
    /// Steps up to which the limb is followed.
    pub end: usize,
    /// Drive of each unknown.
    pub drives: Vec<Drive>,
    /// Largest step of each unknown, m or rad.
    pub most: [f64; 6],
}

/// Three passive rotations about one point at the end of a limb: they leave its orientation free.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere {
    /// The step of the first of them.
    pub step: usize,
    /// Arm from the centre to the platform's point, m, platform axes.
    pub arm: [f64; 3],
}

/// A spring of up to six directions at one place, translations before rotations.
#[derive(Clone, Debug)]
pub(crate) struct Spring {
    /// Coordinate of each direction `x y z rx ry rz`.
    pub coordinates: [Option<usize>; 6],
    /// The first of its places in [`Plan::screws`], one per direction that moves.
    pub screw: usize,
    /// Number of directions that move.
    pub moving: usize,
    /// Compliance, row by row; zero where a direction does not move.
    pub compliance: Box<[f64; 36]>,
    /// Stiffness, row by row.
    pub stiffness: Box<[f64; 36]>,
    pub law: Law,
    /// Weight of a segment with a mass along it.
    pub own_weight: Option<OwnWeight>,
}

/// Effect of the weight of a mass along a segment besides that of its halves at the ends, see [`own_weight`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct OwnWeight {
    /// Index of the half of the mass at the near end, among the masses of the limb.
    pub near: usize,
    /// Coordinates of the turns about y and z.
    pub turns: [usize; 2],
    /// A twelfth of mass times length, kg m.
    pub moment: f64,
}

/// Law of a spring of several directions.
#[derive(Clone, Debug)]
pub(crate) enum Law {
    /// Constant matrix.
    Constant,
    /// Law with strains of its own, see [`crate::model::springs::curved`]; with the compliance of the strains, row by
    /// row.
    Curved(SpringLaw, Box<[f64; 36]>),
    /// Two bars whose compliance depends on a passive joint (its place among them).
    Parallelogram(Box<ParallelogramLaw>, usize),
}

/// One factor of the product.
#[derive(Clone, Debug)]
pub(crate) enum Step {
    /// A constant translation, m, axes of the frame reached.
    Shift([f64; 3]),
    /// A constant rotation, row by row.
    Rotate([f64; 9]),
    Joint(Joint),
    Spring(Box<Spring>),
    /// A mass (kg) with its centre here (m, axes of the frame reached).
    Mass {
        at: [f64; 3],
        mass: f64,
    },
}

/// Two crossing passive rotations about one point, then a commanded slide along the third axis through
/// it: where the slide ends says what they are, without a search.
#[derive(Clone, Debug)]
pub(crate) struct Polar {
    /// Step of the first rotation; the second is the next one.
    pub first: usize,
    /// Their axes.
    pub axes: [usize; 2],
    /// Frame of the first rotation as the base sees it: axes by rows, m.
    pub rotation: [f64; 9],
    pub point: [f64; 3],
    /// Length of the slide: `fixed + ratio * command`, m; its sign at home.
    pub command: usize,
    pub fixed: f64,
    pub ratio: f64,
    pub sign: f64,
    /// Sines and cosines of the rotations at home.
    pub home: [(f64, f64); 2],
}

/// A limb as its steps.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub steps: Vec<Step>,
    /// Motions that a coordinate or a command drives, from the base outwards.
    pub screws: Vec<Screw>,
    pub sphere: Option<Sphere>,
    pub polar: Option<Polar>,
    /// Number of coordinates of the chain.
    pub coordinates: usize,
    /// Number of commands.
    pub commands: usize,
    /// Coordinate of every passive joint that is not redundant.
    pub passive: Vec<usize>,
    /// Drives of the passive joints, from the base outwards.
    pub passive_drives: Vec<Drive>,
    /// Searches for the joints, one after the other.
    pub searches: Vec<Search>,
    /// Every coordinate drives one motion, by the ratio of one.
    pub one_each: bool,
    pub home: Vec<f64>,
    pub home_commands: Vec<f64>,
    /// Natural length, m.
    pub length: f64,
    /// Factor of every coordinate that makes it a share of the natural length, or an angle.
    pub units: Vec<f64>,
}

impl Plan {
    /// Number of springs whose compliance depends on the posture.
    pub fn parallelograms(&self) -> usize {
        let own = |step: &&Step| match step {
            Step::Spring(spring) => matches!(spring.law, Law::Parallelogram(..)),
            _ => false,
        };
        self.steps.iter().filter(own).count()
    }

    /// True if joints and springs differ in numbers only: buffers of one fit the other.
    pub fn is_like(&self, other: &Self) -> bool {
        let kind = std::mem::discriminant::<Support>;
        let law = std::mem::discriminant::<Law>;
        let like = |(a, b): (&Step, &Step)| match (a, b) {
            (Step::Joint(a), Step::Joint(b)) => kind(&a.support) == kind(&b.support),
            (Step::Spring(a), Step::Spring(b)) => {
                a.coordinates == b.coordinates
                    && law(&a.law) == law(&b.law)
                    && a.own_weight.is_some() == b.own_weight.is_some()
            }
            (a, b) => std::mem::discriminant(a) == std::mem::discriminant(b),
        };
        (self.coordinates, self.commands) == (other.coordinates, other.commands)
            && self.passive == other.passive
            && self.screws.len() == other.screws.len()
            && self.steps.len() == other.steps.len()
            && self.steps.iter().zip(&other.steps).all(like)
    }

    /// Newton's iteration along the limb is compiled: serial, springs of constant matrices.
    pub fn has_tangent(&self) -> bool {
        let linear = |step: &Step| match step {
            Step::Spring(spring) => matches!(spring.law, Law::Constant),
            _ => true,
        };
        self.passive.is_empty() && self.steps.iter().all(linear)
    }
}

/// Half of the mass of the segments that begin or end at a node, kg; `None` where none does.
pub(super) fn halves_at(chain: &Chain, node: usize) -> Option<f64> {
    let segments = chain.segment_masses().iter();
    let own = segments.filter(|s| s.near == node || s.far == node);
    own.map(|s| 0.5 * s.total()).reduce(|a, b| a + b)
}

/// A segment with a mass along it begins at a node.
pub(super) fn begins_at(chain: &Chain, node: usize) -> bool {
    chain.segment_masses().iter().any(|s| s.near == node)
}

/// Effect of the segment's weight on a spring with these coordinates in the six directions, behind so many masses;
/// `None` for a spring without a mass along it.
///
/// A segment of mass `m` and length `h` with `eta = (u, v, w, rx, ry, rz)` from its near to its far end
/// ([`crate::model::link_mass`]) has its first moment about the near end, near axes, at
///
/// ```text
/// m (h/2 + u/2,  v/2 - h rz/12,  w/2 + h ry/12):   the shapes of bending integrated, with every shear ratio
/// ```
///
/// With `(h + u, v, w)` from the near to the far end, its weight has the potential
/// `V = -g . (m/2 p_near + m/2 p_far + R_near (0, -k rz, k ry))`, `k = m h / 12`: half of the mass at either end, which
/// are points as any, and what the weight bends the segment by, see [`crate::batch::limb::tangent_own_weight`]. Links have their
/// nodes, offsets along x and springs in one set of axes ([`crate::ChainBuilder::link_with`]), and `ry` and `rz` are coordinates
/// of the spring wherever it lies between the ends.
pub(super) fn own_weight(
    chain: &Chain,
    block: &SpringBlock,
    coordinates: &[Option<usize>; 6],
    masses: usize,
) -> Result<Option<OwnWeight>, &'static str> {
    let mut segments = chain.segment_masses().iter();
    let Some(segment) = segments.find(|s| chain.springs()[s.spring].first == block.first) else {
        return Ok(None);
    };
    // The last one is at the node before the spring.
    let Some(near) = masses.checked_sub(1) else {
        return Err("has a mass along it and no node before it");
    };
    let [_, _, _, _, Some(ry), Some(rz)] = *coordinates else {
        return Err("has a mass along it and does not bend both ways");
    };
    Ok(Some(OwnWeight {
        near,
        turns: [ry, rz],
        moment: segment.total() * segment.length / 12.0,
    }))
}
