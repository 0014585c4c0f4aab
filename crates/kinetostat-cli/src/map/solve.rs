//! The grid gone through: the table is written, figures and picture are gathered.

use kinetostat_machining::{MapPlace, MapTask, map};
use kinetostat_report::Cell;

use crate::files::outputs::Outputs;
use crate::map::answer::Figures;
use crate::map::picture::Picture;
use crate::map::text::{self, Columns};
use crate::ui::failure::{Answer, Failure};
use crate::ui::progress::Progress;

/// Goes through the grid: the table is written, figures and picture are gathered.
pub(crate) fn solve(
    task: &MapTask<'_>,
    outputs: &mut Outputs,
    csv: Option<usize>,
    mut picture: Picture,
) -> Answer<(Figures, Picture)> {
    let columns = Columns {
        loaded: task.load.is_some(),
        follows: task.orientation_follows,
    };
    if let Some(index) = csv {
        outputs.append(index, text::header(columns).as_bytes())?;
    }
    let mut figures = Figures::default();
    let progress = Progress::new();
    let shown = picture.clone();
    let block = |places: &[MapPlace]| {
        let lines = csv.map(|_| text::lines(places, columns));
        let cells: Vec<(usize, Cell)> = places.iter().filter_map(|p| shown.cell(p)).collect();
        (Figures::of(places, task.mechanism.size()), lines, cells)
    };
    map(task, &progress, block, |(own, lines, cells)| {
        figures.add(&own);
        for (at, cell) in cells {
            picture.cells[at] = cell;
        }
        match (csv, lines) {
            (Some(index), Some(lines)) => outputs.append(index, lines.as_bytes()),
            _ => Ok::<(), Failure>(()),
        }
    })?;
    progress.finish();
    if let Some(index) = csv {
        outputs.complete(index)?;
    }
    Ok((figures, picture))
}
