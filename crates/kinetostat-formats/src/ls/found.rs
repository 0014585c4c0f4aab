//! Results and errors of the programs so far.

use crate::error::ProgramError;
use crate::model::site::Declaration;
use crate::options::ReadOptions;
use crate::text::finding::Finding;
use crate::text::source::SourceFile;

/// Results of the programs so far.
pub(super) struct Reader<'o> {
    pub options: &'o ReadOptions,
    pub faults: Vec<ProgramError>,
    pub findings: Vec<Finding>,
    pub declarations: Vec<Declaration>,
}

impl Reader<'_> {
    pub(super) fn fault(
        &mut self,
        file: &SourceFile,
        span: std::ops::Range<usize>,
        reason: impl Into<String>,
        remedy: impl Into<String>,
    ) {
        self.faults
            .push(ProgramError::at(file, span, reason, remedy));
    }

    pub(super) fn finding(&mut self, file: usize, line: usize, message: impl Into<String>) {
        self.findings.push(Finding {
            file,
            line,
            message: message.into(),
        });
    }
}
