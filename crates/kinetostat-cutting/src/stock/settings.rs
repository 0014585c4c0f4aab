//! Resolution of a stock, and its limit of memory.

use crate::error::{CutError, CutErrorKind, Result, within};
use crate::tool::Tool;

/// Memory a stock may take unless told otherwise, bytes: 500 MB.
const MEMORY: u64 = 500_000_000;
/// Bytes of one point of the grid.
pub(crate) const BYTES_PER_CELL: u64 = 20;

/// Behaviour when the requested cells need more memory than allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Overflow {
    Coarser,
    Refused,
}

/// Size of the cells of a stock and bound on its memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StockSettings {
    cell_mm: f64,
    memory_bytes: u64,
    overflow: Overflow,
}

impl StockSettings {
    /// Cells of a twentieth of the tool's diameter; at most 500 MB, and an error beyond them. Of several tools take the
    /// smallest.
    ///
    /// ```
    /// use kinetostat_cutting::{Shape, StockSettings, Tool};
    ///
    /// let settings = StockSettings::for_tool(&Tool::new(Shape::Flat, 6.0, 2)?);
    /// assert!((settings.cell_mm() - 0.3).abs() < 1e-12);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn for_tool(tool: &Tool) -> Self {
        Self {
            cell_mm: tool.diameter_mm() / 20.0,
            memory_bytes: MEMORY,
            overflow: Overflow::Refused,
        }
    }

    /// Cells of this size, mm; at most 500 MB, and an error beyond them.
    ///
    /// # Errors
    /// A size outside 0.001 to 100 mm, or none.
    pub fn with_cell_mm(cell_mm: f64) -> Result<Self> {
        within(CutErrorKind::Stock, "cell", cell_mm, 1e-3..=100.0, "mm")?;
        Ok(Self {
            cell_mm,
            memory_bytes: MEMORY,
            overflow: Overflow::Refused,
        })
    }

    /// Sets the limit of memory, bytes.
    #[must_use]
    pub fn with_memory_bytes(mut self, bytes: u64) -> Self {
        self.memory_bytes = bytes;
        self
    }

    /// Enlarges the cells where the memory does not suffice, until it does: [`Stock::coarsened_from_mm`] tells.
    ///
    /// [`Stock::coarsened_from_mm`]: crate::Stock::coarsened_from_mm
    #[must_use]
    pub fn coarser_if_needed(mut self) -> Self {
        self.overflow = Overflow::Coarser;
        self
    }

    /// Size of a cell that is asked for, mm.
    #[must_use]
    pub fn cell_mm(&self) -> f64 {
        self.cell_mm
    }

    /// Size of the cells for a part of these lengths along x and y, mm, and the numbers of points along both.
    pub(crate) fn grid_for(&self, lengths: [f64; 2]) -> Result<(f64, [usize; 2])> {
        let points = |cell: f64| lengths.map(|length| (length / cell).ceil() + 2.0);
        let bytes = |[nx, ny]: [f64; 2]| nx * ny * BYTES_PER_CELL as f64;
        let allowed = self.memory_bytes as f64;
        let mut cell = self.cell_mm;
        if bytes(points(cell)) > allowed {
            let mb = |bytes: f64| format!("{:.1} MB", bytes / 1e6);
            if self.overflow == Overflow::Refused || allowed < (16 * BYTES_PER_CELL) as f64 {
                return Err(CutError::new(
                    CutErrorKind::Stock,
                    "memory of the stock",
                    mb(bytes(points(cell))),
                    format!("at most {}: larger cells, or more memory", mb(allowed)),
                ));
            }
            // Longer by hundredths, so that they are never much larger than they must be.
            while bytes(points(cell)) > allowed {
                cell *= 1.01;
            }
        }
        Ok((cell, points(cell).map(|n| n as usize)))
    }
}
