//! A table of poses, as it is made here, as one of joint values.

use nalgebra::{Isometry3, Quaternion, UnitQuaternion, Vector3};

use crate::model::site::{BetweenRows, TableArm};

/// Decimals of joint values: a thousandth of a billionth of a degree.
const DECIMALS: usize = 12;

/// Limit of the halvings of a path on which all joints move in step.
const MOST_HALVINGS: u32 = 20;

/// Start of a table of joint values, and axes of its poses.
///
/// ```
/// let from = kinetostat_formats::JointStart::default();
/// assert_eq!((from.tolerance_mm, from.near.len()), (0.001, 0));
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct JointStart {
    /// Transformation from the axes of the poses to those of the robot's base, mm.
    pub base: Isometry3<f64>,
    /// Joint values next to the first row, as the table has them: they say in which configuration the arm is.
    pub near: Vec<f64>,
    /// Tolerated deviation of the tool from straight lines when all joints move in step, mm.
    pub tolerance_mm: f64,
    /// Rapids go straight, too; otherwise all joints move in step from one end of them to the other.
    pub straight_rapids: bool,
}

impl Default for JointStart {
    fn default() -> Self {
        Self {
            base: Isometry3::identity(),
            near: Vec::new(),
            tolerance_mm: 1e-3,
            straight_rapids: true,
        }
    }
}

/// A table of joint values that was made.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct JointTable {
    /// The table, as text.
    pub bytes: Vec<u8>,
    /// Line in the table of poses (from 1) and joint values of each row; inserted rows have the line of the later pose.
    pub rows: Vec<(usize, Vec<f64>)>,
    /// Deviation of the poses of the written joint values from those of the table, mm and rad.
    pub departure: [f64; 2],
    /// Deviation of the middle of an undivided rapid from the straight line when all joints move in step, mm.
    pub rapid_departure_mm: f64,
}

/// A row of a table of poses that becomes no joint values.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {reason}")]
#[non_exhaustive]
pub struct JointTableError {
    /// Line of the table of poses, counted from 1.
    pub line: usize,
    /// Reason and remedy.
    pub reason: String,
}

impl JointTableError {
    fn at(line: usize, reason: impl Into<String>) -> Self {
        let reason = reason.into();
        Self { line, reason }
    }
}

