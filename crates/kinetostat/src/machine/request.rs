//! Request of a posture: a pose of the tool, a position, commands, or known joints; and the start of the search.

use nalgebra::{UnitQuaternion, Vector3};

use crate::error::Result;
use crate::machine::inverse::limb::LimbPosture;
use crate::machine::posture::Posture;
use crate::model::mechanism::Mechanism;
use crate::spatial::Pose;

#[derive(Clone, Debug)]
enum Query<'a> {
    Pose(Pose),
    Position(Vector3<f64>, UnitQuaternion<f64>),
    Commands(&'a [f64]),
    Joints(Pose, Vec<LimbPosture>),
}

/// Start of the search for joints.
#[derive(Clone, Copy, Debug)]
enum Start<'a> {
    Home,
    Near(&'a Posture),
    StraightFrom(&'a Posture),
}

/// Request of a machine's posture, for [`Mechanism::posture`]. A pose alone (`&Pose`) is one, too.
///
/// ```
/// use kinetostat::{ActuatorSpec, Chain, Mechanism, MotionKind, Pose, PostureRequest};
/// use nalgebra::{Vector3, vector};
///
/// let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
/// let chain = Chain::builder("arm")
///     .actuator("shoulder", hinge(2e5))
///     .translation(vector![0.6, 0.0, 0.0])
///     .actuator("elbow", hinge(1e5))
///     .translation(vector![0.5, 0.0, 0.0])
///     .build()?;
/// let home = Pose::translation(1.1, 0.0, 0.0);
/// let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
///
/// let bent = arm.posture(PostureRequest::commands(&[0.3, 0.9]))?;
/// // An arm of two joints turns its tool as it moves: a position is requested, the orientation follows.
/// let position = bent.target().translation.vector + vector![0.01, 0.0, 0.0];
/// let request = PostureRequest::position(&position, &home.rotation).near(&bent);
/// let beside = arm.posture(request)?;
/// assert!((beside.target().translation.vector - position).norm() < 1e-12);
/// assert!((beside.commands()[1] - 0.9).abs() < 0.1, "the elbow stays on its side");
/// # Ok::<(), kinetostat::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PostureRequest<'a> {
    query: Query<'a>,
    from: Start<'a>,
}

impl<'a> PostureRequest<'a> {
    fn of(query: Query<'a>) -> Self {
        Self {
            query,
            from: Start::Home,
        }
    }

    /// The tool (base from tool) is at a pose on the nominal machine with springs at rest. Platforms between base and
    /// tool find their places with the joints. Where actuators are redundant, see [`Posture::redundancy`].
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let drive = |stiffness, limits| ActuatorSpec {
    /// #     limits: Some(limits), // rad
    /// #     home: 0.5,
    /// #     ..ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness) // N m/rad
    /// # };
    /// # let chain = Chain::builder("arm")
    /// #     .actuator("shoulder", drive(2e5, (-2.0, 2.0)))
    /// #     .translation(vector![0.6, 0.0, 0.0])
    /// #     .actuator("elbow", drive(1e5, (0.2, 2.5)))
    /// #     .translation(vector![0.5, 0.0, 0.0])
    /// #     .build()?;
    /// # let turn = Pose::rotation(vector![0.0, 0.0, 0.5]); // rad: both joints at home
    /// # let home = turn * Pose::translation(0.6, 0.0, 0.0) * turn * Pose::translation(0.5, 0.0, 0.0);
    /// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let (shoulder, elbow) = (0.3, 0.8_f64); // rad
    /// let reached = Pose::rotation(vector![0.0, 0.0, shoulder])
    ///     * Pose::translation(0.6, 0.0, 0.0)
    ///     * Pose::rotation(vector![0.0, 0.0, elbow])
    ///     * Pose::translation(0.5, 0.0, 0.0);
    /// let posture = arm.posture(PostureRequest::pose(&reached))?; // or `arm.posture(&reached)`
    /// let commands = posture.commands();
    /// assert!((commands[0] - shoulder).abs() < 1e-9 && (commands[1] - elbow).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn pose(target: &Pose) -> Self {
        Self::of(Query::Pose(*target))
    }

    /// The tool's reference point is at a position (m, base axes), with the orientation whose rotation from `wanted`
    /// (base from tool) is least, `wanted` itself where the machine can have it: for machines that turn their tool
    /// as they move ([`Mechanism::turns_as_it_moves`]).
    #[must_use]
    pub fn position(position: &Vector3<f64>, wanted: &UnitQuaternion<f64>) -> Self {
        Self::of(Query::Position(*position, *wanted))
    }

    /// The actuators have these commands (m or rad, in the order of [`Mechanism::actuator_names`]): nominal geometry,
    /// springs at their home, passive joints and platforms where the loops lead them from home.
    #[must_use]
    pub fn commands(commands: &'a [f64]) -> Self {
        Self::of(Query::Commands(commands))
    }

