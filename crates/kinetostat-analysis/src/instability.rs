//! Closeness of a machine to instability under load: of its limbs with their ends held, of its links, and of the whole
//! with its tool free. All shares are 0 unloaded and 1 where stability is lost.

use kinetostat::number::larger;
use kinetostat::{MechanismEquilibrium, Posture, PostureRequest, machine::LimbPosture};
use nalgebra::{DMatrix, Matrix6};

/// Share from which a load is near buckling.
pub const NEAR_BUCKLING: f64 = 0.5;

/// Share to buckling from which the stiffness changes noticeably.
pub const NOTICEABLE: f64 = 0.1;

/// Load factors (1 / buckling factor) of one state of a machine.
#[derive(Clone, Copy, Debug)]
pub struct InstabilityShares<'e> {
    state: &'e MechanismEquilibrium,
    /// The limb that is nearest to buckling with its ends held.
    pub limb: Option<LimbShare<'e>>,
    /// The link with the largest compression.
    pub link: Option<LinkShare<'e>>,
    /// Share of the machine with its tool free, see [`share_to_instability`].
    pub free: Option<f64>,
}

/// Load factor of the limb nearest to buckling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimbShare<'e> {
    /// Share of the load at which it buckles.
    pub share: f64,
    /// Name of the limb.
    pub limb: &'e str,
}

/// Compression of a link relative to its Euler load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkShare<'e> {
    /// Compression as a share of its Euler load.
    pub share: f64,
    /// Name of its limb.
    pub limb: &'e str,
    /// Name of the link.
    pub link: &'e str,
}

impl<'e> InstabilityShares<'e> {
    /// The limb and the link of `state`, an equilibrium of `posture`, with the largest shares.
    #[must_use]
    pub fn of(posture: &Posture, state: &'e MechanismEquilibrium) -> Self {
        let links = state.limbs.iter().flat_map(|l| {
            l.link_loads.iter().map(move |k| LinkShare {
                share: k.share,
                limb: &l.name,
                link: &k.link,
            })
        });
        let limbs = state.limbs.iter().filter_map(|l| {
            Some(LimbShare {
                share: finite(l.stability.share_to_buckling)?,
                limb: &l.name,
            })
        });
        Self {
            state,
            limb: limbs.max_by(|a, b| a.share.total_cmp(&b.share)),
            link: links.max_by(|a, b| a.share.total_cmp(&b.share)),
            free: share_to_instability(posture, state),
        }
    }

    /// The state that they are of.
    #[must_use]
    pub fn state(&self) -> &'e MechanismEquilibrium {
        self.state
    }

    /// The largest of all shares.
    #[must_use]
    pub fn largest(&self) -> f64 {
        let shares = [
            self.limb.map(|l| l.share),
            self.link.map(|l| l.share),
            self.free,
        ];
        shares.into_iter().flatten().fold(0.0, larger)
    }

    /// Stable, but not far from where it is not.
    #[must_use]
    pub fn is_near_buckling(&self) -> bool {
        self.state.stable() && self.largest_to_buckling() > NEAR_BUCKLING
    }

    /// The largest of the shares that lead to buckling: those of loads without a potential lead to where the
    /// symmetric part of the stiffness is no more positive, and nothing need buckle there or beyond.
    fn largest_to_buckling(&self) -> f64 {
        let limbs = self.state.limbs.iter().filter(|l| l.conservative);
        let limbs = limbs.filter_map(|l| finite(l.stability.share_to_buckling));
        let free = self.free.filter(|_| self.state.conservative);
        let shares = limbs.chain(free).chain(self.link.map(|l| l.share));
        shares.fold(0.0, larger)
    }

    /// All loads on the limb that is nearest to buckling have a potential: its share leads to buckling.
    #[must_use]
    pub fn limb_is_conservative(&self) -> bool {
        let named = |name: &str| self.state.limbs.iter().find(|l| l.name == name);
        let limb = self.limb.and_then(|l| named(l.limb));
        limb.is_none_or(|l| l.conservative)
    }

    /// The share of the machine with its tool free, where its limbs do not tell it.
    #[must_use]
    pub fn free_beyond_limbs(&self) -> Option<f64> {
        let of_limbs = self.limb.map_or(0.0, |l| l.share);
        self.free.filter(|s| *s > NOTICEABLE && *s > of_limbs)
    }
}

fn finite(share: Option<f64>) -> Option<f64> {
    share.filter(|s| s.is_finite())
}

/// Load factor of a state with the tool free; 1 where stability is lost. It is at least that of each limb with the tool
/// held; motions of the tool are assessed by the stiffness condensed to it. The factor belongs to the state itself: a
/// limit point of the load (snap-through) shows only as the stiffness falls towards it, and a state beyond a snap has
/// the factor of that state. An unstable state has a factor of at least 1; `None` where the condensed stiffness, which
/// returns from infinity beyond the buckling of a limb, cannot give it.
#[must_use]
pub fn share_to_instability(posture: &Posture, loaded: &MechanismEquilibrium) -> Option<f64> {
    let limbs = loaded.limbs.iter();
    let limbs = limbs.filter_map(|l| finite(l.stability.share_to_buckling));
    let most = limbs
        .chain(condensed(posture, loaded))
        .max_by(f64::total_cmp);
    most.filter(|s| loaded.stable() || *s >= 1.0)
}

/// Load factor of a dead load while no limb has buckled: 0 unloaded, 1 where the tool's stiffness is lost, negative
/// where the load stiffens it. It is `1 - s` of the smallest `s` in `K v = s K_e v`, with the stiffness under load `K`
/// and the elastic stiffness of the same deformed machine, `K_e`. Both are condensed to the tool, which makes the
/// factor nearly linear in the load. `None` where no direction is elastic.
fn condensed(posture: &Posture, loaded: &MechanismEquilibrium) -> Option<f64> {
    let limbs = posture.limbs().iter().zip(&loaded.limbs);
    let joints = limbs.map(|(own, bent)| LimbPosture {
        commands: own.commands.clone(),
        coordinates: bent.coordinates.clone(),
    });
    let bent = posture
        .mechanism()
        .posture(PostureRequest::joints(&loaded.tool, joints.collect()))
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
