//! The feed of a written block.

use crate::heidenhain::path_words::FeedWord;
use crate::heidenhain::reading::found::Way;
use crate::heidenhain::words::Word;
use crate::heidenhain::writing::words::{Stated, before_functions, feed_text};
use crate::heidenhain::writing::writer::Writer;
use crate::text::edits::Edits;

impl Writer<'_> {
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
