//! Frames of the parts of a limb with the machine at home, and loads of the weight on its joints.

use kinetostat::linalg::SingularValues;
use kinetostat::model::Element;
use kinetostat::number::{larger, smaller};
use kinetostat::{Chain, Mechanism, MotionKind, Pose};
use nalgebra::{DMatrix, Translation3, UnitQuaternion, Vector3};

/// Poses in the chain's base before every element and at the end, at home.
pub(crate) fn frames(chain: &Chain) -> Vec<Pose> {
    let (coordinates, commands) = (chain.home_coordinates(), chain.home_commands());
    let mut pose = Pose::identity();
    let mut list = vec![pose];
    for element in chain.elements() {
        match element {
            Element::Rigid(offset) => pose *= offset,
            Element::Motion(m) => {
                let share = |drive: Option<kinetostat::model::Drive>, values: &[f64]| {
                    drive.map_or(0.0, |d| {
                        d.ratio * values.get(d.index).copied().unwrap_or(0.0)
                    })
                };
                let amount = share(m.coordinate, &coordinates) + share(m.command, &commands);
                match m.kind {
                    MotionKind::Prismatic => {
                        pose *= Translation3::from(m.axis.into_inner() * amount);
                    }
                    MotionKind::Revolute => {
                        pose *= UnitQuaternion::from_axis_angle(&m.axis, amount);
                    }
                }
            }
            Element::Node(_) => {}
        }
        list.push(pose);
    }
    list
}

/// Size of a machine, m: the longest way from joint to joint of any limb at home, the way to the
/// first of them left out.
pub(crate) fn machine_size(mechanism: &Mechanism) -> f64 {
    let length = |chain: &Chain| {
        // Offsets on the way to a centre of mass and back are no part of it.
        let frames = frames(chain);
        let joints = chain.elements().iter().zip(&frames);
        let joints = joints.filter(|(e, _)| matches!(e, Element::Motion(_)));
        let mut at: Vec<Vector3<f64>> = joints.map(|(_, f)| f.translation.vector).collect();
        at.extend(frames.last().map(|f| f.translation.vector));
        at.windows(2).map(|w| (w[1] - w[0]).norm()).sum::<f64>()
    };
    let limbs = mechanism.limbs().iter();
    limbs.map(|l| length(&l.nominal)).fold(0.0, larger)
}

/// Length of an arm from its second drive on, m: the first one only turns it about its foot. Zero where fewer than three turn.
pub(crate) fn reach(chain: &Chain) -> f64 {
    let frames = frames(chain);
    let drives =
        chain
            .elements()
            .iter()
            .zip(&frames)
            .filter_map(|(element, frame)| match element {
                Element::Motion(m) if m.command.is_some() && m.kind == MotionKind::Revolute => {
                    Some(frame)
                }
                _ => None,
            });
    let mut at: Vec<Vector3<f64>> = drives.map(|frame| frame.translation.vector).collect();
    if at.len() < 3 {
        return 0.0;
    }
    at.extend(frames.last().map(|frame| frame.translation.vector));
    at.windows(2).skip(1).map(|w| (w[1] - w[0]).norm()).sum()
}

/// Inverse condition number of the Jacobian at home of an arm of six drives or more, rotations at its reach; `None` for
/// other machines.
pub(crate) fn conditioning(mechanism: &Mechanism) -> Option<f64> {
    let [limb] = mechanism.limbs() else {
        return None;
    };
    let chain = &limb.nominal;
    let reach = reach(chain);
    let (frames, count) = (frames(chain), chain.actuators().len());
    if count < 6 || reach < 1e-3 {
        return None;
    }
    let end = frames.last()?.translation.vector;
    let mut jacobian = DMatrix::<f64>::zeros(6, count);
    for (element, frame) in chain.elements().iter().zip(&frames) {
        let Element::Motion(motion) = element else {
            continue;
        };
        let Some(drive) = motion.command else {
            continue;
        };
        let axis = frame.rotation * motion.axis.into_inner();
        let (shift, turn) = match motion.kind {
            MotionKind::Prismatic => (axis, Vector3::zeros()),
            MotionKind::Revolute => (axis.cross(&(end - frame.translation.vector)), axis),
        };
        for k in 0..3 {
            jacobian[(k, drive.index)] += drive.ratio * shift[k] / reach;
            jacobian[(3 + k, drive.index)] += drive.ratio * turn[k];
        }
    }
    let values = SingularValues::of(&jacobian);
    Some(values.least() / values.largest())
}

