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

/// A value holds from its place to the next one.
fn steps(places: &[Place], of: &dyn Fn(&Place) -> f64) -> Vec<(f64, f64)> {
    let mut points = Vec::with_capacity(2 * places.len());
    for (i, place) in places.iter().enumerate() {
        let until = places.get(i + 1).map_or(place.path_mm, |next| next.path_mm);
        points.extend([(place.path_mm, of(place)), (until, of(place))]);
    }
    points
}
