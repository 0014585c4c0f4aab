//! Corrected places, further blocks, modes that are stated again.
