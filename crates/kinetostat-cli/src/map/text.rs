//! A map as a table and in words.

use std::fmt::Write as _;

use kinetostat_machining::number::counted;
use kinetostat_machining::{MapPlace, PlaceState};

use crate::map::answer::{Extreme, FigureAnswer, MapAnswer};
use crate::map::columns::Column;
use crate::place::orientation;
use crate::ui::csv_cell::{decimals, digits};
use crate::ui::layout::{columns, wrapped};
use crate::ui::numbers::{load_triple, number, short, triple};
use crate::ui::warnings;

/// Columns of a table besides stiffness.
#[derive(Clone, Copy)]
pub(crate) struct Columns {
    pub(crate) loaded: bool,
    pub(crate) follows: bool,
}

/// First line of the table.
pub(crate) fn header(columns: Columns, further: &[Column]) -> String {
    let mut out = String::from(
        "x_mm,y_mm,z_mm,smallest_stiffness_n_per_mm,stiffness_x_n_per_mm,stiffness_y_n_per_mm,stiffness_z_n_per_mm",
    );
    if columns.follows {
        out.push_str(",tool_turn_deg");
    }
    if columns.loaded {
        out.push_str(",dx_mm,dy_mm,dz_mm,rx_deg,ry_deg,rz_deg");
    }
    for column in further {
        let _ = write!(out, ",{}", column.head());
    }
    out.push_str(",status\n");
    out
}

/// One line for each place; a number that does not exist is an empty cell. Digits as in the table of points:
/// 100 nm for places, 1 nm for displacements, 1e-5 deg, five digits of a stiffness.
pub(crate) fn lines(places: &[MapPlace], columns: Columns) -> String {
    let mut out = String::with_capacity(100 * places.len());
    for place in places {
        let mut cell = |text: String| {
            out.push_str(&text);
            out.push(',');
        };
        let all = |values: &[f64; 3], most: usize| values.map(|x| decimals(x, most));
        all(&place.position_mm, 4).into_iter().for_each(&mut cell);
        cell(stiffness(place.smallest_stiffness_n_per_mm));
        place
            .stiffness_n_per_mm
            .map(stiffness)
            .into_iter()
            .for_each(&mut cell);
        if columns.follows {
            cell(decimals(place.tool_turn_deg, 5));
        }
        if columns.loaded {
            all(&place.displacement_mm, 6)
                .into_iter()
                .for_each(&mut cell);
            all(&place.rotation_deg, 5).into_iter().for_each(&mut cell);
        }
        for value in &place.values {
            match value.is_nan() {
                true => out.push(','),
                // All digits: it is read back as the same number.
                false => {
                    let _ = write!(out, "{value:?},");
                }
            }
        }
        out.push_str(status(place.state));
        out.push('\n');
    }
    out
}

/// A rigid direction has a stiffness: it is infinite.
fn stiffness(value: f64) -> String {
    match value == f64::INFINITY {
        true => "inf".to_owned(),
        false => digits(value, 5),
    }
}

pub(crate) fn status(state: PlaceState) -> &'static str {
    match state {
        PlaceState::Regular => "ok",
        PlaceState::Singular => "singular",
        PlaceState::Unstable => "unstable",
        PlaceState::OutsideLimits => "outside limits",
        PlaceState::Unreachable => "unreachable",
        PlaceState::Unanswered => "no answer",
    }
}

