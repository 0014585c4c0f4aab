//! State of the writer on its way through the motions, and the feed of a written block.

use nalgebra::{Vector2, Vector3};

use crate::heidenhain::arcs::Plane;
use crate::heidenhain::path_words::FeedWord;
use crate::heidenhain::reading::walker::Way;
use crate::heidenhain::words::{Word, decimals};
use crate::heidenhain::writing::words::{Stated, before_functions, feed_text};
use crate::model::program::RobotProgram;
use crate::options::WriteOptions;
use crate::text::source::Edits;
use crate::turned_axis::CountShown;

/// Reason and remedy of a motion that cannot be written.
pub(crate) type Reason = (String, &'static str);

/// A pole of the writer's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OwnPole {
    pub plane: Plane,
    /// Pole position in the plane, in the programmed axes, mm.
    pub at: Vector2<f64>,
    /// Number of CC blocks that ran before it.
    pub count: usize,
}

/// The walk over the motions.
pub(crate) struct Writer<'w> {
    pub program: &'w RobotProgram,
    /// Evidence in the program for the way in which rotary axes count.
    pub shown: Vec<CountShown>,
    pub options: &'w WriteOptions,
    pub edits: Vec<Edits>,
    /// True by file if positive numbers have a sign.
    pub signs: Vec<bool>,
    /// True by file if blocks were added.
    pub added: Vec<bool>,
    /// Tool offset of the written blocks from the input; in the preset's axes, mm.
    pub off: Vector3<f64>,
    /// The feed that the written blocks leave behind, where it is another one.
    pub feed: Option<f64>,
    /// A pole of the writer's own that is in force, or would be behind CC blocks that need one from before.
    pub pole: Option<OwnPole>,
    /// Tool direction if it differs from the program; in the preset's axes.
    pub axis: Option<Vector3<f64>>,
    /// Deviation of the rotary axes from the program, and their positions within a motion, deg.
    pub turned_deg: Vec<f64>,
    pub angles_now: Vec<f64>,
    /// A polar block was written by X and Y: those behind it have no last radius.
    pub polar_broken: bool,
    /// True for each motion whose end is displaced in the written blocks.
    pub off_at: Vec<bool>,
    /// True for each motion that is changed.
    pub changed: Vec<bool>,
    pub file: usize,
}

/// Threshold of a difference of position, mm.
pub(crate) const SAME_MM: f64 = 1e-9;

pub(crate) const ABOUT_CENTRE: &str =
    "a piece goes through a place between its ends, and circles are written about centres";

impl Writer<'_> {
    /// Half of the last digit, mm.
    pub(crate) fn half_mm(&self, way: &Way) -> f64 {
        0.5 * 10.0_f64.powi(-(self.decimals(way) as i32)) * way.unit_mm
    }

    pub(crate) fn decimals(&self, way: &Way) -> usize {
        // Equal resolution in inches.
        let more = match way.unit_mm == 1.0 {
            true => 0,
            false => 2,
        };
        (self.options.position_decimals + more).min(decimals(way.unit_mm))
    }

    /// Axes that a block states as it did are where they were.
    pub(crate) fn stated_again(&mut self, way: &Way, stated: &Stated) {
        let mut off = way.datum.step(&self.off);
        for axis in 0..3 {
            if stated.absolute[axis] {
                off[axis] = 0.0;
            }
        }
        self.off = way.datum.preset(&off) - way.datum.shift_mm;
    }

    /// The feed of a piece, where it is not the one in force.
    pub(crate) fn write_feed(&mut self, way: &Way, words: &[Word], factor: f64, edits: &mut Edits) {
        let stated = Stated::of(words).feed;
        let Some(own) = way.feed else {
            if matches!(stated, FeedWord::Auto | FeedWord::Other) {
                self.feed = None;
            }
            return;
        };
        let wanted = own * factor;
        let changed = (factor - 1.0).abs() > 1e-12;
        match stated {
            FeedWord::Number(at, _) => {
                if let (true, Some(number)) = (changed, words[at].number()) {
                    edits.replace(number.span.clone(), feed_text(wanted));
                }
                self.feed = changed.then_some(wanted);
            }
            FeedWord::Max | FeedWord::Other => {}
            FeedWord::Auto | FeedWord::None => {
                let in_force = match stated {
                    FeedWord::Auto => own,
                    _ => self.feed.unwrap_or(own),
                };
                if in_force == wanted {
                    if stated == FeedWord::Auto {
                        self.feed = None;
                    }
                    return;
                }
                let text = format!("F{}", feed_text(wanted));
                let auto = words.iter().find(|word| word.is("FAUTO"));
                let f = words.iter().position(|word| word.is("F"));
                match (auto, f) {
                    (Some(word), _) => edits.replace(word.span.clone(), text),
                    (None, Some(at)) => {
                        let end = words.get(at + 1).map_or(words[at].span.end, |w| w.span.end);
                        edits.replace(words[at].span.start..end, text);
                    }
                    (None, None) => {
                        let at = before_functions(words);
                        edits.replace(at..at, format!(" {text}"));
                    }
                }
                self.feed = changed.then_some(wanted);
            }
        }
    }
}
