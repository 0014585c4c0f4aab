//! Charts: axes, lines, labels that avoid each other, and what is drawn from them.
//!
//! Takes numbers with the words for their axes; gives SVG. Knows neither runs nor machines.

pub(crate) mod area;
pub(crate) mod bands;
pub(crate) mod bars;
pub(crate) mod cell;
pub(crate) mod fine;
pub(crate) mod label;
pub(crate) mod outline;
pub(crate) mod panel;
pub(crate) mod plot;
pub(crate) mod section;

use crate::number;

/// Range from the smallest to the largest value shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

/// A tick with its label.
pub(crate) struct Tick {
    pub(crate) value: f64,
    pub(crate) label: String,
}

impl Span {
    /// The span of the values that can be drawn; none without any.
    pub(crate) fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        values
            .filter_map(number::drawable)
            .fold(None, |span, value| match span {
                None => Some(Self {
                    low: value,
                    high: value,
                }),
                Some(span) => Some(span.including(value)),
            })
    }

    pub(crate) fn including(self, value: f64) -> Self {
        Self {
            low: self.low.min(value),
            high: self.high.max(value),
        }
    }

    pub(crate) fn joined(self, other: Self) -> Self {
        self.including(other.low).including(other.high)
    }

    pub(crate) fn length(self) -> f64 {
        self.high - self.low
    }

    pub(crate) fn middle(self) -> f64 {
        0.5 * (self.low + self.high)
    }

    /// Zero belongs to the span unless the values are far from it compared with their spread.
    pub(crate) fn with_near_zero(self) -> Self {
        let (near, far) = (
            self.low.abs().min(self.high.abs()),
            self.low.abs().max(self.high.abs()),
        );
        if self.low * self.high > 0.0 && near > 0.6 * far {
            self
        } else {
            self.including(0.0)
        }
    }

    /// The span of all values but a few spikes: where at most one value in 50 makes the span more than four times as long as
    /// all others do, those are left out.
    pub(crate) fn without_spikes(values: impl Iterator<Item = f64>) -> Option<Self> {
        let mut all: Vec<f64> = values.filter_map(number::drawable).collect();
        all.sort_unstable_by(f64::total_cmp);
        let (low, high) = (*all.first()?, *all.last()?);
        let whole = Self { low, high };
        let few = all.len() / 50;
        let most = Self {
            low: all[few],
            high: all[all.len() - 1 - few],
        };
        // Values that hardly leave the others are no spikes.
        let room = 0.5 * most.length();
        let near = |value: &f64| (most.low - room..=most.high + room).contains(value);
        let others = Self::of(all.into_iter().filter(near))?;
        let is_spike =
            few > 0 && whole.with_near_zero().length() > 4.0 * others.with_near_zero().length();
        Some(if is_spike { others } else { whole })
    }

    /// Never so thin that a small change of a large value fills the height: at least a fifth of the largest value.
    pub(crate) fn moderate(self) -> Self {
        let least = 0.2 * self.low.abs().max(self.high.abs());
        if self.length() >= least {
            return self;
        }
        Self {
            low: self.middle() - 0.5 * least,
            high: self.middle() + 0.5 * least,
        }
    }

    /// Never empty, and never so thin that the noise of arithmetic fills the plot.
    pub(crate) fn widened(self) -> Self {
        let size = self.low.abs().max(self.high.abs());
        if size == 0.0 {
            return Self {
                low: 0.0,
                high: 1.0,
            };
        }
        let least = 0.02 * size;
        if self.length() >= least {
            return self;
        }
        let middle = self.middle();
        Self {
            low: middle - least,
            high: middle + least,
        }
    }

    /// Adds room at the ends, as shares of the length; an end at zero stays.
    pub(crate) fn padded(self, below: f64, above: f64) -> Self {
        let length = self.length();
        Self {
            low: if self.low == 0.0 {
                0.0
            } else {
                self.low - below * length
            },
            high: if self.high == 0.0 {
                0.0
            } else {
                self.high + above * length
            },
        }
    }

    /// Round ticks inside the span, about as many as wanted.
    pub(crate) fn ticks(self, wanted: usize) -> Vec<Tick> {
        let raw = self.length() / wanted.max(1) as f64;
        if !raw.is_finite() || raw <= 0.0 {
            return Vec::new();
        }
        let step = round_step(raw);
        let decimals = usize::try_from(-(step.log10() + 1e-9).floor() as i64)
            .unwrap_or(0)
            .min(9);
        let slack = 1e-9 * self.length();
        let first = ((self.low - slack) / step).ceil();
        let last = ((self.high + slack) / step).floor();
        (0..=20)
            .map(|index| first + f64::from(index))
            .take_while(|count| *count <= last)
            .map(|count| Tick {
                value: count * step,
                label: number::fixed(count * step, decimals),
            })
            .collect()
    }

    /// Round ticks of a span of decimal logarithms: powers of ten, and 2 and 5 times them where few of those are in it.
    pub(crate) fn decade_ticks(self) -> Vec<Tick> {
        if !self.length().is_finite() || self.length() > 60.0 {
            return Vec::new();
        }
        let (first, last) = (self.low.floor() as i32, self.high.ceil() as i32);
        let every = ((last - first) as usize / 8).max(1);
        let between: &[u32] = match self.length() {
            length if length < 1.2 => &[1, 2, 3, 4, 5, 6, 7, 8, 9],
            length if length < 3.5 => &[1, 2, 5],
            _ => &[1],
        };
        let mut ticks = Vec::new();
        for power in (first..=last).step_by(every) {
            for factor in between {
                let value = f64::from(*factor).log10() + f64::from(power);
                if value >= self.low - 1e-9 && value <= self.high + 1e-9 {
                    let label = match power {
                        0..=5 => format!("{}", u64::from(*factor) * 10_u64.pow(power as u32)),
                        -4..=-1 => number::fixed(
                            f64::from(*factor) * 10_f64.powi(power),
                            power.unsigned_abs() as usize,
                        ),
                        _ => number::typeset(&format!("{factor}e{power}")),
                    };
                    ticks.push(Tick { value, label });
                }
            }
        }
        ticks
    }
}

