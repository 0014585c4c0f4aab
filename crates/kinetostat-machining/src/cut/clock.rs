//! When each move of a program is made, or where it lies along the program's cuts.

use kinetostat_program::{Knowledge, Move, MoveKind, Path, PauseKind};
use serde::{Deserialize, Serialize};

use crate::cut::finding::CutFailure;

/// Unit of the P of a dwell (G4).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum DwellUnit {
    /// Seconds, as with LinuxCNC.
    #[serde(rename = "s")]
    Seconds,
    /// Milliseconds, as with Fanuc.
    #[serde(rename = "ms")]
    Milliseconds,
}

/// Times that a program does not state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timing {
    pub rapid_mm_per_minute: Option<f64>,
    pub rpm: Option<f64>,
    pub dwell_unit: Option<DwellUnit>,
}

/// Interval of each move: from and to, in s or mm, the first cut beginning at 0.
#[derive(Debug)]
pub(crate) struct Clock {
    pub spans: Vec<[f64; 2]>,
    /// Indices of moves behind the first cut and before the last whose way is not known.
    pub unknown: Vec<usize>,
    /// Pauses between them of which nobody knows how long they take, with their lines.
    pub pauses: Vec<(usize, PauseKind)>,
}

/// A feed move whose place is known.
pub(crate) fn cuts(motion: &Move) -> bool {
    motion.is_known_feed() && motion.has_length()
}

impl Clock {
    /// Time of each move, s: length over feed, and over the speed of rapids, behind the dwells before it; moves whose way is
    /// not known and pauses that last until somebody starts again take none.
    pub fn by_time(path: &Path, timing: &Timing) -> Result<Self, CutFailure> {
        let rapid_mm_per_minute = timing.rapid_mm_per_minute;
        let first = path.moves.iter().position(cuts);
        let last = path.moves.iter().rposition(cuts);
        let between = |i: usize| first.is_some_and(|first| i > first) && Some(i) < last;
        let mut durations = Vec::with_capacity(path.moves.len());
        let mut waits = Vec::with_capacity(path.moves.len());
        let (mut unknown, mut pauses) = (Vec::new(), Vec::new());
        for (i, motion) in path.moves.iter().enumerate() {
            if motion.known != Knowledge::Whole && between(i) {
                unknown.push(i);
            }
            waits.push(match i.checked_sub(1).filter(|_| between(i)) {
                Some(before) => {
                    let after_line = path.moves[before].line;
                    let unit = timing.dwell_unit;
                    wait(path, after_line, motion.line, unit, &mut pauses)?
                }
                None => 0.0,
            });
            let timed = motion.known == Knowledge::Whole && motion.has_length();
            let speed = match (timed, motion.kind) {
                (false, _) => None,
                (true, MoveKind::Feed) => Some(feed(path, motion, timing.rpm)?),
                (true, MoveKind::Rapid) if rapid_mm_per_minute.is_none() && between(i) => {
                    return Err(CutFailure::Missing {
                        line: motion.line,
                        what: "how long a rapid takes is not known",
                        help: "give the speed of rapids (rapid_mm_per_min)",
                    });
                }
                (true, MoveKind::Rapid) => rapid_mm_per_minute,
            };
            durations.push(speed.map_or(0.0, |speed| 60.0 * motion.length_mm() / speed));
        }
        Ok(Self {
            spans: spans(&durations, &waits, first),
            unknown,
            pauses,
        })
    }

    /// Length along the cuts up to and behind each move, mm.
    pub fn by_length(path: &Path) -> Self {
        let length = |m: &Move| if cuts(m) { m.length_mm() } else { 0.0 };
        let lengths: Vec<f64> = path.moves.iter().map(length).collect();
        Self {
            spans: spans(&lengths, &[], Some(0)),
            unknown: Vec::new(),
            pauses: Vec::new(),
        }
    }

