//! Removed volume against exact ones.

use std::f64::consts::PI;

use kinetostat_cutting::{Probe, Shape, Stock, StockSettings, Tool};

use kinetostat_testing::figure::at_most;

use crate::stock_support::{block, circle, flat};

/// Relative errors of a removed volume with cells of 0.3, 0.15 and 0.075 mm.
fn errors(exact: f64, tool: &Tool, cut: impl Fn(&mut Probe, &mut Stock)) -> [f64; 3] {
    [0.3, 0.15, 0.075].map(|cell| {
        let mut stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 6.0], cell);
        let before = stock.volume_mm3();
        let mut probe = Probe::new(tool);
        cut(&mut probe, &mut stock);
        // Away: the wall before the tool is done.
        probe.cut(&mut stock, [50.0; 3], [50.0; 3]).unwrap();
        (before - stock.volume_mm3()) / exact - 1.0
    })
}

fn assert_converges(name: &str, errors: [f64; 3], first: f64) {
    let title = format!("removed volume, {name}: share at cells of 0.3 mm");
    at_most(&title, errors[0].abs(), first, "1");
    let title = format!("removed volume, {name}: share at cells of 0.075 mm");
    at_most(&title, errors[2].abs(), 0.5 * first, "1");
    assert!(errors[0].abs() < first, "{errors:?}");
    assert!(
        errors[2].abs() < 0.5 * first && errors[2].abs() < 0.5 * errors[0].abs() + 2e-4,
        "{errors:?}"
    );
}

const A: [f64; 3] = [-7.1, -4.3, 4.0];
const B: [f64; 3] = [8.2, 5.1, 4.0];

fn length() -> f64 {
    (B[0] - A[0]).hypot(B[1] - A[1])
}

/// A slot through a block whose sides it leaves, in one move, in short ones, off the grid and aslant, with the default cell: walls
/// that meet in a cell lead to levels of their own.
#[test]
fn slots_through_the_sides_of_a_block() {
    let tool = flat(16.0);
    let (depth, sides) = (1.31, [90.0, 40.0]);
    let mut worst = kinetostat_testing::Worst::new();
    // From below x = 0 to beyond x = 90; the strip of a slanted slot within the block is a parallelogram.
    for (ends, moves) in [
        ([20.0, 20.0], 1),
        ([20.0, 20.0], 57),
        ([20.33, 20.33], 1),
        ([15.0, 25.0], 1),
        ([15.0, 25.0], 31),
    ] {
        let mut stock = block([0.0, 0.0, -20.0], [sides[0], sides[1], 0.0], 0.8);
        let before = stock.volume_mm3();
        let mut probe = Probe::new(&tool);
        let slope = (ends[1] - ends[0]) / sides[0];
        let place = |k: usize| {
            let x = -30.0 + 150.0 * k as f64 / f64::from(moves);
            [x, ends[0] + slope * x, -depth]
        };
        let places: Vec<[f64; 3]> = (0..=moves as usize).map(place).collect();
        probe.cut_along(&mut stock, &places).unwrap();
        probe.cut(&mut stock, [500.0; 3], [500.0; 3]).unwrap();
        let exact = sides[0] * 16.0 * slope.hypot(1.0) * depth;
        worst.add((before - stock.volume_mm3()) / exact - 1.0);
    }
    assert!(
        at_most(
            "removed volume, slots through the sides of a block: share",
            worst.of(5),
            2e-3,
            "1"
        ),
        "{worst}"
    );
}

#[test]
fn figure_a_slot_with_round_ends() {
    let exact = (PI * 9.0 + 6.0 * length()) * 2.0;
    let errors = errors(exact, &flat(6.0), |probe, stock| {
        probe.cut(stock, A, B).unwrap()
    });
    assert_converges("slot", errors, 2e-3);
}

#[test]
fn figure_a_slot_in_short_chords_is_the_slot() {
    let exact = (PI * 9.0 + 6.0 * length()) * 2.0;
    let errors = errors(exact, &flat(6.0), |probe, stock| {
        let place = |k: usize| std::array::from_fn(|i| A[i] + (B[i] - A[i]) * k as f64 / 53.0);
        let places: Vec<[f64; 3]> = (0..=53).map(place).collect();
        probe.cut_along(stock, &places).unwrap();
    });
    assert_converges("slot in short chords", errors, 2e-3);
}

#[test]
fn figure_a_slot_of_a_ball() {
    let ball = Tool::new(Shape::Ball, 6.0, 2).unwrap();
    // 2 mm deep with a radius of 3: the segment of the circle along, and a cap of the sphere (half at each end).
    let (r, h) = (3.0_f64, 2.0_f64);
    let segment = r * r * (1.0 - h / r).acos() - (r - h) * (2.0 * r * h - h * h).sqrt();
    let cap = PI * h * h * (r - h / 3.0);
    let errors = errors(segment * length() + cap, &ball, |probe, stock| {
        probe.cut(stock, A, B).unwrap()
    });
    assert_converges("slot of a ball", errors, 4e-3);
}

