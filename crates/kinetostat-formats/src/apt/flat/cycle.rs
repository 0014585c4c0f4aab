//! Decoding of CYCLE (`CYCLE/DRILL,DEPTH,10,MMPM,150,CLEAR,3`, `CYCLE/DRILL,RAPTO,3,FEDTO,-10,RTRCTO,AUTO,MMPM,250`), and the motions of one
//! hole.
//!
//! Depth, feed and clearance are numbers in this order where no word names them [ISO 4343, CYCLE; the postprocessors of Autodesk
//! and the CLSF of Siemens NX name them]. Lengths count from the place of a GOTO along the tool's axis.

use kinetostat_program::{Spindle, SpindleRotation};
use nalgebra::Vector3;

use crate::apt::lines::{Argument, Statement, arguments_of};
use crate::apt::table::Dialect;
use crate::extreme::{larger, smaller};
use crate::text::source::SourceFile;

/// Retraction from a hole, and the action at its bottom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Rapid retraction: DRILL, FACE, CSINK.
    Drill,
    /// Rapid retraction after each step: DEEP, DEEP2 of SolidWorks CAM.
    Deep,
    /// Rapid retraction, and chip breaking by a short retraction after each step: BRKCHP.
    Break,
    /// Retraction at feed: BORE, REAM.
    Bore,
    /// Retraction at feed with the spindle reversed: TAP.
    Tap,
}

/// Retraction height after a hole, from its place along the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Retract {
    /// End of the rapid approach.
    Clear,
    To(f64),
    /// Tool height before the cycle.
    Auto,
}

/// A cycle; lengths in the unit of the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cycle {
    pub kind: Kind,
    /// Below the place of the hole, above zero.
    pub depth: f64,
    /// The text of its FEDRAT; none where that in force counts.
    pub feed: Option<String>,
    /// End of the rapid approach above the place of the hole.
    pub rapid_to: f64,
    /// The least height between holes.
    pub clear: f64,
    pub retract: Retract,
    /// Seconds, as written.
    pub dwell: Option<String>,
    pub step: Option<f64>,
    /// The first step, where it is another one.
    pub first_step: Option<f64>,
}

/// Reason and remedy of a cycle that is not followed.
pub(crate) type Wrong = (String, &'static str);

const POINTS: &str = "let the CAM system write its motions as points (GOTO)";

/// Effect of a CYCLE statement.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Said {
    Off,
    On(Result<Cycle, Wrong>),
}

fn wrong<T>(reason: impl Into<String>, remedy: &'static str) -> Result<T, Wrong> {
    Err((reason.into(), remedy))
}

/// Words and numbers of a cycle.
#[derive(Default)]
struct Words {
    kind: Option<Kind>,
    /// Numbers that no word names.
    bare: Vec<(f64, String)>,
    depth: Option<f64>,
    /// FEDTO of NX counts upwards.
    fedto: Option<f64>,
    clear: Option<f64>,
    rapid_to: Option<f64>,
    retract: Option<Retract>,
    dwell: Option<String>,
    step: Option<f64>,
    first_step: Option<f64>,
    unit: Option<String>,
    unit_is_last: bool,
}

/// Decodes a CYCLE statement of a file.
pub(crate) fn said(file: &SourceFile, statement: &Statement, dialect: Dialect) -> Said {
    let arguments = arguments_of(file.bytes(), &statement.arguments);
    let text = |argument: &Argument| match argument {
        Argument::Number(number) => String::from_utf8_lossy(file.part(&number.span))
            .trim()
            .to_owned(),
        Argument::Word(word) => String::from_utf8_lossy(file.part(word)).to_ascii_uppercase(),
    };
    let texts: Vec<(String, Option<f64>)> = arguments
        .iter()
        .map(|argument| (text(argument), argument.number().map(|number| number.value)))
        .collect();
    if matches!(texts.first(), Some((word, _)) if matches!(word.as_str(), "OFF" | "INIT" | "NOMORE"))
    {
        return Said::Off;
    }
    Said::On(words_of(&texts).and_then(|words| words.cycle(dialect)))
}

