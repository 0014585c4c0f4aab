//! Values that the caller states.

/// A value that only the controller knows, as the caller states it.
#[derive(Debug, Clone, PartialEq)]
pub enum StatedValue {
    /// A number.
    Number(f64),
    /// TRUE or FALSE.
    Truth(bool),
    /// Any other text.
    Text(String),
}
