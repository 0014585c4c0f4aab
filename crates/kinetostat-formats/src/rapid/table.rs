//! stub
use crate::table::StatementRow;
/// Stub.
pub const RAPID_STATEMENTS: &[StatementRow] = &[];
