//! All motions that do not take their pieces, in one message.

use std::collections::BTreeMap;

use crate::error::WriteError;
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::text::line_words::in_words;
use crate::writing::refusals::Reason;

/// Limit of the reasons that are named beside the first one.
const MOST_OTHERS: usize = 8;

/// Motions that are refused for one reason.
struct OfOne {
    reason: Reason,
    /// File and lines of the motions.
    lines: BTreeMap<usize, Vec<usize>>,
}

/// The motions that were refused up to here.
#[derive(Default)]
pub(super) struct Refused {
    by_reason: Vec<OfOne>,
}

impl Refused {
    /// One more.
    pub(super) fn add(&mut self, motion: &Motion, reason: Reason) {
        let known = self.by_reason.iter().position(|own| own.reason == reason);
        let index = known.unwrap_or_else(|| {
            self.by_reason.push(OfOne {
                reason,
                lines: BTreeMap::new(),
            });
            self.by_reason.len() - 1
        });
        if let Some(own) = self.by_reason.get_mut(index) {
            own.lines.entry(motion.file).or_default().push(motion.line);
        }
    }

    /// The error of the first one, which names all others with their lines.
    pub(super) fn error(mut self, program: &RobotProgram) -> Option<WriteError> {
        let name = |file: usize| program.files.get(file).map_or("", |file| file.name());
        let first = self.by_reason.first_mut()?;
        let (file, lines) = first.lines.iter_mut().next()?;
        let (file, line) = (*file, lines.remove(0));
        let named = |own: &OfOne| {
            let all = own.lines.iter().filter(|(_, lines)| !lines.is_empty());
            let all = all.map(|(of, lines)| {
                let mut lines = lines.clone();
                lines.sort_unstable();
                lines.dedup();
                match *of == file {
                    true => in_words(&lines),
                    false => format!("{} of {}", in_words(&lines), name(*of)),
                }
            });
            all.collect::<Vec<_>>().join(", ")
        };
        let (first, others) = self.by_reason.split_first()?;
        let mut reason = first.reason.0.to_owned();
        let further = named(first);
        if !further.is_empty() {
            reason.push_str(&format!("; so on {further}"));
        }
        for other in others.iter().take(MOST_OTHERS) {
            reason.push_str(&format!("; {}: {}", named(other), other.reason.0));
        }
        Some(WriteError::Motion {
            file: name(file).to_owned(),
            line,
            reason,
            remedy: first.reason.1.to_owned(),
        })
    }
}
