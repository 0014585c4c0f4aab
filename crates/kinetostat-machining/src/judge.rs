//! Does the question make sense, and does the answer? Figures beyond a limit refuse a program; those
//! that are merely odd become warnings.

use kinetostat::number::{largest, largest_length, length_setting, short};
use kinetostat::{Mechanism, MotionKind, Pose, Wrench};
use kinetostat_program::{Accounting, Corrected, Knowledge, WriteOptions};
use nalgebra::Vector3;

use crate::limits::{Beyond, Limits};
use crate::load::{CuttingLoad, LoadAxes, ProgramLoad};
use crate::near::natural_length;
use crate::own_weight::by_own_loads;
use crate::placement::Placement;
use crate::result::{
    MissedTolerance, PointKind, PointResult, RunResult, Summary, ToleranceVerdict,
};
use crate::run::{Task, kinds};
use crate::verdict::left_out;
use crate::warning::{Warning, WarningCode};

/// What the figures of a run are judged by.
#[derive(Clone, Debug, Default)]
pub struct Bounds {
    /// What refuses a program.
    pub limits: Limits,
    /// Largest force (N) or torque (N m) of every drive, in the order of the actuators; empty where
    /// no rating is known.
    pub ratings: Vec<Option<f64>>,
    /// The tools as they were given; empty where the platform's own point is the tool by construction.
    pub tools: Vec<ToolGiven>,
    /// Where the machine works without its tool: smallest and largest coordinates, base axes, m.
    pub workspace: Option<(Vector3<f64>, Vector3<f64>)>,
}

/// A tool as a question states it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolGiven {
    /// Its number, where the question numbers its tools.
    pub number: Option<u32>,
    /// Flange from tip, m.
    pub pose: Pose,
    /// Whether the question says anything of a tool.
    pub stated: bool,
}

impl ToolGiven {
    /// Along z of the flange where it points there, else the distance of the tip, mm.
    fn length_mm(&self) -> f64 {
        let tip = self.pose.translation.vector * 1e3;
        if tip.xy().norm() <= 1e-9 {
            tip.z
        } else {
            tip.norm()
        }
    }
}

/// Above this share of a limit a figure is allowed and odd.
const ODD: f64 = 0.5;

/// Softer tools than this are no machines that cut, N/mm.
const SOFT: f64 = 50.0;

/// Stiffer tools than this are no machines, N/mm.
const STIFF: f64 = 1e6;

/// A cutting load has a moment about the tip of at most its force by a large cutter's radius, m.
const LEVER: f64 = 0.3;

/// Shorter tools with their holder are odd, mm.
const SHORT_MM: f64 = 15.0;

/// Wider tolerances than this are not those of cutting, mm.
const WIDE_MM: f64 = 0.1;

/// Backward steps up to this are as long as corrections are, mm.
const LONG_STEP_MM: f64 = 1.0;

/// The largest wrench that the load law gives, in part axes (of a law that turns: at one heading).
fn of_law(cutting: CuttingLoad, placement: &Placement) -> Wrench {
    let part_from_base = placement
        .base_from_part
        .rotation
        .inverse()
        .to_rotation_matrix();
    match cutting {
        CuttingLoad::None => Wrench::zero(),
        CuttingLoad::Milling {
            radial,
            tangential,
            axial,
        } => Wrench::new(Vector3::new(tangential, -radial, axial), Vector3::zeros()),
        CuttingLoad::Constant { axes, wrench } => match axes {
            LoadAxes::Feed => wrench,
            LoadAxes::Base => wrench.rotated(&part_from_base),
            LoadAxes::Tool => wrench
                .rotated(&placement.tool_orientation.to_rotation_matrix())
                .rotated(&part_from_base),
        },
    }
}

fn numbered(tool: Option<u32>) -> String {
    tool.map_or_else(String::new, |number| format!("tool {number}"))
}

/// Every load of a question, and whose it is.
fn loads(task: &Task<'_>) -> Vec<(String, ProgramLoad)> {
    let of_tools = task.tools.iter();
    std::iter::once((String::new(), task.load))
        .chain(of_tools.map(|tool| (numbered(Some(tool.number)), tool.load)))
        .collect()
}

/// Collects figures beyond their limits.
struct Over<'l> {
    limits: &'l Limits,
    found: Vec<Beyond>,
}

