//! Curves of equilibria by arc-length continuation (Keller): force against displacement, or
//! displacement against a load factor, around limit points and through bifurcations.
//!
//! A curve starts at an equilibrium, is followed both ways, and every further branch that crosses
//! it can be followed as well. Steps adapt to the curve; limit points and bifurcation points
//! between two steps are located by themselves ([`Special`]).
//!
//! Shapes that a motion turns into each other at no cost (a round rod that buckles in any direction)
//! are one family and one branch, followed at rest along that motion ([`CurvePoint::in_family`]).

use std::fmt::Debug;
use std::sync::Arc;

use nalgebra::{DVector, Matrix6};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::chain::directions::Direction;
use crate::chain::equilibrium::Equilibrium;
use crate::chain::problem::ChainProblem;
use crate::chain::stability::ShapeStability;
use crate::continuation::linear::family::Family;
use crate::continuation::settings::{CurveSettings, Parameter};
use crate::spatial::{Pose, Wrench};

/// Reason why a branch ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum BranchEnd {
    /// The parameter or its conjugate reached a limit.
    Range,
    /// A joint reached the largest angle.
    Angle,
    /// Maximum number of points.
    Points,
    /// The branch came back to where it started.
    Closed,
    /// The smallest step found no further point.
    Lost,
    /// Ever shorter steps made no progress.
    Stalled,
    /// Searched point was found.
    Found,
}

/// An equilibrium on a curve, with the slope of the curve there and its stability under either control.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct CurvePoint<E: CurveEquilibrium = Equilibrium> {
    /// Displacement (m, rad) or load factor.
    pub parameter: f64,
    /// Force (N, N m) along the displacement, or displacement along the load pattern (J per unit
    /// factor; of a chain since the curve's start, of a machine from its commanded place).
    pub conjugate: f64,
    /// Coordinates, wrench, energy, stiffness and shape (the whole end held).
    pub equilibrium: E,
    /// Load per displacement along the curve (N/m, N m/rad; for a load pattern factor per J):
    /// negative where a dead load runs away, infinite where the end is locked.
    pub slope: f64,
    /// Stability while the motion along the parameter's direction is prescribed.
    pub displacement_control: E::Stability,
    /// Stability while a dead load acts along it instead.
    pub dead_load: E::Stability,
    /// Arc length since the branch's first point, natural units.
    pub arc: f64,
    pub(crate) z: DVector<f64>,
    pub(crate) tangent: DVector<f64>,
    pub(crate) unstable: [usize; 2],
    pub(crate) family: Option<Arc<Family>>,
}

impl<E: CurveEquilibrium> CurvePoint<E> {
    /// Number of unstable modes while the motion along the parameter is prescribed, and under a
    /// dead load.
    #[must_use]
    pub fn unstable_modes(&self) -> [usize; 2] {
        self.unstable
    }

    /// True if the shape is one of a continuum at this value of the parameter: a motion leads from
    /// it to others that costs nothing (a buckled round rod turned about its axis). Stability then
    /// is that against all other motions, the neutral one counts as a zero of the inertia.
    #[must_use]
    pub fn in_family(&self) -> bool {
        self.family.is_some()
    }

    /// Distance from another point of the same curve, in the natural units of its unknowns.
    #[must_use]
    pub fn apart(&self, other: &Self) -> f64 {
        (&self.z - &other.z).norm()
    }

    /// The parameter's load: the factor, or the force along the displacement.
    #[must_use]
    pub fn load(&self, parameter: &Parameter) -> f64 {
        match parameter {
            Parameter::Displacement(_) => self.conjugate,
            Parameter::Load(_) => self.parameter,
        }
    }
}

/// Kind of a special point of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum SpecialKind {
    /// Limit point of the load: under a dead load the chain jumps (snap-through).
    LoadLimit,
    /// Limit point of the displacement: under prescribed motion the chain jumps (snap-back).
    DisplacementLimit,
    /// Two branches cross, one of them turns back there: buckling of a symmetric chain.
    Pitchfork,
    /// Two branches cross and both go on.
    Transcritical,
    /// Stability ends or comes back without a limit point and without a branch that the unknowns of the curve show:
    /// a limb or a platform of a machine that moves while the tool stands still.
    StabilityChange,
    /// Several modes become critical together.
    Multiple {
        /// Number of independent critical modes.
        modes: usize,
    },
}

impl SpecialKind {
    /// True where branches cross.
    #[must_use]
    pub fn is_bifurcation(self) -> bool {
        !matches!(
            self,
            Self::LoadLimit | Self::DisplacementLimit | Self::StabilityChange
        )
    }
}

