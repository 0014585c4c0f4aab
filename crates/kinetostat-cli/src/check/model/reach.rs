//! How far the tool gets: an arm's reach by search over its joints, a parallel machine's box by
//! inverse kinematics around home.

use kinetostat::{Element, Limb, Mechanism, MotionKind, Pose, Posture, Role};
use kinetostat_machining::natural_length;
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use rayon::prelude::*;
use serde::Serialize;

use crate::ui::layout::item;
use crate::ui::numbers::{number, short, triple};

/// Reach of a machine.
#[derive(Serialize)]
pub(crate) struct ReachFinding {
    /// Farthest the tool's reference point gets from the base's origin, mm: of an arm, and of a machine
    /// that moves only while its tool turns.
    pub(crate) from_base_mm: Option<f64>,
    /// Of an arm whose first actuator turns: farthest it gets from that axis, mm.
    pub(crate) from_first_axis_mm: Option<f64>,
    /// The tool turns on these ways as the machine turns it, kept as near to its orientation at home as can be.
    pub(crate) orientation_follows: bool,
    /// Else: how far it gets from home along -x, +x, -y, +y, -z, +z of the base, mm; the tool does not turn
    /// where the machine can move it so.
    pub(crate) along_axes_mm: Option<[[f64; 2]; 3]>,
    /// What ends these ways: an actuator at its limit, or the limbs themselves.
    pub(crate) ends: Option<[[String; 2]; 3]>,
    /// A box around home of which corners, edges and faces were reached, mm.
    pub(crate) box_mm: Option<[[f64; 3]; 2]>,
    /// Of a machine that moves only while its tool turns: smallest and largest coordinates of the
    /// tool's reference point, mm.
    pub(crate) positions_span_mm: Option<[[f64; 3]; 2]>,
    /// How all this was found.
    pub(crate) how: String,
}

impl ReachFinding {
    fn none(how: impl Into<String>) -> Self {
        Self {
            from_base_mm: None,
            from_first_axis_mm: None,
            orientation_follows: false,
            along_axes_mm: None,
            ends: None,
            box_mm: None,
            positions_span_mm: None,
            how: how.into(),
        }
    }
}

/// Reach of a machine from its posture at home.
pub(crate) fn reach(home: &Posture<'_>) -> ReachFinding {
    let m = home.mechanism();
    match m.limbs() {
        [limb] if m.platforms().len() == 2 => of_arm(m, limb),
        limbs if limbs.len() > MOST_LIMBS => ReachFinding::none(format!(
            "not searched: the machine has more than {MOST_LIMBS} limbs"
        )),
        _ => around_home(home),
    }
}

/// Machines of more limbs take too long.
const MOST_LIMBS: usize = 24;

/// A joint of an arm and its range, m or rad.
struct Joint {
    /// A command, or else a passive coordinate.
    command: bool,
    index: usize,
    range: (f64, f64),
}

/// Pose of the tool for commands and coordinates, or of the first commanded motion.
fn product(m: &Mechanism, limb: &Limb, commands: &[f64], coordinates: &[f64], whole: bool) -> Pose {
    let mut pose = m.platforms()[limb.from].home;
    for element in limb.nominal.elements() {
        match element {
            Element::Rigid(offset) => pose *= offset,
            Element::Motion(motion) => {
                if !whole && motion.command.is_some() {
                    return pose;
                }
                let part = |drive: Option<kinetostat::Drive>, values: &[f64]| {
                    drive.map_or(0.0, |d| d.ratio * values[d.index])
                };
                let amount = part(motion.command, commands) + part(motion.coordinate, coordinates);
                match motion.kind {
                    MotionKind::Prismatic => {
                        pose *= Translation3::from(motion.axis.into_inner() * amount);
                    }
                    MotionKind::Revolute => {
                        pose *= UnitQuaternion::from_axis_angle(&motion.axis, amount);
                    }
                }
            }
            Element::Node(_) => {}
        }
    }
    pose * limb.platform_from_tip.inverse()
}

