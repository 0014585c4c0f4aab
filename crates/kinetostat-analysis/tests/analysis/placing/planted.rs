//! Optima that are known.

use kinetostat_analysis::placing::{Effort, Placed, Question, Range, Space, Variable, place};
use kinetostat_machining::{Unwatched, analyse};
use kinetostat_testing::{Worst, figure};

use crate::placing::machine::{SOFT, along_x, rails, swing, to_the_right, with_task};

/// Along y from -30 to 50 mm: about its zero it is not even.
const ALONG_Y: &str = "G21 G90\nG0 X0 Y-30 Z0\nG1 Y50 F600\nM2\n";

fn range(variable: Variable, from: f64, to: f64) -> Range {
    Range { variable, from, to }
}

fn swung(ranges: &[Range]) -> Placed {
    with_task(&swing(), ALONG_Y, along_x(1000.0), |task| {
        let space = Space::new(task.placement, ranges.to_vec(), Vec::new(), false).expect("space");
        place(
            task,
            &space,
            &Question::default(),
            Effort::default(),
            &Unwatched,
        )
        .expect("answer")
    })
}

/// Largest error of the program at a place of its zero, mm.
fn expected_mm([x, y]: [f64; 2]) -> f64 {
    let error = |y: f64| 1e3 * 1e-6 * 1e3 * y.abs() * x.hypot(y) / SOFT; // N, mm, N m/rad
    error(y - 30.0).max(error(y + 50.0))
}

/// Both ends of the program are equally far off: a kink, at which no slope is zero.
#[test]
fn figure_a_kink_is_found() {
    let placed = swung(&[range(Variable::Y, -300.0, 200.0)]);
    let best = placed.best.expect("a best placement");
    let mut far = Worst::new();
    far.add(best.values["y_mm"] + 10.0);
    let name = "place: distance from the planted optimum, in a range of 500 mm";
    assert!(figure::at_most(name, far.value(), 0.02, "mm"), "{far}");
    let mut relative = Worst::new();
    relative.add(best.figure.expect("a figure") / expected_mm([600.0, -10.0]) - 1.0);
    assert!(relative.holds(1e-3), "{relative}");
    // To both sides it grows by the way that is left to the farther end.
    let room = placed.sensitivity[0];
    assert!(room.down.slope.expect("a slope") < 0.0 && room.up.slope.expect("a slope") > 0.0);
    let five = |until: Option<f64>| until.expect("not to the end");
    let mut ways = Worst::new();
    ways.add(five(room.up.until_5_percent_worse) - 2.0);
    ways.add(five(room.down.until_5_percent_worse) - 2.0);
    assert!(ways.holds(0.2), "{ways}");
    assert!(placed.findings.is_empty(), "{:?}", placed.findings);
}

/// The nearer to the axis, the better: at the end of the range, and that is said.
#[test]
fn an_optimum_at_the_end_of_a_range_is_said() {
    let placed = swung(&[
        range(Variable::X, 300.0, 900.0),
        range(Variable::Y, -200.0, 200.0),
    ]);
    let best = placed.best.expect("a best placement");
    let mut far = Worst::new();
    far.add(best.values["x_mm"] - 300.0);
    far.add(best.values["y_mm"] + 10.0);
    assert!(far.holds(0.1), "{far}");
    let kinds: Vec<&str> = placed.findings.iter().map(|f| f.kind).collect();
    assert_eq!(kinds, ["at_bound"]);
    assert!(
        placed.findings[0].message.contains("x = 300 mm"),
        "{:?}",
        placed.findings
    );
    assert_eq!(placed.next_best.len(), 10);
    let mut figures = vec![best.figure.expect("a figure")];
    figures.extend(placed.next_best.iter().map(|c| c.figure.expect("a figure")));
    assert!(figures.is_sorted(), "{figures:?}");
    let mut relative = Worst::new();
    for candidate in std::iter::once(&best).chain(&placed.next_best) {
        let at = [candidate.values["x_mm"], candidate.values["y_mm"]];
        relative.add(candidate.figure.expect("a figure") / expected_mm(at) - 1.0);
    }
    assert!(relative.holds(1e-3), "{relative}");
}

