//! Loads on platforms: wrenches, and compensators between bodies of different limbs.

use nalgebra::{Matrix6, Vector3};

use crate::model::kinematics::NodeTangent;
use crate::model::loads::length_law::LengthLaw;
use crate::model::loads::strut::{Anchor, Strut};
use crate::spatial::{Pose, Wrench, hat, rotational};

/// Something that acts on the platforms of a mechanism and belongs to no limb.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// let law = LengthLaw::Linear { stiffness: 3e3, free_length: 0.5, preload: 0.0 }; // N/m, m, N
/// let spring = PlatformLoad::strut(
///     Anchor::on_platform(1, vector![0.1, 0.0, 0.0]),
///     Anchor::on_platform(2, vector![0.0, -0.2, 0.05]),
///     law,
/// );
/// assert_eq!(spring.platforms(), [1, 2]);
/// let turned = nalgebra::Isometry3::new(vector![0.3, 0.5, -0.2], vector![0.4, -0.3, 0.2]);
/// let poses = [Pose::identity(), Pose::translation(0.1, 0.2, 0.3), turned];
/// // Equal and opposite, in one line: about the base's origin the two wrenches cancel.
/// let mut wrenches = Vec::new();
/// spring.wrenches(&poses, &mut wrenches);
/// let about_base = |(on, wrench): &(usize, Wrench)| wrench.shifted(&-poses[*on].translation.vector);
/// assert!(wrenches.iter().map(about_base).sum::<Wrench>().0.norm() < 1e-12 * wrenches[0].1.0.norm());
/// let ends = [poses[1] * nalgebra::Point3::new(0.1, 0.0, 0.0), poses[2] * nalgebra::Point3::new(0.0, -0.2, 0.05)];
/// let stretch = (ends[1] - ends[0]).norm() - 0.5; // m
/// let energy = spring.energy(&poses).expect("a spring has a potential"); // J
/// assert!(spring.conservative() && (energy - 1.5e3 * stretch * stretch).abs() < 1e-12);
/// // Both platforms moved alike change no force.
/// let mut tangents = Vec::new();
/// spring.tangents(&poses, &mut tangents);
/// let on_first = tangents.iter().filter(|tangent| tangent.on == 1);
/// let by_all = on_first.map(|tangent| tangent.matrix.fixed_view::<6, 3>(0, 0).into_owned());
/// assert!(by_all.sum::<nalgebra::SMatrix<f64, 6, 3>>().amax() < 1e-9);
/// // What turns with its platform has no potential.
/// let jet = Wrench::new(vector![0.0, 20.0, 0.0], Vector3::zeros()); // N
/// let follower = PlatformLoad::Wrench { platform: 2, point: Vector3::zeros(), wrench: jet, turns: true };
/// assert!(!follower.conservative() && follower.energy(&poses).is_none());
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum PlatformLoad {
    /// Force and moment at a point of a platform.
    Wrench {
        /// Index of the platform; the base (0) cannot be loaded.
        platform: usize,
        /// Point of the force, platform axes, m.
        point: Vector3<f64>,
        /// Wrench about that point; base axes, or platform axes if it `turns`.
        wrench: Wrench,
        /// True if it turns with the platform (a follower, without a potential).
        turns: bool,
    },
    /// A spring, gas spring or rope between points of two platforms; nodes of its anchors are
    /// indices of platforms, and `Anchor::Base` is a point of the base.
    Strut(Strut),
}

impl PartialEq for PlatformLoad {
    fn eq(&self, other: &Self) -> bool {
        // Numbers tell everything but a function, which equals nothing.
        let function = matches!(self, Self::Strut(s) if matches!(s.law, LengthLaw::Function(_)));
        !function && format!("{self:?}") == format!("{other:?}")
    }
}

impl PlatformLoad {
    /// A strut between points of two platforms ([`Anchor::on_platform`]) by a law of length.
    #[must_use]
    pub fn strut(from: Anchor, to: Anchor, law: LengthLaw) -> Self {
        Self::Strut(Strut { from, to, law })
    }

    /// Platforms that it moves.
    #[must_use]
    pub fn platforms(&self) -> Vec<usize> {
        match self {
            Self::Wrench { platform, .. } => vec![*platform],
            Self::Strut(strut) => {
                let ends = [&strut.from, &strut.to].into_iter();
                ends.filter_map(Anchor::on).collect()
            }
        }
    }

