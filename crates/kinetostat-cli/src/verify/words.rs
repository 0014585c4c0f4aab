//! Words of two programs beside their places: those in force at each cut, and all others where they stand.

use std::collections::{BTreeMap, BTreeSet};

use crate::verify::cut_lines::{CutLines, Left};
use crate::verify::in_force::InForce;
use crate::verify::other_word::{FaultKind, Lines, OTHER_PATH_MODE, OtherWord};

/// Kinds of words. Of those in `IN_FORCE` the last one holds, the others are for the place where they stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Frame,
    /// Before the first place is known it says where the machine stands, in a frame that it moves.
    Shift,
    Length,
    Radius,
    Tool,
    Edge,
    Speed,
    Rotation,
    PathMode,
    /// Statements behind which the motions that follow may not be made.
    End,
    /// Those that make motions behind them under a condition, or again.
    Branch,
    /// Those that say how fast all motions run.
    Override,
    /// Statements that name the spindle, by what they call or switch.
    Spindle,
    Other,
}

const IN_FORCE: [Kind; 9] = [
    Kind::Frame,
    Kind::Shift,
    Kind::Length,
    Kind::Radius,
    Kind::Tool,
    Kind::Edge,
    Kind::Speed,
    Kind::Rotation,
    Kind::PathMode,
];

/// At the start, and behind a change of tools, which stops the spindle.
pub(crate) const STANDS: &str = "no M3 or M4 since the change of tools";

/// A call that adds nothing to its tool.
pub(crate) const NOTHING_ADDED: &str = "no DL and DR";

/// The frame of a program that names none.
const NO_FRAME: &str = "no word for a frame";

/// Words that are done behind the motion of their block.
const BEHIND_MOTIONS: [&str; 9] = ["M0", "M1", "M2", "M5", "M9", "M17", "M30", "M60", "M99"];

/// Lines that are listed of one word.
const LISTED: usize = 5;

impl Kind {
    /// In force without a word.
    fn usual(self) -> &'static str {
        match self {
            Self::Frame => NO_FRAME,
            Self::Shift => "no G92 before the first place",
            Self::Length => "G49",
            Self::Radius => "G40",
            Self::Speed => "no S",
            Self::Rotation => STANDS,
            Self::PathMode => "what the control is set up for",
            _ => "none",
        }
    }

    fn fault(self) -> Option<FaultKind> {
        match self {
            Self::Frame | Self::Shift => Some(FaultKind::Frame),
            Self::Length | Self::Radius | Self::Tool | Self::Edge => Some(FaultKind::Tool),
            Self::Speed => Some(FaultKind::Spindle),
            Self::Rotation | Self::Spindle => Some(FaultKind::Rotation),
            Self::PathMode => Some(FaultKind::PathMode),
            Self::End | Self::Branch => Some(FaultKind::Course),
            Self::Override => Some(FaultKind::Feed),
            Self::Other => None,
        }
    }

    fn follows(self) -> &'static str {
        match self {
            Self::Frame => {
                ": it is not known where the control has this frame (state its origin with --work-offset if it is the one that the program is made for)"
            }
            Self::Shift => {
                ": before the program has said where the tool is, it shifts the frame by what the control knows"
            }
            Self::Length => ": the control moves the tool by what its table has there",
            Self::PathMode => OTHER_PATH_MODE,
            Self::End => ": motions behind it may not be made",
            Self::Branch => ": motions behind it may not be made, or more than once",
            Self::Override => ": it changes how fast all motions run",
            _ => "",
        }
    }

    /// Whether two words say the same; places in frames with stated origins are compared as places.
    fn is_same(self, [a, b]: [&str; 2], is_stated: &dyn Fn(&str) -> bool) -> bool {
        let both = |is: &dyn Fn(&str) -> bool| is(a) && is(b);
        let first = |word: &str| matches!(word, NO_FRAME | "G54");
        a == b
            || match self {
                Self::Frame => both(&first) || both(&|word| word == NO_FRAME || is_stated(word)),
                Self::Edge => both(&|word| matches!(word, "none" | "D1" | NOTHING_ADDED)),
                Self::Rotation => both(&|word| !matches!(word, "M3" | "M4")),
                _ => false,
            }
    }
}

