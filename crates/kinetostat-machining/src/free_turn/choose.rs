//! The turns of a task.

use rayon::prelude::*;

use crate::free_turn::choice::{TurnCell, TurnChoice, TurnFigures, TurnMap, TurnStation};
use crate::free_turn::constant::constant_turns;
use crate::free_turn::error::TurnError;
use crate::free_turn::no_way::no_way;
use crate::free_turn::nodes::Node;
use crate::free_turn::search::{Failed, Looked, Problem, Stand};
use crate::free_turn::serial::Joints;
use crate::free_turn::smooth::{Curve, smooth};
use crate::free_turn::task::{TurnCurve, TurnTask, checked};

/// Number of times that the distance of stations is doubled along a path that is too long for them: from 5 mm to 160
/// mm.
const TIMES_FARTHER: usize = 5;

/// Chooses the free turn of a round tool about its own axis along a whole path: at stations along it the turns of a band, in any of the
/// configurations of the arm, that cost least together and keep what is asked. The result is the cheapest of all candidates. Stations are
/// set farther apart on a path so long that it has more postures than may be kept ([`TurnChoice::station_mm`]).
///
/// # Errors
/// [`TurnError::Input`] for numbers and paths that make no sense, [`TurnError::NoFreedom`] for another machine than an arm of six
/// joints with a wrist in one point, [`TurnError::NoWay`] where every sequence of turns ends, with line, reasons and what helps,
/// [`TurnError::TooMany`] beyond the bounds of memory.
///
/// ```
/// use kinetostat_machining::{Placement, TurnTask, choose_turns, with_turns};
/// use kinetostat_program::{Program, ReadOptions, interpret};
/// use nalgebra::{UnitQuaternion, Vector3, vector};
///
/// // A spindle at a right angle to the flange of an arm, vertical where the arm is at home.
/// let arm = kinetostat_model::Model::preset("heavy_6r")?.mechanism;
/// let upright = UnitQuaternion::from_euler_angles(0.0, 0.5 * std::f64::consts::PI, 0.0);
/// let tool = kinetostat::Pose::from_parts(vector![0.2, 0.0, 0.1].into(), upright); // m
/// let arm = arm.with_tool(&tool);
/// let program = Program::read("G21 G90\nG0 X0 Y0 Z0\nG1 X100 F600\nG1 Y50\n")?;
/// let path = interpret(&program, &ReadOptions::default())?;
/// let mut placement = Placement::at(vector![1.3, -0.2, 0.8]);
/// placement.tool_orientation = UnitQuaternion::from_euler_angles(std::f64::consts::PI, 0.0, 0.0); // z downwards
/// let task = TurnTask::new(&arm, &path, placement);
///
/// let choice = choose_turns(&task)?;
/// assert!(choice.smallest_singular_value >= task.bounds.least_singular_value);
/// assert!(choice.largest_rate_deg_per_mm <= 2.0 + 1e-9);
/// let turned = with_turns(&task, &choice)?;
/// let tool = turned.path.moves[1].orientation(0.5).ok_or("an orientation")?;
/// assert!((tool * Vector3::z() + Vector3::z()).norm() < 1e-9, "still downwards");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn choose_turns(task: &TurnTask<'_>) -> Result<TurnChoice, TurnError> {
    checked(task)?;
    let mut spaced = task.clone();
    for _ in 0..TIMES_FARTHER {
        let problem = Problem::of(&spaced);
        if !matches!(problem, Err(TurnError::TooMany { .. })) {
            return chosen(problem?);
        }
        spaced.station_mm *= 2.0;
    }
    chosen(Problem::of(&spaced)?)
}

fn chosen(mut problem: Problem<'_, '_>) -> Result<TurnChoice, TurnError> {
    match problem.search() {
        Ok(found) => {
            let steps = Curve::of(&problem, found);
            let (curve, in_steps) = made_smooth(&problem, steps);
            Ok(choice(&problem, &curve, in_steps))
        }
        Err(Failed::Error(error)) => Err(error),
        Err(Failed::At(station, progress)) => Err(TurnError::NoWay(Box::new(no_way(
            &problem, station, &progress,
        )))),
    }
}

