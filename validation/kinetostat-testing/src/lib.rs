//! Maxima of differences that a test may rely on.
//!
//! `f64::max` returns its other argument where one is NaN, and nalgebra's `amax` forgets a NaN that a
//! number follows. A test that folds with them passes where nothing was computed, and so does one whose
//! postures were all skipped. What stands here fails in both cases.

pub mod figure;

use std::fmt;
use std::panic::Location;

use nalgebra::storage::RawStorage;
use nalgebra::{Dim, Matrix, Matrix6};

/// The largest of many differences, with how many there were and which one it was.
///
/// NaN counts as the largest of all; [`Worst::value`] and [`Worst::of`] refuse it, and refuse a maximum
/// of nothing.
#[derive(Debug, Default, Clone)]
pub struct Worst {
    samples: usize,
    largest: Option<Largest>,
}

#[derive(Debug, Clone)]
struct Largest {
    size: f64,
    /// From 0.
    sample: usize,
    added: &'static Location<'static>,
    place: String,
}

impl Worst {
    /// Without samples.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// One more difference; its size counts.
    #[track_caller]
    pub fn add(&mut self, difference: f64) {
        self.add_at(difference, || "");
    }

    /// As [`Worst::add`], with words about where it was taken.
    #[track_caller]
    pub fn add_at<W: fmt::Display>(&mut self, difference: f64, place: impl FnOnce() -> W) {
        let size = difference.abs();
        let larger =
            |largest: &Largest| !largest.size.is_nan() && (size.is_nan() || size > largest.size);
        if self.largest.as_ref().is_none_or(larger) {
            self.largest = Some(Largest {
                size,
                sample: self.samples,
                added: Location::caller(),
                place: place().to_string(),
            });
        }
        self.samples += 1;
    }

    /// The difference of two numbers.
    #[track_caller]
    pub fn apart(&mut self, found: f64, expected: f64) {
        self.add(found - expected);
    }

    /// The differences of all numbers of two lists, which must be equally long.
    #[track_caller]
    pub fn all_apart(&mut self, found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            self.apart(*found, *expected);
        }
    }

    /// The differences of all entries, each as a share of the geometric mean of its two diagonal
    /// entries in `size`.
    #[track_caller]
    pub fn matrix(&mut self, found: &Matrix6<f64>, expected: &Matrix6<f64>, size: &Matrix6<f64>) {
        for i in 0..6 {
            for j in 0..6 {
                let unit = (size[(i, i)] * size[(j, j)]).sqrt();
                self.add((found[(i, j)] - expected[(i, j)]) / unit);
            }
        }
    }

    /// The difference in units of the last of `digits` significant digits of what is expected.
    #[track_caller]
    pub fn printed(&mut self, found: f64, expected: f64, digits: i32) {
        let unit = 10_f64.powi(expected.abs().log10().floor() as i32 + 1 - digits);
        self.add((found - expected) / unit);
    }

    /// Number of differences so far.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// The largest, NaN where one was NaN; none without samples. For output: an assertion takes
    /// [`Worst::value`], [`Worst::of`] or [`Worst::holds`].
    #[must_use]
    pub fn measured(&self) -> Option<f64> {
        self.largest.as_ref().map(|largest| largest.size)
    }

    /// True where there were differences and none is above the limit or NaN.
    #[must_use]
    pub fn holds(&self, most: f64) -> bool {
        self.measured().is_some_and(|size| size <= most)
    }

    /// The largest.
    ///
    /// # Panics
    /// Without samples, and where one was NaN.
    #[must_use]
    #[track_caller]
    pub fn value(&self) -> f64 {
        assert!(self.samples > 0, "nothing was compared");
        let size = self.measured().unwrap_or(f64::NAN);
        assert!(!size.is_nan(), "{self}");
        size
    }

    /// The largest of exactly so many.
    ///
    /// # Panics
    /// With another number of samples, and where one was NaN.
    #[must_use]
    #[track_caller]
    pub fn of(&self, samples: usize) -> f64 {
        assert_eq!(
            self.samples, samples,
            "not as many were compared as are there"
        );
        self.value()
    }

    /// As [`Worst::of`] where none may be right: then 0.
    ///
    /// # Panics
    /// As [`Worst::of`].
    #[must_use]
    #[track_caller]
    pub fn of_all(&self, samples: usize) -> f64 {
        match (samples, self.samples) {
            (0, 0) => 0.0,
            _ => self.of(samples),
        }
    }

    /// The words that came with the largest.
    #[must_use]
    pub fn place(&self) -> &str {
        self.largest.as_ref().map_or("", |largest| &largest.place)
    }
}

/// The size, where it was, and how many there were.
impl fmt::Display for Worst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.largest {
            None => f.write_str("nothing was compared"),
            Some(Largest {
                size,
                sample,
                added,
                place,
            }) => write!(
                f,
                "{size:e} at {place}{}sample {} of {}, added in {added}",
                if place.is_empty() { "" } else { ", " },
                sample + 1,
                self.samples,
            ),
        }
    }
}

/// The largest number.
///
/// # Panics
/// Where there is none, or one is NaN.
#[must_use]
#[track_caller]
pub fn largest(numbers: impl IntoIterator<Item = f64>) -> f64 {
    extreme(numbers, |a, b| a > b)
}

/// The largest absolute value.
///
/// # Panics
/// Where there is none, or one is NaN.
#[must_use]
#[track_caller]
pub fn largest_size(numbers: impl IntoIterator<Item = f64>) -> f64 {
    extreme(numbers.into_iter().map(f64::abs), |a, b| a > b)
}

/// The smallest number.
///
/// # Panics
/// Where there is none, or one is NaN.
#[must_use]
#[track_caller]
pub fn least(numbers: impl IntoIterator<Item = f64>) -> f64 {
    extreme(numbers, |a, b| a < b)
}

#[track_caller]
fn extreme(numbers: impl IntoIterator<Item = f64>, beyond: fn(f64, f64) -> bool) -> f64 {
    let mut found = None;
    for (i, x) in numbers.into_iter().enumerate() {
        assert!(!x.is_nan(), "number {} is NaN", i + 1);
        if found.is_none_or(|y| beyond(x, y)) {
            found = Some(x);
        }
    }
    match found {
        Some(x) => x,
        None => panic!("the largest or smallest of no numbers"),
    }
}

/// The largest entry of a matrix, for tests.
pub trait LargestEntry {
    /// Largest absolute value of an entry, 0 for a matrix without entries.
    ///
    /// # Panics
    /// Where an entry is NaN: `amax` would go on with the entry after it.
    #[must_use]
    fn largest_entry(&self) -> f64;
}

impl<R: Dim, C: Dim, S: RawStorage<f64, R, C>> LargestEntry for Matrix<f64, R, C, S> {
    #[track_caller]
    fn largest_entry(&self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        largest_size(self.iter().copied())
    }
}
