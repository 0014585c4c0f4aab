//! The load on the tool: force laws, tools with laws of their own, and the wrench at every place of a path.
//!
//! Knows headings, corners and arcs of a program; takes a law and a path; gives the wrench on the tool's tip in base
//! axes [R 7.16, 7.17]. Knows no deflection.

pub(crate) mod along_path;
pub(crate) mod headings;
pub(crate) mod law;
pub(crate) mod ramp_findings;
pub(crate) mod ramps;
