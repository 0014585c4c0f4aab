//! Singular and invalid input of the choice of postures.

use crate::candidates::{p9, random_candidates, three_r_test_pose};
use crate::regressors::{Arm, markers, tool_point};
use crate::support::Random;
use kinetostat_identification::design::{
    Criterion, DesignError, DesignSettings, continuous, evaluate, exact,
};
use nalgebra::{DMatrix, Vector3};

fn with_fixed(information: DMatrix<f64>) -> DesignSettings {
    DesignSettings {
        fixed_information: Some(information),
        ..DesignSettings::default()
    }
}

fn repeated() -> DesignSettings {
    DesignSettings {
        repeats: true,
        ..DesignSettings::default()
    }
}

#[test]
fn a_weight_does_not_load_the_vertical_joint() {
    let arm = Arm::h6();
    let mut random = Random::new(72);
    let candidates: Vec<DMatrix<f64>> = (0..40)
        .map(|_| {
            let posture = arm.at(&arm.draw(&mut random));
            posture.marker_regressor(tool_point(), Vector3::new(0.0, 0.0, -2500.0), &markers())
        })
        .collect();
    for criterion in [
        Criterion::Average,
        Criterion::Determinant,
        Criterion::WorstDirection,
    ] {
        let Err(DesignError::NotIdentifiable {
            rank,
            parameters,
            combinations,
        }) = exact(&candidates, &criterion, 12, &DesignSettings::default())
        else {
            panic!("joint 1 was identified");
        };
        assert_eq!((rank, parameters), (5, 6));
        assert_eq!(combinations.shape(), (6, 1));
        assert!((combinations[(0, 0)].abs() - 1.0).abs() < 1e-12);
        assert!(combinations.rows(1, 5).norm() < 1e-9);
        // A prior for joint 1 makes the rest identifiable.
        let mut prior = DMatrix::zeros(6, 6);
        prior[(0, 0)] = 1e12;
        let found = exact(&candidates, &criterion, 12, &with_fixed(prior)).unwrap();
        assert!(found.value.is_finite() && found.value > 0.0);
    }
}

#[test]
fn unobserved_combination_is_named() {
    // Columns 0 and 2 occur only as their sum.
    let candidates: Vec<DMatrix<f64>> = random_candidates(1, 10, 2, 2)
        .iter()
        .map(|a| DMatrix::from_fn(2, 3, |i, j| a[(i, j % 2)] * if j == 2 { 4.0 } else { 1.0 }))
        .collect();
    let Err(DesignError::NotIdentifiable {
        rank, combinations, ..
    }) = continuous(
        &candidates,
        &Criterion::Determinant,
        3,
        &DesignSettings::default(),
    )
    else {
        panic!("identified");
    };
    assert_eq!(rank, 2);
    let c = combinations.column(0);
    assert!((c[0] + 4.0 * c[2]).abs() < 1e-12 && c[1].abs() < 1e-12 && c[0].abs() == 1.0);
}

#[test]
fn too_few_postures_are_a_finding() {
    let candidates = random_candidates(3, 20, 3, 7);
    let l = Criterion::TestPoses(DMatrix::identity(7, 7));
    for criterion in [
        l,
        Criterion::Average,
        Criterion::Determinant,
        Criterion::WorstDirection,
    ] {
        let result = exact(&candidates, &criterion, 2, &DesignSettings::default());
        assert_eq!(
            result,
            Err(DesignError::TooFewObservations {
                count: 2,
                rank: 6,
                parameters: 7
            })
        );
        let result = evaluate(&candidates, &[5, 5, 5], &criterion, &repeated());
        assert_eq!(
            result,
            Err(DesignError::TooFewObservations {
                count: 3,
                rank: 3,
                parameters: 7
            })
        );
        assert!(exact(&candidates, &criterion, 3, &DesignSettings::default()).is_ok());
    }
}

