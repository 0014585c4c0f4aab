//! Warnings on a path that was made.

use std::f64::consts::PI;

use kinetostat_program::{Knowledge, Move, MoveKind, StatedBy, ToolTurn, Warning};
use nalgebra::{UnitQuaternion, Vector3};

use crate::model::motion::{Motion, MotionKind};
use crate::model::orientation::OrientationText;
use crate::model::program::RobotProgram;
use crate::model::site::TargetSite;
use crate::path::axis_angles::on_great_circle;
use crate::path::axis_turns::{ALONG_Z, TurnAboutAxis, axis_of};
use crate::path::maker::PathOptions;

/// Number of positions that suffice to judge whether a program is small, ...
const SEVERAL: usize = 8;

/// ... as one of 3 m in metres is where its lengths are taken for millimetres.
const METRES_AS_MM: f64 = 3.0;

/// Fewer places say so where they are as near to each other as no part is large, mm.
const NO_PART_MM: f64 = 0.5;

/// Slower and faster cuts are mostly in another unit, mm/s: robots cut with 1 to 300 mm/s.
const USUAL_CUTS: [f64; 2] = [0.1, 1000.0];

/// Turns that are nearer to half a turn are one but for the last digits of quaternions with four decimals, rad (0.01 deg).
const NEAR_HALF_A_TURN: f64 = 1.75e-4;

/// Warnings of a path; `place` says where a motion ends.
pub(crate) fn warnings_of(
    program: &RobotProgram,
    options: &PathOptions,
    moves: &[Move],
    in_base: bool,
    place: impl Fn(usize) -> Option<Vector3<f64>>,
) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let begins = |motion: &&Move| motion.known == Knowledge::End && motion.kind == MoveKind::Feed;
    if let Some(first) = moves.iter().find(begins) {
        warnings.push(Warning::of_corrections(first.line, format!(
                "where {} begins is not known, here first: behind another tool or zero point (G54, G55), behind joint values, in a branch or in what runs more than once. Only the end is corrected, and of a force that turns with the feed only the part along the tool",
                match moves.iter().filter(begins).count() {
                    1 => "1 motion at feed".to_owned(),
                    n => format!("{n} motions at feed"),
                }
            )));
    }
    warnings.extend(by_half_a_turn(moves));
    let slow = |motion: &&Motion| {
        motion.kind != MotionKind::Joint
            && motion.target.pose().is_some()
            && motion.speed.mm_per_s.is_none()
    };
    let unknown = program.motions.iter().find(slow);
    if let (Some(motion), Some(_)) = (unknown, options.rapid_from_mm_per_s) {
        warnings.push(Warning::new(
            motion.line,
            format!(
                "the speed `{}` is not known, here first: such motions are taken to cut",
                motion.speed.text
            ),
        ));
    }
    if let Some(line) = tiny(program, place) {
        warnings.push(Warning::new(line, "all places of the program lie within 3 mm of each other: are its lengths in metres or centimetres? They are taken for millimetres".to_owned()));
    }
    warnings.extend(odd_speed(program, moves));
    if in_base {
        warnings.push(Warning::of_corrections(1, "the program uses several work objects: its places in results, heights of the load and tables of corrections are in axes of the robot's base".to_owned()));
    }
    for finding in &program.findings {
        warnings.push(Warning::new(finding.line, finding.message.clone()));
    }
    warnings
}

/// Motions at feed that turn the tool by half a turn: on which side it goes round, the poses do not say.
fn by_half_a_turn(moves: &[Move]) -> Option<Warning> {
    let half = |motion: &&Move| {
        let turn = motion.tool_turn.as_ref();
        motion.is_known_feed() && turn.is_some_and(|turn| is_half_a_turn(turn))
    };
    let mut all = moves.iter().filter(half);
    let first = all.next()?;
    let more = and_more(all.count(), "motion");
    Some(Warning::new(
        first.line,
        format!(
            "the tool turns by half a turn here{more}, and on which side it goes round is not stated: the controller may go on the other one than is taken here; write a pose between"
        ),
    ))
}

/// True for a rotation of about 180 deg, whose sense is ambiguous; angles of rotary axes define it.
fn is_half_a_turn(turn: &ToolTurn) -> bool {
    let half = |angle: f64| angle > PI - NEAR_HALF_A_TURN;
    match (&turn.rotary, &turn.swivelling) {
        (Some(_), _) => false,
        (None, None) => half(turn.start.angle_to(&turn.end)),
        (None, Some(axis)) => {
            let [from, to] = [turn.start * axis, turn.end * axis];
            let swung = UnitQuaternion::rotation_between(&from, &to);
            // `None`: opposite directions; otherwise the rest is the rotation about the axis.
            swung.is_none_or(|swung| {
                half(swung.angle()) || half((swung * turn.start).angle_to(&turn.end))
            })
        }
    }
}

