//! Checks that a load fits its chain, that its tangent is the derivative of its wrenches, and that a potential exists.

use nalgebra::{DVector, Unit, UnitQuaternion, Vector3};

use crate::error::{Error, Result};
use crate::linalg::sparse::largest;
use crate::model::chain::{Chain, Element};
use crate::model::kinematics::Kinematics;
use crate::model::limits::check_number;
use crate::model::loads::load::Load;
use crate::number::{larger, short};
use crate::spatial::{MotionKind, Pose, Wrench};

/// Relative error of a tangent from which debug builds refuse it before solving.
const TANGENT_TOLERANCE: f64 = 1e-5;

/// Comparison of a load's tangent with differences of its wrenches.
#[derive(Clone, Debug, PartialEq, Default)]
#[non_exhaustive]
pub struct TangentCheck {
    /// Largest difference as a share of the largest change or wrench; moments are divided by the
    /// chain's natural length, changes are per radian or per natural length of slide.
    pub largest: f64,
    /// Node whose wrench changes otherwise than the tangent says.
    pub node: usize,
    /// Name of the coordinate that was moved.
    pub coordinate: String,
}

/// Compares a load's tangent with fourth-order differences of its wrenches over the motions that
/// the chain can make, at coordinates and commands (m, rad) over a base.
///
/// # Errors
/// Lists of the wrong length or with numbers that are not finite; a load that does not fit.
pub fn check_tangents(
    chain: &Chain,
    base: &Pose,
    coordinates: &[f64],
    commands: &[f64],
    load: &Load,
) -> Result<TangentCheck> {
    chain.check(coordinates, commands)?;
    let place = chain.place();
    crate::model::limits::check_pose(&place, "the pose of the base", base)?;
    let kinematics = Kinematics::new(chain, base, coordinates, commands);
    fits(chain, &kinematics, load)?;
    let length = chain.scale().length;
    let nodes = chain.nodes().len();
    // All node wrenches in newtons, stacked.
    let stacked = |kinematics: &Kinematics| {
        let mut list = Vec::new();
        load.add_wrenches(chain, kinematics, 1.0, &mut list);
        let mut all = DVector::zeros(6 * nodes);
        for (node, wrench) in list {
            for k in 0..6 {
                let unit = if k < 3 { 1.0 } else { length };
                all[6 * node + k] += wrench.0[k] / unit;
            }
        }
        all
    };
    let mut tangents = Vec::new();
    load.add_tangents(chain, &kinematics, 1.0, &mut tangents);
    // Also of what cancels within a body.
    let mut list = Vec::new();
    load.add_wrenches(chain, &kinematics, 1.0, &mut list);
    let newtons = |w: &Wrench| w.force().norm().max(w.moment().norm() / length);
    let mut size = list.iter().map(|(_, w)| newtons(w)).fold(0.0_f64, larger);
    let mut worst = TangentCheck::default();
    for (i, coordinate) in chain.coordinates().iter().enumerate() {
        let unit = match coordinate.kind {
            MotionKind::Prismatic => length,
            MotionKind::Revolute => 1.0,
        };
        let mut exact = DVector::zeros(6 * nodes);
        for tangent in &tangents {
            let change = tangent.matrix * kinematics.jacobian(tangent.by).column(i) * unit;
            for k in 0..6 {
                exact[6 * tangent.on + k] += change[k] / if k < 3 { 1.0 } else { length };
            }
        }
        let step = 1e-4;
        let at = |share: f64| {
            let mut near = coordinates.to_vec();
            near[i] += share * step * unit;
            stacked(&Kinematics::new(chain, base, &near, commands))
        };
        let differences: DVector<f64> =
            (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step);
        size = larger(larger(size, largest(&exact)), largest(&differences));
        let off = (exact - differences).abs();
        let row = off.imax();
        // A difference that is not a number is the worst of all.
        if off[row] > worst.largest || off.iter().any(|x| x.is_nan()) {
            worst = TangentCheck {
                largest: if off.iter().any(|x| x.is_nan()) {
                    f64::INFINITY
                } else {
                    off[row]
                },
                node: row / 6,
                coordinate: coordinate.name.clone(),
            };
        }
    }
    worst.largest /= larger(size, f64::MIN_POSITIVE);
    Ok(worst)
}

