//! Buffers of the kernels, kept from call to call: only the first call allocates them.

use std::any::Any;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

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
