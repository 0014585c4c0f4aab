//! Rows of joint values as poses of the tool, and how far the tool goes from the straight way between them.

use std::ops::Range;

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::extreme::larger;
use crate::model::motion::{Frame, FrameUse};
use crate::model::site::{BetweenRows, JointsText, TableArm, TargetSite};
use crate::model::target::{Configuration, PoseTarget, Target};
use crate::options::ReadOptions;
use crate::poses::row::{Row, RowTarget};
use crate::text::number::NumberText;

/// Poses of joint values are in axes of the base.
pub(crate) fn base() -> FrameUse {
    FrameUse {
        name: "base".to_owned(),
        frame: Frame::Known(Isometry3::identity()),
    }
}

/// Target of a row of joint values, and their positions in the text.
pub(crate) fn joint_target(
    options: &ReadOptions,
    whole: Range<usize>,
    numbers: Vec<(NumberText, f64)>,
) -> (Target, TargetSite) {
    let joints = joints_of(&numbers);
    let Some(arm) = &options.arm else {
        let reason = "the row states joint values, and which pose they give is not known";
        let target = Target::Joints { values_deg: joints };
        return (target, TargetSite::Fixed(reason));
    };
    let tool = arm.arm.tool_pose(&joints);
    let pose = PoseTarget {
        position_mm: tool.translation.vector,
        orientation: tool.rotation,
        configuration: Configuration::default(),
        external: Vec::new(),
    };
    let text = JointsText {
        whole,
        numbers,
        arm: arm.clone(),
    };
    (Target::Pose(pose), TargetSite::Joints(Box::new(text)))
}

fn joints_of(numbers: &[(NumberText, f64)]) -> Vec<f64> {
    let numbers = numbers.iter();
    numbers.map(|(number, unit)| number.value * unit).collect()
}

/// Tolerated deviation of the tool from the straight line between rows, mm, ...
const MOST_MM: f64 = 0.1;

/// ... and turn otherwise than evenly, deg.
const MOST_DEG: f64 = 0.1;

/// Departures below this are not worth a word, mm.
const NOTHING_MM: f64 = 1e-4;

/// A row, what is wrong with it, and what to do.
type RowFault = (usize, String, &'static str);

/// Finding on the paths between rows, with its row.
pub(crate) fn between_rows(
    table: &TableArm,
    rows: &[Row],
) -> Result<Option<(usize, String)>, RowFault> {
    let mut before: Option<(Vec<f64>, Isometry3<f64>)> = None;
    let mut worst: Option<(usize, f64)> = None;
    for (index, row) in rows.iter().enumerate() {
        let RowTarget::Joints(numbers) = &row.target else {
            continue;
        };
        let joints = joints_of(numbers);
        let count = table.arm.joint_count();
        if joints.len() != count {
            return Err((
                index,
                format!("the table has {} joints, the arm {count}", joints.len()),
                "write a column for each joint of the arm, and no others with units of joints",
            ));
        }
        if joints.iter().any(|joint| joint.abs() > FARTHEST) {
            return Err((
                index,
                format!("a joint value is beyond {FARTHEST}"),
                "write degrees, radians, mm or m, and say it in the name of the column",
            ));
        }
        let tool = table.arm.tool_pose(&joints);
        if let (Some((from, start)), BetweenRows::Joint, false) =
            (&before, table.between, row.rapid)
        {
            let (off_mm, off_deg) = departure(table, [from, &joints], [start, &tool]);
            // NaN counts as too far.
            let near = off_mm <= MOST_MM && off_deg <= MOST_DEG;
            if !near {
                return Err((
                    index,
                    format!(
                        "with all joints in step the tool leaves the straight way to this row by {off_mm:.3} mm and {off_deg:.3} deg; up to {MOST_MM} mm and {MOST_DEG} deg it is taken for straight"
                    ),
                    "write more rows between, mark motions in air (rapid 1), or say that the controller goes straight (joint_rows = \"linear\")",
                ));
            }
            if worst.is_none_or(|(_, most)| off_mm > most) {
                worst = Some((index, off_mm));
            }
        }
        before = Some((joints, tool));
    }
    Ok(worst
        .filter(|(_, off_mm)| *off_mm > NOTHING_MM)
        .map(|(index, off_mm)| {
            let words = format!(
                "from row to row all joints move in step: there the tool leaves the straight way by up to {:.1} um, here most; straight ways are corrected",
                1e3 * off_mm
            );
            (index, words)
        }))
}

/// Largest joint value, deg or mm.
const FARTHEST: f64 = 1e6;

/// Deviation of the tool from the straight line between two rows, mm, and of its rotation from an even one, deg.
fn departure(
    table: &TableArm,
    [from, to]: [&[f64]; 2],
    [start, end]: [&Isometry3<f64>; 2],
) -> (f64, f64) {
    let way = end.translation.vector - start.translation.vector;
    let square = way.norm_squared();
    let turn = (start.rotation.inverse() * end.rotation).scaled_axis();
    let (mut most_mm, mut most_deg) = (0.0, 0.0);
    for share in [0.25, 0.5, 0.75] {
        let joints: Vec<f64> = (from.iter().zip(to))
            .map(|(a, b)| a + share * (b - a))
            .collect();
        let tool = table.arm.tool_pose(&joints);
        let gone = tool.translation.vector - start.translation.vector;
        let along = match square > 0.0 {
            true => gone.dot(&way) / square,
            false => share,
        };
        let off: Vector3<f64> = gone - along * way;
        let even = start.rotation * UnitQuaternion::from_scaled_axis(along * turn);
        most_mm = larger(most_mm, off.norm());
        most_deg = larger(most_deg, tool.rotation.angle_to(&even).to_degrees());
    }
    (most_mm, most_deg)
}
