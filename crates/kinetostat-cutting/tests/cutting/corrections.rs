//! Tables 2.1 and 2.3 of the report.

use kinetostat_cutting::{
    Coolant, Correction, CuttingMaterial, Kienzle, RakeReference, largest_force,
};

/// All cells of Table 2.3 (`shared/theory/reference-values.md`), N.
#[test]
fn every_cell_of_table_2_3() {
    let rows = [
        (2600.0, 0.19, 0.2, [6965.1043, 6770.1960, 6635.2231]),
        (2600.0, 0.19, 1.0, [25650.3521, 24932.5640, 24435.5001]),
        (780.0, 0.23, 0.2, [2228.4746, 2166.1139, 2122.9296]),
        (780.0, 0.23, 1.0, [7695.1056, 7479.7692, 7330.6500]),
    ];
    let mut compared = 0;
    for (specific, exponent, chip, cells) in rows {
        let material = Kienzle::new([specific, 0.0, 0.0], [exponent, 0.0, 0.0]).unwrap();
        for (speed, cell) in [1000.0, 1500.0, 2000.0].into_iter().zip(cells) {
            for width in [8.0, 16.0] {
                let force = largest_force(&material, chip, width, speed);
                assert!(
                    (force - cell * width / 8.0).abs() < 2e-4,
                    "{force} for {cell}"
                );
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 24);
}

/// Every line of Table 2.1.
#[test]
fn every_factor_of_table_2_1() {
    let factor = |of: Correction| of.factor().unwrap();
    let none = Correction::default();
    let lines = [
        (
            Correction {
                process: Some(1.3),
                ..none
            },
            1.3,
        ),
        (
            Correction {
                cutting_speed_m_per_min: Some(50.0),
                ..none
            },
            2.023 / 50_f64.powf(0.153),
        ),
        (
            Correction {
                cutting_speed_m_per_min: Some(500.0),
                ..none
            },
            1.380 / 500_f64.powf(0.07),
        ),
        (
            Correction {
                rake_deg: Some(6.0),
                ..none
            },
            1.018,
        ),
        (
            Correction {
                rake_deg: Some(2.0),
                rake_reference: RakeReference::CastIron,
                ..none
            },
            1.006,
        ),
        (
            Correction {
                cutting_material: CuttingMaterial::HighSpeedSteel,
                ..none
            },
            1.05,
        ),
        (
            Correction {
                cutting_material: CuttingMaterial::Ceramic,
                ..none
            },
            0.925,
        ),
        (
            Correction {
                wear: Some(1.5),
                ..none
            },
            1.5,
        ),
        (
            Correction {
                coolant: Coolant::Oil,
                ..none
            },
            0.85,
        ),
        (
            Correction {
                coolant: Coolant::Emulsion,
                ..none
            },
            0.9,
        ),
        (
            Correction {
                workpiece_shape: Some(1.2),
                ..none
            },
            1.2,
        ),
    ];
    let mut product = 1.0;
    for (of, expected) in lines {
        assert!((factor(of) - expected).abs() < 1e-12, "{of:?}");
        product *= expected;
    }
    assert!(product.is_finite());
    for absurd in [
        Correction {
            cutting_speed_m_per_min: Some(-5.0),
            ..none
        },
        Correction {
            wear: Some(f64::NAN),
            ..none
        },
        Correction {
            rake_deg: Some(80.0),
            ..none
        },
    ] {
        assert!(absurd.factor().is_err(), "{absurd:?}");
    }
}
