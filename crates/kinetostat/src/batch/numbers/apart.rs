//! Calls between the parts of a kernel.
//!
//! What a kernel calls must be inlined, for a function by itself does not know the instruction set. Inlined
//! everywhere a kernel became one function of half a megabyte, for every instruction set, and compiling it
//! took six minutes. [`apart!`] makes a function of its own for the instruction set at hand, compiled once
//! and called from wherever it is used.

use pulp::{Simd, WithSimd};

use crate::batch::numbers::instruction_set::singly;

struct Part<F>(F);

impl<F: FnOnce() -> R, R> WithSimd for Part<F> {
    type Output = R;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> R {
        (self.0)()
    }
}

/// `apart!(simd, { body })`: the body of a kernel's function, compiled once for every instruction set and
/// called from wherever the function is used. A `return` in it ends the body.
macro_rules! apart {
    ($simd:expr, $body:block) => {
        $crate::batch::numbers::apart::call(
            $simd,
            #[inline(always)]
            || $body,
        )
    };
}
pub(crate) use apart;

/// Calls a part of a kernel in a function of its own.
#[inline(always)]
pub(crate) fn call<S: Simd, R>(simd: S, part: impl FnOnce() -> R) -> R {
    // Single numbers do not tell whether the fused multiply-adds of a wide instruction set are there.
    if S::F64_LANES == 1 {
        return singly(Part(part));
    }
    simd.vectorize(Part(part))
}
