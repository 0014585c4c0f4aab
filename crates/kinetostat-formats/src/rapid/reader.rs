//! stub
use crate::error::ProgramError;
use crate::model::program::RobotProgram;
use crate::options::ReadOptions;
use crate::text::source::SourceFile;
/// Stub.
pub fn read_rapid(_: Vec<SourceFile>, _: &ReadOptions) -> Result<RobotProgram, Vec<ProgramError>> {
    Err(Vec::new())
}
