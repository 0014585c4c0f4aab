//! The scale of colours of a section: bands between round values.

use crate::chart::Span;
use crate::chart::label::{Frame, widest};
use crate::number;
use crate::svg::{Anchor, Svg};

/// Colours of the style sheet, from low to high.
const COLOURS: usize = 11;
/// Shades of each of the two hues of the style sheet.
const SHADES: usize = 5;
/// Bands of a scale with two hues, about.
const HUES: usize = 9;
/// A span of more than this ratio is divided by ratios.
const WIDE: f64 = 50.0;
/// Width of the scale beside the section.
pub(crate) const BAR: f64 = 18.0;

/// Round values that divide the colours.
#[derive(Default)]
pub(crate) struct Bands {
    pub(crate) borders: Vec<f64>,
    pub(crate) labels: Vec<String>,
    /// The border that parts two hues, by its number, and the most bands on one side of it.
    parted: Option<(usize, usize)>,
}

impl Bands {
    pub(crate) fn of(values: impl Iterator<Item = f64>, from: Option<f64>) -> Self {
        let none = Self::default();
        let Some(span) = Span::of(values) else {
            return none;
        };
        if from.is_none() && span.low > 0.0 && span.high > WIDE * span.low {
            return Self::by_ratio(span);
        }
        let span = from.map_or(span, |from| span.including(from)).widened();
        // The lowest and the highest band reach beyond their borders.
        let inside = |wanted: usize| -> Vec<_> {
            let ticks = span.ticks(wanted).into_iter();
            ticks
                .filter(|t| t.value > span.low && t.value < span.high)
                .collect()
        };
        // Every band has a colour of its own.
        let ticks = (1..=COLOURS).rev().map(inside).find(|t| t.len() < COLOURS);
        let ticks = ticks.into_iter().flatten();
        let (borders, labels) = ticks.map(|t| (t.value, t.label)).unzip();
        Self {
            borders,
            labels,
            parted: None,
        }
    }

    /// Round values of which the middle is one.
    pub(crate) fn parted(values: impl Iterator<Item = f64>, middle: f64) -> Self {
        let Some(span) = Span::of(values.map(|value| value - middle)) else {
            return Self::default();
        };
        // Where all is the middle, there is no distance to shade.
        let (most, shades) = match span.low.abs().max(span.high.abs()) {
            0.0 => (1.0, SHADES),
            most => (most, 1),
        };
        // As many bands on both sides of zero, so that equal distances have equal shades.
        let both = Span {
            low: -most,
            high: most,
        };
        let step = match both.ticks(HUES).as_slice() {
            [first, second, ..] => second.value - first.value,
            _ => most,
        };
        let below = (-span.low / step).ceil().max(1.0) as usize;
        let above = (span.high / step).ceil().max(1.0) as usize;
        let counts = (0..below + above - 1).map(|k| k as f64 + 1.0 - below as f64);
        let borders: Vec<f64> = counts.map(|k| middle + k * step).collect();
        let decimals = usize::try_from(-(step.log10() + 1e-9).floor() as i64).unwrap_or(0);
        let label = |x: &f64| number::fixed(*x, decimals.min(9));
        Self {
            labels: borders.iter().map(label).collect(),
            borders,
            parted: Some((below - 1, below.max(above).max(shades))),
        }
    }

    /// 1, 2, 5 times powers of ten, or the powers alone.
    fn by_ratio(span: Span) -> Self {
        let decades = span.low.log10().floor() as i32..=span.high.log10().ceil() as i32;
        let steps: &[f64] = match span.high / span.low {
            ratio if ratio > 1e3 => &[1.0],
            _ => &[1.0, 2.0, 5.0],
        };
        let borders: Vec<f64> = decades
            .flat_map(|d| steps.iter().map(move |s| s * 10f64.powi(d)))
            .filter(|x| *x > span.low && *x < span.high)
            .collect();
        let labels = borders
            .iter()
            .map(|x| number::significant(*x, 1, number::Rounding::Nearest))
            .collect();
        Self {
            borders,
            labels,
            parted: None,
        }
    }

    /// Number of the band of a value.
    fn band(&self, value: f64) -> usize {
        self.borders.partition_point(|border| *border <= value)
    }

    pub(crate) fn class(&self, value: f64) -> String {
        self.colour(self.band(value))
    }

    fn colour(&self, band: usize) -> String {
        if let Some((border, most)) = self.parted {
            let (hue, away) = match band > border {
                true => ("more", band - border),
                false => ("less", border + 1 - band),
            };
            let shade = (away * SHADES).div_ceil(most).clamp(1, SHADES);
            return format!("{hue}{shade}");
        }
        let most = self.borders.len().max(1);
        let colour = (band * (COLOURS - 1) + most / 2) / most;
        format!("f{colour}")
    }

    /// The scale of colours with its borders.
    pub(crate) fn key(&self, svg: &mut Svg, left: f64, room: &Frame, label: &str) {
        if self.borders.is_empty() && self.labels.is_empty() {
            return;
        }
        let bands = self.borders.len() + 1;
        let height = room.height.min(34.0 * bands as f64) / bands as f64;
        let bottom = room.y + 0.5 * (room.height + height * bands as f64);
        for band in 0..bands {
            let top = bottom - height * (band + 1) as f64;
            svg.rectangle(&self.colour(band), [left, top], [BAR, height], 0.0);
        }
        for (k, text) in self.labels.iter().enumerate() {
            let at = bottom - height * (k + 1) as f64;
            svg.line("axis", [left + BAR, at], [left + BAR + 4.0, at]);
            svg.text("tick", [left + BAR + 7.0, at + 4.2], Anchor::Start, text);
        }
        let widest = widest(self.labels.iter().map(String::as_str));
        let beside = [left + BAR + 26.0 + widest, room.y + 0.5 * room.height];
        svg.text_upwards("name", beside, label);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_span_is_divided_by_ratios() {
        let bands = Bands::of([0.3, 40.0].into_iter(), None);
        assert_eq!(bands.borders, [0.5, 1.0, 2.0, 5.0, 10.0, 20.0]);
        assert_eq!((bands.band(0.4), bands.band(40.0)), (0, 6));
        let classes: Vec<String> = (0..7).map(|b| bands.colour(b)).collect();
        assert_eq!((classes[0].as_str(), classes[6].as_str()), ("f0", "f10"));
        // All the same.
        let flat = Bands::of([7.0, 7.0].into_iter(), None);
        assert!(flat.borders.len() < 20);
    }

    #[test]
    fn each_side_of_a_middle_has_a_hue_of_its_own() {
        let bands = Bands::parted([-7.0, 46.0].into_iter(), 0.0);
        assert_eq!(bands.borders, [0.0, 10.0, 20.0, 30.0, 40.0]);
        assert_eq!(
            (bands.class(-1.0), bands.class(1.0)),
            ("less1".into(), "more1".into())
        );
        assert_eq!(bands.class(45.0), "more5");
        // Nothing but gain: no shade of loss is used, and the middle is on the scale.
        let gain = Bands::parted([2.0, 46.0].into_iter(), 0.0);
        assert_eq!((gain.borders[0], gain.class(2.0)), (0.0, "more1".into()));
        assert!(
            Bands::parted([0.0].into_iter(), 0.0)
                .class(0.0)
                .ends_with('1')
        );
    }
}