    /// Activity from the first cut to the last: 1 in feed moves, 0 between them.
    pub fn activity(&self, path: &Path) -> Vec<[f64; 2]> {
        let mut points: Vec<[f64; 2]> = Vec::new();
        let moves = path.moves.iter().zip(&self.spans);
        for (_, [from, to]) in moves.filter(|(motion, _)| cuts(motion)) {
            match points.last_mut() {
                Some(last) if last[0] == *from => last[0] = *to,
                before => {
                    if let Some([at, _]) = before.copied() {
                        points.extend([[at, 0.0], [*from, 0.0]]);
                    }
                    points.extend([[*from, 1.0], [*to, 1.0]]);
                }
            }
        }
        points
    }
}

/// Time between the blocks of two moves that dwells take, s; pauses of which nobody knows the time are listed.
fn wait(
    path: &Path,
    after_line: usize,
    before_line: usize,
    unit: Option<DwellUnit>,
    unknown: &mut Vec<(usize, PauseKind)>,
) -> Result<f64, CutFailure> {
    let mut seconds = 0.0;
    for pause in path.pauses_between(after_line, before_line + 1) {
        match (pause.kind, unit) {
            (PauseKind::DwellSeconds(stated), _)
            | (PauseKind::Dwell(stated), Some(DwellUnit::Seconds)) => seconds += stated,
            (PauseKind::Dwell(stated), Some(DwellUnit::Milliseconds)) => seconds += 1e-3 * stated,
            (PauseKind::Dwell(_), None) => {
                return Err(CutFailure::Missing {
                    line: pause.line,
                    what: "how long a dwell takes is not known: its P counts seconds on some controllers and milliseconds on others",
                    help: "say which (dwell_unit = \"s\" or \"ms\")",
                });
            }
            (kind, _) => unknown.push((pause.line, kind)),
        }
    }
    Ok(seconds)
}

/// Spans that follow each other with what is waited before each, that of the move `zero` beginning at 0.
fn spans(sizes: &[f64], waits: &[f64], zero: Option<usize>) -> Vec<[f64; 2]> {
    let before: f64 = sizes.iter().take(zero.unwrap_or(0)).sum();
    let mut at = -before;
    let mut next = |(size, wait): (&f64, f64)| {
        let from = at + wait;
        at = from + size;
        [from, at]
    };
    let waits = waits.iter().copied().chain(std::iter::repeat(0.0));
    let mut all: Vec<[f64; 2]> = sizes.iter().zip(waits).map(&mut next).collect();
    if let Some(first) = zero.and_then(|zero| all.get_mut(zero)) {
        first[0] = 0.0;
    }
    all
}

/// Speed of a feed move, mm/min.
fn feed(path: &Path, motion: &Move, rpm: Option<f64>) -> Result<f64, CutFailure> {
    let line = motion.line;
    let missing = |what, help| CutFailure::Missing { line, what, help };
    let rpm = rpm.or_else(|| path.spindle_on(line).rpm());
    let speed = match motion.feed.map(|feed| feed.mode) {
        Some(kinetostat_program::FeedMode::PerRevolution) => {
            let rpm = rpm.filter(|rpm| *rpm > 0.0).ok_or_else(|| {
                missing(
                    "the feed counts by revolutions (G95), and no speed of the spindle is known (S with G97)",
                    "add the S word to the program",
                )
            })?;
            motion.feed_mm_per_minute(rpm)
        }
        _ => motion.feed_mm_per_minute(0.0),
    };
    speed.filter(|speed| *speed > 0.0).ok_or_else(|| {
        missing(
            "how long a feed move takes is not known (F)",
            "add the F word to the program",
        )
    })
}

/// The longest revolution of the spindle in a cut, s, or the longest way in one, mm.
pub(crate) fn longest_revolution(
    path: &Path,
    rpm: Option<f64>,
    size: impl Fn(&Move, f64) -> Option<f64>,
) -> Option<f64> {
    let sizes = path.moves.iter().filter(|m| cuts(m)).filter_map(|motion| {
        let rpm = rpm.or_else(|| path.spindle_on(motion.line).rpm());
        size(motion, rpm.filter(|rpm| *rpm > 0.0)?)
    });
    sizes.reduce(|a, b| if b > a { b } else { a })
}
