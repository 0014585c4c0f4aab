//! Result at a place of a program.

use kinetostat_chatter::{Instability, LeftOut};

use crate::vibration::program::forced::ForcedVibration;
use crate::vibration::program::site::{CutSite, SiteGroup};

/// Limits within this factor are near each other: those of cuts that are alike differ by up to 9 %.
const NEAR: f64 = 1.1;

/// Verdict on the cut at a place.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Vibrations die away.
    Stable,
    /// They grow.
    Chatters,
    /// Not judged, with the reason.
    NotJudged(String),
}

/// A place of a program with its limit.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedSite {
    /// The place.
    pub site: CutSite,
    /// Verdict on the cut.
    pub verdict: Verdict,
    /// Depth at which the cut becomes unstable at the speed of the program, mm; `None` where it does not up to `looked_up_to_mm`.
    pub limit_mm: Option<f64>,
    /// Largest depth that was looked at, mm.
    pub looked_up_to_mm: f64,
    /// Strongest frequency of the vibration at the limit, Hz.
    pub chatter_hz: Option<f64>,
    /// Type of the instability at the limit.
    pub kind: Option<Instability>,
    /// Lowest frequency of the machine there, Hz.
    pub first_hz: Option<f64>,
    /// Forced vibration of the tool; `None` where it chatters or is not judged.
    pub forced: Option<ForcedVibration>,
    /// Frequency of the fastest mode that swings in the calculation, Hz; those above are springs.
    pub modes_up_to_hz: Option<f64>,
    /// Mode with the largest share among those treated as springs although they contribute.
    pub left_out: Option<LeftOut>,
    /// Uncertainty of the force of the cut, as a share of it.
    pub force_spread: f64,
    /// Error of the response by modes with their own damping alone at the frequencies of the modes, as a share of it; 0
    /// where no damper couples modes.
    pub lost_coupling: f64,
    /// True if its limit was not found, so that it may chatter.
    pub(crate) is_open: bool,
    /// Number of the cluster of groups that are alike.
    pub(crate) cluster: usize,
    /// Places of the program that this one stands for.
    pub places: usize,
    /// Start and end of these along the path, mm.
    pub path_mm: [f64; 2],
}

impl JudgedSite {
    /// True if the cut was judged.
    #[must_use]
    pub fn is_judged(&self) -> bool {
        !matches!(self.verdict, Verdict::NotJudged(_))
    }

    /// True if the cut is stable, but not with a force larger by its spread: the force is the product of depth and law.
    #[must_use]
    pub fn is_within_spread(&self) -> bool {
        let reached =
            |limit_mm: f64| limit_mm <= self.site.station.depth_mm * (1.0 + self.force_spread);
        self.verdict == Verdict::Stable && self.limit_mm.is_some_and(reached)
    }

    /// True where what is said hangs on this cut and cuts that are alike may differ: its limit was not found, lies near its depth
    /// or between this and that which the spread of the force allows, or near the least limit of its line, mm, if it chatters.
    pub(crate) fn is_decisive(&self, least_mm: f64) -> bool {
        let depth_mm = self.site.station.depth_mm;
        let largest_mm = depth_mm * (1.0 + self.force_spread) * NEAR;
        let decides = |limit_mm: f64| {
            let is_near = depth_mm <= limit_mm * NEAR && limit_mm <= largest_mm;
            is_near || (self.verdict == Verdict::Chatters && limit_mm <= least_mm * NEAR)
        };
        self.is_open || self.limit_mm.is_some_and(decides)
    }

    /// True if it is worse than another one of the same group: it chatters, or its limit was not found, or is nearer to
    /// its depth; of places with neither the first is kept.
    pub(crate) fn is_worse_than(&self, other: &Self) -> bool {
        let rank = |judged: &Self| match judged.verdict {
            Verdict::Chatters => 3,
            Verdict::NotJudged(_) if judged.is_open => 2,
            Verdict::Stable => 1,
            Verdict::NotJudged(_) => 0,
        };
        let share = |judged: &Self| match judged.limit_mm {
            Some(limit_mm) => limit_mm / judged.site.station.depth_mm,
            None => f64::INFINITY,
        };
        rank(self) > rank(other) || (rank(self) == rank(other) && share(self) < share(other))
    }

    /// Result for a group of the same cluster.
    pub(crate) fn for_group(&self, group: SiteGroup<'_>, cluster: usize) -> Self {
        let (deepest, _) = group.judged(1.0);
        Self {
            site: *deepest,
            cluster,
            places: group.count(),
            path_mm: group.path_mm(),
            ..self.clone()
        }
    }

    pub(crate) fn not_judged(
        site: &CutSite,
        group: &SiteGroup<'_>,
        why: impl Into<String>,
    ) -> Self {
        Self {
            site: *site,
            verdict: Verdict::NotJudged(why.into()),
            limit_mm: None,
            looked_up_to_mm: 0.0,
            chatter_hz: None,
            kind: None,
            first_hz: None,
            forced: None,
            modes_up_to_hz: None,
            left_out: None,
            force_spread: 0.0,
            lost_coupling: 0.0,
            is_open: false,
            cluster: 0,
            places: group.count(),
            path_mm: group.path_mm(),
        }
    }
}
