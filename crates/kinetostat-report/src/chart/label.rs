//! Text on figures: titles, labels beside points that do not cover each other, and names that keep away from lines.

use crate::svg::{Anchor, Pixel, Svg};
use crate::text;

/// Size of text in drawings, in pixels; the style sheet says the same.
pub(crate) const TEXT_SIZE: f64 = 12.5;

/// Width of the widest of some labels, pixels.
pub(crate) fn widest<'a>(labels: impl Iterator<Item = &'a str>) -> f64 {
    labels
        .map(|label| text::width(label, TEXT_SIZE))
        .fold(0.0, f64::max)
}

/// A rectangle on the drawing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Frame {
    pub(crate) fn right(&self) -> f64 {
        self.x + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.y + self.height
    }

    pub(crate) fn covers(&self, other: &Self) -> bool {
        self.x < other.right()
            && other.x < self.right()
            && self.y < other.bottom()
            && other.y < self.bottom()
    }

    pub(crate) fn holds(&self, at: Pixel) -> bool {
        self.x < at[0] && at[0] < self.right() && self.y < at[1] && at[1] < self.bottom()
    }

    pub(crate) fn contains(&self, other: &Self) -> bool {
        self.x <= other.x
            && self.y <= other.y
            && self.right() >= other.right()
            && self.bottom() >= other.bottom()
    }
}

/// Places that are taken.
#[derive(Default)]
pub(crate) struct Labels {
    taken: Vec<Frame>,
}

impl Labels {
    /// Reserves a frame in which nothing may be written.
    pub(crate) fn reserve(&mut self, frame: Frame) {
        self.taken.push(frame);
    }

    /// True if something is written or drawn in a frame.
    pub(crate) fn is_taken(&self, frame: &Frame) -> bool {
        self.taken.iter().any(|other| other.covers(frame))
    }

    /// Writes a label beside a point, where there is room inside the frame, if possible in the wanted
    /// direction; says if there was room.
    pub(crate) fn place(
        &mut self,
        svg: &mut Svg,
        class: &str,
        frame: &Frame,
        at: Pixel,
        wanted: Pixel,
        label: &str,
    ) -> bool {
        let width = 1.1 * text::width(label, TEXT_SIZE) + 8.0;
        let mut choices = [
            (0.0, -9.0, Anchor::Middle),
            (9.0, -6.0, Anchor::Start),
            (-9.0, -6.0, Anchor::End),
            (9.0, 15.0, Anchor::Start),
            (-9.0, 15.0, Anchor::End),
            (0.0, 20.0, Anchor::Middle),
            (0.0, -24.0, Anchor::Middle),
        ];
        let along = |choice: &(f64, f64, Anchor)| {
            // Text stands on its base line: its middle is a little higher.
            let (x, y) = (choice.0, choice.1 - 4.0);
            (x * wanted[0] + y * wanted[1]) / x.hypot(y)
        };
        choices.sort_by(|a, b| along(b).total_cmp(&along(a)));
        for (dx, dy, anchor) in choices {
            let (x, y) = (at[0] + dx, at[1] + dy);
            let left = match anchor {
                Anchor::Start => x,
                Anchor::Middle => x - 0.5 * width,
                Anchor::End => x - width,
            };
            let area = Frame {
                x: left,
                y: y - 11.0,
                width,
                height: 14.0,
            };
            if frame.contains(&area) && !self.is_taken(&area) {
                self.taken.push(area);
                svg.text(class, [x, y], anchor, label);
                return true;
            }
        }
        false
    }
}

/// Size of the title; the style sheet says the same.
pub(crate) const TITLE_SIZE: f64 = 13.5;

/// A title in at most two lines; what is longer is cut.
pub(crate) fn title_lines(title: &str, width: f64) -> Vec<String> {
    let size = |text: &str| text::bold_width(text, TITLE_SIZE);
    let mut lines = vec![String::new()];
    for word in title.split(' ').filter(|word| !word.is_empty()) {
        let last = lines.len() - 1;
        let longer = if lines[last].is_empty() {
            word.to_owned()
        } else {
            format!("{} {word}", lines[last])
        };
        if size(&longer) <= width || lines[last].is_empty() {
            lines[last] = longer;
        } else if lines.len() < 2 {
            lines.push(word.to_owned());
        } else {
            let fitting = longer.chars().count().saturating_sub(word.chars().count());
            lines[last] = format!("{}\u{2026}", text::shorten(&lines[last], fitting));
            break;
        }
    }
    for line in &mut lines {
        if size(line) > width {
            let share = width / size(line);
            *line = text::shorten(line, (share * line.chars().count() as f64) as usize);
        }
    }
    lines
}

