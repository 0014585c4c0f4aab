//! The whole way: from a path to files that were read again.

use std::collections::VecDeque;

use kinetostat_program::{Path, SpindleRotation};
use nalgebra::Vector3;

use crate::making::compare::{Kept, compare, read_again};
use crate::making::course::Course;
use crate::making::events::{Coolant, EventAction, SourceEvent};
use crate::making::limits::MakeLanguage;
use crate::making::names::{checked, coordinates, fixed, parts_checked, short};
use crate::making::plan::plan;
use crate::making::stated::of_frames;
use crate::making::step::{MadeMotion, Step, Way, parts};
use crate::making::template::{Rapids, Template};
use crate::making::{MakeError, MakeFinding, csv, gcode, krl, ls, rapid, stated};

/// A made program.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Made {
    /// Names and bytes; the first is the main program.
    pub files: Vec<(String, Vec<u8>)>,
    /// Differences from the source, and assumptions; those without a line at the end.
    pub findings: Vec<MakeFinding>,
    /// Deviation from the path, measured on the program as its own reader reads it.
    pub kept: Kept,
    /// Line of each motion, counted through all files in order, and the line of its source.
    pub lines: Vec<[usize; 2]>,
    /// Move of the path for each motion, and the fractions of its length at which the motion starts and ends. The motion to the initial joint values
    /// has none: it takes the start of the first of the others, `[0.0, 0.0]`.
    pub parts: Vec<(usize, [f64; 2])>,
    /// The first motion to a pose states how the arm reaches it: as the template says, or as the source does in the same language.
    pub states_configuration: bool,
    /// The first start of the spindle in the source that is a note alone: the program does not start it.
    pub spindle_not_started: Option<String>,
}

/// Rapids below this are a speed in another unit, mm/s.
const SLOWEST_RAPID_MM_PER_S: f64 = 1.0;

/// Header text of made programs.
const MADE_BY: &str = "made by kinetostat convert";

/// A program in another language that goes along a path.
///
/// Lines stay lines and arcs stay arcs where the language has them; helices, and what the controller takes for no circle, are
/// followed by lines within [`Template::tolerance_mm`]. The first motion is a joint motion to its end: where the arm is before,
/// nobody knows. Events of the source become notes, pauses that both sides have stay. What was made is read again by the
/// reader of its language and compared with the path: [`Made::kept`].
///
/// ```
/// use kinetostat_formats::*;
/// use kinetostat_program::{Program, ReadOptions as Reading, interpret};
/// use nalgebra::{UnitQuaternion, Vector3};
///
/// let program = Program::read("G21 G90\nS8000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG3 X10 Y10 I0 J10\n")?;
/// let path = interpret(&program, &Reading::default())?;
/// let mut template = Template::default();
/// template.tool_orientation = Some(UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI));
/// let made = make(&path, &events_of_gcode(&program, &path), &template, MakeLanguage::Krl).unwrap();
/// let text = String::from_utf8(made.files[0].1.clone())?;
/// assert!(text.contains("; line 2: S8000 M3\nPTP {X 0.000000,Y 0.000000,Z 5.000000,A 0.00000000,B 0.00000000,C 180.00000000}\n"));
/// assert!(text.contains("$VEL.CP=0.005\n$APO.CDIS=0.3\nLIN {X 0.000000,Y 0.000000,Z -1.000000,"));
/// assert!(text.contains("CIRC {X 7.071068,Y 2.928932,"));
/// assert!(made.kept.position_mm < 1e-6 && made.kept.orientation_rad < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// All that cannot be written, in the order of lines of the source; nothing is made then.
pub fn make(
    path: &Path,
    events: &[SourceEvent],
    template: &Template,
    language: MakeLanguage,
) -> Result<Made, Vec<MakeError>> {
    make_along(path, &Course::of_lines(path, events), template, language)
}

