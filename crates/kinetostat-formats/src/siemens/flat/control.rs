//! What a line does besides its words: jumps, loops, sections that run again.

use std::ops::Range;

use crate::siemens::expression::Expression;

/// A jump.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Jump {
    pub way: Way,
    /// Label or number.
    pub to: Range<usize>,
    pub number: Option<u64>,
}

/// Where the destination of a jump is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    Forward,
    Back,
    Both,
    /// As both, and no fault where there is none.
    IfThere,
}

/// What a line does besides its words. Lines of others are indices of the unit.
#[derive(Debug, Clone)]
pub(super) enum Control {
    None,
    Define,
    /// PROC, EXTERN.
    Skip,
    If {
        condition: Expression,
        otherwise: usize,
    },
    /// ELSE: behind it.
    Else(usize),
    /// ENDIF, and others that only mark a place.
    Mark,
    JumpIf(Vec<(Expression, Jump)>),
    Jump(Jump),
    Case {
        of: Expression,
        cases: Vec<(Option<Expression>, Jump)>,
    },
    While {
        condition: Expression,
        end: usize,
    },
    /// ENDWHILE, ENDLOOP: back there.
    Back(usize),
    For {
        variable: Range<usize>,
        indices: Vec<Expression>,
        from: Expression,
        to: Expression,
        end: usize,
    },
    EndFor(usize),
    Until {
        condition: Expression,
        start: usize,
    },
    /// REPEAT and REPEATB of a section.
    Repeat {
        from: Range<usize>,
        to: Option<Range<usize>>,
        one_block: bool,
        count: Option<Expression>,
    },
}
