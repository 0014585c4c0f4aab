//! Tools and bases that the program itself puts into the arrays of the controller: `TOOL_DATA[4]={X 0,Y 0,Z 180,A 0,B 0,C 0}`.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::krl::role::Role;

/// Numbers of the array of a role to which the program gave a value for certain, once, as far as it was walked.
pub(crate) type Given = BTreeSet<(Role, u32)>;

/// A statement that gives an element a value, or may do so.
#[derive(Debug, Clone)]
pub(crate) struct Assignment {
    pub role: Role,
    /// None where the index is no literal number.
    pub number: Option<u32>,
    pub routine: usize,
    pub line: usize,
    /// Tokens of the value; none of a part of it, and of an argument of a call.
    pub value: Option<Range<usize>>,
}