pub(crate) fn answer_text(a: &MapAnswer, rotation: &nalgebra::UnitQuaternion<f64>) -> String {
    let mut out = wrapped(
        &format!(
            "{} ({}), {}, tool {}",
            a.model,
            a.model_source,
            counted(a.places.requested, "place"),
            orientation::description(rotation)
        ),
        0,
    );
    for (k, name) in ["x", "y", "z"].iter().enumerate() {
        let (from, to) = (short(a.grid.from_mm[k]), short(a.grid.to_mm[k]));
        let _ = match a.grid.places[k] {
            1 => writeln!(out, "  {name} at {from} mm"),
            n => writeln!(out, "  {name} from {from} to {to} mm in {n} places"),
        };
    }
    if !a.tool.starts_with("none") {
        out.push_str(&wrapped(&format!("tool: {}", a.tool), 0));
    }
    a.deviations
        .iter()
        .for_each(|d| out.push_str(&wrapped(d, 0)));
    out.push('\n');
    out.push_str(&wrapped(
        &if a.cases > 1 {
            format!(
                "The worst of {} orientations and loads at every place; a place counts as what is worst there. Stiffness is what a further small force on the tip would meet while the tool may turn.",
                a.cases
            )
        } else if a.loaded {
            format!(
                "Under the force {} N and the moment {} N m on the tool, with weights, preloads and deviations. Stiffness is what a further small force on the tip would meet while the tool may turn; displacement is from where the tool is commanded.",
                load_triple(a.force_n),
                load_triple(a.moment_n_m)
            )
        } else {
            "Stiffness of the unloaded machine as drawn against a force on the tip, by the motion along it while the tool may turn (weights, preloads and deviations left out; give --force for the loaded one).".to_owned()
        },
        0,
    ));
    out.push('\n');
    out.push_str(&figures(a));
    out.push_str("\nPlaces\n");
    out.push_str(&places(a));
    for sentence in a.solving.sentences("place") {
        out.push_str(&wrapped(&sentence, 2));
    }
    out.push_str(&warnings::warnings(&a.warnings));
    out
}

fn figures(a: &MapAnswer) -> String {
    let mut rows = vec![
        ["", "least", "at (x, y, z), mm", "mean", "most", "at"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for figure in &a.figures {
        rows.push(row(figure));
    }
    columns(&rows, 2)
}

fn row(figure: &FigureAnswer) -> Vec<String> {
    let name = match &*figure.name {
        "smallest_stiffness_n_per_mm" => "smallest, N/mm",
        "stiffness_x_n_per_mm" => "along x, N/mm",
        "stiffness_y_n_per_mm" => "along y, N/mm",
        "stiffness_z_n_per_mm" => "along z, N/mm",
        "displacement_mm" => "moved, mm",
        "rotation_deg" => "turned, deg",
        other => &format!("{other}, {}", figure.unit),
    };
    let value = |e: &Option<Extreme>| {
        e.as_ref()
            .map_or_else(|| "-".to_owned(), |e| number(e.value, 4))
    };
    let place = |e: &Option<Extreme>| {
        e.as_ref()
            .map_or_else(String::new, |e| triple(e.position_mm, shorter))
    };
    let mean = figure.mean.map_or_else(|| "-".to_owned(), |x| number(x, 4));
    vec![
        name.to_owned(),
        value(&figure.least),
        place(&figure.least),
        mean,
        value(&figure.most),
        place(&figure.most),
    ]
}

/// A tenth of a millimetre is enough to find a place.
fn shorter(value: f64) -> String {
    let text = crate::ui::numbers::fixed(value, 1);
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

fn places(a: &MapAnswer) -> String {
    let p = &a.places;
    let list = [
        (p.regular, if a.loaded { "stable" } else { "regular" }),
        (
            p.singular,
            "singular: a direction of the tool has no stiffness",
        ),
        (
            p.unstable,
            "NOT STABLE: the machine would jump to another shape",
        ),
        (p.outside_limits, "outside the limits of an actuator"),
        (p.unreachable, "cannot be reached with this orientation"),
        (
            p.no_answer,
            "without an equilibrium: the load may be too large",
        ),
    ];
    let width = p.requested.to_string().len();
    let mut out = String::new();
    for (count, what) in list.into_iter().filter(|(count, _)| *count > 0) {
        let _ = writeln!(out, "  {count:>width$}  {what}");
    }
    out
}
