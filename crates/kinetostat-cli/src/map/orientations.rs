//! The orientations and loads at every place of a map.

use kinetostat::{Mechanism, Wrench};
use nalgebra::UnitQuaternion;

use crate::map::arguments::MapArgs;
use crate::place::orientation;
use crate::ui::failure::{Answer, Failure};

/// Orientations of the tool at every place.
pub(crate) struct Orientations {
    /// Requested orientations; none: it follows.
    requested: Vec<Option<UnitQuaternion<f64>>>,
    /// The first one, at home without any.
    pub(crate) first: UnitQuaternion<f64>,
    /// True if the orientation is the nearest to the first that the machine can have.
    pub(crate) follows: bool,
}

impl Orientations {
    /// Orientations by the options; without them, that at home.
    pub(crate) fn asked(args: &MapArgs, mechanism: &Mechanism) -> Answer<Self> {
        let requested: Vec<Option<UnitQuaternion<f64>>> = (args.rotation.iter())
            .map(|text| orientation::option_or_follows("--rotation", text))
            .collect::<Answer<_>>()?;
        if requested.len() > 1 && requested.iter().any(Option::is_none) {
            return Err(Failure::input(
                "--rotation follows is the only orientation, or none of them",
            ));
        }
        let home = mechanism.platforms()[mechanism.tool()].home.rotation;
        let first = requested.first().copied();
        Ok(Self {
            follows: first.map_or_else(|| mechanism.turns_as_it_moves(), |a| a.is_none()),
            first: first.flatten().unwrap_or(home),
            requested,
        })
    }

    /// True if the options state any.
    pub(crate) fn are_stated(&self) -> bool {
        !self.requested.is_empty()
    }

    /// Number of cases of each orientation with each load.
    pub(crate) fn cases(&self, loads: &[Wrench]) -> Answer<usize> {
        let cases = self.requested.len().max(1) * loads.len().max(1);
        if cases > 1 && self.follows {
            return Err(Failure::input(
                "several loads are compared where the orientation is held; give --rotation, or one load",
            ));
        }
        Ok(cases)
    }

    /// The cases beside the first orientation with the first load.
    pub(crate) fn further(&self, loads: &[Wrench]) -> Vec<(UnitQuaternion<f64>, Option<Wrench>)> {
        let orientations: Vec<_> = match self.requested.is_empty() {
            true => vec![self.first],
            false => self.requested.iter().flatten().copied().collect(),
        };
        let loads: Vec<Option<Wrench>> = match loads.is_empty() {
            true => vec![None],
            false => loads.iter().copied().map(Some).collect(),
        };
        let all = orientations
            .iter()
            .flat_map(|o| loads.iter().map(move |l| (*o, *l)));
        all.skip(1).collect()
    }
}
