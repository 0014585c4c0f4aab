//! Marks of a program, apart from the targets of its moves, in one form for all languages.

use std::collections::BTreeMap;
use std::fmt;

use kinetostat_formats::{FrameUse, Zone};
use kinetostat_program::Path;
use nalgebra::Vector3;

use crate::job::robot::frame_distance::distance;
use crate::ui::numbers::{number, short, triple};
use crate::verify::other_word::{FaultKind, OTHER_PATH_MODE};

/// Frames nearer to each other than this are one: more digits than controllers write, mm and rad.
const SAME_MM: f64 = 1e-3;
const SAME_RAD: f64 = 5e-6;

/// Kinds of marks. Of those in `IN_FORCE` the last one holds, the others are for the place where they stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    Frame,
    /// Before the first place is known it says where the machine stands, in a frame that it moves.
    Shift,
    Length,
    Radius,
    Tool,
    Edge,
    /// Settings of how motions run, each by its name.
    PathMode,
    /// Approximation at the end of a motion.
    Zone,
    /// Options in the statement of a motion.
    Options,
    /// Number of executions of a motion.
    Runs,
    /// Configuration of the arm.
    Configuration,
    /// A block that a switch of the control leaves out.
    Optional,
    /// Motions of which it is not known where the tool is: by joint values, or to places that are computed.
    Unseen,
    /// Statements of robots behind which somebody has to start again.
    Stop,
    /// Loops that nothing leaves, and programs that begin again.
    Endless,
    /// Overrides of all motions.
    Override,
    /// Statements that name the spindle, by what they call or switch.
    Spindle,
    Other,
}

pub(crate) const IN_FORCE: [Kind; 12] = [
    Kind::Frame,
    Kind::Shift,
    Kind::Length,
    Kind::Radius,
    Kind::Tool,
    Kind::Edge,
    Kind::PathMode,
    Kind::Zone,
    Kind::Options,
    Kind::Runs,
    Kind::Configuration,
    Kind::Optional,
];

/// A call that adds nothing to its tool.
pub(crate) const NOTHING_ADDED: &str = "no DL and DR";

/// The frame of a program that names none.
const NO_FRAME: &str = "no word for a frame";

/// Value of motions that run once.
pub(crate) const ONCE: &str = "statements that run once";
pub(crate) const AGAIN: &str = "statements that run again";

impl Kind {
    /// Value in force without a mark.
    pub(crate) fn usual(self) -> Value<'static> {
        Value::Text(
            match self {
                Self::Frame => NO_FRAME,
                Self::Shift => "no G92 before the first place",
                Self::Length => "G49",
                Self::Radius => "G40",
                Self::PathMode => "what the control is set up for",
                Self::Runs => ONCE,
                Self::Optional => "no /",
                _ => "none",
            }
            .to_owned(),
        )
    }

    pub(crate) fn fault(self) -> Option<FaultKind> {
        match self {
            Self::Frame | Self::Shift => Some(FaultKind::Frame),
            Self::Length | Self::Radius | Self::Tool | Self::Edge => Some(FaultKind::Tool),
            Self::Spindle => Some(FaultKind::Rotation),
            Self::PathMode | Self::Zone | Self::Options => Some(FaultKind::PathMode),
            Self::Runs | Self::Stop | Self::Unseen | Self::Endless => Some(FaultKind::Course),
            Self::Override => Some(FaultKind::Feed),
            Self::Configuration | Self::Optional | Self::Other => None,
        }
    }

    pub(crate) fn follows(self) -> &'static str {
        match self {
            Self::Frame => {
                ": where its origin is not stated (--work-offset), it is not known where the control has this frame"
            }
            Self::Shift => {
                ": before the program has said where the tool is, it shifts the frame by what the control knows"
            }
            Self::Length => ": the control moves the tool by what its table has there",
            Self::PathMode | Self::Zone | Self::Options => OTHER_PATH_MODE,
            Self::Runs => ": these cuts may not be made, or more than once",
            Self::Stop => ": motions behind it may not be made",
            Self::Endless => ": nothing leaves it, and the motions in it are made again and again",
            Self::Override => ": it changes how fast all motions run",
            Self::Configuration => ": the model stands as in the original",
            Self::Optional => {
                ": where the control is switched to leave such blocks out, they are not made"
            }
            _ => "",
        }
    }
}

/// Value of a mark.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value<'a> {
    Text(String),
    WorkObject(&'a FrameUse),
    Tool(&'a FrameUse),
    Zone(Zone),
}

impl fmt::Display for Value<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(text) => write!(f, "{text}"),
            Self::WorkObject(frame) => write!(f, "work object '{}'", frame.name),
            Self::Tool(frame) => write!(f, "tool '{}'", frame.name),
            Self::Zone(Zone::Exact) => write!(f, "motions that stop at their ends"),
            Self::Zone(Zone::Radius(mm)) => {
                write!(f, "an end that is passed at up to {} mm", short(*mm))
            }
            Self::Zone(Zone::Percent(percent)) => {
                write!(f, "an end that is passed at {} %", short(*percent))
            }
            Self::Zone(Zone::Unstated) => {
                write!(f, "an end that is passed at a distance that is not stated")
            }
        }
    }
}

/// Difference of two values.
pub(crate) struct Apart {
    pub(crate) fault: Option<FaultKind>,
    pub(crate) follows: String,
}

