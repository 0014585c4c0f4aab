//! Roles of frames.

use crate::text::name::Name;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    Tool,
    Base,
}

impl Role {
    /// The array of the numbered ones.
    pub(crate) fn array(self) -> &'static str {
        match self {
            Self::Tool => "TOOL_DATA",
            Self::Base => "BASE_DATA",
        }
    }

    /// The role of an array.
    pub(crate) fn of_array(name: &Name) -> Option<Self> {
        let both = [Self::Tool, Self::Base].into_iter();
        both.into_iter().find(|role| name.is(role.array()))
    }

    /// The one in force.
    pub(crate) fn variable(self) -> &'static str {
        match self {
            Self::Tool => "$TOOL",
            Self::Base => "$BASE",
        }
    }
}