#[test]
fn a_ramp_of_a_ball() {
    // Deep enough that its sphere is in the material all along: the cylinder of its way below the top.
    let ball = Tool::new(Shape::Ball, 4.0, 2).unwrap();
    let errors = errors(1.0, &ball, |probe, stock| {
        probe.cut(stock, [-9.0, 1.0, 3.5], [9.0, 2.0, 1.0]).unwrap();
    });
    // By brute force: columns of 0.02 mm, the lowest of 4000 spheres' places.
    let (from, to) = ([-9.0, 1.0, 3.5], [9.0, 2.0, 1.0_f64]);
    let mut exact = 0.0;
    let step = 0.1;
    for i in 0..400 {
        for j in 0..400 {
            let (x, y) = (
                -20.0 + step * (i as f64 + 0.5),
                -20.0 + step * (j as f64 + 0.5),
            );
            let mut top = 6.0_f64;
            for k in 0..=1500 {
                let t = f64::from(k) / 1500.0;
                let (dx, dy) = (
                    x - from[0] - t * (to[0] - from[0]),
                    y - from[1] - t * (to[1] - from[1]),
                );
                let rest = 4.0 - dx * dx - dy * dy;
                if rest >= 0.0 {
                    top = top.min(from[2] + t * (to[2] - from[2]) + 2.0 - rest.sqrt());
                }
            }
            exact += (6.0 - top) * step * step;
        }
    }
    for (error, bound) in errors.iter().zip([1e-2, 4e-3, 2e-3]) {
        let found = error + 1.0;
        assert!((found / exact - 1.0).abs() < bound, "{found} {exact}");
    }
}

#[test]
fn figure_a_plunge_of_each_shape() {
    let shapes = [
        (Shape::Flat, PI * 9.0 * 2.0),
        (Shape::Ball, PI * 4.0 * (3.0 - 2.0 / 3.0)),
        // Half a turn of the quarter circle with corner 1: end 2, height 1, then a cylinder.
        (
            Shape::Bull {
                corner_radius_mm: 1.0,
            },
            PI * 9.0 + PI * (4.0 + 4.0 * PI / 4.0 + 2.0 / 3.0),
        ),
        // A cone from 3 to 5 mm.
        (
            Shape::Face {
                lead_angle: PI / 4.0,
            },
            PI * 2.0 / 3.0 * (9.0 + 15.0 + 25.0),
        ),
    ];
    for (shape, exact) in shapes {
        let tool = Tool::new(shape, 6.0, 2).unwrap();
        let errors = errors(exact, &tool, |probe, stock| {
            probe
                .cut(stock, [0.37, 0.21, 9.0], [0.37, 0.21, 4.0])
                .unwrap();
        });
        assert_converges(&format!("plunge of {shape:?}"), errors, 8e-3);
    }
}

#[test]
fn figure_a_round_pocket() {
    let exact = PI * 100.0 * 3.0;
    let errors = errors(exact, &flat(6.0), |probe, stock| {
        for radius in [1.0, 3.0, 5.0, 7.0] {
            let places = circle([0.1, 0.3], radius, 3.0, [0.0, 2.0 * PI], 720);
            probe.cut_along(stock, &places).unwrap();
        }
    });
    assert_converges("round pocket", errors, 2e-3);
}

#[test]
fn below_the_bottom_there_is_nothing_to_remove() {
    let mut stock = block([0.0; 3], [10.0, 10.0, 2.0], 0.25);
    let mut probe = Probe::new(&flat(40.0));
    probe
        .cut(&mut stock, [5.0, 5.0, 9.0], [5.0, 5.0, -3.0])
        .unwrap();
    assert_eq!(stock.volume_mm3(), 0.0);
}

/// A pass along an edge takes width, depth and length, wherever the edge lies between the points; so does the pass below it.
#[test]
fn passes_along_an_edge_leave_the_edge_below_where_it_is() {
    let tool = Tool::new(Shape::Flat, 6.0, 2).unwrap();
    let mut compared = 0;
    for cell in [0.15, 0.23, 0.3, 0.31, 0.37, 0.4] {
        let settings = StockSettings::with_cell_mm(cell).unwrap();
        let mut stock = Stock::block([-30.0, -20.0, -20.0], [30.0, 20.0, 0.0], &settings).unwrap();
        let mut probe = Probe::new(&tool);
        let mut before = stock.volume_mm3();
        for z in [-3.0, -7.0] {
            probe
                .cut(&mut stock, [-45.0, 21.0, z], [45.0, 21.0, z])
                .unwrap();
            let after = stock.volume_mm3();
            let depth = if z == -3.0 { 3.0 } else { 4.0 };
            let exact = 2.0 * depth * 60.0;
            assert!(
                (before - after - exact).abs() < 0.01 * exact,
                "cell {cell}, z {z}: {} instead of {exact}",
                before - after
            );
            before = after;
            compared += 1;
        }
    }
    assert_eq!(compared, 12);
}
