//! The grid of heights with the distances of its walls, and blanks as they come from the saw.

use crate::error::{CutError, CutErrorKind, Result, within};
use crate::stock::arcs::Sliver;
use crate::stock::profile::{Normal, Profile, outline_normal};
use crate::stock::settings::{BYTES_PER_CELL, StockSettings};

/// Walls are known up to this many cells away: more than the diagonal of a cell.
const KNOWN_CELLS: f64 = 1.5;
/// Longest arc of a sliver, cells.
const SLIVER_CELLS: f64 = 1.2;
/// Coordinates beyond this are a slip of the unit, mm.
pub(crate) const FAR_MM: f64 = 1e5;

/// One point of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct Column {
    /// Top of the material above the stock's bottom, mm; 0 where there is none.
    pub top: f32,
    /// Distance of the next wall down, seen from above, mm; `known` where none is near.
    pub drop: f32,
    /// Distance of the next wall up, mm; `known` where none is near.
    pub rise: f32,
    /// Normal of the next wall down.
    pub drop_normal: Normal,
    /// Normal of the next wall up.
    pub rise_normal: Normal,
}

const _: () = assert!(size_of::<Column>() as u64 == BYTES_PER_CELL);

/// Remaining stock: heights at the points of a square grid parallel to x and y of the part.
///
/// Every point holds the top of the material (solid from there down to the bottom), and distance and direction of the
/// next wall down and the next wall up as the tools have left them. So vertical walls are located between the points,
/// and where two walls meet in a cell both are. With a cell of a twentieth of the tool's diameter the ends of arcs were
/// found to 0.0005 rad on straight cuts and to 0.008 rad on circles of short chords, and to a quarter of that or less
/// with half the cell. Along `tball-pocket` (40 000 moves of 0.2 mm) 98 % of all arcs are within 0.017 rad of those of
/// the swept area itself, the worst is 0.27 rad off: where more than two walls meet in a cell, a place of the rim may
/// be off by as much as that cell.
///
/// **Slivers are air**: an arc of at most 1.2 cells that is nowhere deeper than `cell^2 / (2 radius)` in the material (0.015 mm at
/// D/20). By so much a circle leaves its tangent within a cell. Its force is below 1 % of that of a slot with a law without edge
/// force; a tool that goes along its own wall again has none. An arc of at most twice that length, or of any length and nowhere
/// deeper than a 500th of a cell, is air as well where the distances of the walls, interpolated in the cell, do not show it:
/// ways that crossed at sharp angles or bent leave none.
///
/// Likewise up to a cell where walls at two heights lie less than one and a half cells apart, and at the steep walls of a mesh
/// or a map of heights. On ramps, what was cut already may seem to be in contact by up to a cell and a quarter on the rim at each
/// side; on steep ones by more.
///
/// **Limits**: undercuts and cavities (only the greatest height is kept), tools whose axis is not z, cuts by T-slot or
/// lollipop cutters, shanks and holders that rub, the cone of a face mill beyond twice its diameter at the tip. Numbers
/// are stored as `f32` above the bottom: heights are rounded by less than 6e-8 of the stock's height.
///
/// ```
/// use kinetostat_cutting::{Engagement, Probe, Shape, Side, Stock, StockSettings, Tool};
///
/// let tool = Tool::new(Shape::Flat, 6.0, 2)?;
/// let mut stock = Stock::block([0.0, 0.0, 0.0], [40.0, 30.0, 10.0], &StockSettings::for_tool(&tool))?; // mm
/// let mut probe = Probe::new(&tool);
/// // Along the left edge (seen along the feed, +x, the part is at the right), 1.5 mm wide and 2 mm deep.
/// let stations = probe.stations(&mut stock, [-5.0, 31.5, 8.0], [20.0, 31.5, 8.0])?;
/// let last = stations.last().unwrap();
/// let exact = Engagement::straight(3.0, 1.5, 2.0, Side::Right)?.contacts[0];
/// let found = last.engagement.contacts[0];
/// assert_eq!(last.share, 1.0);
/// assert!((found.entry - exact.entry).abs() < 0.01 && (found.exit - exact.exit).abs() < 0.01);
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Stock {
    pub(crate) columns: Vec<Column>,
    pub(crate) points: [usize; 2],
    /// Place of the first point, mm.
    pub(crate) origin: [f64; 2],
    pub(crate) cell: f64,
    /// Cells per mm.
    pub(crate) per_mm: f64,
    pub(crate) bottom: f64,
    /// Lowest and highest corner of the blank, mm.
    pub(crate) space: [[f64; 3]; 2],
    /// Greatest top at the start, above the bottom.
    pub(crate) height: f64,
    pub(crate) asked_cell: f64,
    /// The tool that was last here, and where it stands: the wall before it is not yet told to the points.
    pub(crate) front: Option<(Profile, [f64; 3])>,
}

