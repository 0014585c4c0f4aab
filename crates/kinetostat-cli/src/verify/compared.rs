//! The marks of two programs beside each other: those in force at each cut, and all others where they stand.

use std::collections::BTreeMap;

use crate::verify::marks::{Apart, IN_FORCE, Kind, Mark, Marks, Value};
use crate::verify::other_word::{FaultKind, OtherWord};

/// Lines that are listed of one word.
const LISTED: usize = 5;

/// Runs of cuts beyond these are not listed.
const MOST: usize = 10;

/// Differences of the programs: `cut_lines` are lines of cuts that both make, of the program verified and of the original; `source`
/// returns the origin of a line of the original.
pub(crate) fn compared(
    [own, of_original]: &[Marks<'_>; 2],
    cut_lines: &[[usize; 2]],
    is_stated: &dyn Fn(&str) -> bool,
    source: &dyn Fn(usize) -> String,
) -> Vec<OtherWord> {
    let mut found = Vec::new();
    for kind in IN_FORCE {
        let both = [own, of_original].map(|marks| InForce::of(marks, kind));
        let at_cuts = match kind {
            // Pieces of a motion may state how the arm stands where the whole does not.
            Kind::Configuration => Vec::new(),
            _ => elsewhere(kind, &both, cut_lines, is_stated, source),
        };
        if at_cuts.is_empty() {
            found.extend(in_one_alone(kind, &both, is_stated));
        }
        found.extend(at_cuts);
    }
    found.extend(elsewhere_placed([own, of_original], cut_lines));
    found
}

/// Values of one kind as they come into force, each with its line.
struct InForce<'m> {
    usual: Value<'static>,
    changes: Vec<(usize, &'m Value<'m>)>,
    /// Values in force on moves.
    on_moves: Vec<(usize, &'m Value<'m>)>,
}

impl<'m> InForce<'m> {
    fn of(marks: &'m Marks<'m>, kind: Kind) -> Self {
        let own = marks.all.iter().filter(|mark| mark.kind == kind);
        let changes: Vec<_> = own.map(|mark| (mark.line, &mark.value)).collect();
        let mut on_moves: Vec<(usize, &Value<'_>)> = Vec::new();
        for (index, (line, value)) in changes.iter().enumerate() {
            let next = changes.get(index + 1).map_or(usize::MAX, |next| next.0);
            let from = marks.move_lines.partition_point(|own| own < line);
            let is_used = marks.move_lines.get(from).is_some_and(|own| *own < next);
            if is_used && !on_moves.iter().any(|(_, known)| known == value) {
                on_moves.push((*line, value));
            }
        }
        Self {
            usual: kind.usual(),
            changes,
            on_moves,
        }
    }

    /// The value that is in force behind what a line says.
    fn on(&self, line: usize) -> &Value<'_> {
        let behind = self.changes.partition_point(|(at, _)| *at <= line);
        let last = behind.checked_sub(1).map(|last| self.changes[last].1);
        last.unwrap_or(&self.usual)
    }
}

