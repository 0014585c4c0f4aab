//! Points that are kept for plots and tables hold what the others show.

use kinetostat_machining::{PointResult, thinned};
use kinetostat_testing::largest;

fn size(v: &[f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Single spikes before and after, at places that no stride meets.
#[test]
fn a_single_spike_stays_wherever_it_is() {
    for spike in (1..50_000).step_by(1733) {
        let mut points: Vec<PointResult> = (0..50_000)
            .map(|i| {
                let mut point = PointResult::default();
                point.path_mm = f64::from(i);
                point.error_before_mm = [0.1, 0.0, 0.0];
                point.error_after_mm = [1e-4, 0.0, 0.0];
                point.actuator_force = vec![1.0, -1.0];
                point.actuator_correction = vec![0.0, 0.0];
                point.stable = true;
                point
            })
            .collect();
        points[spike].error_after_mm[1] = 3e-4;
        points[50_000 - spike].error_before_mm[2] = 0.2;
        points[spike / 2].actuator_force[1] = -7.0;
        points[spike / 3].stable = false;
        let kept = thinned(&points, &[17], 4000);
        assert!(kept.len() <= 4000 && kept.is_sorted());
        for index in [0, 17, 49_999, spike, 50_000 - spike, spike / 2, spike / 3] {
            assert!(kept.contains(&index), "{index} of the spike {spike}");
        }
    }
}

/// In every stretch the kept points reach as high and as low as all of them.
#[test]
fn the_envelope_is_kept() {
    let points: Vec<PointResult> = (0..40_000_u32)
        .map(|i| {
            let mut point = PointResult::default();
            point.error_before_mm = [f64::from(i * 7919 % 1000), 0.0, 0.0];
            point.error_after_mm = [f64::from(i * 104_729 % 997), 0.0, 0.0];
            point
        })
        .collect();
    let kept = thinned(&points, &[], 4000);
    for window in (0..40_000).step_by(1000) {
        let range = window..window + 1000;
        for of in [
            |p: &PointResult| size(&p.error_before_mm),
            |p: &PointResult| size(&p.error_after_mm),
        ] {
            let most =
                |indices: &mut dyn Iterator<Item = usize>| largest(indices.map(|i| of(&points[i])));
            let all = most(&mut range.clone());
            let shown = most(&mut kept.iter().copied().filter(|i| range.contains(i)));
            assert_eq!(all, shown, "from {window}");
        }
    }
}
