//! Drilling cycles as blocks: CYCLE81 (centering), CYCLE82 (with dwell), CYCLE83 (deep holes). Cycles whose way is the control's own (taps,
//! borings) stay, one call over each hole, between the blocks that lead to them and away.
//!
//! CYCLE83 withdraws within the hole (VARI=0, chips are broken) by G1 at the feed of the program, by 1 mm where _VRT states no other way,
//! and out of the hole (VARI=1) by G0; with DAM = 0 all steps are as long as the first. A depth by DPR goes before one by DP. This is
//! Siemens' SINUMERIK 840D/840Di/810D, Programming Guide Cycles, "Deep hole drilling CYCLE83", from memory: the manual was not at hand,
//! and no public text that quotes it was found. So a note names the lines ([`super::holes`]).

use std::collections::BTreeMap;

use crate::siemens::table::KEPT;
use crate::text::number::in_words;
use crate::text::source::Finding;

/// A cycle with its numbers, along the axis across the plane.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Drilling {
    /// Retraction plane.
    pub retract: f64,
    /// Start of the feed: the reference plane plus the safety clearance.
    pub begin: f64,
    pub surface: f64,
    pub depth: f64,
    /// Dwell at the depth: seconds, or turns if negative.
    pub dwell: f64,
    /// G9 at the depth.
    pub exact: bool,
    pub deep: Option<Deep>,
    /// The call of a cycle that stays, with its numbers.
    pub kept: Option<String>,
}

/// True if a word in capitals is a cycle that drills one hole where it is called.
pub(super) fn is_drilling(word: &[u8]) -> bool {
    matches!(word, b"CYCLE81" | b"CYCLE82" | b"CYCLE83")
        || KEPT.iter().any(|own| own.as_bytes() == word)
}

/// Parameters of CYCLE83.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Deep {
    pub first: f64,
    /// DAM: by how much steps become shorter, or their factor where negative.
    pub shorter: f64,
    pub least: f64,
    /// Dwell between steps, and at the start after each withdrawal.
    pub dwell: f64,
    pub dwell_above: f64,
    /// Feed factor of the first step.
    pub feed_share: f64,
    /// VARI: 1 withdraws out of the hole.
    pub withdraws: bool,
    /// Retraction distance within the hole.
    pub back: f64,
    /// Stop distance before the last depth, if stated.
    pub ahead: f64,
}

/// Limit of the steps of a hole.
const MOST_STEPS: usize = 1000;

/// Lengths that differ by less are equal: the last bits of a sum divide no step.
const SAME: f64 = 1e-9;

impl Drilling {
    /// Depths one after the other.
    pub(super) fn depths(&self, deep: &Deep) -> Option<Vec<f64>> {
        let way = (self.surface - self.depth).signum();
        let step = (self.surface - deep.first).abs();
        let (shorter, least) = match deep.shorter == 0.0 {
            true => (-1.0, step),
            false => (deep.shorter, deep.least),
        };
        let (mut length, mut now) = (step, deep.first);
        let mut found = vec![now];
        while now != self.depth {
            if found.len() >= MOST_STEPS {
                return None;
            }
            let left = (now - self.depth).abs();
            let half = now - way * 0.5 * left;
            now = if shorter < 0.0 {
                length *= -shorter;
                length = match length < least {
                    true => least,
                    false => length,
                };
                let next = now - way * length;
                let behind = (next - self.depth) * way;
                match behind {
                    _ if behind < -SAME => self.depth,
                    _ if behind >= least - SAME => next,
                    _ => half,
                }
            } else {
                length = match length - shorter < shorter {
                    true => shorter,
                    false => length - shorter,
                };
                let twice = left > 2.0 * shorter + SAME;
                match left - length >= shorter - SAME {
                    true if twice => now - way * length,
                    true if left > shorter + SAME => half,
                    false if left > length + SAME && twice => self.depth + way * shorter,
                    false if left > length + SAME => half,
                    _ => self.depth,
                }
            };
            if (now - self.depth).abs() < SAME {
                now = self.depth;
            }
            found.push(now);
        }
        Some(found)
    }
}

/// Lines by what is in doubt, each with its file.
#[derive(Debug, Default)]
pub(super) struct Doubts(pub(super) BTreeMap<(&'static str, usize), Vec<usize>>);

impl Doubts {
    /// Each once in every file, with its lines.
    pub(super) fn into_findings(self) -> Vec<Finding> {
        let found = self.0.into_iter().map(|((what, file), mut lines)| {
            lines.sort_unstable();
            lines.dedup();
            let all = match lines.len() {
                1 => String::new(),
                _ => format!(" ({})", in_words(&lines)),
            };
            Finding {
                file,
                line: lines.first().copied().unwrap_or(1),
                message: format!("{what}{all}"),
            }
        });
        let mut found: Vec<Finding> = found.collect();
        found.sort_by_key(|finding| (finding.file, finding.line));
        found
    }
}