fn of_arm(m: &Mechanism, limb: &Limb) -> ReachFinding {
    let chain = &limb.nominal;
    let turn = std::f64::consts::PI;
    let mut joints = Vec::new();
    for (index, actuator) in chain.actuators().iter().enumerate() {
        let range = match (actuator.limits, actuator.kind) {
            (Some(limits), _) => limits,
            (None, MotionKind::Revolute) => (actuator.home - turn, actuator.home + turn),
            (None, MotionKind::Prismatic) => {
                return ReachFinding::none(format!(
                    "not bounded: the actuator '{}' slides without limits",
                    actuator.name
                ));
            }
        };
        joints.push(Joint {
            command: true,
            index,
            range,
        });
    }
    for (index, c) in chain.coordinates().iter().enumerate() {
        match (c.role, c.kind) {
            (Role::Passive, MotionKind::Revolute) => joints.push(Joint {
                command: false,
                index,
                range: (c.home - turn, c.home + turn),
            }),
            (Role::Passive, MotionKind::Prismatic) => {
                return ReachFinding::none(format!(
                    "not bounded: the passive joint '{}' slides without limits",
                    c.name
                ));
            }
            _ => {}
        }
    }
    let point = |commands: &[f64], coordinates: &[f64]| {
        product(m, limb, commands, coordinates, true)
            .translation
            .vector
    };
    let (from_base, starts) = farthest(limb, &joints, &|u, q| point(u, q).norm());
    let first = chain.elements().iter().find_map(|e| match e {
        // Springs of a link before the first axis are no axis.
        Element::Motion(motion)
            if motion.command.is_some()
                || motion
                    .coordinate
                    .is_some_and(|d| chain.coordinates()[d.index].role == Role::Passive) =>
        {
            Some(motion)
        }
        _ => None,
    });
    let axis = first
        .filter(|motion| motion.command.is_some() && motion.kind == MotionKind::Revolute)
        .map(|motion| {
            let frame = product(
                m,
                limb,
                &chain.home_commands(),
                &chain.home_coordinates(),
                false,
            );
            (frame.translation.vector, frame.rotation * motion.axis)
        });
    let from_axis = axis.map(|(origin, axis)| {
        farthest(limb, &joints, &|u, q| {
            let arm = point(u, q) - origin;
            (arm - axis.into_inner() * arm.dot(&axis)).norm()
        })
        .0
    });
    let passive = joints.iter().any(|j| !j.command);
    ReachFinding {
        from_base_mm: Some(1e3 * from_base),
        from_first_axis_mm: from_axis.map(|r| 1e3 * r),
        how: format!(
            "the largest distance found by a search over the ranges of {}, from {starts} start{}; collisions are not looked at",
            if passive {
                "all joints, the passive ones too"
            } else {
                "its actuators"
            },
            if starts == 1 { "" } else { "s" }
        ),
        ..ReachFinding::none("")
    }
}

/// Starts of the search.
const STARTS: usize = 16;

/// Most elements that one search walks over: an arm of six joints needs far less, a chain of ninety
/// is not searched from all starts.
const MOST_STEPS: usize = 25_000_000;

/// Largest value over the joints' ranges: one joint after the other, from evenly spread starts; and
/// the number of starts.
fn farthest(limb: &Limb, joints: &[Joint], value: &dyn Fn(&[f64], &[f64]) -> f64) -> (f64, usize) {
    let chain = &limb.nominal;
    let mut best = 0.0_f64;
    let sweep = joints.len() * VALUES * chain.elements().len();
    let mut steps = 0;
    for start in 0..STARTS {
        if start > 0 && steps > MOST_STEPS {
            return (best, start);
        }
        let mut commands = chain.home_commands();
        let mut coordinates = chain.home_coordinates();
        let at = |joint: &Joint, x: f64, commands: &mut [f64], coordinates: &mut [f64]| {
            if joint.command {
                commands[joint.index] = x;
            } else {
                coordinates[joint.index] = x;
            }
            value(commands, coordinates)
        };
        if start > 0 {
            for (k, joint) in joints.iter().enumerate() {
                let share = ((start * (2 * k + 3)) as f64 * 0.618_034 + 0.1 * k as f64).fract();
                let (low, high) = joint.range;
                at(
                    joint,
                    low + share * (high - low),
                    &mut commands,
                    &mut coordinates,
                );
            }
        }
        let mut reached = value(&commands, &coordinates);
        for _ in 0..30 {
            let before = reached;
            steps += sweep;
            for joint in joints {
                let here = if joint.command {
                    commands[joint.index]
                } else {
                    coordinates[joint.index]
                };
                let mut f = |x: f64| at(joint, x, &mut commands, &mut coordinates);
                let found = along(joint.range, here, &mut f);
                reached = f(found);
            }
            if reached <= before * (1.0 + 1e-10) || steps > MOST_STEPS {
                break;
            }
        }
        best = best.max(reached);
    }
    (best, STARTS)
}

/// Values that one joint's turn takes, about.
const VALUES: usize = 98;

