//! A heavy arm of the library, which bends under its own weight besides the force of the cut: no closed form, but a dense grid.

use kinetostat::Pose;
use kinetostat_analysis::placing::{Effort, Question, Range, Space, Variable, place};
use kinetostat_machining::{Placement, Unwatched, analyse};
use kinetostat_model::Model;
use kinetostat_testing::Worst;
use nalgebra::Vector3;

use crate::placing::machine::{to_the_right, with_task};

/// Few moves, in no symmetry to its zero.
const PLATE: &str = "G21 G90\nG0 X0 Y0 Z20\nG1 Z-2 F600\nG1 X120\nG1 Y90\nG0 Z20\nM30\n";

/// No place of a dense grid, each solved as `deflect` solves it, is better than the best that is found, and the best is no better than
/// the places around it let expect.
#[test]
fn no_place_of_a_dense_grid_is_better_for_a_heavy_arm() {
    let model = Model::preset("heavy_6r").expect("a preset");
    let tool = Pose::translation(0.0, 0.0, 0.2);
    let mechanism = model.mechanism.with_tool(&tool);
    let standing = mechanism.platforms()[mechanism.tool()].home.rotation;
    let ranges = vec![
        Range {
            variable: Variable::X,
            from: 1200.0,
            to: 1700.0,
        },
        Range {
            variable: Variable::Y,
            from: -300.0,
            to: 400.0,
        },
    ];
    with_task(&mechanism, PLATE, to_the_right(215.0), |task| {
        let mut task = task.clone();
        task.placement = Placement::at(Vector3::new(1.4, 0.07, 0.5));
        task.placement.tool_orientation = standing;
        let space = Space::new(task.placement, ranges, Vec::new(), false).expect("space");
        let placed = place(
            &task,
            &space,
            &Question::default(),
            Effort {
                samples: Some(100),
                maps: false,
                ..Effort::default()
            },
            &Unwatched,
        );
        let placed = placed.expect("answer");
        let largest_mm = |shares: &[f64]| {
            let mut there = task.clone();
            there.placement = space.placement(&space.at(0, shares));
            let run = analyse(&there, &Unwatched).ok()?;
            Some(run.result.summary.max_position_error_before_mm)
        };
        let best = placed.best.expect("a best placement");
        let own = largest_mm(&space.shares(&best.place)).expect("it is reached");
        let mut relative = Worst::new();
        relative.add(best.figure.expect("a figure") / own - 1.0);
        assert!(relative.holds(1e-9), "{relative}");
        const CELLS: usize = 9;
        let share = |k: usize| k as f64 / (CELLS - 1) as f64;
        let places = (0..CELLS * CELLS).map(|i| [share(i % CELLS), share(i / CELLS)]);
        let figures: Vec<f64> = places.filter_map(|shares| largest_mm(&shares)).collect();
        assert!(
            figures.len() > CELLS * CELLS / 2,
            "{} reached",
            figures.len()
        );
        assert!(figures.iter().all(|figure| figure.is_finite()));
        let least = figures.iter().copied().min_by(f64::total_cmp);
        let least = least.expect("a place");
        eprintln!(
            "best {own} mm, of the grid {least} mm, {} places",
            figures.len()
        );
        assert!(own <= least, "{own} above {least} of the grid");
        // Cells are 63 by 88 mm: the figure changes by less than a tenth over one.
        assert!(own >= 0.9 * least, "{own} far below {least}");
    });
}
