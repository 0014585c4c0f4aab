//! The path seen from above and from the side, with the deviation magnified.

use kinetostat_machining::{PointKind, PointResult};

use crate::chart::label::{Frame, Labels, widest};
use crate::chart::outline::{first_time, path_data};
use crate::chart::panel::{Sheet, legend};
use crate::chart::{Scale, Span};
use crate::number::{self, Rounding, norm};
use crate::run::Shown;
use crate::svg::{Anchor, Pixel, Svg};

/// Axes of a view: indices into positions and their names.
type View = [usize; 2];
const ABOVE: View = [0, 1];
const SIDE: View = [0, 2];
const NAMES: [&str; 3] = ["X, mm", "Y, mm", "Z, mm"];

/// Maximum number of whiskers from the path to the magnified place of the tool.
const WHISKERS: usize = 72;

/// Multiple of the frame's width and height from which a line is drawn thin: it fills the frame.
const DENSE: f64 = 8.0;

/// Magnification of the deviation: a round number, so that the largest one takes about an eighth of the path's size.
/// `None` if there is no deviation or no path.
pub(crate) fn magnification(result: &Shown<'_>) -> Option<f64> {
    let size = [0, 1, 2]
        .into_iter()
        .filter_map(|axis| Span::of(result.points.iter().map(|p| p.position_mm[axis])))
        .map(Span::length)
        .fold(0.0, f64::max);
    let error = number::largest(result.cutting_points().map(|p| norm(&p.error_before_mm)))?;
    if size <= 0.0 || error <= 0.0 {
        return None;
    }
    let share = 0.14 * size / error;
    share
        .is_finite()
        .then(|| number::round_number(share).clamp(1.0, 1e9))
}

/// Draws both views on one sheet; empty without points.
pub(crate) fn views(result: &Shown<'_>, sheet: Sheet) -> String {
    let magnification = magnification(result);
    let Some(above) = Extent::of(result, ABOVE, magnification) else {
        return String::new();
    };
    let side = Extent::of(result, SIDE, magnification).filter(|_| has_height(result.points));
    let mut svg = Svg::default();
    let mut y = 30.0;
    let (left, right) = (
        above
            .gutter()
            .max(side.as_ref().map_or(0.0, Extent::gutter)),
        14.0,
    );
    let room = sheet.width() - left - right;
    let tallest = if sheet.narrow() { 330.0 } else { 440.0 };
    let scale;
    let panels = Panels {
        result,
        magnification,
        above: &above,
        tallest,
    };
    match side {
        // A compact path leaves room beside it.
        Some(side) if !sheet.narrow() && above.ratio() < 1.8 && side.ratio() < 4.0 => {
            let half = 0.5 * (room - left - 20.0);
            (scale, y) = panels.side_by_side(&mut svg, &side, left, y, half);
        }
        side => (scale, y) = panels.one_above_the_other(&mut svg, side.as_ref(), left, y, room),
    }
    y += 62.0;
    y += draw_legend(
        &mut svg,
        result,
        magnification,
        scale,
        [left, y],
        sheet.width() - right,
    );
    svg.inline(
        sheet.class(),
        [sheet.width(), y],
        "The path from above and from the side with the deviation magnified",
    )
}

/// Extent of a view.
struct Extent {
    view: View,
    across: Span,
    up: Span,
}

impl Extent {
    fn of(result: &Shown<'_>, view: View, magnification: Option<f64>) -> Option<Self> {
        let span = |axis: usize| {
            let path = result.points.iter().map(|p| p.position_mm[axis]);
            let moved = result
                .points
                .iter()
                .filter_map(|p| Some(displaced(p, magnification?)?[axis]));
            Span::of(path.chain(moved))
        };
        let (mut across, mut up) = (span(view[0])?, span(view[1])?);
        let size = across.length().max(up.length());
        let room = if size > 0.0 { 0.05 * size } else { 1.0 };
        // More room at the sides: labels of the worst points stand there.
        for (side, room) in [(&mut across, 2.2 * room), (&mut up, room)] {
            *side = Span {
                low: side.low - room,
                high: side.high + room,
            };
        }
        Some(Self { view, across, up })
    }