/// The round step (1, 2, 5 times a power of ten) nearest to a length in ratio.
fn round_step(raw: f64) -> f64 {
    let power = 10f64.powf(raw.log10().floor());
    let share = raw / power;
    let step = match share {
        share if share < 2f64.sqrt() => 1.0,
        share if share < 10f64.sqrt() => 2.0,
        share if share < 50f64.sqrt() => 5.0,
        _ => 10.0,
    };
    step * power
}

/// The way from values to pixels.
#[derive(Clone, Copy)]
pub(crate) struct Scale {
    span: Span,
    from: f64,
    to: f64,
}

impl Scale {
    /// `span.low` is drawn at `from`, `span.high` at `to`.
    pub(crate) fn new(span: Span, from: f64, to: f64) -> Self {
        Self { span, from, to }
    }

    pub(crate) fn at(&self, value: f64) -> f64 {
        self.from + (value - self.span.low) / self.span.length() * (self.to - self.from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64) -> Vec<String> {
        Span { low, high }
            .ticks(5)
            .into_iter()
            .map(|t| t.label)
            .collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(labels(0.0, 0.8), ["0.0", "0.2", "0.4", "0.6", "0.8"]);
        assert_eq!(
            labels(-26.0, 26.0),
            ["\u{2212}20", "\u{2212}10", "0", "10", "20"]
        );
        assert!(labels(0.0, f64::INFINITY).is_empty());
        assert!(labels(1.0, 1.0).is_empty());
    }

    #[test]
    fn ticks_of_logarithms_are_round() {
        let labels = |low: f64, high: f64| -> Vec<String> {
            let ticks = Span { low, high }.decade_ticks();
            ticks.into_iter().map(|t| t.label).collect()
        };
        assert_eq!(labels(0.0, 2.0), ["1", "2", "5", "10", "20", "50", "100"]);
        assert_eq!(labels(-1.0, -0.5), ["0.1", "0.2", "0.3"]);
        assert_eq!(labels(-2.0, 3.0), ["0.01", "0.1", "1", "10", "100", "1000"]);
        assert!(labels(0.0, f64::INFINITY).is_empty());
    }

    #[test]
    fn a_small_change_of_a_large_value_stays_small() {
        let span = Span::of([296.0, 308.0].into_iter()).unwrap().moderate();
        let share = 12.0 / span.length();
        assert!((0.15..0.25).contains(&share), "{span:?}");
        assert!(span.low > 0.0 && span.low < 296.0 && span.high > 308.0);
        let wide = Span {
            low: -1.0,
            high: 10.0,
        };
        assert_eq!(wide.moderate(), wide);
    }

    #[test]
    fn a_spike_does_not_squash_the_rest() {
        let wave = || (0..100).map(|k| f64::from(k % 10));
        let span = |values: Vec<f64>| Span::without_spikes(values.into_iter()).unwrap();
        let most = |low: f64, high: f64| Span { low, high };
        assert_eq!(span(wave().chain([500.0]).collect()), most(0.0, 9.0));
        assert_eq!(span(wave().chain([-500.0]).collect()), most(0.0, 9.0));
        // A part of the curve is no spike, nor what lies a little beyond the others.
        assert_eq!(span(wave().chain([500.0; 20]).collect()), most(0.0, 500.0));
        assert_eq!(span(wave().chain([20.0]).collect()), most(0.0, 20.0));
        assert_eq!(span(vec![0.0, 1.0, 500.0]), most(0.0, 500.0));
    }

    #[test]
    fn spans_are_never_empty() {
        assert_eq!(Span::of([f64::NAN].into_iter()), None);
        let flat = Span::of([5.0, 5.0].into_iter()).unwrap().widened();
        assert!(flat.length() > 0.1);
        assert_eq!(
            Span {
                low: 0.0,
                high: 0.0
            }
            .widened(),
            Span {
                low: 0.0,
                high: 1.0
            }
        );
    }
}
