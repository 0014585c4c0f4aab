//! What the command answers, by running it: one module per subject.
//!
//! One binary instead of many, because linking dominates the time of a test run. `killed` is another
//! one: see there.

mod common;

mod absurd;
mod assemble;
mod axes_alone;
mod book;
mod checks_under_load;
mod commands;
mod controller;
mod controller_poses;
mod convert;
mod curves;
mod curves_of_machines;
mod curves_refused;
mod curves_warned;
mod cut;
mod cut_end_to_end;
mod cut_refused;
mod demo;
mod divided;
mod draw;
mod endings;
mod engagement;
mod engagement_of_program;
mod expand;
mod expanded;
mod figures;
mod five_axes;
mod force;
mod force_fit;
mod identical;
mod implausible;
mod import;
mod import_link;
mod jobs;
mod joint_tables;
mod joints_written;
mod large_files;
mod library;
mod loads_that_swing;
mod machine_checks;
mod map;
mod measured;
mod named_at_once;
mod other_language;
mod places_by_position;
mod plausibility_checks;
mod poses;
mod programs;
mod refusals;
mod reproduce;
mod robot_oracle;
mod robot_programs;
mod same_figures;
mod sensible_numbers;
mod shares;
mod smallest_stiffness;
mod stability;
mod tables;
mod tolerances;
mod uncertain;
mod without_motion;
mod words;
