//! Points of a run as a table: one unit in every name, digits that mean something, a status in every
//! row.

use std::collections::BTreeSet;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{PointKind, PointResult, RunInputs, thinned};
use kinetostat_model::Controller;

use crate::program::flat_lines;
use crate::program::joint_columns::{JointColumns, one_word};
use crate::ui::csv_cell::{decimals, digits};
use crate::ui::failure::{Answer, Failing, Failure};

/// Points whose lines are in memory at a time.
const BLOCK: usize = 4096;

/// A table of all columns is kept below this size, bytes: what a spreadsheet opens and a mail carries.
const MOST_BYTES: usize = 7_000_000;

/// Bytes of a cell with its comma, at most on the average.
const CELL: usize = 9;

/// Selection of listed points, and the controller for their displayed values.
#[derive(Clone, Debug, Default)]
pub(crate) struct Listing {
    /// True if every point is listed, however large the table becomes.
    pub(crate) all: bool,
    pub(crate) controller: Option<Controller>,
}

/// Indices of the listed points if not all are: of a long program those that `thinned` keeps.
fn listed(run_inputs: &RunInputs, points: &[PointResult], listing: &Listing) -> Option<Vec<usize>> {
    let columns = header(run_inputs, points, listing).len();
    let most = MOST_BYTES / (CELL * columns);
    (!listing.all && points.len() > most).then(|| thinned(points, &[], most))
}

/// Note on a table that does not list every point.
pub(crate) fn note(
    run_inputs: &RunInputs,
    points: &[PointResult],
    listing: &Listing,
) -> Option<String> {
    let kept = listed(run_inputs, points, listing)?;
    Some(format!(
        "the table of points lists {} of {}: of every stretch its first point and those with the largest and the smallest error before and after, and the points that the figures come from; --all-points lists every one",
        kept.len(),
        points.len()
    ))
}

/// The table piece by piece; it opens in a spreadsheet, and the decimal mark is a point.
pub(crate) fn table(
    run_inputs: &RunInputs,
    points: &[PointResult],
    listing: &Listing,
    mut put: impl FnMut(&[u8]) -> Answer<()>,
) -> Answer<()> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let header = header(run_inputs, points, listing);
    writer.write_record(&header).map_err(failed)?;
    put(&bytes(writer)?)?;
    let lines = |block: &mut dyn Iterator<Item = &PointResult>| lines(run_inputs, listing, block);
    match listed(run_inputs, points, listing) {
        Some(kept) => kept
            .chunks(BLOCK)
            .try_for_each(|block| put(&lines(&mut block.iter().map(|i| &points[*i]))?)),
        None => points
            .chunks(BLOCK)
            .try_for_each(|block| put(&lines(&mut block.iter())?)),
    }
}

/// The rows of a part of a long program, one of so many, behind those of the parts before it; the header before the first.
pub(crate) fn part(
    run_inputs: &RunInputs,
    points: &[PointResult],
    listing: &Listing,
    parts: usize,
    begins: bool,
    mut put: impl FnMut(&[u8]) -> Answer<()>,
) -> Answer<()> {
    let header = header(run_inputs, points, listing);
    let most = MOST_BYTES / (CELL * header.len()) / parts.max(1);
    if begins {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(&header).map_err(failed)?;
        put(&bytes(writer)?)?;
    }
    let listed = match listing.all {
        true => (0..points.len()).collect(),
        false => thinned(points, &[], most),
    };
    listed.chunks(BLOCK).try_for_each(|block| {
        put(&lines(
            run_inputs,
            listing,
            &mut block.iter().map(|i| &points[*i]),
        )?)
    })
}

pub(crate) fn header(
    run_inputs: &RunInputs,
    points: &[PointResult],
    listing: &Listing,
) -> Vec<String> {
    let mut header: Vec<String> = ["line", "output_line", "kind", "share", "path_mm"]
        .map(String::from)
        .to_vec();
    for (name, unit) in [
        ("", "_mm"),
        ("error_before_", "_mm"),
        ("error_after_", "_mm"),
        ("correction_", "_mm"),
        ("force_", "_n"),
        ("moment_", "_n_m"),
    ] {
        header.extend(["x", "y", "z"].map(|axis| format!("{name}{axis}{unit}")));
    }
    // Orientation of the program: from tool axes to program axes.
    if run_inputs.states_orientation {
        header.extend(["w", "x", "y", "z"].map(|part| format!("orientation_{part}")));
    }
    header.push("residual_rotation_deg".into());
    // Turn of the tool from the requested orientation, if the orientation follows.
    if points.iter().any(|p| p.tool_turn_deg.is_some()) {
        header.push("tool_turn_deg".into());
    }
    let unit = |unit: &str| unit.replace(' ', "_").to_lowercase();
    let mut per = |quantity: &str, of: &dyn Fn(usize) -> String| {
        for (i, actuator) in run_inputs.actuators.iter().enumerate() {
            header.push(format!("{}_{quantity}_{}", one_word(&actuator.name), of(i)));
        }
    };
    per("command", &|i| unit(&run_inputs.actuators[i].motion_unit));
    per("force", &|i| unit(&run_inputs.actuators[i].force_unit));
    per("correction", &|i| {
        unit(&run_inputs.actuators[i].motion_unit)
    });
    header.extend(JointColumns::of(run_inputs).names());
    for axis in listing.controller.iter().flat_map(|c| c.axes()) {
        header.push(format!(
            "pendant_{}_{}",
            one_word(&axis.name),
            axis.unit.word()
        ));
    }
    header.extend(["smallest_stiffness_n_per_mm", "share_to_buckling", "status"].map(String::from));
    if run_inputs.flat.is_some() {
        header.extend(flat_lines::COLUMNS.map(String::from));
    }
    distinct(header)
}

