//! A stock from a mesh (STL, binary or text).

use std::io::Cursor;

use crate::error::{CutError, CutErrorKind, Result};
use crate::stock::grid::{FAR_MM, Stock};
use crate::stock::settings::StockSettings;

/// Maximum number of triangles of a mesh.
const MOST: usize = 20_000_000;
/// Bytes before the triangles of a binary STL, and of one triangle.
const BINARY: [usize; 2] = [84, 50];

type Triangle = [[f64; 3]; 3];

impl Stock {
    /// The mesh of an STL file in mm, binary or text. At each grid point counts the greatest height of the triangles over it:
    /// undercuts and cavities are lost, all below is material down to the lowest point of the mesh. Walls are placed between
    /// the grid points, up to half a cell wrong. `name` stands in errors.
    ///
    /// ```
    /// use kinetostat_cutting::{Stock, StockSettings};
    ///
    /// let wedge = b"solid wedge
    /// facet normal 0 0 1
    /// outer loop
    /// vertex 0 0 0
    /// vertex 20 0 10
    /// vertex 0 20 10
    /// endloop
    /// endfacet
    /// endsolid wedge";
    /// let stock = Stock::stl(wedge, "wedge.stl", &StockSettings::with_cell_mm(0.5)?)?;
    /// assert!((stock.top_mm(9.75, 9.75).unwrap() - 9.75).abs() < 1e-3);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A file that is no STL or ends early, coordinates that are no numbers, no triangle or more than 20 million; a mesh
    /// without height, and as [`Stock::block`].
    pub fn stl(bytes: &[u8], name: &str, settings: &StockSettings) -> Result<Self> {
        let triangles = read(bytes, name)?;
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for vertex in triangles.iter().flatten() {
            for i in 0..3 {
                low[i] = if vertex[i] < low[i] {
                    vertex[i]
                } else {
                    low[i]
                };
                high[i] = if vertex[i] > high[i] {
                    vertex[i]
                } else {
                    high[i]
                };
            }
        }
        let in_file = |error: CutError| error.at(name, None);
        let ends = [low[2], high[2]];
        let mut stock =
            Self::empty([low[0], low[1]], [high[0], high[1]], ends, settings).map_err(in_file)?;
        for triangle in &triangles {
            stock.cover(triangle);
        }
        Ok(stock)
    }

    /// Raises the points below a triangle to it.
    fn cover(&mut self, triangle: &Triangle) {
        let [a, b, c] = triangle;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if area == 0.0 {
            return;
        }
        let bounds = |axis: usize| {
            let index = |value: f64| (value - self.origin[axis]) / self.cell;
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for vertex in triangle {
                low = if vertex[axis] < low {
                    vertex[axis]
                } else {
                    low
                };
                high = if vertex[axis] > high {
                    vertex[axis]
                } else {
                    high
                };
            }
            let last = (self.points[axis] - 1) as f64;
            [
                index(low).ceil().min(last) as usize,
                index(high).floor().min(last) as usize,
            ]
        };
        let ([i0, i1], [j0, j1]) = (bounds(0), bounds(1));
        for j in j0..=j1 {
            for i in i0..=i1 {
                let [x, y] = self.place(i, j);
                // Shares of the corners; a little beyond the edge, so that no point between two triangles is left out.
                let of_b = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / area;
                let of_c = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / area;
                if of_b < -1e-9 || of_c < -1e-9 || of_b + of_c > 1.0 + 1e-9 {
                    continue;
                }
                let z = a[2] + of_b * (b[2] - a[2]) + of_c * (c[2] - a[2]);
                let top = (z - self.bottom).max(0.0).min(self.height) as f32;
                let column = &mut self.columns[j * self.points[0] + i];
                if top > column.top {
                    column.top = top;
                }
            }
        }
    }
}

fn read(bytes: &[u8], name: &str) -> Result<Vec<Triangle>> {
    let wrong = |quantity: &str, found: String, expected: &str| {
        CutError::new(CutErrorKind::File, quantity, found, expected).at(name, None)
    };
    let binary = bytes.get(80..84).map(|count| {
        let count = u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize;
        (
            count,
            count.saturating_mul(BINARY[1]).saturating_add(BINARY[0]) == bytes.len(),
        )
    });
    let text = bytes.starts_with(b"solid ");
    let owned;
    let source = match binary {
        // Headers of binary files often begin with the word of the other kind.
        Some((_, true)) if text => {
            owned = [&[0_u8; 80], &bytes[80..]].concat();
            owned.as_slice()
        }
        Some((_, true)) => bytes,
        _ if text => bytes,
        Some((count, false)) => {
            let found = format!("{} bytes for {count} triangles", bytes.len());
            return Err(wrong(
                "STL file",
                found,
                "84 bytes and 50 for each triangle",
            ));
        }
        None => {
            let found = format!("{} bytes", bytes.len());
            return Err(wrong(
                "STL file",
                found,
                "a text that begins with `solid`, or 84 bytes and more",
            ));
        }
    };
    let mut cursor = Cursor::new(source);
    let of_library =
        |error: std::io::Error| wrong("STL file", error.to_string(), "triangles of three vertices");
    let mut triangles = Vec::new();
    for triangle in stl_io::create_stl_reader(&mut cursor).map_err(of_library)? {
        let triangle = triangle.map_err(of_library)?;
        let corners = triangle.vertices.map(|vertex| vertex.0.map(f64::from));
        let far = corners
            .iter()
            .flatten()
            .find(|x| x.is_nan() || x.abs() > FAR_MM);
        if let Some(far) = far {
            let found = format!("{far} in triangle {}", triangles.len() + 1);
            return Err(wrong(
                "coordinate of the mesh",
                found,
                "numbers up to 100000 mm",
            ));
        }
        if triangles.len() == MOST {
            return Err(wrong(
                "triangles of the mesh",
                format!("more than {MOST}"),
                "a coarser mesh",
            ));
        }
        triangles.push(corners);
    }
    match triangles.is_empty() {
        true => Err(wrong(
            "triangles of the mesh",
            "none".into(),
            "at least one",
        )),
        false => Ok(triangles),
    }
}
