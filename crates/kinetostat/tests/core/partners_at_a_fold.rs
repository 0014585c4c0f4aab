//! Close to the limit of a two-bar truss a stable and an unstable shape lie beside each other, and a
//! third one beyond: all three are kept.

use kinetostat::{
    Chain, ChainProblem, EndCondition, MotionKind, Pose, Prescribed, Wrench, equilibria,
    equilibrium::{Bounds, SearchSettings},
};
use nalgebra::{Vector3, vector};

#[test]
fn both_partners_are_kept_down_to_one_part_in_a_hundred_million() {
    let (span, rise, stiffness) = (1.0_f64, 0.2_f64, 1000.0);
    let natural = span.hypot(rise);
    // One bar; the other is its mirror image, so the end moves up and down only.
    let chain = Chain::builder("bar")
        .passive("q", MotionKind::Revolute, Vector3::z(), rise.atan2(span))
        .translation(vector![natural, 0.0, 0.0])
        .spring("bar", MotionKind::Prismatic, Vector3::x(), stiffness, 0.0)
        .build()
        .unwrap();
    // Load at a height, and its largest value.
    let load = |h: f64| stiffness * h * (natural / span.hypot(h) - 1.0);
    let limit = ((natural * span * span).powf(2.0 / 3.0) - span * span).sqrt();
    let most = load(limit);
    for share in [1e-3, 3e-6, 1e-7, 1e-8] {
        let p = most * (1.0 - share);
        let root = |mut low: f64, mut high: f64| {
            // load(low) < p < load(high), or the other way round.
            let rising = load(high) > load(low);
            for _ in 0..200 {
                let middle = 0.5 * (low + high);
                if (load(middle) < p) == rising {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            0.5 * (low + high)
        };
        let expected = [root(limit, rise), root(0.0, limit), root(-1.0, -rise)];
        let mut end = EndCondition::wrench(Wrench::new(vector![0.0, -p, 0.0], Vector3::zeros()));
        end.pose = Pose::translation(span, rise, 0.0);
        end.prescribed[0] = Prescribed::Pose;
        let problem = ChainProblem::new(&chain, end);
        let settings = SearchSettings::default().with_fruitless(60);
        let mut bounds = Bounds::of(&chain);
        (bounds.low[0], bounds.high[0]) = (-1.5, 1.5);
        let all = equilibria(&problem, &bounds, &settings).unwrap();
        let heights: Vec<(f64, bool)> = all
            .found
            .iter()
            .map(|f| (f.equilibrium.tip.translation.vector.y, f.stable))
            .collect();
        assert_eq!(
            heights.len(),
            3,
            "{share:e}: {heights:?} asked {expected:?}"
        );
        for (k, h) in expected.iter().enumerate() {
            // A root beside a fold is known to the root of the rounding.
            let near = |(found, stable): &&(f64, bool)| {
                (found - h).abs() < 0.05 * (expected[0] - expected[1]) && *stable == (k != 1)
            };
            assert!(
                heights.iter().any(|f| near(&f)),
                "{share:e}: {h} in {heights:?}"
            );
        }
    }
}
