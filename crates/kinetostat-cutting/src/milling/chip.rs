//! Feed from tooth to tooth, and thickness of the chip with run-out.
//!
//! `h = min over m = 1..N of [m c sin phi + rho_j - rho_(j+m)] sin kappa`: a tooth cuts what the teeth before it have left, and
//! a chip that one misses is cut by the next. With a feed down the axis, `c sin phi sin kappa` is `c sin phi sin kappa + d cos
//! kappa`, the way of the envelope along its normal.

use std::f64::consts::{PI, TAU};

use crate::error::{CutErrorKind, Result, within};
use crate::tool::{Meridian, Tool};

/// One line of the least thickness: so many feeds, and by how much this tooth stands out from that one, mm.
#[derive(Clone, Copy, Debug)]
struct Line {
    feeds: f64,
    offset: f64,
}

/// Chip of a tooth.
#[derive(Clone, Debug)]
pub(crate) struct Tooth {
    /// Number of teeth with equal chips.
    pub(crate) alike: f64,
    /// The lines of the least, each from its own place to the next one's.
    lines: Vec<Line>,
    /// Way along the normal (per sine of its angle) at which each line begins; the chip begins at the first.
    knots: Vec<f64>,
}

/// The teeth of a tool.
#[derive(Clone, Debug)]
pub(crate) struct Chips {
    pub(crate) teeth: Vec<Tooth>,
}

impl Chips {
    pub(crate) fn new(tool: &Tool) -> Self {
        let count = tool.teeth();
        let tooth = |j: usize| Tooth::new(tool, j);
        let teeth = match tool.run_out().offset_mm == 0.0 {
            true => vec![Tooth {
                alike: count as f64,
                ..tooth(0)
            }],
            false => (0..count).map(tooth).collect(),
        };
        Self { teeth }
    }

    /// All teeth have the same chips.
    pub(crate) fn alike(&self) -> bool {
        self.teeth.len() == 1
    }
}

impl Tooth {
    fn new(tool: &Tool, j: usize) -> Self {
        let count = tool.teeth();
        let line = |m: usize| Line {
            feeds: m as f64,
            offset: tool.stands_out_mm(j) - tool.stands_out_mm((j + m) % count),
        };
        let all: Vec<Line> = match tool.run_out().offset_mm == 0.0 {
            true => vec![Line {
                feeds: 1.0,
                offset: 0.0,
            }],
            false => (1..=count).map(line).collect(),
        };
        let (lines, knots) = least(&all);
        Self {
            alike: 1.0,
            lines,
            knots,
        }
    }

    /// Thickness at a place of the envelope, mm; zero or less where there is no chip.
    #[inline]
    pub(crate) fn thickness(&self, feed: &Feed, place: &Meridian, sin_phi: f64) -> f64 {
        let way = feed.level_mm * sin_phi * place.sin + feed.down_mm * place.cos;
        // The normal is the axis on the flat end: teeth that protrude sideways find nothing else there.
        if let [line] = self.lines[..] {
            return line.feeds * way + line.offset * place.sin;
        }
        let at = |line: &Line| line.feeds * way + line.offset * place.sin;
        match place.sin > 0.0 {
            true => {
                let p = way / place.sin;
                let after = self.knots.partition_point(|knot| *knot <= p);
                at(&self.lines[after.saturating_sub(1)])
            }
            false => way,
        }
    }

    /// Angles at which the chip begins, ends or follows another tooth, between `from` and `to`, rad.
    pub(crate) fn breaks(
        &self,
        feed: &Feed,
        place: &Meridian,
        from: f64,
        to: f64,
        mut found: impl FnMut(f64),
    ) {
        if feed.level_mm <= 0.0 || place.sin <= 0.0 {
            return;
        }
        for knot in &self.knots {
            let sine = (knot - feed.down_mm * place.cos / place.sin) / feed.level_mm;
            if sine.abs() < 1.0 {
                let angle = sine.asin();
                for one in [angle, PI - angle] {
                    let mut phi = one + TAU * ((from - one) / TAU).ceil();
                    while phi < to {
                        found(phi);
                        phi += TAU;
                    }
                }
            }
        }
    }
}

/// The least of lines where it is positive: its lines in order, and where each begins.
fn least(all: &[Line]) -> (Vec<Line>, Vec<f64>) {
    let begins = |line: &Line| -line.offset / line.feeds;
    // The chip is there once the last of the lines is positive; of two there, the flatter is the least beyond.
    let Some(mut line) = all.iter().copied().reduce(|a, b| {
        let (from_a, from_b) = (begins(&a), begins(&b));
        match from_b > from_a || (from_b == from_a && b.feeds < a.feeds) {
            true => b,
            false => a,
        }
    }) else {
        return (Vec::new(), Vec::new());
    };
    let (mut lines, mut knots) = (vec![line], vec![begins(&line)]);
    loop {
        let crossing = |other: &Line| (other.offset - line.offset) / (line.feeds - other.feeds);
        let next = all
            .iter()
            .filter(|other| other.feeds < line.feeds)
            .map(|other| (crossing(other), *other))
            .reduce(
                |a, b| match b.0 < a.0 || (b.0 == a.0 && b.1.feeds < a.1.feeds) {
                    true => b,
                    false => a,
                },
            );
        let Some((at, other)) = next else {
            return (lines, knots);
        };
        line = other;
        lines.push(line);
        knots.push(at);
    }
}

/// Feed from tooth to tooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feed {
    /// Feed across the tool axis, mm per tooth.
    pub level_mm: f64,
    /// Feed down along the tool axis, mm per tooth; negative where the tool rises.
    pub down_mm: f64,
}

impl Feed {
    /// Feed across the tool axis, mm per tooth.
    ///
    /// # Errors
    /// Negative, or more than 10 mm.
    pub fn level(per_tooth_mm: f64) -> Result<Self> {
        Self::ramp(per_tooth_mm, 0.0)
    }

    /// Feed across the tool axis and down along it, mm per tooth.
    ///
    /// # Errors
    /// Negative across, or more than 10 mm either way.
    pub fn ramp(level_mm: f64, down_mm: f64) -> Result<Self> {
        let cut = CutErrorKind::Cut;
        within(cut, "feed per tooth", level_mm, 0.0..=10.0, "mm")?;
        within(
            cut,
            "feed per tooth down the axis",
            down_mm,
            -10.0..=10.0,
            "mm",
        )?;
        Ok(Self { level_mm, down_mm })
    }
}
