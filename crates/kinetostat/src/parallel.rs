//! Work on all threads, or on one without the feature `parallel`.

#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// Maps the items in parallel, in their order.
#[cfg(feature = "parallel")]
pub(crate) fn map<I: Send, T: Send>(
    items: Vec<I>,
    answer: impl Fn(I) -> T + Send + Sync,
) -> Vec<T> {
    items.into_par_iter().map(answer).collect()
}

/// Maps the items one after the other, in their order.
#[cfg(not(feature = "parallel"))]
pub(crate) fn map<I, T>(items: Vec<I>, answer: impl Fn(I) -> T) -> Vec<T> {
    items.into_iter().map(answer).collect()
}
