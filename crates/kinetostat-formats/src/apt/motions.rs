//! Statements that move the tool.

use kinetostat_program::last_digit_mm;
use nalgebra::{UnitQuaternion, Vector3};

use crate::apt::file_reader::{HOLES, LEAVE, POINTS, Reader, frame_use, pose_text, work_object};
use crate::apt::lines::Statement;
use crate::apt::state::Circle;
use crate::model::motion::{Motion, MotionKind, Runs, Speed, Zone};
use crate::model::orientation::OrientationText;
use crate::model::site::{MotionSite, TargetSite};
use crate::model::target::{Configuration, PoseTarget, Target};
use crate::options::UnknownTargets;

impl Reader<'_, '_> {
    pub fn goto(&mut self, statement: &Statement) {
        let Some((numbers, place)) = self.pose(statement) else {
            self.state.circle = None;
            self.state.place = None;
            return;
        };
        let circle = self.state.circle.take();
        if self.state.in_cycle {
            let reason =
                "it is a hole of a cycle: from here the controller drills as the cycle says";
            self.unknown_with(statement, reason, HOLES, None);
            return;
        }
        let mut kind = MotionKind::Linear;
        if let Some(circle) = &circle {
            let known = self.state.place;
            let written: Vec<f64> = numbers.iter().take(3).map(|number| number.value).collect();
            let digit_mm = last_digit_mm(&written, self.unit_mm);
            match known.map(|from| circle.angle(&from, &place, digit_mm)) {
                _ if circle.times => {
                    let reason = "it is a helix of several turns, whose way is not followed";
                    self.unknown_with(statement, reason, LEAVE, Some(circle));
                    self.state.place = Some(place);
                    return;
                }
                None => {
                    let reason = "where its arc begins is not known";
                    self.unknown_with(statement, reason, LEAVE, Some(circle));
                    self.state.place = Some(place);
                    return;
                }
                Some(Err((reason, remedy))) => {
                    self.fault(&circle.span, reason, remedy);
                    self.state.place = Some(place);
                    return;
                }
                Some(Ok(angle_rad)) => {
                    kind = MotionKind::Arc {
                        centre_mm: circle.centre_mm,
                        axis: circle.axis,
                        angle_rad,
                    };
                }
            }
        }
        let text = pose_text(self.index, numbers, None);
        self.push(
            statement,
            kind,
            place,
            TargetSite::Literal(text),
            circle.as_ref(),
        );
    }

    pub fn step(&mut self, statement: &Statement) {
        let numbers = self.numbers(statement).filter(|numbers| numbers.len() == 3);
        let (Some(numbers), false) = (numbers, self.state.in_cycle) else {
            self.fault(
                &statement.span,
                "the step is not three numbers, or is in a cycle",
                POINTS,
            );
            return;
        };
        let by = Vector3::from_fn(|i, _| numbers[i].value * self.unit_mm);
        match self.state.place {
            Some(from) => {
                // A changed GODLTA is written as a position; its text has no absolute numbers yet.
                let text = pose_text(self.index, numbers, Some(f64::NAN));
                self.push(
                    statement,
                    MotionKind::Linear,
                    from + by,
                    TargetSite::Literal(text),
                    None,
                );
            }
            None => self.unknown(statement, "where its step begins is not known"),
        }
    }

    pub fn home(&mut self, statement: &Statement) {
        let stated = self.numbers(statement).filter(|numbers| numbers.len() == 3);
        match stated {
            Some(numbers) => {
                let place = Vector3::from_fn(|i, _| numbers[i].value * self.unit_mm);
                let text = pose_text(self.index, numbers, None);
                self.push(
                    statement,
                    MotionKind::Linear,
                    place,
                    TargetSite::Literal(text),
                    None,
                );
            }
            None => self.unknown(statement, "where home is, the file does not say"),
        }
    }

    pub fn from(&mut self, statement: &Statement) {
        self.state.place = self.pose(statement).map(|(_, place)| place);
        self.state.last = None;
    }

