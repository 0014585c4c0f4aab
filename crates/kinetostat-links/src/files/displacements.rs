//! Tables of displacements: CSV, or the `.dat` file of CalculiX.
//!
//! CSV: one line per load case and node, columns in any order, units in the header:
//! `case,node,x_mm,y_mm,z_mm,ux_mm,uy_mm,uz_mm` (also `_m`, `_um`). Cases named fx, fy, fz, mx, my, mz are
//! unit loads; others are found in a table of loads: `case,fx_n,fy_n,fz_n,mx_n_mm,my_n_mm,mz_n_mm`.

use std::collections::BTreeMap;

use nalgebra::{Vector3, Vector6};

use crate::error::Result;
use crate::experiment::LoadCase;
use crate::files::nodes::Nodes;
use crate::text::{Text, fields, short};
use crate::units::Units;

/// Maximum number of load cases.
const MOST_CASES: usize = 1000;

/// Wrenches (N, N m, about the link's end, file's axes) by the name of their case, in order.
pub type LoadTable = Vec<(String, Vector6<f64>)>;

/// The cases fx, fy, fz, mx, my, mz with this force (N) and moment (N m).
#[must_use]
pub fn unit_loads(force: f64, moment: f64) -> LoadTable {
    ["fx", "fy", "fz", "mx", "my", "mz"]
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let mut wrench = Vector6::zeros();
            wrench[i] = if i < 3 { force } else { moment };
            ((*name).to_owned(), wrench)
        })
        .collect()
}

/// Columns of a table: where each wanted one stands, and its factor to SI.
struct Columns {
    found: Vec<Option<(usize, f64)>>,
}

impl Columns {
    /// `wanted`: names without unit; `units`: suffixes and factors of each.
    fn new(
        text: &Text,
        line: usize,
        header: &[&str],
        wanted: &[(&str, &[(&str, f64)])],
    ) -> Result<Self> {
        let mut found: Vec<Option<(usize, f64)>> = vec![None; wanted.len()];
        for (at, cell) in header.iter().enumerate() {
            let cell = cell.to_lowercase();
            if cell.is_empty() {
                continue;
            }
            let hit = wanted.iter().enumerate().find_map(|(w, (name, units))| {
                units
                    .iter()
                    .find(|u| cell == format!("{name}{}", u.0))
                    .map(|u| (w, u.1))
            });
            let Some((w, factor)) = hit else {
                let all: Vec<String> = wanted
                    .iter()
                    .map(|(n, u)| {
                        u.iter()
                            .map(|u| format!("{n}{}", u.0))
                            .collect::<Vec<_>>()
                            .join(" or ")
                    })
                    .collect();
                return Err(text
                    .fault(
                        format!("the column '{}' is not known", short(&cell)),
                        format!("there are: {}", all.join(", ")),
                    )
                    .at(line));
            };
            if found[w].replace((at, factor)).is_some() {
                return Err(text
                    .fault(
                        format!("the column '{}' is given twice", wanted[w].0),
                        "keep one of them",
                    )
                    .at(line));
            }
        }
        Ok(Self { found })
    }

    fn need(&self, text: &Text, line: usize, which: usize, name: &str) -> Result<(usize, f64)> {
        self.found[which].ok_or_else(|| {
            text.fault(
                format!("the column '{name}' is missing"),
                "write it with its unit, as in ux_mm",
            )
            .at(line)
        })
    }

    fn value(
        &self,
        text: &Text,
        line: usize,
        cells: &[&str],
        which: usize,
        name: &str,
    ) -> Result<f64> {
        let (at, factor) = self.need(text, line, which, name)?;
        Ok(factor * text.number(line, name, cells.get(at).copied().unwrap_or(""))?)
    }
}

const LENGTH: &[(&str, f64)] = &[("_mm", 1e-3), ("_m", 1.0)];
const SMALL: &[(&str, f64)] = &[("_mm", 1e-3), ("_m", 1.0), ("_um", 1e-6)];
const PLAIN: &[(&str, f64)] = &[("", 1.0)];

