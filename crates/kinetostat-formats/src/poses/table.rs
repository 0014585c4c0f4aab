//! Treatment of the names of columns and keys.

use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{StatementRow, Treatment, line};

/// Remedy of a table without names.
pub(crate) const TABLE_HELP: &str =
    "write a line of names first, with units: x_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_per_s";

const TABLE: &str = "kinetostat book, programs of robots: lists of poses";
const ROS: &str = "ROS geometry_msgs (Pose, PoseArray, PoseStamped), REP 103: metres";
const RPY: &str = "about the fixed axes x, then y, then z: URDF rpy, FANUC W, P, R";
const ABC: &str = "about z, the new y, the new x: KUKA A, B, C";
const APT: &str = "ISO 4343: the tool's axis from its tip to its holder, of length 1";

const NO_UNIT: Treatment = Refused {
    reason: "a number without its unit",
    remedy: "name it with its unit: x_mm, rx_deg, speed_mm_per_s; places in x, y, z need [robot] length_unit in the job file",
};
const TIME: Treatment = Refused {
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
    line("rx, ry, rz, a, b, c, roll, pitch, yaw", NO_UNIT, TABLE),
    line("speed, feed, f, velocity", NO_UNIT, TABLE),
    line("time, t, timestamp, duration", TIME, TABLE),
    line("motion, move, interpolation", MOVES, TABLE),
    line("dx_..., dy_..., dz_..., ...offset...", MOVES, TABLE),
    line("any other name", Carried, "copied into the rows of further poses"),
];
