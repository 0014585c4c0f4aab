//! Path of the tool: moves along straight lines and arcs, with their feed, spindle and tool.
//!
//! Plain geometry in mm, part frame. Knows no text.

pub(crate) mod closed_circle;
pub(crate) mod crossing;
pub(crate) mod curve;
pub(crate) mod feed;
pub(crate) mod great_circle;
pub(crate) mod moves;
pub(crate) mod orientation;
pub(crate) mod rotary;
pub(crate) mod rotary_angles;
pub(crate) mod rotary_findings;
pub(crate) mod spindle;
pub(crate) mod tool_direction;
pub(crate) mod tool_turn;