fn words_of(texts: &[(String, Option<f64>)]) -> Result<Words, Wrong> {
    let mut words = Words::default();
    let mut rest = texts.iter().peekable();
    while let Some((word, number)) = rest.next() {
        if let Some(number) = number {
            words.bare.push((*number, word.clone()));
            words.unit_is_last = false;
            continue;
        }
        let mut value = || {
            let value = rest.next_if(|(_, number)| number.is_some());
            let value = value.and_then(|(text, number)| Some(((*number)?, text.clone())));
            value.ok_or((format!("no number stands behind {word}"), "state it"))
        };
        let kind = match word.as_str() {
            "DRILL" | "FACE" | "CSINK" => Some(Kind::Drill),
            "DEEP" | "DEEP2" => Some(Kind::Deep),
            "BRKCHP" => Some(Kind::Break),
            "BORE" | "REAM" => Some(Kind::Bore),
            "TAP" => Some(Kind::Tap),
            _ => None,
        };
        match (kind, word.as_str()) {
            // `DRILL,DEEP`: the second says more.
            (Some(kind), _) if matches!(words.kind, None | Some(Kind::Drill)) => {
                words.kind = Some(kind)
            }
            (_, "DEPTH") => words.depth = Some(value()?.0),
            (_, "FEDTO") => words.fedto = Some(value()?.0),
            (_, "CLEAR") => words.clear = Some(value()?.0),
            (_, "RAPTO") => words.rapid_to = Some(value()?.0),
            (_, "RTRCTO" | "RETURN") => {
                let auto = rest.next_if(|(word, _)| word == "AUTO").is_some();
                words.retract = Some(match auto {
                    true => Retract::Auto,
                    false => {
                        let height = rest.next_if(|(_, number)| number.is_some());
                        let height = height.and_then(|(_, number)| *number);
                        Retract::To(height.ok_or((
                            format!("no height stands behind {word}"),
                            "state it, or AUTO",
                        ))?)
                    }
                });
            }
            (_, "DWELL") => words.dwell = Some(value()?.1),
            (_, "1STPECK") => words.first_step = Some(value()?.0),
            (_, "STEP" | "INCR" | "PECK" | "SUBPECK") => words.step = Some(value()?.0),
            (_, "MMPM" | "IPM" | "MMPR" | "IPR" | "PERMIN" | "PERREV") => {
                words.unit = Some(word.clone());
                words.unit_is_last = true;
            }
            (_, "") => {}
            _ => {
                return wrong(
                    format!("what {word} says of the cycle is not followed"),
                    POINTS,
                );
            }
        }
    }
    Ok(words)
}

impl Words {
    fn cycle(self, dialect: Dialect) -> Result<Cycle, Wrong> {
        let Some(kind) = self.kind else {
            return wrong(
                "which cycle it is, is not known",
                "state one of DRILL, FACE, DEEP, BRKCHP, BORE, REAM, TAP; others are not followed",
            );
        };
        // The PP table of CATIA's machine defines the order of the numbers.
        if dialect == Dialect::Catia && self.bare.len() > 1 {
            return wrong(
                "which of its numbers are depth, feed and clearance, a table of CATIA says",
                "let the postprocessor table name them: DEPTH, CLEAR, and the unit before the feed",
            );
        }
        let mut bare = self.bare.into_iter();
        let depth = match (self.depth, self.fedto) {
            (Some(depth), None) => depth.abs(),
            (None, Some(to)) if dialect == Dialect::Nx && to > 0.0 => {
                return wrong(
                    "FEDTO lies above the place of the hole",
                    "state it below zero",
                );
            }
            (None, Some(to)) => to.abs(),
            (Some(_), Some(_)) => return wrong("DEPTH and FEDTO both state its depth", "keep one"),
            (None, None) => bare.next().map_or(0.0, |(depth, _)| depth.abs()),
        };
        if depth <= 0.0 {
            return wrong("its depth is not stated, or zero", "state DEPTH or FEDTO");
        }
        let feed = bare.next();
        if feed.as_ref().is_some_and(|(feed, _)| *feed <= 0.0) {
            return wrong("its feed is not above zero", "state one");
        }
        let feed = feed.map(|(_, feed)| match &self.unit {
            Some(unit) => format!("FEDRAT/{feed},{unit}"),
            None => format!("FEDRAT/{feed}"),
        });
        let clear = self.clear.or_else(|| bare.next().map(|(clear, _)| clear));
        if bare.next().is_some() {
            return wrong(
                "it has more numbers than depth, feed and clearance",
                "name them: DEPTH, CLEAR, RAPTO, STEP, DWELL",
            );
        }
        let Some(rapid_to) = self.rapid_to.or(clear) else {
            return wrong(
                "where the rapid to the hole ends, is not stated",
                "state CLEAR or RAPTO",
            );
        };
        if rapid_to <= -depth {
            return wrong(
                "its rapid ends below its depth",
                "correct RAPTO, or the depth",
            );
        }
        let clear = larger(clear.unwrap_or(rapid_to), rapid_to);
        let in_steps = matches!(kind, Kind::Deep | Kind::Break);
        let is_none = |step: f64| step <= 0.0;
        if in_steps && (self.step.is_none_or(is_none) || self.first_step.is_some_and(is_none)) {
            return wrong("by which steps it drills, is not stated", "state STEP");
        }
        Ok(Cycle {
            kind,
            depth,
            feed,
            rapid_to,
            clear,
            retract: self.retract.unwrap_or(Retract::Clear),
            dwell: self.dwell,
            step: self.step.filter(|_| in_steps),
            first_step: self.first_step,
        })
    }
}

