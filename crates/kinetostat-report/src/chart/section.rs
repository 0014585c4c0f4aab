//! A quantity over a plane, in coloured bands between round values.
//!
//! Cells of one band are one path, so that a section of a hundred thousand cells stays small.

use std::fmt::Write as _;

use crate::chart::bands::{BAR, Bands};
use crate::chart::cell::Cell;
use crate::chart::fine::Fine;
use crate::chart::label::{Frame, Names, TEXT_SIZE, title_lines, widest};
use crate::chart::outline::{first_time, path_data};
use crate::chart::panel::legend;
use crate::chart::plot::{PlotLine, PlotMark};
use crate::chart::{Scale, Span};
use crate::svg::{Anchor, Svg, pixel};
use crate::{number, text};

const SIZE: [f64; 2] = [760.0, 560.0];

const STYLE: &str = concat!(
    include_str!("../template/palette.css"),
    include_str!("../template/plot.css"),
    include_str!("../template/section.css")
);

/// Style of grey cells and of lines over the cells.
const OVER: &str = include_str!("../template/map.css");

/// Inside a frame of the page a drawing has none of its own.
const FRAMED: &str = "svg.framed rect.card{fill:none;stroke:none}";

/// A line that is the subject of the picture.
const BOLD: &str = "svg path.way{stroke-width:2;stroke-opacity:1}svg path.way-ground{stroke-width:5;stroke-opacity:.8}";

/// Greys of the style sheet, from dark to light.
const GREYS: usize = 6;

/// A section through a field.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Title above the frame.
    pub title: String,
    /// Quantity and unit of the horizontal axis, as in `x, mm`.
    pub x_label: String,
    /// Quantity and unit of the vertical axis.
    pub y_label: String,
    /// Quantity and unit of the colours.
    pub value_label: String,
    /// Places along the horizontal axis, evenly spaced.
    pub x: Vec<f64>,
    /// Places along the vertical axis, evenly spaced.
    pub y: Vec<f64>,
    /// A cell around every place, the horizontal axis running fastest.
    pub cells: Vec<Cell>,
    /// Names of cells without a value, at most three kinds.
    pub others: Vec<String>,
    /// Meaning of grey cells and of their shades; empty without such cells.
    pub grey_label: String,
    /// A value at which the scale of colours begins at the latest.
    pub scale_from: Option<f64>,
    /// True for a continuous quantity: its colours are interpolated between places, as its lines of equal value are.
    pub interpolated: bool,
    /// A value that parts two kinds, as zero parts gain and loss: each kind has a hue, and its shades grow with the distance.
    pub parted_at: Option<f64>,
    /// Thin lines over the cells: solid, or dashed.
    pub lines: Vec<PlotLine>,
    /// Named places.
    pub marks: Vec<PlotMark>,
}

/// Units of the two axes.
#[derive(Clone, Copy)]
enum Shape {
    /// Equal units on both axes.
    True,
    /// Units with which both axes fill the picture.
    Filled,
}

impl Section {
    /// The section as an SVG document with its own style; one unit is as long on both axes.
    #[must_use]
    pub fn svg(&self) -> String {
        let style = match self.lines.is_empty() && self.grey_label.is_empty() {
            true => STYLE.to_owned(),
            false => [STYLE, OVER].concat(),
        };
        self.draw(SIZE[1], Shape::True)
            .document(SIZE, &self.title, &style)
    }

    /// The section of two quantities that are not compared: both axes fill the picture.
    pub(crate) fn filled_svg(&self) -> String {
        let style = [STYLE, OVER, BOLD].concat();
        self.draw(SIZE[1], Shape::Filled)
            .document(SIZE, &self.title, &style)
    }

    /// Draws this section and others below it, as one document. Where the two axes of one are not the same quantity,
    /// they fill the picture.
    #[must_use]
    pub fn svg_above(&self, others: &[Self]) -> String {
        let style = [STYLE, OVER].concat();
        let mut svg = Svg::default();
        let mut down = 0.0;
        for section in std::iter::once(self).chain(others) {
            let unit = |label: &str| label.rsplit(", ").next().map(str::to_owned);
            let (drawn, height) = match unit(&section.x_label) == unit(&section.y_label) {
                true => {
                    let (drawn, size) = section.fitted();
                    (drawn, size[1])
                }
                false => (section.draw(SIZE[1], Shape::Filled), SIZE[1]),
            };
            svg.below(down, &drawn);
            down += height + 8.0;
        }
        svg.document([SIZE[0], down - 8.0], &self.title, &style)
    }