#[test]
fn one_rare_candidate_is_found() {
    // Only candidate 17 observes the last parameter.
    let mut candidates = random_candidates(4, 40, 1, 4);
    for (x, a) in candidates.iter_mut().enumerate() {
        a[(0, 3)] = if x == 17 { 1e-3 } else { 0.0 };
    }
    for criterion in [
        Criterion::Average,
        Criterion::Determinant,
        Criterion::WorstDirection,
    ] {
        let found = exact(&candidates, &criterion, 4, &DesignSettings::default()).unwrap();
        assert!(found.postures.contains(&17));
    }
}

#[test]
fn one_candidate() {
    let candidate = random_candidates(2, 1, 6, 3);
    let m = candidate[0].tr_mul(&candidate[0]);
    let trace = m.try_inverse().unwrap().trace();
    let one = exact(
        &candidate,
        &Criterion::Average,
        1,
        &DesignSettings::default(),
    )
    .unwrap();
    assert_eq!(one.postures, [0]);
    assert!((one.value / trace - 1.0).abs() < 1e-10);
    assert!((one.efficiency.unwrap() - 1.0).abs() < 1e-10);
    let four = exact(&candidate, &Criterion::Average, 4, &repeated()).unwrap();
    assert_eq!(four.postures, [0; 4]);
    assert!((four.value / trace - 0.25).abs() < 1e-10);
    let design = continuous(&candidate, &Criterion::Determinant, 1, &repeated()).unwrap();
    assert_eq!(design.weights, [1.0]);
    assert_eq!(
        exact(
            &candidate,
            &Criterion::Average,
            4,
            &DesignSettings::default()
        ),
        Err(DesignError::Count {
            count: 4,
            candidates: 1
        })
    );
}

