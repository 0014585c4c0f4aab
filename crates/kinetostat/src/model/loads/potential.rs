//! Potentials of loads, where they exist.

use nalgebra::{Unit, UnitQuaternion, Vector3};

use crate::model::chain::{Chain, Element};
use crate::model::loads::load::Load;
use crate::spatial::MotionKind;

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
