//! Maps of the figure through the best placement, as a drawing and as a table.

use kinetostat_analysis::placing::{
    Candidate, MapPanel, Place, Placed, Space, Value, Variable, Why,
};
use kinetostat_report::{Cell, Plot, PlotLine, PlotMark, Section};

use crate::placing::answer::PlaceAnswer;
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::Answer;
use crate::ui::numbers::{number, short};

fn label(variable: Variable) -> String {
    match variable {
        Variable::X | Variable::Y | Variable::Z => {
            format!("{} of the program's zero, mm", variable.words())
        }
        _ => format!("{}, {}", variable.words(), variable.unit()),
    }
}

fn figure_label(answer: &PlaceAnswer) -> String {
    let objective = answer.objective;
    match objective.unit() {
        "" => objective.what().to_owned(),
        unit => format!("{}, {unit}", objective.what()),
    }
}

/// The best placement and the next best ones, where they lie in a panel.
fn marks(placed: &Placed, space: &Space, panel: &MapPanel, curve: bool) -> Vec<PlotMark> {
    let index = |variable: Variable| space.ranges().iter().position(|r| r.variable == variable);
    let all = placed.best.iter().chain(&placed.next_best);
    let best = placed.best.as_ref();
    let same_fixture =
        |c: &&Candidate| best.is_none_or(|best| best.place.fixture == c.place.fixture);
    let mark = |(rank, c): (usize, &Candidate)| {
        let value = |k: usize| index(panel.variables[k]).map(|i| c.place.values[i]);
        let figure = c.figure.unwrap_or(f64::NAN);
        let up = match curve {
            true => figure,
            false => value(1)?,
        };
        Some(PlotMark {
            at: (value(0)?, up),
            name: match rank {
                0 => "best".to_owned(),
                _ => (rank + 1).to_string(),
            },
            detail: format!("{}: {}", rank + 1, number(figure, 4)),
        })
    };
    let ranked = all.enumerate().filter(|(_, c)| same_fixture(c));
    ranked.filter_map(mark).collect()
}

/// The drawing; none where there is nothing to draw.
pub(crate) fn drawing(answer: &PlaceAnswer, space: &Space) -> Option<String> {
    let placed = &answer.placed;
    let best = placed.best.as_ref()?;
    let title = |panel: &MapPanel| {
        let fixed = space.ranges().iter().zip(&best.place.values);
        let fixed = fixed.filter(|(range, _)| !panel.variables.contains(&range.variable));
        let fixed: Vec<String> = best
            .fixture
            .iter()
            .map(|name| format!("fixture {name}"))
            .chain(fixed.map(|(range, value)| {
                let (words, unit) = (range.variable.words(), range.variable.unit());
                format!("{words} = {} {unit}", short(*value))
            }))
            .collect();
        let at = match fixed.is_empty() {
            true => String::new(),
            false => format!(" at {}", fixed.join(", ")),
        };
        let projected = match fixed.is_empty() {
            true => "",
            false => "; the next best, numbered, lie before or behind this slice",
        };
        format!(
            "{} with {}: {}{at}{projected}",
            answer.model,
            answer.program,
            answer.objective.what()
        )
    };
    let first = placed.maps.first()?;
    if first.variables.len() == 1 {
        let figures = first.values.iter().map(|v| v.figure().unwrap_or(f64::NAN));
        return Some(
            Plot {
                title: title(first),
                x_label: label(first.variables[0]),
                y_label: figure_label(answer),
                lines: vec![PlotLine {
                    points: first.across.iter().copied().zip(figures).collect(),
                    ..PlotLine::default()
                }],
                marks: marks(placed, space, first, true),
            }
            .svg(),
        );
    }
    let section = |panel: &MapPanel| Section {
        title: title(panel),
        x_label: label(panel.variables[0]),
        y_label: label(panel.variables[1]),
        value_label: figure_label(answer),
        x: panel.across.clone(),
        y: panel.up.clone(),
        cells: panel.values.iter().map(shade).collect(),
        others: vec![
            "cannot be reached".into(),
            "limits, or another posture".into(),
            "an obstacle, or not stable".into(),
        ],
        marks: marks(placed, space, panel, false),
        interpolated: true,
        ..Section::default()
    };
    let sections: Vec<Section> = placed.maps.iter().map(section).collect();
    Some(sections[0].svg_above(&sections[1..]))
}

fn shade(value: &Value) -> Cell {
    match value {
        Value::Figure(figure) => Cell::Value(*figure),
        Value::Refused(refusal) => Cell::Other(match refusal.why {
            Why::Unreachable => 0,
            Why::OutsideLimits | Why::PostureChanges => 1,
            _ => 2,
        }),
    }
}

/// All placements that fill the ranges, and those of the maps.
pub(crate) fn table(placed: &Placed, space: &Space) -> Answer<Vec<u8>> {
    let names = space.ranges().iter().map(|range| range.variable.name());
    let head = ["kind", "fixture"].into_iter().chain(names);
    let head = head.chain(["figure", "refused"]).map(str::to_owned);
    let mut rows: Vec<Vec<String>> = vec![head.collect()];
    let mut add = |kind: &str, place: &Place, value: &Value| {
        let mut row = vec![
            kind.to_owned(),
            space.fixture_of(place).unwrap_or_default().to_owned(),
        ];
        row.extend(place.values.iter().copied().map(cell));
        row.push(cell_if_any(value.figure()));
        row.push(match value {
            Value::Figure(_) => String::new(),
            Value::Refused(refusal) => refusal.why.words().to_owned(),
        });
        rows.push(row);
    };
    for candidate in placed.best.iter().chain(&placed.next_best) {
        let figure = candidate.figure.unwrap_or(f64::NAN);
        add("best", &candidate.place, &Value::Figure(figure));
    }
    for sample in &placed.filling {
        add("filling", &sample.place, &sample.value);
    }
    for panel in &placed.maps {
        let Some(best) = &placed.best else { break };
        for (i, value) in panel.values.iter().enumerate() {
            let mut place = best.place.clone();
            let wide = panel.across.len();
            for (k, variable) in panel.variables.iter().enumerate() {
                let at = space.ranges().iter().position(|r| r.variable == *variable);
                let coordinate = match k {
                    0 => panel.across.get(i % wide),
                    _ => panel.up.get(i / wide),
                };
                if let (Some(at), Some(coordinate)) = (at, coordinate) {
                    place.values[at] = *coordinate;
                }
            }
            add("map", &place, value);
        }
    }
    written(&rows)
}