/// The body whose centre of mass is farthest from the nearest joint or end of its limb, and that
/// distance, m.
pub(crate) fn farthest(chain: &Chain) -> Option<(String, f64)> {
    let frames = frames(chain);
    let ends = [frames.first()?, frames.last()?];
    let joints = chain.elements().iter().zip(&frames);
    let joints = joints.filter(|(e, _)| matches!(e, Element::Motion(_)));
    let near: Vec<Vector3<f64>> = joints
        .map(|(_, f)| f)
        .chain(ends)
        .map(|f| f.translation.vector)
        .collect();
    let at = |node: usize| {
        let own = |e: &Element| matches!(e, Element::Node(n) if *n == node);
        let index = chain.elements().iter().position(own)?;
        Some(frames[index].translation.vector)
    };
    chain
        .bodies()
        .iter()
        .filter_map(|b| {
            let centre = at(b.node)?;
            let away = near.iter().map(|p| (centre - p).norm());
            Some((b.name.clone(), away.fold(f64::INFINITY, smaller)))
        })
        .max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Load of the weight on a coordinate.
pub(crate) struct Load {
    /// Index of the coordinate.
    pub(crate) coordinate: usize,
    /// Magnitude of the force (N) or moment (N m).
    pub(crate) size: f64,
}

/// Forces and moments of all weights behind each coordinate of a limb at home, the platform's
/// included.
pub(crate) fn moments(mechanism: &Mechanism, limb: usize) -> Vec<Load> {
    let limb = &mechanism.limbs()[limb];
    let chain = &limb.nominal;
    let base = mechanism.platforms()[limb.from].home;
    let frames: Vec<Pose> = frames(chain).iter().map(|f| base * f).collect();
    let platform = &mechanism.platforms()[limb.to];
    let end = platform.home * nalgebra::Point3::from(platform.centre_of_mass);
    let mut weights: Vec<(usize, Vector3<f64>, f64)> =
        vec![(chain.elements().len(), end.coords, platform.mass)];
    for body in chain.bodies() {
        let own = |e: &Element| matches!(e, Element::Node(n) if *n == body.node);
        if let Some(i) = chain.elements().iter().position(own) {
            weights.push((i, frames[i].translation.vector, body.mass));
        }
    }
    let mut loads: Vec<Load> = Vec::new();
    for (i, element) in chain.elements().iter().enumerate() {
        let Element::Motion(motion) = element else {
            continue;
        };
        let Some(drive) = motion.coordinate else {
            continue;
        };
        let axis = frames[i].rotation * motion.axis;
        let sum: f64 = weights
            .iter()
            .filter(|(at, _, _)| *at > i)
            .map(|(_, centre, mass)| {
                let force = mechanism.gravity() * *mass;
                match motion.kind {
                    MotionKind::Prismatic => force.dot(&axis),
                    MotionKind::Revolute => (centre - frames[i].translation.vector)
                        .cross(&force)
                        .dot(&axis),
                }
            })
            .sum::<f64>()
            * drive.ratio;
        match loads.iter_mut().find(|l| l.coordinate == drive.index) {
            Some(load) => load.size += sum,
            None => loads.push(Load {
                coordinate: drive.index,
                size: sum,
            }),
        }
    }
    for load in &mut loads {
        load.size = load.size.abs();
    }
    loads
}
