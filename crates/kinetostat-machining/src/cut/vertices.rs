//! The few places of a cut between which its load is linear.

use kinetostat::Wrench;
use kinetostat::number::larger;

use crate::cut::station::CutStation;
use crate::profile::by_move::{ByMove, Profile, reduced};

/// A part of the largest force or moment that does not matter.
const NEGLIGIBLE: f64 = 0.005;

/// The largest force (N) and moment (N m) along a path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    pub force: f64,
    pub moment: f64,
}

impl Scale {
    /// Size of a wrench; 1 where it is no longer negligible.
    pub fn size(&self, wrench: &[f64; 6]) -> f64 {
        let wrench = Wrench((*wrench).into());
        let relative = |size: f64, largest: f64| match size > 0.0 {
            true => size / (NEGLIGIBLE * largest),
            false => 0.0,
        };
        larger(
            relative(wrench.force().norm(), self.force),
            relative(wrench.moment().norm(), self.moment),
        )
    }

    /// The vertices without which the load would be another.
    pub fn needed(&self, vertices: &[(f64, [f64; 6])]) -> Vec<(f64, [f64; 6])> {
        reduced(vertices, |off| self.size(off))
    }
}

/// The load along a path by its vertices.
#[derive(Clone, Debug)]
pub(crate) struct Vertices {
    pub profile: Profile<6>,
    pub scale: Scale,
}

impl Vertices {
    pub fn of(moves: &[Vec<CutStation>]) -> Self {
        let wrenches = || moves.iter().flatten().map(|station| station.wrench);
        let force = wrenches().map(|wrench| wrench.force().norm());
        let moment = wrenches().map(|wrench| wrench.moment().norm());
        let scale = Scale {
            force: force.fold(0.0, larger),
            moment: moment.fold(0.0, larger),
        };
        let mut profile = ByMove::new();
        for own in moves {
            let all: Vec<_> = own.iter().map(|s| (s.share, s.wrench.0.into())).collect();
            profile.push(scale.needed(&all));
        }
        Self { profile, scale }
    }
}
