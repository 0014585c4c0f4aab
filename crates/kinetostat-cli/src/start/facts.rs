//! What a program says of itself, so that only the rest is asked.

use std::path::{Path, PathBuf};

use kinetostat_formats::Language;

use crate::files::input_files::InputFiles;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::program::read_program;
use crate::job::setting::setting;
use crate::ui::failure::Answer;

/// A program that was read.
#[derive(Clone)]
pub(super) struct Facts {
    pub(super) path: PathBuf,
    /// None of G-code.
    pub(super) language: Option<Language>,
    lines: usize,
    moves: usize,
    /// Names of tools that it uses and does not state.
    pub(super) tools: Vec<String>,
    /// Its work object, if it does not state where that is.
    pub(super) work_object: Option<String>,
    pub(super) axis_is_open: bool,
    pub(super) has_spindle: bool,
}

impl Facts {
    /// Reads a program.
    pub(super) fn of(path: &Path) -> Answer<Self> {
        let flags = ProgramArgs {
            program: Some(path.to_owned()),
            ..ProgramArgs::default()
        };
        let setting = setting(
            &InputFiles::default(),
            None,
            &flags,
            &WritingFlags::default(),
        )?;
        let read = read_program(&setting)?;
        let motion = read.path();
        let frames = setting.robot_frames()?;
        let tools = frames.iter().flat_map(|frames| &frames.tools);
        let tools = tools.filter(|(_, _, pose)| pose.is_none());
        let work_object = frames
            .as_ref()
            .and_then(|frames| frames.work_object.as_ref());
        Ok(Self {
            path: path.to_owned(),
            language: setting.robot.as_ref().map(|robot| robot.language),
            lines: read.line_count(),
            moves: motion.moves.len(),
            tools: tools.map(|(_, name, _)| name.clone()).collect(),
            work_object: work_object
                .filter(|(_, pose)| pose.is_none())
                .map(|(name, _)| name.clone()),
            axis_is_open: frames.as_ref().is_some_and(|frames| frames.axis_is_open),
            has_spindle: !motion.spindle_changes.is_empty(),
        })
    }

    /// Number of tools in the flange that it does not state; G-code never states its one.
    pub(super) fn tools_to_ask(&self) -> usize {
        match self.language {
            None => 1,
            Some(_) => self.tools.len(),
        }
    }

    pub(super) fn asks_for_part(&self) -> bool {
        self.language.is_none() || self.work_object.is_some()
    }

    pub(super) fn words(&self) -> String {
        let language = self.language.map_or("G-code", |language| language.name());
        format!("{language}, {} lines, {} moves", self.lines, self.moves)
    }
}