    /// True if it has a potential: a dead moment on a platform that turns about several axes has none, and the axes of
    /// the platform's rotation are not examined.
    #[must_use]
    pub fn conservative(&self) -> bool {
        match self {
            Self::Wrench { wrench, turns, .. } => !turns && wrench.moment() == Vector3::zeros(),
            Self::Strut(_) => true,
        }
    }

    /// Appends `(platform, wrench)`: base axes, about the platform's origin, on the platform; `poses`
    /// are those of all platforms.
    pub fn wrenches(&self, poses: &[Pose], out: &mut Vec<(usize, Wrench)>) {
        match self {
            Self::Wrench {
                platform,
                point,
                wrench,
                turns,
            } => {
                let rotation = poses[*platform].rotation;
                let (arm, own) = (rotation * point, turned(wrench, &poses[*platform], *turns));
                let moment = own.moment() + arm.cross(&own.force());
                out.push((*platform, Wrench::new(own.force(), moment)));
            }
            Self::Strut(strut) => strut.wrenches_at(&|p| poses[p], out),
        }
    }

    /// Appends the derivatives of those wrenches by the motions of platforms (base axes, at their
    /// origins).
    pub fn tangents(&self, poses: &[Pose], out: &mut Vec<NodeTangent>) {
        match self {
            Self::Wrench {
                platform,
                point,
                wrench,
                turns,
            } => {
                let pose = &poses[*platform];
                let (arm, own) = (pose.rotation * point, turned(wrench, pose, *turns));
                let mut matrix = rotational(&(hat(&own.force()) * hat(&arm)));
                if *turns {
                    // The arm turns with the force: the moment about the origin turns as a whole.
                    let moment = own.moment() + arm.cross(&own.force());
                    matrix = Matrix6::zeros();
                    matrix
                        .fixed_view_mut::<3, 3>(0, 3)
                        .copy_from(&-hat(&own.force()));
                    matrix
                        .fixed_view_mut::<3, 3>(3, 3)
                        .copy_from(&-hat(&moment));
                }
                out.push(NodeTangent {
                    on: *platform,
                    by: *platform,
                    matrix,
                });
            }
            Self::Strut(strut) => strut.tangents_at(&|p| poses[p], out),
        }
    }

    /// Potential energy, J; `None` where it has none.
    #[must_use]
    pub fn energy(&self, poses: &[Pose]) -> Option<f64> {
        match self {
            Self::Wrench {
                platform,
                point,
                wrench,
                ..
            } => {
                let place = poses[*platform] * nalgebra::Point3::from(*point);
                self.conservative()
                    .then(|| -wrench.force().dot(&place.coords))
            }
            Self::Strut(strut) => Some(strut.energy_at(&|p| poses[p])),
        }
    }

    /// Moves the frame of a platform to `frame` (platform from new frame).
    pub(crate) fn reframed(&self, platform: usize, frame: &Pose) -> Self {
        let inverse = frame.inverse();
        let there = |point: &Vector3<f64>| (inverse * nalgebra::Point3::from(*point)).coords;
        match self {
            Self::Wrench {
                platform: own,
                point,
                wrench,
                turns,
            } if *own == platform => Self::Wrench {
                platform,
                point: there(point),
                wrench: if *turns {
                    wrench.rotated(&inverse.rotation.to_rotation_matrix())
                } else {
                    *wrench
                },
                turns: *turns,
            },
            Self::Strut(strut) => {
                let anchor = |anchor: &Anchor| match anchor {
                    Anchor::Node { node, point } if *node == platform => Anchor::Node {
                        node: platform,
                        point: there(point),
                    },
                    other => *other,
                };
                Self::Strut(Strut {
                    from: anchor(&strut.from),
                    to: anchor(&strut.to),
                    law: strut.law.clone(),
                })
            }
            other => other.clone(),
        }
    }
}

/// A wrench in base axes.
fn turned(wrench: &Wrench, pose: &Pose, turns: bool) -> Wrench {
    if turns {
        wrench.rotated(&pose.rotation.to_rotation_matrix())
    } else {
        *wrench
    }
}
