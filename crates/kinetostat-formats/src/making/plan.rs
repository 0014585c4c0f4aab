//! Conversion of a path and its events to the steps of a program.

use std::collections::BTreeSet;

use kinetostat_program::{COMPENSATED_MARK, Knowledge, Move, MoveKind, Path, SpindleRotation};
use nalgebra::{UnitQuaternion, Vector3};

use crate::making::course::Course;
use crate::making::events::{EventAction, EventKind, SourceEvent};
use crate::making::limits::{Limits, MakeLanguage};
use crate::making::names::plain;
use crate::making::otherwise::{Otherwise, further_axes, speed_remedy};
use crate::making::pieces::{Shape, Turned, pieces_of};
use crate::making::step::{MadeMotion, Step, Way, stops};
use crate::making::template::{PlacesUnknown, Rapids, Template};
use crate::making::tools_told::{other_edges, told};
use crate::making::{MakeError, MakeFinding};

/// Steps, and what a person should know of them.
pub(crate) struct Planned {
    pub steps: Vec<Step>,
    pub findings: Vec<MakeFinding>,
    pub spindle_not_started: Option<String>,
}

/// Places and orientations that differ by less are one.
const SAME_PLACE_MM: f64 = 1e-9;
const SAME_TURN_RAD: f64 = 1e-9;

/// Limit of the motions of a made program.
const MOST_MOTIONS: usize = 20_000_000;

/// The steps of a path.
pub(crate) fn plan(
    path: &Path,
    course: &Course,
    template: &Template,
    language: MakeLanguage,
) -> Result<Planned, Vec<MakeError>> {
    let mut planner = Planner {
        path,
        course,
        template,
        language,
        limits: language.limits(),
        steps: Vec::with_capacity(path.moves.len() + course.events.len()),
        faults: Vec::new(),
        findings: Vec::new(),
        otherwise: Otherwise::default(),
        turned: Turned::default(),
        spindle_not_started: None,
        spindle_turns: false,
        tool: None,
        last_tool: None,
        begun: false,
    };
    let told = told(path, course, template, language);
    planner.faults.extend(told.faults);
    planner.faults.extend(other_edges(path, course, language));
    planner.findings.extend(told.findings);
    planner.walk();
    planner.end()
}

struct Planner<'p> {
    path: &'p Path,
    course: &'p Course,
    template: &'p Template,
    language: MakeLanguage,
    limits: Limits,
    steps: Vec<Step>,
    faults: Vec<MakeError>,
    findings: Vec<MakeFinding>,
    otherwise: Otherwise,
    turned: Turned,
    /// The first start of the spindle that is a note alone.
    spindle_not_started: Option<String>,
    spindle_turns: bool,
    tool: Option<u32>,
    /// Tool of the last motion.
    last_tool: Option<u32>,
    begun: bool,
}

