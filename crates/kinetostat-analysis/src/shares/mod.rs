//! Shares of each link, drive, joint and load in the deflection along a direction.
//!
//! A small load `f` along the direction moves the tool by `u = C f`. By virtual work its compliance along itself is
//!
//! ```text
//! f . C f = sum over springs x_b^T K_b x_b + what loads add (geometric stiffness)        [R 4.15-4.16, 5.28 corrected]
//! ```
//!
//! with `x_b` the motion of a spring under `f`. The sum is exact, for serial and parallel machines, with passive joints
//! (they store nothing) and under load, where the *tangent* compliance is divided, that for a further small load. Under
//! load the second part is not zero; it is listed beside the elastic shares under its own names, and may be negative.

pub mod stiffening;

use std::collections::BTreeMap;

use kinetostat::machine::{LinearisedMachine, MachineMotion, WorkOf};
use kinetostat::{Mechanism, MechanismEquilibrium, Posture, Wrench};
use schemars::JsonSchema;
use serde::Serialize;

/// Kind of a part of a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum PartKind {
    /// An elastic link, all its segments together.
    Link,
    /// The spring of a drive.
    Drive,
    /// Any other spring inside a limb.
    Spring,
    /// A load between platforms: a spring, a gas spring, a weight on a rope.
    PlatformLoad,
    /// Geometric stiffness: loads on a limb, weights and the force at its end, as it turns.
    LoadsOfLimb,
    /// Geometric stiffness: the weight of a platform, as it turns.
    Weight,
}

impl PartKind {
    /// True if the part is elastic and no load.
    #[must_use]
    pub fn is_elastic(self) -> bool {
        matches!(self, Self::Link | Self::Drive | Self::Spring)
    }

    /// Name in a word or two.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Link => "link",
            Self::Drive => "drive",
            Self::Spring => "spring",
            Self::PlatformLoad => "load between platforms",
            Self::LoadsOfLimb => "loads that turn",
            Self::Weight => "weight that turns",
        }
    }
}

/// Share of one part.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Name of the limb; none for what acts on platforms.
    pub limb: Option<String>,
    /// Name of the element as in the model file.
    pub name: String,
    /// Kind of the part.
    pub kind: PartKind,
    /// Part's contribution to the compliance along the direction, m/N for a force, rad/(N m) for a moment.
    pub compliance: f64,
    /// Contribution relative to the whole; all shares add to 1.
    pub share: f64,
    /// Springs of the limb that it consists of: limb, indices among its springs.
    pub springs: Vec<(usize, usize)>,
}

/// The deflection in one direction, part by part.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Shares {
    /// Motion of the tool along the load by the load, m/N or rad/(N m): the sum of all parts.
    pub compliance: f64,
    /// Every part, in the order of the model.
    pub parts: Vec<Part>,
    /// Sum of all parts by the motion of the tool, less 1: both sides of the identity are computed apart, and this is rounding.
    pub rounding: f64,
    /// Passive joints, which store nothing: limb and name.
    pub passive_joints: Vec<(String, String)>,
}

/// Reason why there are no shares.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SharesError {
    /// The direction has no length.
    #[error("the direction has no length")]
    NoDirection,
    /// Nothing holds the tool along it.
    #[error("a load in this direction meets nothing: a motion that nothing holds lies along it")]
    Free,
    /// Nothing yields.
    #[error("nothing yields in this direction: the machine is rigid along it")]
    Rigid,
    /// The tangent is singular.
    #[error("the tangent of the machine is singular here")]
    Singular,
}

