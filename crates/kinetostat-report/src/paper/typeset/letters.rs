//! The letters of a paper: Noto Sans, regular and bold, in the program. Widths in points.

use krilla::text::{Font, GlyphId, KrillaGlyph};
use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::{FontRef, MetadataProvider};

pub(super) static REGULAR: &[u8] = include_bytes!("../../../fonts/NotoSans-Regular.ttf");
pub(super) static BOLD: &[u8] = include_bytes!("../../../fonts/NotoSans-Bold.ttf");

/// Name of both.
pub(super) const FAMILY: &str = "Noto Sans";

/// A kind of letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    Regular,
    Bold,
}

/// Regular and bold type.
pub(super) struct Letters {
    regular: Face,
    bold: Face,
}

/// One kind: letters to draw, and their widths.
struct Face {
    font: Font,
    widths: GlyphMetrics<'static>,
    letters: skrifa::charmap::Charmap<'static>,
    per_em: f32,
}

impl Face {
    fn of(bytes: &'static [u8]) -> Option<Self> {
        let file = FontRef::new(bytes).ok()?;
        let font = Font::new(bytes.into(), 0)?;
        Some(Self {
            per_em: font.units_per_em(),
            font,
            widths: file.glyph_metrics(Size::unscaled(), LocationRef::default()),
            letters: file.charmap(),
        })
    }

    /// Number and width, in parts of the size of the letters; none of what it has no letter for.
    fn letter(&self, letter: char) -> Option<(u32, f32)> {
        let id = self.letters.map(letter)?;
        Some((id.to_u32(), self.widths.advance_width(id)? / self.per_em))
    }
}

impl Letters {
    /// The letters in the program; none never happens, for tests read them.
    pub(super) fn new() -> Option<Self> {
        Some(Self {
            regular: Face::of(REGULAR)?,
            bold: Face::of(BOLD)?,
        })
    }

    fn face(&self, weight: Weight) -> &Face {
        match weight {
            Weight::Regular => &self.regular,
            Weight::Bold => &self.bold,
        }
    }

    pub(super) fn font(&self, weight: Weight) -> Font {
        self.face(weight).font.clone()
    }

    /// Text with letters that there are: others, of names in other scripts, stand as their number, `<U+4E2D>`.
    pub(super) fn writable(&self, text: &str) -> String {
        let mut out = String::with_capacity(text.len());
        for letter in text.chars() {
            match self.regular.letter(letter).and(self.bold.letter(letter)) {
                Some(_) => out.push(letter),
                None => out.push_str(&format!("<U+{:04X}>", u32::from(letter))),
            }
        }
        out
    }

    /// Width of a text.
    pub(super) fn width(&self, text: &str, weight: Weight, size: f32) -> f32 {
        let face = self.face(weight);
        let widths = text.chars().filter_map(|c| face.letter(c));
        size * widths.map(|(_, width)| width).sum::<f32>()
    }

    /// The text as letters to draw.
    pub(super) fn glyphs(&self, text: &str, weight: Weight) -> Vec<KrillaGlyph> {
        let face = self.face(weight);
        let all = text.char_indices().filter_map(|(at, letter)| {
            let (id, width) = face.letter(letter)?;
            let range = at..at + letter.len_utf8();
            Some(KrillaGlyph::new(
                GlyphId::new(id),
                width,
                0.0,
                0.0,
                0.0,
                range,
                None,
            ))
        });
        all.collect()
    }

    /// A text in lines that are not wider than `most`: between words, and inside of what is longer than a line (names of files).
    pub(super) fn lines(&self, text: &str, weight: Weight, size: f32, most: f32) -> Vec<String> {
        let mut lines = Vec::new();
        let mut line = String::new();
        for word in words(text) {
            let with = match line.is_empty() {
                true => word.clone(),
                false => format!("{line} {word}"),
            };
            if self.width(&with, weight, size) <= most {
                line = with;
                continue;
            }
            if !line.is_empty() {
                lines.push(std::mem::take(&mut line));
            }
            for letter in word.chars() {
                line.push(letter);
                if self.width(&line, weight, size) > most && line.chars().count() > 1 {
                    line.pop();
                    lines.push(std::mem::take(&mut line));
                    line.push(letter);
                }
            }
        }
        if !line.is_empty() || lines.is_empty() {
            lines.push(line);
        }
        lines
    }
}

/// Words between which a line may be broken: signs that stand alone, as in French, belong to the word before.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        let alone = matches!(word, ":" | ";" | "!" | "?" | "»" | "%" | "…");
        match words.last_mut().filter(|_| alone) {
            Some(last) => {
                last.push('\u{a0}');
                last.push_str(word);
            }
            None => words.push(word.to_owned()),
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_not_wider_than_they_may_be_and_lose_nothing() {
        let letters = Letters::new().expect("the letters can be read");
        let text = "Wo das Werkzeug ohne Kompensation am weitesten abliegt : /sehr/langer/Pfad/ohne/Leerzeichen/größer.ngc";
        let lines = letters.lines(text, Weight::Regular, 9.0, 70.0);
        assert!(lines.len() > 4, "{lines:?}");
        for line in &lines {
            assert!(
                letters.width(line, Weight::Regular, 9.0) <= 70.0,
                "{line:?}"
            );
        }
        let plain = |text: &str| text.replace([' ', '\u{a0}'], "");
        assert_eq!(plain(&lines.concat()), plain(text));
    }

    #[test]
    fn there_are_letters_for_all_three_languages_and_for_figures() {
        let letters = Letters::new().expect("the letters can be read");
        let text = "äöüÄÖÜß àâçéèêëîïôùûœŒÀÉÈ’«» −×±µ°…–“”„ \u{202f}10⁻⁹ αβμ Ж";
        assert_eq!(letters.writable(text), text);
        assert_eq!(letters.writable("中.ngc"), "<U+4E2D>.ngc");
    }
}
