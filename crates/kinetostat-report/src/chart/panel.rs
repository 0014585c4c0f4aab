//! A panel with values over the length of the path.

use kinetostat_machining::{CutPlace, Envelope, PointKind, PointResult, Quantity};

use crate::chart::area::area_data;
use crate::chart::label::{Frame, Labels, TEXT_SIZE, TITLE_SIZE, title_lines, widest};
use crate::chart::outline::{path_data, per_column};
use crate::chart::{Scale, Span, Tick};
use crate::svg::{Anchor, Pixel, Svg, pixel};
use crate::{number, text};

/// Height of a line of a title, pixels.
const TITLE_LINE: f64 = 17.0;

/// The drawing surface: the same figure is drawn for wide windows and paper, and for telephones.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sheet {
    Wide,
    Narrow,
}

impl Sheet {
    /// Width in pixels.
    pub(crate) fn width(self) -> f64 {
        match self {
            Self::Wide => 960.0,
            Self::Narrow => 380.0,
        }
    }

    /// Class of the drawing.
    pub(crate) fn class(self) -> &'static str {
        match self {
            Self::Wide => "plot wide",
            Self::Narrow => "plot narrow",
        }
    }

    pub(crate) fn narrow(self) -> bool {
        self == Self::Narrow
    }
}

/// A place of a path.
pub(crate) trait OnPath {
    /// Length of the path up to it, mm.
    fn path_mm(&self) -> f64;
    /// Kind of the point.
    fn kind(&self) -> PointKind;
}

impl OnPath for PointResult {
    fn path_mm(&self) -> f64 {
        self.path_mm
    }
    fn kind(&self) -> PointKind {
        self.kind
    }
}

impl OnPath for CutPlace {
    fn path_mm(&self) -> f64 {
        self.path_mm
    }
    fn kind(&self) -> PointKind {
        self.kind
    }
}

/// The axis along the path, common to all panels of a report.
pub(crate) struct Along {
    pub(crate) span: Span,
    /// Factor from mm to the unit of the axis.
    pub(crate) factor: f64,
    pub(crate) label: &'static str,
    /// Ranges of rapids, in the unit of the axis.
    rapids: Vec<(f64, f64)>,
}

impl Along {
    /// Builds the axis; `None` if no point has a place on the path.
    pub(crate) fn of<P: OnPath>(points: &[P]) -> Option<Self> {
        let span = Span::of(points.iter().map(OnPath::path_mm))?;
        let (factor, label) = unit_of(span);
        let mut rapids: Vec<(f64, f64)> = Vec::new();
        let mut previous = span.low.min(0.0);
        for point in points {
            let Some(here) = number::drawable(point.path_mm()) else {
                continue;
            };
            if point.kind() == PointKind::Rapid && here > previous {
                match rapids.last_mut() {
                    Some(last) if last.1 >= previous * factor => last.1 = here * factor,
                    _ => rapids.push((previous * factor, here * factor)),
                }
            }
            previous = here;
        }
        Some(Self::over(span, factor, label, rapids))
    }

    /// Builds the axis of an envelope; `None` if it has no points.
    pub(crate) fn of_envelope(envelope: &Envelope) -> Option<Self> {
        let span =
            Span::of([0.0, envelope.length_mm()].into_iter()).filter(|_| envelope.points() > 0)?;
        let (factor, label) = unit_of(span);
        let mut rapids: Vec<(f64, f64)> = Vec::new();
        for stretch in envelope.along(Quantity::ErrorBefore).filter(|s| s.rapid) {
            let [from, to] = stretch.path_mm.map(|mm| mm * factor);
            match rapids.last_mut() {
                Some(last) if last.1 >= from => last.1 = to,
                _ => rapids.push((from, to)),
            }
        }
        Some(Self::over(span, factor, label, rapids))
    }

    /// A span in mm.
    fn over(span: Span, factor: f64, label: &'static str, rapids: Vec<(f64, f64)>) -> Self {
        let span = span.including(0.0);
        let span = Span {
            low: span.low * factor,
            high: span.high * factor,
        };
        let span = if span.length() > 0.0 {
            span
        } else {
            span.widened()
        };
        Self {
            span,
            factor,
            label,
            rapids,
        }
    }