/// No place of a dense grid, each of them solved as `deflect` solves it, is better.
#[test]
fn figure_no_place_of_a_dense_grid_is_better() {
    let ranges = [
        range(Variable::X, 300.0, 900.0),
        range(Variable::Y, -200.0, 200.0),
    ];
    with_task(&swing(), ALONG_Y, along_x(1000.0), |task| {
        let space = Space::new(task.placement, ranges.to_vec(), Vec::new(), false).expect("space");
        let placed = place(
            task,
            &space,
            &Question::default(),
            Effort::default(),
            &Unwatched,
        );
        let placed = placed.expect("answer");
        let largest_mm = |fixture: usize, shares: &[f64]| {
            let mut there = task.clone();
            there.placement = space.placement(&space.at(fixture, shares));
            let run = analyse(&there, &Unwatched).expect("a run");
            run.result.summary.max_position_error_before_mm
        };
        let best = placed.best.expect("a best placement");
        let own = largest_mm(0, &space.shares(&best.place));
        let mut relative = Worst::new();
        relative.add(best.figure.expect("a figure") / own - 1.0);
        assert!(relative.holds(1e-9), "{relative}");
        const CELLS: usize = 7;
        let mut grid = f64::INFINITY;
        for i in 0..CELLS * CELLS {
            let share = |k: usize| k as f64 / (CELLS - 1) as f64;
            let there = largest_mm(0, &[share(i % CELLS), share(i / CELLS)]);
            assert!(there.is_finite());
            grid = grid.min(there);
        }
        let name =
            "place: largest error at the best by that of the best of a dense grid, soft swing";
        assert!(figure::at_most(name, own / grid, 1.0, "1"));
        // Its nearest place is 10 mm off, where 40 mm are the least that a path of 80 mm needs.
        assert!(own >= 0.75 * grid, "{own} far below {grid}");
    });
}

/// On rails that are soft along x the force to the right of the feed must be along y: the feed along x.
#[test]
fn the_part_is_turned_to_where_the_machine_is_stiff() {
    let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X40 Y30 F600\nM2\n";
    let [soft, stiff] = [1e3, 4e4];
    with_task(
        &rails([soft, stiff, stiff]),
        text,
        to_the_right(200.0),
        |task| {
            let free = vec![range(Variable::TurnZ, -80.0, 60.0)];
            let space = Space::new(task.placement, free, Vec::new(), false).expect("space");
            let placed = place(
                task,
                &space,
                &Question::default(),
                Effort::default(),
                &Unwatched,
            );
            let best = placed.expect("answer").best.expect("a best placement");
            let mut far = Worst::new();
            far.add(best.values["turn_z_deg"] + (30.0_f64 / 40.0).atan().to_degrees());
            assert!(far.holds(0.02), "{far}");
            let mut relative = Worst::new();
            relative.add(best.figure.expect("a figure") / (200.0 / stiff) - 1.0);
            assert!(relative.holds(1e-3), "{relative}");
        },
    );
}

/// On rails it is the same everywhere.
#[test]
fn that_nothing_depends_on_the_place_is_said() {
    with_task(&rails([1e4; 3]), ALONG_Y, along_x(100.0), |task| {
        let free = vec![
            range(Variable::X, 0.0, 500.0),
            range(Variable::Y, 0.0, 500.0),
        ];
        let space = Space::new(task.placement, free, Vec::new(), false).expect("space");
        let placed = place(
            task,
            &space,
            &Question::default(),
            Effort::default(),
            &Unwatched,
        );
        let kinds: Vec<&str> = placed
            .expect("answer")
            .findings
            .iter()
            .map(|f| f.kind)
            .collect();
        assert_eq!(kinds, ["flat"]);
    });
}