/// A limit point or a bifurcation point.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Special<E: CurveEquilibrium = Equilibrium> {
    /// Limit point, bifurcation or change of stability.
    pub kind: SpecialKind,
    /// Point of the curve at which it lies, within `accuracy`.
    pub point: CurvePoint<E>,
    /// Motion of all coordinates (m, rad; largest component 1): of the critical mode at a
    /// bifurcation, along the curve at a limit point.
    pub mode: Vec<f64>,
    /// Uncertainty of the place in natural units.
    pub accuracy: f64,
    /// Branches through it: indices into [`crate::continuation::Curves::branches`].
    pub branches: Vec<usize>,
    /// True if the curve is stable on one side of it at least (for a limit point: under the kind of
    /// load that it limits).
    pub stable_side: bool,
    /// A branch crosses here whose first step did not converge: it is not among the branches.
    pub lost_branch: bool,
    /// Directions of the branches other than the one on which it was found.
    pub(crate) directions: Vec<DVector<f64>>,
}

/// A smooth path of equilibria.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Branch<E: CurveEquilibrium = Equilibrium> {
    /// Points in order along the path.
    pub points: Vec<CurvePoint<E>>,
    /// Index of the point from which it was followed both ways.
    pub start: usize,
    /// Bifurcation point (index into [`Curves::specials`]) it was found from; `None`: the start.
    pub origin: Option<usize>,
    /// Reasons of its ends, at the first and at the last point.
    pub ends: [BranchEnd; 2],
}

/// A curve of equilibria and the branches connected to it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Curves<'a> {
    /// The problem at parameter 0.
    pub problem: ChainProblem<'a>,
    /// Displacement of the end, or load pattern, that grows along the curve.
    pub parameter: Parameter,
    /// The start's own branch first.
    pub branches: Vec<Branch>,
    /// Limit points and bifurcation points, in the order found.
    pub specials: Vec<Special>,
    /// True if connected branches were left out because there were too many.
    pub more_branches: bool,
    pub(crate) settings: CurveSettings,
    pub(crate) start: (Vec<f64>, crate::spatial::Wrench, f64),
}

/// A jump from a limit point.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Jump<E: CurveEquilibrium = Equilibrium> {
    /// The limit point: index into [`Curves::specials`].
    pub from: usize,
    /// True under a dead load (at a load limit), false under prescribed motion.
    pub dead_load: bool,
    /// Stable equilibria at the same load (displacement), nearest first; empty if no computed
    /// branch holds one.
    pub to: Vec<CurvePoint<E>>,
    /// Branch of each of them: index into [`Curves::branches`].
    pub branches: Vec<usize>,
}

/// Tells that a point is what was looked for.
pub(crate) type Stop<'s, E = Equilibrium> = Option<&'s dyn Fn(&CurvePoint<E>) -> bool>;

/// One branch from its two halves, which share their first point.
pub(crate) fn join<E: CurveEquilibrium>(
    mut halves: Vec<(Vec<CurvePoint<E>>, BranchEnd)>,
    origin: Option<usize>,
) -> Branch<E> {
    let (forward, last) = halves.pop().unwrap_or((Vec::new(), BranchEnd::Lost));
    let (backward, first) = halves.pop().unwrap_or((Vec::new(), BranchEnd::Lost));
    let mut points = backward;
    points.reverse();
    points.pop();
    let start = points.len();
    for point in &mut points {
        point.tangent *= -1.0;
    }
    points.extend(forward);
    let mut arc = 0.0;
    for i in 0..points.len() {
        if i > 0 {
            arc += (&points[i].z - &points[i - 1].z).norm();
        }
        points[i].arc = arc;
    }
    Branch {
        points,
        start,
        origin,
        ends: [first, last],
    }
}

impl BranchEnd {
    /// Reason why the branch ends.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::Range => "leaves the range",
            Self::Angle => "a joint or a machine's tool has turned about half a turn",
            Self::Points => "as many points as allowed",
            Self::Closed => "comes back to where it started",
            Self::Lost => "no further point was found",
            Self::Stalled => "ever shorter steps made no progress",
            Self::Found => "what was looked for was found",
        }
    }

    /// True if nothing that was requested ends the branch there: it may continue.
    #[must_use]
    pub fn may_go_on(self) -> bool {
        matches!(self, Self::Points | Self::Lost | Self::Stalled)
    }
}

