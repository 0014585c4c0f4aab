//! The stock of a job.

use kinetostat_cutting::{CutError, Stock, StockSettings, Tool};
use serde_spanned::Spanned;

use crate::files::input_files::InputFiles;
use crate::job::cut::cutters::ToolRange;
use crate::job::cut::files_of_cut::FilesOfCut;
use crate::job::cut::refused::refused;
use crate::job::cut_tables::StockTable;
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failure};
use crate::ui::numbers::{given, short};

/// Largest cell, as a share of the tool's diameter: forces in coarser ones are off by percents and more.
const COARSEST: f64 = 0.1 + 1e-9;

/// Smallest cell, as a share of the diameter of the largest tool: a rim of thousands of cells takes minutes and shows no more.
const FINEST: f64 = 1e-3;

/// Subject of a fault of a stock's resolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum About {
    Cell,
    Memory,
    Stock,
}

/// The resolution of a stock as it is asked for, and the names under which it is.
pub(crate) struct Resolution<'a> {
    pub(crate) cell_mm: Option<f64>,
    pub(crate) memory_mb: Option<f64>,
    /// Names of both where they are stated.
    pub(crate) names: [&'static str; 2],
    /// A fault where it stands: what it is about, what is wrong, what helps.
    pub(crate) refuse: &'a dyn Fn(About, &str, &str) -> Failure,
}

impl Resolution<'_> {
    /// The settings for tools from the smallest to the largest diameter.
    pub(crate) fn settings(&self, tools: ToolRange<'_>) -> Answer<StockSettings> {
        let finest = FINEST * tools.largest.diameter_mm();
        let mut settings = match self.cell_mm {
            Some(cell) if cell > 0.0 && cell < finest => {
                return Err((self.refuse)(
                    About::Cell,
                    &format!(
                        "cells of {} mm are finer than a thousandth of the tool's diameter of {} mm",
                        given(cell),
                        short(tools.largest.diameter_mm())
                    ),
                    &format!("write at least {}", given(finest)),
                ));
            }
            Some(cell) => StockSettings::with_cell_mm(cell).map_err(|error| self.wrong(&error))?,
            None => StockSettings::for_tool(tools.smallest).coarser_if_needed(),
        };
        if let Some(mb) = self.memory_mb {
            if !(1.0..=1e5).contains(&mb) {
                return Err((self.refuse)(
                    About::Memory,
                    "1 to 100000 MB can be given to a stock",
                    "correct the number",
                ));
            }
            settings = settings.with_memory_bytes((1e6 * mb) as u64);
        }
        Ok(settings)
    }

    /// A stock that shows where these tools cut, with its resolution in words.
    pub(crate) fn of_stock(&self, stock: &Stock, smallest: &Tool) -> Answer<String> {
        let [cell, memory] = self.names;
        if stock.cell_mm() > COARSEST * smallest.diameter_mm() {
            return Err((self.refuse)(
                About::Stock,
                &format!(
                    "cells of {} mm do not show where a tool of {} mm cuts: at most a tenth of its diameter does",
                    given(stock.cell_mm()),
                    short(smallest.diameter_mm())
                ),
                &format!("write a smaller {cell}, give more {memory}, or take a smaller stock"),
            ));
        }
        let coarser = match stock.coarsened_from_mm() {
            Some(asked) => format!(" ({} mm need more memory than {memory})", short(asked)),
            None => String::new(),
        };
        Ok(format!(
            "engagement from the stock, a height field of cells of {} mm{coarser}, in the coordinates of the program with its work offsets: no undercuts, tool along z of the part",
            given(stock.cell_mm())
        ))
    }

    fn wrong(&self, error: &CutError) -> Failure {
        let what = format!("{}: {}", error.quantity, error.found);
        (self.refuse)(About::Cell, &what, &format!("expected {}", error.expected))
    }
}

/// The stock, and its resolution in words, for tools from the smallest to the largest diameter.
pub(crate) fn stock(
    files: &InputFiles,
    job: &JobFile,
    table: &Spanned<StockTable>,
    tools: ToolRange<'_>,
    files_read: &mut FilesOfCut,
) -> Answer<(Stock, String)> {
    let wrong = |error: CutError| refused(job, table, &error);
    let t = table.get_ref();
    let number = |value: &Option<Spanned<f64>>| value.as_ref().map(|value| *value.get_ref());
    let refuse = |about: About, message: &str, help: &str| match (about, &t.cell_mm, &t.memory_mb) {
        (About::Cell, Some(cell), _) => job.error(cell, message, help),
        (About::Memory, _, Some(memory)) => job.error(memory, message, help),
        _ => job.error(table, message, help),
    };
    let resolution = Resolution {
        cell_mm: number(&t.cell_mm),
        memory_mb: number(&t.memory_mb),
        names: ["cell_mm", "memory_mb"],
        refuse: &refuse,
    };
    let settings = resolution.settings(tools)?;
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
    let mut words = resolution.of_stock(&stock, tools.smallest)?;
    if t.stl.is_some() {
        words.push_str(
            "; walls of the mesh stand at points of the grid, up to a cell from where they are",
        );
    }
    Ok((stock, words))
}
