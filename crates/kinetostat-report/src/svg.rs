//! Writer of SVG: shapes with classes; colours, dashes and fonts are the style sheet's business.

use std::fmt::Write as _;

use crate::literal::without_variables;
use crate::text::escape;

/// A point of a drawing, in pixels.
pub(crate) type Pixel = [f64; 2];

/// Anchor of a text.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// An SVG drawing under construction, in pixels.
#[derive(Default)]
pub(crate) struct Svg {
    body: String,
}

impl Svg {
    pub(crate) fn line(&mut self, class: &str, from: Pixel, to: Pixel) {
        let _ = write!(
            self.body,
            "<path class=\"{class}\" d=\"M{} {}L{} {}\"/>",
            pixel(from[0]),
            pixel(from[1]),
            pixel(to[0]),
            pixel(to[1])
        );
    }

    /// A path from ready-made path data; nothing if it is empty.
    pub(crate) fn path(&mut self, class: &str, data: &str) {
        if !data.is_empty() {
            let _ = write!(self.body, "<path class=\"{class}\" d=\"{data}\"/>");
        }
    }

    pub(crate) fn rectangle(&mut self, class: &str, corner: Pixel, size: [f64; 2], radius: f64) {
        let _ = write!(
            self.body,
            "<rect class=\"{class}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"",
            pixel(corner[0]),
            pixel(corner[1]),
            pixel(size[0].max(0.0)),
            pixel(size[1].max(0.0))
        );
        if radius > 0.0 {
            let _ = write!(self.body, " rx=\"{}\"", pixel(radius));
        }
        self.body.push_str("/>");
    }

    /// A ring with a text that appears when the pointer rests on it.
    pub(crate) fn marker(&mut self, class: &str, at: Pixel, tooltip: &str) {
        let _ = write!(
            self.body,
            "<circle class=\"{class}\" cx=\"{}\" cy=\"{}\" r=\"4.5\"><title>{}</title></circle>",
            pixel(at[0]),
            pixel(at[1]),
            escape(tooltip)
        );
    }

    pub(crate) fn text(&mut self, class: &str, at: Pixel, anchor: Anchor, text: &str) {
        let _ = write!(
            self.body,
            "<text class=\"{class}\" x=\"{}\" y=\"{}\"{}>{}</text>",
            pixel(at[0]),
            pixel(at[1]),
            anchor_attribute(anchor),
            escape(text)
        );
    }

    /// Text that reads upwards, centred at a point.
    pub(crate) fn text_upwards(&mut self, class: &str, at: Pixel, text: &str) {
        let _ = write!(
            self.body,
            "<text class=\"{class}\" transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            pixel(at[0]),
            pixel(at[1]),
            escape(text)
        );
    }

    /// Draws another drawing, so many pixels below the top of this one.
    pub(crate) fn below(&mut self, down: f64, other: &Self) {
        self.at([0.0, down], other);
    }

    /// Draws another drawing with its corner at a place of this one.
    pub(crate) fn at(&mut self, [right, down]: Pixel, other: &Self) {
        let _ = write!(
            self.body,
            "<g transform=\"translate({} {})\">{}</g>",
            pixel(right),
            pixel(down),
            other.body
        );
    }

    /// Shows the part of another drawing in a rectangle of this one.
    pub(crate) fn window(&mut self, corner: Pixel, size: [f64; 2], other: &Self) {
        let [x, y, width, height] = [corner[0], corner[1], size[0], size[1]].map(pixel);
        let _ = write!(
            self.body,
            "<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" viewBox=\"{x} {y} {width} {height}\">{}</svg>",
            other.body
        );
    }

    /// The drawing as an element for a page.
    pub(crate) fn inline(&self, class: &str, size: [f64; 2], description: &str) -> String {
        format!(
            "<svg class=\"{class}\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">{}</svg>",
            pixel(size[0]),
            pixel(size[1]),
            escape(description),
            self.body
        )
    }

    /// The drawing as a document with its own style, whose colours programs without variables of style sheets know, too.
    pub(crate) fn document(&self, size: [f64; 2], description: &str, style: &str) -> String {
        let [width, height] = size.map(pixel);
        let style = without_variables(style);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{}\"><style>{style}</style>{}</svg>\n",
            escape(description),
            self.body
        )
    }
}

/// A coordinate with at most one decimal; a value that is no number becomes 0 so that the file stays valid.
pub(crate) fn pixel(value: f64) -> String {
    tenths(to_tenths(value))
}

/// A coordinate in tenths of a pixel.
pub(crate) fn to_tenths(value: f64) -> i64 {
    if value.is_finite() {
        (value.clamp(-1e6, 1e6) * 10.0).round() as i64
    } else {
        0
    }
}

/// Tenths of a pixel as text.
pub(crate) fn tenths(value: i64) -> String {
    let sign = if value < 0 { "-" } else { "" };
    let value = value.unsigned_abs();
    match value % 10 {
        0 => format!("{sign}{}", value / 10),
        fraction => format!("{sign}{}.{fraction}", value / 10),
    }
}

fn anchor_attribute(anchor: Anchor) -> &'static str {
    match anchor {
        Anchor::Start => "",
        Anchor::Middle => " text-anchor=\"middle\"",
        Anchor::End => " text-anchor=\"end\"",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_short_and_valid() {
        assert_eq!(pixel(12.0), "12");
        assert_eq!(pixel(-0.25), "-0.3");
        assert_eq!(pixel(f64::NAN), "0");
        assert_eq!(pixel(f64::MAX), "0".replace('0', "1000000"));
    }

    #[test]
    fn text_is_escaped() {
        let mut svg = Svg::default();
        svg.text("a", [0.0, 0.0], Anchor::Start, "<script>");
        assert!(!svg.inline("x", [1.0, 1.0], "\"<b>").contains("<script"));
    }
}