    fn ratio(&self) -> f64 {
        self.across.length() / self.up.length()
    }

    /// Pixels per mm at which it fits.
    fn scale(&self, width: f64, height: f64) -> f64 {
        (width / self.across.length()).min(height / self.up.length())
    }

    fn width(&self, scale: f64) -> f64 {
        self.across.length() * scale
    }

    fn height(&self, scale: f64) -> f64 {
        self.up.length() * scale
    }

    fn gutter(&self) -> f64 {
        let labels = self.up.ticks(6);
        widest(labels.iter().map(|tick| tick.label.as_str())) + 36.0
    }

    /// The spans that fill a frame with the same scale both ways.
    fn filling(&self, frame: &Frame) -> (Span, Span) {
        let scale = self.scale(frame.width, frame.height);
        let grown = |span: Span, pixels: f64| {
            let half = 0.5 * pixels / scale;
            Span {
                low: span.middle() - half,
                high: span.middle() + half,
            }
        };
        (
            grown(self.across, frame.width),
            grown(self.up, frame.height),
        )
    }
}

/// Common data of both views of a path.
struct Panels<'a> {
    result: &'a Shown<'a>,
    magnification: Option<f64>,
    above: &'a Extent,
    /// Largest height of a panel, pixels.
    tallest: f64,
}

impl Panels<'_> {
    fn draw(&self, svg: &mut Svg, extent: &Extent, frame: Frame, title: &str) {
        draw(svg, self.result, extent, frame, self.magnification, title);
    }

    /// Two panels of one width at one scale; gives the scale and where they end.
    fn side_by_side(
        &self,
        svg: &mut Svg,
        side: &Extent,
        left: f64,
        y: f64,
        half: f64,
    ) -> (f64, f64) {
        let scale = self
            .above
            .scale(half, self.tallest)
            .min(side.scale(half, self.tallest));
        let height = self.above.height(scale).max(side.height(scale)).max(200.0);
        let frame = Frame {
            x: left,
            y,
            width: half,
            height,
        };
        self.draw(svg, self.above, frame, "Seen from above");
        let frame = Frame {
            x: 2.0 * left + half + 20.0,
            ..frame
        };
        self.draw(svg, side, frame, "Seen from the side");
        (scale, y + height)
    }

    /// The view from the side below that from above, where the path has a height.
    fn one_above_the_other(
        &self,
        svg: &mut Svg,
        side: Option<&Extent>,
        left: f64,
        y: f64,
        room: f64,
    ) -> (f64, f64) {
        let wanted = side.map_or(f64::INFINITY, |side| side.scale(room, 220.0));
        let scale = self
            .above
            .scale(room, self.tallest)
            .min(wanted.max(self.above.scale(room, 240.0)));
        let width = (self.above.width(scale) + 30.0).clamp(room.min(420.0), room);
        let x = left + 0.5 * (room - width);
        let frame = Frame {
            x,
            y,
            width,
            height: self.above.height(scale).max(110.0),
        };
        self.draw(svg, self.above, frame, "Seen from above");
        let mut bottom = frame.bottom();
        if let Some(side) = side {
            let height = side.height(scale).clamp(90.0, 2.0 * self.tallest);
            let frame = Frame {
                y: bottom + 78.0,
                height,
                ..frame
            };
            self.draw(svg, side, frame, "Seen from the side");
            bottom = frame.bottom();
        }
        (scale, bottom)
    }
}

