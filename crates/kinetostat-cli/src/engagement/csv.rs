//! Table of all stations of the cut.

use kinetostat_machining::{CutPlace, FlatProgram, ForceAlongPath, PointKind, cut_places};
use kinetostat_program::Path;

use crate::program::flat_lines::{COLUMNS, cells};
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::Answer;

const HEADER: [&str; 19] = [
    "line",
    "move",
    "share",
    "path_mm",
    "x_mm",
    "y_mm",
    "z_mm",
    "depth_mm",
    "arc_deg",
    "force_n",
    "force_along_feed_n",
    "force_left_n",
    "force_up_n",
    "torque_n_m",
    "power_w",
    "spindle_torque_n_m",
    "chip_mm",
    "feed_per_tooth_mm",
    "rpm",
];

/// A row for each; of a program that was written flat with the line that each line came from.
pub(crate) fn of_cut(
    forces: &ForceAlongPath,
    path: &Path,
    flat: Option<&FlatProgram>,
) -> Answer<Vec<u8>> {
    let mut header = HEADER.map(String::from).to_vec();
    header.extend(flat.iter().flat_map(|_| COLUMNS.map(String::from)));
    let mut rows = vec![header];
    let stations = cut_places(forces, path).filter(|place| place.kind != PointKind::Rapid);
    rows.extend(stations.map(|place| {
        let mut row = row(&place);
        row.extend(cells(place.line, flat).into_iter().flatten());
        row
    }));
    written(&rows)
}

fn row(p: &CutPlace) -> Vec<String> {
    let [x, y, z] = p.position_mm;
    let mut row = vec![p.line.to_string(), p.move_number.to_string()];
    row.extend([p.share, p.path_mm, x, y, z, p.depth_mm, p.arc_deg].map(cell));
    let parts = [p.force_along_feed_n, p.force_left_n, p.force_up_n];
    row.push(cell(p.force_n()));
    row.extend(parts.map(cell));
    row.extend([p.torque_n_m, p.power_w].map(cell));
    row.push(cell_if_any(p.spindle_torque_n_m));
    row.extend([p.chip_mm, p.feed_per_tooth_mm, p.rpm].map(cell));
    row
}