/// Speeds of which the decimals of the template leave nothing.
fn speeds_lost(steps: &[Step], template: &Template, language: MakeLanguage) -> Vec<MakeError> {
    let of_arms = matches!(language, MakeLanguage::Krl | MakeLanguage::Rapid);
    let Some(decimals) = template.speed_decimals.filter(|_| of_arms) else {
        return Vec::new();
    };
    let least = 0.5 * 10_f64.powi(-(decimals as i32));
    let motions = steps.iter().filter_map(Step::motion);
    let lost = motions.filter(|motion| motion.speed_mm_per_s <= least);
    lost.map(|motion| {
        MakeError::at(
            motion.line,
            format!(
                "with {decimals} decimals its speed of {} mm/s would be 0",
                short(motion.speed_mm_per_s, 9)
            ),
            "state more speed_decimals (of mm/s) in the template",
        )
    })
    .collect()
}

/// Makes a program with events, moves and tool changes in the order of a course.
pub(crate) fn make_along(
    path: &Path,
    course: &Course,
    template: &Template,
    language: MakeLanguage,
) -> Result<Made, Vec<MakeError>> {
    let mut faults = stated::faults(template, language);
    let name = checked(&template.program_name, language).map_err(|fault| faults.push(fault));
    let planned = match plan(path, course, template, language) {
        Ok(planned) => Some(planned),
        Err(further) => {
            faults.extend(further);
            None
        }
    };
    if let (Some(planned), MakeLanguage::Gcode) = (&planned, language) {
        faults.extend(gcode::faults(&planned.steps));
    }
    if let Some(planned) = &planned {
        faults.extend(speeds_lost(&planned.steps, template, language));
    }
    let (Ok(name), Some(planned), true) = (name, planned, faults.is_empty()) else {
        return Err(faults);
    };
    let steps = &planned.steps;
    let most = language.limits().points.map_or(usize::MAX, |(usual, _)| {
        template.most_points.unwrap_or(usual)
    });
    parts_checked(&name, parts(steps, most).len(), language).map_err(|fault| vec![fault])?;
    let files = match language {
        MakeLanguage::Krl => krl::files(steps, &name, most, template, MADE_BY),
        MakeLanguage::Rapid => rapid::files(steps, &name, most, template, MADE_BY),
        MakeLanguage::FanucLs => ls::files(steps, &name, most, template, MADE_BY),
        MakeLanguage::Apt => files(steps, &name, template, MADE_BY),
        MakeLanguage::Gcode => gcode::files(steps, &name, template, MADE_BY),
        MakeLanguage::Csv => csv::files(steps, &name, template, MADE_BY),
    };
    let states = |step: &Step| matches!(step, Step::Statement(_));
    let again = read_again(&files, language).map_err(|fault| match steps.iter().any(states) {
        true => vec![stated::foreign_statement("not every line is", language)],
        false => vec![fault],
    })?;
    let kept = compare(path, steps, &again, template, language).map_err(|fault| vec![fault])?;
    let lines = (again.iter().zip(steps.iter().filter_map(Step::motion)))
        .map(|(read, motion)| [read.line, motion.line])
        .collect();
    let motions = steps.iter().filter_map(Step::motion);
    let parts = motions.map(|motion| (motion.source, motion.shares));
    let begins_at_joints = language.is_of_an_arm() && template.start_joints_deg.is_some();
    let start = steps.iter().find_map(Step::motion);
    let start = start.map(|motion| (motion.source, [0.0; 2]));
    let parts = start.filter(|_| begins_at_joints).into_iter().chain(parts);
    let parts = parts.collect();
    let first = steps.iter().find_map(Step::motion);
    let of_source = first.is_some_and(|motion| motion.end_configuration().is_some());
    let states_configuration = template.configuration.is_some() || of_source;
    let mut findings = planned.findings.clone();
    if language.is_of_an_arm() {
        findings.extend(crowded(steps));
    }
    taken_for_granted(
        steps,
        states_configuration,
        template,
        language,
        &kept,
        &mut findings,
    );
    findings.sort_by_key(|finding| finding.line.unwrap_or(usize::MAX));
    Ok(Made {
        files,
        findings,
        kept,
        lines,
        parts,
        states_configuration,
        spindle_not_started: planned.spindle_not_started.clone(),
    })
}

