//! Shapes: columns that buckle, links that bend far, limit points, all equilibria.

use super::{Figures, Worst};
use crate::all_equilibria::{compared, search};
use crate::common::planar_column;
use crate::curves_of_columns::{fork_loads, forks, pressed};
use crate::curves_of_elastic_links::{
    ELASTIC, ELASTIC_LIMITS, elastic_limit, elastic_links, elastic_problem, flat_chain,
};
use crate::links_that_bend::{bend, bend_by_shooting, elastica, link, rolled_up};
use crate::straight_links_buckle::{column, critical, euler_cases, holds, table_of_conventions};
use kinetostat::{equilibrium::SearchSettings, model::LinkConvention};
use std::f64::consts::PI;

#[test]
fn columns_of_rigid_links() {
    let mut f = Figures::new();
    let mut worst = Worst::new();
    for n in 2..=6 {
        let chain = planar_column(n, 1.0, 1.0);
        let found = forks(&pressed(&chain, n as f64), 5.0);
        let expected = fork_loads(n);
        worst.add(found.len() as f64 - expected.len() as f64);
        for (found, expected) in found.iter().zip(&expected) {
            worst.add(found / expected - 1.0);
        }
    }
    f.at_most(
        "Straight columns of 2 to 6 links: all forks at 2(1 - cos(k pi/n))",
        &worst,
        1e-8,
        "relative",
    );
    f.finish();
}

#[test]
fn columns_that_bend() {
    let mut f = Figures::new();
    let (mut worst, mut pulled) = (Worst::new(), Vec::new());
    for (root, end, exact) in euler_cases() {
        let chain = column(root, &link(8, LinkConvention::Bowing), end);
        let found = critical(&chain, -1.0).unwrap_or(f64::NAN);
        worst.add(found / exact - 1.0);
        for load in [0.5, 5.0, 20.0, 100.0] {
            pulled.push(usize::from(!holds(&chain, load * PI * PI)));
        }
    }
    let name = "Euler columns, 8 segments of the default link: critical loads";
    f.at_most(name, &worst, 1e-3, "relative");
    f.exactly(
        "Euler columns: failures in tension up to 100 Euler loads",
        &pulled,
        0,
        "in every case",
    );
    let (mut digits, mut odd) = (Worst::new(), Vec::new());
    for c in table_of_conventions() {
        match (c.found, c.expected) {
            (Some(found), Some(expected)) => digits.add((found - expected) / c.digit),
            (found, expected) => odd.push(usize::from(found.is_some() != expected.is_some())),
        }
    }
    f.at_most(
        "Critical loads of every convention, by the equations of the book (links that bend)",
        &digits,
        1.02,
        "half of the last digit there",
    );
    f.exactly(
        "Conventions that never buckle where they should, or the reverse",
        &odd,
        0,
        "in every case",
    );
    f.finish();
}

#[test]
fn links_that_bend_far() {
    let mut f = Figures::new();
    let one = |value: f64| {
        let mut w = Worst::new();
        w.add(value);
        w
    };
    f.at_most(
        "Elastica, P L^2/EI = 10, 32 segments: deflection of the tip against 0.810609024880",
        &one(elastica(32, LinkConvention::Bowing)),
        1e-4,
        "of the length",
    );
    let (_, e) = rolled_up(32, LinkConvention::Bowing);
    let angle: f64 = e.coordinates.iter().skip(5).step_by(6).sum();
    f.at_most(
        "Roll-up to a full circle: the tip comes back to the root",
        &one(e.tip.translation.vector.norm()),
        1e-9,
        "of the length",
    );
    f.at_most(
        "Roll-up to a full circle: angle",
        &one(angle - 2.0 * PI),
        1e-9,
        "rad",
    );
    let (mut own, mut published) = (Worst::new(), Worst::new());
    for (load, simo) in [
        (300.0, [58.84, 22.33, 40.08]),
        (600.0, [47.23, 15.79, 53.37]),
    ] {
        let end = bend(load, 32);
        own.add((end - bend_by_shooting(load)).norm());
        for k in 0..3 {
            published.apart(end[k], simo[k]);
        }
    }
    f.at_most(
        "45-degree bend, 32 links, against shooting",
        &own,
        0.004,
        "in (radius 100 in)",
    );
    f.at_most(
        "45-degree bend, 32 links, against Simo and Vu-Quoc (8 elements)",
        &published,
        0.12,
        "in (radius 100 in)",
    );
    f.finish();
}

#[test]
fn limit_points_of_two_elastic_links() {
    let mut f = Figures::new();
    let (mut places, mut forces) = (Worst::new(), Worst::new());
    for (g, x, dx, y, force) in ELASTIC_LIMITS {
        let found = elastic_limit(g, y);
        for (found, expected) in found.into_iter().zip([x, dx, y]) {
            places.apart(found, expected);
        }
        forces.apart(found[3], force);
    }
    f.at_most("Limit points of 4.6.2: places", &places, 1e-8, "m");
    f.at_most("Limit points of 4.6.2: forces", &forces, 1e-8, "N");
    let [fork, _, limit, _] = flat_chain();
    let mut flat = Worst::new();
    flat.apart(fork, 1.979795897113);
    flat.apart(limit, 1.979795897113);
    let name =
        "Flat chain of 4.6.2: fork (no preload) and limit point (preload) at x 1.979795897113";
    f.at_most(name, &flat, 1e-8, "m");
    f.finish();
}

#[test]
fn all_equilibria() {
    let mut f = Figures::new();
    let chain = elastic_links(15_f64.to_radians());
    let (mut found, mut force) = (0, Worst::new());
    for g in [0.0, 0.5, 1.0, 1.5, 2.0] {
        for dx in [-0.05, 0.0, 0.05] {
            let problem = elastic_problem(&chain, g, dx);
            let all = search("4.6.2", &problem, &SearchSettings::default());
            found += all.found.len();
            for row in ELASTIC.iter().filter(|r| r.0 == g && r.1 == dx) {
                let near = |e: &f64| (e - row.3).abs();
                let nearest = all.found.iter().map(|x| x.equilibrium.wrench.0[0]);
                let nearest = nearest.min_by(|a, b| near(a).total_cmp(&near(b)));
                force.add((nearest.unwrap_or(f64::NAN) - row.3) / row.3.abs().max(0.1));
            }
        }
    }
    f.exactly(
        "All equilibria of 4.6.2 in 15 cases",
        &[found],
        ELASTIC.len(),
        "as many as the reference",
    );
    f.at_most("All equilibria of 4.6.2: forces", &force, 6e-8, "relative");
    for (links, seeds, steps) in [(4, 1..4, 12), (6, 8..9, 7)] {
        let mut lost = Vec::new();
        for seed in seeds {
            let (found, expected, matched, _) = compared(links, seed, steps);
            lost.push(found.abs_diff(expected) + expected - matched);
        }
        let name = format!("Random chain of {links} links: shapes missed or too many");
        f.exactly(&name, &lost, 0, "against an exhaustive search");
    }
    f.finish();
}
