//! The difference of two designs over a common grid.

use kinetostat::Mechanism;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Grid, MapPlace, MapTask, PlaceState, map};
use kinetostat_report::{Cell, Plot, PlotLine, Section};

use crate::compare::answer::{Compared, Summary};
use crate::compare::arguments::CompareArgs;
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::numbers::short;
use crate::ui::progress::Progress;

/// Both are kept in memory.
const MOST_PLACES: f64 = 2e6;

const AXES: [&str; 3] = ["x", "y", "z"];

/// The grid that is requested, through A's home in the other axes.
pub(crate) fn grid(args: &CompareArgs, home_mm: [f64; 3]) -> Answer<Option<Grid>> {
    let mut grid = Grid {
        from_mm: home_mm,
        to_mm: home_mm,
        counts: [1; 3],
    };
    if let [at] = args.at.chunks(3).collect::<Vec<_>>()[..] {
        for k in 0..3 {
            (grid.from_mm[k], grid.to_mm[k]) = (at[k], at[k]);
        }
    }
    let mut all = 1.0;
    for (k, values) in [&args.x, &args.y, &args.z].into_iter().enumerate() {
        let Some(values) = values else { continue };
        let (from, to, count) = (values[0], values[1], values[2]);
        all *= count;
        if count.fract() != 0.0 || count < 2.0 || from == to || all > MOST_PLACES {
            return Err(ErrorCode::Value.failure(format!(
                    "--{} {from} {to} {count}: write from, to (mm) and a whole number of places, 2 or more and {MOST_PLACES} in all at most",
                    AXES[k]
                ),
            ));
        }
        if from.abs().max(to.abs()) > 1e7 {
            return Err(ErrorCode::Value.failure(format!(
                "--{} leads more than 10 km away; coordinates are in mm",
                AXES[k]
            )));
        }
        (grid.from_mm[k], grid.to_mm[k], grid.counts[k]) = (from, to, count as usize);
    }
    Ok((all > 1.0).then_some(grid))
}

/// Comparison of both designs at every place.
pub(crate) struct Difference {
    grid: Grid,
    a: Vec<MapPlace>,
    b: Vec<MapPlace>,
    pub(crate) summary: Summary,
}

fn places(mechanism: &Mechanism, grid: Grid) -> Answer<Vec<MapPlace>> {
    let task = MapTask {
        mechanism,
        grid,
        orientation: mechanism.platforms()[mechanism.tool()].home.rotation,
        orientation_follows: mechanism.turns_as_it_moves(),
        load: None,
        further: Vec::new(),
        variables: Vec::new(),
        ratings: Vec::new(),
        first: 0,
    };
    let progress = Progress::new();
    let mut all = Vec::with_capacity(grid.len());
    map(&task, &progress, <[MapPlace]>::to_vec, |own| {
        all.extend(own);
        Ok::<(), Failure>(())
    })?;
    progress.finish();
    Ok(all)
}

/// A stiffness, where there is one.
fn stiffness(place: &MapPlace) -> Option<f64> {
    let answered = matches!(place.state, PlaceState::Regular | PlaceState::Singular);
    Some(place.smallest_stiffness_n_per_mm).filter(|k| answered && k.is_finite())
}

fn ratio(a: &MapPlace, b: &MapPlace) -> Option<f64> {
    let (a, b) = stiffness(a).zip(stiffness(b))?;
    (a > 0.0).then(|| b / a)
}

/// Solves both.
pub(crate) fn difference(a: &Mechanism, b: &Mechanism, grid: Grid) -> Answer<Difference> {
    let (of_a, of_b) = (places(a, grid)?, places(b, grid)?);
    let both = || of_a.iter().zip(&of_b);
    let ratios: Vec<(f64, [f64; 3])> = both()
        .filter_map(|(x, y)| Some((ratio(x, y)?, x.position_mm)))
        .collect();
    let least = ratios.iter().min_by(|x, y| x.0.total_cmp(&y.0));
    let most = ratios.iter().max_by(|x, y| x.0.total_cmp(&y.0));
    let (Some(least), Some(most)) = (least, most) else {
        return Err(ErrorCode::NoAnswer.failure(format!(
            "no place of the grid is reached by both, {} and {}",
            a.name(),
            b.name()
        )));
    };
    let count = ratios.len() as f64;
    let only = |x: &MapPlace, y: &MapPlace| stiffness(x).is_some() && stiffness(y).is_none();
    let summary = Summary {
        places: grid.len(),
        common: ratios.len(),
        only_a: both().filter(|(x, y)| only(x, y)).count(),
        only_b: both().filter(|(x, y)| only(y, x)).count(),
        b_stiffer_share: ratios.iter().filter(|r| r.0 > 1.0).count() as f64 / count,
        mean_ratio: ratios.iter().map(|r| r.0).sum::<f64>() / count,
        least_ratio: least.0,
        least_at_mm: least.1,
        most_ratio: most.0,
        most_at_mm: most.1,
    };
    Ok(Difference {
        grid,
        a: of_a,
        b: of_b,
        summary,
    })
}

