//! The language of a paper, and how it writes numbers.

use crate::number::MISSING;

/// Language of a report.
///
/// ```
/// use kinetostat_report::Language;
///
/// assert_eq!(Language::German.code(), "de");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Language {
    /// English: decimal point.
    #[default]
    English,
    /// French: decimal comma.
    French,
    /// German: decimal comma.
    German,
}

impl Language {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::English, Self::French, Self::German];

    /// Code of two letters, as ISO 639-1 has it.
    #[must_use]
    pub fn code(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::French => "fr",
            Self::German => "de",
        }
    }

    /// A figure as the report has it, with the decimal sign of the language: a point between two digits becomes a comma.
    /// Thousands stay apart by narrow spaces, which all three languages read alike.
    pub(crate) fn figure(self, text: &str, words: &FigureWords) -> String {
        if text == MISSING {
            return words.missing.to_owned();
        }
        if self == Self::English {
            return text.to_owned();
        }
        if let Some(rest) = text.strip_prefix("below ") {
            return format!("{} {}", words.below, self.figure(rest, words));
        }
        let letters: Vec<char> = text.chars().collect();
        let digit = |at: Option<usize>| {
            at.and_then(|at| letters.get(at))
                .is_some_and(char::is_ascii_digit)
        };
        let decimal =
            |at: usize| letters[at] == '.' && digit(at.checked_sub(1)) && digit(Some(at + 1));
        let in_language = (0..letters.len()).map(|at| match decimal(at) {
            true => ',',
            false => letters[at],
        });
        let text: String = in_language.collect();
        // The unit of angles is written as the language says it.
        match text.strip_suffix("\u{202f}deg") {
            Some(number) => format!("{number}°"),
            None => text,
        }
    }
}

/// Words in place of figures.
pub(crate) struct FigureWords {
    /// Text without a figure.
    pub(crate) missing: &'static str,
    /// Word before the bound of a figure too small to be shown.
    pub(crate) below: &'static str,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_the_decimal_sign_of_their_language() {
        let words = FigureWords {
            missing: "nicht bekannt",
            below: "unter",
        };
        let german = |text: &str| Language::German.figure(text, &words);
        assert_eq!(german("0.759\u{202f}mm"), "0,759\u{202f}mm");
        assert_eq!(
            german("1\u{202f}234.5\u{202f}N m"),
            "1\u{202f}234,5\u{202f}N m"
        );
        assert_eq!(german("below 0.001\u{202f}µm"), "unter 0,001\u{202f}µm");
        assert_eq!(german("0.420\u{202f}deg"), "0,420°");
        assert_eq!(german(MISSING), "nicht bekannt");
        assert_eq!(
            Language::English.figure("0.420\u{202f}deg", &words),
            "0.420\u{202f}deg"
        );
    }
}