/// Limit of the steps of one hole.
const MOST_STEPS: usize = 10_000;

/// Approach distance above the last step, and retraction of BRKCHP, mm; no word states it.
const BACK_MM: f64 = 1.0;

/// Heights nearer than this are one, in units of the file.
const SAME: f64 = 1e-9;

/// A part of a hole as it is written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Part {
    Rapid(Vector3<f64>),
    Feed(Vector3<f64>),
    Text(String),
}

/// A hole: its place and the tool's axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hole {
    pub at: Vector3<f64>,
    pub axis: Vector3<f64>,
    pub unit_mm: f64,
}

impl Hole {
    fn height(&self, place: &Vector3<f64>) -> f64 {
        (place - self.at).dot(&self.axis)
    }

    fn above(&self, height: f64) -> Vector3<f64> {
        self.at + self.axis * height
    }

    /// Motions of a hole at a place, if that is known; `began` is the tool position before the cycle.
    pub(crate) fn parts(
        &self,
        cycle: &Cycle,
        from: Option<Vector3<f64>>,
        began: Option<Vector3<f64>>,
        spindle: &Spindle,
    ) -> Result<Vec<Part>, Wrong> {
        let mut parts = Vec::new();
        let level = cycle.rapid_to;
        if let Some(from) = from {
            // Across above what lies between, and down along the axis.
            let comes = self.height(&from);
            let across = comes.max(cycle.clear).max(0.0);
            if comes < across - SAME {
                parts.push(Part::Rapid(from + self.axis * (across - comes)));
            }
            if across > level + SAME {
                parts.push(Part::Rapid(self.above(across)));
            }
        }
        parts.push(Part::Rapid(self.above(level)));
        parts.extend(self.down(cycle)?);
        if let Some(dwell) = &cycle.dwell {
            parts.push(Part::Text(format!("DELAY/{dwell}")));
        }
        let out = match cycle.retract {
            Retract::Clear => cycle.clear,
            Retract::To(height) => height.max(cycle.clear),
            Retract::Auto => {
                let began = began.map(|place| self.height(&place));
                let began = began.ok_or((
                    "where the tool was before the cycle is not known, and RTRCTO,AUTO goes back to that height".to_owned(),
                    "state the height, or a place before the cycle",
                ))?;
                began.max(cycle.clear)
            }
        };
        match cycle.kind {
            Kind::Drill | Kind::Deep | Kind::Break => parts.push(Part::Rapid(self.above(out))),
            Kind::Bore => {
                parts.push(Part::Feed(self.above(level)));
                if out > level + SAME {
                    parts.push(Part::Rapid(self.above(out)));
                }
            }
            Kind::Tap => {
                let [own, other] = turning(spindle)?;
                parts.push(Part::Text(other));
                parts.push(Part::Feed(self.above(level)));
                parts.push(Part::Text(own));
                if out > level + SAME {
                    parts.push(Part::Rapid(self.above(out)));
                }
            }
        }
        Ok(parts)
    }

    fn down(&self, cycle: &Cycle) -> Result<Vec<Part>, Wrong> {
        let bottom = || Part::Feed(self.above(-cycle.depth));
        let Some(step) = cycle.step else {
            return Ok(vec![bottom()]);
        };
        let first = cycle.first_step.unwrap_or(step);
        let count = ((cycle.depth - first) / step - SAME).ceil() + 1.0;
        if !count.is_finite() || count >= MOST_STEPS as f64 {
            return Err((
                "the hole has more than 10 000 steps".to_owned(),
                "state a larger STEP",
            ));
        }
        let back = smaller(BACK_MM / self.unit_mm, 0.5 * smaller(step, first));
        let mut parts = Vec::new();
        for index in 1..larger(count, 1.0) as usize {
            let depth = first + step * (index - 1) as f64;
            parts.push(Part::Feed(self.above(-depth)));
            if cycle.kind == Kind::Deep {
                parts.push(Part::Rapid(self.above(cycle.rapid_to)));
            }
            parts.push(Part::Rapid(self.above(back - depth)));
        }
        parts.push(bottom());
        Ok(parts)
    }
}

/// SPINDL as it turns, and the other way round.
fn turning(spindle: &Spindle) -> Result<[String; 2], Wrong> {
    let senses = match spindle.rotation {
        SpindleRotation::Clockwise => Some(["CLW", "CCLW"]),
        SpindleRotation::CounterClockwise => Some(["CCLW", "CLW"]),
        SpindleRotation::Stopped => None,
    };
    let (Some(senses), Some(rpm)) = (senses, spindle.rpm()) else {
        return Err((
            "a tap turns back at the bottom, and how the spindle turns is not stated".to_owned(),
            "state SPINDL with its speed and CLW or CCLW before it",
        ));
    };
    Ok(senses.map(|sense| format!("SPINDL/{rpm},RPM,{sense}")))
}
