//! The reader of lists of poses.

use nalgebra::Vector3;

use crate::error::{ProgramError, note};
use crate::model::Language;
use crate::model::motion::{FrameUse, Motion, MotionKind, Runs, Speed, Zone};
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::model::site::{MotionSite, PoseText, SpeedSite, TargetSite};
use crate::model::target::{Configuration, PoseTarget, Target};
use crate::options::{ExternalAxes, LengthUnit, ReadOptions};
use crate::poses::csv::{Carrier, parquet_row, read_table, with_points};
use crate::poses::joints::{base, between_rows, joint_target};
use crate::poses::row::{Reach, Row, RowTarget, Rows, mm_of};
use crate::poses::yaml::read_yaml;
use crate::text::number::{Width, values_of};
use crate::text::source::{Finding, SourceFile};

const MOST_BYTES: usize = 1 << 28;

/// Magic bytes of a Parquet file.
const PARQUET: &[u8] = b"PAR1";

const PARQUET_REASON: &str = "the table is in Parquet, which is not read here";
const PARQUET_REMEDY: &str = "write it as CSV (in Python  pandas.read_parquet('a.parquet').to_csv('a.csv', index=False)), or build kinetostat with its feature `parquet`";

/// Reads lists of poses: tables (`.csv`, `.tsv`) and YAML (`.yaml`, `.yml`).
///
/// A table has a line of names with units in front (`x_mm,y_mm,z_mm`, `qw,qx,qy,qz`, `speed_mm_per_s`, ...; all of them:
/// [`crate::POSES_STATEMENTS`]), in any order, between commas, semicolons or tabs; decimal commas may
/// stand between the latter two, and are written again. In YAML a raster is a list of items with
/// `position` and `orientation`. The first pose of a raster is reached by a joint motion, the others on straight lines. A
/// table of joint values (`joint_1_deg`, ...) is read as [`Target::Joints`], which is not corrected.
///
/// Lengths are in the unit that the names say, or [`ReadOptions::length_unit`]; ROS messages (with `stamp` and `frame_id`)
/// of a plausible size are in metres. All else is refused.
///
/// ```
/// use kinetostat_formats::{MotionKind, ReadOptions, SourceFile, read_poses};
///
/// let text = "# a slot\nx_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_per_s,note\n\
///     0,0,20,0,0,1,0,,above\n0,0,-1,0,0,1,0,20,down\n60,0,-1,0,0,1,0,20,along\n";
/// let program = read_poses(vec![SourceFile::new("slot.csv", text)], &ReadOptions::default()).unwrap();
/// assert_eq!(program.motions.len(), 3);
/// assert_eq!(program.motions[0].kind, MotionKind::Joint);
/// assert_eq!(program.motions[2].speed.mm_per_s, Some(20.0));
/// assert_eq!(program.motions[2].target.pose().unwrap().position_mm.x, 60.0);
///
/// let text = text.replace("x_mm", "x");
/// let errors = read_poses(vec![SourceFile::new("slot.csv", text)], &ReadOptions::default()).unwrap_err();
/// assert!(errors[0].to_string().contains("in another unit"));
/// ```
///
/// # Errors
/// All that is refused, in the order of files and lines.
pub fn read_poses(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    parse_poses(files, options).without_faults()
}

/// Reads a list of poses; the motions of readable rows are returned beside the errors.
pub(crate) fn parse_poses(files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
    let mut reader = Reader {
        options,
        faults: Vec::new(),
        findings: Vec::new(),
        motions: Vec::new(),
    };
    for (index, file) in files.iter().enumerate() {
        if let Some(fault) = ProgramError::too_large(file, MOST_BYTES) {
            reader.faults.push(fault);
            continue;
        }
        if file.bytes().starts_with(PARQUET) {
            reader
                .faults
                .push(ProgramError::at(file, 0..4, PARQUET_REASON, PARQUET_REMEDY));
            continue;
        }
        let before = reader.faults.len();
        let with_points = with_points(file);
        reader.file(index, with_points.as_ref().unwrap_or(file));
        for fault in &mut reader.faults[before..] {
            // Such a file has no lines that a person could look up.
            if let Some(row) = parquet_row(file, &fault.span) {
                fault.reason += &format!(" (row {row}, the first is 0)");
            }
        }
    }
    let Reader {
        motions,
        findings,
        faults,
        ..
    } = reader;
    Parsed::of(Language::Poses, files, motions, findings, faults)
}

