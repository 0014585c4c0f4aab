//! A plot of curves over numbers: lines solid or dashed, named points, axes with units.
//!
//! For force-deflection curves and for the figures of `reproduce`: stable branches are solid, unstable
//! ones dashed, limit and bifurcation points carry their names.

use crate::axis::{Scale, Span};
use crate::chart::legend;
use crate::label::{Frame, Labels, TEXT_SIZE};
use crate::outline::path_data;
use crate::svg::{Anchor, Svg};
use crate::{number, text};

const SIZE: (f64, f64) = (760.0, 480.0);

const STYLE: &str = concat!(
    include_str!("template/palette.css"),
    include_str!("template/plot.css")
);

/// Colours of lines, told apart also without colour vision; further lines begin again.
const COLOURS: [&str; 6] = ["c0", "c1", "c2", "c3", "c4", "c5"];

/// A plot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    /// What is shown, above the frame.
    pub title: String,
    /// Quantity and unit of the horizontal axis, as in `displacement along x, mm`.
    pub x_label: String,
    /// Quantity and unit of the vertical axis.
    pub y_label: String,
    /// The curves, drawn in order.
    pub lines: Vec<PlotLine>,
    /// Points with names.
    pub marks: Vec<PlotMark>,
}

/// One curve, or a part of one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlotLine {
    /// Name in the legend; lines of the same name, colour and kind share an entry; none without a name.
    pub name: String,
    /// Number of the colour, 0 to 5.
    pub colour: usize,
    /// Dashed: unstable.
    pub dashed: bool,
    /// Abscissa and ordinate; a value that is not finite lifts the pen.
    pub points: Vec<(f64, f64)>,
}

/// A named point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlotMark {
    /// Abscissa and ordinate.
    pub at: (f64, f64),
    /// Short name, written beside it where there is room.
    pub name: String,
    /// More words, shown when the pointer rests on it.
    pub detail: String,
}

impl Plot {
    /// The plot as an SVG document with its own style, right on light and on dark pages.
    #[must_use]
    pub fn svg(&self) -> String {
        self.draw().document(SIZE, &self.title, STYLE)
    }

    /// As [`Plot::svg`] with one unit as long on both axes: for shapes.
    #[must_use]
    pub fn shape_svg(&self) -> String {
        self.draw().document(SIZE, &self.title, STYLE)
    }

    /// The plot as an element for a page that carries [`Plot::style`].
    #[must_use]
    pub fn element(&self) -> String {
        self.draw().inline("plot", SIZE, &self.title)
    }

