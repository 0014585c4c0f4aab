//! The free turn of a round tool about its own axis, chosen along a whole path.
//!
//! An arm of six joints that moves a round tool has one motion to spare: the tool may be turned about its axis without the work being
//! changed. At stations along the path the turns of a band are tried in every configuration of the arm; the cheapest sequence of them that
//! keeps limits, stays away from singular postures, never changes the configuration and turns no faster than allowed is found by dynamic
//! programming (Bellman 1957), and made smooth between the steps of the band. The result is checked again between the stations.
//!
//! Takes a machine with its tool, a path and where it lies; gives the turn along the path, or where and why there is none.

pub(crate) mod choice;
pub(crate) mod choose;
pub(crate) mod closed_form;
pub(crate) mod constant;
pub(crate) mod error;
pub(crate) mod no_way;
pub(crate) mod nodes;
pub(crate) mod search;
pub(crate) mod serial;
pub(crate) mod shortest;
pub(crate) mod smooth;
pub(crate) mod task;
pub(crate) mod turned_path;
pub(crate) mod way;