    /// A stroke from the lowest to the highest value in each stretch, from the nearer end on; rapids lift the pen.
    pub(crate) fn envelope(
        &self,
        envelope: &Envelope,
        quantity: Quantity,
        factor: f64,
    ) -> Vec<Option<(f64, f64)>> {
        let mut out: Vec<Option<(f64, f64)>> = Vec::new();
        for stretch in envelope.along(quantity) {
            let Some(range) = stretch.range.filter(|_| !stretch.rapid) else {
                // A stretch without a point is one between two of a long block.
                if stretch.rapid {
                    out.push(None);
                }
                continue;
            };
            let x = 0.5 * (stretch.path_mm[0] + stretch.path_mm[1]) * self.factor;
            let mut ends = range.map(|value| value * factor);
            if let Some(Some((_, before))) = out.last()
                && (before - ends[1]).abs() < (before - ends[0]).abs()
            {
                ends.reverse();
            }
            out.extend(ends.map(|y| Some((x, y))));
        }
        out
    }

    pub(crate) fn has_rapids(&self) -> bool {
        !self.rapids.is_empty()
    }

    /// Values of cutting moves over the path; rapids lift the pen.
    pub(crate) fn values<P: OnPath>(
        &self,
        points: &[P],
        value: impl Fn(&P) -> Option<f64>,
    ) -> Vec<Option<(f64, f64)>> {
        points
            .iter()
            .map(|point| {
                if point.kind() == PointKind::Rapid {
                    return None;
                }
                let x = number::drawable(point.path_mm())? * self.factor;
                let y = value(point).and_then(number::drawable)?;
                Some((x, y))
            })
            .collect()
    }
}

/// Factor from mm to the unit of a path of this length, and the label of its axis.
fn unit_of(span: Span) -> (f64, &'static str) {
    if span.high > 20_000.0 {
        (0.001, "length of the path, m")
    } else {
        (1.0, "length of the path, mm")
    }
}

/// One line of a panel.
pub(crate) struct Series {
    pub(crate) class: &'static str,
    pub(crate) values: Vec<Option<(f64, f64)>>,
}

/// An area between two lines over the same places.
pub(crate) struct Area {
    /// Place, lower and upper value; `None` ends a piece of the area.
    pub(crate) values: Vec<Option<(f64, f64, f64)>>,
}

/// A level that means something.
pub(crate) struct Limit {
    pub(crate) value: f64,
    pub(crate) label: String,
}

/// A point worth a label.
pub(crate) struct Mark {
    pub(crate) at: (f64, f64),
    pub(crate) label: String,
    pub(crate) tooltip: String,
}

/// A plot of values over the path.
pub(crate) struct Panel {
    pub(crate) title: String,
    pub(crate) y_label: String,
    pub(crate) span: Span,
    /// Below the lines.
    pub(crate) areas: Vec<Area>,
    pub(crate) series: Vec<Series>,
    pub(crate) limits: Vec<Limit>,
    pub(crate) marks: Vec<Mark>,
}

impl Panel {
    fn ticks(&self, height: f64) -> Vec<Tick> {
        let wanted = (height / 34.0).round().clamp(3.0, 6.0) as usize;
        self.span.ticks(wanted)
    }

    /// Room left of the frame for the label and the ticks of the vertical axis.
    pub(crate) fn gutter(&self, height: f64) -> f64 {
        let ticks = self.ticks(height);
        widest(ticks.iter().map(|tick| tick.label.as_str())) + 32.0
    }

    /// Height of the title beyond its first line, where this much width is left for it.
    pub(crate) fn more_title(&self, width: f64) -> f64 {
        TITLE_LINE * (title_lines(&self.title, width).len() as f64 - 1.0)
    }

    /// Draws the title from the frame's left edge, or farther left where it needs the room.
    fn draw_title(&self, svg: &mut Svg, frame: &Frame, room: Span) {
        let lines = title_lines(&self.title, room.length());
        let widest = lines.iter().map(|l| text::bold_width(l, TITLE_SIZE));
        let left = frame
            .x
            .min(room.high - widest.fold(0.0, f64::max))
            .max(room.low);
        for (k, line) in lines.iter().rev().enumerate() {
            let base = frame.y - 9.0 - TITLE_LINE * k as f64;
            svg.text("title", [left, base], Anchor::Start, line);
        }
    }