    /// The style sheet of elements.
    #[must_use]
    pub fn style() -> &'static str {
        STYLE
    }

    fn spans(&self) -> Option<(Span, Span)> {
        let points = || {
            let lines = self.lines.iter().flat_map(|l| l.points.iter().copied());
            lines
                .chain(self.marks.iter().map(|m| m.at))
                .filter(|p| p.0.is_finite() && p.1.is_finite())
        };
        let x = Span::of(points().map(|p| p.0))?;
        let y = Span::of(points().map(|p| p.1))?;
        Some((
            x.with_near_zero().widened(),
            y.with_near_zero().widened().padded(0.05, 0.05),
        ))
    }

    fn draw(&self) -> Svg {
        let mut svg = Svg::default();
        svg.rectangle("card", (0.5, 0.5), (SIZE.0 - 1.0, SIZE.1 - 1.0), 10.0);
        let Some((x_span, y_span)) = self.spans() else {
            let middle = (0.5 * SIZE.0, 0.5 * SIZE.1);
            svg.text("name", middle, Anchor::Middle, "no points to show");
            return svg;
        };
        svg.text("title", (18.0, 28.0), Anchor::Start, &self.title);
        let mut entries: Vec<(String, String)> = Vec::new();
        for line in self.lines.iter().filter(|l| !l.name.is_empty()) {
            let entry = (class(line), line.name.clone());
            if !entries.contains(&entry) {
                entries.push(entry);
            }
        }
        let named: Vec<(&str, String)> = entries
            .iter()
            .map(|(class, name)| (class.as_str(), name.clone()))
            .collect();
        let legend_height = if named.is_empty() {
            0.0
        } else {
            legend(&mut svg, &named, (18.0, 50.0), SIZE.0 - 18.0)
        };
        let y_ticks = y_span.ticks(7);
        let widest = y_ticks
            .iter()
            .map(|tick| text::width(&tick.label, TEXT_SIZE))
            .fold(0.0, f64::max);
        let top = 44.0 + legend_height;
        let left = widest + 46.0;
        let frame = Frame {
            x: left,
            y: top,
            width: SIZE.0 - left - 24.0,
            height: SIZE.1 - top - 54.0,
        };
        let x = Scale::new(x_span, frame.x, frame.right());
        let y = Scale::new(y_span, frame.bottom(), frame.y);
        svg.rectangle(
            "ground",
            (frame.x, frame.y),
            (frame.width, frame.height),
            0.0,
        );
        for tick in &y_ticks {
            let at = y.at(tick.value);
            svg.line("grid", (frame.x, at), (frame.right(), at));
            svg.text("tick", (frame.x - 7.0, at + 4.2), Anchor::End, &tick.label);
        }
        for tick in x_span.ticks(8) {
            let at = x.at(tick.value);
            svg.line("grid", (at, frame.y), (at, frame.bottom()));
            let base = frame.bottom() + 17.0;
            svg.text("tick", (at, base), Anchor::Middle, &tick.label);
        }
        svg.line("axis", (frame.x, frame.y), (frame.x, frame.bottom()));
        svg.line(
            "axis",
            (frame.x, frame.bottom()),
            (frame.right(), frame.bottom()),
        );
        let below = (frame.x + 0.5 * frame.width, frame.bottom() + 38.0);
        svg.text("name", below, Anchor::Middle, &self.x_label);
        let beside = (20.0, frame.y + 0.5 * frame.height);
        svg.text_upwards("name", beside, &self.y_label);
        let pixel = |p: &(f64, f64)| {
            let x = x.at(number::drawable(p.0)?);
            let y = y.at(number::drawable(p.1)?);
            Some((x, y))
        };
        for line in &self.lines {
            let pixels: Vec<_> = line.points.iter().map(pixel).collect();
            svg.path(&class(line), &path_data(&pixels));
        }
        let mut labels = Labels::default();
        let at: Vec<_> = self.marks.iter().map(|m| pixel(&m.at)).collect();
        for (mark, at) in self.marks.iter().zip(&at) {
            let Some(at) = at else { continue };
            let tooltip = if mark.detail.is_empty() {
                &mark.name
            } else {
                &mark.detail
            };
            svg.marker("mark", *at, tooltip);
            labels.reserve(Frame {
                x: at.0 - 5.0,
                y: at.1 - 5.0,
                width: 10.0,
                height: 10.0,
            });
        }
        for (mark, at) in self.marks.iter().zip(&at) {
            if let Some(at) = at {
                labels.place(&mut svg, "mark-name", &frame, *at, (0.0, -1.0), &mark.name);
            }
        }
        svg
    }
}

fn class(line: &PlotLine) -> String {
    let colour = COLOURS[line.colour % COLOURS.len()];
    let dashed = if line.dashed { " dashed" } else { "" };
    format!("line {colour}{dashed}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stable_is_solid_and_unstable_dashed_with_a_legend_entry_each() {
        let line = |dashed, name: &str| PlotLine {
            name: name.into(),
            colour: 0,
            dashed,
            points: vec![(0.0, 0.0), (1.0, 2.0), (f64::NAN, 1.0), (2.0, 1.0)],
        };
        let plot = Plot {
            title: "force <and> deflection".into(),
            x_label: "displacement, mm".into(),
            y_label: "force, N".into(),
            lines: vec![
                line(false, "stable"),
                line(true, "unstable"),
                line(false, "stable"),
            ],
            marks: vec![PlotMark {
                at: (1.0, 2.0),
                name: "limit point".into(),
                detail: String::new(),
            }],
        };
        let svg = plot.svg();
        assert_eq!(svg.matches(">stable<").count(), 1);
        assert_eq!(svg.matches("c0 dashed").count(), 2); // line and legend
        assert!(svg.contains("limit point") && svg.contains("displacement, mm"));
        assert!(!svg.contains("NaN") && !svg.contains("<and>"));
        assert!(Plot::default().svg().contains("no points to show"));
    }
}