/// A word and its line.
#[derive(Clone, Debug)]
pub(crate) struct Word {
    pub(crate) line: usize,
    pub(crate) kind: Kind,
    pub(crate) text: String,
}

impl Word {
    /// Line before which a cut stands before the word.
    fn place(&self) -> usize {
        self.line + usize::from(BEHIND_MOTIONS.contains(&self.text.as_str()))
    }
}

/// Words of a program in the order of their lines, and lines of its moves.
pub(crate) struct Words {
    pub(crate) all: Vec<Word>,
    pub(crate) move_lines: Vec<usize>,
    /// Motions run more than once: a program without the loop has the words of its rounds more often.
    pub(crate) has_loops: bool,
}

impl Words {
    fn in_force(&self, kind: Kind) -> InForce {
        let own = self.all.iter().filter(|word| word.kind == kind);
        InForce::new(kind.usual(), own.map(|word| (word.line, word.text.clone())))
    }

    /// Words of a kind in force on moves, each with the line that says it.
    fn on_moves(&self, kind: Kind) -> BTreeMap<String, usize> {
        let in_force = self.in_force(kind);
        let used: BTreeSet<&str> = self.move_lines.iter().map(|l| in_force.on(*l)).collect();
        let mut found = BTreeMap::new();
        for word in &self.all {
            if word.kind == kind && used.contains(word.text.as_str()) {
                found.entry(word.text.clone()).or_insert(word.line);
            }
        }
        found
    }

    /// Words for the place where they stand, with the cut behind which that is.
    fn placed(&self, behind: impl Fn(usize) -> usize) -> Vec<(&Word, usize)> {
        let all = self
            .all
            .iter()
            .filter(|word| !IN_FORCE.contains(&word.kind));
        all.map(|word| (word, behind(word.place()))).collect()
    }
}

/// Words that both programs do not have alike: `cut_lines` are lines of the program verified and of the original.
pub(crate) fn compared(
    own: &Words,
    of_original: &Words,
    cut_lines: &[[usize; 2]],
    is_stated: &dyn Fn(&str) -> bool,
) -> Vec<OtherWord> {
    let mut found = Vec::new();
    for kind in IN_FORCE {
        let same = |a: &str, b: &str| kind.is_same([a, b], is_stated);
        let (own_words, their_words) = (own.in_force(kind), of_original.in_force(kind));
        let elsewhere = own_words.elsewhere(&their_words, cut_lines, same);
        if elsewhere.is_empty() && matches!(kind, Kind::Frame | Kind::Length | Kind::Shift) {
            found.extend(on_rapids(kind, [own, of_original], is_stated));
        }
        found.extend(elsewhere.into_iter().map(|run| match run.word.as_str() {
            "S0" => run.other_word(Some(FaultKind::Rotation), ""),
            // Whoever stops at corners follows the path no worse.
            stops if stops.starts_with("G61") => run.other_word(None, ""),
            _ => run.other_word(kind.fault(), kind.follows()),
        }));
    }
    found.extend(elsewhere_placed(own, of_original, cut_lines));
    found
}

/// Words with which no cut is made, and a rapid is in one of both programs alone.
fn on_rapids(
    kind: Kind,
    both: [&Words; 2],
    is_stated: &dyn Fn(&str) -> bool,
) -> impl Iterator<Item = OtherWord> {
    let [own, theirs] = both.map(|words| words.on_moves(kind));
    let usual = |word: &str| kind.is_same([word, kind.usual()], is_stated);
    let only = |ours: &BTreeMap<String, usize>, others: &BTreeMap<String, usize>| {
        let ours = ours.iter();
        let only = ours.filter(|(w, _)| !usual(w) && !is_stated(w) && !others.contains_key(*w));
        only.map(|(word, line)| (word.clone(), *line))
            .collect::<Vec<_>>()
    };
    let (added, left_out) = (only(&own, &theirs), only(&theirs, &own));
    let said = move |word: String, lines: Lines| {
        let text = OtherWord::only_in_one(&word, lines);
        OtherWord::new(
            word,
            kind.fault(),
            lines,
            format!("{text}{}", kind.follows()),
        )
    };
    let added = added
        .into_iter()
        .map(move |(w, l)| said(w, [Some(l), None]));
    added.chain(
        left_out
            .into_iter()
            .map(move |(w, l)| said(w, [None, Some(l)])),
    )
}