    /// Borders between the colours of an interpolated section with these values: lines of equal value belong there.
    #[must_use]
    pub fn borders(values: impl Iterator<Item = f64>) -> Vec<f64> {
        Bands::of(values.filter_map(number::drawable), None).borders
    }

    /// Draws the section as an element for a page, which has the style of plots and [`Self::filled_style`];
    /// `description` is its text alternative.
    pub(crate) fn filled_element(&self, description: &str) -> String {
        self.draw(SIZE[1], Shape::Filled)
            .inline("plot framed", SIZE, description)
    }

    /// Style of the cells and lines of such an element, in addition to that of plots.
    pub(crate) fn filled_style() -> String {
        [Self::style(), BOLD, FRAMED].concat()
    }

    /// Style of the cells and lines, in addition to that of plots.
    pub(crate) fn style() -> &'static str {
        concat!(
            include_str!("../template/section.css"),
            include_str!("../template/map.css")
        )
    }

    /// The section as high as it needs to be for its shape, with its size.
    pub(crate) fn fitted(&self) -> (Svg, [f64; 2]) {
        let height = match (edges(&self.x), edges(&self.y)) {
            (Some(x), Some(y)) => 135.0 + (SIZE[0] - 195.0) * y.length() / x.length(),
            _ => SIZE[1],
        };
        let height = height.clamp(330.0, 720.0);
        (self.draw(height, Shape::True), [SIZE[0], height])
    }

    fn draw(&self, height: f64, shape: Shape) -> Svg {
        let mut svg = Svg::default();
        let size = [SIZE[0], height];
        svg.rectangle("card", [0.5, 0.5], [size[0] - 1.0, size[1] - 1.0], 10.0);
        let mut top = 28.0;
        for line in title_lines(&self.title, size[0] - 36.0) {
            svg.text("title", [18.0, top], Anchor::Start, &line);
            top += 18.0;
        }
        let (Some(x_span), Some(y_span)) = (edges(&self.x), edges(&self.y)) else {
            let middle = size.map(|side| 0.5 * side);
            svg.text("name", middle, Anchor::Middle, "no places to show");
            return svg;
        };
        let values = self.cells.iter().filter_map(|c| match c {
            Cell::Value(x) => number::drawable(*x),
            Cell::Other(_) | Cell::Grey(_) => None,
        });
        let bands = match self.parted_at {
            Some(middle) => Bands::parted(values, middle),
            None => Bands::of(values, self.scale_from),
        };
        top += self.reasons(&mut svg, top);
        let y_ticks = y_span.ticks(7);
        let left = widest(y_ticks.iter().map(|tick| tick.label.as_str())) + 46.0;
        let scale = widest(bands.labels.iter().map(String::as_str)) + BAR + 54.0;
        let room = Frame {
            x: left,
            y: top,
            width: size[0] - left - scale - 20.0,
            height: size[1] - top - 54.0,
        };
        let unit = (room.width / x_span.length()).min(room.height / y_span.length());
        let (width, height) = match shape {
            Shape::True => (unit * x_span.length(), unit * y_span.length()),
            Shape::Filled => (room.width, room.height),
        };
        let frame = Frame {
            x: room.x + 0.5 * (room.width - width),
            y: room.y + 0.5 * (room.height - height),
            width,
            height,
        };
        let x = Scale::new(x_span, frame.x, frame.right());
        let y = Scale::new(y_span, frame.bottom(), frame.y);
        svg.rectangle("ground", [frame.x, frame.y], [width, height], 0.0);
        self.fill(&mut svg, &bands, &frame);
        self.overlay(&mut svg, &frame, &x, &y);
        for tick in &y_ticks {
            let at = y.at(tick.value);
            svg.line("axis", [frame.x - 4.0, at], [frame.x, at]);
            svg.text("tick", [frame.x - 7.0, at + 4.2], Anchor::End, &tick.label);
        }
        for tick in x_span.ticks((frame.width / 70.0).clamp(2.0, 8.0) as usize) {
            let at = x.at(tick.value);
            svg.line("axis", [at, frame.bottom()], [at, frame.bottom() + 4.0]);
            let below = [at, frame.bottom() + 17.0];
            svg.text("tick", below, Anchor::Middle, &tick.label);
        }
        let corner = [frame.x, frame.bottom()];
        svg.line("axis", [frame.x, frame.y], corner);
        svg.line("axis", corner, [frame.right(), frame.bottom()]);
        let below = [frame.x + 0.5 * width, frame.bottom() + 38.0];
        svg.text("name", below, Anchor::Middle, &self.x_label);
        let beside = [frame.x - left + 20.0, frame.y + 0.5 * height];
        svg.text_upwards("name", beside, &self.y_label);
        bands.key(&mut svg, frame.right() + 22.0, &room, &self.value_label);
        svg
    }

    /// Names of cells without a value; returns the height that they take.
    fn reasons(&self, svg: &mut Svg, top: f64) -> f64 {
        let mut at = 18.0;
        for (kind, name) in self.others.iter().enumerate() {
            if !self.cells.contains(&Cell::Other(kind)) {
                continue;
            }
            let class = format!("other{kind} swatch");
            svg.rectangle(&class, [at, top - 6.0], [22.0, 12.0], 0.0);
            svg.text("name", [at + 28.0, top + 4.0], Anchor::Start, name);
            at += 46.0 + text::width(name, TEXT_SIZE);
        }
        if !self.grey_label.is_empty() {
            svg.rectangle("grey3 swatch", [at, top - 6.0], [22.0, 12.0], 0.0);
            let beside = [at + 28.0, top + 4.0];
            svg.text("name", beside, Anchor::Start, &self.grey_label);
            at += 56.0 + text::width(&self.grey_label, TEXT_SIZE);
        }
        let mut entries: Vec<(&str, String)> = Vec::new();
        for line in self.lines.iter().filter(|line| !line.name.is_empty()) {
            let entry = (key(line), line.name.clone());
            if !entries.contains(&entry) {
                entries.push(entry);
            }
        }
        if !entries.is_empty() {
            return 1.0 + legend(svg, &entries, [at, top + 4.0], SIZE[0] - 18.0);
        }
        if at > 18.0 { 20.0 } else { 0.0 }
    }

    /// Lines and named places over the cells.
    fn overlay(&self, svg: &mut Svg, frame: &Frame, x: &Scale, y: &Scale) {
        let pixel = |p: &(f64, f64)| {
            let at = [x.at(number::drawable(p.0)?), y.at(number::drawable(p.1)?)];
            Some(at)
        };
        let mut ways = Svg::default();
        let mut names = Names::within(*frame);
        for line in &self.lines {
            let pixels: Vec<_> = line.points.iter().map(pixel).collect();
            let data = path_data(&first_time(&pixels));
            // Light below dark: one of them is seen on every colour.
            let ground = if line.dashed {
                "way-ground dashed"
            } else {
                "way-ground"
            };
            ways.path(ground, &data);
            ways.path(way(line), &data);
        }
        if !self.lines.is_empty() {
            svg.window([frame.x, frame.y], [frame.width, frame.height], &ways);
        }
        let at: Vec<_> = self.marks.iter().map(|m| pixel(&m.at)).collect();
        for at in at.iter().flatten() {
            names.mark(*at, 6.0);
        }
        for (mark, at) in self.marks.iter().zip(&at) {
            let Some(at) = at else { continue };
            names.write(svg, *at, &mark.name);
            svg.marker("mark", *at, &mark.detail);
        }
    }

    /// One path for all cells of a class, runs along the horizontal axis as one rectangle each.
    fn fill(&self, svg: &mut Svg, bands: &Bands, frame: &Frame) {
        let fine = self
            .interpolated
            .then(|| Fine::of([self.x.len(), self.y.len()], &self.cells));
        let (columns, rows, own) = match &fine {
            Some(fine) => (fine.columns, fine.rows, fine.cells.as_slice()),
            None => (self.x.len(), self.y.len(), self.cells.as_slice()),
        };
        let (wide, high) = (frame.width / columns as f64, frame.height / rows as f64);
        let class = |cell: &Cell| match cell {
            Cell::Value(x) => number::drawable(*x).map(|x| bands.class(x)),
            Cell::Other(kind) => Some(format!("other{kind}")),
            Cell::Grey(shade) => {
                let shade = number::drawable(*shade)?.clamp(0.0, 1.0);
                Some(format!("grey{}", (shade * (GREYS - 1) as f64).round()))
            }
        };
        let mut paths: std::collections::BTreeMap<String, String> = Default::default();
        for (row, cells) in own.chunks(columns).take(rows).enumerate() {
            let bottom = frame.bottom() - high * row as f64;
            let mut first = 0;
            let classes: Vec<Option<String>> = cells.iter().map(class).collect();
            for run in classes.chunk_by(|a, b| a == b) {
                let (from, to) = (first as f64 * wide, (first + run.len()) as f64 * wide);
                first += run.len();
                let Some(class) = &run[0] else { continue };
                let (left, right) = (pixel(frame.x + from), pixel(frame.x + to));
                let (low, up) = (pixel(bottom), pixel(bottom - high));
                let data = paths.entry(class.clone()).or_default();
                let _ = write!(data, "M{left} {low}H{right}V{up}H{left}Z");
            }
        }
        for (class, data) in paths {
            svg.path(&class, &data);
        }
    }
}

