//! Links in segments, straight: the loads at which columns buckle, by the convention and the number of segments.
//!
//! Closed forms: Euler's columns. The table of conventions is that of `LinkConvention`'s module.

use crate::common::close;
use crate::links_that_bend::{flat, general, link, solve};
use LinkConvention::{
    Bowing, ConstantStrain, Exponential, Middle, RotationsFirst, TranslationsFirst,
};
use kinetostat::{
    Chain, ChainBuilder, ChainProblem, EndCondition, Equilibrium, LinkSpec, MotionKind, Pose,
    model::LinkConvention,
};
use nalgebra::Vector3;
use std::f64::consts::PI;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Support {
    Clamped,
    Pinned,
    Free,
}

pub use Support::{Clamped, Free, Pinned};

/// A column along x between a clamped or pinned root and a clamped, pinned or free end.
pub fn column(root: Support, spec: &LinkSpec, end: Support) -> Chain {
    let hinge =
        |b: ChainBuilder, name: &str| b.passive(name, MotionKind::Revolute, Vector3::z(), 0.0);
    let mut b = Chain::builder("column");
    if root == Pinned {
        b = hinge(b, "root");
    }
    b = b.link_with("column", spec);
    if end != Clamped {
        b = hinge(b, "end");
    }
    if end == Free {
        b = b.passive("side", MotionKind::Prismatic, Vector3::y(), 0.0);
    }
    b.build().unwrap()
}

/// The straight column under an axial force (compression < 0).
fn straight(chain: &Chain, force: f64) -> Equilibrium {
    let end = Pose::translation(1.0 + force / flat().area, 0.0, 0.0);
    let e = solve(&ChainProblem::new(chain, EndCondition::pose(end)));
    close("axial", e.wrench.0[0], force, 1e-6 * force.abs());
    e
}

/// Stability by the inertia of the bordered matrix (Sylvester's law), which needs no assumption
/// about the springs: as many positive eigenvalues as the end has directions.
pub fn holds(chain: &Chain, force: f64) -> bool {
    straight(chain, force).stability.inertia.positive == 6
}

