//! The question of chatter along a program.

use kinetostat_chatter::{ChatterError, Swinging};
use kinetostat_dynamics::{Damping, Error};
use kinetostat_machining::{CutFailure, CutQuestion, CuttingTool, ForceAlongPath, Task};

use crate::vibration::program::site::CutSite;

/// A machine that cuts along a program, and how it is damped.
#[derive(Clone, Copy)]
pub struct ChatterQuestion<'a> {
    /// Machine, program, placement and load.
    pub task: &'a Task<'a>,
    /// Forces of its cuts.
    pub forces: &'a ForceAlongPath,
    /// Tools with their laws of force.
    pub cut: &'a CutQuestion,
    /// Law of damping of the machine.
    pub damping: &'a Damping,
    /// Selection of the modes kept dynamic; the others enter as residual flexibility.
    pub swinging: Swinging,
    /// Places farther apart than this are judged by themselves, mm.
    pub every_mm: f64,
    /// Maximum number of places that are judged.
    pub most: usize,
}

/// Reason why there is no result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProgramChatterError {
    /// Error of the machine: no mass, damping, a place that it does not reach, no equilibrium.
    #[error("line {line}: {error}")]
    Machine {
        /// Line of the program, from 1.
        line: usize,
        /// Error of the machine.
        error: Error,
    },
    /// Error of the cut: a tool that is not a flat end mill, no damping, a law of force that falls.
    #[error("line {line}: {error}")]
    Cut {
        /// Line of the program, from 1.
        line: usize,
        /// Error of the stability analysis.
        error: ChatterError,
    },
    /// Error of the program's tools.
    #[error(transparent)]
    Tool(#[from] CutFailure),
    /// Stopped on request.
    #[error("stopped on request")]
    Cancelled,
}

impl ChatterQuestion<'_> {
    /// The tool of a place.
    pub(crate) fn tool_of(&self, site: &CutSite) -> Result<&CuttingTool, ProgramChatterError> {
        Ok(&self.cut.tools[self.index_of(site)?])
    }

    pub(crate) fn index_of(&self, site: &CutSite) -> Result<usize, ProgramChatterError> {
        Ok(self.cut.tool_on(self.task.path(), site.line)?)
    }
}
