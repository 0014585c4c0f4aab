//! Panels under each other with one axis along the path.

use crate::chart::axis::Span;
use crate::chart::label::Frame;
use crate::chart::panel::{Along, Panel, legend};
use crate::svg::Svg;

/// Heights of the frames of panels that have none of their own, pixels.
const HEIGHT: f64 = 130.0;

/// Panels with the heights of their frames on a drawing of a width, and below them what the names of lines mean; gives the
/// drawing and its height.
pub(crate) fn stack(
    panels: &[Panel],
    heights: &[f64],
    along: &Along,
    width: f64,
    names: &[(&str, String)],
) -> (Svg, f64) {
    let mut svg = Svg::default();
    let heights = || heights.iter().copied().chain(std::iter::repeat(HEIGHT));
    let gutter = panels
        .iter()
        .zip(heights())
        .map(|(p, h)| p.gutter(h))
        .fold(0.0, f64::max);
    let room = Span {
        low: 4.0,
        high: width - 4.0,
    };
    let mut y = 26.0;
    for (index, (panel, height)) in panels.iter().zip(heights()).enumerate() {
        y += panel.more_title(room.length());
        let frame = Frame {
            x: gutter,
            y,
            width: width - gutter - 14.0,
            height,
        };
        panel.draw(&mut svg, frame, room, along, index + 1 == panels.len());
        y += height + 42.0;
    }
    y += 14.0;
    let mut entries = names.to_vec();
    if along.has_rapids() {
        entries.push(("rapids", "rapid move (nothing is cut)".to_owned()));
    }
    if !entries.is_empty() {
        y += legend(&mut svg, &entries, [gutter, y], width);
    }
    (svg, y - 8.0)
}