/// Cuts made with another value than in the original.
fn elsewhere(
    kind: Kind,
    [own, of_original]: &[InForce<'_>; 2],
    cut_lines: &[[usize; 2]],
    is_stated: &dyn Fn(&str) -> bool,
    source: &dyn Fn(usize) -> String,
) -> Vec<OtherWord> {
    /// Lines from the first to the last, and that of the original which the first belongs to.
    type Run<'v> = ([usize; 3], [&'v Value<'v>; 2], Apart);
    let mut runs: Vec<Run<'_>> = Vec::new();
    let mut goes_on = false;
    for [line, there] in cut_lines {
        let values = [own.on(*line), of_original.on(*there)];
        let apart = values[0].apart(values[1], kind, is_stated);
        let Some(apart) = apart else {
            goes_on = false;
            continue;
        };
        let is_full = runs.len() == MOST;
        match runs.last_mut().filter(|last| goes_on && last.1 == values) {
            Some((lines, ..)) => lines[1] = *line,
            None if is_full => break,
            None => runs.push(([*line, *line, *there], values, apart)),
        }
        goes_on = true;
    }
    let said = runs.into_iter().map(|(lines, values, apart)| {
        let [own, of_original] = values.map(Value::to_string);
        let follows = (apart.fault, apart.follows.as_str());
        OtherWord::at_cuts(lines, [&own, &of_original], follows, source)
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
            is_stated_place
                || !value.apart(&usual, kind, is_stated).is_some_and(is_fault)
                || others
                    .any(|(_, other)| !value.apart(other, kind, is_stated).is_some_and(is_fault))
        };
        let own = ours.on_moves.iter().filter(|(_, value)| !is_known(value));
        let said = own.map(|(line, value)| {
            let mut lines = [None, None];
            lines[of] = Some(*line);
            let text = OtherWord::only_in_one(&value.to_string(), lines);
            let text = format!("{text}{}", kind.follows());
            OtherWord::new(value.to_string(), kind.fault(), lines, text)
        });
        said.collect()
    };
    let mut found = only(own, of_original, 0);
    if kind != Kind::Configuration {
        found.extend(only(of_original, own, 1));
    }
    found
}

/// Lines of cuts that both programs make, sorted by those of one of them.
struct CutLines(Vec<[usize; 2]>, usize);

impl CutLines {
    fn of(pairs: &[[usize; 2]], of: usize) -> Self {
        let mut pairs = pairs.to_vec();
        pairs.sort_by_key(|lines| lines[of]);
        Self(pairs, of)
    }

    /// Returns the last cut before a mark, as a line of the original (zero before all cuts).
    fn before(&self, mark: &Mark<'_>) -> usize {
        let line = mark.line + usize::from(mark.is_behind);
        let before = self.0.partition_point(|lines| lines[self.1] < line);
        (before.checked_sub(1)).map_or(0, |last| self.0[last][1])
    }
}

/// Marks for their places that the other program does not have behind the same cut.
fn elsewhere_placed(both: [&Marks<'_>; 2], cut_lines: &[[usize; 2]]) -> Vec<OtherWord> {
    let placed = |of: usize| -> Vec<(String, &Mark<'_>, usize)> {
        let cuts = CutLines::of(cut_lines, of);
        let all = both[of].all.iter();
        let own = all.filter(|mark| !IN_FORCE.contains(&mark.kind));
        own.map(|mark| (mark.value.to_string(), mark, cuts.before(mark)))
            .collect()
    };
    let (ours, theirs) = (placed(0), placed(1));
    let (mut added, mut left_out) = (unmatched(&ours, &theirs), unmatched(&theirs, &ours));
    let has = |all: &[(String, &Mark<'_>, usize)], text: &str| all.iter().any(|own| own.0 == text);
    if both[1].has_loops() {
        added.retain(|(text, of)| of[0].kind == Kind::Stop || !has(&theirs, text));
        left_out.retain(|(text, _)| !has(&ours, text));
    }
    left_out.retain(|(text, _)| !added.iter().any(|(other, _)| other == text));
    let last_motion = both[0].move_lines.last().copied().unwrap_or_default();
    let last_cut = |of: usize| cut_lines.iter().map(|lines| lines[of]).max();
    let fault = |mark: &Mark<'_>, of: usize| match mark.kind {
        // Words after the last motion, or the last cut, change none.
        Kind::Stop if of == 1 || mark.line >= last_motion => None,
        Kind::Unseen if of == 1 => None,
        Kind::Spindle if Some(mark.line) > last_cut(of) => None,
        kind => kind.fault(),
    };
    let added = added.into_iter().map(|(text, marks)| {
        let (mark, lines) = (marks[0], lines_of(&marks));
        let what = match has(&theirs, &text) {
            true => "stands elsewhere in the original",
            false => "is not in the original",
        };
        let fault = fault(mark, 0);
        let follows = fault.map_or("", |_: FaultKind| mark.kind.follows());
        let said = format!("{text} at {lines} {what}{follows}");
        OtherWord::new(text, fault, [Some(mark.line), None], said)
    });
    let left_out = left_out.into_iter().map(|(text, marks)| {
        let said = format!(
            "{text} at {} of the original is not in this program there",
            lines_of(&marks)
        );
        let lines = [None, Some(marks[0].line)];
        OtherWord::new(text, fault(marks[0], 1), lines, said)
    });
    added.chain(left_out).collect()
}

/// Marks that the others do not have as often behind the same cut, by what they say, in their order.
fn unmatched<'a>(
    ours: &[(String, &'a Mark<'a>, usize)],
    theirs: &[(String, &'a Mark<'a>, usize)],
) -> Vec<(String, Vec<&'a Mark<'a>>)> {
    let mut left: BTreeMap<(&str, usize), usize> = BTreeMap::new();
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
