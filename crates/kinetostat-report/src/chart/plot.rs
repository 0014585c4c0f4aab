//! A plot of curves over numbers: lines solid or dashed, named points, axes with units.
//!
//! For force-deflection curves and for the figures of `reproduce`: stable branches are solid, unstable
//! ones dashed, limit and bifurcation points carry their names.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::chart::label::{Frame, Names, title_lines, widest};
use crate::chart::outline::{Drawn, path_data};
use crate::chart::panel::legend;
use crate::chart::{Scale, Span, Tick};
use crate::number;
use crate::svg::{Anchor, Pixel, Svg, pixel};

const SIZE: [f64; 2] = [760.0, 480.0];

/// Height of a plot below another.
const LOWER_HEIGHT: f64 = 300.0;

const STYLE: &str = concat!(
    include_str!("../template/palette.css"),
    include_str!("../template/plot.css")
);

/// Style of a plot.
#[derive(Clone, Copy, Default)]
pub(crate) struct Look<'a> {
    /// One unit is as long on both axes.
    pub(crate) shape: bool,
    /// Values of the horizontal and of the vertical axis are decimal logarithms.
    pub(crate) decades: [bool; 2],
    /// The horizontal axis begins where the data do, not at zero.
    pub(crate) tight: bool,
    /// Corners of shaded areas, below all lines; together they are one.
    pub(crate) areas: &'a [Vec<(f64, f64)>],
    /// Ticks have a decimal comma.
    pub(crate) comma: bool,
    /// Points that lie within the frame, though nothing is drawn there.
    pub(crate) within: &'a [(f64, f64)],
}

impl Look<'_> {
    fn ticks(&self, axis: usize, span: Span, wanted: usize) -> Vec<Tick> {
        let mut ticks = match self.decades[axis] {
            true => span.decade_ticks(),
            false => span.ticks(wanted),
        };
        if self.comma {
            ticks
                .iter_mut()
                .for_each(|t| t.label = t.label.replace('.', ","));
        }
        ticks
    }
}

/// Colours of lines, distinct also without colour vision; further lines begin again.
const COLOURS: [&str; 6] = ["c0", "c1", "c2", "c3", "c4", "c5"];

/// Curves in one frame with two axes, and named points on them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    /// Title above the frame.
    pub title: String,
    /// Quantity and unit of the horizontal axis, as in `displacement along x, mm`.
    pub x_label: String,
    /// Quantity and unit of the vertical axis.
    pub y_label: String,
    /// The curves, drawn in order, dashed ones below solid ones. What a dashed line repeats of another
    /// in its style is left out.
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
    /// Points alone: readings that scatter are not joined.
    pub dots: bool,
    /// Abscissa and ordinate; a value that is not finite lifts the pen.
    pub points: Vec<(f64, f64)>,
}

impl PlotLine {
    /// A solid line.
    #[must_use]
    pub fn solid(name: impl Into<String>, colour: usize, points: Vec<(f64, f64)>) -> Self {
        Self {
            name: name.into(),
            colour,
            dashed: false,
            dots: false,
            points,
        }
    }

    /// Points that are not joined.
    #[must_use]
    pub fn dots(name: impl Into<String>, colour: usize, points: Vec<(f64, f64)>) -> Self {
        Self {
            dots: true,
            ..Self::solid(name, colour, points)
        }
    }

    /// A dashed line.
    #[must_use]
    pub fn dashed(name: impl Into<String>, colour: usize, points: Vec<(f64, f64)>) -> Self {
        Self {
            dashed: true,
            ..Self::solid(name, colour, points)
        }
    }
}

/// A named point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlotMark {
    /// Abscissa and ordinate.
    pub at: (f64, f64),
    /// Short name, written beside it where there is room.
    pub name: String,
    /// Additional text, shown when the pointer rests on it.
    pub detail: String,
}

impl Plot {
    /// The plot as an SVG document with its own style, right on light and on dark pages.
    #[must_use]
    pub fn svg(&self) -> String {
        self.draw(&Look::default(), SIZE, 0.0)
            .document(SIZE, &self.title, STYLE)
    }

