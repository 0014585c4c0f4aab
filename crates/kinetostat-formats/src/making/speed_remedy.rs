//! What is said where the speed of a motion is not known, in words of the language of the program.

use crate::model::language::Language;

/// What to do where the speed of a motion at feed is not known.
pub(crate) fn speed_remedy(language: Option<Language>) -> &'static str {
    match language {
        None | Some(Language::Siemens) => {
            "write an F above zero (with G95 the speed of the spindle, S with M3 or M4, too), or state unstated_feed_mm_per_s in the template"
        }
        Some(Language::Heidenhain) => {
            "write F as a number of mm/min (FZ, FU, FT and F AUTO state none; with M136 S in TOOL CALL and M3, too), or state unstated_feed_mm_per_s in the template"
        }
        Some(Language::Apt) => {
            "state FEDRAT as a number (and SPINDL, where it is by turns), or state unstated_feed_mm_per_s in the template"
        }
        Some(Language::Poses) => {
            "write it as speed_mm_per_s, or state unstated_feed_mm_per_s in the template"
        }
        Some(Language::Krl | Language::Rapid | Language::FanucLs) => {
            "write it as a number of mm/s (here it is a time, a register, or a name without a value), or state unstated_feed_mm_per_s in the template"
        }
    }
}
