//! What a robot's or a control's program says beside its places: frames, tools, how near it comes to ends of motions, and how the arm
//! stands there.

use std::collections::{BTreeMap, BTreeSet};

use kinetostat_formats::{FrameUse, Language, Motion, Runs, Target, Zone};
use nalgebra::Vector3;

use crate::job::robot::frame_distance::distance;
use crate::job::robot::read_program::RobotRead;
use crate::ui::numbers::{number, short, triple};
use crate::verify::control_words::control_words;
use crate::verify::other_word::{FaultKind, OtherWord};
use crate::verify::statements::statements;
use crate::verify::unseen_motions::unseen_motions;
use crate::verify::words::{Kind, Words, compared};

/// Frames nearer to each other than this are one: more digits than controllers write, mm and rad.
const SAME_MM: f64 = 1e-3;
const SAME_RAD: f64 = 5e-6;

/// A call without a name.
const COMPUTED: &str = "a call that is computed";

/// The radius of RAPID's z0, with which steps are passed, mm.
const PASSED_MM: f64 = 0.3;

/// What differs between both programs; `cut_lines` are lines of the program verified and of the original.
pub(crate) fn robot_words(
    original: &RobotRead<'_>,
    verified: &RobotRead<'_>,
    cut_lines: &[[usize; 2]],
) -> Vec<OtherWord> {
    let mut found = Vec::new();
    found.extend(work_objects(original, verified));
    let of_tools = tools(original, verified);
    // What is said of a tool as such holds at all its cuts.
    if of_tools.iter().all(|tool| tool.fault.is_none()) {
        found.extend(tool_at_cuts(original, verified, cut_lines));
    }
    found.extend(of_tools);
    let calls = called_outside(original, verified);
    let [mut own, of_original] = [verified, original].map(words);
    let is_said = |line: usize| calls.iter().any(|call| call.line == Some(line));
    own.all
        .retain(|word| word.kind != Kind::Other || !is_said(word.line));
    found.extend(compared(&own, &of_original, cut_lines, &|_| false));
    found.extend(calls);
    found.extend(unseen_motions(original, verified, cut_lines));
    let stops = fewer_stops(original, verified);
    found.extend(radii(original, verified, stops.is_some()));
    found.extend(stops);
    found.extend(configurations(original, verified));
    found
}

fn words(read: &RobotRead<'_>) -> Words {
    let mut all = control_words(read);
    all.extend(statements(read));
    all.sort_by_key(|word| word.line);
    let motions = &read.program.motions;
    Words {
        all,
        move_lines: motions.iter().map(|motion| motion.line).collect(),
        has_loops: motions.iter().any(|motion| motion.runs == Runs::Repeatedly),
    }
}

fn first_line(read: &RobotRead<'_>) -> Option<usize> {
    Some(read.program.motions.first()?.line)
}

/// Whether two names are one: robots and controls do not tell `tMill` from `TMILL`, nor tool 01 from tool 1.
fn is_same_name(a: &str, b: &str) -> bool {
    let numbers = [a, b].map(str::parse::<u64>);
    a.eq_ignore_ascii_case(b) || matches!(numbers, [Ok(a), Ok(b)] if a == b)
}

/// Why two frames are not one.
fn apart(own: &FrameUse, of_original: &FrameUse) -> Option<String> {
    match (own.known(), of_original.known()) {
        (Some(a), Some(b)) => {
            let [mm, turn] = distance(a, b);
            let shown =
                |v: &Vector3<f64>| triple([v.x, v.y, v.z], |x| short((1e4 * x).round() / 1e4));
            let place = (mm > SAME_MM).then(|| {
                let [own, of] = [a, b].map(|frame| shown(&frame.translation.vector));
                format!("is at {own} mm, in the original at {of} mm")
            });
            let turned = (turn > SAME_RAD).then(|| {
                let deg = number(turn.to_degrees(), 4);
                format!("is turned by {deg} deg from that of the original")
            });
            let found: Vec<String> = place.into_iter().chain(turned).collect();
            (!found.is_empty()).then(|| found.join(", and "))
        }
        _ => (!is_same_name(&own.name, &of_original.name)).then(|| {
            format!(
                "is '{}' in the original, and it is not known where both are",
                of_original.name
            )
        }),
    }
}

