//! Tools and bases that the program itself puts into the arrays of the controller: `TOOL_DATA[4]={X 0,Y 0,Z 180,A 0,B 0,C 0}`.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::krl::role::Role;

/// Numbers of the array of a role to which the program gave a value for certain, once, as far as it was walked.
pub(crate) type Given = BTreeSet<(Role, u32)>;

/// Statements by role and number; none where the index is no literal number.
pub(crate) type Assignments = BTreeMap<(Role, Option<u32>), Vec<Assignment>>;

/// Most statements that give one element a value: what has more is taken for one of which nothing is known.
pub(crate) const MOST: usize = 64;

/// A statement that gives an element a value, or may do so.
#[derive(Debug, Clone)]
pub(crate) struct Assignment {
    pub routine: usize,
    pub line: usize,
    /// Tokens of the value; none of a part of it, of an argument of a call, and where the index is no literal number.
    pub value: Option<Range<usize>>,
}
