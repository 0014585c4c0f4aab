//! The path with the turns that were chosen written into its moves.

use kinetostat_program::{Arc, Curve, Feed, FeedMode, Knowledge, Move, Path, ToolTurn};
use nalgebra::{UnitQuaternion, Vector3};

use crate::free_turn::choice::TurnChoice;
use crate::free_turn::error::TurnError;
use crate::free_turn::task::{TurnTask, checked};
use crate::free_turn::way::{Section, Way};
use crate::number::larger;

/// Maximum rotation of the tool by one piece of a move, deg: between two orientations it goes the shorter way.
const MOST_DEG: f64 = 90.0;

/// The rate of turning changes by less, deg/mm, where a move goes on as it was.
const SAME_RATE: f64 = 1e-9;

/// A path whose moves state the orientation of the tool with its free turn.
#[derive(Clone, Debug, PartialEq, Default)]
#[non_exhaustive]
pub struct TurnedPath {
    /// The path. A move on which the rate of turning changes has become several, all with its line: at the stations where it changes.
    /// Words of other axes go with the last of them.
    pub path: Path,
    /// Number of additional moves.
    pub added: usize,
    /// The number in the path before of every move.
    pub source: Vec<usize>,
    /// The largest angle between the axis of the tool on these moves and that of the program, deg: only moves on which the program
    /// turns it have one, for between two orientations the tool turns about one axis.
    pub axis_off_deg: f64,
}

/// Side of a place at which the turn jumps.
#[derive(Clone, Copy)]
enum Side {
    Before,
    Behind,
}

/// Puts the turns that were chosen for a task into the moves of its path. Moves that nobody knows are given the turns between which
/// they go.
///
/// # Errors
/// [`TurnError::Input`] for a task that makes no sense, or a choice of another path.
///
/// See [`choose_turns`](crate::choose_turns) for an example.
pub fn with_turns(task: &TurnTask<'_>, choice: &TurnChoice) -> Result<TurnedPath, TurnError> {
    checked(task)?;
    let way = Way::of(task)?;
    let own = choice.stations.last().map_or(f64::NAN, |s| s.way_mm);
    if own.is_nan() || (own - way.length).abs() > 1e-9 * way.length {
        return Err(TurnError::Input {
            what: format!(
                "the turns were chosen along {own:.4} mm, and the path has {:.4} mm: choose them for this path",
                way.length
            ),
        });
    }
    let knots = knots(choice);
    let mut turned = TurnedPath {
        path: task.path.clone(),
        ..TurnedPath::default()
    };
    let mut moves = Vec::with_capacity(task.path.moves.len());
    let mut side = Side::Before;
    for (index, motion) in task.path.moves.iter().enumerate() {
        let section = &way.sections[index];
        side = match (motion.known, section.length > 0.0) {
            (Knowledge::Whole, false) => side,
            (Knowledge::Whole, true) => Side::Before,
            _ => Side::Behind,
        };
        for shares in pieces(choice, &knots, motion, section) {
            let (piece, off) = piece(task, choice, &way, index, shares, side);
            turned.axis_off_deg = larger(turned.axis_off_deg, off);
            turned.source.push(index);
            moves.push(piece);
        }
    }
    turned.added = moves.len() - task.path.moves.len();
    turned.path.moves = moves;
    if !task
        .path
        .moves
        .iter()
        .any(|motion| motion.tool_turn.is_some())
    {
        turned.path.tool_axis = up(task);
    }
    Ok(turned)
}

/// Direction from the tip to the holder in axes of the tool, for a program of positions: along z, on the side that is up
/// in the part.
fn up(task: &TurnTask<'_>) -> Vector3<f64> {
    match (in_part(task) * Vector3::z()).z >= 0.0 {
        true => Vector3::z(),
        false => -Vector3::z(),
    }
}

/// Orientation of the tool in a program of positions, part axes from tool axes.
fn in_part(task: &TurnTask<'_>) -> UnitQuaternion<f64> {
    task.placement.base_from_part.rotation.inverse() * task.placement.tool_orientation
}

/// Places of the way where the rate of turning changes, mm.
fn knots(choice: &TurnChoice) -> Vec<f64> {
    let rate = |pair: &[crate::free_turn::choice::TurnStation]| {
        (pair[1].turn_deg - pair[0].turn_deg) / (pair[1].way_mm - pair[0].way_mm)
    };
    let threes = choice.stations.windows(3);
    threes
        .filter(|three| (rate(&three[..2]) - rate(&three[1..])).abs() > SAME_RATE)
        .map(|three| three[1].way_mm)
        .collect()
}

