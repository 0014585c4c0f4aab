//! Branches, loops and jumps of robots' programs, line by line: what stands in none of them runs once.

use crate::model::language::Language;

/// Blocks that run on a condition or again and again.
pub(crate) struct Blocks {
    language: Language,
    open: usize,
    /// The line follows a jump, or its routine has one.
    is_lost: bool,
}

impl Blocks {
    /// At the beginning of a routine.
    pub(crate) fn of(language: Language) -> Self {
        Self {
            language,
            open: 0,
            is_lost: false,
        }
    }

    /// True if the line runs exactly once, unconditionally.
    pub(crate) fn is_certain(&self) -> bool {
        self.open == 0 && !self.is_lost
    }

    /// Jumps make the order of lines no order of time.
    pub(crate) fn jump(&mut self, words: &[String]) {
        let jumps = self.language.jumps();
        self.is_lost |= words.iter().any(|word| jumps.contains(&word.as_str()));
    }

    /// The words of the next line.
    pub(crate) fn enter(&mut self, words: &[String]) {
        let Some(first) = words.first().map(String::as_str) else {
            return;
        };
        let has = |word: &str| words.iter().any(|own| own == word);
        let ends = [
            "ENDIF",
            "ENDFOR",
            "ENDWHILE",
            "ENDTEST",
            "ENDLOOP",
            "UNTIL",
            "ENDSWITCH",
        ];
        let closes = words
            .iter()
            .filter(|word| ends.contains(&word.as_str()))
            .count();
        self.open += usize::from(self.language.opens_block(words));
        match self.open.checked_sub(closes) {
            Some(open) => self.open = open,
            None => self.is_lost = true,
        }
        // Statements after these only run if the routine was not left before.
        let leaves = [
            "RETURN",
            "EXIT",
            "EXITCYCLE",
            "RETRY",
            "TRYNEXT",
            "RAISE",
            "ERROR",
            "UNDO",
            "BACKWARD",
        ];
        let is_statement = leaves.contains(&first) && words.len() == 1 || has("RETURN");
        self.is_lost |= is_statement && self.language.is_of_robot();
        self.is_lost |= self.language.ends_of_run().contains(&first);
    }
}
