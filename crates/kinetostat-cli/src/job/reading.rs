//! Reading of the program: units, work offsets, arcs, optional blocks.

use kinetostat_diagnostic::ErrorCode;
use kinetostat_program::{BlockDelete, OtherAxes, ReadOptions, ToolCentrePoint, Units};
use nalgebra::Vector3;

use crate::job::arguments::ReadingArgs;
use crate::job::format::BlockDeleteWord;
use crate::job::job_file::JobFile;
use crate::job::units_word::UnitsWord;
use crate::job::values::{arc_tolerance, chosen};
use crate::options::vector;
use crate::ui::failure::{Answer, Failing};

pub(crate) fn reading(job: Option<&JobFile>, flags: &ReadingArgs) -> Answer<ReadOptions> {
    let table = job.map(|j| j.job.reading.clone()).unwrap_or_default();
    let mut reading = {
        let mut reading = ReadOptions::default();
        reading.units = flags.units.or(table.units).map(|u| match u {
            UnitsWord::Mm => Units::Millimetres,
            UnitsWord::Inch => Units::Inches,
        });
        reading
    };
    if let Some(mm) = chosen(
        job,
        "--arc-tolerance",
        flags.arc_tolerance,
        table.arc_tolerance_mm.as_ref(),
        arc_tolerance,
    )? {
        reading.arc_tolerance_mm = mm;
    }
    if let Some(word) = flags.block_delete.or(table.block_delete) {
        reading.block_delete = match word {
            BlockDeleteWord::Run => BlockDelete::Run,
            BlockDeleteWord::Skip => BlockDelete::Skip,
        };
    }
    if flags.axes_stand_still || table.axes_stand_still.unwrap_or_default() {
        reading.other_axes = OtherAxes::StandStill;
    }
    if flags.tool_centre_point || table.tool_centre_point.unwrap_or_default() {
        reading.tool_centre_point = ToolCentrePoint::Throughout;
    }
    if let Some(j) = job.filter(|j| !j.job.tools.is_empty()) {
        let numbers = j.job.tools.iter().map(|tool| tool.get_ref().number);
        reading.tools = Some(numbers.collect());
        reading.tool_before_first = j.job.tool.length_mm.is_some() || j.job.tool.pose.is_some();
    }
    let start = &flags.start_position_mm;
    reading.start_position_mm = place("--start-position-mm", start, table.start_position_mm)?;
    let zero = &flags.machine_zero_mm;
    reading.machine_zero_mm = place("--machine-zero-mm", zero, table.machine_zero_mm)?;
    reading.reference_points_mm = [
        place("--g28-mm", &flags.g28_mm, table.g28_mm)?,
        place("--g30-mm", &flags.g30_mm, table.g30_mm)?,
    ];
    let left_out = job.is_some_and(|j| j.lacks("machine_zero_mm"));
    let no_zero = reading.machine_zero_mm.is_none() && !left_out;
    if no_zero && reading.reference_points_mm != [None; 2] {
        return Err(ErrorCode::Missing.failure("a reference point (g28_mm, g30_mm) counts from the machine's zero, and where that lies in the part is not stated: give it as machine_zero_mm under [reading] in the job file, or --machine-zero-mm".to_owned(),
        ));
    }
    if let (Some(j), Some(offsets)) = (job, &table.work_offset_mm) {
        let mut given: Vec<usize> = Vec::new();
        for (name, value) in offsets.get_ref() {
            let index = work_offset(name).ok_or_else(|| {
                j.error(
                    offsets,
                    &format!("'{name}' is no work coordinate system"),
                    "there are G54, G55, G56, G57, G58, G59, \"G59.1\", \"G59.2\", \"G59.3\"",
                )
            })?;
            if given.contains(&index) {
                let what = format!("the origin of {} is given twice", WORK_OFFSETS[index]);
                return Err(j.error(offsets, &what, "keep one of the two"));
            }
            given.push(index);
            reading.work_offsets_mm[index] = Some(Vector3::from(*value));
        }
    }
    let mut given: Vec<usize> = Vec::new();
    for text in &flags.work_offset {
        let refuse = || {
            ErrorCode::Value.failure(format!(
                    "--work-offset '{text}': write the coordinate system and its origin in the part in mm, as in G54=10,0,-5"
                ),
            )
        };
        let (name, values) = text.split_once('=').ok_or_else(refuse)?;
        let index = work_offset(name.trim()).ok_or_else(refuse)?;
        if given.contains(&index) {
            return Err(ErrorCode::Conflict.failure(format!(
                "--work-offset '{text}': the origin of {} is given twice; keep one of the two",
                WORK_OFFSETS[index]
            )));
        }
        given.push(index);
        let numbers: Vec<f64> = values
            .split(',')
            .map(|v| v.trim().parse().ok().filter(|x: &f64| x.is_finite()))
            .collect::<Option<_>>()
            .ok_or_else(refuse)?;
        let [x, y, z] = numbers[..] else {
            return Err(refuse());
        };
        reading.work_offsets_mm[index] = Some(Vector3::new(x, y, z));
    }
    Ok(reading)
}

/// A place by an option, which goes before the job file's.
fn place(
    option: &str,
    flag: &Option<Vec<f64>>,
    table: Option<[f64; 3]>,
) -> Answer<Option<Vector3<f64>>> {
    match (flag, table) {
        (Some(values), _) => vector(option, values).map(Some),
        (None, table) => Ok(table.map(Vector3::from)),
    }
}

const WORK_OFFSETS: [&str; 9] = [
    "G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3",
];

/// Index of the frame of G-code with this name.
pub(crate) fn work_offset(name: &str) -> Option<usize> {
    WORK_OFFSETS
        .iter()
        .position(|known| known.eq_ignore_ascii_case(name))
}
