//! Rotors.
