//! Digits behind the point in a written program.

use serde::{Deserialize, Serialize};

/// Fewest and most digits behind the point of numbers that a written program states and the original does not; none where there is no
/// such number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct WrittenDecimals {
    /// Lengths.
    pub lengths: Option<[u8; 2]>,
    /// Angles, quaternions and directions.
    pub angles: Option<[u8; 2]>,
}

impl WrittenDecimals {
    pub(crate) fn of_lengths(digits: u8) -> Self {
        Self {
            lengths: Some([digits; 2]),
            angles: None,
        }
    }

    pub(crate) fn of_angles(digits: u8) -> Self {
        Self {
            lengths: None,
            angles: Some([digits; 2]),
        }
    }

    /// Takes those of another part.
    pub(crate) fn merge(&mut self, next: &Self) {
        for (own, next) in [
            (&mut self.lengths, next.lengths),
            (&mut self.angles, next.angles),
        ] {
            *own = match (*own, next) {
                (Some([a, b]), Some([c, d])) => Some([a.min(c), b.max(d)]),
                (own, next) => own.or(next),
            };
        }
    }

    /// Digits of lengths and of angles, as in `4` and `6 to 8` (`to` in the language of the text). Where no number was written, lengths
    /// have the digits that were asked for.
    ///
    /// ```
    /// let none = kinetostat_machining::WrittenDecimals::default();
    /// assert_eq!(none.shown(4, "to"), ("4".to_owned(), None));
    /// ```
    #[must_use]
    pub fn shown(&self, asked: u8, to: &str) -> (String, Option<String>) {
        let text = |[fewest, most]: [u8; 2]| match fewest == most {
            true => fewest.to_string(),
            false => format!("{fewest} {to} {most}"),
        };
        let lengths = self.lengths.unwrap_or([asked; 2]);
        (text(lengths), self.angles.map(text))
    }
}
