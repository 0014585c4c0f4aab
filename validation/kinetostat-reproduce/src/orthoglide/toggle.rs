//! Force against displacement along (1, 1, 1), the tool's orientation held [R 5.5.3]: towards the
//! flat posture ("outside", negative) and away from it ("inside", positive).

use kinetostat::{
    ChainProblem, CurveSettings, EndCondition, Mechanism, Parameter, Posture, Settings, Twist,
    continuation::SpecialKind,
    follow,
    model::{LinkConvention, Role},
    reference::{IterationSettings, report_iteration},
    solve_chain,
};
use nalgebra::Vector3;

use crate::Cause;
use crate::orthoglide::bars::Barred;
use crate::orthoglide::machine::{Orthoglide, target};

/// Unit vector along (1, 1, 1).
pub(super) fn diagonal() -> Vector3<f64> {
    Vector3::repeat(1.0_f64).normalize()
}

/// A place on the diagonal: displacement in mm, force in kN.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DiagonalPoint {
    pub(super) moved: f64,
    pub(super) force: f64,
    /// N/mm.
    pub(super) slope: f64,
    /// Stable while the force is a dead load.
    pub(super) stable: bool,
    /// The leg's shape, the platform held: below 1 is stable.
    pub(super) share_to_buckling: f64,
}

/// The curve of the machine with its parallelograms as springs, translations before rotations.
#[derive(Clone, Debug, Default)]
pub(super) struct Curve {
    /// Places in order of the displacement.
    pub(super) places: Vec<DiagonalPoint>,
    /// Extrema of the force, in order of the displacement.
    pub(super) limits: Vec<DiagonalPoint>,
}

impl Curve {
    /// The machine is the same along its three legs, and so is the motion: the force is three times
    /// that of one leg, whose curve is followed from the unloaded posture at `(at, at, at)` m to the
    /// displacements `range` (mm) in steps of at most `step` (mm).
    pub(super) fn new(
        machine: &Mechanism,
        at: f64,
        range: (f64, f64),
        step: f64,
    ) -> Result<Self, Cause> {
        let posture = machine.posture(&target([at; 3]))?;
        let problem = first_leg(&posture, Vector3::repeat(at))?;
        let start = solve_chain(&problem, &Settings::default())?;
        let parameter = Parameter::Displacement(Twist::new(diagonal(), Vector3::zeros()));
        let mut settings = CurveSettings::within(range.0 * 1e-3, range.1 * 1e-3);
        settings.largest_change = Some(step * 1e-3);
        settings.points = 2000;
        let curves = follow(&problem, &parameter, &start, 0.0, &settings)?;
        let place = |p: &kinetostat::continuation::CurvePoint| DiagonalPoint {
            moved: p.parameter * 1e3,
            force: 3.0 * p.conjugate * 1e-3,
            slope: 3.0 * p.slope * 1e-3,
            stable: p.unstable_modes()[1] == 0,
            share_to_buckling: p.displacement_control.share_to_buckling.unwrap_or(0.0),
        };
        let branch = curves.branches.first();
        let mut places: Vec<DiagonalPoint> = branch
            .map(|b| b.points.iter().map(place).collect())
            .unwrap_or_default();
        let mut limits: Vec<DiagonalPoint> = curves
            .specials
            .iter()
            .filter(|s| s.kind == SpecialKind::LoadLimit)
            .map(|s| place(&s.point))
            .collect();
        for list in [&mut places, &mut limits] {
            list.sort_by(|a, b| a.moved.total_cmp(&b.moved));
        }
        Ok(Self { places, limits })
    }