impl<E: CurveEquilibrium> Special<E> {
    /// True if stability ends here: under a dead load, under prescribed motion.
    #[must_use]
    pub fn ends_stability(&self) -> [bool; 2] {
        if !self.stable_side {
            return [false; 2];
        }
        match self.kind {
            SpecialKind::LoadLimit => [true, false],
            SpecialKind::DisplacementLimit => [false, true],
            // The stability of the point itself is a matter of rounding: it is at the limit of what holds.
            _ => [self.point.slope >= 0.0, true],
        }
    }

    /// Describes the event here; `subject` is the owner of the curve: "chain" or "machine".
    #[must_use]
    pub fn description(&self, subject: &str) -> String {
        let text = match self.kind {
            SpecialKind::LoadLimit if self.stable_side => {
                format!("the load has its extreme here: under a dead load the {subject} snaps")
            }
            SpecialKind::DisplacementLimit if self.stable_side => format!(
                "the motion has its extreme here: under prescribed motion the {subject} snaps"
            ),
            SpecialKind::LoadLimit => "extreme of the load".to_owned(),
            SpecialKind::DisplacementLimit => "extreme of the motion".to_owned(),
            SpecialKind::Pitchfork if self.stable_side => {
                format!("pitchfork: the {subject} buckles to one side or the other")
            }
            SpecialKind::Pitchfork => "pitchfork: two mirrored shapes branch off".to_owned(),
            SpecialKind::Transcritical => "two branches cross and both go on".to_owned(),
            SpecialKind::StabilityChange => {
                "stability changes here in a limb or a platform that moves while the tool stands still".to_owned()
            }
            SpecialKind::Multiple { modes } => format!("{modes} modes become critical together"),
        };
        match self.stable_side {
            true => text,
            false => format!("{text}, on a part of the curve that is unstable anyway"),
        }
    }
}

/// An equilibrium of a chain or of a machine.
pub trait CurveEquilibrium: Clone + Debug {
    /// Stability of the equilibrium on a curve.
    type Stability: CurveStability;

    /// Pose of the tool (of a chain: its end), base axes.
    fn tool(&self) -> &Pose;
    /// Wrench on the tool, about its origin, base axes (N, N m).
    fn wrench(&self) -> &Wrench;
    /// Energy in all springs, J.
    fn spring_energy(&self) -> f64;
    /// All loads have a potential; if not, statements about energy do not hold.
    fn conservative(&self) -> bool;
    /// Tangent stiffness at the tool, base axes.
    fn stiffness(&self) -> &Matrix6<f64>;
    /// Principal directions of that stiffness.
    fn directions(&self) -> &[Direction];
    /// The shape of the chain, or of every limb, stays while the tool is held.
    fn shape_stable(&self) -> bool;
    /// Largest share of the way to buckling while the tool is held; `None` without inner freedom.
    fn share_to_buckling(&self) -> Option<f64>;
    /// Motion of a chain's coordinates in which its shape would buckle; empty for a machine.
    fn buckling_mode(&self) -> &[f64];
}

/// Stability of an equilibrium on a curve.
pub trait CurveStability: Clone + Debug {
    /// True if the equilibrium is stable.
    fn stable(&self) -> bool;
    /// Number of independent motions in which it goes away.
    fn unstable_modes(&self) -> usize;
    /// True if, under loads without a potential, it does not diverge but may oscillate with growing amplitude
    /// (flutter), which depends on the masses.
    fn may_flutter(&self) -> bool;
}

impl CurveEquilibrium for Equilibrium {
    type Stability = ShapeStability;

    fn tool(&self) -> &Pose {
        &self.tip
    }

    fn wrench(&self) -> &Wrench {
        &self.wrench
    }

    fn spring_energy(&self) -> f64 {
        self.energy
    }

    fn conservative(&self) -> bool {
        self.conservative
    }

    fn stiffness(&self) -> &Matrix6<f64> {
        &self.stiffness.cartesian.matrix
    }

    fn directions(&self) -> &[Direction] {
        &self.stiffness.directions
    }

    fn shape_stable(&self) -> bool {
        self.stability.stable
    }

    fn share_to_buckling(&self) -> Option<f64> {
        self.stability.share_to_buckling
    }

    fn buckling_mode(&self) -> &[f64] {
        &self.stability.mode
    }
}

impl CurveStability for ShapeStability {
    fn stable(&self) -> bool {
        self.stable
    }

    fn unstable_modes(&self) -> usize {
        self.unstable_modes
    }

    fn may_flutter(&self) -> bool {
        self.may_flutter()
    }
}