/// The curve that the task asks for, with the figures of the steps that it was made from.
fn made_smooth(problem: &Problem<'_, '_>, steps: Curve) -> (Curve, Option<TurnFigures>) {
    if problem.task.curve == TurnCurve::Steps {
        return (steps, None);
    }
    let in_steps = steps.figures(problem);
    let smooth = smooth(problem, steps);
    let fewer = fewer_knots(problem, smooth.clone());
    let curve = match fewer.figures(problem).cost <= in_steps.cost {
        true => fewer,
        false => smooth,
    };
    (curve, Some(in_steps))
}

fn choice(problem: &Problem<'_, '_>, curve: &Curve, in_steps: Option<TurnFigures>) -> TurnChoice {
    let listed: Vec<TurnStation> = (0..problem.stations.len())
        .map(|index| station(problem, curve, index))
        .collect();
    // At stations and between them.
    let seen = curve.seen.iter().flatten();
    let between = seen.map(|seen| (seen.line, &seen.joints, seen.singular_value));
    let at = curve.nodes.iter().enumerate().map(|(index, node)| {
        let line = problem.stations[index].place.line;
        (line, &node.joints, node.singular_value)
    });
    let mut least = (f64::INFINITY, 0);
    let mut limit: Option<(usize, f64, usize)> = None;
    for (line, joints, singular_value) in at.chain(between) {
        if singular_value < least.0 {
            least = (singular_value, line);
        }
        if let Some((joint, far)) = nearest_limit(problem, joints)
            && limit.is_none_or(|nearest| far < nearest.1)
        {
            limit = Some((joint, far, line));
        }
    }
    let configuration = curve.nodes.first().map_or(0, |node| node.configuration);
    let figures = curve.figures(problem);
    let [as_programmed, best_constant] = constant_turns(problem);
    TurnChoice {
        configuration,
        cost: figures.cost,
        largest_rate_deg_per_mm: figures.largest_rate_deg_per_mm,
        largest_rate_change_deg_per_mm: figures.largest_rate_change_deg_per_mm,
        in_steps,
        length_m: problem.postures.arm.serial.length,
        smallest_singular_value: least.0,
        smallest_singular_value_line: least.1,
        nearest_limit: limit,
        broken_links: problem.links.broken.len(),
        tried: (
            problem.turns.count,
            problem.nodes.iter().map(Vec::len).sum(),
        ),
        as_programmed,
        best_constant,
        map: map(problem, configuration),
        station_mm: problem.task.station_mm,
        stations: listed,
    }
}

fn nearest_limit(problem: &Problem<'_, '_>, joints: &Joints) -> Option<(usize, f64)> {
    let (joint, far) = problem.postures.ranges.nearest_limit(joints)?;
    Some((joint, far.to_degrees()))
}

fn station(problem: &Problem<'_, '_>, curve: &Curve, index: usize) -> TurnStation {
    let station = &problem.stations[index];
    let node = &curve.nodes[index];
    TurnStation {
        line: station.place.line,
        position_mm: station.place.position_mm.into(),
        way_mm: station.at,
        turn_deg: curve.turns[index],
        joints_deg: node.joints.map(f64::to_degrees),
        nearest_limit: nearest_limit(problem, &node.joints),
        smallest_singular_value: node.singular_value,
        compliance_m_per_n: node.compliance,
        after_break: station.gap.is_some_and(|gap| !gap.known),
    }
}

/// All turns at all stations, in one configuration: where joints may be on several turns, those farthest from their limits.
fn map(problem: &Problem<'_, '_>, configuration: u8) -> TurnMap {
    let count = problem.turns.count;
    let cells = problem.nodes.iter().map(|nodes| {
        let mut cells: Vec<Option<TurnCell>> = vec![None; count];
        for node in nodes
            .iter()
            .filter(|node| node.configuration == configuration)
        {
            let cell = &mut cells[node.turn as usize];
            if cell.is_none_or(|other| node.share_of_range < other.share_of_range) {
                *cell = Some(TurnCell {
                    smallest_singular_value: node.singular_value,
                    share_of_range: node.share_of_range,
                });
            }
        }
        cells
    });
    TurnMap {
        turns_deg: (0..count as u32)
            .map(|turn| problem.turns.deg(turn))
            .collect(),
        cells: cells.collect(),
    }
}