/// Smallest load at which the shape fails, in Euler loads; `sign` is -1 for compression, +1 for
/// tension. `None`: none up to 100. An eigenvalue counts as zero within a small band: the load is
/// the middle of it.
pub fn critical(chain: &Chain, sign: f64) -> Option<f64> {
    let inertia = |load: f64| straight(chain, sign * load * PI * PI).stability.inertia;
    let mut beyond = 0.05;
    while inertia(beyond).positive == 6 {
        beyond *= 1.05;
        if beyond > 100.0 {
            return None;
        }
    }
    let edge = |inside: &dyn Fn(f64) -> bool| {
        let (mut low, mut high) = (beyond / 1.1, beyond);
        while high - low > 1e-9 * high {
            let middle = 0.5 * (low + high);
            if inside(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    };
    let first = edge(&|load| inertia(load).positive == 6 && inertia(load).zero == 0);
    let last = edge(&|load| inertia(load).positive == 6);
    Some(0.5 * (first + last))
}

/// A critical load in Euler loads (`None`: none), found and expected, with the half of its last digit.
pub struct Critical {
    pub label: String,
    pub found: Option<f64>,
    pub expected: Option<f64>,
    pub digit: f64,
}

/// The table of the book (governing equations, links that bend), to its digits (there, as here, EA / EI = 1e6 / m^2:
/// the limit of an inextensible column is 1.98548 where 1.986 stands, 1.00003 where 1.00004 stands).
pub fn table_of_conventions() -> Vec<Critical> {
    type Row = (
        LinkConvention,
        [Option<f64>; 4],
        [f64; 4],
        [Option<f64>; 3],
        [f64; 3],
    );
    let some = |v: [f64; 4]| v.map(Some);
    let pulled = |v: [f64; 3]| v.map(Some);
    let three = [5e-4; 4];
    let table: [Row; 6] = [
        (
            TranslationsFirst,
            [None, Some(1.986), Some(1.233), Some(1.053)],
            three,
            pulled([0.304, 1.22, 4.86]),
            [5e-4, 5e-3, 5e-3],
        ),
        (
            RotationsFirst,
            some([0.131, 0.390, 0.714, 0.908]),
            three,
            pulled([0.94, 3.8, 15.0]),
            [5e-3, 0.05, 0.5],
        ),
        (
            Middle,
            some([0.334, 0.708, 0.907, 0.975]),
            [5.1e-4, 5e-4, 5e-4, 5e-4],
            pulled([0.74, 3.0, 12.0]),
            [5e-3, 0.05, 0.5],
        ),
        (
            Exponential,
            some([0.405, 0.752, 0.913, 0.975]),
            three,
            pulled([1.2, 4.9, 19.0]),
            [0.05, 0.05, 0.5],
        ),
        (
            ConstantStrain,
            some([1.216, 1.216, 1.052, 1.013]),
            three,
            [None; 3],
            [0.0; 3],
        ),
        (
            Bowing,
            some([1.216, 1.0075, 1.0005, 1.00004]),
            [5e-4, 5e-5, 5e-5, 5e-6],
            [None; 3],
            [0.0; 3],
        ),
    ];
    let mut all = Vec::new();
    for (convention, pushed, digits, pulled, digits_pulled) in table {
        let mut row = |n, sign, expected, digit| {
            all.push(Critical {
                label: format!("{convention:?}, {n} segments, sign {sign}"),
                found: critical(&column(Pinned, &link(n, convention), Pinned), sign),
                expected,
                digit,
            });
        };
        for (k, n) in [1, 2, 4, 8].into_iter().enumerate() {
            row(n, -1.0, pushed[k], digits[k]);
        }
        for (k, n) in [1, 2, 4].into_iter().enumerate() {
            row(n, 1.0, pulled[k], digits_pulled[k]);
        }
    }
    all
}

#[test]
fn pinned_columns_buckle_as_in_the_table_of_conventions() {
    for c in table_of_conventions() {
        check(&c.label, c.found, c.expected, c.digit);
    }
}

#[track_caller]
fn check(label: &str, found: Option<f64>, expected: Option<f64>, tolerance: f64) {
    match (found, expected) {
        (Some(a), Some(b)) => close(label, a, b, tolerance),
        (Some(a), None) => panic!("{label}: buckles at {a}, should not"),
        (None, Some(b)) => panic!("{label}: never buckles, should at {b}"),
        (None, None) => {}
    }
}

/// Supports and critical load in Euler loads. Clamped-pinned: tan(x) = x at x = 4.493409457909.
pub fn euler_cases() -> [(Support, Support, f64); 4] {
    [
        (Pinned, Pinned, 1.0),
        (Clamped, Free, 0.25),
        (Clamped, Clamped, 4.0),
        (Clamped, Pinned, (4.493_409_457_909_f64 / PI).powi(2)),
    ]
}

#[test]
fn eulers_columns_buckle_within_a_thousandth_at_8_segments_and_never_in_tension() {
    for (root, end, exact) in euler_cases() {
        for n in [1, 2, 4, 8] {
            let chain = column(root, &link(n, Bowing), end);
            let label = format!("{root:?} {end:?} {n}");
            for load in [0.5, 5.0, 20.0, 100.0] {
                assert!(
                    holds(&chain, load * PI * PI),
                    "{label}: fails in tension at {load}"
                );
            }
            if n == 8 {
                let found = critical(&chain, -1.0).unwrap();
                close(&label, found / exact, 1.0, 1e-3);
            }
        }
    }
}

#[test]
fn a_column_in_space_buckles_in_its_softer_plane() {
    let section = general();
    let length = 0.7;
    let spec = LinkSpec::beam(section, length).segments(8);
    let chain = Chain::builder("strut")
        .passive_universal("root", Vector3::y(), Vector3::z())
        .link_with("strut", &spec)
        .passive_universal("end", Vector3::z(), Vector3::y())
        .build()
        .unwrap();
    let softer = section.youngs_modulus * section.second_moment_y;
    let euler = PI * PI * softer / (length * length);
    for (share, holds) in [(0.99, true), (1.01, false)] {
        let push = share * euler;
        let shorter = push / (section.youngs_modulus * section.area);
        let end = Pose::translation(length * (1.0 - shorter), 0.0, 0.0);
        let e = solve(&ChainProblem::new(&chain, EndCondition::pose(end)));
        assert_eq!(e.stability.inertia.positive == 6, holds, "{share}");
        let loads = e.link_loads(&chain);
        assert_eq!(loads.len(), 1);
        assert_eq!(loads[0].link, "strut");
        close("axial force", loads[0].axial_force, -push, 1e-6 * push);
        close("Euler load", loads[0].euler_load, euler, 1e-9 * euler);
        close("share", loads[0].share, share, 1e-6);
        let most = e.stability.mode.iter().enumerate();
        let most = most.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).unwrap();
        assert!(
            chain.coordinates()[most.0].name.ends_with('2')
                || chain.coordinates()[most.0].name.ends_with('1')
        );
    }
}

/// One segment beyond its own buckling load included.
#[test]
fn share_to_buckling_and_inertia_agree_for_every_convention() {
    for convention in [
        TranslationsFirst,
        RotationsFirst,
        Middle,
        Exponential,
        Bowing,
    ] {
        for n in [1, 2, 8] {
            let chain = column(Pinned, &link(n, convention), Pinned);
            for load in [-3.1, -1.3, -1.15, -0.9, -0.3, 0.5, 3.0, 20.0] {
                let s = straight(&chain, load * PI * PI).stability;
                let label = format!("{convention:?} {n} {load}");
                assert_eq!(s.stable, s.inertia.positive == 6, "{label}");
            }
        }
    }
}
