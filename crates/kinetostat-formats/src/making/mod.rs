//! A path written as a new program, in the language of a robot, in APT, in G-code or as a table of poses.
//!
//! The way: [`gcode_events`] and [`robot_events`] find what a source says beside its moves ([`motion_events`]: in their statements;
//! [`siemens_events`] and [`heidenhain_events`]: the words of blocks, with [`words`], how the spindle turns and what they do
//! before a motion and behind it; [`run_statements`]: all of them for whoever compares two programs),
//! [`course`] says in which order all of it runs ([`robot_course`], [`routines`]: of robots' programs, [`of_tools`]: their tools, [`configurations`], [`reconfigured`]: their
//! postures), [`plan`] makes steps
//! (where [`tools_told`] finds every tool of the program in the template, and its edges)
//! of moves and events ([`pieces`] divides what the other side has no curve for or turns otherwise), one file for each language writes them, and [`compare`] reads what
//! was written and holds it against the path. [`template`] is what the caller states of the cell.

pub(crate) mod compare;
pub(crate) mod configurations;
pub(crate) mod course;
pub(crate) mod csv;
pub(crate) mod dynamics;
pub(crate) mod events;
pub(crate) mod fault;
pub(crate) mod gcode;
pub(crate) mod gcode_events;
pub(crate) mod heidenhain_events;
pub(crate) mod joint_table;
pub(crate) mod krl;
pub(crate) mod limits;
pub(crate) mod ls;
pub(crate) mod make;
pub(crate) mod motion_events;
pub(crate) mod names;
pub(crate) mod of_robot;
pub(crate) mod of_tools;
pub(crate) mod otherwise;
pub(crate) mod pieces;
pub(crate) mod plan;
pub(crate) mod rapid;
pub(crate) mod reconfigured;
pub(crate) mod robot_course;
pub(crate) mod robot_events;
pub(crate) mod routines;
pub(crate) mod run_statements;
pub(crate) mod siemens_events;
pub(crate) mod stated;
pub(crate) mod statements;
pub(crate) mod step;
pub(crate) mod template;
pub(crate) mod tools_told;
pub(crate) mod words;