    pub fn circle(&mut self, statement: &Statement) {
        match Circle::of(self.file, statement, self.dialect, self.unit_mm) {
            Ok(circle) => self.state.circle = Some(circle),
            Err(reason) => self.fault(&statement.span, reason, self.dialect.points()),
        }
    }

    /// A CIRCLE that no GOTO follows.
    pub fn end_circle(&mut self) {
        if let Some(circle) = self.state.circle.take() {
            self.fault(&circle.span, "no GOTO follows that ends the arc", POINTS);
        }
    }

    /// A motion whose end or way is not known: refused, or left as it is written.
    pub fn unknown(&mut self, statement: &Statement, reason: &'static str) {
        self.unknown_with(statement, reason, LEAVE, None);
    }

    fn unknown_with(
        &mut self,
        statement: &Statement,
        reason: &'static str,
        remedy: &'static str,
        circle: Option<&Circle>,
    ) {
        if self.program.options.unknown_targets == UnknownTargets::Refused {
            let span = circle.map_or(&statement.span, |circle| &circle.span);
            self.fault(&span.clone(), reason, remedy);
            self.state.rapid = None;
            self.state.place = None;
            return;
        }
        self.finding(
            &statement.span,
            format!("it stays as it is written: {reason}"),
        );
        let site = TargetSite::Fixed("its end or its way is not known");
        self.push(
            statement,
            MotionKind::Linear,
            Vector3::zeros(),
            site,
            circle,
        );
        if let Some(motion) = self.program.motions.last_mut() {
            motion.target = Target::Unknown {
                reason: reason.to_owned(),
            };
        }
        self.state.place = None;
    }

    /// The feed in force; one by turns of the spindle is known while those are.
    fn feed(&self) -> Speed {
        let mut feed = self.state.feed.clone();
        let turns = self.state.spindle.rpm().filter(|rpm| *rpm > 0.0);
        let by_turns = self.state.mm_per_turn.zip(turns);
        if let Some((mm_per_turn, rpm)) = by_turns {
            feed.mm_per_s = Some(mm_per_turn * rpm / 60.0);
        }
        feed
    }

    fn push(
        &mut self,
        statement: &Statement,
        kind: MotionKind,
        place: Vector3<f64>,
        target: TargetSite,
        circle: Option<&Circle>,
    ) {
        let axis = self.state.axis;
        let orientation = OrientationText::Axis.rotation_of(axis.as_slice());
        let target_span = match &target {
            TargetSite::Literal(text) => text.whole.clone(),
            _ => statement.arguments.clone(),
        };
        let speed = match self.state.rapid.take() {
            Some(span) => Speed {
                mm_per_s: None,
                text: String::from_utf8_lossy(self.file.part(&span)).into_owned(),
            },
            None => self.feed(),
        };
        let arc_lines = circle.map(|circle| {
            let fixed =
                TargetSite::Fixed("an arc with other ends is none about its written centre");
            (circle.lines.clone(), fixed)
        });
        self.program.motions.push(Motion {
            file: self.index,
            line: self.file.line_of(statement.span.start),
            span: statement.span.clone(),
            kind,
            target: Target::Pose(PoseTarget {
                position_mm: place,
                orientation: orientation.unwrap_or_else(UnitQuaternion::identity),
                configuration: Configuration::default(),
                external: Vec::new(),
            }),
            speed,
            zone: Zone::Unstated,
            tool: frame_use(&self.program.frames, &self.state.tool),
            work_object: work_object(&self.program.frames, self.state.system.as_ref()),
            runs: match self.state.has_ended {
                true => Runs::Elsewhere,
                false => Runs::Once,
            },
            follows: self.state.last,
            site: MotionSite {
                keyword: statement.word.clone(),
                target_span,
                target,
                via: arc_lines,
                speed: None,
                zone: None,
                external: Vec::new(),
                other_speeds: None,
                external_moved_behind: false,
                indivisible: None,
                turns_otherwise: None,
            },
        });
        self.state.place = Some(place);
        self.state.last = Some(self.program.motions.len() - 1);
    }
}
