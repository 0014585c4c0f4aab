//! Files that are refused: line, what is said, and all of it in one run.