/// The object in whose axes the path is.
fn work_objects(original: &RobotRead<'_>, verified: &RobotRead<'_>) -> Option<OtherWord> {
    let lines = [first_line(verified), first_line(original)];
    let (Some(own), Some(of_original)) = (&verified.path.work_object, &original.path.work_object)
    else {
        let several = [verified, original].map(|read| read.path.work_object.is_none());
        return (several[0] != several[1]).then(|| {
            let text =
                "one of both programs goes in one work object and the other in several".to_owned();
            OtherWord::new("work object", Some(FaultKind::Frame), lines, text)
        });
    };
    let why = apart(own, of_original)?;
    let text = format!("work object '{}' {why}", own.name);
    Some(OtherWord::new(
        own.name.as_str(),
        Some(FaultKind::Frame),
        lines,
        text,
    ))
}

/// Tools that stand otherwise in the flange.
fn tools(original: &RobotRead<'_>, verified: &RobotRead<'_>) -> Vec<OtherWord> {
    let of_original = &original.path.tools;
    let line_with = |read: &RobotRead<'_>, tool: &FrameUse| {
        let mut motions = read.program.motions.iter();
        motions.find(|m| m.tool == *tool).map(|m| m.line)
    };
    let own = verified.path.tools.iter().enumerate();
    own.filter_map(|(index, tool)| {
        let mut named = of_original
            .iter()
            .filter(|of| is_same_name(&of.name, &tool.name));
        let beside = named.next().or_else(|| of_original.get(index))?;
        let lines = [line_with(verified, tool), line_with(original, beside)];
        if let Some(why) = apart(tool, beside) {
            let text = format!("tool '{}' {why}", tool.name);
            return Some(OtherWord::new(
                tool.name.as_str(),
                Some(FaultKind::Tool),
                lines,
                text,
            ));
        }
        (!is_same_name(&tool.name, &beside.name)).then(|| {
            let text = format!(
                "tool '{}' is '{}' in the original, at the same place",
                tool.name, beside.name
            );
            OtherWord::new(tool.name.as_str(), None, lines, text)
        })
    })
    .collect()
}

/// The first cut that is made with another tool than in the original.
fn tool_at_cuts(
    original: &RobotRead<'_>,
    verified: &RobotRead<'_>,
    cut_lines: &[[usize; 2]],
) -> Option<OtherWord> {
    let by_line = |read: &RobotRead<'_>| -> BTreeMap<usize, usize> {
        let motions = read.program.motions.iter().enumerate();
        let own = motions.filter(|(_, motion)| motion.file == read.path.file);
        own.map(|(index, motion)| (motion.line, index)).collect()
    };
    let [own, of_original] = [verified, original].map(by_line);
    let tools = |lines: &[usize; 2]| {
        let own = &verified.program.motions[*own.get(&lines[0])?].tool;
        let of_original = &original.program.motions[*of_original.get(&lines[1])?].tool;
        Some((own, of_original, apart(own, of_original)?))
    };
    let mut all = cut_lines.iter();
    let (lines, (own, of_original, why)) = all.find_map(|lines| Some((lines, tools(lines)?)))?;
    let text = format!(
        "line {} cuts with tool '{}', the original with '{}' (line {} there): it {why}",
        lines[0], own.name, of_original.name, lines[1]
    );
    let lines = [Some(lines[0]), Some(lines[1])];
    let fault = Some(FaultKind::Tool);
    Some(OtherWord::new(own.name.as_str(), fault, lines, text))
}

/// What only the program verified calls and none of its files holds, or computes.
fn called_outside(original: &RobotRead<'_>, verified: &RobotRead<'_>) -> Vec<OtherWord> {
    let calls = |read: &RobotRead<'_>| -> Vec<(usize, String)> {
        let findings = read.program.findings.iter();
        let calls = findings.filter_map(|finding| {
            let message = &finding.message;
            let name = match message.split_once(" is in none of the files") {
                Some((name, _)) => name,
                None if message.starts_with("what is called is computed") => COMPUTED,
                None => return None,
            };
            Some((finding.line, name.to_owned()))
        });
        calls.collect()
    };
    let known: BTreeSet<String> = calls(original).into_iter().map(|(_, name)| name).collect();
    let own = calls(verified).into_iter();
    let own = own.filter(|(_, name)| !known.contains(name));
    own.map(|(line, name)| {
        let lines = [Some(line), None];
        let what = OtherWord::only_in_one(&name, lines);
        let follows = match name == COMPUTED {
            true => {
                "if it moves the tool, that is not seen, and a motion behind it is taken for no cut"
            }
            false => "it is taken not to move the tool and not to change speed, tool or frame",
        };
        let text = format!("{what}, and none of these files says what it does: {follows}");
        OtherWord::new(name, None, lines, text)
    })
    .collect()
}

