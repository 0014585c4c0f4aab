//! Inputs of the choice of the free turn of a tool.

use kinetostat::Mechanism;
use kinetostat_program::Path;
use nalgebra::Vector3;

use crate::near::NEAR_SINGULAR;
use crate::placement::Placement;

/// The turns that are tried at every station, deg, right-handed about z of the tool (about the axis that the path states where its
/// moves state the orientation), on top of the orientation that the tool has without them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnBand {
    /// The smallest turn, deg.
    pub from_deg: f64,
    /// The largest one, deg: 360 more than the smallest is the whole circle, which has no ends.
    pub to_deg: f64,
    /// Step from one turn to the next, deg; a little less if the band is no multiple of it.
    pub step_deg: f64,
}

impl Default for TurnBand {
    /// The whole circle in steps of 5 deg.
    fn default() -> Self {
        Self {
            from_deg: -180.0,
            to_deg: 180.0,
            step_deg: 5.0,
        }
    }
}

/// Compliance of the tool's tip that a sequence of turns is to keep small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TipCompliance {
    /// Motion along a direction (axes of the part) by a force along it.
    Along(Vector3<f64>),
    /// Motion in the softest direction by a force along it.
    Worst,
}

/// Criterion of a good turn. Every criterion is a number without unit, weighted, added, and taken in the mean over the length of the
/// path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TurnCriterion {
    /// Distance to the limits: the square of the share of half its range by which the joint that is nearest to one is off the middle;
    /// 1 at a limit.
    Limits {
        /// Weight of the criterion.
        weight: f64,
    },
    /// Distance from singular postures: the square of [`TurnBounds::least_singular_value`] by the smallest singular value; 1 at the bound.
    Singularity {
        /// Weight of the criterion.
        weight: f64,
    },
    /// Evenness: the square of the rate of turning by the largest that is allowed; 1 there.
    Turning {
        /// Weight of the criterion.
        weight: f64,
    },
    /// Stiffness: a compliance of the unloaded machine as drawn, by the least one of all turns that are tried anywhere; 1 there.
    Compliance {
        /// Weight of the criterion.
        weight: f64,
        /// Compliance that is taken.
        of: TipCompliance,
    },
}

impl TurnCriterion {
    pub(crate) fn weight(&self) -> f64 {
        match self {
            Self::Limits { weight }
            | Self::Singularity { weight }
            | Self::Turning { weight }
            | Self::Compliance { weight, .. } => *weight,
        }
    }
}

/// Bounds of all sequences of turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnBounds {
    /// Maximum rate of turning.
    pub rate_deg_per_mm: f64,
    /// Joints stay so far inside their limits, deg.
    pub limit_margin_deg: f64,
    /// The smallest singular value of the Jacobian stays above it. Its rows are the velocity of the tip by half the reach of the arm
    /// ([`TurnChoice::length_m`](crate::TurnChoice::length_m)) and the angular velocity: joints that turn by 1 rad in all move the tool
    /// by so much at least.
    pub least_singular_value: f64,
    /// Maximum rotation of a joint between two stations, deg.
    pub joint_step_deg: f64,
    /// Places between two stations at which all this is checked again, besides the ends of moves.
    pub checks_between: usize,
    /// The only configuration that may be used, by its [number](crate::ArmConfiguration::number); any one, but the same along the whole
    /// path, if none is given.
    pub configuration: Option<u8>,
    /// Maximum number of postures kept at a time (a hundred bytes each).
    pub most_postures: usize,
}

impl Default for TurnBounds {
    fn default() -> Self {
        Self {
            rate_deg_per_mm: 2.0,
            limit_margin_deg: 1.0,
            least_singular_value: NEAR_SINGULAR,
            joint_step_deg: 20.0,
            checks_between: 4,
            configuration: None,
            most_postures: 2_000_000,
        }
    }
}

/// Form of the resulting curve of turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TurnCurve {
    /// A smooth curve near them, in the same configuration and inside the same bounds: it costs no more.
    #[default]
    Smooth,
    /// The steps of the band stay, as a staircase.
    Steps,
}

/// A path along which the free turn of a round tool is to be chosen.
#[derive(Clone, Debug)]
pub struct TurnTask<'a> {
    /// An arm of six joints with its tool: the platform's reference point is the tip, z its axis.
    pub mechanism: &'a Mechanism,
    /// The motion of the program.
    pub path: &'a Path,
    /// Placement of the program.
    pub placement: Placement,
    /// Distance of stations along the path, mm; a little less if the path is no multiple of it, and larger if they would have more
    /// postures than [`TurnBounds::most_postures`].
    pub station_mm: f64,
    /// Turns that are tried.
    pub band: TurnBand,
    /// Criteria of a good turn.
    pub criteria: Vec<TurnCriterion>,
    /// Bounds kept everywhere.
    pub bounds: TurnBounds,
    /// Form of the resulting curve.
    pub curve: TurnCurve,
}

impl<'a> TurnTask<'a> {
    /// The whole circle in steps of 5 deg at stations of 5 mm; limits, singular postures and evenness count alike.
    ///
    /// ```
    /// use kinetostat::ActuatorSpec;
    /// # use kinetostat::{Chain, Mechanism, MotionKind, Pose};
    /// use kinetostat_machining::{Placement, TurnTask, choose_turns};
    /// use kinetostat_program::{Program, ReadOptions, interpret};
    /// # use nalgebra::Vector3;
    ///
    /// let slide = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 5e7); // N/m
    /// let rail = Chain::builder("rail").actuator("x", slide).build()?;
    /// let rail = Mechanism::serial(rail, Pose::identity(), Vector3::zeros())?;
    /// let program = Program::read("G21 G90\nG0 X0 Y0 Z0\nG1 X9 F600\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// let task = TurnTask::new(&rail, &path, Placement::at(Vector3::zeros()));
    /// assert_eq!((task.station_mm, task.band.step_deg), (5.0, 5.0));
    /// let refused = choose_turns(&task).expect_err("one joint does not turn a tool");
    /// assert!(refused.to_string().contains("arm of six"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn new(mechanism: &'a Mechanism, path: &'a Path, placement: Placement) -> Self {
        let weight = 1.0;
        Self {
            mechanism,
            path,
            placement,
            station_mm: 5.0,
            band: TurnBand::default(),
            criteria: vec![
                TurnCriterion::Limits { weight },
                TurnCriterion::Singularity { weight },
                TurnCriterion::Turning { weight },
            ],
            bounds: TurnBounds::default(),
            curve: TurnCurve::default(),
        }
    }
}
