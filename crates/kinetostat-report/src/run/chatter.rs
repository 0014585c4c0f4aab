//! Chatter of a program, and forced vibrations of the tool where it is stable.

use kinetostat_machining::{ChatterLines, ChatterPlace, ChatterResult};
use minijinja::{Value, context};

use crate::chart::plot::{Plot, PlotLine};
use crate::number::{self, MISSING, Rounding};
use crate::run::Shown;
use crate::text;

/// Maximum number of stretches shown; more are in the result file.
pub(crate) const MOST: usize = 20;

/// Places farther apart have air between them, or a move that nothing is known of, mm.
const APART_MM: f64 = 10.0;

/// The section's content; nothing where chatter was not judged.
pub(crate) fn section(result: &Shown<'_>) -> Value {
    let Some(chatter) = &result.chatter else {
        return Value::from(());
    };
    let sentences = [
        Some(chatter.verdict_text()),
        chatter.nearest_text(),
        chatter.vibration_text(),
    ];
    let figure = match chatter.places.is_empty() {
        true => Value::from(()),
        false => Value::from_safe_string(depths("", chatter).element()),
    };
    let rows: Vec<Value> = chatter.stretches.iter().take(MOST).map(row).collect();
    context! {
        damping => text::clean(&chatter.damping),
        sentences => sentences.into_iter().flatten().map(|text| in_type(&text)).collect::<Vec<_>>(),
        left_out => chatter.stretches.len() - rows.len(),
        figure,
        rows,
    }
}

/// A sentence with its unit of micrometres in type.
fn in_type(text: &str) -> String {
    text.replace(" um ", "\u{202f}µm ")
}

fn row(stretch: &ChatterLines) -> Value {
    let [lines, rpm, depth, stable, chatter, other] = cells(stretch);
    context! { lines, rpm, depth, stable, chatter, other }
}

/// Cells of a stretch: lines, speed, depth, stable depth, frequency, stable speed; numbers in type, without units.
pub(crate) fn cells(stretch: &ChatterLines) -> [String; 6] {
    let digits = |value, digits| number::significant(value, digits, Rounding::Nearest);
    // A speed without room is no advice for a page.
    let with_room = stretch
        .stable_rpm
        .filter(|_| !stretch.stable_speed_is_narrow);
    let [first, last] = stretch.lines.map(number::count);
    [
        match first == last {
            true => first,
            false => format!("{first} … {last}"),
        },
        digits(stretch.rpm, 4),
        digits(stretch.depth_mm, 3),
        digits(stretch.stable_depth_mm, 3),
        digits(stretch.chatter_hz, 3),
        // Adds the feed that keeps the feed per tooth.
        match (with_room, stretch.stable_feed_mm_per_min) {
            (None, _) => MISSING.to_owned(),
            (Some(rpm), Some(feed)) => format!("{} (F {})", digits(rpm, 4), digits(feed, 4)),
            (Some(rpm), None) => format!(
                "{} (F \u{d7} {})",
                digits(rpm, 4),
                digits(rpm / stretch.rpm, 3)
            ),
        },
    ]
}

/// Depth and limit along the path, and below them the vibration that the teeth force, as a document.
pub(crate) fn draw(program: &str, chatter: &ChatterResult) -> String {
    let depths = depths(
        &format!("{program}: depth of cut and where it chatters"),
        chatter,
    );
    if chatter.most_shaken.is_none() {
        return depths.svg();
    }
    let line = |name: &str, colour: usize, of: &dyn Fn(&ChatterPlace) -> Option<f64>| {
        PlotLine::solid(
            name,
            colour,
            steps(&chatter.places, &|p| of(p).unwrap_or(f64::NAN)),
        )
    };
    let vibration = Plot {
        title: "vibration that the passing teeth force, where it does not chatter".to_owned(),
        x_label: "path, mm".into(),
        y_label: "um".into(),
        lines: vec![
            zero(chatter),
            line("of the tip (rms)", 0, &|p| p.vibration_rms_um),
            line("left on the wall, positive too deep", 1, &|p| p.wall_um),
        ],
        marks: Vec::new(),
    };
    depths.svg_above(&[vibration])
}

/// The depth of the program and its limit along the path.
fn depths(title: &str, chatter: &ChatterResult) -> Plot {
    let line = |name: &str, colour: usize, of: &dyn Fn(&ChatterPlace) -> f64| {
        PlotLine::solid(name, colour, steps(&chatter.places, of))
    };
    // If nothing becomes unstable up to the largest searched depth, that is a bound.
    let limit = |p: &ChatterPlace| match p.chatters {
        None => f64::NAN,
        Some(_) => p.limit_mm.unwrap_or(p.looked_up_to_mm),
    };
    let chatters = |p: &ChatterPlace| match p.chatters {
        Some(true) => p.depth_mm,
        _ => f64::NAN,
    };
    Plot {
        title: title.to_owned(),
        x_label: "path, mm".into(),
        y_label: "depth of cut, mm".into(),
        lines: vec![
            zero(chatter),
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
}

/// Zero all along the cut, so that pictures one above the other have the same axis.
fn zero(chatter: &ChatterResult) -> PlotLine {
    let ends = [chatter.places.first(), chatter.places.last()];
    let at = ends.iter().flatten().zip([0, 1]);
    PlotLine {
        colour: 5,
        dashed: true,
        points: at.map(|(place, end)| (place.path_mm[end], 0.0)).collect(),
        ..PlotLine::default()
    }
}

/// A value holds from the first of its places to the last; the pen is lifted where the tool leaves the cut.
fn steps(places: &[ChatterPlace], of: &dyn Fn(&ChatterPlace) -> f64) -> Vec<(f64, f64)> {
    let mut points = Vec::with_capacity(2 * places.len());
    let mut last: Option<&ChatterPlace> = None;
    for place in places {
        // Neighbours in the cut have a place in every few millimetres.
        let goes_on = last.is_some_and(|last| place.path_mm[0] - last.path_mm[1] < APART_MM);
        if !goes_on {
            points.push((f64::NAN, f64::NAN));
        }
        points.extend(place.path_mm.map(|at| (at, of(place))));
        last = Some(place);
    }
    points
}
