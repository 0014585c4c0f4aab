//! The machine of chapter 6: as the preset, and with its bars one by one.

use kinetostat::model::LinkConvention;
use kinetostat_model::Model;
use kinetostat_reproduce::internal::{CHAPTER_6_POINTS, WithBars, cutting, orthoglide, target};
use kinetostat_testing::LargestEntry;

#[test]
fn the_machine_is_the_preset() {
    let preset = Model::preset("orthoglide").expect("preset").mechanism;
    let own = orthoglide();
    for (name, point) in CHAPTER_6_POINTS {
        let [a, b] = [&preset, &own].map(|machine| {
            let posture = machine.posture(&target(point)).expect(name);
            let k = posture.stiffness().expect(name).cartesian.matrix;
            let e = posture.deflected_by(&cutting(0.3)).expect(name);
            (posture.commands(), k, e.displacement.0)
        });
        for (x, y) in a.0.iter().zip(&b.0) {
            assert!((x - y).abs() < 1e-12, "{name}");
        }
        assert!(
            (a.1 - b.1).largest_entry() < 1e-9 * b.1.largest_entry(),
            "{name}"
        );
        assert!((a.2 - b.2).largest_entry() < 1e-12, "{name}");
    }
}

/// Two bars between two beams are what the lumped parallelogram stands for: the same stiffness
/// (to rounding), and loaded, with springs of the same convention, a
/// motion that differs by less than 1.4e-4 mm (reference numbers, section 2.0).
#[test]
fn bars_stand_for_the_lumped_spring() {
    let lumped = orthoglide();
    for (name, point) in CHAPTER_6_POINTS {
        let home = target(point);
        let posture = lumped.posture(&home).expect(name);
        let k = posture.stiffness().expect(name).cartesian.matrix;
        let loaded = posture.deflected_by(&cutting(0.0)).expect(name);
        for convention in [LinkConvention::TranslationsFirst, LinkConvention::Bowing] {
            let barred = WithBars::new(&home, convention);
            let posture = barred.posture();
            let rest = posture.wrench_at(&home).expect(name);
            assert!(rest.wrench.0.largest_entry() < 1e-6, "{name}");
            let apart = (rest.stiffness.matrix - k).largest_entry() / k.largest_entry();
            assert!(apart < 1e-11, "{name}: {apart:e}");
            if convention == LinkConvention::TranslationsFirst {
                let e = posture.deflected_by(&cutting(0.0)).expect(name);
                let apart = (e.displacement.linear() - loaded.displacement.linear()).norm();
                assert!(apart < 2e-7, "{name}: {apart:e} m");
            }
        }
    }
}