/// The table of poses of a [`crate::Made`] (in [`crate::MakeLanguage::Csv`], with orientations) as a table of joint values: each
/// next to the one before, so that the arm stays in its configuration. Between rows the controller goes as the arm says: straight, one
/// row for each pose; or with all joints in step, as many rows as keep the tool within the tolerance of the straight ways at feed.
///
/// ```
/// use std::sync::Arc;
/// use kinetostat_formats::*;
/// use nalgebra::Isometry3;
///
/// /// Two slides, x and y, that carry the tool.
/// #[derive(Debug)]
/// struct Slides;
/// impl JointArm for Slides {
///     fn joint_count(&self) -> usize {
///         2
///     }
///     fn tool_pose(&self, joints: &[f64]) -> Isometry3<f64> {
///         Isometry3::translation(joints[0], joints[1], 0.0)
///     }
///     fn joints_near(&self, tool: &Isometry3<f64>, _near: &[f64]) -> Option<Vec<f64>> {
///         Some(vec![tool.translation.x, tool.translation.y])
///     }
/// }
///
/// let arm = TableArm { arm: Arc::new(Slides), between: BetweenRows::Linear };
/// let poses = "# slot\nx_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_per_s,rapid\n5,7.5,0,1,0,0,0,20,0\n";
/// let made = joint_table(poses.as_bytes(), &arm, &JointStart::default())?;
/// let text = String::from_utf8(made.bytes).unwrap();
/// assert_eq!(
///     text,
///     "# slot\njoint_1_deg,joint_2_deg,speed_mm_per_s,rapid\n5.000000000000,7.500000000000,20,0\n"
/// );
/// assert_eq!(made.departure, [0.0, 0.0]);
/// # Ok::<(), JointTableError>(())
/// ```
///
/// # Errors
/// A table without orientations, or of another form; a pose that the arm does not reach from the one before.
pub fn joint_table(
    poses: &[u8],
    arm: &TableArm,
    start: &JointStart,
) -> Result<JointTable, JointTableError> {
    let text = String::from_utf8_lossy(poses);
    let mut table = Table {
        arm,
        start,
        before: None,
        text: String::new(),
        rows: Vec::new(),
        departure: [0.0; 2],
        rapid_departure_mm: 0.0,
    };
    let mut head_is_read = false;
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        match line.strip_prefix("x_mm,y_mm,z_mm,") {
            _ if line.is_empty() || line.starts_with('#') => {
                table.text += line;
                table.text.push('\n');
            }
            Some(rest @ (ONE_TOOL | SEVERAL_TOOLS)) => {
                head_is_read = true;
                for joint in 1..=arm.arm.joint_count() {
                    table.text += &format!("joint_{joint}_deg,");
                }
                let behind = rest.trim_start_matches(TURN);
                table.text += &format!("{behind}\n");
            }
            Some(_) => {
                return Err(JointTableError::at(
                    number,
                    "the path does not say how the tool stands: state its orientation (tool_orientation)",
                ));
            }
            None if head_is_read => table.read_row(number, line)?,
            None => return Err(JointTableError::at(number, "it is no table of poses")),
        }
    }
    Ok(JointTable {
        bytes: table.text.into_bytes(),
        rows: table.rows,
        departure: table.departure,
        rapid_departure_mm: table.rapid_departure_mm,
    })
}

/// The columns of a table behind the places.
const TURN: &str = "qw,qx,qy,qz,";
const ONE_TOOL: &str = "qw,qx,qy,qz,speed_mm_per_s,rapid";
const SEVERAL_TOOLS: &str = "qw,qx,qy,qz,speed_mm_per_s,tool,rapid";

/// A table as it grows.
struct Table<'a> {
    arm: &'a TableArm,
    start: &'a JointStart,
    /// The last pose and its joint values.
    before: Option<(Isometry3<f64>, Vec<f64>)>,
    text: String,
    rows: Vec<(usize, Vec<f64>)>,
    departure: [f64; 2],
    rapid_departure_mm: f64,
}