/// Refuses loads that do not fit a chain: nodes it does not have, numbers that are not finite.
pub(crate) fn fits(chain: &Chain, kinematics: &Kinematics, load: &Load) -> Result<()> {
    let place = || chain.place();
    let (values, nodes) = match load {
        Load::Dead { node, wrench } => (wrench.0.as_slice().to_vec(), vec![*node]),
        Load::Gravity(g) => (g.as_slice().to_vec(), Vec::new()),
        Load::Custom(load) => (Vec::new(), load.nodes()),
    };
    let number = |value: &f64| check_number(&place(), || "a load".into(), *value);
    values.iter().try_for_each(number)?;
    if let Some(node) = nodes.into_iter().find(|&n| n > chain.tip()) {
        return Err(Error::model(
            place(),
            format!(
                "a load acts on node {node}, the last one is {}",
                chain.tip()
            ),
        ));
    }
    let Load::Custom(custom) = load else {
        return Ok(());
    };
    if let Some(fault) = custom.fault().or_else(|| custom.fault_at(kinematics)) {
        return Err(Error::model(
            place(),
            format!("a load does not fit: {fault}"),
        ));
    }
    let mut wrenches = Vec::new();
    custom.wrenches(kinematics, &mut wrenches);
    if let Some((node, _)) = wrenches.iter().find(|(n, _)| *n > chain.tip()) {
        return Err(Error::model(
            place(),
            format!(
                "a load acts on node {node}, the last one is {}",
                chain.tip()
            ),
        ));
    }
    let mut tangents = Vec::new();
    custom.tangents(kinematics, &mut tangents);
    let numbers = wrenches.iter().flat_map(|(_, w)| w.0.iter());
    let mut numbers = numbers.chain(tangents.iter().flat_map(|t| t.matrix.iter()));
    numbers.try_for_each(number)
}

/// Refuses a load that does not fit, in debug builds also one with a wrong tangent.
pub(crate) fn check_load(
    chain: &Chain,
    kinematics: &Kinematics,
    base: &Pose,
    coordinates: &[f64],
    commands: &[f64],
    load: &Load,
) -> Result<()> {
    fits(chain, kinematics, load)?;
    if cfg!(debug_assertions) && matches!(load, Load::Custom(_)) {
        let check = check_tangents(chain, base, coordinates, commands, load)?;
        if check.largest > TANGENT_TOLERANCE {
            return Err(Error::model(
                chain.place(),
                format!(
                    "the tangent of a load is not the derivative of its wrench: on node '{}' they differ by {} (share of the load) when '{}' moves ({load:?})",
                    chain.nodes()[check.node],
                    short(check.largest),
                    check.coordinate
                ),
            ));
        }
    }
    Ok(())
}

/// The one axis about which everything before a node turns, in the axes of the chain's base:
/// `Some(None)` if nothing turns, `None` if axes differ. Parallel axes stay parallel.
pub(crate) fn common_axis(chain: &Chain, node: usize) -> Option<Option<Unit<Vector3<f64>>>> {
    let mut rotation = UnitQuaternion::identity();
    let mut common: Option<Unit<Vector3<f64>>> = None;
    for element in chain.elements() {
        match element {
            Element::Rigid(pose) => rotation *= pose.rotation,
            Element::Node(index) if *index == node => break,
            Element::Motion(motion) if motion.kind == MotionKind::Revolute => {
                let axis = rotation * motion.axis;
                match common {
                    Some(first) if first.cross(&axis).norm() > 1e-12 => return None,
                    Some(_) => {}
                    None => common = Some(axis),
                }
            }
            Element::Node(_) | Element::Motion(_) => {}
        }
    }
    Some(common)
}

/// All turns before a node share one axis: dead moments on it have a potential.
pub(crate) fn moments_have_potential(chain: &Chain, node: usize) -> bool {
    common_axis(chain, node).is_some()
}

/// A dead moment has a potential only where all turns share one axis.
pub(crate) fn dead_moment_is_conservative(
    chain: &Chain,
    node: usize,
    moment: &Vector3<f64>,
) -> bool {
    *moment == Vector3::zeros() || moments_have_potential(chain, node)
}

impl Load {
    /// The load's work on any closed path of this chain is zero: statements about energy hold.
    /// Dead moments are conservative only where everything turns about one axis.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let joint = |second| {
    ///     Chain::builder("joint")
    ///         .spring("first", MotionKind::Revolute, Vector3::z(), 100.0, 0.0)
    ///         .spring("second", MotionKind::Revolute, second, 100.0, 0.0)
    ///         .build()
    /// };
    /// let (hinges, universal) = (joint(Vector3::z())?, joint(Vector3::x())?);
    /// let moment = Load::dead(0, Wrench::new(Vector3::zeros(), vector![0.0, 0.0, 5.0])); // N m
    /// // About one axis a moment works by its angle; about two the work depends on the way.
    /// assert!(moment.conservative(&hinges) && !moment.conservative(&universal));
    /// assert!(Load::dead(0, Wrench::new(vector![1.0, 2.0, 3.0], Vector3::zeros())).conservative(&universal));
    /// assert!(!Load::follower(0, Wrench::new(vector![1.0, 0.0, 0.0], Vector3::zeros())).conservative(&hinges));
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn conservative(&self, chain: &Chain) -> bool {
        match self {
            Self::Dead { node, wrench } => {
                dead_moment_is_conservative(chain, *node, &wrench.moment())
            }
            Self::Gravity(_) => true,
            Self::Custom(load) => load.conservative(),
        }
    }
}
