//! The report's iteration and exact Newton (the book, governing equations), and frames that snap.

use super::{Figures, Worst};
use crate::euler_angles::compared;
use crate::frames_that_snap::{
    POUND, apart, lee_settings, lees_frame, limits_by_shooting, limits_of_chain, williams_settings,
    williams_toggle,
};
use crate::report_iteration::{quadratic, spatial_runs, steps_to, table};
use kinetostat::reference::IterationOutcome;

#[test]
fn the_report_s_own_iteration() {
    let mut f = Figures::new();
    for m in table() {
        let name = format!("Report's iteration, {}", m.row.name);
        let [mut mu, mut rate] = [(); 2].map(|()| Worst::new());
        let (mut cycles, mut left, mut converged, mut newton) = (0, 0, 0, vec![]);
        for (report, exact) in m.report.iter().zip(&m.newton) {
            mu.apart(report.rate_at_start.unwrap_or(f64::NAN), m.row.mu);
            match &report.outcome {
                IterationOutcome::Converged => converged += 1,
                IterationOutcome::Leaves => left += 1,
                IterationOutcome::Cycle(_) => cycles += 1,
                _ => {}
            }
            if let (Some(expected), Some(found)) = (m.row.rate, report.observed_rate) {
                rate.apart(found, expected);
            }
            newton.push(steps_to(&exact.path, &m.exact).unwrap_or(usize::MAX));
        }
        f.at_most(
            &format!("{name}: max |mu|"),
            &mu,
            5.1e-6,
            "(table's digits)",
        );
        let of = format!("of {} starts 0.02 rad off", m.report.len());
        match m.row.rate {
            Some(_) => {
                f.at_most(
                    &format!("{name}: observed rate"),
                    &rate,
                    5.1e-5,
                    "(table's digits)",
                );
                f.at_least(&format!("{name}: settles"), converged, m.report.len(), &of);
            }
            None if m.row.mu > 1.0 && m.row.force > 0.0 => {
                f.at_least(
                    &format!("{name}: cycle of period 2 named"),
                    cycles,
                    m.report.len(),
                    &of,
                );
            }
            None => {
                f.at_least(
                    &format!("{name}: leaves for the stable shape"),
                    left,
                    m.report.len(),
                    &of,
                );
            }
        }
        let mut most = Worst::new();
        most.add(newton.into_iter().max().map_or(f64::NAN, |n| n as f64));
        f.at_most(
            &format!("{name}: Newton steps to 1e-10 rad"),
            &most,
            m.row.newton_steps as f64,
            "steps",
        );
    }
    f.finish();
}

#[test]
fn newton_under_end_moments() {
    let mut f = Figures::new();
    let [mut last, mut rule, mut rate, mut constant] = [(); 4].map(|()| Worst::new());
    let mut least = f64::INFINITY;
    let runs = spatial_runs();
    for run in &runs {
        let (c, e) = quadratic(&run.newton_errors);
        last.add(e);
        constant.add(c);
        rule.add(run.rule);
        rate.apart(run.report.expected_rate.unwrap_or(f64::NAN), run.mu);
        least = least.min(run.asymmetry);
    }
    let name = "Spatial chains with end moments";
    f.at_least(&format!("{name}: chains"), runs.len(), 8, "of 60 seeds");
    f.at_most(
        &format!("{name}: last error of exact Newton"),
        &last,
        1e-12,
        "rad, m",
    );
    f.at_most(
        &format!("{name}: error over square of the one before"),
        &constant,
        20.0,
        "1/rad (test's)",
    );
    f.at_most(
        &format!("{name}: H_ij - H_ji - m.(w_j x w_i)"),
        &rule,
        1e-12,
        "share of H",
    );
    f.at_most(
        &format!("{name}: max |mu| against the oracle"),
        &rate,
        1e-7,
        "(test's tolerance)",
    );
    let mut symmetric = Worst::new();
    symmetric.add(1.0 / least);
    f.at_most(
        &format!("{name}: inverse of the least asymmetry of H"),
        &symmetric,
        1e4,
        "H over |H - H^T|",
    );
    f.finish();
}