    /// Draws this plot and, below it, others over the same horizontal quantity, less high and with their frames in
    /// line.
    #[must_use]
    pub fn svg_above(&self, others: &[Self]) -> String {
        let all: Vec<(&Self, Look<'_>)> = std::iter::once(self)
            .chain(others)
            .map(|plot| (plot, Look::default()))
            .collect();
        stacked(&all, "")
    }

    /// Draws like [`Plot::svg`] with equal units on both axes: for shapes.
    #[must_use]
    pub fn shape_svg(&self) -> String {
        let look = Look {
            shape: true,
            ..Look::default()
        };
        self.draw(&look, SIZE, 0.0)
            .document(SIZE, &self.title, STYLE)
    }

    /// The plot as an element for a page that carries [`Plot::style`].
    #[must_use]
    pub fn element(&self) -> String {
        self.draw(&Look::default(), SIZE, 0.0)
            .inline("plot", SIZE, &self.title)
    }

    /// The style sheet of elements.
    #[must_use]
    pub fn style() -> &'static str {
        STYLE
    }

    fn spans(&self, look: &Look<'_>) -> Option<(Span, Span)> {
        let points = || {
            let lines = self.lines.iter().flat_map(|l| l.points.iter().copied());
            lines
                .chain(self.marks.iter().map(|m| m.at))
                .chain(look.areas.iter().flatten().copied())
                .chain(look.within.iter().copied())
                .filter(|p| p.0.is_finite() && p.1.is_finite())
        };
        let x = Span::of(points().map(|p| p.0))?;
        // Logarithms and shapes have room for a spike; a named point is shown wherever it is.
        let y = match look.shape || look.decades[1] {
            true => Span::of(points().map(|p| p.1))?,
            false => {
                let named = self.marks.iter().filter(|m| !m.name.is_empty());
                let named = Span::of(named.map(|m| m.at.1));
                let most = Span::without_spikes(points().map(|p| p.1))?;
                named.map_or(most, |named| named.joined(most))
            }
        };
        // Zero is no value of a logarithm to begin at.
        let begun = |span: Span, as_it_is: bool| match as_it_is {
            true => span.widened(),
            false => span.with_near_zero().widened(),
        };
        Some(if look.shape {
            let room = 0.05 * x.length().max(y.length());
            let wide = |s: Span| Span {
                low: s.low - room,
                high: s.high + room,
            };
            (wide(x).widened(), wide(y).widened())
        } else {
            (
                beyond(begun(x, look.decades[0] || look.tight)),
                match look.decades[1] {
                    true => begun(y, true),
                    false => begun(y, false).moderate(),
                }
                .padded(0.05, 0.05),
            )
        })
    }

    /// The last line that covers another from end to end, so that only one of them is seen; `height` is that of the frame.
    fn cover(&self, index: usize, height: f64) -> Option<&PlotLine> {
        let line = &self.lines[index];
        let order = |k: usize| (!self.lines[k].dashed, k);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-3 * height || (a.is_nan() && b.is_nan());
        let covers = |(k, over): &(usize, &PlotLine)| {
            let pairs = || over.points.iter().zip(&line.points);
            order(*k) > order(index)
                && !over.name.is_empty()
                && over.name != line.name
                && !(over.dots || line.dots)
                && over.points.len() == line.points.len()
                && pairs().all(|(a, b)| a.0.total_cmp(&b.0).is_eq() && near(a.1, b.1))
        };
        let mut all = self.lines.iter().enumerate();
        all.rfind(covers).map(|(_, over)| over)
    }

    /// Title and legend; returns the height that they take. `height` is that of the frame in the unit of the vertical axis.
    fn head(&self, svg: &mut Svg, height: f64) -> f64 {
        let mut base = 28.0;
        for line in title_lines(&self.title, SIZE[0] - 36.0) {
            svg.text("title", [18.0, base], Anchor::Start, &line);
            base += 18.0;
        }
        // Solid lines first, each group in the order of the lines.
        let mut entries: Vec<(String, String)> = Vec::new();
        for dashed in [false, true] {
            for (k, line) in self.lines.iter().enumerate() {
                let name = match self.cover(k, height) {
                    Some(over) => format!("{} (under {})", line.name, over.name),
                    None => line.name.clone(),
                };
                let entry = (class(line), name);
                if line.dashed == dashed && !line.name.is_empty() && !entries.contains(&entry) {
                    entries.push(entry);
                }
            }
        }
        let named: Vec<(&str, String)> = entries
            .iter()
            .map(|(class, name)| (class.as_str(), name.clone()))
            .collect();
        if !named.is_empty() {
            base += 4.0 + legend(svg, &named, [18.0, base + 4.0], SIZE[0] - 18.0);
        }
        base - 2.0
    }

