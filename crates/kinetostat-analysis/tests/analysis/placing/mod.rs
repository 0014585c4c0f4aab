//! The best placement against machines whose errors are known in closed form.

mod arm;
mod machine;
mod planted;
mod refused;
mod same;
