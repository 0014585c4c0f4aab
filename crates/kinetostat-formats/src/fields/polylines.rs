//! Lines in space with numbers and vectors at their points, as VTK's legacy form of polygonal data: ParaView, `vtk` and `meshio` read it.

use std::fmt::Write as _;

use crate::fields::grid::Fields;

/// A quantity at every point of lines.
#[derive(Clone, Debug, PartialEq)]
pub struct PointQuantity {
    /// Name with the unit: letters, digits and `_`, as in `force_n`.
    pub name: String,
    /// One number of every point, three of a vector, nine of a tensor row by row.
    pub width: usize,
    /// Point after point.
    pub values: Vec<f64>,
}

/// Lines in space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polylines {
    /// Title: the subject of the data.
    pub title: String,
    /// Points, in one unit.
    pub points: Vec<[f64; 3]>,
    /// Number of points of each line, in their order; points without a line are at the end.
    pub lines: Vec<usize>,
    /// Quantities at the points.
    pub quantities: Vec<PointQuantity>,
}

impl Polylines {
    /// Writes a legacy VTK file, doubles, most significant byte first. Missing numbers are NaN.
    #[must_use]
    pub fn vtk(&self) -> Vec<u8> {
        let mut out = header(&self.title, "POLYDATA");
        let put = |out: &mut Vec<u8>, text: String| out.extend_from_slice(text.as_bytes());
        put(&mut out, format!("POINTS {} double\n", self.points.len()));
        numbers(&mut out, self.points.as_flattened());
        let in_lines: usize = self.lines.iter().sum();
        let alone = self.points.len().saturating_sub(in_lines);
        let mut first = 0_usize;
        let index = |out: &mut Vec<u8>, i: usize| {
            // The form has 32 bits.
            out.extend_from_slice(&i32::try_from(i).unwrap_or(i32::MAX).to_be_bytes());
        };
        if alone > 0 {
            put(&mut out, format!("VERTICES {alone} {}\n", 2 * alone));
            for k in in_lines..self.points.len() {
                index(&mut out, 1);
                index(&mut out, k);
            }
            out.push(b'\n');
        }
        let size = self.lines.len() + in_lines;
        put(&mut out, format!("LINES {} {size}\n", self.lines.len()));
        for count in &self.lines {
            index(&mut out, *count);
            (first..first + count).for_each(|k| index(&mut out, k));
            first += count;
        }
        out.push(b'\n');
        put(&mut out, format!("POINT_DATA {}\n", self.points.len()));
        for quantity in &self.quantities {
            let name = &quantity.name;
            put(
                &mut out,
                match quantity.width {
                    3 => format!("VECTORS {name} double\n"),
                    9 => format!("TENSORS {name} double\n"),
                    _ => format!("SCALARS {name} double 1\nLOOKUP_TABLE default\n"),
                },
            );
            numbers(&mut out, &quantity.values);
        }
        out
    }
}

/// Longest title that the form allows.
const TITLE: usize = 255;

impl Fields {
    /// Writes a legacy VTK file, doubles, most significant byte first. Coordinates have the unit of their axes.
    #[must_use]
    pub fn vtk(&self) -> Vec<u8> {
        let [x, y, z] = self.axes.each_ref().map(|axis| axis.places.len());
        let mut out = header(&self.title, "RECTILINEAR_GRID");
        out.extend_from_slice(format!("DIMENSIONS {x} {y} {z}\n").as_bytes());
        for (axis, letter) in self.axes.iter().zip(["X", "Y", "Z"]) {
            out.extend_from_slice(
                format!("{letter}_COORDINATES {} double\n", axis.places.len()).as_bytes(),
            );
            numbers(&mut out, &axis.places);
        }
        let mut head = String::new();
        let count = self.len();
        let _ = writeln!(head, "POINT_DATA {count}");
        out.extend_from_slice(head.as_bytes());
        for column in &self.columns {
            let name = &column.name;
            let head = format!("SCALARS {name} double 1\nLOOKUP_TABLE default\n");
            out.extend_from_slice(head.as_bytes());
            numbers(&mut out, &column.values);
        }
        out
    }
}

/// The first lines of a file.
fn header(title: &str, kind: &str) -> Vec<u8> {
    let title: String = title.chars().filter(char::is_ascii).collect();
    let title = title.replace(['\n', '\r'], " ");
    let title = &title[..title.len().min(TITLE)];
    format!("# vtk DataFile Version 3.0\n{title}\nBINARY\nDATASET {kind}\n").into_bytes()
}

fn numbers(out: &mut Vec<u8>, values: &[f64]) {
    for value in values {
        out.extend_from_slice(&value.to_be_bytes());
    }
    out.push(b'\n');
}