/// Distance of the points by which lines are felt, pixels.
const STEP: f64 = 3.0;
/// Gaps between a point and its name that are tried, pixels.
const GAPS: [f64; 7] = [4.0, 9.0, 16.0, 26.0, 40.0, 58.0, 80.0];
/// Directions that are tried.
const TURNS: usize = 16;
/// A name that is farther from its point has a line to it.
const FAR: f64 = 11.0;
/// Height of a name, and of its middle above its base line.
const HEIGHT: f64 = 15.0;
const RISE: f64 = 4.3;

/// Obstacles for names.
pub(crate) struct Names {
    frame: Frame,
    /// Never covered: marks and other names.
    taken: Vec<Frame>,
    /// Points of lines with half their widths, better not covered.
    lines: Vec<(Pixel, f64)>,
}

/// Anchor of a name.
#[derive(Clone, Copy)]
pub(crate) struct Beside {
    pub(crate) at: Pixel,
    /// Radius of the symbol at `at`, pixels.
    pub(crate) radius: f64,
    /// Unit vector to where the name stands best.
    pub(crate) toward: Pixel,
}

impl Beside {
    /// A point, its name best above at the right.
    pub(crate) fn point(at: Pixel, radius: f64) -> Self {
        Self {
            at,
            radius,
            toward: [0.77, -0.64],
        }
    }
}

/// A place for a name.
struct LabelPlace {
    area: Frame,
    anchor: Anchor,
    gap: f64,
}

/// Names cover neither each other nor, if it can be helped, a line.
///
/// One after the other, each at the cheapest of many places around its point: near, in the direction that is wanted, on few lines.
/// Where nothing near is free, the free place that is nearest, with a thin line to the point.
impl Names {
    pub(crate) fn within(frame: Frame) -> Self {
        Self {
            frame,
            taken: Vec::new(),
            lines: Vec::new(),
        }
    }

    /// Something round that is never covered.
    pub(crate) fn mark(&mut self, at: Pixel, radius: f64) {
        self.taken.push(Frame {
            x: at[0] - radius,
            y: at[1] - radius,
            width: 2.0 * radius,
            height: 2.0 * radius,
        });
    }

    /// Something long that is never covered.
    pub(crate) fn bar(&mut self, from: Pixel, to: Pixel, radius: f64) {
        along(from, to, STEP, |at| self.mark(at, radius));
    }

    /// A drawn line and half its width.
    pub(crate) fn line(&mut self, points: &[Option<Pixel>], half: f64) {
        for pair in points.windows(2) {
            let [Some(a), Some(b)] = pair else { continue };
            along(*a, *b, STEP, |at| self.lines.push((at, half)));
        }
    }

    /// True if a circle lies within the frame.
    pub(crate) fn room_for(&self, at: Pixel, radius: f64) -> bool {
        let corner = [at[0] - radius, at[1] - radius];
        self.frame.holds(corner) && self.frame.holds([at[0] + radius, at[1] + radius])
    }

    /// Cost of obstacles in the way of a line: marks count more than lines.
    pub(crate) fn in_the_way(&self, from: Pixel, to: Pixel, half: f64) -> f64 {
        let mut cost = 0.0;
        along(from, to, STEP, |at| {
            let near =
                |(p, own): &&(Pixel, f64)| (p[0] - at[0]).hypot(p[1] - at[1]) < own + half + 1.0;
            cost += self.lines.iter().filter(near).count().min(2) as f64;
            cost += 2.0 * self.taken.iter().filter(|t| t.holds(at)).count().min(2) as f64;
        });
        cost
    }

    /// Writes a name beside its point.
    pub(crate) fn write(&mut self, svg: &mut Svg, at: Pixel, name: &str) {
        self.write_as(svg, "mark-name", &Beside::point(at, 6.0), name);
    }

    /// Writes a name, with a thin line to its point where it must stand farther away.
    pub(crate) fn write_as(&mut self, svg: &mut Svg, class: &str, beside: &Beside, name: &str) {
        let width = text::bold_width(name, TEXT_SIZE) + 6.0;
        let near = self.near(beside, width);
        let Some(place) = near.or_else(|| self.anywhere(beside, width)) else {
            return;
        };
        let area = place.area;
        if place.gap > FAR {
            let end = [
                beside.at[0].clamp(area.x + 2.0, area.right() - 2.0),
                beside.at[1].clamp(area.y + 2.0, area.bottom() - 2.0),
            ];
            let share = beside.radius
                / (end[0] - beside.at[0])
                    .hypot(end[1] - beside.at[1])
                    .max(1e-9);
            let start = [
                beside.at[0] + share * (end[0] - beside.at[0]),
                beside.at[1] + share * (end[1] - beside.at[1]),
            ];
            svg.line("lead", start, end);
            self.line(&[Some(start), Some(end)], 0.5);
        }
        let x = match place.anchor {
            Anchor::Start => area.x + 3.0,
            Anchor::Middle => area.x + 0.5 * area.width,
            Anchor::End => area.right() - 3.0,
        };
        svg.text(class, [x, area.y + 0.5 * HEIGHT + RISE], place.anchor, name);
        self.taken.push(area);
    }

