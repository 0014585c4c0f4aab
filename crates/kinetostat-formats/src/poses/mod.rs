//! Lists of poses and of joint values as tables (CSV) and as YAML.
//!
//! [`cells`] finds the cells of a line, [`tree`] the nodes of YAML. What a name means and what it is taken for, [`columns`] says, and
//! [`layout`] what all names of a row mean together; [`joints`] finds the poses of joint values, [`csv`] reads commas as points. [`row`]
//! reads the row and decides what a length is: a wrong factor of 1000 is the worst fault of such a list.
//!
//! Source: RFC 4180 (CSV), YAML 1.2.2, ROS `geometry_msgs/Pose` with REP 103 (metres, quaternions).

pub(crate) mod cells;
pub(crate) mod columns;
pub(crate) mod csv;
pub(crate) mod joints;
pub(crate) mod language;
pub(crate) mod layout;
#[cfg(feature = "parquet")]
pub(crate) mod parquet;
pub(crate) mod reader;
pub(crate) mod row;
pub(crate) mod tree;
pub(crate) mod yaml;
