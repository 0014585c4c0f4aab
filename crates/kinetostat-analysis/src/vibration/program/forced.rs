//! Forced vibration of the tool in a stable cut, and the error that it leaves on the wall [D 9].
//!
//! The force is that of the cut's own law over a revolution, edge forces and run-out included, with the arc and the
//! depth of the place. A vibration with the tooth period is not regenerative; that of a run-out would be, but is
//! treated as if it were not.

use std::f64::consts::PI;

use kinetostat_chatter::{Cut, Milled, PeriodicForce, Regeneration, Result, Vibration};
use kinetostat_cutting::{Contact, Engagement, Feed, Milling, Revolution};
use kinetostat_machining::CuttingTool;
use nalgebra::Vector3;

use crate::vibration::program::site::CutSite;

/// Harmonics of the passing teeth that are counted.
const HARMONICS: usize = 120;
/// Heights at which the wall is looked at, from the tip to the depth of the cut.
const HEIGHTS: usize = 13;
/// An arc that ends as near to a wall as this makes it, rad.
const AT_WALL: f64 = 0.05;

/// The steady vibration of the tool's tip about its mean place: what remains when a program is compensated for the mean force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForcedVibration {
    /// Teeth that pass in a second, Hz.
    pub tooth_passing_hz: f64,
    /// Root of the mean square of the distance from the mean place, mm.
    pub root_mean_square_mm: f64,
    /// Frequency of the strongest harmonic, Hz.
    pub strongest_hz: f64,
    /// Frequency of the machine's mode nearest to that (by their ratio), Hz.
    pub nearest_mode_hz: f64,
    /// Error on the wall over its height, mm, least and most, positive where the tool has cut too deep; `None` where
    /// the cut makes no wall. In a slot it covers both walls.
    pub wall_mm: Option<[f64; 2]>,
}

impl ForcedVibration {
    /// The larger error of the walls, whatever its sign, mm; of errors as large the one that is too deep.
    #[must_use]
    pub fn worst_wall_mm(&self) -> Option<f64> {
        let [least, most] = self.wall_mm?;
        Some(if -least > most { least } else { most })
    }

    /// Forced vibration at a place in the cut, with the response of the machine there.
    pub(crate) fn of(
        regeneration: &Regeneration,
        tool: &CuttingTool,
        site: &CutSite,
    ) -> Result<Option<Self>> {
        let (station, Cut::Milling(cut)) = (&site.station, regeneration.cut()) else {
            return Ok(None);
        };
        let Some(contact) = station.contact else {
            return Ok(None);
        };
        let Ok(feed) = Feed::level(station.feed_per_tooth_mm) else {
            return Ok(None);
        };
        let side = Contact::side(0.0, station.depth_mm, contact.entry, contact.exit);
        let engagement = Engagement {
            contacts: vec![side],
        };
        let milling = Milling::new(&tool.tool, &*tool.law, &engagement, feed);
        let force = of_milling(&milling.revolution(), cut.teeth())?;
        let response = regeneration.response();
        let vibration = Vibration::new(response, &force, station.rpm)?.without_mean();
        let strongest = vibration.strongest();
        let frequencies = response
            .modes()
            .iter()
            .map(kinetostat_chatter::Mode::frequency_hz);
        let apart = |f: f64| (f / strongest.frequency_hz).ln().abs();
        let nearest = frequencies.reduce(|a, b| if apart(b) < apart(a) { b } else { a });
        let height = 1e-3 * station.depth_mm / (HEIGHTS - 1) as f64;
        let heights: Vec<f64> = (0..HEIGHTS).map(|i| height * i as f64).collect();
        let mut errors = Vec::new();
        for milled in walls(side) {
            errors.extend(vibration.surface_error(cut, milled, &heights)?);
        }
        errors.sort_by(f64::total_cmp);
        let ends = errors.first().zip(errors.last());
        let wall_mm = ends.map(|(least, most)| [1e3 * least, 1e3 * most]);
        Ok(nearest.map(|nearest_mode_hz| Self {
            tooth_passing_hz: station.rpm / 60.0 * cut.teeth() as f64,
            root_mean_square_mm: 1e3 * vibration.root_mean_square().norm(),
            strongest_hz: strongest.frequency_hz,
            nearest_mode_hz,
            wall_mm,
        }))
    }
}

/// Harmonics over a revolution, or over one tooth period where all teeth are alike.
fn of_milling(revolution: &Revolution, teeth: usize) -> Result<PeriodicForce> {
    let forces: Vec<Vector3<f64>> = revolution.forces.iter().map(|f| f.force_n).collect();
    let of_tooth = forces.len() / teeth;
    let (first, others) = forces.split_at(of_tooth);
    match others.chunks(of_tooth).all(|other| other == first) {
        true => PeriodicForce::sampled(teeth, first, HARMONICS),
        false => PeriodicForce::sampled(1, &forces, HARMONICS * teeth),
    }
}

/// The walls that a cut leaves: a tooth that comes in at 0 makes the left one as in up milling, one that leaves at pi the right one as
/// in down milling.
fn walls(side: Contact) -> impl Iterator<Item = Milled> {
    [(0.0, Milled::Up), (PI, Milled::Down)]
        .into_iter()
        .filter_map(move |(angle, milled)| side.reaches(angle, AT_WALL).then_some(milled))
}