    /// Commands and passive coordinates of every limb are known, with the tool nominally at `target`. Platforms
    /// between base and tool are put where the limbs lead, along the fewest of them.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let drive = |stiffness, limits| ActuatorSpec {
    /// #     limits: Some(limits), // rad
    /// #     home: 0.5,
    /// #     ..ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness) // N m/rad
    /// # };
    /// # let chain = Chain::builder("arm")
    /// #     .actuator("shoulder", drive(2e5, (-2.0, 2.0)))
    /// #     .translation(vector![0.6, 0.0, 0.0])
    /// #     .actuator("elbow", drive(1e5, (0.2, 2.5)))
    /// #     .translation(vector![0.5, 0.0, 0.0])
    /// #     .build()?;
    /// # let turn = Pose::rotation(vector![0.0, 0.0, 0.5]); // rad: both joints at home
    /// # let home = turn * Pose::translation(0.6, 0.0, 0.0) * turn * Pose::translation(0.5, 0.0, 0.0);
    /// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// // A controller says where it thinks that its joints are, and where the tool should be.
    /// let joints = machine::LimbPosture { commands: vec![0.5, 0.5], coordinates: vec![0.0, 0.0] }; // rad
    /// let target = Pose::new(vector![0.76, 0.7, 0.0], vector![0.0, 0.0, 1.0]);
    /// let posture = arm.posture(PostureRequest::joints(&target, vec![joints]))?;
    /// assert_eq!(posture.commands(), [0.5, 0.5], "nothing is solved");
    /// // Where springs at rest lead from there: the two bars, one after the other.
    /// let (x, y) = (0.6 * 0.5_f64.cos() + 0.5 * 1.0_f64.cos(), 0.6 * 0.5_f64.sin() + 0.5 * 1.0_f64.sin());
    /// let rests = posture.deflected_by(&Wrench::zero())?.tool.translation.vector;
    /// assert!((rests - vector![x, y, 0.0]).norm() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn joints(target: &Pose, limbs: Vec<LimbPosture>) -> Self {
        Self::of(Query::Joints(*target, limbs))
    }

    /// Looks near the joints of another posture, that of a neighbour on a path, so that the branch of the inverse
    /// kinematics does not change. Says nothing where joints are given.
    #[must_use]
    pub fn near(mut self, posture: &'a Posture) -> Self {
        self.from = Start::Near(posture);
        self
    }

    /// Starts like [`Self::near`], for a position along the straight line from the other posture and no other: where
    /// many positions are tried that cannot be taken, a search around each would be expensive.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let drive = |stiffness, limits| ActuatorSpec {
    /// #     limits: Some(limits), // rad
    /// #     home: 0.5,
    /// #     ..ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness) // N m/rad
    /// # };
    /// # let chain = Chain::builder("arm")
    /// #     .actuator("shoulder", drive(2e5, (-2.0, 2.0)))
    /// #     .translation(vector![0.6, 0.0, 0.0])
    /// #     .actuator("elbow", drive(1e5, (0.2, 2.5)))
    /// #     .translation(vector![0.5, 0.0, 0.0])
    /// #     .build()?;
    /// # let turn = Pose::rotation(vector![0.0, 0.0, 0.5]); // rad: both joints at home
    /// # let home = turn * Pose::translation(0.6, 0.0, 0.0) * turn * Pose::translation(0.5, 0.0, 0.0);
    /// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let start = arm.posture(PostureRequest::commands(&[0.3, 0.9]))?;
    /// let from = start.target().translation.vector;
    /// let at = |position| arm.posture(PostureRequest::position(&position, &home.rotation).straight_from(&start));
    /// let beside = at(from + vector![-0.05, 0.1, 0.0])?; // m
    /// assert!((beside.target().translation.vector - from - vector![-0.05, 0.1, 0.0]).norm() < 1e-9);
    /// assert!(beside.commands()[1] > 0.0, "the elbow stays on its side");
    /// assert!(at(from + vector![0.9, 0.0, 0.0]).is_err(), "1.1 m is all that the arm reaches");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn straight_from(mut self, posture: &'a Posture) -> Self {
        self.from = Start::StraightFrom(posture);
        self
    }
}

impl From<&Pose> for PostureRequest<'_> {
    fn from(target: &Pose) -> Self {
        Self::pose(target)
    }
}

impl Mechanism {
    /// Commands the actuators for a target of the tool (`&Pose`, base from tool) or another [`PostureRequest`].
    ///
    /// # Errors
    /// [`Error::Unreachable`](crate::Error::Unreachable) with the nearest pose, naming the limb; for a graph of
    /// several moving platforms the nearest pose is the last one reached on the straight line from home.
    /// [`Error::NoClosure`](crate::Error::NoClosure) where loops do not close all the way from home to given
    /// commands. [`Error::Size`](crate::Error::Size) and [`Error::NotFinite`](crate::Error::NotFinite) for numbers
    /// that are no request.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let tube = BeamSection::tube(2.1e11, 8.1e10, 0.12, 0.10); // Pa, m
    /// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
    /// # let chain = Chain::builder("arm")
    /// #     .actuator("shoulder", hinge(2e5))
    /// #     .link("upper arm", &tube, 0.6)
    /// #     .actuator("elbow", hinge(1e5))
    /// #     .link("forearm", &tube, 0.5)
    /// #     .build()?;
    /// # let home = Pose::translation(1.1, 0.0, 0.0);
    /// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let posture = arm.posture(&home)?;
    /// assert!(posture.commands().iter().all(|command| command.abs() < 1e-12));
    /// assert!(matches!(arm.posture(&Pose::translation(2.0, 0.0, 0.0)), Err(Error::Unreachable { .. })));
    /// # Ok::<(), Error>(())
    /// ```
    pub fn posture<'a>(&self, request: impl Into<PostureRequest<'a>>) -> Result<Posture> {
        let PostureRequest { query, from } = request.into();
        let near = match from {
            Start::Home => None,
            Start::Near(posture) | Start::StraightFrom(posture) => Some(posture),
        };
        match (query, from) {
            (Query::Pose(target), _) => self.posture_at_pose(&target, near),
            (Query::Position(position, wanted), Start::StraightFrom(start)) => {
                self.posture_following_straight(&position, &wanted, start)
            }
            (Query::Position(position, wanted), _) => {
                self.posture_following(&position, &wanted, near)
            }
            (Query::Commands(commands), _) => self.posture_at_commands(commands),
            (Query::Joints(target, limbs), _) => self.posture_from_joints(&target, limbs),
        }
    }
}
