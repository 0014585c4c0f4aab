//! How near a load brings a machine to instability: its limbs with their ends held, their links, and
//! the whole while nothing holds its tool. `check` and `deflect` tell it alike.

use kinetostat::{LimbPosture, MechanismEquilibrium, Posture};
use kinetostat_machining::number as formatter;
use nalgebra::{DMatrix, Matrix6};

use crate::ui::numbers::number;

/// From this share of the way on, a load is near buckling.
const NEAR: f64 = 0.5;

/// Shares below are nothing.
const NOTHING: f64 = 1e-9;

/// How near one state of a machine is to instability.
pub(crate) struct Nearness<'e> {
    state: &'e MechanismEquilibrium,
    /// Largest share of the way to buckling of a limb with its ends held.
    pub(crate) limb: Option<(f64, &'e str)>,
    /// Largest compression of a link as a share of its Euler load, its limb, and its name.
    link: Option<(f64, &'e str, &'e str)>,
    /// See [`share`].
    pub(crate) free: Option<f64>,
}

impl<'e> Nearness<'e> {
    pub(crate) fn of(posture: &Posture<'_>, state: &'e MechanismEquilibrium) -> Self {
        let limbs = state.limbs.iter();
        let links = limbs.clone().flat_map(|l| {
            let own = l.link_loads.iter();
            own.map(move |k| (k.share, l.name.as_str(), k.link.as_str()))
        });
        let shares = limbs.filter_map(|l| Some((finite(l.stability.share_to_buckling)?, &*l.name)));
        Self {
            state,
            limb: shares.max_by(|a, b| a.0.total_cmp(&b.0)),
            link: links.max_by(|a, b| a.0.total_cmp(&b.0)),
            free: share(posture, state),
        }
    }

    pub(crate) fn of_euler_load(&self) -> Option<f64> {
        self.link.map(|(share, _, _)| share)
    }

    /// The largest of all shares.
    pub(crate) fn most(&self) -> f64 {
        let shares = [self.limb.map(|l| l.0), self.of_euler_load(), self.free];
        shares.into_iter().flatten().fold(0.0, f64::max)
    }

    /// Stable, but not far from where it is not.
    pub(crate) fn near(&self) -> bool {
        self.state.stable() && self.most_to_buckling() > NEAR
    }

    /// Under loads without a potential it does not go away, but may swing with growing amplitude.
    pub(crate) fn may_flutter(&self) -> bool {
        self.state.may_flutter()
    }

    /// The largest of the shares that lead to buckling: those of loads without a potential lead to where the
    /// symmetric part of the stiffness is no more positive, and nothing need buckle there or beyond.
    fn most_to_buckling(&self) -> f64 {
        let limbs = self.state.limbs.iter().filter(|l| l.conservative);
        let limbs = limbs.filter_map(|l| finite(l.stability.share_to_buckling));
        let free = self.free.filter(|_| self.state.conservative);
        let shares = limbs.chain(free).chain(self.of_euler_load());
        shares.fold(0.0, f64::max)
    }

    /// What the share of the limb that is farthest on its way leads to.
    fn limb_leads_to(&self) -> &'static str {
        let named = |name: &str| self.state.limbs.iter().find(|l| l.name == name);
        let limb = self.limb.and_then(|(_, name)| named(name));
        match limb.is_none_or(|l| l.conservative) {
            true => "buckling",
            false => way_to(false),
        }
    }

    /// The share of the machine with its tool free, where its limbs do not tell it.
    pub(crate) fn free_beyond_limbs(&self) -> Option<f64> {
        let of_limbs = self.limb.map_or(0.0, |l| l.0);
        self.free.filter(|s| *s > NOTICEABLE && *s > of_limbs)
    }

    /// What goes how far, and the judgement. `under_load`: on the tool.
    pub(crate) fn in_words(&self, under_load: bool) -> String {
        let mut parts = Vec::new();
        match (self.limb, under_load) {
            (Some((share, limb)), true) if share > NOTHING => parts.push(format!(
                "the load brings limb '{limb}' {} of the way to {}",
                formatter::share(share),
                self.limb_leads_to()
            )),
            (Some((share, limb)), false) if share > NOTHING => parts.push(format!(
                "without load on the tool limb '{limb}' is {} of the way to {}",
                formatter::share(share),
                self.limb_leads_to()
            )),
            (Some(_), true) => parts.push("no load brings a limb towards buckling".to_owned()),
            (Some(_), false) => {
                parts.push("without load on the tool no limb is on the way to buckling".to_owned());
            }
            (None, _) => {}
        }
        let mut most = self.limb.map_or(0.0, |l| l.0);
        if let Some((share, limb, link)) = self.link.filter(|l| l.0 > 0.0) {
            most = most.max(share);
            parts.push(format!(
                "the link nearest to its Euler load is '{link}' of '{limb}', {} of it",
                formatter::share(share)
            ));
        }
        // Where it is lost, nothing is on the way.
        if let Some(share) = self.free_beyond_limbs().filter(|_| self.state.stable()) {
            let (nearest, to) = match (share > most, self.state.conservative) {
                (true, true) => (", which is nearest to instability,", String::new()),
                (false, true) => ("", String::new()),
                (_, false) => ("", format!(" to {}", way_to(false))),
            };
            parts.push(format!(
                "the machine with its tool free{nearest} goes {} % of the way{to}",
                number(100.0 * share, 3)
            ));
        }
        let mut text = parts.join("; ");
        if text.is_empty() {
            text = "no limb has anything that could buckle".to_owned();
        }
        let told = most;
        let most = self.most();
        text.push_str(match self.state.stable() {
            false if self.state.shapes_stable() => ": NOT STABLE, the tool does not stay",
            false => ": NOT STABLE",
            true if self.near() => ": NEAR BUCKLING",
            true if self.may_flutter() => {
                ": it does not go away, but may swing with growing amplitude (flutter), which depends on its masses"
            }
            true if most > NOTICEABLE => ": stiffness changes noticeably with the load",
            true if told > NOTHING => ": far from buckling",
            true => "",
        });
        text
    }
}

