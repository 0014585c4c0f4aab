//! Tools and bases that the program itself puts into the arrays of the controller: `TOOL_DATA[4]={X 0,Y 0,Z 180,A 0,B 0,C 0}`.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use nalgebra::Isometry3;

use crate::krl::role::Role;

/// What the program gave frames for certain, as far as it was walked.
#[derive(Debug, Default)]
pub(crate) struct Given {
    /// Numbers of the array of a role that have a value.
    pub numbers: BTreeSet<(Role, u32)>,
    /// Data of the program by their index: the value that the last statement gave; none where it is not in numbers, or may not have run.
    pub data: BTreeMap<usize, Option<Isometry3<f64>>>,
    /// The statement that is walked runs once, on no condition: the values above are those that it finds.
    pub is_certain: bool,
}

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