/// How far an end may be passed, in its unit; none where that is not known.
fn width(zone: Zone) -> Option<f64> {
    match zone {
        Zone::Exact => Some(0.0),
        Zone::Radius(width) | Zone::Percent(width) => Some(width),
        Zone::Unstated => None,
    }
}

/// Ends at which the tool stopped, or that it passed more nearly.
fn fewer_stops(original: &RobotRead<'_>, verified: &RobotRead<'_>) -> Option<OtherWord> {
    let widths = |read: &RobotRead<'_>| -> Vec<f64> {
        let motions = read.program.motions.iter();
        let mut all: Vec<f64> = motions.filter_map(|m| width(m.zone)).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let [own, of_original] = [verified, original].map(widths);
    let count = |all: &[f64], most: f64| all.iter().filter(|width| **width <= most).count();
    let fewer = |most: &&f64| count(&own, **most) < count(&of_original, **most);
    let most = *of_original.iter().find(fewer)?;
    let [own, of_original] = [&own, &of_original].map(|all| count(all, most));
    let ends = match most > 0.0 {
        true => format!("pass their ends by no more than zone {}", short(most)),
        false => "stop at their ends".to_owned(),
    };
    let text = format!(
        "{of_original} motions of the original {ends}, and {own} of this program: corners are left by what the control allows, and no figure has that in it"
    );
    let fault = Some(FaultKind::PathMode);
    Some(OtherWord::new("exact stop", fault, [None, None], text))
}

/// Ends that are passed at a larger distance.
fn radii(
    original: &RobotRead<'_>,
    verified: &RobotRead<'_>,
    stops_less: bool,
) -> Option<OtherWord> {
    let largest = |read: &RobotRead<'_>| {
        let motions = read.program.motions.iter();
        let radii = motions.filter_map(|m| match m.zone {
            Zone::Radius(mm) => Some((mm, m.line)),
            Zone::Exact | Zone::Percent(_) | Zone::Unstated => None,
        });
        radii.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let (mm, line) = largest(verified)?;
    let of_original = largest(original).map_or(0.0, |(mm, _)| mm);
    // Pieces of a motion of KRL that stops pass their ends within the distance in force.
    let may_be_pieces =
        verified.program.language == Language::Krl && of_original == 0.0 && !stops_less;
    let fault = (!may_be_pieces).then_some(FaultKind::PathMode);
    (mm > PASSED_MM && mm > of_original).then(|| {
        let text = format!(
            "the end of the motion at line {line} is passed at up to {} mm, those of the original at {}: no figure has that in it",
            short(mm),
            short(of_original)
        );
        OtherWord::new("zone", fault, [Some(line), None], text)
    })
}

/// Ways for the arm to stand that no motion of the original asks for.
fn configurations(original: &RobotRead<'_>, verified: &RobotRead<'_>) -> Option<OtherWord> {
    let of = |motion: &Motion| match &motion.target {
        Target::Pose(pose) => Some(pose.configuration.text.replace(char::is_whitespace, "")),
        _ => None,
    };
    let known: BTreeSet<String> = original.program.motions.iter().filter_map(of).collect();
    let mut own = verified.program.motions.iter();
    let is_new = |motion: &&Motion| of(motion).is_some_and(|text| !known.contains(&text));
    let motion = own.find(is_new)?;
    let text = format!(
        "the arm is to stand as {} at line {}, which no motion of the original asks for: the model stands as in the original",
        of(motion)?,
        motion.line
    );
    Some(OtherWord::new(
        "configuration",
        None,
        [Some(motion.line), None],
        text,
    ))
}
