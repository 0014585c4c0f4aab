//! What the writer must know of RAPID.

use std::collections::BTreeSet;

use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::options::WriteOptions;
use crate::text::edits::Edits;
use crate::writing::syntax::Syntax;

/// RAPID.
pub(crate) struct RapidSyntax;
impl Syntax for RapidSyntax {
    fn names(&self, _: &RobotProgram) -> BTreeSet<Vec<u8>> {
        BTreeSet::new()
    }
    fn free_name(&self, _: &[u8], _: &mut BTreeSet<Vec<u8>>) -> Option<Vec<u8>> {
        None
    }
    fn piece(
        &self,
        _: &RobotProgram,
        _: &Motion,
        _: &[u8],
        _: Option<&[u8]>,
        _: &WriteOptions,
    ) -> Option<Vec<u8>> {
        None
    }
    fn straighten(&self, _: &RobotProgram, _: &Motion, _: &mut Edits) {}
}