/// Reads a table of loads.
///
/// # Errors
///
/// With file, line and what to do.
pub fn read_loads(text: &Text) -> Result<LoadTable> {
    const FORCE: &[(&str, f64)] = &[("_n", 1.0), ("_kn", 1e3)];
    const MOMENT: &[(&str, f64)] = &[("_n_mm", 1e-3), ("_n_m", 1.0)];
    let wanted = [
        ("case", PLAIN),
        ("fx", FORCE),
        ("fy", FORCE),
        ("fz", FORCE),
        ("mx", MOMENT),
        ("my", MOMENT),
        ("mz", MOMENT),
    ];
    let mut table: LoadTable = Vec::new();
    let mut columns = None;
    for (line, written) in text.lines() {
        let cells = fields(written);
        if cells.iter().all(|c| c.is_empty()) {
            continue;
        }
        let Some(columns) = &columns else {
            columns = Some(Columns::new(text, line, &cells, &wanted)?);
            continue;
        };
        let (at, _) = columns.need(text, line, 0, "case")?;
        let name = cells.get(at).copied().unwrap_or("").to_lowercase();
        let mut wrench = Vector6::zeros();
        for i in 0..6 {
            // A column that is left out is zero in all cases.
            if columns.found[i + 1].is_some() {
                wrench[i] = columns.value(text, line, &cells, i + 1, wanted[i + 1].0)?;
            }
        }
        if table.iter().any(|(n, _)| *n == name) {
            return Err(text
                .fault(
                    format!("the case '{}' is given twice", short(&name)),
                    "keep one of them",
                )
                .at(line));
        }
        if table.len() >= MOST_CASES {
            return Err(text
                .fault(
                    format!("there are more than {MOST_CASES} load cases"),
                    "take six or some more",
                )
                .at(line));
        }
        table.push((name, wrench));
    }
    if table.is_empty() {
        return Err(text.fault(
            "the table has no load cases",
            "write case,fx_n,... and a line for each case",
        ));
    }
    Ok(table)
}

/// Reads displacements as CSV or as CalculiX writes them with `*NODE PRINT` and `U` (then `mesh` says
/// where the nodes are, `units` the lengths, and the steps are the cases of `loads` in order).
///
/// # Errors
///
/// With file, line and what to do.
pub fn read_displacements(
    text: &Text,
    loads: &LoadTable,
    mesh: Option<&Nodes>,
    units: Option<Units>,
) -> Result<Vec<LoadCase>> {
    let is_dat = text
        .lines()
        .take(50)
        .any(|(_, l)| l.trim_start().starts_with("displacements (vx,vy,vz)"));
    if is_dat {
        steps(text, loads, mesh, units)
    } else {
        table(text, loads)
    }
}

fn table(text: &Text, loads: &LoadTable) -> Result<Vec<LoadCase>> {
    let wanted = [
        ("case", PLAIN),
        ("node", PLAIN),
        ("x", LENGTH),
        ("y", LENGTH),
        ("z", LENGTH),
        ("ux", SMALL),
        ("uy", SMALL),
        ("uz", SMALL),
    ];
    let mut columns = None;
    let mut cases: Vec<LoadCase> = Vec::new();
    let mut places: BTreeMap<String, (Vector3<f64>, usize)> = BTreeMap::new();
    let mut seen: BTreeMap<(usize, String), usize> = BTreeMap::new();
    for (line, written) in text.lines() {
        let cells = fields(written);
        if cells.iter().all(|c| c.is_empty()) {
            continue;
        }
        let Some(columns) = &columns else {
            let found = Columns::new(text, line, &cells, &wanted)?;
            for which in [0, 2, 3, 4, 5, 6, 7] {
                found.need(text, line, which, wanted[which].0)?;
            }
            columns = Some(found);
            continue;
        };
        let vector = |from: usize| -> Result<Vector3<f64>> {
            let mut v = Vector3::zeros();
            for i in 0..3 {
                v[i] = columns.value(text, line, &cells, from + i, wanted[from + i].0)?;
            }
            Ok(v)
        };
        let (place, moved) = (vector(2)?, vector(5)?);
        let (at, _) = columns.need(text, line, 0, "case")?;
        let name = cells.get(at).copied().unwrap_or("").to_lowercase();
        let case = case_of(text, line, &name, loads, &mut cases)?;
        if let Some((at, _)) = columns.found[1] {
            let node = cells.get(at).copied().unwrap_or("").to_owned();
            if let Some(before) = seen.insert((case, node.clone()), line) {
                return Err(text
                    .fault(
                        format!(
                            "the node {} occurs twice in the case '{}', also at line {before}",
                            short(&node),
                            short(&name)
                        ),
                        "each node has one line in each case",
                    )
                    .at(line));
            }
            check_place(text, line, node, &place, &mut places)?;
        }
        cases[case].places.push(place);
        cases[case].displacements.push(moved);
    }
    if cases.is_empty() {
        return Err(text.fault(
            "the table has no rows",
            "write a header and a line for each case and node",
        ));
    }
    Ok(cases)
}

