//! Elasto-dynamics against programs that were not written for it, and what must not depend on how a machine is described.

mod common;
mod opensees;
mod platform;
mod scripts;
