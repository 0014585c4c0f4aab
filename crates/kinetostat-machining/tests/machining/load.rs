//! The load along a program: axes, turning, where it acts.

use kinetostat::Wrench;
use kinetostat_machining::{CuttingLoad, LoadAlongPath, LoadAxes, Placement, ProgramLoad};
use kinetostat_program::{Path, Program, ReadOptions, interpret};
use kinetostat_testing::Worst;
use nalgebra::{UnitQuaternion, Vector3, vector};

fn path(text: &str) -> Path {
    let program = Program::read(text).expect("program");
    interpret(&program, &ReadOptions::default()).expect("path")
}

fn milling() -> ProgramLoad {
    ProgramLoad::new(CuttingLoad::Milling {
        radial: 215.0,
        tangential: -10.0,
        axial: -25.0,
    })
}

/// Parallel axes, origin at the base's.
fn plain() -> Placement {
    Placement::at(Vector3::zeros())
}

fn close(a: Vector3<f64>, b: Vector3<f64>) {
    assert!((a - b).norm() < 1e-9, "{a} is not {b}");
}

#[test]
fn on_a_counter_clockwise_circle_the_milling_frame_is_the_corrected_eq_7_17() {
    let path = path("G21 G90\nG0 X25 Y0 Z0\nG3 X25 Y0 I-25 J0 F600\n");
    let load = LoadAlongPath::new(milling(), &path);
    for k in 0..=20 {
        let share = f64::from(k) / 20.0;
        let phi = std::f64::consts::TAU * share;
        let (s, c) = phi.sin_cos();
        let force = load.wrench(&plain(), 1, share).force();
        close(
            force,
            vector![215.0 * c + 10.0 * s, 215.0 * s - 10.0 * c, -25.0],
        );
        assert!((force.xy().norm() - (215.0_f64.powi(2) + 100.0).sqrt()).abs() < 1e-9);
    }
}

#[test]
fn rapids_and_points_above_the_height_carry_no_load() {
    let path = path("G21 G90\nG0 X0 Y0 Z5\nG1 Z-2 F100\nG1 X10\n");
    let mut law = milling();
    law.below_z_mm = Some(0.0);
    let load = LoadAlongPath::new(law, &path);
    assert_eq!(load.wrench(&plain(), 0, 1.0), Wrench::zero());
    assert_eq!(load.wrench(&plain(), 1, 0.5), Wrench::zero());
    close(
        load.wrench(&plain(), 1, 0.9).force(),
        vector![0.0, 0.0, -25.0],
    );
    close(
        load.wrench(&plain(), 2, 0.9).force(),
        vector![-10.0, -215.0, -25.0],
    );
}

#[test]
fn the_load_turns_gradually_at_gentle_corners_and_at_once_at_sharp_ones() {
    let path = path("G21 G90\nG0 X0 Y0 Z0\nG1 X50 F100\nG1 X100 Y10\nG1 X100 Y60\n");
    let load = LoadAlongPath::new(milling(), &path);
    let at = |index, share| load.wrench(&plain(), index, share).force();
    close(at(1, 1.0), at(2, 0.0));
    // Two millimetres away it has its own direction again.
    close(at(1, 0.95), vector![-10.0, -215.0, -25.0]);
    let (gentle, sharp) = (
        (at(1, 0.97) - at(1, 0.975)).norm(),
        (at(2, 1.0) - at(3, 0.0)).norm(),
    );
    assert!(gentle > 0.1 && gentle < 20.0, "{gentle}");
    assert!(sharp > 200.0, "{sharp}");
}

#[test]
fn a_constant_wrench_is_meant_in_the_axes_requested() {
    let path = path("G21 G90\nG0 X0 Y0 Z0\nG1 X0 Y50 F100\n");
    let wrench = Wrench::new(vector![10.0, 20.0, 30.0], vector![1.0, 2.0, 3.0]);
    let place = Placement {
        base_from_part: kinetostat::Pose::from_parts(
            vector![0.1, 0.2, 0.3].into(),
            UnitQuaternion::from_scaled_axis(vector![0.0, 0.0, std::f64::consts::FRAC_PI_2]),
        ),
        tool_orientation: UnitQuaternion::from_scaled_axis(vector![std::f64::consts::PI, 0.0, 0.0]),
        orientation_follows: false,
        scale: 1.0,
    };
    let at = |axes| {
        let load = ProgramLoad::new(CuttingLoad::Constant { axes, wrench });
        LoadAlongPath::new(load, &path).wrench(&place, 1, 0.5)
    };
    assert_eq!(at(LoadAxes::Base), wrench);
    close(at(LoadAxes::Tool).force(), vector![10.0, -20.0, -30.0]);
    close(at(LoadAxes::Tool).moment(), vector![1.0, -2.0, -3.0]);
    // Feed along the part's y, which is the base's -x.
    close(at(LoadAxes::Feed).force(), vector![-10.0, -20.0, 30.0]);
}

/// A cut along a straight line, a wave or a circle, written by a CAM system whose numbers have moves of tenths of
/// micrometres in any direction between them: the load is that of the cut.
#[test]
fn moves_far_below_a_tooths_feed_do_not_turn_the_load() {
    let mut state = 7_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as f64 / f64::from(1 << 30) - 1.0
    };
    let (mut short, mut worst) = (0, Worst::new());
    for (noise_mm, allowed) in [(0.0002, 0.01), (0.001, 0.04), (0.003, 0.12)] {
        for direction in [0.0_f64, 0.7, 2.5] {
            let (c, s) = (direction.cos(), direction.sin());
            let mut text = "G21 G90\nG0 X0 Y0 Z0\n".to_owned();
            let mut along = 0.0;
            for k in 1..120 {
                along += if k % 3 == 0 {
                    0.5 + 0.3 * random()
                } else {
                    0.0
                };
                let (u, v) = (along + noise_mm * random(), noise_mm * random());
                text += &format!("G1 X{:.6} Y{:.6} F600\n", u * c - v * s, u * s + v * c);
            }
            let path = path(&text);
            let load = LoadAlongPath::new(milling(), &path);
            // The first and the last cut have no path on both sides.
            for (i, motion) in path.moves.iter().enumerate().take(115).skip(5) {
                let f = load.wrench(&plain(), i, 0.5).force();
                let wanted = vector![215.0 * s - 10.0 * c, -215.0 * c - 10.0 * s, -25.0];
                let turned = (f - wanted).norm() / 215.0;
                worst.add(turned / allowed);
                assert!(turned <= allowed, "{noise_mm} {direction} {i}: {turned}");
                short += usize::from(motion.length_mm() < 0.01);
            }
        }
    }
    let worst = worst.value();
    assert!(short > 500 && worst > 0.1, "{short} {worst}");
}

/// At a corner that is one the load turns, also where a tiny chamfer lies in it.
#[test]
fn a_tiny_chamfer_leaves_a_corner_a_corner() {
    let path = path("G21 G90\nG0 X0 Y0 Z0\nG1 X50 F100\nG1 X50.0002 Y0.0002\nG1 Y50\n");
    let load = LoadAlongPath::new(milling(), &path);
    close(
        load.wrench(&plain(), 1, 0.9).force(),
        vector![-10.0, -215.0, -25.0],
    );
    close(
        load.wrench(&plain(), 3, 0.5).force(),
        vector![215.0, -10.0, -25.0],
    );
    let chamfer = load.wrench(&plain(), 2, 0.5).force();
    assert!(
        (chamfer.y + 225.0 * 0.5_f64.sqrt()).abs() < 2.0,
        "{chamfer}"
    );
}