/// Words for their places that the other program does not have behind the same cut.
fn elsewhere_placed(own: &Words, of_original: &Words, cut_lines: &[[usize; 2]]) -> Vec<OtherWord> {
    let cuts = CutLines::of(cut_lines);
    let ours = own.placed(|line| cuts.before_own(line));
    let theirs = of_original.placed(|line| cuts.before(line));
    let (mut added, mut left_out) = (unmatched(&ours, &theirs), unmatched(&theirs, &ours));
    if of_original.has_loops {
        let has = |all: &[(&Word, usize)], text: &str| all.iter().any(|(w, _)| w.text == text);
        added.retain(|(text, of)| {
            of[0].kind.fault() == Some(FaultKind::Course) || !has(&theirs, text)
        });
        left_out.retain(|(text, of)| of[0].kind != Kind::Branch && !has(&ours, text));
    }
    left_out.retain(|(text, _)| !added.iter().any(|(other, _)| other == text));
    let last_motion = own.move_lines.iter().max().copied().unwrap_or_default();
    let last_cut = |of: usize| cut_lines.iter().map(|lines| lines[of]).max();
    let fault = |word: &Word, of: usize| match word.kind {
        // What is said behind the last motion, or the last cut, changes none.
        Kind::End | Kind::Branch if of == 1 || word.line >= last_motion => None,
        Kind::Spindle if Some(word.line) > last_cut(of) => None,
        kind => kind.fault(),
    };
    let added = added.into_iter().map(|(text, words)| {
        let (word, lines) = (words[0], lines_of(&words));
        let what = match theirs.iter().any(|(other, _)| other.text == text) {
            true => "stands elsewhere in the original",
            false => "is not in the original",
        };
        let fault = fault(word, 0);
        let follows = fault.map_or("", |_| word.kind.follows());
        let said = format!("{text} at {lines} {what}{follows}");
        OtherWord::new(text, fault, [Some(word.line), None], said)
    });
    let left_out = left_out.into_iter().map(|(text, words)| {
        let said = format!(
            "{text} at {} of the original is not in this program there",
            lines_of(&words)
        );
        let lines = [None, Some(words[0].line)];
        OtherWord::new(text, fault(words[0], 1), lines, said)
    });
    added.chain(left_out).collect()
}

/// Words that the others do not have as often behind the same cut, by what they say, in their order.
fn unmatched<'a>(
    ours: &[(&'a Word, usize)],
    theirs: &[(&'a Word, usize)],
) -> Vec<(String, Vec<&'a Word>)> {
    let key = |(word, behind): &(&Word, usize)| (word.text.clone(), *behind);
    let mut left = Left::of(theirs.iter().map(key));
    let mut found: Vec<(String, Vec<&Word>)> = Vec::new();
    for placed in ours {
        if left.take(&key(placed)) {
            continue;
        }
        let text = &placed.0.text;
        match found.iter_mut().find(|(known, _)| known == text) {
            Some((_, words)) => words.push(placed.0),
            None => found.push((text.clone(), vec![placed.0])),
        }
    }
    found
}

/// "line 5", "lines 5, 9 and 3 more".
fn lines_of(words: &[&Word]) -> String {
    let shown: Vec<String> = words
        .iter()
        .take(LISTED)
        .map(|w| w.line.to_string())
        .collect();
    let more = match words.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let lines = if words.len() == 1 { "line" } else { "lines" };
    format!("{lines} {}{more}", shown.join(", "))
}