/// Line of the first of many places that lie as near to each other as those of a program in metres.
fn tiny(program: &RobotProgram, place: impl Fn(usize) -> Option<Vector3<f64>>) -> Option<usize> {
    let motions = program.motions.iter().enumerate();
    let places = motions.filter_map(|(index, motion)| Some((motion.line, place(index)?)));
    let (mut count, mut first) = (0, None);
    let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY].map(Vector3::repeat);
    for (line, place) in places {
        count += 1;
        first.get_or_insert(line);
        (low, high) = (low.inf(&place), high.sup(&place));
    }
    let spread = (high - low).amax();
    let most = match count {
        0..3 => 0.0,
        3..SEVERAL => NO_PART_MM,
        _ => METRES_AS_MM,
    };
    first.filter(|_| spread > 0.0 && spread < most)
}

/// The fastest cut, if it is so slow or so fast that its unit is most likely wrong; of KRL every motion that is faster than it can be.
fn odd_speed(program: &RobotProgram, moves: &[Move]) -> Option<Warning> {
    let cuts = moves.iter().filter(|motion| motion.is_known_feed());
    let cuts = cuts.filter_map(|m| Some((m.line, m.feed_mm_per_minute(f64::NAN)? / 60.0)));
    let known = cuts.filter(|(_, speed)| speed.is_finite());
    let fastest = known.max_by(|a, b| a.1.total_cmp(&b.1));
    let is_odd = |(_, speed): &(usize, f64)| !(USUAL_CUTS[0]..=USUAL_CUTS[1]).contains(speed);
    let too_fast = || {
        let most = program.language.most_speed_mm_per_s()?;
        let mut motions = program.motions.iter();
        let motion = motions.find(|m| m.speed.mm_per_s.is_some_and(|v| v > most))?;
        Some((motion.line, motion.speed.mm_per_s?))
    };
    let (line, speed) = fastest.filter(is_odd).or_else(too_fast)?;
    Some(Warning::new(
        line,
        format!(
            "a speed of {} mm/s is unusual: robots cut with 1 to 300 mm/s and move with up to 2000 mm/s; check its unit ($VEL.CP of KRL is in m/s, speeds of RAPID in mm/s, those of tables as their column says)",
            (1e4 * speed).round() / 1e4
        ),
    ))
}

/// Warnings on the rule for the rotation about the tool axis, at the first motion that it affects, and on an unstated axis.
pub(crate) fn by_rule(
    program: &RobotProgram,
    leaning: &Motion,
    options: &PathOptions,
) -> Vec<Warning> {
    let rule = match options.turn_about_axis {
        _ if options.rotary.is_some() => {
            let index = (program.motions.iter()).position(|motion| std::ptr::eq(motion, leaning));
            match on_great_circle(program, index.unwrap_or(0)) {
                true => {
                    "with the rotary axes of the machine, which lead its axis on the great circle from pose to pose"
                }
                false => "with the rotary axes of the machine, each evenly from pose to pose",
            }
        }
        TurnAboutAxis::Least => "as little as possible from pose to pose (`turn_about_axis`)",
        TurnAboutAxis::Towards { .. } => "towards the direction that is stated (`turn_about_axis`)",
    };
    let axis = axis_of(program, leaning);
    // A work object may turn it.
    let z = match axis.is_some_and(|axis| (axis - Vector3::z()).norm() > ALONG_Z) {
        true => "z",
        false => "z of the robot's base",
    };
    let mut warnings = vec![Warning::new(
        leaning.line,
        format!(
            "the program states the tool's axis alone, here first another one than {z}: about it the tool is taken to turn {rule}"
        ),
    )];
    let unstated = |motion: &Motion| matches!(&motion.site.target, TargetSite::Literal(text) if text.convention == OrientationText::Unstated);
    let has_angles = program.rotary.has_angles();
    let by_axes = |index: &usize| has_angles && program.rotary.motions.contains_key(index);
    let mut motions = program.motions.iter().enumerate();
    let first = motions.find(|(index, motion)| unstated(motion) && !by_axes(index));
    if let (Some(words), Some((_, motion))) = (program.language.words_of_direction(), first) {
        warnings.push(Warning::new(
            motion.line,
            format!(
                "the direction of the tool is not stated here ({words}): z of the part is taken"
            ),
        ));
    }
    warnings
}

/// Blocks whose angles alone change at feed.
pub(crate) fn turns_alone(moves: &[Move]) -> Option<Warning> {
    let alone = |motion: &&Move| {
        let turn = motion.tool_turn.as_ref();
        let turn = turn.and_then(|turn| turn.rotary.as_ref());
        let by_angles = turn.is_some_and(|turn| turn.stated == StatedBy::Angles);
        by_angles && motion.is_known_feed() && motion.turns_in_place()
    };
    let mut all = moves.iter().filter(alone);
    let first = all.next()?;
    let more = and_more(all.count(), "block");
    Some(Warning::of_corrections(
        first.line,
        format!(
            "rotary axes turn alone here{more}: where the block is corrected its pieces keep F, which counts the way of the tip then, so that the axes may turn as fast as they can"
        ),
    ))
}

/// Number of further findings, in brackets.
fn and_more(count: usize, what: &str) -> String {
    match count {
        0 => String::new(),
        1 => format!(" (and in 1 more {what})"),
        n => format!(" (and in {n} more {what}s)"),
    }
}
