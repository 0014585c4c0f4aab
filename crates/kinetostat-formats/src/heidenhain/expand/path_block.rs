//! Blocks that go somewhere or take a tool: their values, their calls of a cycle, the feed behind a hole.

use crate::flat_run::BlockId;
use crate::heidenhain::expand::run::{Fault, Frame, Next, Run};
use crate::heidenhain::expand::values::Parameters;
use crate::heidenhain::flow::label_name;
use crate::heidenhain::path_words::{FeedWord, PathWords};
use crate::heidenhain::words::{Value, Word, words_of};
use crate::heidenhain::writing::words::{before_functions, take_out};
use crate::text::source::Edits;

impl Run<'_> {
    /// The feed of a tool that is taken is in force; its radius, where the program defines it, is Q108 from there on.
    fn tool(&mut self, words: &[Word], text: &[u8]) {
        let Some(kind) = words.get(1) else {
            return;
        };
        let named = |axis: &&str| {
            words
                .iter()
                .any(|word| word.is(axis) && word.value == Value::None)
        };
        self.axis = ["X", "Y", "Z"].into_iter().find(named).unwrap_or(self.axis);
        if kind.is("CALL")
            && let Some(word) = words.iter().find(|word| word.is("F"))
        {
            self.feed = Some(String::from_utf8_lossy(&text[word.span.clone()]).into_owned());
            self.feed_lost = false;
        }
        let Some(name) = label_name(text, kind) else {
            return;
        };
        let key = format!("TOOL {name}");
        if kind.is("DEF") {
            match words.iter().find(|word| word.is("R")).and_then(Word::value) {
                Some(radius) => self.parameters.insert(key, radius),
                None => self.parameters.remove(&key),
            };
            return;
        }
        let larger = words.iter().any(|word| word.is("DR"));
        match self.parameters.value(&key).filter(|_| !larger) {
            Some(radius) => self.parameters.insert("Q108".to_owned(), radius),
            None => self.parameters.remove("Q108"),
        };
    }

    /// Any other block: its values, its calls of a cycle, the feed behind a hole.
    pub(crate) fn path(&mut self, at: BlockId, words: &[Word]) -> Result<Next, Fault> {
        // Blocks without parameters and functions are written unchanged.
        let plain = |word: &Word| {
            !matches!(word.value, Value::Parameter { .. })
                && !matches!(
                    word.letters.letters(),
                    b"M" | b"F" | b"FAUTO" | b"FU" | b"FZ" | b"FT" | b"TOOL"
                )
        };
        if !self.modal && !self.feed_lost && words.iter().all(plain) {
            let program = &self.programs[at.file];
            let text = program.file.part(&program.blocks[at.block].text);
            self.write(text, at);
            return Ok(Next::Block);
        }
        let mut text = self.text(at, words)?;
        let flat = words_of(&text, &(0..text.len()));
        if flat.first().is_some_and(|word| word.is("TOOL")) {
            self.tool(&flat, &text);
            self.write(&text, at);
            return Ok(Next::Block);
        }
        let moves = matches!(
            flat.first().map(|word| word.letters),
            Some(letters) if matches!(letters.letters(), b"L" | b"LN" | b"LP" | b"C" | b"CP" | b"CR" | b"CT" | b"CTP")
        );
        let numbers = |number: u32| {
            flat.iter()
                .position(|word| word.is("M") && word.whole() == Some(number))
        };
        let ends = numbers(2).or(numbers(30)).is_some();
        let parsed = PathWords::of(&flat).ok().filter(|_| moves);
        let goes = parsed.as_ref().is_some_and(PathWords::moves);
        let (once, on) = (numbers(99), numbers(89));
        let calls = once.is_some() || (goes && (self.modal || on.is_some()));
        let left = calls && self.is_left(at)?;
        if on.is_some() {
            self.modal = true;
        }
        if once.is_some() {
            self.modal = false;
        }
        let mut edits = Edits::default();
        if let Some(parsed) = &parsed {
            self.take_feed(parsed.feed, goes, &flat, &text, &mut edits);
        }
        let taken: Vec<usize> = match left {
            true => Vec::new(),
            false => [once, on].into_iter().flatten().collect(),
        };
        for at in &taken {
            take_out(&flat, *at, &mut edits);
        }
        text = edits.applied_to(&text).ok_or_else(|| {
            self.fault(
                at,
                "its words overlap",
                "write the block as the control shows it",
            )
        })?;
        // The rest of `L FMAX M99` has no effect.
        let rest = words_of(&text, &(0..text.len()));
        let idle = |word: &Word| {
            ["L", "FMAX", "F", "R", "MAX"]
                .iter()
                .any(|letters| word.is(letters))
        };
        let nothing = !taken.is_empty() && !goes && rest.iter().all(idle);
        match nothing {
            true => self.feed_lost |= self.feed.is_some(),
            false => self.write(&text, at),
        }
        if calls && !left {
            self.drill(at)?;
        }
        match ends {
            true => self.ends_all(at),
            false => Ok(Next::Block),
        }
    }

    /// Takes the feed of a block; behind a hole, one that states none gets that of before.
    fn take_feed(
        &mut self,
        feed: FeedWord,
        goes: bool,
        flat: &[Word],
        text: &[u8],
        edits: &mut Edits,
    ) {
        match feed {
            FeedWord::Number(word, _) => {
                let span = flat[word].span.clone();
                self.feed = Some(String::from_utf8_lossy(&text[span]).into_owned());
                self.feed_lost = false;
            }
            FeedWord::Auto => {
                self.feed = Some("FAUTO".to_owned());
                self.feed_lost = false;
            }
            FeedWord::Other => self.feed = None,
            FeedWord::None if self.feed_lost && goes => {
                if let Some(feed) = &self.feed {
                    let behind = before_functions(flat);
                    edits.replace(behind..behind, format!(" {feed}"));
                }
                self.feed_lost = false;
            }
            FeedWord::None | FeedWord::Max => {}
        }
    }

    /// M2 and M30.
    fn ends_all(&self, at: BlockId) -> Result<Next, Fault> {
        let in_program = |frame: &Frame| matches!(frame, Frame::Program { .. });
        match self.frames.iter().any(in_program) {
            true => Err(self.fault(
                at,
                "a program that is called ends the whole program",
                "take M2 or M30 out of the program that is called",
            )),
            false => Ok(Next::End),
        }
    }
}