    /// The plot in a size, its frame at least so far from the left edge.
    fn draw(&self, look: &Look<'_>, size: [f64; 2], least_left: f64) -> Svg {
        let mut svg = Svg::default();
        svg.rectangle("card", [0.5, 0.5], [size[0] - 1.0, size[1] - 1.0], 10.0);
        let Some((mut x_span, mut y_span)) = self.spans(look) else {
            let middle = size.map(|side| 0.5 * side);
            svg.text("name", middle, Anchor::Middle, "no points to show");
            return svg;
        };
        let top = self.head(&mut svg, y_span.length());
        let height = size[1] - top - 54.0;
        if look.shape {
            let width = size[0] - gutter(&look.ticks(1, y_span, 7)) - 24.0;
            let unit = (x_span.length() / width).max(y_span.length() / height);
            x_span = about(&x_span, unit * width);
            y_span = about(&y_span, unit * height);
        }
        let y_ticks = look.ticks(1, y_span, 7);
        let left = gutter(&y_ticks).max(least_left);
        let frame = Frame {
            x: left,
            y: top,
            width: size[0] - left - 24.0,
            height,
        };
        if look.shape {
            // The labels may need more room than before: the unit stays that of the height.
            x_span = about(&x_span, y_span.length() / height * frame.width);
        }
        let x = Scale::new(x_span, frame.x, frame.right());
        let y = Scale::new(y_span, frame.bottom(), frame.y);
        self.draw_axes(&mut svg, frame, &x, &y, [look.ticks(0, x_span, 8), y_ticks]);
        let pixel = |p: &(f64, f64)| {
            let x = x.at(number::drawable(p.0)?);
            let y = y.at(number::drawable(p.1)?);
            Some([x, y])
        };
        svg.path("unstable", &polygons(look.areas, pixel));
        let mut names = Names::within(frame);
        let spike = self.spike(y_span);
        let mut lines = Svg::default();
        self.draw_lines(&mut lines, &mut names, pixel);
        match spike {
            Some(_) => svg.window([frame.x, frame.y], [frame.width, frame.height], &lines),
            None => svg.append(&lines),
        }
        // What lies beyond is shown at the edge.
        let within = |p: &(f64, f64)| {
            let edge = |[x, y]: Pixel| match y {
                y if y < frame.y - 1.0 => [x, frame.y + 8.0],
                y if y > frame.bottom() + 1.0 => [x, frame.bottom() - 8.0],
                y => [x, y],
            };
            pixel(p).map(edge)
        };
        if let Some((at, arrow)) = spike
            && let Some(edge) = within(&at)
        {
            let value = number::significant(at.1, 4, number::Rounding::Nearest);
            names.write(&mut svg, edge, &format!("{arrow} up to {value}"));
        }
        self.draw_marks(&mut svg, &mut names, within);
        svg
    }

    /// The point that lies farthest beyond a span, and an arrow to it.
    fn spike(&self, span: Span) -> Option<((f64, f64), char)> {
        let points = self.lines.iter().flat_map(|line| line.points.iter());
        let points = points.copied().chain(self.marks.iter().map(|mark| mark.at));
        let beyond = |p: &(f64, f64)| match p.1 > span.high {
            true => p.1 - span.high,
            false => span.low - p.1,
        };
        let slack = 1e-9 * span.length();
        let outside = points.filter(|p| p.0.is_finite() && p.1.is_finite() && beyond(p) > slack);
        let farthest = outside.reduce(|a, b| if beyond(&b) > beyond(&a) { b } else { a })?;
        let arrow = match farthest.1 > span.high {
            true => '\u{2191}',
            false => '\u{2193}',
        };
        Some((farthest, arrow))
    }

