//! The six-axis arm of the reference values, section D3: its modes from the printed mass and stiffness, its Jacobian from the
//! table of joints.

use kinetostat_chatter::{Arc, Coefficients, MillingCut};
use kinetostat_chatter::{
    FeedFrame, Instability, Milled, Mode, Regeneration, ToolResponse, zeroth_order,
};
use kinetostat_testing::Worst;
use nalgebra::{
    Cholesky, Matrix3, Matrix3x6, Matrix6, Rotation3, SymmetricEigen, Unit, Vector3, Vector6,
};

const JOINTS: [([f64; 3], [f64; 3]); 6] = [
    ([0.0, 0.0, 0.4], [0.0, 0.0, 1.0]),
    ([0.35, 0.0, 0.4], [0.0, 1.0, 0.0]),
    ([0.0, 0.0, 1.15], [0.0, 1.0, 0.0]),
    ([0.6, 0.0, 0.12], [1.0, 0.0, 0.0]),
    ([0.6, 0.0, 0.0], [0.0, 1.0, 0.0]),
    ([0.2, 0.0, 0.0], [1.0, 0.0, 0.0]),
];

fn jacobian() -> Matrix3x6<f64> {
    let x = [
        0.2,
        0.3509565672,
        -0.0991920064,
        0.2999524539,
        0.9000305944,
        -0.4000291345,
    ];
    let (mut rotation, mut place) = (Rotation3::identity(), Vector3::zeros());
    let mut axes = Vec::new();
    for ((offset, axis), angle) in JOINTS.into_iter().zip(x) {
        place += rotation * Vector3::from(offset);
        let axis = Unit::new_normalize(Vector3::from(axis));
        axes.push((place, rotation * axis.into_inner()));
        rotation *= Rotation3::from_axis_angle(&axis, angle);
    }
    let tool = place + rotation * Vector3::new(0.25, 0.0, -0.30);
    let printed = Vector3::new(1.819546714, 0.4130091718, 1.1629274663);
    assert!((tool - printed).norm() < 1e-9);
    Matrix3x6::from_columns(&[0, 1, 2, 3, 4, 5].map(|i| {
        let (at, axis): (Vector3<f64>, Vector3<f64>) = axes[i];
        axis.cross(&(tool - at))
    }))
}

/// All six modes in base axes, 3 % of critical damping in each.
pub fn arm() -> ToolResponse {
    #[rustfmt::skip]
    let mass = Matrix6::from_row_slice(&[
        789.146107, 0.0280298263, 1.98720369, 31.7422675, 5.37671721, 9.76615551,
        0.0280298263, 823.723046, 268.608782, -5.45517259, -5.72428325, -1.88851941,
        1.98720369, 268.608782, 223.632019, -5.02772704, 12.8132746, -0.65343233,
        31.7422675, -5.45517259, -5.02772704, 7.32389979, 0.0186039709, 2.43313675,
        5.37671721, -5.72428325, 12.8132746, 0.0186039709, 7.49159452, 0.445920745,
        9.76615551, -1.88851941, -0.65343233, 2.43313675, 0.445920745, 1.566,
    ]);
    #[rustfmt::skip]
    let stiffness = Matrix6::from_row_slice(&[
        4200000.0, 0.0, 0.0, 0.0, 0.0, 0.0,
        0.0, 3895908.84, 360.547516, -9.1724335, 175.118875, 7.48645011,
        0.0, 360.547516, 2600360.55, -9.1724335, 175.118875, 7.48645011,
        0.0, -9.1724335, -9.1724335, 750156.263, 18.3920894, 50.5481299,
        0.0, 175.118875, 175.118875, 18.3920894, 600168.698, 10.9939799,
        0.0, 7.48645011, 7.48645011, 50.5481299, 10.9939799, 350023.422,
    ]);
    let inverse = Cholesky::new(mass).unwrap().l().try_inverse().unwrap();
    let eigen = SymmetricEigen::new(inverse * stiffness * inverse.transpose());
    let modes = (0..6).map(|k| {
        let shape: Vector6<f64> = inverse.transpose() * eigen.eigenvectors.column(k);
        Mode::new(jacobian() * shape, eigen.eigenvalues[k], 0.03).unwrap()
    });
    ToolResponse::new(modes.collect()).unwrap()
}

