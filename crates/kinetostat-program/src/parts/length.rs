//! Length of the parts of a program.

/// Length of the parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PartLength {
    /// Lines that are a part's own.
    pub own: usize,
    /// Motions on either side that say how these begin and end, with the lines between.
    pub beside: usize,
}

impl Default for PartLength {
    /// 4 000 lines, and 256 motions on either side. It is the same everywhere: which bytes are written must not depend on a machine's
    /// memory.
    fn default() -> Self {
        Self {
            own: 4_000,
            beside: 256,
        }
    }
}
