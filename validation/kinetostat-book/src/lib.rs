//! The examples of the book, as tests.
//!
//! Every Rust block of every chapter is a documentation test of this crate, so the book cannot say
//! what the library does not do. The shell examples run in `kinetostat-cli/tests/cli/book.rs`. Here are
//! also the [chains of the report](chains) that several chapters use.

pub mod chains;

/// Two numbers agree within a tolerance.
///
/// # Panics
/// They do not: an example of the book is wrong.
#[track_caller]
pub fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected} within {tolerance}"
    );
}

/// The chapters. Only the documentation tests see them.
#[cfg(doctest)]
mod chapters {
    macro_rules! chapters {
        ($($name:ident: $file:literal,)*) => {
            $(
                #[doc = include_str!(concat!("../../../book/src/", $file))]
                pub mod $name {}
            )*
        };
    }

    chapters! {
        introduction: "introduction.md",
        conventions: "conventions.md",
        first_chain: "tutorials/first-chain.md",
        buckling: "tutorials/buckling.md",
        assembly: "tutorials/assembly.md",
        milling: "tutorials/milling.md",
        reproduce: "tutorials/reproduce.md",
        machines_library: "machines/library.md",
        machines_urdf: "machines/urdf.md",
        machines_links: "machines/links.md",
        machines_parallel: "machines/parallel.md",
        machines_singular: "machines/singular.md",
        theory_map: "theory-map.md",
        equations: "equations.md",
        errata: "errata/errata.md",
        errata_stiffness: "errata/stiffness.md",
        errata_loads: "errata/loads.md",
        errata_stability: "errata/stability.md",
        errata_machines: "errata/machines.md",
        cost: "cost.md",
    }
}