impl Stock {
    /// Air above a rectangle, with a ring of points around it, and the walls not known.
    pub(crate) fn empty(
        corner: [f64; 2],
        opposite: [f64; 2],
        [bottom, top]: [f64; 2],
        settings: &StockSettings,
    ) -> Result<Self> {
        let names = ["along x", "along y"];
        for i in 0..2 {
            within(
                CutErrorKind::Stock,
                &format!("stock {}", names[i]),
                opposite[i] - corner[i],
                1e-3..=FAR_MM,
                "mm",
            )?;
        }
        within(
            CutErrorKind::Stock,
            "height of the stock",
            top - bottom,
            1e-3..=FAR_MM,
            "mm",
        )?;
        let place = [corner[0], corner[1], opposite[0], opposite[1], bottom, top];
        for value in place {
            let bounds = -FAR_MM..=FAR_MM;
            within(
                CutErrorKind::Stock,
                "place of the stock",
                value,
                bounds,
                "mm",
            )?;
        }
        let lengths = [opposite[0] - corner[0], opposite[1] - corner[1]];
        let (cell, points) = settings.grid_for(lengths)?;
        let known = (KNOWN_CELLS * cell) as f32;
        let air = Column {
            drop: known,
            rise: known,
            ..Column::default()
        };
        Ok(Self {
            columns: vec![air; points[0] * points[1]],
            points,
            origin: corner.map(|c| c - 0.5 * cell),
            cell,
            per_mm: 1.0 / cell,
            bottom,
            space: [
                [corner[0], corner[1], bottom],
                [opposite[0], opposite[1], top],
            ],
            height: top - bottom,
            asked_cell: settings.cell_mm(),
            front: None,
        })
    }

    /// Sets every point; takes x and y, gives the top above the bottom and the distance of the stock's outline, negative
    /// outside (infinite where it is not known).
    pub(crate) fn fill(&mut self, at: impl Fn(f64, f64) -> (f64, f64)) {
        let known = self.known();
        for j in 0..self.points[1] {
            for i in 0..self.points[0] {
                let [x, y] = self.place(i, j);
                let (top, inside) = at(x, y);
                let distance = inside.abs().min(known) as f32;
                let normal = match inside.abs() < known {
                    true => outline_normal(&at, [x, y], 1e-3 * self.cell),
                    false => Normal::default(),
                };
                let column = &mut self.columns[j * self.points[0] + i];
                match inside > 0.0 {
                    true => {
                        column.top = (top as f32).max(0.0);
                        column.drop = distance;
                        column.drop_normal = normal;
                    }
                    false => {
                        column.rise = distance;
                        column.rise_normal = normal;
                    }
                }
            }
        }
    }

    /// Size of a cell, mm.
    #[must_use]
    pub fn cell_mm(&self) -> f64 {
        self.cell
    }

