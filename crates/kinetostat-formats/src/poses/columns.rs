//! Meaning of the names of columns and keys.

use crate::model::orientation::OrientationText;
use crate::options::LengthUnit;

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