impl Over<'_> {
    /// Notes a figure that is above its limit, or no number.
    fn above(&mut self, name: &str, found: f64, line: Option<usize>, place: String) {
        let Some(limit) = Limits::named(name) else {
            return;
        };
        let allowed = self.limits.get(limit);
        if found > allowed || found.is_nan() {
            self.found.push(Beyond {
                limit,
                found,
                allowed,
                line,
                place,
            });
        }
    }
}

impl Over<'_> {
    /// Notes the length of a tool, mm; one that is not there has none.
    fn tool(&mut self, length: f64, place: &str) {
        self.above("longest_tool_mm", length, None, place.to_owned());
        if length != 0.0 && length < self.limits.shortest_tool_mm {
            let limit = Limits::named("shortest_tool_mm");
            self.found.extend(limit.map(|limit| Beyond {
                limit,
                found: length,
                allowed: self.limits.shortest_tool_mm,
                line: None,
                place: place.to_owned(),
            }));
        }
    }
}

/// Figures of the question that are beyond their limits.
pub(crate) fn of_question(task: &Task<'_>) -> Vec<Beyond> {
    let limits = &task.bounds.limits;
    let mut over = Over {
        limits,
        found: Vec::new(),
    };
    for (whose, load) in loads(task) {
        let wrench = of_law(load.cutting, &task.placement);
        over.above("force_n", wrench.force().norm(), None, whose.clone());
        over.above("moment_n_m", wrench.moment().norm(), None, whose);
    }
    for tool in &task.bounds.tools {
        over.tool(tool.length_mm(), &numbered(tool.number));
    }
    over.found
}

/// What is odd about the length of a tool (mm, along z of the flange) where the machine stands at a place.
#[must_use]
pub fn odd_tool_length(mechanism: &Mechanism, length_mm: f64) -> Vec<Warning> {
    let limits = Limits::default();
    let mut over = Over {
        limits: &limits,
        found: Vec::new(),
    };
    over.tool(length_mm, "");
    let beyond = over.found.iter();
    let beyond = beyond.map(|b| Warning::new(WarningCode::OverLimit, b.in_words()));
    let odd = odd_length(mechanism, length_mm, &limits);
    beyond.chain(odd).collect()
}

/// The correction of a written program, and its rate of blocks, where they are beyond their limits.
/// Shared by programs corrected with a model and with a table.
#[must_use]
pub fn of_accounting(limits: &Limits, accounting: &Accounting) -> Vec<Beyond> {
    let mut over = Over {
        limits,
        found: Vec::new(),
    };
    over.above(
        "correction_mm",
        accounting.largest_correction_mm,
        accounting.largest_correction_line,
        String::new(),
    );
    // A program of a few blocks has no row over which a peak is taken: its mean is what is stated of it.
    let before = accounting
        .peak_blocks_per_second_in
        .or(accounting.mean_blocks_per_second_in)
        .unwrap_or(0.0);
    let rate = accounting
        .peak_blocks_per_second
        .or(accounting.mean_blocks_per_second);
    // A program that was that dense before is not made so.
    if let Some(rate) = rate.filter(|r| *r > 1.05 * before) {
        over.above(
            "blocks_per_second",
            rate,
            None,
            "widen the tolerances path_um and chord_um, or cut more slowly".to_owned(),
        );
    }
    over.found
}

/// The place where a figure is largest; places without a number count as the largest.
pub(crate) fn most(
    points: &[PointResult],
    figure: impl Fn(&PointResult) -> f64,
) -> Option<(f64, &PointResult)> {
    let key = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
    points
        .iter()
        .map(|p| (figure(p), p))
        .max_by(|a, b| key(a.0).total_cmp(&key(b.0)))
}

fn place(point: &PointResult) -> String {
    let [x, y, z] = point.position_mm;
    format!("at X{x:.2} Y{y:.2} Z{z:.2}")
}

fn length(v: &[f64; 3]) -> f64 {
    Vector3::from(*v).norm()
}

/// Share of its rating that a drive carries at a place, the largest of all drives.
fn share_of_rating(task: &Task<'_>, points: &[PointResult]) -> Option<(f64, usize, usize)> {
    let mut worst: Option<(f64, usize, usize)> = None;
    for (drive, rating) in task.bounds.ratings.iter().enumerate() {
        let Some(rating) = rating else { continue };
        let load = |p: &PointResult| p.actuator_force.get(drive).map_or(0.0, |f| f.abs());
        if let Some((force, at)) = most(points, load) {
            let share = force / rating;
            if worst.is_none_or(|(largest, ..)| share > largest || share.is_nan()) {
                worst = Some((share, drive, at.line));
            }
        }
    }
    worst
}