impl Difference {
    pub(crate) fn csv(&self) -> Answer<Vec<u8>> {
        let mut header: Vec<String> = ["x_mm", "y_mm", "z_mm"].map(str::to_owned).to_vec();
        for what in [
            "smallest_stiffness",
            "stiffness_x",
            "stiffness_y",
            "stiffness_z",
        ] {
            header.extend(["a", "b"].map(|of| format!("{what}_{of}_n_per_mm")));
        }
        header.push("smallest_stiffness_ratio_b_by_a".to_owned());
        let mut rows = vec![header];
        for (a, b) in self.a.iter().zip(&self.b) {
            let mut row: Vec<String> = a.position_mm.iter().map(|x| cell(*x)).collect();
            let value = |p: &MapPlace, x: f64| stiffness(p).map_or_else(String::new, |_| cell(x));
            row.push(value(a, a.smallest_stiffness_n_per_mm));
            row.push(value(b, b.smallest_stiffness_n_per_mm));
            for k in 0..3 {
                row.push(value(a, a.stiffness_n_per_mm[k]));
                row.push(value(b, b.stiffness_n_per_mm[k]));
            }
            row.push(cell_if_any(ratio(a, b)));
            rows.push(row);
        }
        written(&rows)
    }

    /// Draws the ratio of the stiffnesses B to A over the two longest axes of the grid, in the middle of the third.
    pub(crate) fn svg(&self, answer: &Compared) -> String {
        let counts = self.grid.counts;
        let across = (0..3).rev().min_by_key(|k| counts[*k]).unwrap_or(2);
        let middle = (counts[across] - 1) / 2;
        let axes: Vec<usize> = (0..3).filter(|k| *k != across).collect();
        let in_section = |p: &MapPlace| p.index[across] == middle;
        let pairs = self.a.iter().zip(&self.b).filter(|(a, _)| in_section(a));
        let cells: Vec<Cell> = pairs
            .map(|(a, b)| match (ratio(a, b), stiffness(a), stiffness(b)) {
                (Some(r), _, _) => Cell::Value(100.0 * (r - 1.0)),
                (None, Some(_), None) => Cell::Other(0),
                (None, None, Some(_)) => Cell::Other(1),
                _ => Cell::Other(2),
            })
            .collect();
        let along = |k: usize| -> Vec<f64> {
            let places = 0..counts[axes[k]];
            places.map(|i| self.grid.position_mm(axes[k], i)).collect()
        };
        let at = self.grid.position_mm(across, middle);
        let title = format!(
            "{} against {}: how much stiffer the second is in its softest direction, at {} = {} mm",
            answer.b,
            answer.a,
            AXES[across],
            short(at)
        );
        let label = |k: usize| format!("{}, mm", AXES[axes[k]]);
        let value_label = "stiffness of the second more by, %".to_owned();
        if let Some(single) = (0..2).find(|k| counts[axes[*k]] == 1) {
            let values = cells.iter().map(|c| match c {
                Cell::Value(x) => *x,
                _ => f64::NAN,
            });
            let line = PlotLine {
                points: along(1 - single).into_iter().zip(values).collect(),
                ..PlotLine::default()
            };
            let plot = Plot {
                title,
                x_label: label(1 - single),
                y_label: value_label,
                lines: vec![line],
                marks: Vec::new(),
            };
            return plot.svg();
        }
        let section = Section {
            title,
            x_label: label(0),
            y_label: label(1),
            value_label,
            x: along(0),
            y: along(1),
            cells,
            others: [
                "only the first reaches",
                "only the second reaches",
                "none reaches",
            ]
            .map(str::to_owned)
            .to_vec(),
            interpolated: true,
            parted_at: Some(0.0),
            ..Section::default()
        };
        section.svg()
    }
}
