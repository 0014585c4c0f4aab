//! Inputs of the choice of the free turn of a tool, and their check.

use kinetostat::Mechanism;
use kinetostat_program::Path;
use nalgebra::Vector3;

use crate::free_turn::error::TurnError;
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

/// Maximum number of steps of a band.
const MOST_TURNS: f64 = 7200.0;

/// Checks that all numbers of a task are plausible.
pub(crate) fn checked(task: &TurnTask<'_>) -> Result<(), TurnError> {
    let refused = |what: String| Err(TurnError::Input { what });
    let positive = |x: f64| x.is_finite() && x > 0.0;
    let band = &task.band;
    let (from, to, step) = (band.from_deg, band.to_deg, band.step_deg);
    if !positive(task.station_mm) {
        return refused(format!(
            "stations are {} mm apart: a positive number is needed",
            task.station_mm
        ));
    }
    if ![from, to].iter().all(|x| x.is_finite() && x.abs() <= 720.0) {
        return refused(format!(
            "the band of turns goes from {from} to {to} deg: two numbers within 720 deg of zero are needed"
        ));
    }
    if to <= from {
        return refused(format!(
            "the band of turns from {from} to {to} deg is empty: its end must be larger than its start"
        ));
    }
    if to - from > 360.0 + 1e-9 {
        return refused(format!(
            "the band of turns from {from} to {to} deg is more than the whole circle: at most 360 deg are needed"
        ));
    }
    if !positive(step) || (to - from) / step > MOST_TURNS {
        return refused(format!(
            "the band of turns is divided in steps of {step} deg: a positive number is needed that makes at most {MOST_TURNS} steps"
        ));
    }
    let rate = task.bounds.rate_deg_per_mm;
    if !positive(rate) {
        return refused(format!(
            "the tool may be turned by {rate} deg/mm: a positive number is needed (for a turn that stays the same see \
             TurnChoice::best_constant)"
        ));
    }
    bounds(task)?;
    criteria(&task.criteria)?;
    placement(task)
}

fn bounds(task: &TurnTask<'_>) -> Result<(), TurnError> {
    let refused = |what: String| Err(TurnError::Input { what });
    let bounds = &task.bounds;
    let least = bounds.least_singular_value;
    if !(least.is_finite() && least > 0.0) {
        return refused(format!(
            "the smallest singular value is to stay above {least}: a positive number is needed"
        ));
    }
    let margin = bounds.limit_margin_deg;
    if !(margin.is_finite() && margin >= 0.0) {
        return refused(format!(
            "joints are to stay {margin} deg inside their limits: zero or a positive number is needed"
        ));
    }
    let step = bounds.joint_step_deg;
    if !(step > 0.0 && step <= 90.0) {
        return refused(format!(
            "joints may turn by {step} deg between two stations: a positive number of at most 90 is needed"
        ));
    }
    if bounds.checks_between > 1000 {
        return refused(format!(
            "{} places are to be looked at between two stations: at most 1000 are",
            bounds.checks_between
        ));
    }
    match bounds.configuration {
        Some(number) if number > 7 => refused(format!(
            "configuration {number} is asked for: an arm of six joints has those from 0 to 7"
        )),
        _ => Ok(()),
    }
}

fn criteria(criteria: &[TurnCriterion]) -> Result<(), TurnError> {
    let refused = |what: String| Err(TurnError::Input { what });
    let mut compliances = 0;
    for criterion in criteria {
        let weight = criterion.weight();
        if !(weight.is_finite() && weight >= 0.0) {
            return refused(format!(
                "a criterion counts with the weight {weight}: zero or a positive number is needed"
            ));
        }
        if let TurnCriterion::Compliance { of, .. } = criterion {
            compliances += 1;
            if let TipCompliance::Along(direction) = of
                && !(direction.norm().is_finite() && direction.norm() > 0.0)
            {
                return refused(format!(
                    "the compliance along [{}, {}, {}] is asked for: a direction is needed",
                    direction.x, direction.y, direction.z
                ));
            }
        }
    }
    match compliances {
        0 | 1 => Ok(()),
        _ => refused(format!(
            "{compliances} criteria ask for a compliance: one is taken into account"
        )),
    }
}

fn placement(task: &TurnTask<'_>) -> Result<(), TurnError> {
    let refused = |what: &str| {
        Err(TurnError::Input {
            what: what.to_owned(),
        })
    };
    let placement = &task.placement;
    if placement.orientation_follows {
        return Err(TurnError::NoFreedom {
            what: "the machine turns its tool as it moves (orientation_follows): there is no turn to choose".to_owned(),
        });
    }
    if !(placement.scale.is_finite() && placement.scale > 0.0) {
        return refused("the scale of the program is no positive number");
    }
    let pose = placement.base_from_part;
    let mut numbers = pose
        .translation
        .vector
        .iter()
        .chain(pose.rotation.coords.iter())
        .chain(placement.tool_orientation.coords.iter());
    match numbers.all(|x| x.is_finite()) {
        true => Ok(()),
        false => refused(
            "the placement of the part or the orientation of the tool has a number that is not finite",
        ),
    }
}
