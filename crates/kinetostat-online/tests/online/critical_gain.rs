//! Critical gains against an independent computation: eigenvalues of the loop's state matrix by numpy.
//!
//! Source: online.md section 4, table of `loop_sim.py table` (run with numpy and scipy; all digits that its bisection gives to 1e-6).

use kinetostat_online::SampledLoop;
use kinetostat_testing::Worst;

const KAPPAS: [f64; 6] = [0.05, 0.2, 0.5, 1.0, 3.0, 10.0];

type Row = (f64, f64, f64, u32, f64, u32, bool, [f64; 6]);

/// Mode (Hz), damping, lag (s), delay (cycles), cutoff (Hz), order, notch; critical gains by kappa.
#[rustfmt::skip]
const TABLE: [Row; 12] = [
    // rigid structure, lag 20 ms, delay 4, fc 100 Hz
    (2000.0, 0.7, 0.02, 4, 100.0, 1, false, [21.000000, 6.000000, 3.000000, 2.000000, 1.333333, 1.100000]),
    // mode 12 Hz zeta .04, fc 30 Hz 1st, delay 12
    (12.0, 0.04, 0.02, 12, 30.0, 1, false, [21.000000, 6.000000, 3.000000, 2.000000, 0.415156, 0.237054]),
    // mode 12 Hz zeta .04, fc 3 Hz 1st, delay 12
    (12.0, 0.04, 0.02, 12, 3.0, 1, false, [21.000000, 6.000000, 3.000000, 2.000000, 1.333333, 1.100000]),
    // mode 12 Hz zeta .04, fc 3 Hz 2nd, delay 12
    (12.0, 0.04, 0.02, 12, 3.0, 2, false, [21.000000, 6.000000, 3.000000, 2.000000, 1.333333, 1.100000]),
    // mode 12 Hz zeta .04, fc 1 Hz 2nd, delay 12
    (12.0, 0.04, 0.02, 12, 1.0, 2, false, [21.000000, 6.000000, 3.000000, 2.000000, 1.333333, 1.100000]),
    // mode 12 Hz zeta .04, fc 3 Hz 2nd + notch, delay 12
    (12.0, 0.04, 0.02, 12, 3.0, 2, true, [20.999999, 6.000000, 2.999999, 2.000000, 1.333333, 1.100000]),
    // mode 12 Hz zeta .04, fc 3 Hz 2nd, delay 40
    (12.0, 0.04, 0.02, 40, 3.0, 2, false, [21.000000, 6.000000, 3.000000, 2.000000, 1.333333, 1.100000]),
    // mode 12 Hz zeta .04, fc 10 Hz 2nd, delay 12
    (12.0, 0.04, 0.02, 12, 10.0, 2, false, [9.567887, 2.466270, 1.150087, 0.823618, 1.239058, 1.100000]),
    // mode 12 Hz zeta .04, fc 100 Hz 1st, fast servo 5 ms, delay 4
    (12.0, 0.04, 0.005, 4, 100.0, 1, false, [21.000000, 6.000000, 3.000000, 2.000000, 1.333333, 1.100000]),
    // mode 12 Hz zeta .04, fc 10 Hz 2nd, fast servo 5 ms, delay 4
    (12.0, 0.04, 0.005, 4, 10.0, 2, false, [21.000000, 6.000000, 3.000000, 2.000000, 0.758983, 0.673798]),
    // mode 12 Hz zeta .04, fc 3 Hz 2nd, fast servo 5 ms, delay 4
    (12.0, 0.04, 0.005, 4, 3.0, 2, false, [21.000000, 6.000000, 3.000000, 2.000000, 1.333333, 1.100000]),
    // mode 25 Hz zeta .05, fc 5 Hz 2nd, delay 2
    (25.0, 0.05, 0.01, 2, 5.0, 2, false, [21.000000, 6.000000, 3.000000, 2.000000, 1.333333, 1.100000]),
];

#[test]
fn critical_gains_are_those_of_the_loop_s_eigenvalues() {
    let mut worst = Worst::new();
    for (case, row) in TABLE.iter().enumerate() {
        let &(mode_hz, damping, lag, delay_cycles, cutoff_hz, order, notch, ref gains) = row;
        for (kappa, expected) in KAPPAS.into_iter().zip(gains) {
            let sampled = SampledLoop {
                kappa,
                mode_hz,
                damping,
                lag,
                delay_cycles,
                cutoff_hz,
                order,
                notch,
                period: 1e-3,
            };
            let found = sampled.critical_gain();
            worst.add_at(found / expected - 1.0, || {
                format!("case {case}, kappa {kappa}: {found}")
            });
        }
    }
    assert_eq!(worst.samples(), 72);
    println!(
        "largest difference of critical gains: {:?}",
        worst.measured()
    );
    assert!(worst.holds(0.02), "{worst:?}");
    // What is wanted is 2 %; what two ways to one number should show is more.
    assert!(worst.holds(1e-5), "{worst:?}");
}

#[test]
fn without_contact_no_gain_is_critical() {
    let sampled = SampledLoop {
        kappa: 0.0,
        mode_hz: 12.0,
        damping: 0.04,
        lag: 0.02,
        delay_cycles: 12,
        cutoff_hz: 3.0,
        order: 2,
        notch: false,
        period: 1e-3,
    };
    assert_eq!(sampled.critical_gain(), f64::INFINITY);
}
