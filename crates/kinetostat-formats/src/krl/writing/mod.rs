//! Writing of KRL: statements of pieces, ends that state what they took over from the previous pose, and FOLDs that show renamed points.

mod stated;
pub(crate) mod write;
