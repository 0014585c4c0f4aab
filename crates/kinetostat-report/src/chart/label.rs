//! Labels beside points that do not cover each other.

use crate::svg::{Anchor, Pixel, Svg};
use crate::text;

/// Size of text in drawings, in pixels; the style sheet says the same.
pub(crate) const TEXT_SIZE: f64 = 12.5;

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
            if frame.contains(&area) && !self.taken.iter().any(|other| other.covers(&area)) {
                self.taken.push(area);
                svg.text(class, [x, y], anchor, label);
                return true;
            }
        }
        false
    }
}
