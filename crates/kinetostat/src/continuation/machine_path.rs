//! The path of equilibria of a machine while a load or a motion of its tool grows, as a list of points: around limit
//! points of both, through snap-through and back [R 5.5.3]. It is the start's own branch of [`Posture::curves`].

use crate::chain::problem::EndCondition;
use crate::continuation::curve::{Branch, BranchEnd, CurvePoint, Special, SpecialKind};
use crate::continuation::machine_curves::MachineCurves;
use crate::continuation::parameter::Parameter;
use crate::continuation::settings::CurveSettings;
use crate::continuation::state_distance::segment_share;
use crate::error::Result;
use crate::machine::equilibrium::MechanismEquilibrium;
use crate::machine::posture::Posture;

/// An equilibrium on a machine's path.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PathPoint {
    /// Displacement from the nominal target (m, rad) or load factor.
    pub parameter: f64,
    /// Force along the displacement (N, N m; without the dead wrench), or displacement along the
    /// load pattern (J per unit factor).
    pub conjugate: f64,
    /// Load by displacement along the path: of the force by the displacement (N/m, N m/rad), or of
    /// the factor by its conjugate (1/J). Not finite where the displacement stands still.
    pub slope: f64,
    /// Every shape and platform stays where it is while the driven motion is prescribed (under a
    /// growing load: while the tool is held along the load).
    pub held: bool,
    /// The same while the load that is reached acts as a dead load instead.
    pub dead: bool,
    /// Under that load without a potential it does not go away, but may swing with growing amplitude
    /// (flutter), which depends on the masses.
    pub may_flutter: bool,
    /// The equilibrium.
    pub equilibrium: MechanismEquilibrium,
}

/// What happens at a special point of a machine's path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathSpecialKind {
    /// The load has its extreme: under a dead load the machine snaps.
    LoadLimit,
    /// The displacement has its extreme: under prescribed motion the machine snaps.
    DisplacementLimit,
    /// Stability ends (or comes back) where neither has: another branch crosses.
    Crossing,
}

/// A special point of a machine's path.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PathSpecial {
    /// What happens.
    pub kind: PathSpecialKind,
    /// Where.
    pub point: PathPoint,
    /// Which stability ends here, coming from a stable side: while the motion is prescribed, under a
    /// dead load.
    pub ends: [bool; 2],
}

/// Where a machine goes from a limit point.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PathJump {
    /// The limit point: index into [`MachinePath::specials`].
    pub from: usize,
    /// Under a dead load (at a load limit) or under prescribed motion.
    pub dead_load: bool,
    /// Stable equilibria at the same load (displacement) on the path, nearest first; if it has
    /// none, where the machine was seen to come to rest from the path's ends.
    pub to: Vec<PathPoint>,
}

/// A path of equilibria of a machine.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MachinePath {
    /// Points in their order, from the low end of the parameter at the start.
    pub points: Vec<PathPoint>,
    /// Index of the point where it started.
    pub start: usize,
    /// In the order of the path.
    pub specials: Vec<PathSpecial>,
    /// Of every limit point at which a stable part ends.
    pub jumps: Vec<PathJump>,
    /// Why it ends at its first and at its last point.
    pub ends: [BranchEnd; 2],
}

impl Posture {
    /// Equilibria while the parameter runs through `settings.range`, in both directions from its value nearest to zero:
    /// the start's own branch of [`Self::curves`], whose limit points of load and displacement are passed; branches that
    /// cross are named, not followed.
    ///
    /// # Errors
    /// Those of [`Self::curves`].
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
    /// let push = Wrench::new(vector![-1000.0, 0.0, 0.0], Vector3::zeros());
    /// let parameter = Parameter::end_wrench(push);
    /// let free = EndCondition::wrench(Wrench::zero());
    /// let path = arm.posture(&home)?.path(&parameter, &free, &CurveSettings::within(0.0, 10.0))?;
    /// assert!(path.points.len() > 1);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn path(
        &self,
        parameter: &Parameter,
        end: &EndCondition,
        settings: &CurveSettings,
    ) -> Result<MachinePath> {
        let own = CurveSettings {
            branches: 1,
            ..settings.clone()
        };
        let curves = self.curves(parameter, end, &own)?;
        let branch = &curves.branches[0];
        let (specials, order) = specials_of(&curves, branch);
        let mut jumps: Vec<PathJump> = Vec::new();
        for jump in curves.jumps()? {
            let Some(from) = order.iter().position(|s| *s == jump.from) else {
                continue;
            };
            let to = match jump.to.is_empty() && jump.dead_load {
                // Beyond what was followed: the machine is let go at the path's ends.
                true => curves.let_go(branch, &curves.specials[jump.from])?,
                false => jump.to,
            };
            jumps.push(PathJump {
                from,
                dead_load: jump.dead_load,
                to: to.iter().map(PathPoint::of).collect(),
            });
        }
        jumps.sort_by_key(|jump| jump.from);
        Ok(MachinePath {
            points: branch.points.iter().map(PathPoint::of).collect(),
            start: curves.start,
            specials,
            jumps,
            ends: branch.ends,
        })
    }
}

impl PathPoint {
    fn of(p: &CurvePoint<MechanismEquilibrium>) -> Self {
        Self {
            parameter: p.parameter,
            conjugate: p.conjugate,
            slope: p.slope,
            held: p.held.stable,
            dead: p.dead.stable,
            may_flutter: p.dead.may_flutter,
            equilibrium: p.equilibrium.clone(),
        }
    }
}

/// Special points in the order of the path, and which of the curve's they are.
fn specials_of(
    curves: &MachineCurves<'_>,
    branch: &Branch<MechanismEquilibrium>,
) -> (Vec<PathSpecial>, Vec<usize>) {
    // Segment in which each lies, and where in it.
    let place = |s: &Special<MechanismEquilibrium>| {
        let segments = branch.points.windows(2).enumerate();
        let shares = segments.map(|(i, w)| {
            let (share, off) = segment_share(&s.point.z, &w[0].z, &w[1].z);
            (off, i, share)
        });
        shares.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let mut list: Vec<(usize, f64, usize)> = (curves.specials.iter().enumerate())
        .filter(|(_, s)| s.branches.contains(&0))
        .filter_map(|(k, s)| place(s).map(|(_, i, share)| (i, share, k)))
        .collect();
    list.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let kind = |k: usize| match curves.specials[k].kind {
        SpecialKind::LoadLimit => PathSpecialKind::LoadLimit,
        SpecialKind::DisplacementLimit => PathSpecialKind::DisplacementLimit,
        _ => PathSpecialKind::Crossing,
    };
    let specials = list.iter().map(|&(i, _, k)| {
        let (a, b) = (&branch.points[i], &branch.points[i + 1]);
        let differs = [
            a.held.stable != b.held.stable,
            a.dead.stable != b.dead.stable,
        ];
        let limit = |kind_of| list.iter().any(|l| l.0 == i && kind(l.2) == kind_of);
        let ends = match kind(k) {
            PathSpecialKind::LoadLimit => [false, differs[1]],
            PathSpecialKind::DisplacementLimit => [differs[0], false],
            PathSpecialKind::Crossing => [
                differs[0] && !limit(PathSpecialKind::DisplacementLimit),
                differs[1] && !limit(PathSpecialKind::LoadLimit),
            ],
        };
        PathSpecial {
            kind: kind(k),
            point: PathPoint::of(&curves.specials[k].point),
            ends,
        }
    });
    let specials = specials.collect();
    (specials, list.into_iter().map(|l| l.2).collect())
}