/// Where a smooth function is largest in a range: samples, then thirds around the best of them.
fn along((low, high): (f64, f64), here: f64, f: &mut dyn FnMut(f64) -> f64) -> f64 {
    const SAMPLES: usize = 12;
    let step = (high - low) / SAMPLES as f64;
    let mut best = (here, f(here));
    for k in 0..=SAMPLES {
        let x = low + step * k as f64;
        let value = f(x);
        if value > best.1 {
            best = (x, value);
        }
    }
    let (mut a, mut b) = ((best.0 - step).max(low), (best.0 + step).min(high));
    for _ in 0..40 {
        let (c, d) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        if f(c) < f(d) { a = c } else { b = d }
    }
    for x in [0.5 * (a + b), a, b] {
        let value = f(x);
        if value > best.1 {
            best = (x, value);
        }
    }
    best.0
}

/// How far the tool gets along the base's axes, and a box that it fills.
fn around_home(home: &Posture<'_>) -> ReachFinding {
    if let Some((name, _, _)) = home.limit_violations().first() {
        return ReachFinding::none(format!(
            "not searched: at home the actuator '{name}' is outside its limits"
        ));
    }
    let m = home.mechanism();
    let length = natural_length(m);
    let follows = m.turns_as_it_moves();
    let mut along = [[0.0; 2]; 3];
    let mut ends = <[[String; 2]; 3]>::default();
    let way = |way: usize| {
        let mut direction = Vector3::zeros();
        direction[way / 2] = if way.is_multiple_of(2) { -1.0 } else { 1.0 };
        march(home, follows, &direction, length)
    };
    let (ways, free) = rayon::join(
        || (0..6).into_par_iter().map(way).collect::<Vec<_>>(),
        || follows.then(|| crate::check::model::reach_commands::search(m).ok()),
    );
    let free = free.flatten();
    for (way, (far, end)) in ways.into_iter().enumerate() {
        along[way / 2][way % 2] = 1e3 * far;
        ends[way / 2][way % 2] = end;
    }
    let unlimited = || {
        let mut actuators = m.limbs().iter().flat_map(|l| l.nominal.actuators());
        actuators.all(|a| a.limits.is_none())
    };
    if ends.iter().flatten().any(|end| end == UNBOUNDED) && unlimited() {
        return ReachFinding::none(
            "not bounded: the actuators have no limits; write limits_mm or limits_deg",
        );
    }
    let filled = filled(home, follows, &along);
    let mm = |v: Vector3<f64>| <[f64; 3]>::from(v * 1e3);
    ReachFinding {
        from_base_mm: free.as_ref().map(|f| 1e3 * f.from_base),
        positions_span_mm: free.as_ref().map(|f| f.span.map(mm)),
        along_axes_mm: Some(along),
        ends: Some(ends),
        box_mm: filled,
        orientation_follows: follows,
        how: format!(
            "by inverse kinematics from home within the limits of the actuators, the tool {}; collisions and limits of passive joints are not looked at",
            if follows {
                "turning as the machine turns it"
            } else {
                "not turning"
            }
        ),
        ..ReachFinding::none("")
    }
}

/// What ends a way that is longer than ten times the machine.
const UNBOUNDED: &str = "nothing: it was not followed farther";

/// The posture at a place near another one, or what forbids it.
fn at<'m>(
    from: &Posture<'m>,
    follows: bool,
    shift: &Vector3<f64>,
    home: &Pose,
) -> Result<Posture<'m>, String> {
    let mut target = *home;
    target.translation.vector += shift;
    let (m, place) = (from.mechanism(), &target.translation.vector);
    let posture = match follows {
        true => m.posture_following_straight(place, &home.rotation, from),
        false => m.posture_near(&target, from),
    };
    let posture = posture.map_err(|_| "the limbs cannot follow".to_owned())?;
    match posture.limit_violations().first() {
        Some((name, _, _)) => Err(format!("limit of '{name}'")),
        None => Ok(posture),
    }
}

/// How far (m) along a direction, and what ends it.
fn march(
    home: &Posture<'_>,
    follows: bool,
    direction: &Vector3<f64>,
    length: f64,
) -> (f64, String) {
    let origin = *home.target();
    let mut last = home.clone();
    let (mut good, mut step) = (0.0, 0.02 * length);
    let (mut bad, mut end) = loop {
        let next = good + step;
        match at(&last, follows, &(direction * next), &origin) {
            Ok(posture) => {
                last = posture;
                good = next;
                step *= 1.3;
            }
            Err(reason) => break (next, reason),
        }
        if good > 10.0 * length {
            return (good, UNBOUNDED.to_owned());
        }
    };
    // A place that follows costs many times as much as one with its orientation held.
    for _ in 0..if follows { 10 } else { 14 } {
        let middle = 0.5 * (good + bad);
        match at(&last, follows, &(direction * middle), &origin) {
            Ok(posture) => {
                last = posture;
                good = middle;
            }
            Err(reason) => (bad, end) = (middle, reason),
        }
    }
    if good < 1e-4 * length {
        return (0.0, "the machine does not move this way".to_owned());
    }
    (good, end)
}