/// Shares from and to of the pieces of a move.
fn pieces(choice: &TurnChoice, knots: &[f64], motion: &Move, section: &Section) -> Vec<[f64; 2]> {
    if section.length <= 0.0 {
        return vec![[0.0, 1.0]];
    }
    let (from, to) = (section.from, section.from + section.length);
    let share = |at: f64| (at - from) / section.length;
    // Two turns do not add up to one about one axis if the program turns the tool: all stations are used.
    let places: Vec<f64> = match section.turns {
        true => choice
            .stations
            .iter()
            .map(|s| s.way_mm)
            .filter(|at| (from..to).contains(at))
            .collect(),
        false => {
            let first = knots.partition_point(|at| *at <= from);
            let last = knots.partition_point(|at| *at < to);
            knots[first.min(last)..last].to_vec()
        }
    };
    let inside = places.into_iter().map(share);
    let mut shares = vec![0.0];
    shares.extend(inside.filter(|share| *share > 1e-6 && *share < 1.0 - 1e-6));
    shares.push(1.0);
    shares.dedup();
    let mut pieces = Vec::new();
    for pair in shares.windows(2) {
        let at = |share: f64| choice.turn_at_deg(from + share * section.length);
        let own = (at(pair[1]) - at(pair[0])).abs();
        let by_program = match (motion.orientation(pair[0]), motion.orientation(pair[1])) {
            (Some(a), Some(b)) => a.angle_to(&b).to_degrees(),
            _ => 0.0,
        };
        let count = ((own + by_program) / MOST_DEG).ceil().max(1.0);
        for k in 0..count as usize {
            let part = |k: usize| pair[0] + (pair[1] - pair[0]) * k as f64 / count;
            let end = match (k + 1) as f64 == count {
                true => pair[1],
                false => part(k + 1),
            };
            pieces.push([part(k), end]);
        }
    }
    pieces
}

/// A piece of a move, and how far the axis of the tool is off in its middle, deg.
fn piece(
    task: &TurnTask<'_>,
    choice: &TurnChoice,
    way: &Way<'_>,
    index: usize,
    [from, to]: [f64; 2],
    side: Side,
) -> (Move, f64) {
    let (motion, section) = (&task.path.moves[index], &way.sections[index]);
    let axis = &way.axis;
    let program = |share: f64| motion.orientation(share).unwrap_or_else(|| in_part(task));
    let way = |share: f64| section.from + share * section.length;
    let (start_deg, end_deg) = match (section.length > 0.0, motion.known, side) {
        (true, ..) => (
            choice.turn_at_deg(way(from)),
            choice.turn_before_deg(way(to)),
        ),
        (false, Knowledge::Whole, Side::Before) => [choice.turn_before_deg(section.from); 2].into(),
        (false, Knowledge::Whole, Side::Behind) => [choice.turn_at_deg(section.from); 2].into(),
        _ => (
            choice.turn_before_deg(section.from),
            choice.turn_at_deg(section.from),
        ),
    };
    let about = |degrees: f64| UnitQuaternion::from_axis_angle(axis, degrees.to_radians());
    let (start, end) = (
        program(from) * about(start_deg),
        program(to) * about(end_deg),
    );
    let turn = match &motion.tool_turn {
        Some(turn) => turn.with_ends(start, end),
        None => ToolTurn::shortest(start, end),
    };
    let middle = program(0.5 * (from + to)) * axis.into_inner();
    let off = match section.length > 0.0 {
        true => (turn.at(0.5) * axis.into_inner())
            .angle(&middle)
            .to_degrees(),
        false => 0.0,
    };
    let whole = from == 0.0 && to == 1.0;
    let mut own = motion.clone();
    own.tool_turn = Some(Box::new(turn));
    if !whole {
        own.start = motion.point(from);
        own.end = motion.point(to);
        own.curve = part_of(&motion.curve, [from, to]);
        own.feed = motion.feed.map(|feed| match feed.mode {
            FeedMode::InverseTime => Feed {
                value: feed.value / (to - from),
                ..feed
            },
            FeedMode::PerMinute | FeedMode::PerRevolution => feed,
        });
        if to != 1.0 {
            own.extra.clear();
        }
    }
    (own, off)
}

/// A curve between two shares.
fn part_of(curve: &Curve, [from, to]: [f64; 2]) -> Curve {
    match curve {
        Curve::Line => Curve::Line,
        Curve::Arc(arc) => {
            let radius =
                |share: f64| arc.start_radius + share * (arc.end_radius - arc.start_radius);
            Curve::Arc(Arc {
                centre: arc.centre + arc.axis * (arc.rise * from),
                start_angle: arc.start_angle + arc.sweep * from,
                sweep: arc.sweep * (to - from),
                start_radius: radius(from),
                end_radius: radius(to),
                rise: arc.rise * (to - from),
                ..*arc
            })
        }
    }
}
