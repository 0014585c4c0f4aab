//! The marks of two programs beside each other: those in force at each cut, and all others where they stand.

use std::collections::{BTreeMap, BTreeSet};

use crate::verify::aligned::Aligned;
use crate::verify::marks::{Apart, IN_FORCE, Kind, Mark, Marks, Value};
use crate::verify::other_word::{FaultKind, OtherWord};

/// Lines that are listed of one word.
const LISTED: usize = 5;

/// Runs of cuts beyond these are not listed.
const MOST: usize = 10;

/// Queries to the original: stated origins of frames, and origins of lines.
pub(crate) struct Original<'o> {
    pub(crate) is_stated: &'o dyn Fn(&str) -> bool,
    pub(crate) source: &'o dyn Fn(usize) -> String,
}

/// Differences of the programs: `cuts` are moves that both make, of the program verified and of the original.
pub(crate) fn compared(
    both: &[Marks<'_>; 2],
    cuts: &[[usize; 2]],
    original: &Original<'_>,
) -> Vec<OtherWord> {
    let aligned = Aligned::of(both, cuts);
    let mut found = Vec::new();
    let mut named = Vec::new();
    for kind in IN_FORCE {
        let marks = both.iter().flat_map(|marks| &marks.all);
        let names = marks.filter(|mark| mark.kind == kind);
        let names: BTreeSet<&str> = names.map(|mark| mark.name.as_str()).collect();
        for name in names {
            let in_force = both.each_ref().map(|own| InForce::of(own, kind, name));
            let at_cuts = match kind {
                // Pieces of a motion may state how the arm stands where the whole does not.
                Kind::Configuration => Vec::new(),
                // Pieces of a motion pass their ends; the last one ends as the whole.
                Kind::Zone | Kind::Options => {
                    elsewhere(kind, both, &in_force, &aligned.ends, original)
                }
                _ => elsewhere(kind, both, &in_force, cuts, original),
            };
            match kind {
                Kind::PathMode | Kind::Radius if at_cuts.is_empty() => named.push((kind, name)),
                _ if at_cuts.is_empty() => {
                    found.extend(in_one_alone(kind, &in_force, original.is_stated));
                }
                _ => {}
            }
            found.extend(at_cuts);
        }
    }
    let is_placed = |mark: &Mark<'_>| {
        !IN_FORCE.contains(&mark.kind) || named.contains(&(mark.kind, mark.name.as_str()))
    };
    found.extend(elsewhere_placed([&both[0], &both[1]], cuts, &is_placed));
    found.extend(aligned.other_ways);
    found
}

/// Values of one kind as they come into force, each with the number of moves before it and its line.
struct InForce<'m> {
    usual: Value<'static>,
    changes: Vec<&'m Mark<'m>>,
    /// Marks in force on moves.
    on_moves: Vec<&'m Mark<'m>>,
}

impl<'m> InForce<'m> {
    fn of(marks: &'m Marks<'m>, kind: Kind, name: &str) -> Self {
        let own = marks.all.iter();
        let own = own.filter(|mark| mark.kind == kind && mark.name == name);
        let changes: Vec<_> = own.collect();
        let mut on_moves: Vec<&Mark<'_>> = Vec::new();
        for (index, mark) in changes.iter().enumerate() {
            let next = changes.get(index + 1).map_or(usize::MAX, |next| next.at);
            let is_used = mark.at < next.min(marks.path.moves.len());
            if is_used && !on_moves.iter().any(|known| known.value == mark.value) {
                on_moves.push(mark);
            }
        }
        Self {
            usual: kind.usual(),
            changes,
            on_moves,
        }
    }

    /// The value that is in force on a move.
    fn on(&self, index: usize) -> &Value<'_> {
        let behind = self.changes.partition_point(|mark| mark.at <= index);
        let last = behind.checked_sub(1).map(|last| &self.changes[last].value);
        last.unwrap_or(&self.usual)
    }
}