    /// The cheapest place on rings about the point.
    fn near(&self, beside: &Beside, width: f64) -> Option<LabelPlace> {
        let mut best: Option<(f64, LabelPlace)> = None;
        for (ring, gap) in GAPS.into_iter().enumerate() {
            for turn in 0..TURNS {
                let angle = std::f64::consts::TAU * turn as f64 / TURNS as f64;
                let (y, x) = angle.sin_cos();
                let away = beside.radius + gap;
                // The side or corner of the name that looks to the point lies on the ring.
                let side = |c: f64| if c.abs() < 0.3 { 0.0 } else { c.signum() };
                let middle = [
                    beside.at[0] + away * x + 0.5 * (width - 4.0) * side(x),
                    beside.at[1] + away * y + 0.5 * (HEIGHT - 4.0) * side(y),
                ];
                let area = about(middle, width);
                if !self.free(&area) {
                    continue;
                }
                let cosine = x * beside.toward[0] + y * beside.toward[1];
                let mut cost = self.covered(&area) + 9.0 * ring as f64 + 4.0 * (1.0 - cosine);
                if gap > FAR {
                    cost += 8.0 + self.in_the_way(beside.at, middle, 0.5).min(40.0);
                }
                if best.as_ref().is_none_or(|b| cost < b.0) {
                    let anchor = match side(x) {
                        s if s > 0.0 => Anchor::Start,
                        s if s < 0.0 => Anchor::End,
                        _ => Anchor::Middle,
                    };
                    best = Some((cost, LabelPlace { area, anchor, gap }));
                }
            }
        }
        best.map(|b| b.1)
    }

    /// The free place that is nearest, wherever it is.
    fn anywhere(&self, beside: &Beside, width: f64) -> Option<LabelPlace> {
        let mut best: Option<(f64, Frame)> = None;
        let (columns, rows) = (self.frame.width / 8.0, self.frame.height / 8.0);
        for column in 0..columns.clamp(0.0, 200.0) as usize {
            for row in 0..rows.clamp(0.0, 200.0) as usize {
                let middle = [
                    self.frame.x + 8.0 * column as f64,
                    self.frame.y + 8.0 * row as f64,
                ];
                let area = about(middle, width);
                if !self.free(&area) {
                    continue;
                }
                let away = (middle[0] - beside.at[0]).hypot(middle[1] - beside.at[1]);
                let cost = away + self.covered(&area);
                if best.as_ref().is_none_or(|b| cost < b.0) {
                    best = Some((cost, area));
                }
            }
        }
        best.map(|(_, area)| LabelPlace {
            area,
            anchor: Anchor::Middle,
            gap: f64::INFINITY,
        })
    }

    fn free(&self, area: &Frame) -> bool {
        self.frame.contains(area) && !self.taken.iter().any(|t| t.covers(area))
    }

    /// Cost of a name there for the lines below it.
    fn covered(&self, area: &Frame) -> f64 {
        let on = |(p, half): &&(Pixel, f64)| {
            let half = half + 1.0;
            p[0] > area.x - half
                && p[0] < area.right() + half
                && p[1] > area.y - half
                && p[1] < area.bottom() + half
        };
        10.0 * self.lines.iter().filter(on).count() as f64
    }
}

fn about(middle: Pixel, width: f64) -> Frame {
    Frame {
        x: middle[0] - 0.5 * width,
        y: middle[1] - 0.5 * HEIGHT,
        width,
        height: HEIGHT,
    }
}

/// Points of a straight line, at most `step` apart.
fn along(from: Pixel, to: Pixel, step: f64, mut each: impl FnMut(Pixel)) {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let count = (dx.hypot(dy) / step).ceil().clamp(1.0, 1000.0) as usize;
    for k in 0..=count {
        let share = k as f64 / count as f64;
        each([from[0] + share * dx, from[1] + share * dy]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_titles_take_two_lines_and_no_more() {
        let long = "a title of many words that goes on and on ".repeat(8);
        let lines = title_lines(&long, 700.0);
        assert_eq!(lines.len(), 2);
        assert!(lines[1].ends_with('\u{2026}'));
        assert!(
            lines
                .iter()
                .all(|l| text::bold_width(l, TITLE_SIZE) < 720.0)
        );
        assert_eq!(title_lines("short", 700.0), ["short"]);
        assert_eq!(title_lines(&"x".repeat(500), 700.0).len(), 1);
    }
}
