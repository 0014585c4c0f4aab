//! Shares as horizontal bars.

use kinetostat_machining::number::{larger, smaller};

use crate::chart::label::title_lines;
use crate::svg::{Anchor, Svg};
use crate::text;

const WIDTH: f64 = 760.0;
/// Height of a bar with its gap, pixels.
const ROW: f64 = 24.0;
/// Room for names on the left, and for figures on the right.
const NAMES: f64 = 230.0;
const FIGURES: f64 = 80.0;

const STYLE: &str = concat!(
    include_str!("../template/palette.css"),
    include_str!("../template/plot.css"),
    "svg rect.share{fill:var(--after)}svg rect.negative{fill:var(--before)}"
);

/// Bars from zero, in the order in which they are given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bars {
    /// Title of the chart.
    pub title: String,
    /// The bars.
    pub bars: Vec<Bar>,
}

/// A bar with its name and its figure in words.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bar {
    /// Text before the bar.
    pub name: String,
    /// Length of the bar, to the left if negative. A value that is not finite has no bar.
    pub value: f64,
    /// Text behind the bar.
    pub figure: String,
}

impl Bars {
    /// Draws an SVG document with its own style.
    #[must_use]
    pub fn svg(&self) -> String {
        let mut svg = Svg::default();
        let titles = title_lines(&self.title, WIDTH - 36.0);
        let top = 28.0 + 18.0 * titles.len() as f64;
        let height = top + ROW * self.bars.len().max(1) as f64 + 14.0;
        svg.rectangle("card", [0.5, 0.5], [WIDTH - 1.0, height - 1.0], 10.0);
        for (k, line) in titles.iter().enumerate() {
            svg.text("title", [18.0, 28.0 + 18.0 * k as f64], Anchor::Start, line);
        }
        let values = || {
            self.bars
                .iter()
                .map(|bar| bar.value)
                .filter(|v| v.is_finite())
        };
        let low = values().fold(0.0, smaller);
        let high = values().fold(0.0, larger);
        let room = WIDTH - NAMES - FIGURES;
        let unit = room / (high - low).max(f64::MIN_POSITIVE);
        let zero = NAMES - low * unit;
        for (k, bar) in self.bars.iter().enumerate() {
            let y = top + ROW * k as f64;
            let name = text::shorten(&bar.name, 34);
            svg.text("name", [NAMES - 10.0, y + 14.0], Anchor::End, &name);
            let length = if bar.value.is_finite() {
                bar.value * unit
            } else {
                0.0
            };
            let (class, from) = match length < 0.0 {
                true => ("negative", zero + length),
                false => ("share", zero),
            };
            svg.rectangle(class, [from, y + 3.0], [length.abs(), ROW - 8.0], 2.0);
            let end = zero + length.max(0.0) + 8.0;
            svg.text("tick", [end, y + 14.0], Anchor::Start, &bar.figure);
        }
        let bottom = top + ROW * self.bars.len() as f64;
        svg.line("axis", [zero, top], [zero, bottom]);
        svg.document([WIDTH, height], &self.title, STYLE)
    }
}
