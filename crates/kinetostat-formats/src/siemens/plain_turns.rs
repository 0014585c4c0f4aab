//! Angles of modulo axes without AC or DC, which a setting of the machine takes one way or the other.
//!
//! Source: Siemens, SINUMERIK 840D sl, machine data lists, MD30455 $MA_MISC_FUNCTION_MASK: with bit 2 a modulo rotary axis that is programmed
//! under G90 goes to its angle as with DC; without it, as with AC.

use crate::siemens::state::Coordinate;
use crate::siemens::walker::{PlainTurn, Reader};
use crate::text::finding::Finding;

/// Limit of the other lines that a finding names.
const MOST_NAMED: usize = 20;

impl Reader<'_> {
    /// Notes a word that turns an axis in a cut, where it matters what the machine takes it for.
    pub(crate) fn note_plain_turn(&mut self, place: usize, word: &Coordinate, to: f64) {
        let letter = self.options.rotary_axes.get(place).copied();
        let readings = self.state.standing.readings_of(place, to);
        if let (Some(letter), Some(readings)) = (letter, readings) {
            let line = self.file.line_of(word.whole.start);
            self.out.plain_turns.push(PlainTurn {
                line,
                letter,
                to,
                readings,
            });
        }
    }
}

/// Finding on the plain turns of a file, at the first of them.
pub(crate) fn finding_of(file: usize, turns: &[PlainTurn]) -> Option<Finding> {
    let (first, others) = turns.split_first()?;
    let PlainTurn { letter, to, .. } = first;
    let [on, shorter] = (first.readings).map(|angle| (angle * 1e5).round() / 1e5);
    let mut lines: Vec<usize> = others.iter().map(|turn| turn.line).collect();
    lines.retain(|line| *line != first.line);
    lines.dedup();
    let named = lines.iter().take(MOST_NAMED).map(usize::to_string);
    let named = named.collect::<Vec<_>>().join(", ");
    let further = match lines.len() {
        0 => String::new(),
        1 => format!("; so in line {named}"),
        count @ ..=MOST_NAMED => format!("; so in {count} further lines: {named}"),
        count => format!("; so in {count} further lines: {named} ..."),
    };
    Some(Finding {
        file,
        line: first.line,
        message: format!(
            "axis {letter} is sent to {to} deg by a word without AC or DC, and how far it turns is a setting of the machine: it is taken as AC here, the basic setting, and turns by {on} deg; where bit 2 of MD30455 makes it DC, it turns by {shorter} deg. Write {letter}=AC({to}) or {letter}=DC({to}){further}"
        ),
    })
}