impl Planner<'_> {
    fn fault(&mut self, line: usize, reason: impl Into<String>, remedy: impl Into<String>) {
        self.faults.push(MakeError::at(line, reason, remedy));
    }

    fn walk(&mut self) {
        let moves = &self.path.moves;
        let course = self.course;
        self.findings.extend(course.finding());
        let mut events = course.events.iter().peekable();
        let last_known = moves
            .iter()
            .rposition(|motion| motion.known != Knowledge::Nothing);
        for (index, motion) in moves.iter().enumerate() {
            let order = course.of_move(index, motion.line);
            while let Some((at, event)) = events.next_if(|(at, _)| *at < order) {
                self.event(*at, event);
            }
            self.change_tool(order);
            match motion.known {
                Knowledge::Nothing => self.without_place(index, last_known),
                _ => self.made(index),
            }
            if self.steps.len() > MOST_MOTIONS {
                self.fault(
                    motion.line,
                    "the program would have more than 20 million motions",
                    "state a larger tolerance_mm",
                );
                return;
            }
        }
        for (at, event) in events {
            self.event(*at, event);
        }
        self.stop_spindle();
        if !self.begun && self.faults.is_empty() {
            let line = moves.first().map_or(1, |motion| motion.line);
            self.fault(
                line,
                "the program has no move to a place that is known",
                "give a program that moves the tool",
            );
        }
    }

    /// The end of a program stops the spindle, and that of an arm's does not.
    fn stop_spindle(&mut self) {
        if !self.spindle_turns {
            return;
        }
        let stop = self.template.spindle.lines(SpindleRotation::Stopped, None);
        match stop {
            Some(lines) => self.steps.extend(lines.into_iter().map(Step::Statement)),
            None => self.findings.push(MakeFinding::of(
                None,
                "the spindle still turns at the end of the program: the template states no stop under [spindle]",
            )),
        }
    }

    fn change_tool(&mut self, order: usize) {
        let number = self.course.tool_at(order);
        if number == self.tool {
            return;
        }
        self.tool = number;
        let is_written = !self.language.is_of_an_arm() || !self.template.tools.is_empty();
        if let (Some(number), true) = (number, is_written) {
            self.steps.push(Step::Tool(number));
        }
    }

    fn event(&mut self, order: usize, event: &SourceEvent) {
        let note = match event.text.contains(COMPENSATED_MARK) {
            // Readers search for exactly this text; it fills the remark of a TP program.
            true => COMPENSATED_MARK.to_owned(),
            false => format!("{}: {}", event.place, plain(&event.text)),
        };
        self.steps.push(Step::Note(note.clone()));
        let of_a_machine = matches!(self.language, MakeLanguage::Apt | MakeLanguage::Gcode);
        let before = self.tool;
        if of_a_machine {
            // The tool changes before a statement such as the start of the spindle.
            self.change_tool(order);
        }
        let mut lost: BTreeSet<EventKind> = BTreeSet::new();
        for action in &event.actions {
            match action.is_in(self.language) {
                true => {
                    if *action == EventAction::OptionalStop && !of_a_machine {
                        self.otherwise.stop_always(event.line);
                    }
                    self.steps.push(Step::Action(*action));
                }
                false => match self.statements(*action) {
                    Some(lines) => {
                        self.spindle_turns = action.starts_spindle();
                        self.steps.extend(lines.into_iter().map(Step::Statement));
                    }
                    None => {
                        let starts = action.starts_spindle() && !of_a_machine;
                        if starts && self.spindle_not_started.is_none() {
                            self.spindle_not_started = Some(note.clone());
                        }
                        lost.insert(action.kind());
                    }
                },
            }
        }
        let is_taken = |kind: EventKind| {
            let length = event.text.contains("G43") || event.text.contains("G49");
            kind == EventKind::Tool && of_a_machine && self.tool != before && !length
        };
        let has_speed = |action: &EventAction| matches!(action, EventAction::Spindle { rotation, rpm: Some(_) } if *rotation != SpindleRotation::Stopped);
        if self.language.is_of_an_arm()
            && self.template.spindle.leaves_out_speed()
            && (event.states_speed || event.actions.iter().any(has_speed))
        {
            self.otherwise.dropped_speed.get_or_insert(note.clone());
        }
        let speaks_alone = event.actions.is_empty() && event.rest.is_none();
        lost.extend(event.rest.filter(|kind| !is_taken(*kind)));
        // The speed of a spindle that stands still is written where it starts.
        let is_written_there = of_a_machine || !self.template.spindle.clockwise.is_empty();
        lost.extend((event.states_speed && !is_written_there).then_some(EventKind::Spindle));
        lost.extend((speaks_alone && !event.states_speed).then_some(event.kind));
        for kind in lost {
            if !matches!(kind, EventKind::Comment | EventKind::End) {
                self.otherwise.lose(kind, note.clone());
            }
        }
    }

    /// Statements of the template for what the language has no words for.
    fn statements(&self, action: EventAction) -> Option<Vec<String>> {
        match action {
            EventAction::Spindle { rotation, rpm } if self.language.is_of_an_arm() => {
                self.template.spindle.lines(rotation, rpm)
            }
            _ => None,
        }
    }

    /// A move whose end is not known in the part.
    fn without_place(&mut self, index: usize, last_known: Option<usize>) {
        let motion = &self.path.moves[index];
        let line = motion.line;
        let outside = !self.begun || last_known.is_none_or(|last| index > last);
        if outside || self.template.places_unknown == PlacesUnknown::LeftOut {
            let why = match motion.words.is_to_machine() {
                true => "it goes to a place of the machine",
                false => "where it ends is not known in the part",
            };
            let message = match self.begun {
                false => format!("{why}: it is left out, the program begins behind it"),
                true => format!("{why}: it is left out"),
            };
            let known = self
                .findings
                .last()
                .is_some_and(|last| last.message == message);
            if !known {
                self.findings.push(MakeFinding::of(line, message));
            }
            self.steps
                .push(Step::Note(format!("line {line}: a move is left out here")));
            return;
        }
        self.fault(
            line,
            "the move goes to a place of the machine, or to one that is not known in the part",
            "take it out, or let it be left out (places_unknown = \"left_out\"): the tool goes straight on then",
        );
    }

    fn speed(&mut self, motion: &Move) -> Option<f64> {
        if motion.kind == MoveKind::Rapid {
            return Some(self.template.rapid_speed_mm_per_s);
        }
        let rpm = self.path.spindle_on(motion.line).rpm().unwrap_or(f64::NAN);
        let stated = motion.feed_mm_per_minute(rpm).map(|feed| feed / 60.0);
        let found = stated.or(self.template.unstated_feed_mm_per_s);
        if let Some(speed) = found.filter(|speed| *speed > 0.0 && speed.is_finite()) {
            return Some(speed);
        }
        self.fault(
            motion.line,
            "the speed of this motion at feed is not known",
            speed_remedy(self.course.language),
        );
        None
    }

    fn orientation(&self, motion: &Move, share: f64) -> Option<UnitQuaternion<f64>> {
        motion.orientation(share).or(self.template.tool_orientation)
    }

    /// True if a move with an unknown start ends elsewhere than the previous motion, for example after an unknown routine.
    fn comes_from_elsewhere(&self, motion: &Move) -> bool {
        let last = self.steps.iter().rev().find_map(Step::motion);
        let (Knowledge::End, Some(last)) = (motion.known, last) else {
            return false;
        };
        let turned = last.orientation.zip(self.orientation(motion, 1.0));
        (last.end - motion.point(1.0)).norm() > SAME_PLACE_MM
            || turned.is_some_and(|(one, other)| one.angle_to(&other) > SAME_TURN_RAD)
    }

    fn made(&mut self, index: usize) {
        let path = self.path;
        let motion = &path.moves[index];
        let stated = self.course.configurations.get(index);
        let stated = stated.filter(|stated| stated.end.is_some() || stated.via.is_some());
        let reconfigures = stated.is_some_and(|stated| stated.changes);
        // Another tip goes there from where it is.
        let same_tool = self.tool == self.last_tool;
        let goes = motion.has_length()
            || motion.turns_in_place()
            || reconfigures
            || self.comes_from_elsewhere(motion);
        if self.begun && same_tool && !goes {
            return;
        }
        if self.limits.orientation
            && self.language != MakeLanguage::Csv
            && self.language != MakeLanguage::Apt
            && self.orientation(motion, 1.0).is_none()
        {
            if !self
                .faults
                .iter()
                .any(|fault| fault.remedy.contains("tool_orientation"))
            {
                self.fault(
                    motion.line,
                    "the program does not say how the tool stands, and a robot needs to know it",
                    "state tool_orientation in the template: the part's axes turned into the tool's (an angle of 180 deg about x where the tool's z points down)",
                );
            }
            return;
        }
        let Some(speed_mm_per_s) = self.speed(motion) else {
            return;
        };
        let Some(mut pieces) = pieces_of(motion, &self.limits, self.template.tolerance_mm) else {
            return self.fault(
                motion.line,
                "the arc would become more than a million lines",
                "state a larger tolerance_mm",
            );
        };
        if !self.begun {
            // From wherever the arm is, straight to its end.
            pieces.ends = vec![1.0];
            pieces.shape = Shape::Line;
            pieces.followed = None;
        }
        let rapid = motion.kind == MoveKind::Rapid;
        let by_joints = !self.begun || reconfigures;
        let is_joint = by_joints || (rapid && self.template.rapids == Rapids::Joint);
        if !is_joint || pieces.shape != Shape::Line {
            let axis = &path.tool_axis;
            (self.turned).divide(motion, &mut pieces, self.language, axis);
        }
        if let Some(followed) = pieces.followed {
            self.otherwise
                .follow(followed, motion.line, pieces.ends.len());
        }
        self.last_tool = self.tool;
        let other_speeds = self.course.other_speeds.get(index).and_then(Option::as_ref);
        let mut from = 0.0;
        for to in pieces.ends {
            let via = 0.5 * (from + to);
            let way = match pieces.shape {
                Shape::Circle => Way::Circle {
                    via: motion.point(via),
                    via_orientation: self.orientation(motion, via),
                },
                Shape::AboutZ { clockwise } => Way::AboutZ {
                    centre: centre(motion),
                    clockwise,
                },
                Shape::Line if is_joint => Way::Joint,
                Shape::Line => Way::Line,
            };
            let axis = match motion.orientation(to) {
                Some(orientation) => orientation * path.tool_axis,
                None => Vector3::z(),
            };
            self.steps.push(Step::Motion(MadeMotion {
                source: index,
                shares: [from, to],
                line: motion.line,
                way,
                end: motion.point(to),
                orientation: self.orientation(motion, to),
                axis,
                speed_mm_per_s,
                other_speeds: other_speeds.cloned().filter(|_| !rapid),
                rapid,
                first: !self.begun,
                exact: by_joints,
                configuration: stated.cloned().map(Box::new),
            }));
            self.begun = true;
            from = to;
        }
    }

    fn end(mut self) -> Result<Planned, Vec<MakeError>> {
        if !self.faults.is_empty() {
            self.faults.sort_by_key(|fault| fault.line);
            return Err(self.faults);
        }
        stops(&mut self.steps);
        let otherwise = self
            .otherwise
            .findings(self.language, self.template.tolerance_mm);
        self.findings.extend(otherwise);
        self.findings.extend(self.turned.findings());
        self.findings.extend(further_axes(self.path));
        Ok(Planned {
            steps: self.steps,
            findings: self.findings,
            spindle_not_started: self.spindle_not_started,
        })
    }
}

fn centre(motion: &Move) -> Vector3<f64> {
    match &motion.curve {
        kinetostat_program::Curve::Arc(arc) => arc.centre,
        kinetostat_program::Curve::Line => motion.start,
    }
}