    /// Draws the panel; `room` are the left and the right end of what its title may take, `numbered`
    /// writes the numbers and the label of the axis along the path.
    pub(crate) fn draw(
        &self,
        svg: &mut Svg,
        frame: Frame,
        room: Span,
        along: &Along,
        numbered: bool,
    ) {
        let x = Scale::new(along.span, frame.x, frame.right());
        let y = Scale::new(self.span, frame.bottom(), frame.y);
        svg.rectangle(
            "ground",
            [frame.x, frame.y],
            [frame.width, frame.height],
            0.0,
        );
        svg.path("rapids", &bands(along, &x, &frame));
        for tick in self.ticks(frame.height) {
            let at = y.at(tick.value);
            svg.line("grid", [frame.x, at], [frame.right(), at]);
            svg.text("tick", [frame.x - 7.0, at + 4.2], Anchor::End, &tick.label);
        }
        draw_path_axis(svg, frame, along, &x, numbered);
        svg.line("axis", [frame.x, frame.y], [frame.x, frame.bottom()]);
        let gutter = self.gutter(frame.height);
        svg.text_upwards(
            "name",
            [frame.x - gutter + 12.0, frame.y + 0.5 * frame.height],
            &self.y_label,
        );
        self.draw_title(svg, &frame, room);

        let marks: Vec<_> = self
            .marks
            .iter()
            .map(|m| [x.at(m.at.0), y.at(m.at.1)])
            .collect();
        let mut labels = Labels::default();
        for area in &self.areas {
            let pixels: Vec<_> = area
                .values
                .iter()
                .map(|v| v.map(|(along, low, high)| [x.at(along), y.at(low), y.at(high)]))
                .collect();
            svg.path("area", &area_data(&pixels));
        }
        self.draw_limits(svg, frame, &y, &marks, &mut labels);
        let mut lines = Svg::default();
        for series in &self.series {
            let pixels: Vec<_> = series
                .values
                .iter()
                .map(|value| value.map(|(along, value)| [x.at(along), y.at(value)]))
                .collect();
            lines.path(series.class, &path_data(&per_column(&pixels)));
        }
        let values = self.series.iter().flat_map(|series| series.values.iter());
        match Span::of(values.flatten().map(|value| value.1)) {
            Some(all) if all.joined(self.span) != self.span => {
                svg.window([frame.x, frame.y], [frame.width, frame.height], &lines);
            }
            _ => svg.append(&lines),
        }
        for (mark, at) in self.marks.iter().zip(&marks) {
            svg.marker("mark", *at, &mark.tooltip);
            labels.reserve(Frame {
                x: at[0] - 5.0,
                y: at[1] - 5.0,
                width: 10.0,
                height: 10.0,
            });
        }
        for (mark, at) in self.marks.iter().zip(&marks) {
            labels.place(svg, "mark-name", &frame, *at, [0.0, -1.0], &mark.label);
        }
    }

    fn draw_limits(
        &self,
        svg: &mut Svg,
        frame: Frame,
        y: &Scale,
        marks: &[Pixel],
        labels: &mut Labels,
    ) {
        for limit in &self.limits {
            let at = y.at(limit.value);
            svg.line("limit", [frame.x, at], [frame.right(), at]);
            labels.reserve(Frame {
                x: frame.x,
                y: at - 1.0,
                width: frame.width,
                height: 2.0,
            });
        }
        for limit in &self.limits {
            let at = y.at(limit.value);
            let width = text::width(&limit.label, TEXT_SIZE) + 10.0;
            // Above its line or below, at the right end or, where a marked point needs that, at the left.
            let places = [frame.right() - width, frame.x].map(|x| {
                [at - 17.0, at + 2.0].map(|top| Frame {
                    x,
                    y: top,
                    width,
                    height: 15.0,
                })
            });
            let busy = |place: &Frame| {
                let base = place.y + 12.0;
                let near = |mark: &Pixel| {
                    (place.x - 60.0..place.right() + 60.0).contains(&mark[0])
                        && (mark[1] - base).abs() < 40.0
                };
                marks.iter().any(near)
            };
            let within = |place: &&Frame| place.y >= frame.y && place.bottom() <= frame.bottom();
            let cost = |place: &Frame| (labels.is_taken(place), busy(place));
            let places = places.as_flattened();
            let best = places.iter().filter(within).min_by_key(|p| cost(p));
            let Some(place) = best.or(places.first()) else {
                continue;
            };
            let (x, anchor) = match place.x > frame.x {
                true => (frame.right() - 6.0, Anchor::End),
                false => (frame.x + 6.0, Anchor::Start),
            };
            let base = place.y + 12.0;
            svg.text("limit-name", [x, base], anchor, &limit.label);
            labels.reserve(*place);
        }
    }
}

