//! What the core must satisfy: one module per claim of the theory or per source of numbers.
//!
//! One binary instead of many, because linking dominates the time of a test run.

#![allow(
    clippy::unwrap_used,
    clippy::needless_range_loop,
    reason = "a failing test may panic; matrices are read by their indices"
)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../oracle/mod.rs"]
mod oracle;
#[path = "../../benches/platforms/mod.rs"]
mod platforms;

mod all_equilibria;
mod beam_tables_3_2_and_3_3;
mod bent_links_buckle;
mod branches_of_machines;
mod change_of_frame_and_reference_point;
mod compensation_closes;
mod condensed_equals_flattened;
mod curves_and_bifurcations;
mod curves_of_columns;
mod curves_of_elastic_links;
mod curves_of_families;
mod end_conditions_are_consistent;
mod energy_equals_work;
mod euler_angles;
mod figures;
mod frames_that_snap;
mod free_rigid_and_redundant_directions;
mod fuzz_short;
mod graphs;
mod hybrids;
mod inputs_are_looked_at;
mod inputs_of_machines_are_looked_at;
mod internal;
mod iterations_find_their_equilibrium;
mod jacobians_are_derivatives;
mod joints_that_follow;
mod links_that_bend;
mod loads_in_mechanisms;
mod loads_of_every_kind;
mod loads_on_platforms;
mod loads_that_follow;
mod loads_that_snap;
mod long_chains;
mod lost_motions;
mod machines_reach_what_chains_reach;
mod machines_that_snap;
mod machines_with_rigid_directions;
mod numbers_of_tables;
mod orientation_follows;
mod orthoglide_reference;
mod pantographs_and_lattices;
mod parallel_machines;
mod parallelograms;
mod partners_at_a_fold;
mod planar_machines;
mod platforms_in_series;
mod report_iteration;
mod screws_turn_with_their_joints;
mod shapes_and_their_stability;
mod shapes_of_limbs;
mod singular_values;
mod stewart_gough_3_34_and_3_35;
mod stiffnesses_behind_platforms;
mod stiffnesses_of_any_ratio;
mod stored_stiffness_is_the_derivative_of_the_wrench;
mod straight_links_buckle;
mod sums_of_wrenches;
mod three_ways_to_a_stiffness;
mod two_link_chain_4_31;
mod what_goes_wrong_says_why;
mod where_a_load_leads;
