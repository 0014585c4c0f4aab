//! Conversion losses: curves approximated by lines, events reduced to notes, omitted axes.

use std::collections::{BTreeMap, BTreeSet};

use kinetostat_program::Path;

use crate::making::events::EventKind;
use crate::making::fault::MakeFinding;
use crate::making::limits::MakeLanguage;
use crate::making::pieces::Followed;

/// Optional stops are named up to so many.
const MOST_SHOWN: usize = 20;

/// Counts of the conversion losses.
#[derive(Default)]
pub(crate) struct Otherwise {
    /// Approximated arcs by reason: their count, the source line of the first, and the number of straight segments.
    followed: BTreeMap<Followed, (usize, usize, usize)>,
    /// Events reduced to notes, by kind: their count, with the first of them.
    lost: BTreeMap<EventKind, (usize, String)>,
    /// Lines of optional stops that always stop.
    always: Vec<usize>,
    /// The first block with a speed of the spindle that the statements of the template do not take.
    pub(crate) dropped_speed: Option<String>,
}

impl Otherwise {
    /// An arc of a line of the source is followed by so many lines.
    pub(crate) fn follow(&mut self, why: Followed, line: usize, lines: usize) {
        let entry = self.followed.entry(why).or_insert((0, line, 0));
        entry.0 += 1;
        entry.2 += lines;
    }

    /// An event is a note alone.
    pub(crate) fn lose(&mut self, kind: EventKind, note: String) {
        self.lost.entry(kind).or_insert((0, note)).0 += 1;
    }

    /// An optional stop is one without a condition.
    pub(crate) fn stop_always(&mut self, line: usize) {
        self.always.push(line);
    }

    /// All of it in words.
    pub(crate) fn findings(&self, language: MakeLanguage, tolerance_mm: f64) -> Vec<MakeFinding> {
        let followed = self.followed.iter().map(|(why, (arcs, line, lines))| {
            let reason = match why {
                Followed::Helix => "circles of robots are flat, and this climbs",
                Followed::Language => match language {
                    MakeLanguage::Gcode => "it does not lie about the z axis",
                    _ => "there is no arc here that all readers take alike",
                },
                Followed::Small => "it is too small for a circle of the controller",
                Followed::Spiral => "its radius is another one at the end than at the start",
            };
            let arcs = match arcs {
                1 => "the arc is".to_owned(),
                n => format!("{n} arcs, here first, are"),
            };
            let message =
                format!("{arcs} followed by {lines} lines within {tolerance_mm} mm: {reason}");
            MakeFinding::of(*line, message)
        });
        let lost = self.lost.iter().map(|(kind, (count, first))| {
            let lines = match count {
                1 => "1 line is a note now, and does nothing there".to_owned(),
                n => format!("{n} lines are notes now, and do nothing there"),
            };
            MakeFinding::of(None, format!("{}: {lines} ({first})", kind.words()))
        });
        let always = self.always.first().map(|first| {
            // Each for itself: of an expanded program it is said from where it came.
            let shown = self.always.iter().take(MOST_SHOWN);
            let shown: Vec<String> = shown.map(|line| format!("line {line}")).collect();
            let more = match self.always.len().saturating_sub(MOST_SHOWN) {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            let message = format!(
                "an optional stop, which a switch of the machine decides on, always stops here ({}{more})",
                shown.join(", ")
            );
            MakeFinding::of(*first, message)
        });
        let dropped = self.dropped_speed.iter().map(|first| {
            let message = format!("spindle: the speed of the program is left out ({first}): the template's statements have no {{rpm}}, and the spindle turns as they say");
            MakeFinding::of(None, message)
        });
        followed.chain(lost).chain(dropped).chain(always).collect()
    }
}

/// Axes that the source moves beside X, Y and Z.
pub(crate) fn further_axes(path: &Path) -> Option<MakeFinding> {
    let motion = path.moves.iter().find(|motion| !motion.extra.is_empty())?;
    let letters: BTreeSet<char> = (path.moves.iter())
        .flat_map(|motion| motion.extra.iter().map(|extra| extra.letter))
        .collect();
    let letters: Vec<String> = letters.iter().map(char::to_string).collect();
    let message = format!("the words of the axes {} are left out", letters.join(", "));
    Some(MakeFinding::of(motion.line, message))
}
