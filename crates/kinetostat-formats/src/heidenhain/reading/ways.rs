//! Kinds of path blocks: to a position, back along the tool, to a machine position.

use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector3};

use crate::heidenhain::arcs::XY;
use crate::heidenhain::blocks::Block;
use crate::heidenhain::datum::Bend;
use crate::heidenhain::ends::{Ends, Went};
use crate::heidenhain::path_words::{FeedWord, PathWords};
use crate::heidenhain::reading::motions::{Carried, MotionEnd, UNSTATED};
use crate::heidenhain::reading::walker::Reader;
use crate::heidenhain::state::Stands;
use crate::heidenhain::words::Word;
use crate::model::motion::MotionKind;
use crate::model::orientation::OrientationText;
use crate::model::site::{PoseText, TargetSite};
use crate::model::target::{Configuration, PoseTarget, Target};
use crate::text::number::{NumberText, Width};

/// Effects of the functions of a block.
#[derive(Debug, Default)]
pub(crate) struct Acts {
    pub ends: bool,
    pub machine: bool,
    pub retracts: bool,
    pub calls: bool,
}

impl Reader<'_> {
    /// Decodes the movement of a block.
    pub(crate) fn moved(
        &mut self,
        block: &Block,
        words: &[Word],
        parsed: &PathWords,
        turns: bool,
        span: &Range<usize>,
        acts: &Acts,
    ) {
        let rapid = parsed.feed == FeedWord::Max;
        if acts.retracts {
            self.unknown(
                block,
                words,
                span,
                "the tool goes back along its axis",
                Carried::Yes,
            );
            self.state.place[self.state.plane.0] = None;
            for axis in 0..3 {
                if parsed.axes[axis].is_some() {
                    self.state.place[axis] = None;
                }
            }
            self.state.direction = None;
            return;
        }
        if !parsed.moves() && turns && !acts.machine && !self.state.tip.on {
            self.turn_alone(span, rapid);
        }
        let moves = parsed.moves() || turns && !acts.machine && self.state.tip.on;
        if !moves {
            if acts.calls {
                let place = self.state.counts_from();
                self.called(block, words, span, place);
            }
            return;
        }
        if acts.machine {
            self.unknown(
                block,
                words,
                span,
                "its places are those of the machine",
                Carried::Yes,
            );
            for axis in 0..3 {
                let by_angle = parsed.radius.is_some() || parsed.angle.is_some();
                if parsed.axes[axis].is_some() || by_angle {
                    self.state.place[axis] = None;
                }
            }
            self.state.direction = None;
            return;
        }
        if let [Some(x), Some(y), Some(z)] = parsed.axis {
            let axis = Vector3::new(x, y, z);
            match OrientationText::Axis.rotation_of(axis.as_slice()) {
                Some(_) => {
                    (self.state.axis, self.state.directed) = (axis, true);
                    self.state.standing.take_direction_instead();
                    self.state.tilt.stands = Stands::AsWords;
                }
                None => self.fault(span, "the tool's axis has not the length 1", "mend it"),
            }
        }
        if self.no_place_by_plane(span, rapid) || self.no_place_by_axes(span, rapid) {
            self.unknown(
                block,
                words,
                span,
                "its places are not those of the tool's tip in the part",
                Carried::Yes,
            );
            self.state.place = [None; 3];
            self.state.direction = None;
            return;
        }
        let mut ends = Ends {
            state: &mut self.state,
            unit_mm: self.unit_mm,
        };
        match ends.of(words, parsed) {
            Ok(went) if acts.calls => self.called(block, words, span, went.end),
            Ok(went) => self.goes(block, words, span, &went, rapid),
            Err((reason, remedy)) => {
                self.fault(span, reason, remedy);
                self.state.lost();
            }
        }
    }

    /// The motion of a block whose end is known as far as its words say it.
    fn goes(
        &mut self,
        block: &Block,
        words: &[Word],
        span: &Range<usize>,
        went: &Went,
        rapid: bool,
    ) {
        let start = self.state.place;
        let [x, y, z] = went.end;
        let whole = x.zip(y).zip(z).map(|((x, y), z)| Vector3::new(x, y, z));
        let is_arc = went.arc.is_some();
        let plane = went.plane;
        let Some(place) = whole.filter(|_| !is_arc || start[plane.0].is_some()) else {
            let reason = match self.state.unstated {
                true => UNSTATED,
                false => "where the tool is, is not wholly known here",
            };
            // A cut that was refused for its axes says nothing of its place.
            let carried = match rapid || self.state.standing.is_refused() {
                true => Carried::Yes,
                false => Carried::IfLeft,
            };
            self.unknown(block, words, span, reason, carried);
            self.ends_at(went.end);
            self.state.place = went.end;
            self.state.direction = None;
            return;
        };
        self.state.unstated = false;
        let datum = self.state.datum;
        let kind = match &went.arc {
            Some(arc) => MotionKind::Arc {
                centre_mm: datum
                    .preset(&plane.place(arc.centre, start[plane.0].unwrap_or(place[plane.0]))),
                axis: datum.direction(&plane.across()),
                angle_rad: arc.angle * datum.sense(),
            },
            None => MotionKind::Linear,
        };
        let from = start.map(|at| at.unwrap_or(f64::NAN));
        self.state.direction = match &went.arc {
            Some(arc) => arc.last_direction(&plane.flat(&place)).map(|way| {
                let rise = place[plane.0] - from[plane.0];
                plane.place(
                    way * (plane.flat(&place) - arc.centre).norm() * arc.angle.abs(),
                    rise,
                )
            }),
            None => Some(place - Vector3::from(from)),
        };
        let axis = datum.direction(&self.state.axis);
        let orientation = OrientationText::Axis.rotation_of(axis.as_slice());
        let text = PoseText {
            file: self.index,
            whole: span.clone(),
            position: [0, 1, 2].map(|i| NumberText {
                span: span.start..span.start,
                value: place[i],
            }),
            orientation: Vec::new(),
            unit_mm: 1.0,
            convention: match self.state.directed {
                true => OrientationText::Axis,
                false if self.state.plane != XY || self.state.axis != Vector3::z() => {
                    OrientationText::Axis
                }
                false if matches!(datum.bend, Bend::Tilt(_)) => OrientationText::Axis,
                false => OrientationText::Unstated,
            },
            external: Vec::new(),
            width: Width::Free,
        };
        let target = Target::Pose(PoseTarget {
            position_mm: datum.preset(&place),
            orientation: orientation.unwrap_or_else(UnitQuaternion::identity),
            configuration: Configuration::default(),
            external: Vec::new(),
        });
        let end = MotionEnd {
            target,
            site: TargetSite::Literal(text),
            shape: went.shape,
            end: went.end,
        };
        self.push(block, words, span, kind, end, rapid);
        if self.has_corners {
            self.line_went(block, words, went, place, rapid);
        }
        self.state.place = went.end;
    }
}
