//! Work on all threads, or on one without the feature `parallel`.

#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// What `question` answers of each item, in their order.
#[cfg(feature = "parallel")]
pub(crate) fn map<I: Send, T: Send>(
    items: Vec<I>,
    question: impl Fn(I) -> T + Send + Sync,
) -> Vec<T> {
    items.into_par_iter().map(question).collect()
}

/// What `question` answers of each item, in their order.
#[cfg(not(feature = "parallel"))]
pub(crate) fn map<I, T>(items: Vec<I>, question: impl Fn(I) -> T) -> Vec<T> {
    items.into_iter().map(question).collect()
}