/// The largest share of a rating; none where no rating is known.
pub(crate) fn largest_share_of_rating(task: &Task<'_>, points: &[PointResult]) -> Option<f64> {
    share_of_rating(task, points).map(|(share, ..)| share)
}

/// Figures of the answer that are beyond their limits.
pub(crate) fn of_points(task: &Task<'_>, points: &[PointResult]) -> Vec<Beyond> {
    let mut over = Over {
        limits: &task.bounds.limits,
        found: Vec::new(),
    };
    let mut largest = |name: &str, figure: &dyn Fn(&PointResult) -> f64| {
        if let Some((value, at)) = most(points, figure) {
            over.above(name, value, Some(at.line), place(at));
        }
    };
    largest("tilt_deg", &|p| p.residual_rotation_deg);
    largest("share_of_buckling", &|p| p.share_to_buckling.unwrap_or(0.0));
    if let Some((share, drive, line)) = share_of_rating(task, points) {
        let name = task.mechanism.actuator_names().get(drive).cloned();
        let rating = task.bounds.ratings.get(drive).copied().flatten();
        let unit = match kinds(task.mechanism).nth(drive) {
            Some(MotionKind::Prismatic) => "N",
            _ => "N m",
        };
        let place = format!(
            "drive {}, {} of {} {unit}",
            name.unwrap_or_default(),
            short(share * rating.unwrap_or(f64::NAN)),
            short(rating.unwrap_or(f64::NAN)),
        );
        over.above("share_of_rating", share, Some(line), place);
    }
    corrections(&mut over, task, points);
    over.found
}

/// Points at which the part of own weight is asked for, where a correction is large.
const ASKED: usize = 4096;

/// The correction at a point or, of an analysis, what it would have to make up for, mm.
fn to_make_up(point: &PointResult) -> f64 {
    length(&point.correction_mm).max(length(&point.error_before_mm))
}

/// The same without what is due to the machine's own weight.
fn besides(point: &PointResult, own: &Vector3<f64>) -> f64 {
    let correction = Vector3::from(point.correction_mm);
    // A correction is against what it makes up for; an analysis has none.
    let corrected = match correction == Vector3::zeros() {
        true => 0.0,
        false => (correction + own).norm(),
    };
    corrected.max((Vector3::from(point.error_before_mm) - own).norm())
}

/// Corrections beyond their limit, that by own weight and that by the rest each by its own. Limits are
/// millimetres of the machine, results those of a program that may be scaled in it.
fn corrections(over: &mut Over<'_>, task: &Task<'_>, points: &[PointResult]) {
    let limits = over.limits;
    let scale = task.placement.scale;
    let least = limits.correction_mm.min(limits.own_weight_mm) / scale;
    // What is no number is beyond every limit.
    let large: Vec<&PointResult> = points
        .iter()
        .filter(|p| !matches!(to_make_up(p).partial_cmp(&least), Some(order) if order.is_le()))
        .collect();
    let mut asked: Vec<&PointResult> = large
        .iter()
        .step_by(large.len().div_ceil(ASKED).max(1))
        .copied()
        .collect();
    asked.extend(
        most(points, to_make_up)
            .map(|(_, at)| at)
            .filter(|_| !large.is_empty()),
    );
    let own = by_own_loads(task, &asked);
    let mut worst: [Option<(f64, &PointResult)>; 2] = [None, None];
    let mut note = |kind: usize, value: f64, at| {
        let key = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
        if worst[kind].is_none_or(|(most, _)| key(value) > key(most)) {
            worst[kind] = Some((value, at));
        }
    };
    for (point, own) in asked.into_iter().zip(own) {
        let own = own.unwrap_or_default();
        note(0, scale * besides(point, &own), point);
        note(1, scale * own.norm(), point);
    }
    for (name, found) in ["correction_mm", "own_weight_mm"].into_iter().zip(worst) {
        if let Some((value, at)) = found {
            over.above(name, value, Some(at.line), place(at));
        }
    }
}

