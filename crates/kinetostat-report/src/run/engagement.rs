//! The cut of a program as one picture: the stock from above, and below it what the cut asks along the path.

use kinetostat_machining::CuttingResult;

use crate::chart::plot::Plot;
use crate::chart::section::Section;
use crate::run::cutting::charts;
use crate::svg::{Anchor, Svg};

/// Width of the picture, that of a section, pixels.
const WIDTH: f64 = 760.0;

/// Style of bands.
const AREA: &str = include_str!("../template/area.css");

/// Room around the charts, pixels.
const MARGIN: f64 = 16.0;

/// The picture as a document; `map` is the stock, where it is known.
pub(crate) fn draw(cutting: &CuttingResult, map: Option<&Section>, title: &str) -> String {
    let mut svg = Svg::default();
    let mut down = 0.0;
    if let Some(map) = map {
        let (drawn, size) = map.fitted();
        svg.below(0.0, &drawn);
        down = size[1] + 8.0;
    }
    let mut lower = Svg::default();
    let height = match charts(cutting, WIDTH - 2.0 * MARGIN) {
        Some((charts, height)) => {
            lower.at([MARGIN, 12.0], &charts);
            height + 24.0
        }
        None => {
            lower.text(
                "name",
                [0.5 * WIDTH, 60.0],
                Anchor::Middle,
                "nothing is cut",
            );
            110.0
        }
    };
    let mut card = Svg::default();
    card.rectangle("card", [0.5, 0.5], [WIDTH - 1.0, height - 1.0], 10.0);
    svg.below(down, &card);
    svg.below(down, &lower);
    let style = [Plot::style(), Section::style(), AREA].concat();
    svg.document([WIDTH, down + height], title, &style)
}
