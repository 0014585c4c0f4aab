//! A cell of a section.

/// Content of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell {
    /// A value; one that is not finite is left blank.
    Value(f64),
    /// No value, for a reason: its number in [`others`](crate::Section::others).
    Other(usize),
    /// A shade of grey, from 0 (dark) to 1 (light): what is there and is not in question.
    Grey(f64),
}
