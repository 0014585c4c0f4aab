//! Tolerances of machines against closed forms and against draws made apart.

mod closed_forms;
mod files;
mod fixing_points;
mod machines;
