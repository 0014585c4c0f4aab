//! Analyses by themselves; with models and machines the command line tests them.

mod coupled_damping;
mod placing;
mod rotation;
mod sensitivity;
mod shares;
mod stiffening;
mod tolerance;
