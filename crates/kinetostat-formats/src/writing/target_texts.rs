//! Text positions of targets.

use std::ops::Range;

use crate::model::program::RobotProgram;
use crate::model::site::{PoseText, TargetSite};

/// The literal that says the configuration of an end.
pub(super) fn text_of<'s>(program: &'s RobotProgram, site: &'s TargetSite) -> Option<&'s PoseText> {
    match site {
        TargetSite::Literal(text) => Some(text),
        TargetSite::Declared { declaration, .. } => {
            Some(&program.declarations.get(*declaration)?.text)
        }
        TargetSite::Offset { literal, .. } => Some(literal),
        TargetSite::Partial(_)
        | TargetSite::Replaced(_)
        | TargetSite::Joints(_)
        | TargetSite::Fixed(_) => None,
    }
}

/// Position of a target's text; empty for partial, joint and fixed targets.
pub(super) fn span_of(site: &TargetSite) -> Range<usize> {
    match site {
        TargetSite::Literal(text) => text.whole.clone(),
        TargetSite::Declared { name, .. } => name.clone(),
        TargetSite::Offset { call, .. } => call.clone(),
        TargetSite::Replaced(text) => text.span.clone(),
        TargetSite::Partial(_) | TargetSite::Joints(_) | TargetSite::Fixed(_) => 0..0,
    }
}
