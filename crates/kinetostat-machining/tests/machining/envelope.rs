//! What is gathered point by point shows what all points show, in as much memory for a long program as for a short one.

use kinetostat_machining::{Envelope, KeptPoints, PointKind, PointResult, Quantity};

const POINTS: u32 = 100_000;

fn point(i: u32) -> PointResult {
    let noise = |by: u64, of: u64| f64::from(((u64::from(i) * by) % of) as u32) / of as f64;
    let mut point = PointResult::default();
    point.line = i as usize / 3 + 1;
    point.output_line = i as usize / 2 + 1;
    // Unevenly along the path.
    point.path_mm = f64::from(i) + 0.9 * noise(7919, 1000);
    point.error_before_mm = [noise(104_729, 997), 0.0, 1.0];
    point.error_after_mm = [0.0, 1e-3 * noise(1_299_709, 991), 0.0];
    point.actuator_force = vec![noise(31, 89) - 0.5, -1.0];
    point.actuator_correction = vec![0.0, 0.0];
    point.smallest_stiffness_n_per_mm = 1000.0;
    point.stable = true;
    if i % 1000 == 999 {
        point.kind = PointKind::Rapid;
        // Never the worst: the tool does not cut.
        point.error_before_mm = [9.0, 0.0, 0.0];
    }
    point
}

/// Each stretch has exactly the lowest and the highest value of its own points, and all points are in one.
#[test]
fn a_stretch_has_the_range_of_its_points() {
    let points: Vec<PointResult> = (0..POINTS).map(point).collect();
    let mut envelope = Envelope::default();
    envelope.extend(&points);
    assert_eq!(envelope.points(), points.len());
    for quantity in [
        Quantity::ErrorBefore,
        Quantity::ErrorAfter,
        Quantity::ActuatorForce(0),
    ] {
        let stretches: Vec<_> = envelope.along(quantity).collect();
        assert!(
            (Envelope::MOST_STRETCHES / 2..=Envelope::MOST_STRETCHES).contains(&stretches.len())
        );
        let mut counted = 0;
        for stretch in &stretches {
            let [from, to] = stretch.path_mm;
            let last = to >= envelope.length_mm();
            let inside = |p: &&PointResult| {
                p.path_mm >= from && (p.path_mm < to || last) && p.kind != PointKind::Rapid
            };
            let own: Vec<f64> = points
                .iter()
                .filter(inside)
                .filter_map(|p| quantity.of(p))
                .collect();
            counted += own.len();
            let [low, high] = stretch.range.expect("points in every stretch");
            assert!(own.contains(&low) && own.contains(&high));
            assert!(
                own.iter().all(|x| (low..=high).contains(x)),
                "{quantity:?} from {from}"
            );
        }
        let cut = points.iter().filter(|p| p.kind != PointKind::Rapid);
        assert_eq!(counted, cut.count());
    }
}

/// Long rapids are rapids in the envelope, and NaN is skipped.
#[test]
fn rapids_and_missing_numbers() {
    let at = |path_mm: f64, kind: PointKind, error: f64| {
        let mut point = PointResult::default();
        (point.path_mm, point.kind) = (path_mm, kind);
        point.error_before_mm = [error, 0.0, 0.0];
        point
    };
    let mut envelope = Envelope::default();
    for i in 0..=100 {
        envelope.add(&at(f64::from(i), PointKind::Feed, 1.0));
    }
    envelope.add(&at(200.0, PointKind::Rapid, 7.0));
    envelope.add(&at(250.0, PointKind::Feed, f64::NAN));
    envelope.add(&at(f64::NAN, PointKind::Feed, 2.0));
    let mut seen = [0.0; 2];
    for stretch in envelope.along(Quantity::ErrorBefore) {
        let [from, to] = stretch.path_mm;
        seen[usize::from(stretch.rapid)] += to - from;
        if let Some([low, high]) = stretch.range {
            assert!(low >= 1.0 && high <= 2.0, "{stretch:?}");
        }
    }
    // As exactly as a stretch is long.
    assert!(
        (seen[1] - 100.0).abs() < 0.5 && (seen[0] - 150.0).abs() < 0.5,
        "{seen:?}"
    );
}

/// The worst before and after, the first place that is not stable, both ends, and no more than asked for.
#[test]
fn what_a_report_names_is_kept() {
    for spike in (1..POINTS).step_by(7_331) {
        let (unstable, after) = (POINTS - 1 - spike, (spike + 40_001) % POINTS);
        let mut kept = KeptPoints::new(4000);
        let mut all = Vec::new();
        for i in 0..POINTS {
            let mut point = point(i);
            if i == spike {
                (point.kind, point.error_before_mm) = (PointKind::Feed, [0.0, 3.0, 0.0]);
            }
            if i == after {
                (point.kind, point.error_after_mm) = (PointKind::Feed, [0.0, 0.0, 2.0]);
            }
            point.stable = i < unstable;
            kept.add(&point);
            all.push(point);
        }
        let points = kept.points();
        assert!(
            points.len() <= 4000 && points.len() > 1000,
            "{}",
            points.len()
        );
        assert!(points.is_sorted_by(|a, b| a.path_mm <= b.path_mm));
        for i in [0, spike, after, unstable, POINTS - 1] {
            assert!(points.contains(&all[i as usize]), "{i} of {spike}");
        }
        let (before, after_list) = (kept.worst_before(), kept.worst_after());
        assert_eq!(before[0], all[spike as usize]);
        assert_eq!(after_list[0], all[after as usize]);
        assert!(before.len() == 10 && after_list.len() == 10);
        assert!(before.iter().all(|p| p.kind == PointKind::Feed));
        // Apart from each other, before as along the whole path.
        for (i, a) in before.iter().enumerate() {
            for b in &before[..i] {
                assert!((a.path_mm - b.path_mm).abs() > f64::from(POINTS) / 51.0);
            }
        }
    }
}

/// Of a short program all points are kept.
#[test]
fn a_short_program_is_kept_whole() {
    let points: Vec<PointResult> = (0..4000).map(point).collect();
    let mut kept = KeptPoints::new(4000);
    kept.extend(&points);
    assert_eq!(kept.points(), points);
    kept.add(&point(4000));
    assert!(kept.points().len() < 4000);
}

/// A program that only turns the tool has no length of path.
#[test]
fn a_path_without_length_is_one_stretch() {
    let mut envelope = Envelope::default();
    let mut kept = KeptPoints::new(4000);
    for i in 0..10_000 {
        let mut still = point(i);
        still.path_mm = 0.0;
        envelope.add(&still);
        kept.add(&still);
    }
    assert_eq!(envelope.along(Quantity::ErrorBefore).count(), 1);
    assert!(!kept.points().is_empty() && !kept.worst_before().is_empty());
}