/// How far own weight and loads of the model put the tool off by themselves, mm, the largest of
/// [`RunResult::MAX_POSTURES`] points.
pub(crate) fn largest_by_own_weight(task: &Task<'_>, points: &[&PointResult]) -> Option<f64> {
    let mut machines = points.iter().map(|p| task.mechanism_on(p.line));
    if !machines.any(Mechanism::has_own_loads) {
        return None;
    }
    let stride = points.len().div_ceil(RunResult::MAX_POSTURES).max(1);
    let some: Vec<&PointResult> = points.iter().step_by(stride).copied().collect();
    let own = by_own_loads(task, &some);
    let sizes = own.into_iter().flatten().map(|shift| shift.norm());
    sizes.max_by(f64::total_cmp)
}

/// A load of one place or of a map that is beyond the usual limits: an analysis warns where a program would be
/// refused.
#[must_use]
pub fn large_load(wrench: &Wrench) -> Vec<Warning> {
    let limits = Limits::default();
    let mut over = Over {
        limits: &limits,
        found: Vec::new(),
    };
    over.above("force_n", wrench.force().norm(), None, String::new());
    over.above("moment_n_m", wrench.moment().norm(), None, String::new());
    // No limit is moved where no program is written.
    over.found
        .iter()
        .map(|beyond| Warning::new(WarningCode::OverLimit, beyond.in_words()))
        .collect()
}

/// What was found beyond a limit, where nothing is refused.
pub(crate) fn as_warning(beyond: &Beyond) -> Warning {
    // The line is said once, by the warning itself.
    let of_line = Beyond {
        line: None,
        ..beyond.clone()
    };
    Warning {
        line: beyond.line,
        ..Warning::new(WarningCode::OverLimit, of_line.to_string())
    }
}

/// Corrections that are allowed and odd; for tables as for models.
#[must_use]
pub fn odd_correction(
    limits: &Limits,
    largest_mm: f64,
    line: Option<usize>,
    tolerance_mm: f64,
) -> Option<Warning> {
    let warning = if largest_mm > ODD * limits.correction_mm {
        Warning::new(
            WarningCode::LargeCorrection,
            format!(
                "corrections of up to {} are large: check units and signs of load and stiffnesses, or of the table",
                largest_length(largest_mm)
            ),
        )
    } else if largest_mm <= tolerance_mm {
        Warning::new(
            WarningCode::SmallCorrection,
            format!(
                "the largest correction, {}, is not more than the tolerance, {}: there is nothing to correct; check units, load and placement",
                largest_length(largest_mm),
                length_setting(tolerance_mm)
            ),
        )
    } else {
        return None;
    };
    Some(Warning { line, ..warning })
}

/// Tolerances that are allowed and odd.
#[must_use]
pub fn odd_tolerances(writing: &WriteOptions) -> Vec<Warning> {
    let wide = [
        ("path", writing.tolerance_mm),
        ("chord", writing.chord_tolerance_mm),
    ];
    let wide = wide.into_iter().filter(|(_, mm)| *mm > WIDE_MM);
    let wide = wide.map(|(name, mm)| {
        format!(
            "the {name} tolerance is {} mm: machines that cut are judged by hundredths; {name}_um is in micrometres",
            short(mm)
        )
    });
    let backward = writing.backward_step_mm;
    let long = (backward > LONG_STEP_MM).then(|| {
        format!(
            "steps that cut backwards are not warned of up to {} mm: at corners they are as long as the corrections; backward_step_um is in micrometres",
            short(backward)
        )
    });
    wide.chain(long)
        .map(|said| Warning::new(WarningCode::WideTolerance, said))
        .collect()
}

