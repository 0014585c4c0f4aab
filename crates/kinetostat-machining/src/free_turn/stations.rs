//! Stations evenly along the way, and what lies between two of them.

use kinetostat::number::smaller;

use crate::free_turn::error::TurnError;
use crate::free_turn::task::{TurnBand, TurnTask};
use crate::free_turn::way::{Way, WayPlace};

/// The turns that are tried.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turns {
    pub from_deg: f64,
    pub step_deg: f64,
    pub count: usize,
    /// The whole circle: the first one follows the last one.
    pub circle: bool,
}

impl Turns {
    pub fn of(band: &TurnBand) -> Self {
        let span = band.to_deg - band.from_deg;
        let steps = (span / band.step_deg - 1e-9).ceil().max(1.0);
        let circle = span > 360.0 - 1e-9;
        Self {
            from_deg: band.from_deg,
            step_deg: span / steps,
            count: steps as usize + usize::from(!circle),
            circle,
        }
    }

    pub fn deg(&self, index: u32) -> f64 {
        self.from_deg + self.step_deg * f64::from(index)
    }

    /// Steps from one turn to another, on a circle by the shorter way.
    pub fn steps(&self, from: u32, to: u32) -> i64 {
        let steps = i64::from(to) - i64::from(from);
        let count = self.count as i64;
        match self.circle {
            true if 2 * steps > count => steps - count,
            true if 2 * steps < -count => steps + count,
            _ => steps,
        }
    }
}

/// Interval between a station and the one before it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gap {
    /// Way, mm.
    pub length: f64,
    /// Maximum turn, deg.
    pub turn_deg: f64,
    /// The program says how the tool goes there.
    pub known: bool,
}

/// A station.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Station {
    /// Way from the start, mm.
    pub at: f64,
    /// Share of the way that it stands for.
    pub share: f64,
    pub place: WayPlace,
    /// Interval to the station before; `None` before the first one.
    pub gap: Option<Gap>,
}

/// All stations of a way.
pub(crate) fn stations(task: &TurnTask<'_>, way: &Way<'_>) -> Result<Vec<Station>, TurnError> {
    let places = way.length / task.station_mm;
    let most = task.bounds.most_postures;
    if places > most as f64 {
        return Err(TurnError::TooMany {
            what: format!(
                "stations of {} mm along {:.0} mm of path are {places:.3e} in all",
                task.station_mm, way.length
            ),
            most,
        });
    }
    let mut stations: Vec<Station> = Vec::new();
    for [first, last] in &way.stretches {
        let from = way.sections[*first].from;
        let end = way.sections[*last].from + way.sections[*last].length;
        let pieces = ((end - from) / task.station_mm - 1e-9).ceil().max(1.0);
        let mut section = *first;
        for piece in 0..=pieces as usize {
            let at = match piece as f64 == pieces {
                true => end,
                false => from + (end - from) * piece as f64 / pieces,
            };
            let before = section;
            section = way.section_at(at).clamp(*first, *last);
            let gap = stations.last().map(|last: &Station| match piece {
                0 => Gap {
                    length: 0.0,
                    turn_deg: f64::INFINITY,
                    known: false,
                },
                _ => {
                    let length = at - last.at;
                    let between = way.sections[before..=section].iter();
                    // A section that only begins here does not count.
                    let between = between.filter(|s| s.length > 0.0 && s.from < at);
                    let rate = between.map(|s| s.rate).fold(f64::INFINITY, smaller);
                    Gap {
                        length,
                        turn_deg: rate * length,
                        known: true,
                    }
                }
            });
            stations.push(Station {
                at,
                share: 0.0,
                place: way.place(section, at),
                gap,
            });
        }
    }
    // Each stands for half of the way to its neighbours.
    for index in 1..stations.len() {
        let Some(gap) = stations[index].gap else {
            continue;
        };
        let half = 0.5 * gap.length / way.length;
        stations[index].share += half;
        stations[index - 1].share += half;
    }
    Ok(stations)
}

/// Checks that the rate allows any step from one turn of the band to the next.
pub(crate) fn lets_turn(
    task: &TurnTask<'_>,
    stations: &[Station],
    turns: &Turns,
) -> Result<(), TurnError> {
    let gaps = stations.iter().filter_map(|station| station.gap);
    let most = gaps
        .filter(|gap| gap.known)
        .map(|gap| gap.turn_deg)
        .fold(0.0, kinetostat::number::larger);
    if turns.count > 1 && most < turns.step_deg * (1.0 - 1e-9) {
        return Err(TurnError::Input {
            what: format!(
                "the rate lets the tool turn by at most {most:.4} deg between two stations of {} mm, less than one step of the band \
                 ({:.4} deg): it could never turn. Take a smaller step of the band, stations that are farther apart, or a larger rate",
                task.station_mm, turns.step_deg
            ),
        });
    }
    Ok(())
}
