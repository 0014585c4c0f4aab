//! Names of marked points where they cover neither each other nor, if it can be helped, a line.

use crate::label::{Frame, TEXT_SIZE};
use crate::outline::Pixel;
use crate::svg::{Anchor, Svg};
use crate::text;

/// Distance of the points by which lines are felt, pixels.
const STEP: f64 = 3.0;

/// What is in the way of names.
pub(crate) struct Names {
    frame: Frame,
    /// Never covered: marks and other names.
    taken: Vec<Frame>,
    /// Points of lines, better not covered.
    lines: Vec<Pixel>,
}

impl Names {
    pub(crate) fn within(frame: Frame) -> Self {
        Self {
            frame,
            taken: Vec::new(),
            lines: Vec::new(),
        }
    }

    /// A marked point.
    pub(crate) fn mark(&mut self, at: Pixel) {
        self.taken.push(Frame {
            x: at.0 - 6.0,
            y: at.1 - 6.0,
            width: 12.0,
            height: 12.0,
        });
    }

    /// A drawn line.
    pub(crate) fn line(&mut self, points: &[Option<Pixel>]) {
        for pair in points.windows(2) {
            let [Some(a), Some(b)] = pair else { continue };
            let length = (b.0 - a.0).hypot(b.1 - a.1);
            let count = (length / STEP).ceil().clamp(1.0, 1000.0) as usize;
            for k in 0..=count {
                let share = k as f64 / count as f64;
                self.lines
                    .push((a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1)));
            }
        }
    }

    /// Writes a name beside its point, with a thin line to it where it must stand farther away.
    pub(crate) fn write(&mut self, svg: &mut Svg, at: Pixel, name: &str) {
        let width = 1.1 * text::width(name, TEXT_SIZE) + 4.0;
        let (height, rise) = (15.0, 11.5);
        // (cost of the place by itself, offset of the base line, anchor)
        let mut best: Option<(f64, Frame, Pixel, Anchor, bool)> = None;
        for (ring, away) in [10.0, 22.0, 36.0, 52.0].into_iter().enumerate() {
            for (turn, (dx, dy, anchor)) in [
                (0.7, -0.7, Anchor::Start),
                (-0.7, -0.7, Anchor::End),
                (0.7, 0.9, Anchor::Start),
                (-0.7, 0.9, Anchor::End),
                (0.0, -1.0, Anchor::Middle),
                (0.0, 1.0, Anchor::Middle),
                (1.0, 0.0, Anchor::Start),
                (-1.0, 0.0, Anchor::End),
            ]
            .into_iter()
            .enumerate()
            {
                // The text's middle lies on the ring; its base line a little lower.
                let x = at.0 + away * dx;
                let y = at.1 + away * dy + if dy < 0.0 { 1.0 } else { 5.0 };
                let left = match anchor {
                    Anchor::Start => x,
                    Anchor::Middle => x - 0.5 * width,
                    Anchor::End => x - width,
                };
                let area = Frame {
                    x: left - 1.0,
                    y: y - rise,
                    width: width + 2.0,
                    height,
                };
                let inside = area.x >= self.frame.x
                    && area.right() <= self.frame.right()
                    && area.y >= self.frame.y
                    && area.bottom() <= self.frame.bottom();
                if !inside || self.taken.iter().any(|t| t.covers(&area)) {
                    continue;
                }
                let crossed = self
                    .lines
                    .iter()
                    .filter(|p| {
                        p.0 > area.x - 2.0
                            && p.0 < area.right() + 2.0
                            && p.1 > area.y
                            && p.1 < area.bottom()
                    })
                    .count();
                let cost = 10.0 * crossed as f64 + 8.0 * ring as f64 + turn as f64;
                if best.as_ref().is_none_or(|b| cost < b.0) {
                    best = Some((cost, area, (x, y), anchor, ring > 0));
                }
            }
        }
        let Some((_, area, place, anchor, far)) = best else {
            return;
        };
        if far {
            let end = (
                at.0.clamp(area.x + 2.0, area.right() - 2.0),
                at.1.clamp(area.y + 2.0, area.bottom() - 2.0),
            );
            svg.line("lead", at, end);
        }
        svg.text("mark-name", place, anchor, name);
        self.taken.push(area);
    }
}