#[test]
fn one_parameter() {
    let candidates = random_candidates(6, 5, 1, 1);
    let sizes: Vec<f64> = candidates.iter().map(|a| a[(0, 0)].abs()).collect();
    let largest = (0..5)
        .max_by(|a, b| sizes[*a].total_cmp(&sizes[*b]))
        .unwrap();
    for criterion in [
        Criterion::Average,
        Criterion::Determinant,
        Criterion::WorstDirection,
    ] {
        let found = exact(&candidates, &criterion, 2, &repeated()).unwrap();
        assert_eq!(found.postures, [largest; 2]);
        assert!((found.value * 2.0 * sizes[largest].powi(2) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn count_of_the_whole_list() {
    let candidates = p9();
    let l = Criterion::TestPoses(three_r_test_pose());
    let all = exact(&candidates, &l, 20, &DesignSettings::default()).unwrap();
    assert_eq!(all.postures, (0..20).collect::<Vec<_>>());
    assert!(all.efficiency.unwrap() > 1.0 - 1e-9);
    assert_eq!(
        exact(&candidates, &l, 21, &DesignSettings::default()),
        Err(DesignError::Count {
            count: 21,
            candidates: 20
        })
    );
    assert_eq!(
        exact(&candidates, &l, 21, &repeated())
            .unwrap()
            .postures
            .len(),
        21
    );
}

#[test]
fn equal_and_empty_candidates() {
    let mut candidates = p9();
    candidates.extend(p9());
    candidates.push(DMatrix::zeros(3, 3));
    let l = Criterion::TestPoses(three_r_test_pose());
    let found = exact(&candidates, &l, 3, &DesignSettings::default()).unwrap();
    assert!(found.value <= 2.240942498937 * (1.0 + 1e-9));
    let design = continuous(&candidates, &l, 1, &DesignSettings::default()).unwrap();
    assert!((design.value / 5.379571583 - 1.0).abs() < 1e-9 && design.gap < 1e-9);
}

#[test]
fn invalid_numbers_are_refused() {
    let l = Criterion::TestPoses(three_r_test_pose());
    let settings = DesignSettings::default();
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e200] {
        let mut candidates = p9();
        candidates[6][(1, 2)] = bad;
        let refused = DesignError::CandidateNotFinite(6);
        assert_eq!(exact(&candidates, &l, 3, &settings), Err(refused.clone()));
        assert_eq!(
            continuous(&candidates, &l, 3, &settings),
            Err(refused.clone())
        );
        assert_eq!(
            evaluate(&candidates, &[0, 1, 2], &l, &settings),
            Err(refused)
        );
    }
    let mut skew = DMatrix::identity(3, 3);
    skew[(0, 1)] = 0.5;
    let not_finite = DMatrix::from_element(3, 3, f64::NAN);
    for bad in [skew, not_finite, -DMatrix::<f64>::identity(3, 3)] {
        assert_eq!(
            exact(&p9(), &Criterion::TestPoses(bad.clone()), 3, &settings),
            Err(DesignError::NotSemidefinite {
                matrix: "matrix of the test poses",
                parameters: 3
            })
        );
        assert_eq!(
            exact(&p9(), &l, 3, &with_fixed(bad)),
            Err(DesignError::NotSemidefinite {
                matrix: "fixed information",
                parameters: 3
            })
        );
    }
    for gap in [0.0, 1.0, -1.0, f64::NAN] {
        let settings = DesignSettings {
            gap,
            ..DesignSettings::default()
        };
        assert!(matches!(
            exact(&p9(), &l, 3, &settings),
            Err(DesignError::Gap(_))
        ));
    }
}

#[test]
fn invalid_shapes_are_refused() {
    let settings = DesignSettings::default();
    let average = Criterion::Average;
    assert_eq!(
        exact(&[], &average, 3, &settings),
        Err(DesignError::NoCandidates)
    );
    assert_eq!(
        exact(&[DMatrix::zeros(3, 0)], &average, 1, &settings),
        Err(DesignError::NoCandidates)
    );
    assert_eq!(
        exact(&p9(), &average, 0, &settings),
        Err(DesignError::Count {
            count: 0,
            candidates: 20
        })
    );
    assert_eq!(
        evaluate(&p9(), &[], &average, &settings),
        Err(DesignError::Count {
            count: 0,
            candidates: 20
        })
    );
    for (rows, columns) in [(3, 2), (0, 3)] {
        let mut candidates = p9();
        candidates.push(DMatrix::zeros(rows, columns));
        assert_eq!(
            exact(&candidates, &average, 3, &settings),
            Err(DesignError::CandidateShape {
                candidate: 20,
                rows,
                columns,
                expected: 3
            })
        );
    }
    assert_eq!(
        exact(
            &p9(),
            &Criterion::TestPoses(DMatrix::identity(2, 2)),
            3,
            &settings
        ),
        Err(DesignError::NotSemidefinite {
            matrix: "matrix of the test poses",
            parameters: 3
        })
    );
    assert_eq!(
        exact(
            &p9(),
            &Criterion::TestPoses(DMatrix::zeros(3, 3)),
            3,
            &settings
        ),
        Err(DesignError::ZeroTestPoses)
    );
    assert_eq!(
        evaluate(&p9(), &[0, 1, 20], &average, &settings),
        Err(DesignError::UnknownPosture {
            index: 20,
            candidates: 20
        })
    );
    assert_eq!(
        continuous(&p9(), &Criterion::WorstDirection, 3, &settings),
        Err(DesignError::NoContinuousDesign)
    );
}

#[test]
fn optimum_with_singular_information() {
    // The best design for one test pose measures the deflection at that pose, which identifies 3 combinations of 7 only.
    let mut candidates = random_candidates(3, 20, 3, 7);
    let test = random_candidates(4, 1, 3, 7).remove(0);
    candidates.push(&test * 100.0);
    let l = Criterion::TestPoses(test.tr_mul(&test));
    let design = continuous(&candidates, &l, 12, &repeated()).unwrap();
    assert!(design.gap < 1e-6, "{}", design.gap);
    assert!((design.bound / (3e-4 / 12.0) - 1.0).abs() < 1e-6 && design.support == [20]);
    let found = exact(&candidates, &l, 12, &repeated()).unwrap();
    assert!(found.value.is_finite() && found.efficiency.unwrap() <= 1.0);
}
