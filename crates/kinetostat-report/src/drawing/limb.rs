//! One limb as bars and joints, traced along the elements of its chain.

use kinetostat::{
    Chain, MotionKind, Pose,
    model::{Element, Motion, Role, SpringLaw},
};
use nalgebra::{UnitQuaternion, Vector3};

use crate::drawing::parts::{Bar, BarKind, Blob, BlobKind, Ground, Scene};

/// A limb at a state.
pub(super) struct Run<'a> {
    pub(super) limb: usize,
    pub(super) chain: &'a Chain,
    /// Pose of the platform where it starts.
    pub(super) from: Pose,
    pub(super) coordinates: &'a [f64],
    pub(super) commands: &'a [f64],
    /// Rigid offsets before its first motion are a link of their own (a pedestal), not a part of a
    /// plate.
    pub(super) start_is_link: bool,
    /// Rigid offsets behind its last motion are a link of their own.
    pub(super) end_is_link: bool,
    pub(super) on_base: bool,
}

/// Points of a limb's attachment to its platforms.
pub(super) struct Ends {
    pub(super) start: Vector3<f64>,
    pub(super) end: Vector3<f64>,
    pub(super) tip: Vector3<f64>,
}

/// Half lengths of symbols, pixels.
const MOTOR: f64 = 12.0;
const CARRIAGE: f64 = 12.0;
const RAIL: f64 = 48.0;

/// Displacement of a motion, m or rad, and the step from the frame before it to that behind it.
pub(super) fn step(motion: &Motion, coordinates: &[f64], commands: &[f64]) -> (f64, Pose) {
    let coordinate = motion.coordinate.map(|d| d.ratio * coordinates[d.index]);
    let command = motion.command.map(|d| d.ratio * commands[d.index]);
    let displacement = coordinate.unwrap_or(0.0) + command.unwrap_or(0.0);
    let along = motion.axis.into_inner() * displacement;
    let pose = match motion.kind {
        MotionKind::Prismatic => Pose::from_parts(along.into(), UnitQuaternion::identity()),
        MotionKind::Revolute => Pose::from_parts(
            Vector3::zeros().into(),
            UnitQuaternion::from_axis_angle(&motion.axis, displacement),
        ),
    };
    (displacement, pose)
}

/// State of the tracing of a limb.
struct Trace<'a, 'b> {
    run: &'b Run<'a>,
    scene: &'b mut Scene,
    pose: Pose,
    /// Start of an elastic link: its spring comes behind its offset.
    bending: Option<(Pose, Vector3<f64>)>,
    /// Links whose spring lies in their middle: name and the length drawn so far.
    drawn: f64,
    /// Passive turns at one point so far.
    turns: Vec<Vector3<f64>>,
    passive_before: bool,
    seen: Vec<bool>,
    commanded: Vec<bool>,
    /// Point and direction across of an open parallelogram, with its coordinate and width.
    parallelogram: Option<(usize, f64, Pose)>,
}

pub(super) fn trace(scene: &mut Scene, run: &Run<'_>) -> Ends {
    let chain = run.chain;
    let elements = chain.elements();
    let moves = |e: &Element| matches!(e, Element::Motion(_));
    let first = elements.iter().position(moves).unwrap_or(0);
    let last = elements.iter().rposition(moves).unwrap_or(0);
    let mut trace = Trace {
        run,
        scene,
        pose: run.from,
        bending: None,
        drawn: 0.0,
        turns: Vec::new(),
        passive_before: false,
        seen: vec![false; chain.coordinate_count()],
        commanded: vec![false; chain.actuators().len()],
        parallelogram: None,
    };
    let (mut start, mut end) = (None, run.from.translation.vector);
    let mut detour = false;
    for (i, element) in elements.iter().enumerate() {
        match element {
            Element::Rigid(offset) => {
                let to_mass = matches!(elements.get(i + 1), Some(Element::Node(n)) if chain.bodies().iter().any(|b| b.node == *n));
                let bends = trace.bends(i);
                if !to_mass && !detour && offset.translation.vector.norm() > 1e-9 {
                    trace.flush_turns();
                }
                let lead = i < first && !bends && !run.start_is_link;
                let trail = i > last && !run.end_is_link;
                if start.is_none() && bends {
                    start = Some(trace.pose.translation.vector);
                }
                trace.offset(offset, bends, to_mass || detour || lead || trail);
                // A centre of mass is reached by an offset and left by its inverse.
                detour = to_mass;
            }
            Element::Motion(motion) => {
                start.get_or_insert(trace.pose.translation.vector);
                trace.motion(motion);
                if i == last {
                    trace.flush();
                    end = trace.pose.translation.vector;
                }
            }
            Element::Node(_) => {}
        }
    }
    trace.flush();
    let tip = trace.pose.translation.vector;
    let start = start.unwrap_or(tip);
    let begins_on_rail = elements[..].iter().find(|e| moves(e)).is_some_and(
        |e| matches!(e, Element::Motion(m) if m.command.is_some() && m.kind == MotionKind::Prismatic),
    );
    if run.on_base && !begins_on_rail {
        let at = if run.start_is_link {
            run.from.translation.vector
        } else {
            start
        };
        scene.grounds.push(Ground {
            at,
            away: Vector3::zeros(),
        });
    }
    Ends { start, end, tip }
}

