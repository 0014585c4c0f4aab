//! Tables of measurements: one row for each marker that was read in a posture under a load.
//!
//! The header names quantity and unit (`A1_deg`, `fz_n`, `dx_um`). Cells are separated by commas, semicolons or tabs; with
//! semicolons or tabs the decimal sign may be a comma. All faults of a file are found in one run, each with row and column.

mod columns;
mod frame;
mod read;
mod row;

use std::collections::BTreeMap;

use kinetostat::number::larger;
use nalgebra::Vector3;

use crate::experiment::{Branch, Observation, Reading, ReadingOf, TestLoad};

pub use columns::COLUMNS;
pub use frame::{InstrumentFrame, NoFrame, into_base};
pub use read::{read_postures, read_table};
pub use row::{DEVIATION, MOST_FAULTS, MeasuredRow, Read, TURN_DEVIATION, TableFault};

/// The largest load of the loop that a row belongs to: in its posture, at its point and along its force, or, behind the loop, along the
/// force of the row before.
fn whole_load(
    beside: &[&MeasuredRow],
    of: &MeasuredRow,
    gravity: &Vector3<f64>,
) -> Option<TestLoad> {
    let same_point = beside
        .iter()
        .filter(|row| row.is_loaded() && row.load.at == of.load.at);
    let last = same_point.clone().rfind(|row| row.line <= of.line)?;
    let direction = last.load_under(gravity).force.normalize();
    let loads = same_point.map(|row| row.load_under(gravity));
    let same = loads.filter(|load| load.force.normalize().dot(&direction) > SAME_WAY);
    same.max_by(|a, b| a.force.norm().total_cmp(&b.force.norm()))
}

/// Cosine of the angle between forces of one loop, at least.
const SAME_WAY: f64 = 0.99;
/// Difference of axes within a posture, m or rad: what a controller shows of one that stands still.
const SAME_AXES: f64 = 2e-6;

/// Faults of rows that cannot stand beside each other: one name for several postures, masses without gravity.
fn contradictions(rows: &[MeasuredRow], gravity: &Vector3<f64>) -> Vec<TableFault> {
    let mut faults = Vec::new();
    let mut first: BTreeMap<&str, &MeasuredRow> = BTreeMap::new();
    for row in rows {
        let fault = |column: Option<&str>, message: String| TableFault {
            line: row.line,
            column: column.map(str::to_owned),
            found: None,
            message,
        };
        let before = first.entry(&row.posture).or_insert(row);
        let apart = row
            .shown
            .iter()
            .zip(&before.shown)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, larger);
        if apart > SAME_AXES {
            faults.push(fault(None, format!(
                "posture '{}' has other axes here than in line {}: give it another name, or, if the machine stood still, the same axes",
                row.posture, before.line
            )));
        }
        if row.mass > 0.0 && *gravity == Vector3::zeros() {
            faults.push(fault(Some("mass_kg"), "the model has no gravity, so that a mass pulls nowhere: write fz_n, or gravity_m_per_s2 in the model".to_owned()));
        }
    }
    faults
}

/// Observations that the geometry is identified from: places of markers, with and without a load, and beside them the displacements, turns
/// and gauges of [`observations`].
///
/// # Errors
/// Rows that contradict each other; displacements without a load.
pub fn places(
    rows: &[MeasuredRow],
    gravity: &Vector3<f64>,
) -> Result<Vec<Observation>, Vec<TableFault>> {
    let faults = contradictions(rows, gravity);
    let observation = |row: &MeasuredRow| {
        let (place, deviation) = (row.read.position?, row.deviation.unwrap_or(DEVIATION));
        Some(Observation {
            posture: row.posture.clone(),
            commands: row.commands.clone(),
            load: row.load_under(gravity),
            branch: None,
            readings: Reading::place(row.marker, &place, deviation).into(),
        })
    };
    if !faults.is_empty() {
        return Err(faults);
    }
    let mut found = Vec::new();
    for own in rows.iter().filter_map(observation) {
        add(&mut found, own);
    }
    let mut others = rows.to_vec();
    others.iter_mut().for_each(|row| row.read.position = None);
    others.retain(|row| row.read != Read::default());
    if !others.is_empty() {
        found.extend(observations(&others, gravity)?);
    }
    Ok(found)
}

