//! Meaning and treatment of the names of columns and keys.

use crate::model::orientation::OrientationText;
use crate::options::LengthUnit;
use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{StatementRow, Treatment, line};

/// Content of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Column {
    /// A coordinate: 0, 1, 2 for x, y, z; the unit where the name says it.
    Position(usize, Option<LengthUnit>),
    /// A number of an orientation, by its place in the convention.
    Orientation(OrientationText, usize),
    /// A speed, and how many mm/s one of it is.
    Speed(f64),
    /// Rapid: 0 or 1, the pose is reached in air.
    Rapid,
    /// Raster number: where it changes, the next pose is reached in air.
    Raster,
    /// Name of the tool.
    Tool,
    /// Name of the frame in whose axes the pose is.
    Frame,
    /// The place of an external axis.
    External,
    /// A joint: its number where the name says it, and how many degrees or mm one of its unit is.
    Joint(Option<usize>, f64),
    /// Anything that moves nothing.
    Carried,
}

/// Reason and remedy of a refused name.
pub(crate) type Refusal = (&'static str, &'static str);

const NO_UNIT: Refusal = (
    "a length without its unit, or with another than mm and m",
    "name it with its unit: x_mm, y_mm, z_mm or x_m, y_m, z_m",
);
const NO_ANGLE: Refusal = (
    "an orientation whose convention is not stated: angles about fixed or moving axes, or a rotation vector",
    "write a quaternion (qw, qx, qy, qz), angles about the fixed axes x, then y, then z (rx_deg, ry_deg, rz_deg), or KUKA's A, B, C (a_deg, b_deg, c_deg)",
);
const NO_ORIENTATION: Refusal = (
    "it looks like a part of an orientation, and which is not known by this name",
    "name a quaternion qw, qx, qy, qz (in YAML: orientation with w, x, y, z), or give it another name if it is none",
);
const NO_SPEED: Refusal = (
    "a speed without its unit",
    "name it with its unit: speed_mm_per_s",
);
const TIME: Refusal = (
    "a time at which the pose is reached: it does not hold for a corrected path, nor for poses between",
    "take the times out, and write speeds (speed_mm_per_s)",
);
const OFFSET: Refusal = (
    "an offset, which moves the pose",
    "let the places be those of the tool, and take the offset out",
);
const WAY: Refusal = (
    "which way the tool takes, in words that are not known here",
    "write  rapid  with 1 (in air) or 0 (straight at feed)",
);

/// Millimetres a minute.
const PER_MINUTE: f64 = 1.0 / 60.0;

/// Meaning of a name; case is ignored.
///
/// # Errors
/// The name may move the tool in an unknown way.
pub(crate) fn column_of(name: &str) -> Result<Column, Refusal> {
    use OrientationText::{Abc, Axis, Quaternion, Wpr};
    let name = name.to_ascii_lowercase();
    let found = match name.as_str() {
        "x_mm" => Column::Position(0, Some(LengthUnit::Millimetre)),
        "y_mm" => Column::Position(1, Some(LengthUnit::Millimetre)),
        "z_mm" => Column::Position(2, Some(LengthUnit::Millimetre)),
        "x_m" => Column::Position(0, Some(LengthUnit::Metre)),
        "y_m" => Column::Position(1, Some(LengthUnit::Metre)),
        "z_m" => Column::Position(2, Some(LengthUnit::Metre)),
        "x" => Column::Position(0, None),
        "y" => Column::Position(1, None),
        "z" => Column::Position(2, None),
        "qw" | "orientation_w" => Column::Orientation(Quaternion, 0),
        "qx" | "orientation_x" => Column::Orientation(Quaternion, 1),
        "qy" | "orientation_y" => Column::Orientation(Quaternion, 2),
        "qz" | "orientation_z" => Column::Orientation(Quaternion, 3),
        "rx_deg" | "roll_deg" | "w_deg" => Column::Orientation(Wpr, 0),
        "ry_deg" | "pitch_deg" | "p_deg" => Column::Orientation(Wpr, 1),
        "rz_deg" | "yaw_deg" | "r_deg" => Column::Orientation(Wpr, 2),
        "a_deg" => Column::Orientation(Abc, 0),
        "b_deg" => Column::Orientation(Abc, 1),
        "c_deg" => Column::Orientation(Abc, 2),
        "i" => Column::Orientation(Axis, 0),
        "j" => Column::Orientation(Axis, 1),
        "k" => Column::Orientation(Axis, 2),
        "speed_mm_per_s" => Column::Speed(1.0),
        "speed_m_per_s" => Column::Speed(1000.0),
        "feed_mm_per_min" => Column::Speed(PER_MINUTE),
        "rapid" => Column::Rapid,
        "raster" | "segment" => Column::Raster,
        "tool" => Column::Tool,
        "frame" | "work_object" => Column::Frame,
        "a" | "b" | "c" | "w" | "p" | "r" | "rx" | "ry" | "rz" | "roll" | "pitch" | "yaw" => {
            return Err(NO_ANGLE);
        }
        "speed" | "feed" | "feedrate" | "velocity" | "f" | "v" => return Err(NO_SPEED),
        "t" | "time" | "timestamp" | "duration" => return Err(TIME),
        "motion" | "move" | "motion_type" | "move_type" | "interpolation" => return Err(WAY),
        other => by_beginning(other)?,
    };
    Ok(found)
}

