//! Processors for which the kernels are compiled, choice of the one for a call, and calls between the parts of a kernel.
//!
//! With the feature `simd` they are compiled for the widest registers that `pulp` knows of a processor (AVX-512 or
//! AVX2, NEON), for AVX2 and for single numbers. A build with debug assertions has no AVX-512, and no fused
//! multiply-adds for single numbers: each of them is the whole of the kernels compiled once more. The bits of an
//! answer are the same in all of them. A processor of the x86 family without AVX2 (before 2013) has no kernels: the
//! general engine solves every posture there.

use std::cell::Cell;

#[cfg(all(feature = "simd", target_arch = "x86_64"))]
use pulp::x86::V3;
#[cfg(all(feature = "simd", target_arch = "x86_64", not(debug_assertions)))]
use pulp::x86::V4;
use pulp::{Scalar, Simd, WithSimd};

/// Instruction set of a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstructionSet {
    /// Single numbers.
    Single,
    /// Four numbers side by side.
    Avx2,
    /// Widest registers of this processor.
    Widest,
}

/// True if this build has more than AVX2 and single numbers.
const HAS_WIDEST: bool = cfg!(all(
    feature = "simd",
    any(not(debug_assertions), not(target_arch = "x86_64"))
));

thread_local! {
    /// The one that a test has chosen for its thread.
    static CHOSEN: Cell<Option<InstructionSet>> = const { Cell::new(None) };
}

impl InstructionSet {
    /// Instruction sets that this build has and this processor supports.
    #[must_use]
    pub fn available() -> Vec<Self> {
        let all = [
            (Self::Single, true),
            (Self::Avx2, has_avx2()),
            (Self::Widest, HAS_WIDEST),
        ];
        all.into_iter()
            .filter_map(|(set, has)| has.then_some(set))
            .collect()
    }

    /// Answers a question while this thread computes with this instruction set.
    pub fn during<R>(self, question: impl FnOnce() -> R) -> R {
        let before = CHOSEN.replace(Some(self));
        let answer = question();
        CHOSEN.set(before);
        answer
    }

    /// The widest registers that so many postures fill at least by half: one posture costs as much in a
    /// wide register as eight.
    pub(crate) fn of(postures: usize) -> Self {
        match (CHOSEN.get(), postures) {
            (Some(chosen), _) => chosen,
            (None, 0..=1) if has_avx2() => Self::Single,
            (None, 2..=4) if has_avx2() => Self::Avx2,
            _ if HAS_WIDEST => Self::Widest,
            _ if has_avx2() => Self::Avx2,
            _ => Self::Single,
        }
    }

    pub(crate) fn run<W: WithSimd<Output = ()>>(self, work: W) {
        #[cfg(all(feature = "simd", target_arch = "x86_64"))]
        if self != Self::Single {
            #[cfg(not(debug_assertions))]
            if let (Self::Widest, Some(simd)) = (self, V4::try_new()) {
                return Simd::vectorize(simd, work);
            }
            if let Some(simd) = V3::try_new() {
                return Simd::vectorize(simd, work);
            }
        }
        #[cfg(all(feature = "simd", not(target_arch = "x86_64")))]
        if self == Self::Widest {
            return pulp::Arch::new().dispatch(work);
        }
        singly(Single(work));
    }
}

/// True if this processor supports the kernels of this build.
pub(crate) fn has_kernels() -> bool {
    !ALWAYS_FUSED || has_avx2()
}

/// True if kernels in single numbers are compiled for the fused multiply-adds of AVX2 and for nothing else. Without
/// them each is a call, which makes the kernels slower than the general engine.
const ALWAYS_FUSED: bool = cfg!(all(
    feature = "simd",
    target_arch = "x86_64",
    not(debug_assertions)
));

fn has_avx2() -> bool {
    #[cfg(all(feature = "simd", target_arch = "x86_64"))]
    return V3::try_new().is_some();
    #[cfg(not(all(feature = "simd", target_arch = "x86_64")))]
    false
}

/// Work in single numbers whatever the instruction set, so that they get its fused multiply-adds.
struct Single<W>(W);

impl<W: WithSimd> WithSimd for Single<W> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> W::Output {
        self.0.with_simd(Scalar)
    }
}

/// Runs in a function of its own, with the fused multiply-adds that the processor has.
#[cfg(all(feature = "simd", target_arch = "x86_64", not(debug_assertions)))]
#[inline(always)]
pub(crate) fn singly<W: WithSimd>(part: W) -> W::Output {
    match V3::try_new() {
        Some(simd) => Simd::vectorize(simd, part),
        None => unreachable!("no machine is compiled into kernels on this processor: has_kernels"),
    }
}

/// Runs in a function of its own, with the fused multiply-adds that the processor has.
#[cfg(not(all(feature = "simd", target_arch = "x86_64", not(debug_assertions))))]
#[inline(never)]
pub(crate) fn singly<W: WithSimd>(part: W) -> W::Output {
    part.with_simd(Scalar)
}

/// What a kernel calls must be inlined, for a function by itself does not know the instruction set. Inlined
/// everywhere a kernel became one function of half a megabyte, for every instruction set, and compiling it
/// took six minutes. [`apart!`] makes a function of its own for the instruction set at hand, compiled once
/// and called from wherever it is used.
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
        $crate::batch::numbers::instruction_set::call(
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