/// Index of a load case by its name; a new one where the loads have it.
fn case_of(
    text: &Text,
    line: usize,
    name: &str,
    loads: &LoadTable,
    cases: &mut Vec<LoadCase>,
) -> Result<usize> {
    Ok(match cases.iter().position(|c| c.name == name) {
        Some(case) => case,
        None => {
            let Some((_, wrench)) = loads.iter().find(|(n, _)| n == name) else {
                let names: Vec<&str> = loads.iter().take(12).map(|l| l.0.as_str()).collect();
                return Err(text
                    .fault(
                        format!("the load of the case '{}' is unknown", short(name)),
                        format!(
                            "there are: {}; or give a table of loads with --loads",
                            names.join(", ")
                        ),
                    )
                    .at(line));
            };
            cases.push(LoadCase {
                name: name.to_owned(),
                wrench: *wrench,
                places: Vec::new(),
                displacements: Vec::new(),
            });
            cases.len() - 1
        }
    })
}

/// A node has one place in all cases.
fn check_place(
    text: &Text,
    line: usize,
    node: String,
    place: &Vector3<f64>,
    places: &mut BTreeMap<String, (Vector3<f64>, usize)>,
) -> Result<()> {
    match places.get(&node) {
        Some((other, before)) if (other - place).norm() > 1e-6 + 1e-6 * place.norm() => {
            return Err(text
                .fault(
                    format!("the node {} lies elsewhere at line {before}", short(&node)),
                    "places are those of the unloaded mesh, the same in all cases",
                )
                .at(line));
        }
        Some(_) => {}
        None => {
            places.insert(node, (*place, line));
        }
    }
    Ok(())
}

fn steps(
    text: &Text,
    loads: &LoadTable,
    mesh: Option<&Nodes>,
    units: Option<Units>,
) -> Result<Vec<LoadCase>> {
    let (Some(mesh), Some(units)) = (mesh, units) else {
        return Err(text.fault(
            "this is a .dat file of CalculiX, which has neither places nor units",
            "name the mesh with --nodes and the units with --units",
        ));
    };
    let mut cases: Vec<LoadCase> = Vec::new();
    for (line, written) in text.lines() {
        let trimmed = written.trim();
        if trimmed.starts_with("displacements (vx,vy,vz)") {
            let Some((name, wrench)) = loads.get(cases.len()) else {
                return Err(text
                    .fault(
                        format!("there are more steps than the {} load cases", loads.len()),
                        "print the displacements of one set once per step, or give all loads with --loads",
                    )
                    .at(line));
            };
            cases.push(LoadCase {
                name: name.clone(),
                wrench: *wrench,
                places: Vec::new(),
                displacements: Vec::new(),
            });
            continue;
        }
        let cells: Vec<&str> = trimmed.split_whitespace().collect();
        let Some(case) = cases.last_mut() else {
            continue;
        };
        if cells.is_empty() || cells[0].parse::<u64>().is_err() {
            continue;
        }
        if cells.len() != 4 {
            return Err(text
                .fault(
                    format!("the line has {} fields", cells.len()),
                    "four are needed: node, vx, vy, vz",
                )
                .at(line));
        }
        let node = text.whole(line, "the node", cells[0], 1, u64::MAX)?;
        let Some(place) = mesh.places.get(&node) else {
            return Err(text
                .fault(
                    format!("the node {node} is not in the mesh"),
                    "name the mesh of this run",
                )
                .at(line));
        };
        let mut moved = Vector3::zeros();
        for i in 0..3 {
            moved[i] = text.number(line, "a displacement", cells[i + 1])? * units.length_m;
        }
        case.places.push(*place);
        case.displacements.push(moved);
    }
    Ok(cases)
}