/// The merely odd: about the question and about its answer.
pub(crate) fn odd(
    task: &Task<'_>,
    points: &[PointResult],
    summary: &Summary,
    compensated: bool,
) -> Vec<Warning> {
    let mut list: Vec<Warning> = loads(task)
        .iter()
        .flat_map(|(whose, load)| odd_load(task, whose, load))
        .collect();
    list.extend(never_acts(task, points));
    list.extend(
        task.bounds
            .tools
            .iter()
            .filter_map(|tool| odd_tool(task, tool)),
    );
    list.extend(origin_in_metres(task.mechanism, &task.placement, task.path));
    list.extend(outside_workspace(task, points));
    let limits = &task.bounds.limits;
    if let Some((size, at)) = most(points, |p| length(&p.correction_mm)).filter(|_| compensated) {
        let tolerance = task.writing.tolerance_mm;
        let scale = task.placement.scale;
        // A large one is judged without the part of own weight.
        let size = match scale * size > ODD * limits.correction_mm {
            true => {
                let own = by_own_loads(task, &[at])
                    .pop()
                    .flatten()
                    .unwrap_or_default();
                besides(at, &own).max(2.0 * tolerance)
            }
            false => size,
        };
        list.extend(odd_correction(
            limits,
            scale * size,
            Some(at.line),
            scale * tolerance,
        ));
    }
    if compensated {
        list.extend(odd_tolerances(&task.writing));
    }
    let stiffness = summary.smallest_stiffness_n_per_mm;
    if summary.stable && !(SOFT..=STIFF).contains(&stiffness) {
        let which = if stiffness < SOFT {
            "softer"
        } else {
            "stiffer"
        };
        list.push(Warning::new(
            WarningCode::OddStiffness,
            format!(
                "the tool gives way with {} N/mm in its softest direction, {which} than machines that cut (arms 100 to 2000, parallel machines up to 100000 N/mm): check the units of the stiffnesses",
                short(stiffness)
            ),
        ));
    }
    let mut near = |name: &str, odd: f64, value: f64, text: &str| {
        let limit = Limits::named(name).map_or(f64::NAN, |l| limits.get(l));
        if value > odd * limit && value <= limit {
            list.push(Warning::new(
                WarningCode::NearLimit,
                format!(
                    "{text} {} of the {} that are allowed",
                    largest(value, ""),
                    short(limit)
                ),
            ));
        }
    };
    near(
        "tilt_deg",
        ODD,
        summary.max_residual_rotation_deg,
        "the tool is tilted, in degrees, by",
    );
    if let Some(share) = summary.largest_share_to_buckling {
        near(
            "share_of_buckling",
            0.4,
            share,
            "the share of the way to buckling is",
        );
    }
    if let Some(share) = summary.largest_share_of_rating {
        near(
            "share_of_rating",
            0.8,
            share,
            "a drive is loaded, as a share of its rating, by",
        );
    }
    list
}

fn odd_load(task: &Task<'_>, whose: &str, load: &ProgramLoad) -> Vec<Warning> {
    let mut list = Vec::new();
    let limits = &task.bounds.limits;
    let wrench = of_law(load.cutting, &task.placement);
    let (f, m) = (wrench.force(), wrench.moment());
    let (force, moment) = (f.norm(), m.norm());
    if force == 0.0 && moment == 0.0 {
        return list;
    }
    let mut warn = |code, text: String| {
        let text = match whose {
            "" => text,
            whose => format!("{whose}: {text}"),
        };
        list.push(Warning::new(code, text));
    };
    if force < 1.0 && moment < 0.01 {
        warn(
            WarningCode::SmallLoad,
            format!(
                "the load on the tool is only {} N and {} N m: cutting takes 10 to 1000 N; check the unit",
                short(force),
                short(moment)
            ),
        );
    }
    if force > ODD * limits.force_n && force <= limits.force_n {
        warn(
            WarningCode::LargeLoad,
            format!(
                "the force on the tool is {} N: robots mill with 50 to 1000 N; check the unit",
                short(force)
            ),
        );
    }
    if moment > ODD * limits.moment_n_m && moment <= limits.moment_n_m {
        warn(
            WarningCode::LargeLoad,
            format!(
                "the moment on the tool is {} N m: cutting torques are 0.1 to 100 N m; check the unit (N m, not N mm)",
                short(moment)
            ),
        );
    }
    if force > 0.0 && moment > LEVER * force {
        warn(
            WarningCode::LongLever,
            format!(
                "the moment on the tool, {} N m, is that of its force {} m away from the tip: check the unit (N m, not N mm)",
                short(moment),
                short(moment / force)
            ),
        );
    }
    // Even a helix of 45 degrees pulls no more along the axis than it pushes across.
    if f.z < 0.0 && -f.z > f.xy().norm() && -f.z >= 1.0 {
        warn(
            WarningCode::PullingForce,
            format!(
                "the force on the tool is {} N along -z of the program: it pulls the tool into the part, more than it pushes across; cutting pushes a tool back, along +z: check the sign",
                short(-f.z)
            ),
        );
    }
    list
}