/// Cuts made with another value than in the original; `moves` are those of both programs.
fn elsewhere(
    kind: Kind,
    both: &[Marks<'_>; 2],
    [own, of_original]: &[InForce<'_>; 2],
    moves: &[[usize; 2]],
    original: &Original<'_>,
) -> Vec<OtherWord> {
    /// Lines from the first to the last, and that of the original which the first belongs to.
    type Run<'v> = ([usize; 3], [&'v Value<'v>; 2], Apart);
    let mut runs: Vec<Run<'_>> = Vec::new();
    let mut goes_on = false;
    for [index, there] in moves {
        let values = [own.on(*index), of_original.on(*there)];
        let apart = values[0].apart(values[1], kind, original.is_stated);
        let Some(apart) = apart else {
            goes_on = false;
            continue;
        };
        let (line, there) = (both[0].line_of(*index), both[1].line_of(*there));
        let is_full = runs.len() == MOST;
        match runs.last_mut().filter(|last| goes_on && last.1 == values) {
            Some((lines, ..)) => lines[1] = line,
            None if is_full => break,
            None => runs.push(([line, line, there], values, apart)),
        }
        goes_on = true;
    }
    let said = runs.into_iter().map(|(lines, values, apart)| {
        let [own, of_original] = values.map(Value::to_string);
        let values = [own.as_str(), of_original.as_str()];
        OtherWord::at_cuts(lines, values, apart.fault, &apart.follows, original.source)
    });
    said.collect()
}

/// Values with which moves of one of both programs alone are made; how an arm stands matters in the program verified.
fn in_one_alone(
    kind: Kind,
    [own, of_original]: &[InForce<'_>; 2],
    is_stated: &dyn Fn(&str) -> bool,
) -> Vec<OtherWord> {
    let matters = [
        Kind::Frame,
        Kind::Length,
        Kind::Shift,
        Kind::Tool,
        Kind::Configuration,
    ];
    if !matters.contains(&kind) {
        return Vec::new();
    }
    let usual = kind.usual();
    let only = |ours: &InForce<'_>, others: &InForce<'_>, of: usize| -> Vec<OtherWord> {
        let is_known = |value: &Value<'_>| {
            let mut others = others.on_moves.iter();
            let is_stated_place = matches!(value, Value::Text(text) if is_stated(text));
            let is_fault = |apart: Apart| apart.fault.is_some() || kind.fault().is_none();
            let is_other =
                |other: &Value<'_>| (value.apart(other, kind, is_stated)).is_some_and(is_fault);
            is_stated_place || !is_other(&usual) || others.any(|other| !is_other(&other.value))
        };
        let own = ours.on_moves.iter().filter(|mark| !is_known(&mark.value));
        let said = own.map(|mark| {
            let mut lines = [None, None];
            lines[of] = Some(mark.line);
            let text = OtherWord::only_in_one(&mark.value.to_string(), lines);
            let text = format!("{text}{}", kind.follows());
            OtherWord::new(mark.value.to_string(), kind.fault(), lines, text)
        });
        said.collect()
    };
    let mut found = only(own, of_original, 0);
    if kind != Kind::Configuration {
        found.extend(only(of_original, own, 1));
    }
    found
}

/// Cuts that both programs make, by their moves, sorted by those of one of them.
struct Cuts(Vec<[usize; 2]>, usize);

impl Cuts {
    fn of(pairs: &[[usize; 2]], of: usize) -> Self {
        let mut pairs = pairs.to_vec();
        pairs.sort_by_key(|moves| moves[of]);
        Self(pairs, of)
    }

    /// The cut behind which a mark stands, as a move of the original counted from 1 (zero before all cuts); and true if it stands among
    /// the pieces of that cut.
    fn before(&self, mark: &Mark<'_>) -> (usize, bool) {
        let next = self.0.partition_point(|moves| moves[self.1] < mark.at);
        let last = next.checked_sub(1).map(|last| self.0[last][1]);
        let is_inside =
            last.is_some_and(|last| self.0.get(next).is_some_and(|next| next[1] == last));
        (last.map_or(0, |last| last + 1), is_inside)
    }

    fn last(&self) -> usize {
        self.0.last().map_or(0, |moves| moves[self.1])
    }
}

/// A mark, what it says, and the cut behind which it stands.
type Placed<'m> = (String, &'m Mark<'m>, (usize, bool));

/// Marks for their places that the other program does not have behind the same cut.
fn elsewhere_placed(
    both: [&Marks<'_>; 2],
    cuts: &[[usize; 2]],
    is_placed: &dyn Fn(&Mark<'_>) -> bool,
) -> Vec<OtherWord> {
    let cuts = [0, 1].map(|of| Cuts::of(cuts, of));
    let placed = |of: usize| -> Vec<Placed<'_>> {
        let own = both[of].all.iter().filter(|mark| is_placed(mark));
        own.map(|mark| (mark.value.to_string(), mark, cuts[of].before(mark)))
            .collect()
    };
    let (ours, theirs) = (placed(0), placed(1));
    let (added, mut left_out) = (unmatched(&ours, &theirs), unmatched(&theirs, &ours));
    let has = |all: &[(String, Vec<&Mark<'_>>)], text: &str| all.iter().any(|own| own.0 == text);
    // They stand on the other side of a cut.
    let moved: BTreeSet<String> = (added.iter())
        .filter(|(text, _)| has(&left_out, text))
        .map(|(text, _)| text.clone())
        .collect();
    left_out.retain(|(text, _)| !moved.contains(text));
    let fault = |text: &str, mark: &Mark<'_>, of: usize| match mark.kind {
        kind if IN_FORCE.contains(&kind) => None,
        kind if moved.contains(text) => kind.fault().or(Some(FaultKind::Course)),
        // Words after the last motion, or the last cut, change none.
        Kind::Stop if of == 1 || mark.at >= both[0].path.moves.len() => None,
        Kind::Unseen | Kind::Endless if of == 1 => None,
        Kind::Spindle if mark.at > cuts[of].last() => None,
        kind => kind.fault(),
    };
    let said = |of: usize, (text, marks): (String, Vec<&Mark<'_>>)| {
        let (mark, at) = (marks[0], lines_of(&marks));
        let fault = fault(&text, mark, of);
        let mut lines = [None, None];
        lines[of] = Some(mark.line);
        let said = match of {
            1 => format!("{text} at {at} of the original is not in this program there"),
            _ if moved.contains(&text) => {
                format!("{text} at {at} stands on the other side of a cut in the original")
            }
            _ => format!("{text} at {at} is not in the original"),
        };
        let follows = fault.filter(|_| of == 0);
        let follows = follows.map_or("", |_: FaultKind| mark.kind.follows());
        OtherWord::new(text, fault, lines, format!("{said}{follows}"))
    };
    let added = added.into_iter().map(|of| said(0, of));
    added
        .chain(left_out.into_iter().map(|of| said(1, of)))
        .collect()
}

/// Marks that the others do not have as often behind the same cut, by what they say, in their order.
fn unmatched<'a>(ours: &[Placed<'a>], theirs: &[Placed<'a>]) -> Vec<(String, Vec<&'a Mark<'a>>)> {
    let mut left: BTreeMap<(&str, (usize, bool)), usize> = BTreeMap::new();
    for (text, _, behind) in theirs {
        *left.entry((text, *behind)).or_default() += 1;
    }
    let mut found: Vec<(String, Vec<&Mark<'_>>)> = Vec::new();
    for (text, mark, behind) in ours {
        match left
            .get_mut(&(text.as_str(), *behind))
            .filter(|left| **left > 0)
        {
            Some(left) => *left -= 1,
            None => match found.iter_mut().find(|(known, _)| known == text) {
                Some((_, marks)) => marks.push(mark),
                None => found.push((text.clone(), vec![mark])),
            },
        }
    }
    found
}

/// "line 5", "lines 5, 9 and 3 more".
fn lines_of(marks: &[&Mark<'_>]) -> String {
    let shown = marks.iter().take(LISTED).map(|mark| mark.line.to_string());
    let shown: Vec<String> = shown.collect();
    let more = match marks.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let lines = if marks.len() == 1 { "line" } else { "lines" };
    format!("{lines} {}{more}", shown.join(", "))
}
