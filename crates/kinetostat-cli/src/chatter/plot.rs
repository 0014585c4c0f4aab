//! The depth of the program and its limit along the path.

use kinetostat_report::{Plot, PlotLine};

use crate::chatter::answer::{ChatterAnswer, Place};

pub(crate) fn drawing(a: &ChatterAnswer) -> String {
    let line = |name: &str, colour: usize, of: &dyn Fn(&Place) -> f64| PlotLine {
        name: name.to_owned(),
        colour,
        dashed: false,
        points: steps(&a.places, of),
    };
    // Where nothing becomes unstable up to the largest depth that was looked at, that is a bound.
    let limit = |p: &Place| match p.verdict {
        "not judged" => f64::NAN,
        _ => p.limit_mm.unwrap_or(p.looked_up_to_mm),
    };
    let chatters = |p: &Place| match p.verdict {
        "chatters" => p.depth_mm,
        _ => f64::NAN,
    };
    Plot {
        title: format!("{}: depth of cut and where it chatters", a.program),
        x_label: "path, mm".into(),
        y_label: "depth of cut, mm".into(),
        lines: vec![
            line(
                "stable up to (at most 3 times the depth is looked at)",
                0,
                &limit,
            ),
            line("depth of the program", 2, &|p| p.depth_mm),
            line("chatters", 1, &chatters),
        ],
        marks: Vec::new(),
    }
    .svg()
}

/// A value holds from the first of its places to the last; the pen is lifted where the tool leaves the cut.
fn steps(places: &[Place], of: &dyn Fn(&Place) -> f64) -> Vec<(f64, f64)> {
    let mut points = Vec::with_capacity(2 * places.len());
    let mut last: Option<&Place> = None;
    for place in places {
        // Neighbours in the cut have a place in every few millimetres.
        let goes_on = last.is_some_and(|last| place.from_path_mm - last.to_path_mm < APART_MM);
        if !goes_on {
            points.push((f64::NAN, f64::NAN));
        }
        points.extend([place.from_path_mm, place.to_path_mm].map(|at| (at, of(place))));
        last = Some(place);
    }
    points
}

/// Places farther apart have air between them, or a move that nothing is known of.
const APART_MM: f64 = 10.0;
