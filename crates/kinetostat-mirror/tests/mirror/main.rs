//! Measured points against machines whose errors are known in closed form.

mod aligning;
mod corners;
mod degenerate;
mod files;
mod machine;
mod machined;
mod outliers;
mod partial;
mod registration;
mod scatter;
mod settings;
mod taking;
mod trials;
mod writing;