/// The largest of some boxes of the proportions of `along` (mm) whose corners, edges and faces can
/// be reached; none if even a small one has gaps.
fn filled(home: &Posture<'_>, follows: bool, along: &[[f64; 2]; 3]) -> Option<[[f64; 3]; 2]> {
    if along.iter().flatten().all(|x| *x == 0.0) {
        return None;
    }
    let origin = *home.target();
    let reached = |scale: f64| {
        let mut shifts: Vec<Vector3<f64>> = Vec::new();
        for code in 0..27_usize {
            let part = |axis: usize| match (code / 3_usize.pow(axis as u32)) % 3 {
                0 => -along[axis][0],
                1 => 0.0,
                _ => along[axis][1],
            };
            let shift = Vector3::new(part(0), part(1), part(2)) * (1e-3 * scale);
            if shift.norm() > 0.0 && !shifts.contains(&shift) {
                shifts.push(shift);
            }
        }
        // In steps, so that every limb stays in its own way of assembly.
        shifts.par_iter().all(|shift| {
            let mut last = home.clone();
            [0.35, 0.7, 1.0].into_iter().all(|share| {
                let next = at(&last, follows, &(shift * share), &origin);
                next.map(|posture| last = posture).is_ok()
            })
        })
    };
    let (mut good, mut bad) = (0.0, 1.0);
    if reached(1.0) {
        good = 1.0;
    }
    for _ in 0..if follows { 5 } else { 7 } {
        if good >= 1.0 {
            break;
        }
        let middle = 0.5 * (good + bad);
        if reached(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    let centre = Point3::from(origin.translation.vector * 1e3);
    (good > 0.0).then(|| {
        let corner = |side: usize, sign: f64| -> [f64; 3] {
            std::array::from_fn(|k| centre[k] + sign * good * along[k][side])
        };
        [corner(0, -1.0), corner(1, 1.0)]
    })
}

/// The reach in words.
pub(crate) fn in_words(reach: &ReachFinding) -> String {
    let mut out = String::new();
    let rounded = |x: f64| short((10.0 * x).round() / 10.0);
    if let (Some(far), None) = (reach.from_base_mm, reach.along_axes_mm) {
        let axis = reach.from_first_axis_mm.map_or_else(String::new, |r| {
            format!(", and up to {} mm from its first axis", rounded(r))
        });
        out.push_str(&item(&format!(
            "reach: the tool gets up to {} mm from the base's origin{axis} ({})",
            rounded(far),
            reach.how
        )));
        return out;
    }
    let Some(along) = &reach.along_axes_mm else {
        return item(&format!("reach: {}", reach.how));
    };
    let ways: Vec<String> = ["x", "y", "z"]
        .iter()
        .zip(along)
        .map(|(name, [back, ahead])| match (*back, *ahead) {
            (0.0, 0.0) => format!("{name} none"),
            _ => format!("{name} -{} .. +{}", number(*back, 4), number(*ahead, 4)),
        })
        .collect();
    let turning = if reach.orientation_follows {
        ", the tool turning as the machine turns it"
    } else {
        ""
    };
    let mut text = format!("reach from home{turning}, mm: {}", ways.join(", "));
    if let Some([low, high]) = reach.box_mm {
        text.push_str(&format!(
            "; the largest box of these proportions that it fills is from {} to {} mm",
            triple(low, rounded),
            triple(high, rounded)
        ));
    }
    out.push_str(&item(&text));
    let mut reasons: Vec<&str> = Vec::new();
    for end in reach.ends.iter().flatten().flatten() {
        if !reasons.contains(&end.as_str()) && !end.starts_with("the machine ") {
            reasons.push(end);
        }
    }
    let limits = reasons.iter().filter(|r| r.starts_with("limit of")).count();
    let what = if limits > 2 {
        let others: Vec<&str> = reasons
            .iter()
            .filter(|r| !r.starts_with("limit of"))
            .copied()
            .collect();
        let mut list = vec!["limits of actuators"];
        list.extend(others);
        list.join(", or ")
    } else {
        reasons.join(", or ")
    };
    let end = match what.as_str() {
        "" => String::new(),
        what => format!("; what ends it: {what}"),
    };
    out.push_str(&item(&format!("found {}{end}", reach.how)));
    if let (Some(far), Some([low, high])) = (reach.from_base_mm, reach.positions_span_mm) {
        out.push_str(&item(&format!(
            "reach by all its ways: up to {} mm from the base's origin; its positions lie between {} and {} mm (the farthest found by a search over the ranges of the actuators)",
            rounded(far),
            triple(low, rounded),
            triple(high, rounded)
        )));
    }
    out
}
