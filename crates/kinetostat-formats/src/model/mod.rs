//! One model of robot programs for all languages: motions with poses, and where in the text these stand.
//!
//! A reader fills it, [`crate::write()`] takes it. It knows no language; lengths are in mm, angles in degrees where the name
//! says so, poses in the axes of the work object as written.

pub(crate) mod external;
pub(crate) mod frame;
pub(crate) mod language;
pub(crate) mod motion;
pub(crate) mod orientation;
pub(crate) mod outside_call;
pub(crate) mod parsed;
pub(crate) mod program;
pub(crate) mod site;
pub(crate) mod stated_value;
pub(crate) mod target;