/// As the reference values take it: directions x (feed) and y only.
pub fn in_plane(tool: &ToolResponse) -> ToolResponse {
    let flat = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0));
    let modes = tool.modes().iter().map(|mode| {
        Mode::new(
            flat * mode.shape(),
            mode.angular_frequency().powi(2),
            mode.damping_ratio(),
        )
        .unwrap()
    });
    ToolResponse::new(modes.collect()).unwrap()
}

fn half_up() -> MillingCut {
    let coefficients = Coefficients::new(8e8, 2.4e8, 0.0).unwrap();
    MillingCut::new(2, Arc::straight(Milled::Up, 0.5).unwrap(), coefficients).unwrap()
}

fn fed_at(degrees: f64) -> Regeneration {
    let frame = FeedFrame::vertical(f64::to_radians(degrees)).unwrap();
    Regeneration::new(in_plane(&arm()).in_frame(&frame), half_up().into()).unwrap()
}

#[test]
fn modes_and_receptance_as_printed() {
    let arm = arm();
    let mut frequencies: Vec<f64> = arm.modes().iter().map(Mode::frequency_hz).collect();
    frequencies.sort_by(f64::total_cmp);
    let mut worst = Worst::new();
    let printed = [
        9.98746752, 11.5425353, 23.2012812, 49.0179614, 53.7168096, 126.52171,
    ];
    for (found, expected) in frequencies.iter().zip(printed) {
        worst.add(found / expected - 1.0);
    }
    let g = arm.receptance(52.0);
    for (i, j, re, im) in [
        (0, 0, 9.18771444e-08, -1.61499867e-06),
        (0, 1, 2.45454540e-06, -2.66946237e-07),
        (1, 2, -8.15475502e-07, 1.89576659e-07),
        (2, 2, 5.74175616e-08, -2.10119170e-07),
    ] {
        worst.add((g[(i, j)].re - re) / 2.5e-6);
        worst.add((g[(i, j)].im - im) / 2.5e-6);
    }
    worst.add(arm.receptance(0.0)[(0, 1)].re / -2.33069765e-07 - 1.0);
    assert!(worst.of(15) < 1e-7, "{worst}");
}

#[test]
fn zeroth_order_over_the_feed_direction() {
    let mut worst = Worst::new();
    for (angle, depth, frequency) in [
        (0.0, 1.343414, 51.57434),
        (30.0, 1.830673, 51.40354),
        (60.0, 1.396189, 52.09370),
        (90.0, 0.715597, 52.19121),
        (120.0, 0.516007, 51.99052),
        (150.0, 0.690314, 51.88575),
    ] {
        let found = zeroth_order::limit(&fed_at(angle), 3000.0)
            .unwrap()
            .unwrap();
        worst.add_at(1e3 * found.depth / depth - 1.0, || {
            format!("{angle}: {found:?}")
        });
        worst.add(found.frequency_hz / frequency - 1.0);
    }
    assert!(worst.of(12) < 1e-6, "{worst}");
}

#[test]
fn exact_limits_over_the_speed() {
    let arm = fed_at(0.0);
    let (mut exact, mut zeroth) = (Worst::new(), Worst::new());
    for (speed, printed_zeroth, printed) in [
        (600.0, 1.303056, 0.792692),
        (900.0, 0.770134, 0.803223),
        (1500.0, 2.622993, 0.705773),
        (2200.0, 1.322673, 0.808468),
        (3000.0, 1.343414, 0.642480),
        (3600.0, 1.399509, 1.346807),
        (6000.0, 2.189935, 2.190751),
    ] {
        let found = arm.stability_at(speed, 4e-3).unwrap();
        let limit = found.limit().copied().unwrap();
        exact.add_at(1e3 * limit.depth / printed - 1.0, || {
            format!("{speed}: {limit:?}")
        });
        let of_zeroth = zeroth_order::limit(&arm, speed).unwrap().unwrap();
        zeroth.add_at(1e3 * of_zeroth.depth / printed_zeroth - 1.0, || {
            format!("{speed}: {of_zeroth:?}")
        });
        if speed == 3000.0 {
            // Trap 2: the zeroth order would call twice the true limit safe; it flips, at half the tooth frequency.
            assert_eq!(limit.kind, Instability::Flip);
            assert!((limit.multiplier.0 + 1.0).abs() < 1e-6);
            assert!((limit.frequency_hz - 50.0).abs() < 1e-6, "{limit:?}");
            assert!(arm.multiplier(speed, 0.9 * of_zeroth.depth).unwrap().size() > 1.05);
        }
    }
    assert!(exact.of(7) < 2e-6, "{exact}");
    assert!(zeroth.of(7) < 2e-6, "{zeroth}");
}