    /// Force at a displacement (mm), kN: cubic between two points of the curve.
    pub(super) fn force(&self, moved: f64) -> Option<f64> {
        let [a, b] = self
            .places
            .windows(2)
            .find(|w| w[0].moved <= moved && moved <= w[1].moved)?
        else {
            return None;
        };
        let width = b.moved - a.moved;
        if width <= 0.0 {
            return Some(a.force);
        }
        let t = (moved - a.moved) / width;
        let (s, h) = (1.0 - t, 1e-3 * width);
        let bend =
            s * (a.slope * h - (b.force - a.force)) + t * ((b.force - a.force) - b.slope * h);
        Some(s * a.force + t * b.force + s * t * bend)
    }

    /// The first limit of the force on the way outside.
    pub(super) fn outside(&self) -> Option<DiagonalPoint> {
        self.limits.iter().rev().find(|p| p.moved < 0.0).copied()
    }

    /// Place on the way inside at which the slope falls fastest: the tip of the parabola through the three lowest
    /// rates of the slope.
    pub(super) fn knee(&self) -> Option<DiagonalPoint> {
        let inside: Vec<&DiagonalPoint> = self.places.iter().filter(|p| p.moved > 0.0).collect();
        let rates: Vec<(f64, f64)> = inside
            .windows(2)
            .filter(|w| w[1].moved > w[0].moved)
            .map(|w| {
                let rate = (w[1].slope - w[0].slope) / (w[1].moved - w[0].moved);
                (0.5 * (w[0].moved + w[1].moved), rate)
            })
            .collect();
        let [a, b, c] = rates.windows(3).min_by(|a, b| a[1].1.total_cmp(&b[1].1))? else {
            return None;
        };
        let (left, right) = ((b.1 - a.1) / (b.0 - a.0), (c.1 - b.1) / (c.0 - b.0));
        let bend = (right - left) / (c.0 - a.0);
        let moved = 0.5 * (a.0 + b.0) - 0.5 * left / bend;
        let near = inside
            .iter()
            .min_by(|p, q| (p.moved - moved).abs().total_cmp(&(q.moved - moved).abs()))?;
        Some(DiagonalPoint {
            moved,
            force: self.force(moved)?,
            ..**near
        })
    }
}

/// The first leg of a commanded machine with its end held at a place (m), not turned.
fn first_leg(posture: &Posture, place: Vector3<f64>) -> Result<ChainProblem<'_>, Cause> {
    let limb = posture.mechanism().limbs().first();
    let (limb, joints) = limb
        .zip(posture.limbs().first())
        .ok_or_else(|| Cause::Missing("the first leg".to_owned()))?;
    let mut problem = ChainProblem::new(&limb.nominal, EndCondition::pose(target(place.into())));
    problem.commands.clone_from(&joints.commands);
    problem.posture.clone_from(&joints.coordinates);
    Ok(problem)
}

/// Rate of the report's iteration at a leg held at a displacement (mm): above 1 it cannot stay.
pub(super) fn report_rate(machine: &Mechanism, at: f64, moved: f64) -> Result<f64, Cause> {
    let posture = machine.posture(&target([at; 3]))?;
    let place = Vector3::repeat(at) + diagonal() * (moved * 1e-3);
    let problem = first_leg(&posture, place)?;
    // The rate belongs to the equilibrium: no step of the iteration is needed for it.
    let settings = IterationSettings::default().with_steps(1);
    let run = report_iteration(&problem, None, &settings)?;
    run.rate_at_start
        .ok_or_else(|| Cause::Missing("the rate of the report's iteration".to_owned()))
}

/// Displacement (mm) between rest and `to` where the rate of the report's iteration reaches 1.
pub(super) fn report_fails_at(machine: &Mechanism, at: f64, to: f64) -> Result<Option<f64>, Cause> {
    if report_rate(machine, at, to)? < 1.0 {
        return Ok(None);
    }
    let (mut good, mut bad) = (0.0, to);
    for _ in 0..30 {
        let middle = 0.5 * (good + bad);
        if report_rate(machine, at, middle)? < 1.0 {
            good = middle;
        } else {
            bad = middle;
        }
    }
    Ok(Some(good))
}

