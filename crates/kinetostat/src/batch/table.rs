//! Results of many postures, laid out as the kernels write them, and buffers that the kernels keep from call to call.

use std::any::Any;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use crate::model::mechanism::Mechanism;

/// Postures that lie side by side.
pub(crate) const BLOCK: usize = 8;

/// A row of numbers for each of many postures, as a structure of arrays in blocks of eight: the
/// numbers of eight postures lie side by side, so that a vector register is stored at once.
///
/// The numbers begin at a cache line, because a store of a register of eight numbers (AVX-512) touches two lines
/// anywhere else.
#[derive(Clone, Debug, Default)]
pub struct Table {
    width: usize,
    count: usize,
    /// The numbers, after those that fill up a cache line.
    padded: Vec<f64>,
    start: usize,
}

/// Bytes of a cache line, and of the widest register.
const LINE: usize = 64;

/// Numbers of each posture, `width` of them, as in a [`Table`].
#[derive(Clone, Copy)]
pub(crate) struct Columns<'a> {
    pub numbers: &'a [f64],
    pub width: usize,
}

impl Columns<'_> {
    /// Drops the first postures, which are whole blocks.
    pub fn from(self, first: usize) -> Self {
        Self {
            numbers: &self.numbers[first * self.width..],
            width: self.width,
        }
    }
}

impl PartialEq for Table {
    fn eq(&self, other: &Self) -> bool {
        (self.width, self.count) == (other.width, other.count)
            && (0..self.count).all(|i| self.row(i).eq(other.row(i)))
    }
}

impl Table {
    /// Makes room for `count` rows of `width` numbers; old numbers stay until they are written over.
    pub(crate) fn reset(&mut self, width: usize, count: usize) {
        (self.width, self.count) = (width, count);
        let numbers = count.div_ceil(BLOCK) * width * BLOCK;
        if self.padded.len() == self.start + numbers {
            return;
        }
        let most = LINE / size_of::<f64>() - 1;
        self.padded.resize(numbers + most, 0.0);
        self.start = self.padded.as_ptr().align_offset(LINE).min(most);
        self.padded.truncate(self.start + numbers);
    }

    /// Table of so many rows without numbers.
    pub(crate) fn none(count: usize) -> Self {
        Self {
            count,
            ..Self::default()
        }
    }

    /// Numbers per posture.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of postures.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// True without postures.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// One number of one posture.
    ///
    /// # Panics
    /// If either index is out of range, as for a slice.
    #[must_use]
    pub fn get(&self, posture: usize, number: usize) -> f64 {
        assert!(posture < self.count && number < self.width, "out of range");
        self.data()[self.place(posture, number)]
    }

    /// The numbers of one posture.
    ///
    /// # Panics
    /// If the index is out of range, as for a slice.
    pub fn row(&self, posture: usize) -> impl Iterator<Item = f64> + '_ {
        (0..self.width).map(move |k| self.get(posture, k))
    }

    /// All numbers: number `k` of posture `i` is at `(i / 8) * 8 * width + 8 * k + i % 8`; the last
    /// block is filled up with numbers that mean nothing.
    #[must_use]
    pub fn data(&self) -> &[f64] {
        &self.padded[self.start..]
    }

    fn data_mut(&mut self) -> &mut [f64] {
        &mut self.padded[self.start..]
    }

    pub(crate) fn columns(&self) -> Columns<'_> {
        Columns {
            numbers: self.data(),
            width: self.width,
        }
    }

    /// True if a command in this row lies outside its actuator's limits.
    pub(crate) fn outside_limits(&self, mechanism: &Mechanism, posture: usize) -> bool {
        let limbs = mechanism.limbs().iter();
        let mut own = limbs
            .flat_map(|l| l.nominal.actuators())
            .zip(self.row(posture));
        own.any(|(actuator, command)| {
            let limits = actuator.limits;
            limits.is_some_and(|(low, high)| command < low || command > high)
        })
    }

    fn place(&self, posture: usize, number: usize) -> usize {
        (posture / BLOCK) * BLOCK * self.width + BLOCK * number + posture % BLOCK
    }

    /// Sets column `k` of one posture to `number(k)`.
    pub(crate) fn set_row(&mut self, posture: usize, number: impl Fn(usize) -> f64) {
        for k in 0..self.width {
            let at = self.place(posture, k);
            self.data_mut()[at] = number(k);
        }
    }

    /// The numbers in parts of so many blocks each; a table without columns has as many, all empty.
    pub(crate) fn parts(&mut self, blocks: usize) -> impl Iterator<Item = &mut [f64]> {
        let each = self.width * BLOCK * blocks;
        let parts = self.count.div_ceil(BLOCK * blocks);
        let mut rest = self.data_mut();
        (0..parts).map(move |_| {
            let end = each.min(rest.len());
            let (part, after) = std::mem::take(&mut rest).split_at_mut(end);
            rest = after;
            part
        })
    }
}

/// Buffers that are not in use, of whatever kind and for whatever instruction set.
///
/// Nothing is found in them that an answer depends on: each group of postures writes over what it reads.
#[derive(Default)]
pub(crate) struct Buffers(Arc<Mutex<Vec<Box<dyn Any + Send>>>>);

impl Buffers {
    /// Shares the buffers with a machine that differs in numbers.
    pub fn shared(&self) -> Self {
        Self(Arc::clone(&self.0))
    }

    /// Takes buffers of a kind, or makes them.
    pub fn take<T: Send + 'static>(&self, make: impl FnOnce() -> T) -> Box<T> {
        self.take_fitting(|_| true, make)
    }

    /// Takes buffers of a kind that fit, or makes them.
    pub fn take_fitting<T: Send + 'static>(
        &self,
        fits: impl Fn(&T) -> bool,
        make: impl FnOnce() -> T,
    ) -> Box<T> {
        let mut free = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let fitting = |kept: &Box<dyn Any + Send>| kept.downcast_ref().is_some_and(&fits);
        let own = free.iter().rposition(fitting);
        let own = own.map(|k| free.swap_remove(k).downcast::<T>());
        drop(free);
        match own {
            Some(Ok(buffers)) => buffers,
            _ => Box::new(make()),
        }
    }

    /// Gives buffers back.
    pub fn put<T: Send + 'static>(&self, buffers: Box<T>) {
        let mut free = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        free.push(buffers);
    }
}

impl Clone for Buffers {
    /// A copy of a machine makes its own.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl fmt::Debug for Buffers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Buffers")
    }
}
