//! The grid gone through: the table is written, figures and picture are gathered.

use kinetostat_machining::{MapPlace, MapTask, map};
use kinetostat_report::Cell;

use crate::files::outputs::Outputs;
use crate::map::answer::Figures;
use crate::map::columns::Column;
use crate::map::fields::Gathering;
use crate::map::picture::Picture;
use crate::map::store::{self, Store};
use crate::map::text::{self, Columns};
use crate::ui::failure::Answer;
use crate::ui::progress::Progress;

/// Receivers of the places as they are solved.
pub(crate) struct Sinks<'a> {
    pub(crate) outputs: &'a mut Outputs,
    pub(crate) csv: Option<usize>,
    pub(crate) store: Option<Store>,
    pub(crate) gathering: Option<Gathering>,
    pub(crate) further: Vec<Column>,
}

/// Results of a block of places, on any thread.
struct Block {
    figures: Figures,
    lines: Option<String>,
    cells: Vec<(usize, Cell)>,
    rows: Vec<u8>,
    places: Vec<MapPlace>,
}

/// Goes through the grid: the table is written, figures and picture are gathered.
pub(crate) fn solve(
    task: &mut MapTask<'_>,
    sinks: &mut Sinks<'_>,
    mut picture: Picture,
) -> Answer<(Figures, Picture)> {
    let columns = Columns {
        loaded: task.load.is_some(),
        follows: task.orientation_follows,
    };
    let csv = sinks.csv;
    if let Some(index) = csv {
        let header = text::header(columns, &sinks.further);
        sinks.outputs.append(index, header.as_bytes())?;
    }
    let mut figures = Figures::default();
    let progress = Progress::new();
    let shown = picture.clone();
    let (size, further) = (task.mechanism.size(), sinks.further.len());
    let (kept, gathered) = (sinks.store.is_some(), sinks.gathering.is_some());
    let block = |places: &[MapPlace], kept: bool| Block {
        figures: Figures::of(places, size, further),
        lines: csv.map(|_| text::lines(places, columns)),
        cells: places.iter().filter_map(|p| shown.cell(p)).collect(),
        rows: if kept {
            store::rows(places)
        } else {
            Vec::new()
        },
        places: if gathered {
            places.to_vec()
        } else {
            Vec::new()
        },
    };
    let mut put = |own: Block, sinks: &mut Sinks<'_>| -> Answer<()> {
        figures.add(&own.figures);
        for (at, cell) in own.cells {
            picture.cells[at] = cell;
        }
        if let Some(gathering) = &mut sinks.gathering {
            own.places.iter().for_each(|place| gathering.take(place));
        }
        if let Some(store) = &mut sinks.store {
            store.keep(&own.rows)?;
        }
        match (csv, own.lines) {
            (Some(index), Some(lines)) => sinks.outputs.append(index, lines.as_bytes()),
            _ => Ok(()),
        }
    };
    if let Some(mut store) = sinks.store.take() {
        store.replay(&task.grid, |places| put(block(places, false), sinks))?;
        task.first = store.known;
        sinks.store = Some(store);
    }
    map(
        task,
        &progress,
        |places| block(places, kept),
        |own| put(own, sinks),
    )?;
    progress.finish();
    if let Some(index) = csv {
        sinks.outputs.complete(index)?;
    }
    Ok((figures, picture))
}
