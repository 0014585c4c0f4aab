//! Execution order of motions, events and tool changes of a robot's program.

use std::collections::{BTreeMap, VecDeque};

use crate::making::course::{Course, at, counted_on_lines, place_of};
use crate::making::events::{EventKind, SourceEvent};
use crate::making::motion_events::comment_behind;
use crate::making::of_tools::changes_of_source;
use crate::making::robot_events::events_of_robot;
use crate::making::routines::{Part, running_lines};
use crate::model::Language;
use crate::model::program::RobotProgram;
use crate::path::of_program::RobotPath;

/// The course of a program along its path.
pub(crate) fn course_of(program: &RobotProgram, robot: &RobotPath) -> Course {
    let events = events_of_robot(program);
    let Some(running) = running_lines(program, robot.file) else {
        let mut course = Course::of_lines(&robot.path, &events);
        let mut events = std::mem::take(&mut course.events);
        events.iter_mut().for_each(|(_, event)| event.only_words());
        let moves = numbers(robot, |line| line);
        course.tools = changes_of_source(program, robot, &moves, &events);
        course.events = events;
        course.language = Some(program.language);
        return course;
    };
    let mut by_line: BTreeMap<usize, VecDeque<SourceEvent>> = BTreeMap::new();
    for event in events {
        by_line.entry(event.line).or_default().push_back(event);
    }
    let mut placed = Vec::new();
    let mut order: BTreeMap<usize, usize> = BTreeMap::new();
    for (index, running) in running.iter().enumerate() {
        if running.part == Part::Rest {
            order.entry(running.line).or_insert(index);
        }
        let Some(own) = by_line.get_mut(&running.line) else {
            continue;
        };
        for mut event in part_of(program.language, own, &running.part) {
            if !running.is_certain {
                event.only_words();
            }
            placed.push((place_of(&event, index), event));
        }
    }
    placed.sort_by_key(|(order, _)| *order);
    let moves = numbers(robot, |line| order.get(&line).copied().unwrap_or(line));
    Course {
        tools: changes_of_source(program, robot, &moves, &placed),
        of_moves: Some(moves),
        events: placed,
        left_out: by_line.into_values().flatten().collect(),
        language: Some(program.language),
        ..Course::default()
    }
}

/// Takes what runs at a part of a line out of the events of that line; of a call that is followed its comment alone.
fn part_of(
    language: Language,
    events: &mut VecDeque<SourceEvent>,
    part: &Part,
) -> Vec<SourceEvent> {
    let name = match part {
        Part::Rest => return events.drain(..).collect(),
        Part::Call => {
            events.clear();
            return Vec::new();
        }
        Part::Before(name) => name,
    };
    let mut taken = Vec::new();
    while let Some(event) = events.pop_front() {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let mut words = event.text.split(|c| !is_word(c));
        if words
            .next()
            .is_some_and(|word| word.eq_ignore_ascii_case(name))
        {
            let comment = comment_behind(language, &event.text);
            taken.extend(
                comment.map(|text| SourceEvent::words_alone(event.line, EventKind::Comment, text)),
            );
            break;
        }
        taken.push(event);
    }
    taken
}

/// The numbers of all moves, with the place of their lines in the order in which they run.
fn numbers(robot: &RobotPath, place: impl Fn(usize) -> usize) -> Vec<usize> {
    let lines: Vec<usize> = robot.path.moves.iter().map(|m| m.line).collect();
    let counted = counted_on_lines(&lines);
    let both = lines.iter().zip(counted);
    both.map(|(line, motion)| at(place(*line), motion))
        .collect()
}
