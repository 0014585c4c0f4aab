//! A path as one way: where the tool is after so many millimetres, and where nobody knows how it got there.

use kinetostat::Pose;
use kinetostat::number::smaller;
use kinetostat_program::{Knowledge, Move, Path};
use nalgebra::{Unit, UnitQuaternion, Vector3};

use crate::free_turn::error::TurnError;
use crate::free_turn::task::{TurnBand, TurnTask};
use crate::placement::Placement;

/// A move that turns the tool's axis counts at least so long by degree, mm: it has stations also where it has no length.
const MM_PER_DEG: f64 = 1.0;

/// A move on the way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Section {
    /// Start, mm of the way.
    pub from: f64,
    /// Length, mm; zero if the program does not state the start of the move.
    pub length: f64,
    /// Maximum turn by way, deg/mm.
    pub rate: f64,
    /// The program changes the orientation of the tool on it.
    pub turns: bool,
}

/// A path with its length counted through.
#[derive(Clone, Debug)]
pub(crate) struct Way<'a> {
    path: &'a Path,
    placement: Placement,
    /// Sections, one for every move.
    pub sections: Vec<Section>,
    /// First and last section of every stretch that is known without a break.
    pub stretches: Vec<[usize; 2]>,
    /// Length in all, mm.
    pub length: f64,
    /// The axis of the tool, axes of the tool.
    pub axis: Unit<Vector3<f64>>,
}

/// A place on the way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WayPlace {
    pub move_index: usize,
    pub line: usize,
    pub position_mm: Vector3<f64>,
    /// Tool at the turn that the program states, base from tool.
    pub pose: Pose,
}

/// True if the moves of a path state the orientation of the tool.
fn states_orientation(path: &Path) -> bool {
    path.moves.iter().any(|motion| motion.tool_turn.is_some())
}

/// The axis of the tool, axes of the tool, unit vector: of the path where its moves state orientations, else z.
pub(crate) fn tool_axis(path: &Path) -> Option<Unit<Vector3<f64>>> {
    match states_orientation(path) {
        true => Unit::try_new(path.tool_axis, 1e-6),
        false => Some(Vector3::z_axis()),
    }
}

impl<'a> Way<'a> {
    /// Way of a task whose numbers have been checked.
    pub fn of(task: &TurnTask<'a>) -> Result<Self, TurnError> {
        let axis = tool_axis(task.path).ok_or_else(|| TurnError::Input {
            what:
                "the path states no axis of the tool: a unit vector in axes of the tool is needed"
                    .to_owned(),
        })?;
        let mut way = Self {
            path: task.path,
            placement: task.placement,
            sections: Vec::with_capacity(task.path.moves.len()),
            stretches: Vec::new(),
            length: 0.0,
            axis,
        };
        let mut broken = true;
        for (index, motion) in task.path.moves.iter().enumerate() {
            let turn_deg = turn_deg(motion);
            let length = match motion.known {
                Knowledge::Whole => motion.length_mm().max(MM_PER_DEG * turn_deg),
                Knowledge::End | Knowledge::Nothing => 0.0,
            };
            if !length.is_finite() || length < 0.0 {
                return Err(TurnError::Input {
                    what: format!("line {}: the move has no finite length", motion.line),
                });
            }
            way.sections.push(Section {
                from: way.length,
                length,
                rate: task.bounds.rate_deg_per_mm,
                turns: turn_deg > 1e-6,
            });
            way.length += length;
            match (motion.known, way.stretches.last_mut()) {
                (Knowledge::Whole, Some(stretch)) if !broken => stretch[1] = index,
                (Knowledge::Whole, _) => way.stretches.push([index, index]),
                _ => {}
            }
            broken = motion.known != Knowledge::Whole;
        }
        way.stretches.retain(|[first, last]| {
            let sections = &way.sections;
            sections[*last].from + sections[*last].length > sections[*first].from
        });
        if way.stretches.is_empty() {
            return Err(TurnError::Input {
                what: "the path has no length: no move goes from a known place to another"
                    .to_owned(),
            });
        }
        Ok(way)
    }

    /// The section in which a place of the way is: the last one that begins there or before and has a length.
    pub fn section_at(&self, at: f64) -> usize {
        let after = self.sections.partition_point(|section| section.from <= at);
        let mut before = self.sections[..after].iter();
        before
            .rposition(|section| section.length > 0.0)
            .or_else(|| {
                self.sections
                    .iter()
                    .position(|section| section.length > 0.0)
            })
            .unwrap_or(0)
    }

    /// Place of the tool after `at` mm, in the section of that place.
    pub fn place(&self, section: usize, at: f64) -> WayPlace {
        let motion = &self.path.moves[section];
        let Section { from, length, .. } = self.sections[section];
        let share = match length > 0.0 {
            true => ((at - from) / length).clamp(0.0, 1.0),
            false => 1.0,
        };
        let position_mm = motion.point(share);
        let orientation = self.placement.orientation_on(motion, share);
        WayPlace {
            move_index: section,
            line: motion.line,
            position_mm,
            pose: self.placement.pose(&position_mm, orientation),
        }
    }

    /// The tool turned about its axis by an angle, deg.
    pub fn turned(&self, pose: &Pose, turn_deg: f64) -> Pose {
        pose * UnitQuaternion::from_axis_angle(&self.axis, turn_deg.to_radians())
    }
}

/// Angle by which the program turns the tool on a move, deg.
fn turn_deg(motion: &Move) -> f64 {
    let turn = motion.tool_turn.as_ref();
    turn.map_or(0.0, |turn| turn.start.angle_to(&turn.end).to_degrees())
}

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