/// A load that was asked for and is nowhere along the program.
fn never_acts(task: &Task<'_>, points: &[PointResult]) -> Option<Warning> {
    let asked = |(_, load): &(String, ProgramLoad)| {
        of_law(load.cutting, &task.placement).force().norm() > 0.0
    };
    let cuts = |p: &&PointResult| p.kind != PointKind::Rapid;
    let acts = |p: &PointResult| p.force_n.iter().any(|x| *x != 0.0);
    if !loads(task).iter().any(asked) || points.iter().filter(cuts).any(acts) {
        return None;
    }
    let why = match task.load.below_z_mm {
        Some(z) => format!("no feed move goes below Z {} mm", short(z)),
        None => "the program has no feed move on which it could act".to_owned(),
    };
    Some(Warning::new(
        WarningCode::LoadNeverActs,
        format!("the load never acts: {why}; only weights and deviations are corrected"),
    ))
}

fn odd_tool(task: &Task<'_>, tool: &ToolGiven) -> Option<Warning> {
    let length = tool.length_mm();
    if !tool.stated {
        return Some(Warning::new(
            WarningCode::NoTool,
            "no tool is given: the load acts on the platform's own point. Write --tool-length-mm or, under [tool], length_mm (0 where the model has the tool in it)",
        ));
    }
    odd_length(task.mechanism, length, &task.bounds.limits)
}

/// A tool within its limits that is short, or long beside the machine.
fn odd_length(mechanism: &Mechanism, length: f64, limits: &Limits) -> Option<Warning> {
    if length != 0.0 && length >= limits.shortest_tool_mm && length < SHORT_MM {
        return Some(Warning::new(
            WarningCode::OddTool,
            format!(
                "the tool is only {} mm long, from the flange to its tip: check the unit",
                short(length)
            ),
        ));
    }
    let machine = 1e3 * natural_length(mechanism);
    (length > 0.4 * machine && length <= limits.longest_tool_mm).then(|| {
        Warning::new(
            WarningCode::OddTool,
            format!(
                "the tool is {} mm long, on limbs of {} mm: check the unit",
                short(length),
                short(machine)
            ),
        )
    })
}

/// Origins of parts that are nearer than this to the origin of a large machine may be metres, mm.
const NEAR_MM: f64 = 10.0;

/// Nearer ones would be nearer than that in metres too, where no large machine works, mm.
const LEAST_MM: f64 = 0.05;

/// Machines of this size, working as far from the origin of their base, are large, m.
const LARGE_M: f64 = 0.3;

/// A place of the part that was most likely written in metres: some millimetres from the origin of the base,
/// so that the base of a large machine stands in the part.
#[must_use]
pub fn origin_in_metres(
    mechanism: &Mechanism,
    placement: &Placement,
    path: &kinetostat_program::Path,
) -> Option<Warning> {
    let origin = 1e3 * placement.base_from_part.translation.vector;
    let home = mechanism.platforms()[mechanism.tool()].home;
    // Machines whose base has its origin where they work have parts there.
    let away = home.translation.vector.norm().min(mechanism.size());
    if !(LEAST_MM..NEAR_MM).contains(&origin.amax()) || away <= LARGE_M {
        return None;
    }
    let places = path
        .moves
        .iter()
        .filter(|m| m.known != Knowledge::Nothing)
        .map(|m| 1e3 * placement.tool_pose(&m.end).translation.vector);
    let (low, high) = places
        .map(|p| (p, p))
        .reduce(|a, b| (a.0.inf(&b.0), a.1.sup(&b.1)))?;
    let inside = (0..3).all(|k| low[k] <= NEAR_MM && high[k] >= -NEAR_MM);
    inside.then(|| {
        let [x, y, z] = [0, 1, 2].map(|k| short(origin[k]));
        Warning::new(
            WarningCode::OddPlacement,
            format!(
                "the program's zero lies at ({x}, {y}, {z}) mm, so that the machine's base stands in the part: check the unit of part_origin_mm (millimetres, not metres)"
            ),
        )
    })
}

fn outside_workspace(task: &Task<'_>, points: &[PointResult]) -> Option<Warning> {
    let (low, high) = task.bounds.workspace?;
    // With several tools the flange is not one.
    let flange = match task.bounds.tools.as_slice() {
        [] => Pose::identity(),
        [tool] => tool.pose.inverse(),
        _ => return None,
    };
    let slack = 1e-3;
    let outside = |p: &&PointResult| {
        let at = (task.placement.tool_pose(&p.position_mm.into()) * flange)
            .translation
            .vector;
        (0..3).any(|k| at[k] < low[k] - slack || at[k] > high[k] + slack)
    };
    let first = points
        .iter()
        .filter(|p| p.kind != PointKind::Rapid)
        .find(outside)?;
    Some(Warning::at_line(
        WarningCode::OutsideWorkspace,
        first.line,
        format!(
            "{} the flange leaves the workspace that the model states: check where the part lies and the tool's length",
            place(first)
        ),
    ))
}