    /// Ground, grid, ticks and the names of the axes.
    fn draw_axes(
        &self,
        svg: &mut Svg,
        frame: Frame,
        x: &Scale,
        y: &Scale,
        [x_ticks, y_ticks]: [Vec<Tick>; 2],
    ) {
        svg.rectangle(
            "ground",
            [frame.x, frame.y],
            [frame.width, frame.height],
            0.0,
        );
        for tick in &y_ticks {
            let at = y.at(tick.value);
            svg.line("grid", [frame.x, at], [frame.right(), at]);
            svg.text("tick", [frame.x - 7.0, at + 4.2], Anchor::End, &tick.label);
        }
        for tick in &x_ticks {
            let at = x.at(tick.value);
            svg.line("grid", [at, frame.y], [at, frame.bottom()]);
            let base = frame.bottom() + 17.0;
            svg.text("tick", [at, base], Anchor::Middle, &tick.label);
        }
        svg.line("axis", [frame.x, frame.y], [frame.x, frame.bottom()]);
        svg.line(
            "axis",
            [frame.x, frame.bottom()],
            [frame.right(), frame.bottom()],
        );
        let below = [frame.x + 0.5 * frame.width, frame.bottom() + 38.0];
        svg.text("name", below, Anchor::Middle, &self.x_label);
        let beside = [20.0, frame.y + 0.5 * frame.height];
        svg.text_upwards("name", beside, &self.y_label);
    }

    /// All curves; the names of points keep away from them.
    fn draw_lines(
        &self,
        svg: &mut Svg,
        names: &mut Names,
        pixel: impl Fn(&(f64, f64)) -> Option<Pixel>,
    ) {
        let mut drawn: BTreeMap<String, Drawn> = BTreeMap::new();
        // Solid lines lie on top of dashed ones.
        for dashed in [true, false] {
            for line in self.lines.iter().filter(|l| l.dashed == dashed) {
                let pixels: Vec<_> = line.points.iter().map(&pixel).collect();
                names.line(&pixels, 1.0);
                let class = class(line);
                let data = if line.dots {
                    let apart = pixels.iter().flat_map(|p| [*p, None]);
                    path_data(&apart.collect::<Vec<_>>())
                } else if dashed {
                    let drawn = drawn.entry(class.clone()).or_default();
                    path_data(&drawn.fresh(&pixels))
                } else {
                    path_data(&pixels)
                };
                svg.path(&class, &data);
            }
        }
    }

    /// Named points: markers last, on top of all names.
    fn draw_marks(
        &self,
        svg: &mut Svg,
        names: &mut Names,
        pixel: impl Fn(&(f64, f64)) -> Option<Pixel>,
    ) {
        let at: Vec<_> = self.marks.iter().map(|m| pixel(&m.at)).collect();
        for at in at.iter().flatten() {
            names.mark(*at, 6.0);
        }
        for (mark, at) in self.marks.iter().zip(&at) {
            if let Some(at) = at
                && !mark.name.is_empty()
            {
                names.write(svg, *at, &mark.name);
            }
        }
        for (mark, at) in self.marks.iter().zip(&at) {
            let Some(at) = at else { continue };
            let tooltip = if mark.detail.is_empty() {
                &mark.name
            } else {
                &mark.detail
            };
            svg.marker("mark", *at, tooltip);
        }
    }
}