/// The defaults that were used, and the rounding that the decimals of the template cause.
fn taken_for_granted(
    steps: &[Step],
    states_configuration: bool,
    template: &Template,
    language: MakeLanguage,
    kept: &Kept,
    findings: &mut Vec<MakeFinding>,
) {
    let mut say = |message: String| findings.push(MakeFinding::of(None, message));
    if language.is_of_an_arm() {
        say("the first motion is a joint motion: on which way the arm comes there, the controller decides".to_owned());
        of_frames(template, language, &mut say);
        if !states_configuration {
            say(match language {
                MakeLanguage::FanucLs => format!(
                    "the configuration is not stated: every position has '{}'",
                    ls::CONFIGURATION
                ),
                _ => "the configuration is not stated: the arm keeps the one that it comes with"
                    .to_owned(),
            });
        }
        say(zones(template, language));
        let straight = |motion: &MadeMotion| motion.rapid && motion.way == Way::Line;
        if steps.iter().filter_map(Step::motion).any(straight) {
            let speed = template.rapid_speed_mm_per_s;
            say(format!("rapids are straight motions at {speed} mm/s"));
            if speed < SLOWEST_RAPID_MM_PER_S {
                say(format!(
                    "{speed} mm/s is slow for rapids: check the unit of rapid_speed_mm_per_s (mm/s, not m/s)"
                ));
            }
        }
    }
    if template.rapids == Rapids::Joint
        && steps
            .iter()
            .filter_map(Step::motion)
            .any(|m| m.way == Way::Joint && !m.first)
    {
        say("rapids are joint motions: their way is not that of the source".to_owned());
    }
    if kept.position_mm > 1e-6 {
        say(format!(
            "{} decimals of lengths move places by up to {:.1e} mm",
            template.position_decimals, kept.position_mm
        ));
    }
    if kept.orientation_rad > 1e-9 {
        say(format!(
            "the decimals of orientations turn the tool by up to {:.1e} rad",
            kept.orientation_rad
        ));
    }
    if kept.speed_relative > 1e-6 {
        say(format!(
            "feeds are rounded by up to {:.2} %: {}",
            100.0 * kept.speed_relative,
            match language {
                MakeLanguage::FanucLs => "pendants take tenths of mm/s (speed_decimals)",
                _ => "the template states the decimals of speeds",
            }
        ));
    }
    if language == MakeLanguage::Gcode {
        say(
            "G-code of three axes says nothing of the turn of the tool about its own axis"
                .to_owned(),
        );
        let waits = |step: &Step| matches!(step, Step::Action(EventAction::Wait { .. }));
        if steps.iter().any(waits) {
            say("pauses are G4 X, in seconds: where the controller takes P, write G4 P with the number in its unit".to_owned());
        }
    }
}

fn zones(template: &Template, language: MakeLanguage) -> String {
    let zones = &template.zones;
    match language {
        MakeLanguage::FanucLs => format!(
            "corners are rounded: CNT{} at feed, CNT{} of rapids; the tool stops where rapids and feeds meet",
            zones.feeds_percent, zones.rapids_percent
        ),
        _ => format!(
            "corners are rounded: within {} mm at feed, {} mm of rapids; the tool stops where rapids and feeds meet",
            zones.feeds_mm, zones.rapids_mm
        ),
    }
}

/// Axes nearer to z than this are z.
const UPRIGHT: f64 = 1e-12;