/// How the written program stands to its tolerance, and where and why it misses it.
pub(crate) fn tolerance(
    result: &RunResult,
    points: &[PointResult],
    written: Option<&Corrected>,
) -> ToleranceVerdict {
    let allowed_mm = result.allowed_mm();
    let held = result.holds_tolerance();
    let error = |p: &PointResult| length(&p.error_after_mm);
    let worst = points
        .iter()
        .filter(|p| p.kind != PointKind::Rapid)
        .max_by(|a, b| error(a).total_cmp(&error(b)))
        .filter(|_| held == Some(false));
    let missed = worst.zip(written).map(|(p, written)| {
        let a = &written.accounting;
        let reason = if a.left_out_mm > 0.5 * error(p) {
            left_out(a)
        } else if p.kind == PointKind::Corner {
            "the tool stands at a corner while the load turns, and the correction is written for its ends; round the corner, or reduce the load".to_owned()
        } else if length(&p.correction_mm) == 0.0 {
            "this block is carried over as it was: it comes before all axes are stated, or is of a kind that is not corrected".to_owned()
        } else if a.largest_jump_taken_up_mm > 0.5 * error(p) {
            format!(
                "a jump of the correction of {} got no step of its own; tighten the tolerance",
                largest_length(a.largest_jump_taken_up_mm)
            )
        } else {
            "the correction bends more between the ends of the written pieces than was expected, also where they were divided again; tighten the tolerance of the path".to_owned()
        };
        MissedTolerance {
            line: p.line,
            output_line: p.output_line,
            position_mm: p.position_mm,
            error_mm: error(p),
            reason,
        }
    });
    ToleranceVerdict {
        allowed_mm,
        held,
        missed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A program of a few blocks has no row of sixteen; its limit holds all the same.
    #[test]
    fn the_rate_of_a_short_program_has_its_limit() {
        let limits = Limits {
            blocks_per_second: 0.3,
            ..Limits::default()
        };
        for (peak, mean, before, refused) in [
            (None, Some(0.5), None, true),
            (None, Some(0.5), Some(0.1), true),
            (None, Some(0.5), Some(0.49), false),
            (None, Some(0.2), None, false),
            (None, None, None, false),
            (Some(0.5), Some(0.1), None, true),
            (Some(0.2), Some(0.1), None, false),
        ] {
            let accounting = Accounting {
                peak_blocks_per_second: peak,
                mean_blocks_per_second: mean,
                mean_blocks_per_second_in: before,
                ..Accounting::default()
            };
            let found = of_accounting(&limits, &accounting);
            assert_eq!(!found.is_empty(), refused, "{peak:?} {mean:?} {before:?}");
        }
    }

    #[test]
    fn a_load_of_a_place_is_large_where_that_of_a_program_is_refused() {
        let limits = Limits::default();
        let count = |force: f64, moment: f64| {
            let wrench = Wrench::new(Vector3::z() * force, Vector3::x() * moment);
            large_load(&wrench).len()
        };
        assert_eq!(count(limits.force_n, limits.moment_n_m), 0);
        assert_eq!(count(-1.001 * limits.force_n, 0.0), 1);
        assert_eq!(count(1e300, -1.001 * limits.moment_n_m), 2);
    }

    /// A largest figure is never stated too small, and a length has a smallest figure as everywhere.
    #[test]
    fn an_odd_correction_has_the_digits_of_the_table() {
        let limits = Limits::default();
        for (mm, said) in [
            (1.0204, "up to 1.03 mm are large"),
            (0.000_301, "correction, 0.301 um, is"),
            (5.31e-8, "correction, 0.001 um, is"),
        ] {
            let found = odd_correction(&limits, mm, None, 0.0005).map(|w| w.message);
            let found = found.unwrap_or_default();
            assert!(found.contains(said), "{found}");
            assert!(found.contains(&largest_length(mm)), "{found}");
        }
    }
}