    /// The size that was asked for, mm, if the memory did not do for it.
    ///
    /// ```
    /// use kinetostat_cutting::{Stock, StockSettings};
    ///
    /// let settings = StockSettings::with_cell_mm(0.1)?.with_memory_bytes(1_000_000).coarser_if_needed();
    /// let stock = Stock::block([0.0; 3], [100.0, 100.0, 20.0], &settings)?;
    /// assert_eq!(stock.coarsened_from_mm(), Some(0.1));
    /// assert!(stock.cell_mm() < 0.46 && stock.memory_bytes() <= 1_000_000);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn coarsened_from_mm(&self) -> Option<f64> {
        (self.cell > self.asked_cell).then_some(self.asked_cell)
    }

    /// Number of points of the grid.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.columns.len()
    }

    /// Memory of the grid, bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> u64 {
        self.columns.len() as u64 * BYTES_PER_CELL
    }

    /// Lowest and highest x and y of the grid, mm: the stock with a ring of half a cell around it.
    ///
    /// ```
    /// use kinetostat_cutting::{Stock, StockSettings};
    ///
    /// let stock = Stock::block([0.0; 3], [20.0, 10.0, 5.0], &StockSettings::with_cell_mm(0.5)?)?;
    /// let [low, high] = stock.corners_mm();
    /// assert_eq!(low, [-0.25, -0.25]);
    /// assert!((high[0] - 20.25).abs() < 1e-9 && (high[1] - 10.25).abs() < 1e-9);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn corners_mm(&self) -> [[f64; 2]; 2] {
        let [nx, ny] = self.points;
        [self.origin, self.place(nx - 1, ny - 1)]
    }

    /// Lowest and highest corner of the box around the material at the start, mm.
    ///
    /// ```
    /// use kinetostat_cutting::{Stock, StockSettings};
    ///
    /// let stock = Stock::block([0.0; 3], [20.0, 10.0, 5.0], &StockSettings::with_cell_mm(0.5)?)?;
    /// let [low, high] = stock.space_mm();
    /// assert_eq!((low, high), ([0.0; 3], [20.0, 10.0, 5.0]));
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn space_mm(&self) -> [[f64; 3]; 2] {
        self.space
    }

    /// Top of the material at the grid point next to x and y, mm; `None` where there is no material.
    #[must_use]
    pub fn top_mm(&self, x: f64, y: f64) -> Option<f64> {
        let index = |value: f64, i: usize| {
            let at = ((value - self.origin[i]) / self.cell).round();
            (at >= 0.0 && at < self.points[i] as f64).then_some(at as usize)
        };
        let top = self.columns[index(y, 1)? * self.points[0] + index(x, 0)?].top;
        (top > 0.0).then(|| f64::from(top) + self.bottom)
    }

    /// Greatest distance at which walls are known.
    pub(crate) fn known(&self) -> f64 {
        KNOWN_CELLS * self.cell
    }

    /// Place of a point.
    pub(crate) fn place(&self, i: usize, j: usize) -> [f64; 2] {
        [
            self.origin[0] + i as f64 * self.cell,
            self.origin[1] + j as f64 * self.cell,
        ]
    }

    /// Height below which differences are rounding, mm.
    pub(crate) fn tolerance(&self) -> f64 {
        (1e-4 * self.cell).max(4e-7 * self.height)
    }

    /// Sliver below the resolution of the walls, for a rim of this radius.
    pub(crate) fn sliver(&self, radius: f64) -> Sliver {
        Sliver {
            arc: SLIVER_CELLS * self.cell / radius,
            depth: 0.5 * self.cell * self.cell / radius,
        }
    }

    /// Error of a coordinate of a move that no machine has.
    pub(crate) fn checked_place(place: [f64; 3]) -> Result<[f64; 3]> {
        match place.iter().all(|value| value.abs() <= FAR_MM) {
            true => Ok(place),
            false => Err(CutError::new(
                CutErrorKind::Cut,
                "place of the tool",
                format!("{place:?} mm"),
                format!("coordinates up to {FAR_MM} mm"),
            )),
        }
    }
}

impl Stock {
    /// A block between two opposite corners, mm.
    ///
    /// # Errors
    /// A block without volume, one larger than 100 m or far away, more memory than allowed.
    pub fn block(a: [f64; 3], b: [f64; 3], settings: &StockSettings) -> Result<Self> {
        let least = |i: usize| if b[i] < a[i] { b[i] } else { a[i] };
        let most = |i: usize| if b[i] < a[i] { a[i] } else { b[i] };
        let (low, high) = ([least(0), least(1)], [most(0), most(1)]);
        let mut stock = Self::empty(low, high, [least(2), most(2)], settings)?;
        let height = stock.height;
        stock.fill(|x, y| {
            let beyond = [(low[0] - x).max(x - high[0]), (low[1] - y).max(y - high[1])];
            let nearest = beyond[0].max(beyond[1]);
            let distance = match nearest > 0.0 {
                true => beyond[0].max(0.0).hypot(beyond[1].max(0.0)),
                false => nearest,
            };
            (height, -distance)
        });
        Ok(stock)
    }

    /// A cylinder that stands upright: centre of its lower end, diameter and height, mm.
    ///
    /// ```
    /// use kinetostat_cutting::{Stock, StockSettings};
    ///
    /// let stock = Stock::cylinder([0.0, 0.0, -5.0], 40.0, 5.0, &StockSettings::with_cell_mm(0.5)?)?;
    /// assert!((stock.volume_mm3() / 6283.2 - 1.0).abs() < 1e-3);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Stock::block`].
    pub fn cylinder(
        centre: [f64; 3],
        diameter_mm: f64,
        height_mm: f64,
        settings: &StockSettings,
    ) -> Result<Self> {
        let [x0, y0, bottom] = centre;
        let radius = 0.5 * diameter_mm;
        let ends = [bottom, bottom + height_mm];
        let (low, high) = ([x0 - radius, y0 - radius], [x0 + radius, y0 + radius]);
        let mut stock = Self::empty(low, high, ends, settings)?;
        stock.fill(|x, y| (height_mm, radius - (x - x0).hypot(y - y0)));
        Ok(stock)
    }
}
