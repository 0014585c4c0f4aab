//! What changes nothing: the number of threads, and the order in which fixtures are named.

use kinetostat_analysis::placing::{
    Effort, Fixture, Placed, Question, Range, Space, Variable, place,
};
use kinetostat_machining::Unwatched;

use crate::placing::machine::{along_x, swing, with_task};

const ALONG_Y: &str = "G21 G90\nG0 X0 Y-30 Z0\nG1 Y50 F600\nM2\n";

#[test]
fn the_number_of_threads_changes_nothing() {
    let found = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| {
            with_task(&swing(), ALONG_Y, along_x(1000.0), |task| {
                let range = |variable, from, to| Range { variable, from, to };
                let free = vec![
                    range(Variable::X, 300.0, 900.0),
                    range(Variable::Y, -200.0, 200.0),
                    range(Variable::TurnZ, -90.0, 90.0),
                ];
                let space = Space::new(task.placement, free, Vec::new(), false).expect("space");
                let effort = Effort {
                    samples: Some(30),
                    starts: 2,
                    ..Effort::default()
                };
                place(task, &space, &Question::default(), effort, &Unwatched).expect("answer")
            })
        })
    });
    assert!(found[0].best.is_some());
    assert_eq!(found[0], found[1]);
}

fn of_fixtures(names: &[(&str, f64)]) -> Placed {
    with_task(&swing(), ALONG_Y, along_x(1000.0), |task| {
        let fixture = |(name, y): &(&str, f64)| Fixture {
            name: (*name).to_owned(),
            origin_mm: [600.0, *y, 0.0],
            orientation: None,
        };
        let fixtures = names.iter().map(fixture).collect();
        let space = Space::new(task.placement, Vec::new(), fixtures, false).expect("space");
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

/// The nearer its middle (y = 10 mm of the program) lies to y = 0, the better.
#[test]
fn fixtures_in_any_order() {
    let found = of_fixtures(&[
        ("far", -250.0),
        ("near", -15.0),
        ("right", 80.0),
        ("out", 3000.0),
    ]);
    let ranked: Vec<&str> = found
        .best
        .iter()
        .chain(&found.next_best)
        .filter_map(|c| c.fixture.as_deref())
        .collect();
    assert_eq!(ranked, ["near", "right", "far"]);
    let other = of_fixtures(&[
        ("out", 3000.0),
        ("right", 80.0),
        ("far", -250.0),
        ("near", -15.0),
    ]);
    assert_eq!(found, other);
}