impl Table<'_> {
    fn read_row(&mut self, line: usize, text: &str) -> Result<(), JointTableError> {
        let other = || JointTableError::at(line, "it is no row of such a table");
        let mut cells = text.splitn(8, ',');
        let mut numbers = [0.0; 7];
        for number in &mut numbers {
            let cell = cells.next().and_then(|cell| cell.parse().ok());
            *number = cell
                .filter(|value: &f64| value.is_finite())
                .ok_or_else(other)?;
        }
        let rest = cells.next().ok_or_else(other)?;
        let [x, y, z, qw, qx, qy, qz] = numbers;
        let turn = UnitQuaternion::try_new(Quaternion::new(qw, qx, qy, qz), 1e-3);
        let pose = Isometry3::from_parts(Vector3::new(x, y, z).into(), turn.ok_or_else(other)?);
        let pose = self.start.base * pose;
        let is_straight = self.start.straight_rapids || rest.ends_with(",0");
        let before = self.before.take();
        let joints = match &before {
            None => self.joints_next_to(line, &pose, &self.start.near)?,
            Some((from, near)) => {
                let joints = self.joints_next_to(line, &pose, near)?;
                let way = [(from, near.as_slice()), (&pose, joints.as_slice())];
                match (self.arm.between, is_straight) {
                    (BetweenRows::Joint, true) => {
                        self.rows_between(line, way, rest, MOST_HALVINGS)?;
                    }
                    (BetweenRows::Joint, false) => {
                        let [off_mm, _] = self.in_the_middle(way).1;
                        if off_mm > self.rapid_departure_mm || off_mm.is_nan() {
                            self.rapid_departure_mm = off_mm;
                        }
                    }
                    (BetweenRows::Linear, _) => {}
                }
                joints
            }
        };
        self.write_row(line, &pose, &joints, rest);
        self.before = Some((pose, joints));
        Ok(())
    }

    fn joints_next_to(
        &self,
        line: usize,
        pose: &Isometry3<f64>,
        near: &[f64],
    ) -> Result<Vec<f64>, JointTableError> {
        let found = self.arm.arm.joints_near(pose, near);
        let found = found.filter(|joints| joints.iter().all(|joint| joint.is_finite()));
        found.ok_or_else(|| {
            let at = pose.translation.vector;
            JointTableError::at(
                line,
                format!(
                    "from where the arm stands before it does not come straight to ({:.3}, {:.3}, {:.3}) mm in its base: the way is out of reach, or passes a singular posture; move the part, turn the tool, or go there by way of another place",
                    at.x, at.y, at.z
                ),
            )
        })
    }

    /// The pose halfway along the straight way, and how far the tool is from it where all joints move in step.
    fn in_the_middle(
        &self,
        [(from, near), (to, joints)]: [(&Isometry3<f64>, &[f64]); 2],
    ) -> (Isometry3<f64>, [f64; 2]) {
        let middle: Vec<f64> = (near.iter().zip(joints))
            .map(|(a, b)| 0.5 * (a + b))
            .collect();
        let place = 0.5 * (from.translation.vector + to.translation.vector);
        let turn = (from.rotation.inverse() * to.rotation).scaled_axis();
        let turn = from.rotation * UnitQuaternion::from_scaled_axis(0.5 * turn);
        let straight = Isometry3::from_parts(place.into(), turn);
        let off = apart(&straight, &self.arm.arm.tool_pose(&middle));
        (straight, off)
    }

    /// Rows between two, so that the tool stays near the straight way where all joints move in step.
    fn rows_between(
        &mut self,
        line: usize,
        [(from, near), (to, joints)]: [(&Isometry3<f64>, &[f64]); 2],
        rest: &str,
        halvings: u32,
    ) -> Result<(), JointTableError> {
        let (straight, [off_mm, off_rad]) = self.in_the_middle([(from, near), (to, joints)]);
        // A turn by a thousandth of a degree is as good as one micrometre.
        let is_near =
            off_mm <= self.start.tolerance_mm && off_rad <= (self.start.tolerance_mm).to_radians();
        if is_near || halvings == 0 {
            return Ok(());
        }
        let middle = self.joints_next_to(line, &straight, near)?;
        self.rows_between(
            line,
            [(from, near), (&straight, &middle)],
            rest,
            halvings - 1,
        )?;
        self.write_row(line, &straight, &middle, rest);
        self.rows_between(
            line,
            [(&straight, &middle), (to, joints)],
            rest,
            halvings - 1,
        )
    }

    fn write_row(&mut self, line: usize, pose: &Isometry3<f64>, joints: &[f64], rest: &str) {
        let mut written = Vec::with_capacity(joints.len());
        for joint in joints {
            let text = format!("{joint:.DECIMALS$}");
            written.push(text.parse().unwrap_or(*joint));
            self.text += &text;
            self.text.push(',');
        }
        self.text += rest;
        self.text.push('\n');
        let off = apart(pose, &self.arm.arm.tool_pose(&written));
        for (most, off) in self.departure.iter_mut().zip(off) {
            // NaN counts as the largest.
            if off > *most || off.is_nan() {
                *most = off;
            }
        }
        self.rows.push((line, written));
    }
}

/// Distance of two poses, mm and rad.
fn apart(a: &Isometry3<f64>, b: &Isometry3<f64>) -> [f64; 2] {
    let off = a.translation.vector - b.translation.vector;
    [off.norm(), a.rotation.angle_to(&b.rotation)]
}
