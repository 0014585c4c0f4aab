//! For the tests of this crate alone: what the rooms of all languages share and no public function shows by itself.

pub use crate::heidenhain::expand::flat::expand_within as expand_heidenhain_within;
pub use crate::model::orientation::OrientationText;
pub use crate::siemens::flat::expand_within as expand_siemens_within;
pub use crate::text::number::{Width, printed};