/// Class of a line over the cells.
fn way(line: &PlotLine) -> &'static str {
    match line.dashed {
        true => "way dashed",
        false => "way",
    }
}

/// Class of its sample beside its name, which stands on the card's own ground.
fn key(line: &PlotLine) -> &'static str {
    match line.dashed {
        true => "feed dashed",
        false => "feed",
    }
}

/// Range from half a step before the first place to half a step after the last.
fn edges(places: &[f64]) -> Option<Span> {
    let (first, last) = (*places.first()?, *places.last()?);
    let half = 0.5 * (last - first) / (places.len() as f64 - 1.0);
    let span = Span {
        low: first - half,
        high: last + half,
    };
    (span.length().is_finite() && span.length() > 0.0).then_some(span)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section(cells: Vec<Cell>) -> Section {
        Section {
            title: "softest <direction>".into(),
            x_label: "x, mm".into(),
            y_label: "y, mm".into(),
            value_label: "N/mm".into(),
            x: vec![0.0, 10.0, 20.0],
            y: vec![0.0, 10.0],
            cells,
            others: vec!["outside limits".into(), "unreachable".into()],
            ..Section::default()
        }
    }

    #[test]
    fn bands_are_round_and_runs_are_one_rectangle() {
        let cells = [100.0, 101.0, 390.0, 250.0, 250.0, f64::NAN].map(Cell::Value);
        let svg = section(cells.to_vec()).svg();
        assert!(svg.contains(">150<") && svg.contains(">350<"), "{svg}");
        // Two places of one band side by side.
        let low = svg.split("class=\"f0\" d=\"").nth(1).unwrap();
        assert_eq!(low.split('"').next().unwrap().matches('M').count(), 1);
        assert!(!svg.contains("NaN") && !svg.contains("<direction>"));
        assert!(!svg.contains("unreachable"));
    }

    #[test]
    fn lines_of_one_name_have_one_entry_and_colours_change_along_the_lines() {
        let values = [100.0, 200.0, 390.0, 100.0, 200.0, 390.0];
        let mut section = section(values.map(Cell::Value).to_vec());
        section.lines = vec![PlotLine::dashed("machine", 0, vec![(0.0, 0.0), (20.0, 10.0)]); 3];
        assert_eq!(section.svg().matches(">machine<").count(), 1);
        // Three cells in a row have three colours; interpolated, all that lie between are there, too.
        let has = |svg: &str, k: usize| svg.contains(&format!("<path class=\"f{k}\""));
        let colours = |svg: &str| (0..11).filter(|k| has(svg, *k)).count();
        let coarse = section.svg();
        section.interpolated = true;
        let fine = section.svg();
        assert_eq!((colours(&coarse), colours(&fine)), (3, 6));
        assert_eq!(Section::borders(values.into_iter()).len(), 5);
    }

    #[test]
    fn what_has_no_value_is_named() {
        let mut cells = vec![Cell::Value(1.0); 6];
        cells[4] = Cell::Other(1);
        let svg = section(cells).svg();
        assert!(svg.contains(">unreachable<") && !svg.contains(">outside limits<"));
        let nothing = Section::default().svg();
        assert!(nothing.contains("no places to show"));
    }
}