impl Trace<'_, '_> {
    fn here(&self) -> Vector3<f64> {
        self.pose.translation.vector
    }

    fn push(&mut self, from: Vector3<f64>, kind: BarKind) {
        let to = self.here();
        self.scene
            .bars
            .push(Bar::straight(Some(self.run.limb), from, to, kind));
    }

    fn blob(&mut self, at: Vector3<f64>, axis: Vector3<f64>, half: f64, kind: BlobKind) {
        let across = square_to(&axis);
        self.scene.blobs.push(Blob {
            at,
            axis,
            across,
            half,
            kind,
        });
    }

    /// True if the offset at this index belongs to an elastic link: springs in several directions follow it, or it is
    /// the rest of a link whose springs lie in the middle.
    fn bends(&self, index: usize) -> bool {
        let chain = self.run.chain;
        let elements = chain.elements();
        let block_of = |e: &Element| {
            let Element::Motion(m) = e else { return None };
            let drive = m.coordinate.filter(|_| m.command.is_none())?;
            chain.springs().iter().find(|b| {
                (b.first..b.first + b.len()).contains(&drive.index)
                    && b.len() >= 3
                    && !matches!(b.law, SpringLaw::Parallelogram(_))
            })
        };
        let next = elements[index + 1..]
            .iter()
            .find(|e| !matches!(e, Element::Node(_)));
        if next.and_then(block_of).is_some() {
            return true;
        }
        let Element::Rigid(offset) = &elements[index] else {
            return false;
        };
        let before = index.checked_sub(1).and_then(|i| block_of(&elements[i]));
        before.and_then(|b| b.segment.as_ref()).is_some_and(|s| {
            let rest = s.link_length - self.drawn;
            let own = offset.translation.vector.norm();
            own > 0.0 && own < 1.01 * rest && offset.translation.vector.dot(&s.along) > 0.99 * own
        })
    }

    fn offset(&mut self, offset: &Pose, bends: bool, hidden: bool) {
        self.flush_bar();
        let from = self.pose;
        self.pose *= *offset;
        let length = offset.translation.vector.norm();
        if bends {
            self.drawn += length;
            self.bending = Some((from, offset.translation.vector));
            return;
        }
        self.drawn = 0.0;
        if !hidden && self.parallelogram.is_none() {
            self.push(from.translation.vector, BarKind::Rigid);
        }
    }

    /// The link that bends ends here.
    fn flush_bar(&mut self) {
        let Some((from, offset)) = self.bending.take() else {
            return;
        };
        let length = offset.norm();
        // A spring without an offset has no length to be seen.
        if length > 0.0 {
            self.scene.bars.push(Bar {
                limb: Some(self.run.limb),
                ends: [from.translation.vector, self.here()],
                tangents: [from.rotation * offset, self.pose.rotation * offset],
                kind: BarKind::Elastic,
            });
        }
    }

    /// Passive turns about one point are one joint.
    fn flush_turns(&mut self) {
        let kind = match self.turns.len() {
            0 => return,
            1 => BlobKind::Turn,
            2 => BlobKind::Universal,
            _ => BlobKind::Spherical,
        };
        let axis = self.turns[0];
        self.turns.clear();
        self.blob(self.here(), axis, 0.0, kind);
    }

    fn flush(&mut self) {
        self.flush_turns();
        self.flush_bar();
    }