/// A turn is moved by no more, deg.
const MOST_DEG: f64 = 0.01;

/// Turns, postures and what is seen before each, behind the first station of a part up to its last one.
struct Part {
    first: usize,
    turns: Vec<f64>,
    nodes: Vec<Node>,
    seen: Vec<Vec<Looked>>,
}

/// The curve with the turns between its knots on lines.
fn fewer_knots(problem: &Problem<'_, '_>, mut curve: Curve) -> Curve {
    let knots = knots(problem, &curve);
    let parts: Vec<Part> = knots
        .par_windows(2)
        .filter_map(|ends| part(problem, &curve, [ends[0], ends[1]]))
        .collect();
    for part in parts {
        let inner = part.first + 1..part.first + 1 + part.turns.len();
        curve.turns[inner.clone()].copy_from_slice(&part.turns);
        curve.nodes[inner].copy_from_slice(&part.nodes);
        for (index, seen) in part.seen.into_iter().enumerate() {
            curve.seen[part.first + 1 + index] = seen;
        }
    }
    curve
}

/// The turn on the line between two stations, deg.
fn on_line(problem: &Problem<'_, '_>, curve: &Curve, [first, last]: [usize; 2], at: usize) -> f64 {
    let way = |station: usize| problem.stations[station].at;
    let share = (way(at) - way(first)) / (way(last) - way(first));
    curve.turns[first] + share * (curve.turns[last] - curve.turns[first])
}

/// Stations at which the curve bends, the first and the last of every stretch among them; ascending.
fn knots(problem: &Problem<'_, '_>, curve: &Curve) -> Vec<usize> {
    let count = curve.turns.len();
    let begins = |station: usize| problem.stations[station].gap.is_none_or(|gap| !gap.known);
    let mut is_knot: Vec<bool> = (0..count)
        .map(|station| station + 1 == count || begins(station) || begins(station + 1))
        .collect();
    let fixed: Vec<usize> = (0..count).filter(|station| is_knot[*station]).collect();
    let mut open: Vec<[usize; 2]> = fixed.windows(2).map(|ends| [ends[0], ends[1]]).collect();
    while let Some([first, last]) = open.pop() {
        if begins(last) {
            continue;
        }
        let off = |at: usize| (curve.turns[at] - on_line(problem, curve, [first, last], at)).abs();
        let inner = (first + 1..last).map(|at| (off(at), at));
        let Some((farthest, at)) = inner.max_by(|a, b| a.0.total_cmp(&b.0)) else {
            continue;
        };
        if farthest > MOST_DEG {
            is_knot[at] = true;
            open.extend([[first, at], [at, last]]);
        }
    }
    (0..count).filter(|station| is_knot[*station]).collect()
}

/// Part of the curve between two knots, on a line; `None` if it is there already, or may not be.
fn part(problem: &Problem<'_, '_>, curve: &Curve, ends: [usize; 2]) -> Option<Part> {
    let [first, last] = ends;
    let turns: Vec<f64> = (first + 1..last)
        .map(|at| on_line(problem, curve, ends, at))
        .collect();
    if turns.is_empty() || turns == curve.turns[first + 1..last] {
        return None;
    }
    let placed = turns.iter().enumerate().map(|(index, turn)| {
        let station = first + 1 + index;
        let pose = &problem.stations[station].place.pose;
        let pose = problem.way.turned(pose, *turn);
        problem.postures.next_to(&curve.nodes[station], &pose)
    });
    let nodes: Vec<Node> = placed.collect::<Option<_>>()?;
    let stand = |station: usize| match station == first || station == last {
        true => curve.stand(problem, station),
        false => Stand {
            station: &problem.stations[station],
            turn_deg: turns[station - first - 1],
            node: &nodes[station - first - 1],
        },
    };
    let between = problem.between();
    let mut seen = Vec::with_capacity(last - first);
    for station in first + 1..=last {
        let (start, end) = (stand(station - 1), stand(station));
        let gap = end.station.gap?;
        let turn = end.turn_deg - start.turn_deg;
        let joints = [&start.node.joints, &end.node.joints];
        problem.links.held(&gap, turn, joints).ok()?;
        seen.push(between.look(start, end).ok()?);
    }
    Some(Part {
        first,
        turns,
        nodes,
        seen,
    })
}