/// The file of a program.
pub(crate) fn files(
    steps: &[Step],
    name: &str,
    template: &Template,
    made_by: &str,
) -> Vec<(String, Vec<u8>)> {
    let mut motions = steps.iter().filter_map(Step::motion);
    let leans = motions.any(|motion| (motion.axis - Vector3::z()).norm() > UPRIGHT);
    let mut text = format!(
        "PARTNO/{}\n$$ {made_by}\nUNITS/MM\n",
        name.to_ascii_uppercase()
    );
    if leans {
        text += "MULTAX/ON\n";
    }
    let mut feed = String::new();
    for step in steps {
        match step {
            Step::Note(note) => text += &format!("$$ {note}\n"),
            Step::Tool(number) => text += &format!("LOADTL/{number}\n"),
            Step::Statement(statement) => text += &format!("{statement}\n"),
            Step::Action(action) => text += &action_text(*action),
            Step::Motion(motion) => {
                let per_minute = short(
                    60.0 * motion.speed_mm_per_s,
                    template.speed_decimals.unwrap_or(9),
                );
                let wanted = format!("FEDRAT/{per_minute},MMPM\n");
                if motion.rapid {
                    text += "RAPID\n";
                } else if wanted != feed {
                    text += &wanted;
                    feed = wanted;
                }
                text += &format!(
                    "GOTO/{}",
                    coordinates(&motion.end, template.position_decimals).join(",")
                );
                if leans {
                    let axis =
                        [0, 1, 2].map(|i| fixed(motion.axis[i], template.quaternion_decimals));
                    text += &format!(",{}", axis.join(","));
                }
                text.push('\n');
            }
        }
    }
    vec![(format!("{name}.apt"), (text + "FINI\n").into_bytes())]
}

fn action_text(action: EventAction) -> String {
    match action {
        EventAction::Wait { seconds } => format!("DELAY/{}\n", short(seconds, 6)),
        EventAction::Stop => "STOP\n".to_owned(),
        EventAction::OptionalStop => "OPSTOP\n".to_owned(),
        EventAction::Spindle { rotation, rpm } => {
            let sense = match rotation {
                SpindleRotation::Clockwise => "CLW",
                SpindleRotation::CounterClockwise => "CCLW",
                SpindleRotation::Stopped => return "SPINDL/OFF\n".to_owned(),
            };
            match rpm {
                Some(rpm) => format!("SPINDL/{},RPM,{sense}\n", short(rpm, 3)),
                None => format!("SPINDL/{sense}\n"),
            }
        }
        EventAction::Coolant(Coolant::Mist) => "COOLNT/MIST\n".to_owned(),
        EventAction::Coolant(Coolant::Flood) => "COOLNT/FLOOD\n".to_owned(),
        EventAction::Coolant(Coolant::Off) => "COOLNT/OFF\n".to_owned(),
    }
}

/// Window of consecutive motions: look-ahead compensates a single short one.
const IN_A_ROW: usize = 16;

/// The time of a motion that controllers of arms plan without slowing down, s: KUKA interpolates every 4 or 12 ms, FANUC every 8 ms.
const SHORTEST_S: f64 = 0.008;

/// The feeds of a program that are too short for their speed, in words; none where all are long enough.
fn crowded(steps: &[Step]) -> Option<MakeFinding> {
    let mut window: VecDeque<f64> = VecDeque::new();
    let (mut count, mut most_per_s, mut shortest_mm) = (0, 0.0, f64::INFINITY);
    let mut first = None;
    let mut from: Option<&MadeMotion> = None;
    for step in steps {
        let Step::Motion(motion) = step else {
            if !matches!(step, Step::Note(_)) {
                window.clear();
            }
            continue;
        };
        let way_mm = from.map_or(0.0, |from| (motion.end - from.end).norm());
        from = Some(motion);
        if motion.rapid || motion.way != Way::Line || way_mm == 0.0 {
            window.clear();
            continue;
        }
        let time_s = way_mm / motion.speed_mm_per_s;
        if time_s < SHORTEST_S {
            count += 1;
            if way_mm < shortest_mm {
                shortest_mm = way_mm;
            }
        }
        window.push_back(time_s);
        if window.len() > IN_A_ROW {
            window.pop_front();
        }
        let rate = IN_A_ROW as f64 / window.iter().sum::<f64>();
        if window.len() == IN_A_ROW && rate > 1.0 / SHORTEST_S {
            first.get_or_insert(motion.line);
            if rate > most_per_s {
                most_per_s = rate;
            }
        }
    }
    first.map(|line| {
        MakeFinding::of(
            line,
            format!(
                "{count} motions are shorter than {:.0} ms at their speed, the shortest {shortest_mm:.3} mm, up to {most_per_s:.0} of them in a second, here first: an arm may slow down there; let the CAM system write longer ones (a wider tolerance of its chords), or cut more slowly",
                1e3 * SHORTEST_S
            ),
        )
    })
}