/// The machine with two bars between two beams in every leg, held at displacements along the diagonal.
pub(super) struct Bars {
    barred: Barred,
    at: f64,
}

/// Steps of a search along the way, and halvings after it.
const STEPS: u32 = 24;

impl Bars {
    /// Creates the toggle at home at `(at, at, at)` m, with bars of one segment by a convention.
    pub(super) fn new(at: f64, convention: LinkConvention) -> Result<Self, Cause> {
        let machine = Orthoglide::default();
        let barred = Barred::new(&machine, &target([at; 3]), convention, 1)?;
        Ok(Self { barred, at })
    }

    /// Held at a displacement (mm).
    pub(super) fn held(&self, moved: f64) -> Result<DiagonalPoint, Cause> {
        hold(&self.barred.posture()?, self.at, moved)
    }

    /// Finds the last place, on the way to a displacement (mm), before the first limit of the force or the first loss
    /// of a bar's shape, whichever comes first.
    pub(super) fn first_limit(&self, to: f64) -> Result<Option<DiagonalPoint>, Cause> {
        // The solver may find nothing at all if a bar has lost its shape.
        let holds = |moved: f64| {
            let place = self.held(moved).ok()?;
            (place.slope > 0.0 && place.share_to_buckling < 1.0).then_some(place)
        };
        let (mut good, mut bad) = (0.0, None);
        for k in 1..=STEPS {
            let moved = to * f64::from(k) / f64::from(STEPS);
            if holds(moved).is_none() {
                bad = Some(moved);
                break;
            }
            good = moved;
        }
        let Some(mut bad) = bad else { return Ok(None) };
        for _ in 0..STEPS {
            let middle = 0.5 * (good + bad);
            if holds(middle).is_some() {
                good = middle;
            } else {
                bad = middle;
            }
        }
        Ok(Some(self.held(good)?))
    }
}

/// A posture held at a displacement (mm) along the diagonal from `(at, at, at)` m, not turned.
pub(super) fn hold(posture: &Posture, at: f64, moved: f64) -> Result<DiagonalPoint, Cause> {
    let place = Vector3::repeat(at) + diagonal() * (moved * 1e-3);
    let e = posture.wrench_at(&target(place.into()))?;
    let stiffness = e.stiffness.matrix.fixed_view::<3, 3>(0, 0).into_owned();
    let slope = diagonal().dot(&(stiffness * diagonal())) * 1e-3;
    Ok(DiagonalPoint {
        moved,
        force: e.wrench.force().dot(&diagonal()) * 1e-3,
        slope,
        stable: slope > 0.0 && e.limbs.iter().all(|l| l.stability.stable),
        share_to_buckling: e.share_to_buckling().unwrap_or(0.0),
    })
}

/// Coordinate (m) on the diagonal at which the legs lie in one plane.
pub(super) fn flat(machine: &Mechanism) -> Result<f64, Cause> {
    // Height of a leg's far end over its near one, along the diagonal: zero where it is flat.
    let height = |at: f64| -> Result<f64, Cause> {
        let posture = machine.posture(&target([at; 3]))?;
        let first = machine.limbs().first().zip(posture.limbs().first());
        let (limb, joints) = first.ok_or_else(|| Cause::Missing("the first leg".to_owned()))?;
        let passive = limb.nominal.indices_of(Role::Passive);
        let (q1, q2) = (
            joints.coordinates[passive[0]],
            joints.coordinates[passive[1]],
        );
        Ok((q1.cos() + q1.sin()) * q2.cos() - q2.sin())
    };
    let (mut a, mut b) = (-0.08, -0.12);
    let (mut fa, mut fb) = (height(a)?, height(b)?);
    for _ in 0..40 {
        if (b - a).abs() < 1e-13 || (fb - fa).abs() < 1e-15 {
            break;
        }
        let next = b - fb * (b - a) / (fb - fa);
        (a, fa) = (b, fb);
        b = next;
        fb = height(b)?;
    }
    Ok(b)
}
