//! Thickness of chips: closed forms, and the least over the teeth before by plain search.

use kinetostat_testing::least;
use std::f64::consts::{PI, TAU};

use kinetostat_cutting::{Engagement, Feed, Linear, Milling, Rotation, RunOut, Shape, Side, Tool};

fn law() -> Linear {
    Linear::new([800.0, 200.0, 100.0], [20.0, 20.0, 0.0]).unwrap()
}

/// `c sin kappa` where the ball is widest, in the middle of a slot; `r = R sin kappa`.
#[test]
fn a_ball_has_its_thickest_chip_at_full_depth() {
    let tool = Tool::new(Shape::Ball, 10.0, 3).unwrap();
    let law = law();
    for depth in [0.5, 1.0, 3.0, 5.0, 8.0] {
        let slot = Engagement::straight(5.0, 10.0, depth, Side::Left).unwrap();
        let cut = Milling::new(&tool, &law, &slot, Feed::level(0.08).unwrap());
        let chip = cut.chip_thickness().unwrap();
        let radius = tool.radius_at_mm(least([depth, 5.0]));
        let expected = 0.08 * radius / 5.0;
        assert!(
            (chip.largest_mm - expected).abs() < 1e-9,
            "{depth}: {chip:?}"
        );
        assert!(chip.mean_mm < chip.largest_mm && chip.mean_mm > 0.0);
    }
}

/// `(c/a) (1 - cos a)` over the arc `a` of a side cut, either way of the spindle.
#[test]
fn the_mean_of_a_side_cut_is_that_of_its_arc() {
    let tool = Tool::new(Shape::Flat, 12.0, 4).unwrap();
    let law = law();
    for width in [0.1, 2.0, 6.0, 9.0] {
        let arc = (1.0_f64 - width / 6.0).acos();
        let expected = 0.1 * (1.0 - arc.cos()) / arc;
        for side in [Side::Left, Side::Right] {
            for rotation in [Rotation::Clockwise, Rotation::CounterClockwise] {
                let cut = Engagement::straight(6.0, width, 2.0, side).unwrap();
                let cut = Milling::new(&tool, &law, &cut, Feed::level(0.1).unwrap());
                let chip = cut.turning(rotation).chip_thickness().unwrap();
                let apart = (chip.mean_mm - expected).abs();
                assert!(apart < 1e-6 * expected + 1e-12, "{width}: {chip:?}");
                let most = 0.1 * least([arc, 0.5 * PI]).sin();
                assert!((chip.largest_mm - most).abs() < 1e-6, "{width}: {chip:?}");
            }
        }
    }
}

/// `h_j = min over m of [m c sin phi + rho_j - rho_(j+m)]`, teeth that miss their chip included.
#[test]
fn run_out_thickens_chips_as_the_teeth_before_left_them() {
    let (teeth, feed) = (4, 0.05);
    let law = law();
    for (offset, angle) in [(0.005, 0.3), (0.03, 2.0), (0.2, 5.0)] {
        let tool = Tool::new(Shape::Flat, 10.0, teeth).unwrap();
        let run_out = RunOut {
            offset_mm: offset,
            angle,
        };
        let tool = tool.with_run_out(run_out).unwrap();
        let slot = Engagement::straight(5.0, 10.0, 1.0, Side::Left).unwrap();
        let cut = Milling::new(&tool, &law, &slot, Feed::level(feed).unwrap());
        let chip = cut.chip_thickness().unwrap();
        let rho = |j: usize| offset * (angle - TAU * j as f64 / teeth as f64).cos();
        let (mut largest, mut sum, mut count) = (0.0, 0.0, 0.0);
        for j in 0..teeth {
            for i in 0..20_000 {
                let sine = (PI * (f64::from(i) + 0.5) / 20_000.0).sin();
                let line = |m: usize| m as f64 * feed * sine + rho(j) - rho((j + m) % teeth);
                let thickness = least((1..=teeth).map(line));
                if thickness > 0.0 {
                    sum += thickness;
                    count += 1.0;
                }
                if thickness > largest {
                    largest = thickness;
                }
            }
        }
        assert!((chip.largest_mm - largest).abs() < 1e-6, "{chip:?}");
        assert!((chip.mean_mm - sum / count).abs() < 2e-3 * chip.mean_mm);
    }
}

#[test]
fn air_has_no_chips() {
    let tool = Tool::new(Shape::Flat, 10.0, 2).unwrap();
    let (law, air) = (law(), Engagement::air());
    let cut = Milling::new(&tool, &law, &air, Feed::level(0.1).unwrap());
    assert_eq!(cut.chip_thickness(), None);
}