impl Value<'_> {
    /// Compares the value with that of the original; places in frames with stated origins are compared as places.
    pub(crate) fn apart(
        &self,
        of_original: &Self,
        kind: Kind,
        is_stated: &dyn Fn(&str) -> bool,
    ) -> Option<Apart> {
        let (fault, follows) = match (self, of_original) {
            (Self::Text(own), Self::Text(of_original)) => {
                let texts = [own.as_str(), of_original.as_str()];
                (!is_same_text(kind, texts, is_stated)).then(|| {
                    // An exact stop is at least as accurate; the orientation on a circle is in the path.
                    match own.starts_with("G61") || own == "CIRPATHMODE\\OBJECTFRAME" {
                        true => (None, String::new()),
                        false => (kind.fault(), kind.follows().to_owned()),
                    }
                })?
            }
            (
                Self::WorkObject(own) | Self::Tool(own),
                Self::WorkObject(of_original) | Self::Tool(of_original),
            ) => match frames_apart(own, of_original) {
                Some(why) => (kind.fault(), format!(": it {why}")),
                None if is_same_name(&own.name, &of_original.name) => return None,
                None => (None, ": it is at the same place".to_owned()),
            },
            (Self::Zone(own), Self::Zone(of_original)) => {
                if own == of_original {
                    return None;
                }
                match [own, of_original].map(|zone| width(*zone)) {
                    [Some(own), Some(of_original)] if own <= of_original => (None, String::new()),
                    _ => (kind.fault(), kind.follows().to_owned()),
                }
            }
            _ => (kind.fault(), String::new()),
        };
        Some(Apart { fault, follows })
    }
}

fn is_same_text(kind: Kind, [own, of]: [&str; 2], is_stated: &dyn Fn(&str) -> bool) -> bool {
    let both = |is: &dyn Fn(&str) -> bool| is(own) && is(of);
    let first = |word: &str| matches!(word, NO_FRAME | "G54");
    own == of
        || match kind {
            Kind::Frame => both(&first) || both(&|word| word == NO_FRAME || is_stated(word)),
            Kind::Edge => both(&|word| matches!(word, "none" | "D1" | NOTHING_ADDED)),
            // Repeated motions may be written out, one round after the other.
            Kind::Runs => own == ONCE || own == AGAIN && of != ONCE,
            Kind::Optional => own != "/",
            _ => false,
        }
}

/// Width of a zone, in its unit; none if it is unknown.
fn width(zone: Zone) -> Option<f64> {
    match zone {
        Zone::Exact => Some(0.0),
        Zone::Radius(width) | Zone::Percent(width) => Some(width),
        Zone::Unstated => None,
    }
}

/// True for equal names: robots and controls treat `tMill` and `TMILL` as equal, and tools 01 and 1.
fn is_same_name(a: &str, b: &str) -> bool {
    let numbers = [a, b].map(str::parse::<u64>);
    a.eq_ignore_ascii_case(b) || matches!(numbers, [Ok(a), Ok(b)] if a == b)
}

/// Describes the difference of two frames.
fn frames_apart(own: &FrameUse, of_original: &FrameUse) -> Option<String> {
    let (Some(a), Some(b)) = (own.known(), of_original.known()) else {
        let same = is_same_name(&own.name, &of_original.name);
        return (!same).then(|| "is not known where both are".to_owned());
    };
    let [mm, turn] = distance(a, b);
    let shown = |v: &Vector3<f64>| triple([v.x, v.y, v.z], |x| short((1e4 * x).round() / 1e4));
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

/// A value and its place.
#[derive(Clone, Debug)]
pub(crate) struct Mark<'a> {
    pub(crate) line: usize,
    pub(crate) kind: Kind,
    /// The name of a setting, of kinds that have several.
    pub(crate) name: String,
    pub(crate) value: Value<'a>,
    /// Number of moves before it.
    pub(crate) at: usize,
}

/// Interpolation of a move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// Joint interpolation.
    Joints,
    Rapid,
    Feed,
}

/// Marks of a program in the order of its run, and its moves.
pub(crate) struct Marks<'a> {
    pub(crate) all: Vec<Mark<'a>>,
    pub(crate) path: &'a Path,
    pub(crate) ways: Vec<Way>,
    /// For programs that run line by line, the largest line up to each move.
    pub(crate) lines: Vec<usize>,
    /// The last of each kind in force.
    last: BTreeMap<(Kind, String), Value<'a>>,
}

impl<'a> Marks<'a> {
    /// No marks of a path yet.
    pub(crate) fn along(path: &'a Path, way: impl Fn(usize) -> Way) -> Self {
        let lines = path.moves.iter().scan(0, |last: &mut usize, m| {
            *last = (*last).max(m.line);
            Some(*last)
        });
        Self {
            all: Vec::new(),
            path,
            ways: (0..path.moves.len()).map(way).collect(),
            lines: lines.collect(),
            last: BTreeMap::new(),
        }
    }

    /// Number of moves before a line, or up to it (`is_behind`), of a program that runs line by line.
    pub(crate) fn before_line(&self, line: usize, is_behind: bool) -> usize {
        self.lines
            .partition_point(|own| *own < line + usize::from(is_behind))
    }

    /// Adds a mark, of those in force where it says another thing than the last one; those of a kind are added in the order of the run.
    pub(crate) fn add(
        &mut self,
        [at, line]: [usize; 2],
        kind: Kind,
        name: String,
        value: Value<'a>,
    ) {
        if IN_FORCE.contains(&kind) {
            let last = self.last.insert((kind, name.clone()), value.clone());
            if last.is_some_and(|last| last == value) {
                return;
            }
        }
        self.all.push(Mark {
            line,
            kind,
            name,
            value,
            at,
        });
    }

    /// The line of a move.
    pub(crate) fn line_of(&self, index: usize) -> usize {
        self.path.moves.get(index).map_or(1, |m| m.line)
    }
}