/// Adds an observation: further markers of a posture under a load are read in the same equilibrium.
fn add(all: &mut Vec<Observation>, own: Observation) {
    let same = all.last_mut().filter(|last| {
        (&last.posture, &last.commands, last.load, last.branch)
            == (&own.posture, &own.commands, own.load, own.branch)
    });
    match same {
        Some(last) => last.readings.extend(own.readings),
        None => all.push(own),
    }
}

/// Observations from rows: displacements as they are, and positions under a load less the mean of those of the same marker in the
/// same posture without one. `gravity` (m/s^2, base axes) pulls at the masses.
///
/// # Errors
/// A loaded position without an unloaded one; displacements without a load.
pub fn observations(
    rows: &[MeasuredRow],
    gravity: &Vector3<f64>,
) -> Result<Vec<Observation>, Vec<TableFault>> {
    let mut faults = contradictions(rows, gravity);
    let mut found = Vec::new();
    let mut by_posture: BTreeMap<&str, Vec<&MeasuredRow>> = BTreeMap::new();
    for row in rows {
        by_posture.entry(&row.posture).or_default().push(row);
    }
    for row in rows {
        let beside = &by_posture[row.posture.as_str()];
        // Rows of a plan that were not measured yet.
        if row.read == Read::default() {
            continue;
        }
        let fault = |message: &str| TableFault {
            line: row.line,
            column: None,
            found: None,
            message: message.to_owned(),
        };
        let differs =
            row.read.displacement.is_some() || row.read.turn.is_some() || row.read.gauge.is_some();
        // Behind a loop of loading and unloading, friction leaves a displacement without a load.
        let closes_loop = differs && row.unloading == Some(true);
        if !row.is_loaded() && !closes_loop {
            if differs {
                faults.push(fault("a displacement without a load: all loads of this row are zero; give the load under which it was read, or positions (x_mm, y_mm, z_mm) of the unloaded tool"));
            }
            continue;
        }
        let deviation = row.deviation.unwrap_or(DEVIATION);
        let mut readings = Vec::new();
        if let Some(d) = &row.read.displacement {
            readings.extend(Reading::displacement(row.marker, d, deviation));
        }
        if let Some(turn) = &row.read.turn {
            readings.extend(Reading::turn(
                row.marker.on,
                turn,
                row.turn_deviation.unwrap_or(TURN_DEVIATION),
            ));
        }
        if let Some((value, direction)) = row.read.gauge {
            readings.push(Reading {
                of: ReadingOf::Along(direction),
                marker: row.marker,
                value,
                deviation,
            });
        }
        if let Some(position) = &row.read.position {
            let unloaded: Vec<(&Vector3<f64>, f64)> = beside
                .iter()
                .filter(|other| !other.is_loaded() && other.marker == row.marker)
                .filter_map(|other| {
                    let own = other.deviation.unwrap_or(DEVIATION);
                    Some((other.read.position.as_ref()?, own))
                })
                .collect();
            match unloaded.len() {
                0 => faults.push(fault("a position under a load, but none of the same marker in the same posture without one: add the unloaded reading (loads of zero), before and after the loaded one if you can")),
                count => {
                    let mean = unloaded.iter().map(|(place, _)| *place).sum::<Vector3<f64>>()
                        / count as f64;
                    // The unloaded mean has an error of its own.
                    let squares = unloaded.iter().map(|(_, own)| own * own).sum::<f64>();
                    let both = deviation.hypot(squares.sqrt() / count as f64);
                    readings.extend(Reading::displacement(row.marker, &(position - mean), both));
                }
            }
        }
        let own = Observation {
            posture: row.posture.clone(),
            commands: row.commands.clone(),
            load: row.load_under(gravity),
            branch: row.unloading.and_then(|unloading| {
                Some(Branch {
                    unloading,
                    whole: whole_load(beside, row, gravity)?,
                })
            }),
            readings,
        };
        add(&mut found, own);
    }
    if found.is_empty() && faults.is_empty() {
        faults.push(TableFault {
            line: 1,
            column: None,
            found: None,
            message: "no row has a load and a reading: nothing shows how stiff the machine is"
                .to_owned(),
        });
    }
    match faults.is_empty() {
        true => Ok(found),
        false => {
            faults.truncate(MOST_FAULTS);
            Err(faults)
        }
    }
}
