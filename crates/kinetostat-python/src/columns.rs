//! Columns of numbers, filled block by block by all threads away from the interpreter.

use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays::reserve;
use crate::work::{Course, Manner, away};

/// Postures that a thread takes at a time.
const BLOCK: usize = 256;

/// Postures that are solved on the calling thread: to hand them over takes longer.
const FEW: usize = 64;

/// The first row of a block, its part of each column, and of the states.
type Rows<'a> = (usize, Vec<&'a mut [f64]>, &'a mut [u8]);

/// Columns of many rows, each with its own width, written block by block by all threads.
pub(crate) struct Columns {
    widths: Vec<usize>,
    pub(crate) numbers: Vec<Vec<f64>>,
    pub(crate) status: Vec<u8>,
}

impl Columns {
    /// Zeros.
    ///
    /// # Errors
    /// `MemoryError`.
    pub(crate) fn new(count: usize, widths: &[usize]) -> PyResult<Self> {
        reserve(count, size_of::<f64>() * widths.iter().sum::<usize>() + 1)?;
        Ok(Self {
            widths: widths.to_vec(),
            numbers: widths.iter().map(|w| vec![0.0; count * w]).collect(),
            status: vec![0; count],
        })
    }

    fn blocks(&mut self) -> Vec<Rows<'_>> {
        let mut parts: Vec<_> = (self.widths.iter().zip(&mut self.numbers))
            .map(|(width, numbers)| numbers.chunks_mut((BLOCK * width).max(1)))
            .collect();
        (self.status.chunks_mut(BLOCK).enumerate())
            .map(|(i, status)| {
                let own = parts.iter_mut().map(|part| part.next().unwrap_or_default());
                (BLOCK * i, own.collect(), status)
            })
            .collect()
    }

    /// Solves block after block on all threads; false where it was stopped before the end.
    pub(crate) fn fill<T: Default + Send>(
        &mut self,
        course: &Course,
        solve: impl Fn(&mut T, usize, &mut [&mut [f64]], &mut [u8]) + Sync,
    ) -> bool {
        course.of(self.status.len());
        let stopped = || course.stopped();
        let one = |room: &mut T, (first, mut columns, status): Rows<'_>| {
            // Cancelled work is not solved.
            if !stopped() {
                solve(room, first, &mut columns, status);
                course.add(status.len());
            }
        };
        if self.status.len() <= FEW {
            let mut room = T::default();
            self.blocks()
                .into_iter()
                .for_each(|block| one(&mut room, block));
        } else {
            self.blocks().into_par_iter().for_each_init(T::default, one);
        }
        !course.stopped()
    }
}

/// Does the work here if it is little, else away from the interpreter.
pub(crate) fn done<R: Send + 'static>(
    py: Python<'_>,
    count: usize,
    manner: &Manner<'_>,
    work: impl FnOnce(&Course) -> R + Send + 'static,
) -> PyResult<R> {
    // A number of threads that cannot be is refused of few postures too.
    let threads_can_be = manner.threads.is_none_or(|n| n > 0);
    if count <= FEW && manner.progress.is_none() && threads_can_be {
        return Ok(py.detach(|| work(&Course::default())));
    }
    away(py, manner, move |course| work(course))
}
