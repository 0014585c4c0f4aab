//! The free turn of a round tool along a path: all turns that were tried over the length of the path, and the one that was chosen.

use kinetostat_machining::TurnChoice;

use crate::chart::cell::Cell;
use crate::chart::plot::PlotLine;
use crate::chart::section::Section;

/// Maximum number of columns and rows of cells; of more stations and turns those nearest to them are shown.
const MOST: usize = 360;

/// Evenly spaced numbers from the first to the last.
fn evenly(first: f64, last: f64, count: usize) -> Vec<f64> {
    let steps = count.saturating_sub(1).max(1) as f64;
    (0..count)
        .map(|k| first + (last - first) * k as f64 / steps)
        .collect()
}

/// The picture as a document.
pub(crate) fn draw(choice: &TurnChoice) -> String {
    section(choice).filled_svg()
}

/// The picture as an element for a page, which says beside it what was chosen.
pub(crate) fn element(choice: &TurnChoice) -> String {
    let section = Section {
        title: String::new(),
        ..section(choice)
    };
    section.filled_element(&title(choice))
}

fn section(choice: &TurnChoice) -> Section {
    let [Some(first), Some(last)] = [choice.stations.first(), choice.stations.last()] else {
        return Section::default();
    };
    let turns = &choice.map.turns_deg;
    let [Some(low), Some(high)] = [turns.first(), turns.last()] else {
        return Section::default();
    };
    let columns = choice.stations.len().clamp(2, MOST);
    let rows = turns.len().min(MOST);
    let x = evenly(first.way_mm, last.way_mm, columns);
    let y = evenly(*low, *high, rows);
    // Station and turn nearest to the middle of every cell.
    let station = |way_mm: &f64| {
        let after = choice.stations.partition_point(|s| s.way_mm < *way_mm);
        let before = after.saturating_sub(1);
        let far = |index: usize| {
            let station = choice.stations.get(index);
            station.map_or(f64::INFINITY, |s| (s.way_mm - way_mm).abs())
        };
        match far(after) < far(before) {
            true => after,
            false => before,
        }
    };
    let stations: Vec<usize> = x.iter().map(station).collect();
    let turn = |row: usize| (row * (turns.len() - 1) + (rows - 1) / 2) / (rows - 1).max(1);
    let cells = (0..rows).flat_map(|row| {
        let turn = turn(row);
        stations.iter().map(move |station| {
            let cells = choice.map.cells.get(*station);
            let cell = cells.and_then(|cells| cells.get(turn).copied().flatten());
            cell.map_or(Cell::Other(0), |cell| {
                Cell::Value(100.0 * (1.0 - cell.share_of_range))
            })
        })
    });
    Section {
        title: title(choice),
        x_label: "way along the path, mm".to_owned(),
        y_label: "turn about the tool's axis, deg".to_owned(),
        value_label: "distance of the nearest joint to its limit, % of half its range".to_owned(),
        cells: cells.collect(),
        others: vec!["not allowed: limit, singular or out of reach".to_owned()],
        lines: vec![chosen(choice, [*low, *high])],
        x,
        y,
        ..Section::default()
    }
}

/// The first sentence of what was chosen.
fn title(choice: &TurnChoice) -> String {
    let all = choice.description();
    all.split(". ").next().unwrap_or_default().to_owned()
}

/// The turn that was chosen, inside the band: on a whole circle the line goes on at its other end.
fn chosen(choice: &TurnChoice, [low, high]: [f64; 2]) -> PlotLine {
    let middle = 0.5 * (low + high);
    let circles = |turn: f64| 360.0 * ((turn - middle) / 360.0).round();
    let mut points = Vec::with_capacity(choice.stations.len());
    let mut last: Option<(f64, f64)> = None;
    for station in &choice.stations {
        let (at, turn) = (station.way_mm, station.turn_deg);
        let own = circles(turn);
        if let Some((way, before)) = last {
            // Draws both ends of a step across the border, each outside the picture, and nothing between them.
            if circles(before) != own {
                points.push((at, turn - circles(before)));
                points.push((f64::NAN, f64::NAN));
                points.push((way, before - own));
            } else if station.after_break {
                points.push((f64::NAN, f64::NAN));
            }
        }
        points.push((at, turn - own));
        last = Some((at, turn));
    }
    PlotLine::solid("chosen", 0, points)
}