fn draw_path_axis(svg: &mut Svg, frame: Frame, along: &Along, x: &Scale, numbered: bool) {
    let wanted = (frame.width / 95.0).round().clamp(2.0, 10.0) as usize;
    for tick in along.span.ticks(wanted) {
        let at = x.at(tick.value);
        svg.line("axis", [at, frame.bottom()], [at, frame.bottom() + 4.0]);
        if numbered {
            svg.text(
                "tick",
                [at, frame.bottom() + 17.0],
                Anchor::Middle,
                &tick.label,
            );
        }
    }
    svg.line(
        "axis",
        [frame.x, frame.bottom()],
        [frame.right(), frame.bottom()],
    );
    if numbered {
        let at = [frame.x + 0.5 * frame.width, frame.bottom() + 34.0];
        svg.text("name", at, Anchor::Middle, along.label);
    }
}

/// Rapids as one shape; those narrower than a pixel are drawn a pixel wide.
fn bands(along: &Along, x: &Scale, frame: &Frame) -> String {
    let mut data = String::new();
    let mut covered = f64::NEG_INFINITY;
    for (from, to) in &along.rapids {
        let left = x.at(*from).max(covered);
        let right = x.at(*to).max(left + 1.0).min(frame.right());
        if right - left < 0.2 {
            continue;
        }
        covered = right;
        data.push_str(&format!(
            "M{} {}h{}v{}h{}z",
            pixel(left),
            pixel(frame.y),
            pixel(right - left),
            pixel(frame.height),
            pixel(left - right)
        ));
    }
    data
}

/// A row of samples with names; returns the height it takes.
pub(crate) fn legend(svg: &mut Svg, entries: &[(&str, String)], from: Pixel, right: f64) -> f64 {
    let [mut x, mut y] = from;
    for (class, name) in entries {
        let width = 30.0 + text::width(name, TEXT_SIZE);
        if x > from[0] && x + width > right {
            x = from[0];
            y += 19.0;
        }
        if matches!(*class, "rapids" | "area") {
            svg.rectangle(&format!("{class} swatch"), [x, y - 10.0], [22.0, 12.0], 0.0);
        } else if class.ends_with(" dots") {
            let dots = [3.0, 11.0, 19.0].map(|at| Some([x + at, y - 4.0]));
            svg.path(class, &path_data(&dots.map(|dot| [dot, None]).concat()));
        } else {
            svg.line(class, [x, y - 4.0], [x + 22.0, y - 4.0]);
        }
        svg.text("name", [x + 28.0, y], Anchor::Start, name);
        x += width + 18.0;
    }
    y - from[1] + 19.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Attribute of the first text of a class that says something.
    fn height_of(svg: &str, text: &str) -> f64 {
        let before = svg.split(&format!(">{text}<")).next().unwrap_or_default();
        let y = before.rsplit(" y=\"").next().unwrap_or_default();
        y.split('"')
            .next()
            .and_then(|y| y.parse().ok())
            .unwrap_or(f64::NAN)
    }

    #[test]
    fn no_limit_runs_through_the_name_of_another() {
        let limit = |value: f64| Limit {
            value,
            label: format!("limit {value}"),
        };
        let panel = Panel {
            title: String::new(),
            y_label: String::new(),
            span: Span {
                low: 0.0,
                high: 100.0,
            },
            areas: Vec::new(),
            series: Vec::new(),
            limits: vec![limit(50.0), limit(60.0)],
            marks: Vec::new(),
        };
        let span = panel.span;
        let along = Along::over(span, 1.0, "length of the path, mm", Vec::new());
        let frame = Frame {
            x: 0.0,
            y: 0.0,
            width: 300.0,
            height: 100.0,
        };
        let mut svg = Svg::default();
        panel.draw(&mut svg, frame, span, &along, true);
        let svg = svg.inline("", [300.0, 100.0], "");
        // The lines lie at 50 and 40 pixels; a name reaches from 12 pixels above its base to 3 below.
        for name in ["limit 50", "limit 60"] {
            let base = height_of(&svg, name);
            let through = |line: &f64| (base - 12.0..base + 3.0).contains(line);
            assert!(![40.0, 50.0].iter().any(through), "{name} at {base}: {svg}");
        }
    }
}
