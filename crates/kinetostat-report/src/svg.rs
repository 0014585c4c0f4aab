//! Writer of SVG: shapes with classes; colours, dashes and fonts are the style sheet's business. Style sheets of documents of their
//! own have colours in place of variables.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

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

    /// Draws another drawing in the same place.
    pub(crate) fn append(&mut self, other: &Self) {
        self.body.push_str(&other.body);
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
        let style = without_variables(style) + FITTING;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{}\"><style>{style}</style>{}</svg>\n",
            escape(description),
            self.body
        )
    }
}

/// A document is shown in its own size where there is room, and smaller on a narrow page.
pub(crate) const FITTING: &str = "svg:root{max-width:100%;height:auto}";

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

/// Media query of dark pages, which begins the second half of a sheet.
const DARK: &str = "@media screen and (prefers-color-scheme:dark)";

/// A style sheet without variables: first with the values of light pages, then, for dark ones, once more what the variables
/// colour. Word processors, drawing programs and converters know neither variables nor dark pages; they draw the first half,
/// where they would draw all in black.
pub(crate) fn without_variables(style: &str) -> String {
    let (mut light, mut dark) = (BTreeMap::new(), BTreeMap::new());
    // True for a rule of dark pages alone, its head and its body.
    let mut rules = Vec::new();
    for (head, body) in blocks(style) {
        if head == DARK {
            let inner = blocks(body);
            dark.extend(inner.iter().flat_map(|(_, body)| variables(body)));
            rules.extend(inner.into_iter().map(|(head, body)| (true, head, body)));
        } else {
            // The first value counts.
            for (name, value) in variables(body) {
                light.entry(name).or_insert(value);
            }
            rules.push((false, head, body));
        }
    }
    let coloured: BTreeSet<&str> = (rules.iter())
        .flat_map(|(_, _, body)| declarations(body))
        .filter(|(_, value)| value.contains("var("))
        .map(|(name, _)| name)
        .collect();
    // Variables without a dark value have their light one.
    let has_dark = !dark.is_empty();
    let mut dark_or_light = light.clone();
    dark_or_light.append(&mut dark);
    let (mut out, mut night) = (String::new(), String::new());
    for (at_night, head, body) in rules {
        let own = || declarations(body).filter(|(name, _)| !name.starts_with("--"));
        if !at_night {
            rule(&mut out, head, own(), &light);
        }
        // Keeps the order of the sheet, so that later rules override earlier ones there, too.
        let kept = own().filter(|(name, _)| at_night || coloured.contains(name));
        rule(&mut night, head, kept, &dark_or_light);
    }
    if has_dark {
        out.push_str(DARK);
        out.push('{');
        out.push_str(&night);
        out.push('}');
    }
    out
}

type Values<'s> = BTreeMap<&'s str, &'s str>;

/// Heads and bodies of the outermost blocks.
fn blocks(style: &str) -> Vec<(&str, &str)> {
    let (mut all, mut depth, mut from, mut opened) = (Vec::new(), 0_usize, 0, 0);
    for (at, sign) in style.char_indices() {
        match sign {
            '{' => {
                if depth == 0 {
                    opened = at;
                }
                depth += 1;
            }
            '}' => {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    all.push((style[from..opened].trim(), &style[opened + 1..at]));
                    from = at + 1;
                }
            }
            _ => {}
        }
    }
    all
}

fn declarations(body: &str) -> impl Iterator<Item = (&str, &str)> {
    let all = body.split(';').filter_map(|own| own.split_once(':'));
    all.map(|(name, value)| (name.trim(), value.trim()))
}

fn variables(body: &str) -> impl Iterator<Item = (&str, &str)> {
    declarations(body).filter(|(name, _)| name.starts_with("--"))
}

/// A rule with values in place of variables; nothing without a declaration.
fn rule<'s>(
    out: &mut String,
    head: &str,
    kept: impl Iterator<Item = (&'s str, &'s str)>,
    values: &Values<'_>,
) {
    let all: Vec<String> = kept
        .map(|(name, value)| format!("{name}:{}", valued(value, values)))
        .collect();
    if !all.is_empty() {
        out.push_str(head);
        out.push('{');
        out.push_str(&all.join(";"));
        out.push('}');
        out.push('\n');
    }
}

/// A value with those of its variables; one that has none stays.
fn valued(value: &str, values: &Values<'_>) -> String {
    let (mut rest, mut out) = (value, String::new());
    while let Some((before, after)) = rest.split_once("var(") {
        let (name, behind) = after.split_once(')').unwrap_or((after, ""));
        out.push_str(before);
        match values.get(name.trim()) {
            Some(value) => out.push_str(value),
            None => out.push_str(&format!("var({name})")),
        }
        rest = behind;
    }
    out + rest
}

/// A drawing within an attribute: an image has a style sheet of its own, which does not reach the page.
pub(crate) fn picture_address(svg: &str) -> String {
    let mut out = "data:image/svg+xml,".to_owned();
    for letter in svg.chars() {
        match letter {
            '%' | '#' | '"' | '<' | '>' | '&' | '\n' => {
                let _ = write!(out, "%{:02X}", u32::from(letter));
            }
            other => out.push(other),
        }
    }
    out
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

    #[test]
    fn values_stand_for_variables_on_light_and_on_dark_pages() {
        let style = ":root{--a:#123;--b:#fff}\n@media screen and (prefers-color-scheme:dark){:root{--a:#eee}.v{r:5}}\n\
                     svg{--c:red}.x{fill:none;stroke:var(--a)}.y,.z{fill:var(--c);r:2}.w{stroke:var(--b);r:3;border:1px solid var(--a)}";
        assert_eq!(
            without_variables(style),
            ".x{fill:none;stroke:#123}\n.y,.z{fill:red;r:2}\n.w{stroke:#fff;r:3;border:1px solid #123}\n\
             @media screen and (prefers-color-scheme:dark){\
             .v{r:5}\n.x{fill:none;stroke:#eee}\n.y,.z{fill:red}\n.w{stroke:#fff;border:1px solid #eee}\n}"
        );
        assert_eq!(without_variables(""), "");
        assert_eq!(without_variables("a{b:c}"), "a{b:c}\n");
    }

    #[test]
    fn a_document_fits_a_narrow_page() {
        let document = Svg::default().document([760.0, 480.0], "wide", "");
        assert!(document.contains("width=\"760\"") && document.contains("viewBox"));
        assert!(
            document.contains("max-width:100%;height:auto"),
            "{document}"
        );
    }

    #[test]
    fn no_variable_is_left_in_documents_of_this_crate() {
        let plot = crate::chart::plot::Plot::default().svg();
        let chatter = crate::chatter_svg("x", &kinetostat_machining::ChatterResult::default());
        for document in [plot, chatter] {
            assert!(
                !document.contains("var(") && !document.contains("--"),
                "{document}"
            );
        }
    }
}