struct Reader<'o> {
    options: &'o ReadOptions,
    faults: Vec<ProgramError>,
    findings: Vec<Finding>,
    motions: Vec<Motion>,
}

/// Unit as a list states it.
struct Said {
    named: Option<LengthUnit>,
    is_ros: bool,
}

const UNIT_REMEDY: &str =
    "state it: in the names (x_mm or x_m), or with length_unit = \"m\" under [robot] in a job file";

impl Reader<'_> {
    fn file(&mut self, index: usize, file: &SourceFile) {
        let (rows, said) = match Carrier::of(file) {
            Carrier::Table => {
                let (rows, named) = read_table(file);
                let is_ros = false;
                (rows, Said { named, is_ros })
            }
            Carrier::Yaml => {
                let found = read_yaml(file);
                let (named, is_ros) = (found.unit, found.is_ros);
                (found.rows, Said { named, is_ros })
            }
        };
        let Rows {
            rows,
            faults,
            findings,
        } = rows;
        let refused = !faults.is_empty();
        self.faults.extend(faults);
        for (at, message) in findings {
            self.finding(index, file, at, message);
        }
        self.external(file, &rows);
        // With refused rows, the other rows are only checked one by one.
        let unit = match refused {
            true => said.named.or(self.options.length_unit),
            false => self.unit(index, file, &rows, &said),
        };
        let Some(unit) = unit else {
            return;
        };
        if let Some(arm) = self.options.arm.as_ref().filter(|_| !refused) {
            match between_rows(arm, &rows) {
                Ok(None) => {}
                Ok(Some((row, words))) => self.finding(index, file, rows[row].span.start, words),
                Err((row, reason, remedy)) => {
                    self.fault(file, &rows[row], &reason, remedy);
                    return;
                }
            }
        }
        let from = self.motions.len();
        for row in rows {
            let follows = (self.motions.len() > from).then(|| self.motions.len() - 1);
            let motion = self.motion(index, file, row, unit, follows);
            self.motions.push(motion);
        }
    }

    fn finding(&mut self, index: usize, file: &SourceFile, at: usize, message: String) {
        self.findings.push(Finding {
            file: index,
            line: file.line_of(at),
            message,
        });
    }

    fn fault(&mut self, file: &SourceFile, row: &Row, reason: &str, remedy: &str) {
        note(&mut self.faults, || {
            ProgramError::at(file, row.span.clone(), reason, remedy)
        });
    }

    /// The unit of the places of a file; none where it is not known.
    fn unit(
        &mut self,
        index: usize,
        file: &SourceFile,
        rows: &[Row],
        said: &Said,
    ) -> Option<LengthUnit> {
        let is_pose = |row: &&Row| matches!(row.target, RowTarget::Pose { .. });
        let Some(first) = rows.iter().find(is_pose) else {
            return Some(LengthUnit::Millimetre);
        };
        let reach = Reach::of(rows);
        let unit = match (said.named, self.options.length_unit) {
            (Some(named), Some(stated)) if named != stated => {
                let reason =
                    "the names of the columns state another unit of lengths than length_unit does";
                self.fault(file, first, reason, "correct one of the two");
                return None;
            }
            (Some(unit), _) | (None, Some(unit)) => unit,
            (None, None) if said.is_ros && reach.looks_like_metres() => {
                let message = format!(
                    "no unit of lengths is stated: taken as metres, as in messages of ROS (REP 103); the path is {:.3} m long in its longest direction",
                    reach.extent
                );
                self.finding(index, file, first.span.start, message);
                LengthUnit::Metre
            }
            (None, None) => {
                let reason = format!(
                    "whether lengths are mm or m is not stated; the numbers reach {} from the origin",
                    reach.farthest
                );
                self.fault(file, first, &reason, UNIT_REMEDY);
                return None;
            }
        };
        if unit == LengthUnit::Metre && reach.farthest == 0.0 {
            let reason = "all places are 0";
            self.fault(file, first, reason, "write the places of the tool");
            return None;
        }
        if let Some(doubt) = reach.doubt(unit) {
            self.finding(index, file, first.span.start, doubt);
        }
        Some(unit)
    }

    /// Refuses external axes that move.
    fn external(&mut self, file: &SourceFile, rows: &[Row]) {
        if self.options.external_axes == ExternalAxes::Carried {
            return;
        }
        let moved = (rows.windows(2)).find(|pair| {
            let [before, now] = [0, 1].map(|row: usize| values_of(&pair[row].external));
            before != now
        });
        if let Some([_, row]) = moved {
            let reason = "an external axis moves here: the arm stands elsewhere then";
            let remedy = "if what they move is known, let them be carried (external_axes = \"carried\" under [robot] in a job file)";
            self.fault(file, row, reason, remedy);
        }
    }

    fn frame(&self, name: &str) -> FrameUse {
        let mut frames = self.options.frames.iter();
        let stated = frames.find(|(own, _)| own.eq_ignore_ascii_case(name));
        FrameUse::stated(name, stated.map(|(_, frame)| frame), "the file")
    }

    fn motion(
        &self,
        index: usize,
        file: &SourceFile,
        row: Row,
        unit: LengthUnit,
        follows: Option<usize>,
    ) -> Motion {
        let tool = self.frame(&row.tool);
        let external = values_of(&row.external);
        let work_object = match row.target {
            RowTarget::Joints(_) => base(),
            RowTarget::Pose { .. } => self.frame(&row.frame),
        };
        let (target, site) = match row.target {
            RowTarget::Joints(numbers) => joint_target(self.options, row.span.clone(), numbers),
            RowTarget::Pose {
                position,
                orientation,
                convention,
            } => {
                let values: Vec<f64> = orientation.iter().map(|number| number.value).collect();
                let place = Vector3::from_fn(|axis, _| position[axis].value * mm_of(unit));
                let pose = PoseTarget {
                    position_mm: place,
                    orientation: convention.rotation_of(&values).unwrap_or_default(),
                    configuration: Configuration::default(),
                    external: external.clone(),
                };
                let text = PoseText {
                    file: index,
                    whole: row.span.clone(),
                    position,
                    orientation,
                    unit_mm: 1.0,
                    convention,
                    external: row.external,
                    width: Width::Free,
                };
                (Target::Pose(pose), TargetSite::Literal(text))
            }
        };
        let kind = match (row.rapid, &target) {
            (false, Target::Pose(_)) => MotionKind::Linear,
            _ => MotionKind::Joint,
        };
        let speed = Speed {
            mm_per_s: row.speed.as_ref().map(|(_, speed, _)| *speed),
            text: (row.speed.as_ref()).map_or(String::new(), |(span, _, _)| {
                String::from_utf8_lossy(file.part(span)).into_owned()
            }),
        };
        Motion {
            file: index,
            line: file.line_of(row.span.start),
            kind,
            target,
            speed,
            zone: Zone::Unstated,
            tool,
            work_object,
            runs: Runs::Once,
            follows,
            site: MotionSite {
                keyword: row.span.start..row.span.start,
                target_span: row.span.clone(),
                target: site,
                via: None,
                speed: row
                    .speed
                    .filter(|(_, _, exact)| *exact)
                    .map(|(span, _, _)| SpeedSite {
                        span,
                        before: String::new(),
                        after: String::new(),
                        unit_mm_per_s: 1.0,
                    }),
                zone: None,
                external,
                other_speeds: None,
                external_moved_behind: false,
                indivisible: row.indivisible,
                turns_otherwise: None,
            },
            span: row.span,
        }
    }
}