fn draw(
    svg: &mut Svg,
    result: &Shown<'_>,
    extent: &Extent,
    frame: Frame,
    magnification: Option<f64>,
    title: &str,
) {
    let (across, up) = extent.filling(&frame);
    let x = Scale::new(across, frame.x, frame.right());
    let y = Scale::new(up, frame.bottom(), frame.y);
    svg.rectangle(
        "ground",
        [frame.x, frame.y],
        [frame.width, frame.height],
        0.0,
    );
    for tick in across.ticks((frame.width / 80.0).clamp(2.0, 9.0) as usize) {
        let at = x.at(tick.value);
        svg.line("grid", [at, frame.y], [at, frame.bottom()]);
        svg.text(
            "tick",
            [at, frame.bottom() + 17.0],
            Anchor::Middle,
            &tick.label,
        );
    }
    for tick in up.ticks((frame.height / 60.0).clamp(2.0, 8.0) as usize) {
        let at = y.at(tick.value);
        svg.line("grid", [frame.x, at], [frame.right(), at]);
        svg.text("tick", [frame.x - 7.0, at + 4.2], Anchor::End, &tick.label);
    }
    let [first, second] = extent.view;
    svg.text("title", [frame.x, frame.y - 10.0], Anchor::Start, title);
    svg.text(
        "name",
        [frame.x + 0.5 * frame.width, frame.bottom() + 34.0],
        Anchor::Middle,
        NAMES[first],
    );
    svg.text_upwards(
        "name",
        [
            frame.x - extent.gutter() + 12.0,
            frame.y + 0.5 * frame.height,
        ],
        NAMES[second],
    );

    let place = |at: [f64; 3]| {
        Some([
            x.at(number::drawable(at[first])?),
            y.at(number::drawable(at[second])?),
        ])
    };
    let points = result.points;
    let programmed: Vec<_> = points.iter().map(|p| place(p.position_mm)).collect();
    let length: f64 = programmed.windows(2).map(piece).sum();
    let (feed, before) = if length < DENSE * (frame.width + frame.height) {
        ("feed", "line before")
    } else {
        ("feed fine", "line before fine")
    };
    svg.path("rapid", &path_data(&moves(points, true, &place)));
    if let Some(factor) = magnification {
        let tips: Vec<_> = points
            .iter()
            .map(|p| displaced(p, factor).and_then(&place))
            .collect();
        let every = points.len().div_ceil(WHISKERS).max(1);
        for (point, tip) in points.iter().zip(&tips).step_by(every) {
            if let (Some(from), Some(to)) = (place(point.position_mm), *tip) {
                svg.line("whisker", from, to);
            }
        }
        svg.path(feed, &path_data(&first_time(&moves(points, false, &place))));
        svg.path(
            before,
            &path_data(&first_time(&without_jumps(&tips, &programmed))),
        );
        mark_worst(svg, result, &frame, |p| {
            displaced(p, factor).and_then(&place)
        });
    } else {
        svg.path(feed, &path_data(&first_time(&moves(points, false, &place))));
    }
}

/// Length of a straight piece, pixels.
fn piece(ends: &[Option<Pixel>]) -> f64 {
    match ends {
        [Some(a), Some(b)] => (b[0] - a[0]).hypot(b[1] - a[1]),
        _ => 0.0,
    }
}

/// The line of rapids or of cutting moves, each from where the move before it ended.
fn moves(
    points: &[PointResult],
    rapid: bool,
    place: &impl Fn([f64; 3]) -> Option<Pixel>,
) -> Vec<Option<Pixel>> {
    let mut line = Vec::new();
    let mut drawing = false;
    for (index, point) in points.iter().enumerate() {
        let wanted = (point.kind == PointKind::Rapid) == rapid;
        if wanted && !drawing {
            line.push(None);
            if let Some(before) = index.checked_sub(1).and_then(|before| points.get(before)) {
                line.push(place(before.position_mm));
            }
        }
        if wanted {
            line.push(place(point.position_mm));
        }
        drawing = wanted;
    }
    line
}