    fn motion(&mut self, motion: &Motion) {
        let chain = self.run.chain;
        let (displacement, step) = step(motion, self.run.coordinates, self.run.commands);
        let axis = self.pose.rotation * motion.axis.into_inner();
        let coordinate = motion.coordinate.map(|d| d.index);
        let new = coordinate.is_none_or(|i| !std::mem::replace(&mut self.seen[i], true));
        let passive = coordinate.is_some_and(|i| chain.coordinates()[i].role == Role::Passive);
        if let Some(drive) = motion.command {
            self.flush();
            let first = !std::mem::replace(&mut self.commanded[drive.index], true);
            match motion.kind {
                MotionKind::Prismatic if first => {
                    self.slide(axis, displacement, chain.actuators()[drive.index].limits);
                }
                MotionKind::Revolute if first => {
                    let half = MOTOR * self.scene.unit;
                    self.blob(self.here(), axis, half, BlobKind::Motor);
                }
                MotionKind::Revolute => self.blob(self.here(), axis, 0.0, BlobKind::Turn),
                MotionKind::Prismatic => {}
            }
        } else if passive {
            self.flush_bar();
            self.passive_before = true;
            let index = coordinate.unwrap_or_default();
            let pair = chain.springs().iter().find_map(|b| match &b.law {
                SpringLaw::Parallelogram(law) if law.inclination == index => Some(law.width),
                _ => None,
            });
            match (motion.kind, pair) {
                (_, Some(width)) if new => {
                    self.flush_turns();
                    self.parallelogram = Some((index, width, self.pose));
                }
                (MotionKind::Revolute, _) => self.turns.push(axis),
                (MotionKind::Prismatic, _) => {
                    self.flush_turns();
                    let half = CARRIAGE * self.scene.unit;
                    self.blob(self.here(), axis, half, BlobKind::Slide);
                }
            }
        } else if let Some(index) = coordinate
            && new
        {
            let block = chain
                .springs()
                .iter()
                .find(|b| (b.first..b.first + b.len()).contains(&index));
            if block.is_some_and(|b| b.len() < 3) {
                self.flush();
                if motion.kind == MotionKind::Prismatic {
                    let from = self.here();
                    let coil = Bar::straight(
                        Some(self.run.limb),
                        from,
                        from + axis * displacement,
                        BarKind::Spring,
                    );
                    self.scene.bars.push(coil);
                } else {
                    self.blob(self.here(), axis, 0.0, BlobKind::Spring);
                }
            }
        }
        self.pose *= step;
        if let Some((index, width, from)) = self.parallelogram
            && coordinate == Some(index)
            && !new
        {
            self.turns.clear();
            self.close_parallelogram(width, &from);
        }
    }

    /// Two bars side by side, each with a joint at both ends.
    fn close_parallelogram(&mut self, width: f64, from: &Pose) {
        self.parallelogram = None;
        let to = self.pose;
        let half = Vector3::z() * (0.5 * width);
        let points = |pose: &Pose| {
            let p = pose.translation.vector;
            [p - pose.rotation * half, p + pose.rotation * half]
        };
        let (near, far) = (points(from), points(&to));
        let limb = Some(self.run.limb);
        let bar = |a: Vector3<f64>, b: Vector3<f64>, kind| Bar::straight(limb, a, b, kind);
        let axis = to.rotation * Vector3::y();
        for bar in [
            bar(near[0], far[0], BarKind::Elastic),
            bar(near[1], far[1], BarKind::Elastic),
            bar(near[0], near[1], BarKind::Rigid),
            bar(far[0], far[1], BarKind::Rigid),
        ] {
            self.scene.bars.push(bar);
        }
        for at in near.into_iter().chain(far) {
            self.blob(at, axis, 0.0, BlobKind::Turn);
        }
    }

    /// A drive that slides: a carriage on a rail where nothing passive comes before it, else a
    /// sleeve with a rod.
    fn slide(&mut self, axis: Vector3<f64>, travel: f64, limits: Option<(f64, f64)>) {
        let (from, unit) = (self.here(), self.scene.unit);
        let to = from + axis * travel;
        if self.passive_before {
            let least = match limits {
                Some((low, high)) if low * travel > 0.0 && high * travel > 0.0 => {
                    low.abs().min(high.abs()).min(travel.abs()) * travel.signum()
                }
                _ => 0.6 * travel,
            };
            let (near, far) = (0.06 * travel, 0.92 * least);
            let middle = from + axis * (0.5 * (near + far));
            let rod = |a: f64, b: f64| {
                let (a, b) = (from + axis * a, from + axis * b);
                Bar::straight(Some(self.run.limb), a, b, BarKind::Rod)
            };
            let mut ram = rod(0.0, travel);
            ram.kind = BarKind::Ram;
            let parts = [rod(0.0, near), rod(far, travel), ram];
            self.scene.bars.extend(parts);
            self.blob(middle, axis, 0.5 * (far - near).abs(), BlobKind::Sleeve);
            return;
        }
        let room = self.scene.unit * 420.0;
        let short = RAIL * unit;
        let (low, high) = limits.map_or((travel - short, travel + short), |(low, high)| {
            (
                low.max(travel - room).min(travel),
                high.min(travel + room).max(travel),
            )
        });
        let ends = [low, high].map(|s| from + axis * s);
        self.scene.bars.push(Bar::straight(
            Some(self.run.limb),
            ends[0],
            ends[1],
            BarKind::Rail,
        ));
        self.blob(to, axis, CARRIAGE * unit, BlobKind::Sleeve);
        if self.run.on_base && self.commanded.iter().filter(|c| **c).count() == 1 {
            for at in ends {
                self.scene.grounds.push(Ground { at, away: axis });
            }
        }
    }
}

/// A unit vector square to an axis.
fn square_to(axis: &Vector3<f64>) -> Vector3<f64> {
    let mut other = Vector3::zeros();
    other[axis.iamin()] = 1.0;
    (other - axis * axis.dot(&other)).normalize()
}
