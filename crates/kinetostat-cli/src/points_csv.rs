//! All points of a run as a table: units in the header, full precision, a status in every row.

use kinetostat_machining::{PointKind, PointResult, Question};

use crate::failure::{Answer, Failure};

/// Points whose lines are in memory at a time.
const BLOCK: usize = 4096;

/// The table piece by piece; it opens in a spreadsheet, and the decimal mark is a point.
pub(crate) fn table(
    question: &Question,
    points: &[PointResult],
    mut put: impl FnMut(&[u8]) -> Answer<()>,
) -> Answer<()> {
    put(&header(question)?)?;
    points
        .chunks(BLOCK)
        .try_for_each(|block| put(&lines(block)?))
}

fn header(question: &Question) -> Answer<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut header: Vec<String> = ["line", "output_line", "kind", "share", "path_mm"]
        .map(String::from)
        .to_vec();
    for (name, unit) in [
        ("", "_mm"),
        ("error_before_", "_mm"),
        ("error_after_", "_mm"),
        ("correction_", "_mm"),
        ("force_", "_n"),
    ] {
        header.extend(["x", "y", "z"].map(|axis| format!("{name}{axis}{unit}")));
    }
    header.push("residual_rotation_deg".into());
    for actuator in &question.actuators {
        let unit = actuator.force_unit.replace(' ', "_").to_lowercase();
        header.push(text(&format!("actuator_force_{unit} {}", actuator.name)));
    }
    for actuator in &question.actuators {
        let unit = &actuator.motion_unit;
        header.push(text(&format!(
            "actuator_correction_{unit} {}",
            actuator.name
        )));
    }
    header.extend(["smallest_stiffness_n_per_mm", "buckling_margin", "status"].map(String::from));
    writer.write_record(&header).map_err(failed)?;
    bytes(writer)
}

fn lines(points: &[PointResult]) -> Answer<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::with_capacity(512 * points.len()));
    let mut row: Vec<String> = Vec::new();
    for point in points {
        row.clear();
        row.push(point.line.to_string());
        row.push(point.output_line.to_string());
        row.push(
            match point.kind {
                PointKind::Feed => "feed",
                PointKind::Rapid => "rapid",
                PointKind::Corner => "corner",
            }
            .into(),
        );
        row.push(point.share.to_string());
        row.push(point.path_mm.to_string());
        for vector in [
            &point.position_mm,
            &point.error_before_mm,
            &point.error_after_mm,
            &point.correction_mm,
            &point.force_n,
        ] {
            row.extend(vector.iter().map(f64::to_string));
        }
        row.push(point.residual_rotation_deg.to_string());
        row.extend(point.actuator_force.iter().map(f64::to_string));
        row.extend(point.actuator_correction.iter().map(f64::to_string));
        row.push(point.smallest_stiffness_n_per_mm.to_string());
        row.push(
            point
                .buckling_margin
                .map_or_else(String::new, |m| m.to_string()),
        );
        row.push(if point.stable { "ok" } else { "unstable" }.into());
        writer.write_record(&row).map_err(failed)?;
    }
    bytes(writer)
}

fn bytes(writer: csv::Writer<Vec<u8>>) -> Answer<Vec<u8>> {
    let written = writer.into_inner();
    written.map_err(|error| failed(csv::Error::from(error.into_error())))
}

/// A text that a spreadsheet would take for a formula is led by an apostrophe.
pub(crate) fn text(cell: &str) -> String {
    if cell.starts_with(['=', '+', '-', '@', '\t', '\r']) {
        format!("'{cell}")
    } else {
        cell.to_owned()
    }
}

fn failed(error: csv::Error) -> Failure {
    Failure::input(format!("the table of points cannot be made: {error}"))
}
