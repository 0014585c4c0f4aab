//! VTK's legacy form of a rectilinear grid, binary: ParaView, `vtk` and `meshio` read it. The crate `vtkio` has had no release
//! since its candidate for 0.7 and needs old readers of XML; the form is a header and numbers.

use std::fmt::Write as _;

use crate::fields::grid::Fields;

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
pub(super) fn header(title: &str, kind: &str) -> Vec<u8> {
    let title: String = title.chars().filter(char::is_ascii).collect();
    let title = title.replace(['\n', '\r'], " ");
    let title = &title[..title.len().min(TITLE)];
    format!("# vtk DataFile Version 3.0\n{title}\nBINARY\nDATASET {kind}\n").into_bytes()
}

pub(super) fn numbers(out: &mut Vec<u8>, values: &[f64]) {
    for value in values {
        out.extend_from_slice(&value.to_be_bytes());
    }
    out.push(b'\n');
}
