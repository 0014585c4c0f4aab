//! The stock of a job.

use kinetostat_cutting::{CutError, Stock, StockSettings, Tool};
use serde_spanned::Spanned;

use crate::files::input_files::InputFiles;
use crate::job::cut::files_of_cut::FilesOfCut;
use crate::job::cut::refused::refused;
use crate::job::cut_tables::StockTable;
use crate::job::job_file::JobFile;
use crate::ui::failure::Answer;
use crate::ui::numbers::{given, short};

/// Largest cell, as a share of the tool's diameter: forces in coarser ones are off by percents and more.
const COARSEST: f64 = 0.1 + 1e-9;

/// Smallest cell, as a share of the diameter of the largest tool: a rim of thousands of cells takes minutes and shows no more.
const FINEST: f64 = 1e-3;

/// The stock, and its resolution in words, for tools from the smallest to the largest diameter.
pub(super) fn stock(
    files: &InputFiles,
    job: &JobFile,
    table: &Spanned<StockTable>,
    (smallest, largest): (&Tool, &Tool),
    files_read: &mut FilesOfCut,
) -> Answer<(Stock, String)> {
    let wrong = |error: CutError| refused(job, table, &error);
    let t = table.get_ref();
    let finest = FINEST * largest.diameter_mm();
    if let Some(cell) = &t.cell_mm
        && *cell.get_ref() < finest
    {
        return Err(job.error(
            cell,
            &format!(
                "cells of {} mm are finer than a thousandth of the tool's diameter of {} mm",
                given(*cell.get_ref()),
                short(largest.diameter_mm())
            ),
            &format!("write at least {}", given(finest)),
        ));
    }
    let mut settings = match &t.cell_mm {
        Some(cell) => StockSettings::with_cell_mm(*cell.get_ref()).map_err(wrong)?,
        None => StockSettings::for_tool(smallest).coarser_if_needed(),
    };
    if let Some(mb) = &t.memory_mb {
        if !(1.0..=1e5).contains(mb.get_ref()) {
            return Err(job.error(
                mb,
                "1 to 100000 MB can be given to a stock",
                "correct the number",
            ));
        }
        settings = settings.with_memory_bytes((1e6 * mb.get_ref()) as u64);
    }
    let shapes = [
        t.block_mm.is_some(),
        t.cylinder.is_some(),
        t.stl.is_some(),
        t.height_map.is_some(),
    ];
    if shapes.iter().filter(|given| **given).count() != 1 {
        return Err(job.error(
            table,
            "a stock is one of 'block_mm', 'cylinder', 'stl' and 'height_map'",
            "write block_mm = [[x, y, z], [x, y, z]], for instance",
        ));
    }
    let mut read = |what: &str, name: &Spanned<String>| files_read.bytes(files, job, what, name);
    let stock = if let Some(corners) = &t.block_mm {
        let [a, b] = *corners.get_ref();
        Stock::block(a, b, &settings)
    } else if let Some(cylinder) = &t.cylinder {
        let c = cylinder.get_ref();
        Stock::cylinder(c.foot_mm, 2.0 * c.radius_mm, c.height_mm, &settings)
    } else if let Some(stl) = &t.stl {
        let (bytes, name) = read("mesh of the stock", stl)?;
        Stock::stl(&bytes, &name, &settings)
    } else if let Some(map) = &t.height_map {
        let m = map.get_ref();
        let (bytes, name) = read("height map of the stock", &m.file)?;
        Stock::height_map(&bytes, &name, m.corner_mm, m.spacing_mm, &settings)
    } else {
        return Err(job.error(
            table,
            "the stock has no shape",
            "write block_mm = [[x, y, z], [x, y, z]]",
        ));
    };
    let stock = stock.map_err(wrong)?;
    let most = COARSEST * smallest.diameter_mm();
    if stock.cell_mm() > most {
        return Err(job.error(
            table,
            &format!(
                "cells of {} mm do not show where a tool of {} mm cuts: at most a tenth of its diameter does",
                given(stock.cell_mm()),
                short(smallest.diameter_mm())
            ),
            "write a smaller cell_mm, give more memory_mb, or take a smaller stock",
        ));
    }
    let coarser = match stock.coarsened_from_mm() {
        Some(asked) => format!(" ({} mm need more memory than memory_mb)", short(asked)),
        None => String::new(),
    };
    let walls = match t.stl.is_some() {
        true => "; walls of the mesh stand at points of the grid, up to a cell from where they are",
        false => "",
    };
    let words = format!(
        "engagement from the stock, a height field of cells of {} mm{coarser}, in the coordinates of the program with its work offsets: no undercuts, tool along z of the part{walls}",
        given(stock.cell_mm())
    );
    Ok((stock, words))
}