/// Names that have become the same are numbered.
fn distinct(names: Vec<String>) -> Vec<String> {
    let mut used = BTreeSet::new();
    names
        .into_iter()
        .map(|name| {
            let mut own = name.clone();
            let mut number = 2;
            while !used.insert(own.clone()) {
                own = format!("{name}_{number}");
                number += 1;
            }
            own
        })
        .collect()
}

fn size([x, y, z]: &[f64; 3]) -> f64 {
    x.hypot(*y).hypot(*z)
}

fn lines(
    run_inputs: &RunInputs,
    listing: &Listing,
    points: &mut dyn Iterator<Item = &PointResult>,
) -> Answer<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::with_capacity(256 * BLOCK));
    rows(run_inputs, listing, points, |row| {
        writer.write_record(row).map_err(failed)
    })?;
    bytes(writer)
}

/// The cells of each point. Decimals: 1 nm for errors and corrections (the rounding of a program is 100 nm), 100 nm for places,
/// 0.01 N, 1e-5 deg; four digits of what is a ratio.
pub(crate) fn rows(
    run_inputs: &RunInputs,
    listing: &Listing,
    points: &mut dyn Iterator<Item = &PointResult>,
    mut put: impl FnMut(&[String]) -> Answer<()>,
) -> Answer<()> {
    let mut row: Vec<String> = Vec::new();
    let joints = JointColumns::of(run_inputs);
    for point in points {
        row.clear();
        row.push(point.line.to_string());
        row.push(point.output_line.to_string());
        row.push(
            match point.kind {
                PointKind::Feed => "feed",
                PointKind::Rapid => "rapid",
                PointKind::Corner => "corner",
                PointKind::Entry => "entry",
            }
            .into(),
        );
        row.push(decimals(point.share, 4));
        row.push(decimals(point.path_mm, 3));
        for (vector, most) in [
            (&point.position_mm, 4),
            (&point.error_before_mm, 6),
            (&point.error_after_mm, 6),
            (&point.correction_mm, 6),
            (&point.force_n, 2),
            (&point.moment_n_m, 5),
        ] {
            row.extend(vector.iter().map(|x| decimals(*x, most)));
        }
        if run_inputs.states_orientation {
            let parts = point
                .tool_orientation
                .map(|parts| parts.map(|x| decimals(x, 7)));
            row.extend(parts.unwrap_or_default());
        }
        row.push(decimals(point.residual_rotation_deg, 5));
        row.extend(point.tool_turn_deg.map(|turn| decimals(size(&turn), 5)));
        row.extend(point.actuator_command.iter().map(|x| decimals(*x, 5)));
        row.extend(point.actuator_force.iter().map(|x| decimals(*x, 3)));
        row.extend(point.actuator_correction.iter().map(|x| decimals(*x, 6)));
        row.extend(joints.cells(run_inputs, point));
        if let Some(controller) = &listing.controller {
            let shown = controller
                .coordinates(&in_si(run_inputs, point))
                .unwrap_or_default();
            row.extend(shown.iter().map(|x| decimals(*x, 5)));
        }
        row.push(digits(point.smallest_stiffness_n_per_mm, 5));
        row.push(
            point
                .share_to_buckling
                .map_or_else(String::new, |share| digits(rounded_away(share), 4)),
        );
        row.push(if point.stable { "ok" } else { "unstable" }.into());
        let source = flat_lines::cells(point.line, run_inputs.flat.as_ref());
        row.extend(source.into_iter().flatten());
        put(&row)?;
    }
    Ok(())
}

/// Shares below 1e-12 are the rounding of their arithmetic.
fn rounded_away(share: f64) -> f64 {
    match share.abs() < 1e-12 {
        true => 0.0,
        false => share,
    }
}

/// Joint values in m and rad.
fn in_si(run_inputs: &RunInputs, point: &PointResult) -> Vec<f64> {
    let units = run_inputs.actuators.iter().map(|a| a.motion_unit.as_str());
    let values = point.actuator_command.iter().zip(units);
    values
        .map(|(value, unit)| match unit {
            "mm" => 1e-3 * value,
            _ => value.to_radians(),
        })
        .collect()
}

fn bytes(writer: csv::Writer<Vec<u8>>) -> Answer<Vec<u8>> {
    let written = writer.into_inner();
    written.map_err(|error| failed(csv::Error::from(error.into_error())))
}

fn failed(error: csv::Error) -> Failure {
    ErrorCode::Internal.failure(format!("the table of points cannot be made: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_one_word_and_differ() {
        assert_eq!(one_word("leg x.slider"), "leg_x.slider");
        assert_eq!(one_word("=1+1"), "_1_1");
        let names = ["a_b", "a_b", "a_b_2", "c"].map(String::from).to_vec();
        assert_eq!(distinct(names), ["a_b", "a_b_2", "a_b_2_2", "c"]);
    }
}