#[test]
fn frames_that_snap() {
    let mut f = Figures::new();
    let mut put = |name: &str, found: f64, expected: f64, most: f64, unit: &str| {
        let mut worst = Worst::new();
        worst.apart(found, expected);
        f.at_most(name, &worst, most, unit);
    };
    let frame = lees_frame();
    let (exact, chain) = (
        limits_by_shooting(&frame, 0.75),
        limits_of_chain(&frame, 2, &lee_settings()),
    );
    let off = apart(&chain, &exact);
    let lee = "Lee's frame, 20 segments";
    put(
        &format!("{lee}: first limit load minus the published 1.855 kN (1.85 to 1.86)"),
        chain[0].0 / 1e3,
        1.855,
        0.005,
        "kN",
    );
    put(
        &format!(
            "{lee}: first limit load against the elastica {:.2} N",
            exact[0].0
        ),
        off[0].0,
        0.0,
        5e-5,
        "share (test's tolerance)",
    );
    put(
        &format!(
            "{lee}: second limit load against the elastica {:.2} N",
            exact[1].0
        ),
        off[1].0,
        0.0,
        2e-3,
        "share of the first (test's tolerance)",
    );
    let frame = williams_toggle(0.386);
    let exact = limits_by_shooting(&frame, 0.6 * crate::frames_that_snap::INCH);
    let chain = limits_of_chain(&frame, 4, &williams_settings());
    let off = apart(&chain, &exact);
    let toggle = "Williams' toggle, 16 segments";
    put(
        &format!("{toggle}: limit load minus the published 34 lb"),
        chain[0].0 / POUND,
        34.0,
        0.5,
        "lb",
    );
    put(
        &format!(
            "{toggle}: limit load against the elastica {:.3} lb",
            exact[0].0 / POUND
        ),
        off[0].0,
        0.0,
        1e-4,
        "share (test's tolerance)",
    );
    put(
        &format!(
            "{toggle}: second limit load against the elastica {:.3} lb",
            exact[1].0 / POUND
        ),
        off[1].0,
        0.0,
        1e-4,
        "share of the first (test's tolerance)",
    );
    f.finish();
}

#[test]
fn spatial_and_euler_versions() {
    let mut f = Figures::new();
    let [mut h, mut k, mut again] = [(); 3].map(|()| Worst::new());
    let (mut h_without, mut k_without) = (Worst::new(), Worst::new());
    let list = compared();
    for c in &list {
        h.add(c.hessian);
        k.add(c.stiffness);
        again.add(c.solved_again);
        // The least of them, as what it is times smaller than the whole.
        h_without.add(1.0 / c.hessian_without);
        k_without.add(1.0 / c.stiffness_without.0);
    }
    let name = "Euler-angle version, spatial chains with end moments";
    f.at_least(&format!("{name}: chains"), list.len(), 4, "of 40 seeds");
    let unit = "share (test's tolerance)";
    let rule = "H - (H_Euler + J_E^T D J_E)";
    f.at_most(&format!("{name}: {rule}"), &h, 1e-9, unit);
    let rule = "K - B^-T (K_Euler - D) B^-1";
    f.at_most(&format!("{name}: {rule}"), &k, 1e-9, unit);
    f.at_most(
        &format!("{name}: {rule}, K_Euler by re-solved wrenches"),
        &again,
        1e-8,
        unit,
    );
    let unit = "H over what is missing";
    f.at_most(
        &format!("{name}: H without D is off by at least 1 %"),
        &h_without,
        100.0,
        unit,
    );
    let unit = "K over what is missing";
    f.at_most(
        &format!("{name}: K without D is off by at least 1 %"),
        &k_without,
        100.0,
        unit,
    );
    f.finish();
}