impl Shares {
    /// Computes the shares of the unloaded machine as drawn: without weights, loads of the model, preloads and
    /// deviations.
    ///
    /// `direction` is a force or a moment on the tool about its origin, base axes; only its direction counts.
    ///
    /// # Errors
    /// [`SharesError`] where nothing holds the tool or nothing yields.
    ///
    /// ```
    /// use kinetostat::{Pose, Wrench, nalgebra::Vector3};
    /// use kinetostat_analysis::shares::Shares;
    /// let model = kinetostat_model::Model::preset("orthoglide")?;
    /// let posture = model.mechanism.posture(&model.mechanism.platforms()[1].home)?;
    /// let shares = Shares::unloaded(&posture, &Wrench::new(Vector3::z(), Vector3::zeros()))?;
    /// let sum: f64 = shares.parts.iter().map(|part| part.share).sum();
    /// assert!((sum - 1.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn unloaded(posture: &Posture, direction: &Wrench) -> Result<Self, SharesError> {
        let drawn = posture.as_drawn();
        let held = posture
            .stiffness()
            .is_ok_and(|k| k.compliance().twist_under(direction).is_some());
        Self::of(&drawn, &mut drawn.linearised_at_rest(), direction, held)
    }

    /// Computes the shares of the tangent compliance at an equilibrium, that for a further small load along
    /// `direction`.
    ///
    /// # Errors
    /// [`SharesError`], as for [`Self::unloaded`].
    pub fn at(
        posture: &Posture,
        equilibrium: &MechanismEquilibrium,
        direction: &Wrench,
    ) -> Result<Self, SharesError> {
        let held = equilibrium.compliance().twist_under(direction).is_some();
        let mut tangent = posture
            .linearised(equilibrium)
            .map_err(|_| SharesError::Singular)?;
        Self::of(posture, &mut tangent, direction, held)
    }

    fn of(
        posture: &Posture,
        tangent: &mut LinearisedMachine<'_>,
        direction: &Wrench,
        held: bool,
    ) -> Result<Self, SharesError> {
        let size = direction.0.norm();
        if !(size.is_finite() && size > 0.0) {
            return Err(SharesError::NoDirection);
        }
        if !held {
            return Err(SharesError::Free);
        }
        let unit = *direction * (1.0 / size);
        let motion = tangent.under(&unit).ok_or(SharesError::Singular)?;
        let m = posture.mechanism();
        let compliance = motion.platforms[m.tool()].0.dot(&unit.0);
        let moved = motion.platforms[m.tool()].0.norm();
        if moved == 0.0 || compliance.abs() <= 1e-14 * moved {
            return Err(SharesError::Rigid);
        }
        let parts = parts(m, tangent, &motion);
        let sum: f64 = parts.iter().map(|part| part.compliance).sum();
        Ok(Self {
            compliance: sum,
            rounding: sum / compliance - 1.0,
            parts,
            passive_joints: passive_joints(m),
        })
    }

    /// Shares of what is elastic, the largest first.
    #[must_use]
    pub fn elastic(&self) -> Vec<&Part> {
        let mut list: Vec<&Part> = self.parts.iter().filter(|p| p.kind.is_elastic()).collect();
        list.sort_by(|a, b| b.share.total_cmp(&a.share));
        list
    }

    /// Share of every limb, and of what acts on platforms (no name).
    #[must_use]
    pub fn by_limb(&self) -> BTreeMap<Option<&str>, f64> {
        let mut sums = BTreeMap::new();
        for part in &self.parts {
            *sums.entry(part.limb.as_deref()).or_insert(0.0) += part.share;
        }
        sums
    }

    /// Share of what loads add as they turn: 0 without a load.
    #[must_use]
    pub fn geometric(&self) -> f64 {
        let turning = |p: &&Part| matches!(p.kind, PartKind::LoadsOfLimb | PartKind::Weight);
        self.parts.iter().filter(turning).map(|p| p.share).sum()
    }
}

fn passive_joints(m: &Mechanism) -> Vec<(String, String)> {
    use kinetostat::model::Role;
    let joints = m.limbs().iter().flat_map(|limb| {
        let own = limb.actual.coordinates().iter();
        let passive = own.filter(|c| c.role == Role::Passive);
        passive.map(|c| (limb.name.clone(), c.name.clone()))
    });
    joints.collect()
}

fn parts(m: &Mechanism, tangent: &LinearisedMachine<'_>, motion: &MachineMotion) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for term in tangent.work(motion, motion) {
        let (limb, name, kind, spring) = described(m, term.of);
        let loads = matches!(kind, PartKind::LoadsOfLimb);
        let same = |p: &&mut Part| p.limb == limb && p.kind == kind && (p.name == name || loads);
        let at = match parts.iter_mut().find(same) {
            Some(part) => part,
            None => {
                parts.push(Part {
                    limb,
                    name,
                    kind,
                    compliance: 0.0,
                    share: 0.0,
                    springs: Vec::new(),
                });
                let last = parts.len() - 1;
                &mut parts[last]
            }
        };
        at.compliance += term.work;
        at.springs.extend(spring);
    }
    let sum: f64 = parts.iter().map(|part| part.compliance).sum();
    for part in &mut parts {
        part.share = part.compliance / sum;
    }
    // Passive joints, and loads without effect, are not listed.
    parts.retain(|p| p.kind.is_elastic() || p.compliance != 0.0);
    parts
}

/// Limb, name and kind of what does a work, and its spring.
fn described(
    m: &Mechanism,
    of: WorkOf,
) -> (Option<String>, String, PartKind, Option<(usize, usize)>) {
    let limb_named = |i: usize| m.limbs().get(i).map(|limb| limb.name.clone());
    match of {
        WorkOf::Spring(i, k) => {
            let chain = &m.limbs()[i].actual;
            let block = &chain.springs()[k];
            let drive = (chain.actuators().iter()).any(|a| a.coordinate == Some(block.first));
            let (name, kind) = match &block.segment {
                Some(segment) => (segment.link.clone(), PartKind::Link),
                None if drive => (block.name.clone(), PartKind::Drive),
                None => (block.name.clone(), PartKind::Spring),
            };
            (limb_named(i), name, kind, Some((i, k)))
        }
        WorkOf::LimbLoads(i) | WorkOf::SpringLoad(i, _) => (
            limb_named(i),
            "loads".to_owned(),
            PartKind::LoadsOfLimb,
            None,
        ),
        WorkOf::PlatformLoad(k) => {
            let name = format!("load {}", k + 1);
            (None, name, PartKind::PlatformLoad, None)
        }
        WorkOf::Weight(k) => (None, m.platforms()[k].name.clone(), PartKind::Weight, None),
        _ => (None, String::new(), PartKind::LoadsOfLimb, None),
    }
}
