mod closed_forms;
mod files;
mod machines;
