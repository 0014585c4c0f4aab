//! What cannot be taken: obstacles, ranges out of reach, questions that make no sense.

use kinetostat_analysis::placing::{
    Effort, Fixture, Objective, Obstacle, PartBox, Placed, Question, Range, Space, SpaceError,
    Variable, Why, place,
};
use kinetostat_machining::Unwatched;
use kinetostat_testing::Worst;

use crate::placing::machine::{along_x, swing, with_task};

const ALONG_Y: &str = "G21 G90\nG0 X0 Y-30 Z0\nG1 Y50 F600\nM2\n";

fn asked(ranges: Vec<Range>, question: &Question) -> Placed {
    with_task(&swing(), ALONG_Y, along_x(1000.0), |task| {
        let space = Space::new(task.placement, ranges, Vec::new(), false).expect("space");
        place(task, &space, question, Effort::default(), &Unwatched).expect("answer")
    })
}

fn along_y() -> Vec<Range> {
    let (variable, from, to) = (Variable::Y, -300.0, 200.0);
    vec![Range { variable, from, to }]
}

fn wall(from_y: f64, to_y: f64) -> Obstacle {
    Obstacle {
        name: "wall".to_owned(),
        from_mm: [500.0, from_y, -10.0],
        to_mm: [700.0, to_y, 10.0],
    }
}

/// Without the wall the zero would lie at y = -10 mm, and the path from -40 to 40 mm.
#[test]
fn an_obstacle_pushes_the_part_aside() {
    let mut question = Question {
        obstacles: vec![wall(-100.0, 5.0)],
        ..Question::default()
    };
    let placed = asked(along_y(), &question);
    let best = placed.best.expect("a best placement");
    let mut far = Worst::new();
    far.add(best.values["y_mm"] - 35.0);
    assert!(far.holds(0.1), "{far}");
    let middle = placed.centre.refusal.expect("refused");
    assert_eq!(middle.why, Why::Obstacle);
    assert!(middle.message.contains("wall"), "{middle:?}");
    // A part that is longer than its path needs more room.
    question.part = Some(PartBox {
        from_mm: [-10.0, -45.0, -5.0],
        to_mm: [10.0, 60.0, 0.0],
    });
    let best = asked(along_y(), &question).best.expect("a best placement");
    let mut far = Worst::new();
    far.add(best.values["y_mm"] - 50.0);
    assert!(far.holds(0.1), "{far}");
}

#[test]
fn ranges_out_of_reach_name_the_nearest_and_the_way_back() {
    // The rail ends at 1200 mm.
    let (variable, from, to) = (Variable::X, 1500.0, 2500.0);
    let placed = asked(vec![Range { variable, from, to }], &Question::default());
    assert!(placed.best.is_none() && placed.next_best.is_empty());
    let nowhere = placed.nowhere.expect("said");
    let mut far = Worst::new();
    far.add(nowhere.nearest.values["x_mm"] - 1500.0);
    assert!(far.holds(1.0), "{far}");
    let why = nowhere.nearest.refusal.expect("refused");
    assert_eq!(why.why, Why::OutsideLimits, "{why:?}");
    let [x, _, _] = nowhere.move_mm.expect("a way back");
    let reach = 1500.0 + x;
    assert!((1150.0..=1200.0).contains(&reach), "moved by {x} mm");
}

#[test]
fn a_figure_that_the_model_does_not_tell_is_said() {
    let question = Question {
        objective: Objective::Drive,
        ..Question::default()
    };
    let nowhere = asked(along_y(), &question).nowhere.expect("said");
    let refusal = nowhere.nearest.refusal.expect("refused");
    assert_eq!(refusal.why, Why::NoFigure);
    assert!(refusal.message.contains("rating"), "{refusal:?}");
}

#[test]
fn spaces_without_sense_are_refused() {
    with_task(&swing(), ALONG_Y, along_x(1000.0), |task| {
        let space = |ranges: &[(Variable, f64, f64)], fixtures: &[&str], states: bool| {
            let range = |&(variable, from, to): &(Variable, f64, f64)| Range { variable, from, to };
            let fixture = |name: &&str| Fixture {
                name: (*name).to_owned(),
                origin_mm: [600.0, 0.0, 0.0],
                orientation: None,
            };
            let ranges = ranges.iter().map(range).collect();
            let fixtures = fixtures.iter().map(fixture).collect();
            Space::new(task.placement, ranges, fixtures, states).err()
        };
        assert_eq!(space(&[], &[], false), Some(SpaceError::NothingFree));
        let empty = space(&[(Variable::X, 1.0, 1.0)], &[], false);
        assert!(
            matches!(empty, Some(SpaceError::NoRange { .. })),
            "{empty:?}"
        );
        let nan = space(&[(Variable::X, f64::NAN, 1.0)], &[], false);
        assert!(matches!(nan, Some(SpaceError::NoRange { .. })), "{nan:?}");
        let x = (Variable::X, 0.0, 1.0);
        assert_eq!(space(&[x, x], &[], false), Some(SpaceError::Twice("x_mm")));
        assert_eq!(
            space(&[x], &["a"], false),
            Some(SpaceError::BesideFixtures("x_mm"))
        );
        let twice = space(&[], &["a", "a"], false);
        assert_eq!(twice, Some(SpaceError::SameName("a".to_owned())));
        let turned = space(&[(Variable::TurnTool, -180.0, 180.0)], &[], true);
        assert_eq!(turned, Some(SpaceError::StatedOrientation));
        assert_eq!(space(&[x], &[], true), None);
    });
}