/// The magnified line with its pen lifted where the load turns: there the tool jumps while the program
/// hardly moves, and a stroke across would be a spike that no tool cuts.
fn without_jumps(tips: &[Option<Pixel>], programmed: &[Option<Pixel>]) -> Vec<Option<Pixel>> {
    const LONGER: f64 = 3.0;
    const PIXELS: f64 = 4.0;
    let mut line: Vec<Option<Pixel>> = Vec::with_capacity(tips.len());
    for (index, tip) in tips.iter().enumerate() {
        if let (Some(before), Some(here)) = (index.checked_sub(1).and_then(|i| tips[i]), *tip)
            && let (Some(from), Some(to)) = (programmed[index - 1], programmed[index])
        {
            let step = (to[0] - from[0]).hypot(to[1] - from[1]);
            let jump = (here[0] - before[0]).hypot(here[1] - before[1]);
            if jump > LONGER * step + PIXELS {
                line.push(None);
            }
        }
        line.push(*tip);
    }
    line
}

fn mark_worst(
    svg: &mut Svg,
    result: &Shown<'_>,
    frame: &Frame,
    tip: impl Fn(&PointResult) -> Option<Pixel>,
) {
    let mut labels = Labels::default();
    let mut marked: Vec<(usize, Pixel)> = Vec::new();
    let middle = [frame.x + 0.5 * frame.width, frame.y + 0.5 * frame.height];
    for point in &result.worst_points {
        let Some(at) = tip(point) else { continue };
        let near = |other: &(usize, Pixel)| {
            other.0 == point.line || (other.1[0] - at[0]).hypot(other.1[1] - at[1]) < 46.0
        };
        if marked.len() == 3 || marked.iter().any(near) {
            continue;
        }
        marked.push((point.line, at));
        let label = format!("line {}", number::count(point.line));
        let error = number::length(norm(&point.error_before_mm), 3, Rounding::Nearest);
        svg.marker("mark", at, &format!("{label}: {error} off"));
        labels.reserve(Frame {
            x: at[0] - 5.0,
            y: at[1] - 5.0,
            width: 10.0,
            height: 10.0,
        });
        // Outwards, where the path is not in the way.
        let outwards = [at[0] - middle[0], at[1] - middle[1]];
        labels.place(svg, "mark-name", frame, at, outwards, &label);
    }
}

fn draw_legend(
    svg: &mut Svg,
    result: &Shown<'_>,
    magnification: Option<f64>,
    scale: f64,
    from: Pixel,
    right: f64,
) -> f64 {
    let mut entries = vec![("feed", "programmed path".to_owned())];
    if result.points.iter().any(|p| p.kind == PointKind::Rapid) {
        entries.push(("rapid", "rapid move".to_owned()));
    }
    if let Some(factor) = magnification {
        let times = number::setting(factor);
        entries.push((
            "line before",
            format!("tool without compensation, deviation × {times}"),
        ));
    }
    let mut height = legend(svg, &entries, from, right);
    if let Some(factor) = magnification {
        // A bar that says how long a deviation is on this drawing.
        let pixels_per_mm = scale * factor;
        let bar = number::round_number(110.0 / pixels_per_mm);
        let [x, y] = [from[0], from[1] + height];
        let end = x + bar * pixels_per_mm;
        svg.line("bar", [x, y - 4.0], [end, y - 4.0]);
        svg.line("bar", [x, y - 8.0], [x, y]);
        svg.line("bar", [end, y - 8.0], [end, y]);
        let label = format!("this long: {} of deviation", number::length_setting(bar));
        svg.text("name", [end + 8.0, y], Anchor::Start, &label);
        height += 19.0;
    }
    height - 8.0
}

/// Uncompensated place of the tool, the deviation magnified; `None` for rapids.
pub(crate) fn displaced(point: &PointResult, magnification: f64) -> Option<[f64; 3]> {
    if point.kind == PointKind::Rapid {
        return None;
    }
    let mut place = [0.0; 3];
    for (axis, value) in place.iter_mut().enumerate() {
        *value = number::drawable(
            point.position_mm[axis] + magnification * point.error_before_mm[axis],
        )?;
    }
    Some(place)
}

/// True if the path is not flat.
fn has_height(points: &[PointResult]) -> bool {
    Span::of(points.iter().map(|p| p.position_mm[2])).is_some_and(|span| span.length() > 1e-3)
}