/// What a share is the share of the way to.
pub(crate) fn way_to(conservative: bool) -> &'static str {
    match conservative {
        true => "instability",
        false => "where its stiffness is no more positive in every motion",
    }
}

fn finite(share: Option<f64>) -> Option<f64> {
    share.filter(|s| s.is_finite())
}

/// How near a state is to where the machine with its tool free is not stable any more, 1 is there.
/// It is at least as near as each of its limbs is while the tool is held; the motions of the tool
/// are judged by the stiffness condensed to it. The share is that of the state itself: a limit point
/// of the load, where the machine snaps, is seen as the stiffness falls towards it and not sooner,
/// and of a state behind a snap it is the share of that state. Where the state is not stable the
/// share is at least 1, and none where the condensed stiffness, which comes back from infinity behind
/// the buckling of a limb, does not tell it.
pub(crate) fn share(posture: &Posture<'_>, loaded: &MechanismEquilibrium) -> Option<f64> {
    let limbs = loaded.limbs.iter();
    let limbs = limbs.filter_map(|l| finite(l.stability.share_to_buckling));
    let most = limbs
        .chain(condensed(posture, loaded))
        .max_by(f64::total_cmp);
    most.filter(|s| loaded.stable() || *s >= 1.0)
}

/// How far a dead load has brought the tool, no limb having buckled: 0 unloaded, 1 where its stiffness
/// is lost, negative where the load stiffens it. `1 - s` of the smallest `s` in `K v = s K_e v`, with
/// the stiffness under load `K` and that of the same bent machine with its springs alone, `K_e`.
/// Both are condensed to the tool, which makes the share nearly straight in the load. `None` where
/// no direction is elastic.
fn condensed(posture: &Posture<'_>, loaded: &MechanismEquilibrium) -> Option<f64> {
    let limbs = posture.limbs().iter().zip(&loaded.limbs);
    let joints = limbs.map(|(own, bent)| LimbPosture {
        commands: own.commands.clone(),
        coordinates: bent.coordinates.clone(),
    });
    let bent = posture
        .mechanism()
        .posture_from_joints(&loaded.tool, joints.collect())
        .ok()?;
    let elastic = bent.stiffness().ok()?;
    // Rotations as motions at the natural length.
    let unit = |i: usize| if i < 3 { 1.0 } else { loaded.length };
    let scaled = |m: &Matrix6<f64>, sign: i32| {
        Matrix6::from_fn(|i, j| m[(i, j)] * (unit(i) * unit(j)).powi(sign))
    };
    let compliance = scaled(&elastic.compliance().springs, 1);
    let stiffness = scaled(&loaded.stiffness.symmetric(), -1);
    let eigen = compliance.symmetric_eigen();
    let least = 1e-10 * eigen.eigenvalues.amax();
    let held: Vec<usize> = (0..6).filter(|&i| eigen.eigenvalues[i] > least).collect();
    if held.is_empty() {
        return None;
    }
    let root = DMatrix::from_fn(6, held.len(), |i, j| {
        eigen.eigenvectors[(i, held[j])] * eigen.eigenvalues[held[j]].sqrt()
    });
    let whole = DMatrix::from_fn(6, 6, |i, j| stiffness[(i, j)]);
    let kept = root.transpose() * whole * &root;
    let share = 1.0 - kept.symmetric_eigenvalues().min();
    share.is_finite().then_some(share)
}

/// From this share of the way to buckling on the stiffness changes noticeably.
pub(crate) const NOTICEABLE: f64 = 0.1;