fn by_beginning(name: &str) -> Result<Column, Refusal> {
    let begins = |words: &[&str]| words.iter().any(|word| name.starts_with(word));
    if begins(&["external_"]) {
        return Ok(Column::External);
    }
    if begins(&["joint_"]) {
        return joint_of(name).ok_or((
            "a joint without its unit, or with another than deg, rad, mm and m",
            "name it with its unit: joint_1_deg",
        ));
    }
    if begins(&["x_", "y_", "z_"]) && name.len() <= 7 {
        return Err(NO_UNIT);
    }
    if begins(&["rx_", "ry_", "rz_", "roll_", "pitch_", "yaw_"]) {
        return Err(NO_ANGLE);
    }
    let numbered = |word: &str| {
        let rest = name.strip_prefix(word).unwrap_or("-");
        rest.len() <= 1
            && rest
                .bytes()
                .all(|byte| byte.is_ascii_digit() || b"wxyz".contains(&byte))
    };
    if begins(&["quat", "orient", "rot", "attitude", "euler"]) || numbered("q") || numbered("o") {
        return Err(NO_ORIENTATION);
    }
    if begins(&["speed_", "feed_", "velocity_"]) {
        return Err(NO_SPEED);
    }
    if begins(&["time_", "t_s", "t_ms", "timestamp"]) {
        return Err(TIME);
    }
    if begins(&["dx_", "dy_", "dz_"]) || name.contains("offset") {
        return Err(OFFSET);
    }
    Ok(Column::Carried)
}

/// `joint_3_deg`, `A2_deg`, `q5_rad`, or any name with a unit of joints behind it.
pub(crate) fn joint_of(name: &str) -> Option<Column> {
    let name = name.to_ascii_lowercase();
    let (stem, unit) = name.rsplit_once('_')?;
    let factor = match unit {
        "deg" | "mm" => 1.0,
        "rad" => 180.0 / std::f64::consts::PI,
        "m" => 1000.0,
        _ => return None,
    };
    // The number behind the letters: of joint_3, a2, j5.
    let letters = stem.trim_end_matches(|c: char| c.is_ascii_digit());
    let number = stem[letters.len()..].parse().ok();
    Some(Column::Joint(number, factor))
}

/// Remedy of a table without names.
pub(crate) const TABLE_HELP: &str =
    "write a line of names first, with units: x_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_per_s";

const TABLE: &str = "kinetostat book, programs of robots: lists of poses";
const ROS: &str = "ROS geometry_msgs (Pose, PoseArray, PoseStamped), REP 103: metres";
const RPY: &str = "about the fixed axes x, then y, then z: URDF rpy, FANUC W, P, R";
const ABC: &str = "about z, the new y, the new x: KUKA A, B, C";
const APT: &str = "ISO 4343: the tool's axis from its tip to its holder, of length 1";

const REFUSED_UNIT: Treatment = Refused {
    reason: "a number without its unit",
    remedy: "name it with its unit: x_mm, rx_deg, speed_mm_per_s; places in x, y, z need [robot] length_unit in the job file",
};
const REFUSED_TIME: Treatment = Refused {
    reason: "times do not hold for a corrected path",
    remedy: "take them out, and write speeds",
};
const MOVES: Treatment = Refused {
    reason: "it can move the tool, and how is not stated",
    remedy: "let the places be those of the tool; write rapid (1 or 0) for the way",
};

/// Treatment of each name of a column (CSV) or a key (YAML) of a list of poses. Other names are carried unchanged.
#[rustfmt::skip]
pub const POSES_STATEMENTS: &[StatementRow] = &[
    line("x_mm, y_mm, z_mm", Understood, TABLE),
    line("x_m, y_m, z_m", Understood, TABLE),
    line("x, y, z", Understood, "the unit is [robot] length_unit of the job file"),
    line("qw, qx, qy, qz", Understood, "unit quaternion, of length 1 within 0.001; also orientation_w, ..."),
    line("rx_deg, ry_deg, rz_deg", Understood, RPY),
    line("roll_deg, pitch_deg, yaw_deg", Understood, RPY),
    line("w_deg, p_deg, r_deg", Understood, RPY),
    line("a_deg, b_deg, c_deg", Understood, ABC),
    line("i, j, k", Understood, APT),
    line("speed_mm_per_s", Understood, TABLE),
    line("speed_m_per_s", Understood, "read; not changed from pose to pose"),
    line("feed_mm_per_min", Understood, "read; not changed from pose to pose"),
    line("rapid", Understood, "1: reached in air by a joint motion; 0: straight, at feed"),
    line("raster, segment", Understood, "where it changes, the pose is reached in air"),
    line("tool", Understood, TABLE),
    line("frame, work_object", Understood, TABLE),
    line("external_...", Understood, "refused where it moves, unless [robot] external_axes says carried"),
    line("joint_1_deg, joint_2_deg, ...", Understood, "also _rad, _mm, _m, and other names (A1_deg); with the tool and [robot] joint_rows in the job file"),
    line("position: x, y, z", Understood, ROS),
    line("orientation: w, x, y, z", Understood, ROS),
    line("pose", Understood, ROS),
    line("header: stamp, frame_id", Understood, ROS),
    line("tool_offset", Understood, "carried where its place is 0, else refused"),
    line("rx, ry, rz, a, b, c, roll, pitch, yaw", REFUSED_UNIT, TABLE),
    line("speed, feed, f, velocity", REFUSED_UNIT, TABLE),
    line("time, t, timestamp, duration", REFUSED_TIME, TABLE),
    line("motion, move, interpolation", MOVES, TABLE),
    line("dx_..., dy_..., dz_..., ...offset...", MOVES, TABLE),
    line("any other name", Carried, "copied into the rows of further poses"),
];
