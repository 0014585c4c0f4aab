//! In which order motions, events and changes of tools of a robot's program run.

use std::collections::BTreeMap;

use crate::making::course::{Course, at, counted_on_lines, place_of};
use crate::making::events::SourceEvent;
use crate::making::of_tools::changes_of_source;
use crate::making::robot_events::events_of_robot;
use crate::making::routines::running_lines;
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
        course.tools = changes_of_source(program, robot, (&moves, &events));
        course.events = events;
        course.language = Some(program.language);
        return course;
    };
    let mut by_line: BTreeMap<usize, Vec<SourceEvent>> = BTreeMap::new();
    for event in events {
        by_line.entry(event.line).or_default().push(event);
    }
    let mut placed = Vec::new();
    let mut order: BTreeMap<usize, usize> = BTreeMap::new();
    for (index, running) in running.iter().enumerate() {
        order.entry(running.line).or_insert(index);
        for mut event in by_line.remove(&running.line).into_iter().flatten() {
            if running.is_followed {
                continue;
            }
            if !running.is_certain {
                event.only_words();
            }
            placed.push((place_of(&event, index), event));
        }
    }
    placed.sort_by_key(|(order, _)| *order);
    let moves = numbers(robot, |line| order.get(&line).copied().unwrap_or(line));
    Course {
        tools: changes_of_source(program, robot, (&moves, &placed)),
        of_moves: Some(moves),
        events: placed,
        left_out: by_line.into_values().flatten().collect(),
        language: Some(program.language),
        configurations: Vec::new(),
        other_speeds: Vec::new(),
        lost_speeds: BTreeMap::new(),
    }
}

/// The numbers of all moves, with the place of their lines in the order in which they run.
fn numbers(robot: &RobotPath, place: impl Fn(usize) -> usize) -> Vec<usize> {
    let lines: Vec<usize> = robot.path.moves.iter().map(|m| m.line).collect();
    let counted = counted_on_lines(&lines);
    let both = lines.iter().zip(counted);
    both.map(|(line, motion)| at(place(*line), motion))
        .collect()
}
