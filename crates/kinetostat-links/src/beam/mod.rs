//! Links that are beams: materials, sections, and the stiffness of a straight or tapered cantilever.

pub(crate) mod section;
pub(crate) mod taper;