/// Plots below each other over the same horizontal quantity, their frames in line, with more style.
pub(crate) fn stacked(plots: &[(&Plot, Look<'_>)], style: &str) -> String {
    let left = plots
        .iter()
        .filter_map(|(plot, look)| Some(look.ticks(1, plot.spans(look)?.1, 7)))
        .map(|ticks| gutter(&ticks))
        .fold(0.0, f64::max);
    let mut svg = Svg::default();
    let mut down = 0.0;
    for (k, (plot, look)) in plots.iter().enumerate() {
        let height = if k == 0 { SIZE[1] } else { LOWER_HEIGHT };
        svg.below(down, &plot.draw(look, [SIZE[0], height], left));
        down += height + 8.0;
    }
    let title = plots.first().map_or("", |(plot, _)| &plot.title);
    svg.document([SIZE[0], down - 8.0], title, &[STYLE, style].concat())
}

/// Path data of areas as one.
fn polygons(areas: &[Vec<(f64, f64)>], at: impl Fn(&(f64, f64)) -> Option<Pixel>) -> String {
    let mut data = String::new();
    for area in areas {
        let corners: Option<Vec<_>> = area.iter().map(&at).collect();
        for (k, [x, y]) in corners.into_iter().flatten().enumerate() {
            let word = if k == 0 { 'M' } else { 'L' };
            let _ = write!(data, "{word}{} {}", pixel(x), pixel(y));
        }
        if !area.is_empty() {
            data.push('z');
        }
    }
    data
}

/// Room left of a frame for the numbers and the name of its vertical axis.
fn gutter(ticks: &[Tick]) -> f64 {
    widest(ticks.iter().map(|tick| tick.label.as_str())) + 46.0
}

/// A little room at both ends, so that what runs along the axis can be seen.
fn beyond(span: Span) -> Span {
    let room = 0.02 * span.length();
    Span {
        low: span.low - room,
        high: span.high + room,
    }
}

/// A span of a length with the same middle.
fn about(span: &Span, length: f64) -> Span {
    Span {
        low: span.middle() - 0.5 * length,
        high: span.middle() + 0.5 * length,
    }
}

fn class(line: &PlotLine) -> String {
    let colour = COLOURS[line.colour % COLOURS.len()];
    let kind = match (line.dots, line.dashed) {
        (true, _) => " dots",
        (false, true) => " dashed",
        (false, false) => "",
    };
    format!("line {colour}{kind}")
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
            dots: false,
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
        assert!(plot.shape_svg().contains("limit point"));
        assert!(Plot::default().svg().contains("no points to show"));
    }

    #[test]
    fn what_scatters_is_not_joined_and_what_is_covered_is_said() {
        let points = |shift: f64| {
            (0..4)
                .map(|k| (f64::from(k), shift + f64::from(k)))
                .collect()
        };
        let plot = Plot {
            lines: vec![
                PlotLine::dots("readings", 2, points(0.0)),
                PlotLine::solid("x", 0, points(0.0)),
                PlotLine::solid("y", 1, points(1e-4)),
                PlotLine::solid("z", 3, points(1.0)),
            ],
            ..Plot::default()
        };
        let svg = plot.svg();
        let dots = svg.split("class=\"line c2 dots\" d=\"").nth(2).unwrap();
        let dots = dots.split('"').next().unwrap();
        assert_eq!(
            (dots.matches('M').count(), dots.matches("h0").count()),
            (4, 4)
        );
        assert!(svg.contains(">x (under y)<") && svg.contains(">y<") && svg.contains(">z<"));
    }

    #[test]
    fn a_spike_is_cut_off_and_told() {
        let mut points: Vec<_> = (0..100)
            .map(|k| (f64::from(k), f64::from(k % 10)))
            .collect();
        points[50].1 = 1234.0;
        let mut plot = Plot {
            lines: vec![PlotLine::solid("", 0, points)],
            ..Plot::default()
        };
        let svg = plot.svg();
        assert!(
            svg.contains("up to 1\u{202f}234<") && svg.contains(">8<"),
            "{svg}"
        );
        assert_eq!(svg.matches("viewBox").count(), 2);
        // A named point is what the picture is about.
        plot.marks = vec![PlotMark {
            at: (50.0, 1234.0),
            name: "limit point".into(),
            detail: String::new(),
        }];
        let svg = plot.svg();
        assert!(
            !svg.contains("up to") && svg.contains(">1\u{202f}000<"),
            "{svg}"
        );
    }

    #[test]
    fn plots_below_each_other_have_their_frames_in_line() {
        let plot = |title: &str, high: f64| Plot {
            title: title.into(),
            lines: vec![PlotLine {
                points: vec![(0.0, 0.0), (360.0, high)],
                ..PlotLine::default()
            }],
            ..Plot::default()
        };
        let svg = plot("above", 2.0).svg_above(&[plot("below", 123_456.0)]);
        assert!(svg.contains(">above<") && svg.contains(">below<"));
        let left: Vec<&str> = svg
            .split("class=\"ground\" x=\"")
            .skip(1)
            .filter_map(|rest| rest.split('"').next())
            .collect();
        assert_eq!(left.len(), 2);
        assert_eq!(left[0], left[1]);
    }

    #[test]
    fn a_shape_is_as_long_both_ways() {
        let plot = Plot {
            lines: vec![PlotLine {
                points: vec![(0.0, 0.0), (100.0, 0.0), (100.0, 100.0)],
                ..PlotLine::default()
            }],
            ..Plot::default()
        };
        let svg = plot.shape_svg();
        let path = svg.split("class=\"line c0\" d=\"").nth(1).unwrap();
        let path = path.split('"').next().unwrap();
        let step = |letter: char| -> f64 {
            let rest = path.split(letter).nth(1).expect("a step");
            let end = rest.find(|c: char| c.is_ascii_alphabetic());
            rest[..end.unwrap_or(rest.len())].parse().expect("a number")
        };
        let (right, up) = (step('h'), -step('v'));
        assert!(right > 10.0, "{path}");
        assert!((right - up).abs() < 0.3, "{right} {up}: {path}");
    }
}
