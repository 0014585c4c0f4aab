//! What a program says of itself, so that only the rest is asked.

use std::path::{Path, PathBuf};

use kinetostat_formats::Language;
use kinetostat_machining::Placement;
use kinetostat_model::Model;
use nalgebra::Vector3;

use crate::files::input_files::InputFiles;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::program::read_program;
use crate::job::rotary::rotary;
use crate::job::setting::setting;
use crate::ui::failure::Answer;

/// A program that was read.
#[derive(Clone)]
pub(super) struct Facts {
    pub(super) path: PathBuf,
    /// None of G-code.
    pub(super) language: Option<Language>,
    /// It is run once and written flat: subprograms, variables, cycles.
    pub(super) expanded: bool,
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
    /// Reads a program, with the rotary axes of the machine; one that is no plain path is run once.
    pub(super) fn of(path: &Path, model: Option<&Model>) -> Answer<Self> {
        let plain = Self::read(path, model, false);
        plain.or_else(|refused| Self::read(path, model, true).map_err(|_| refused))
    }

    fn read(path: &Path, model: Option<&Model>, expanded: bool) -> Answer<Self> {
        let mut flags = ProgramArgs {
            program: Some(path.to_owned()),
            ..ProgramArgs::default()
        };
        flags.expansion.expand = expanded;
        let mut setting = setting(
            &InputFiles::default(),
            None,
            &flags,
            &WritingFlags::default(),
        )?;
        if let Some(model) = model {
            setting.turned_by(rotary(model, &Placement::at(Vector3::zeros())));
        }
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
            expanded,
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

    /// True of a language that does not say which motions are in air.
    pub(super) fn hides_rapids(&self) -> bool {
        self.language
            .is_some_and(|language| !language.is_in_blocks() && !language.is_list())
    }

    pub(super) fn words(&self) -> String {
        let language = self.language.map_or("G-code", |language| language.name());
        let flat = if self.expanded {
            ", run once and written flat"
        } else {
            ""
        };
        format!(
            "{language}, {} lines, {} moves{flat}",
            self.lines, self.moves
        )
    }
}
