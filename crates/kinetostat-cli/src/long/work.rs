//! Progress of a long run: the result so far, and its files.

use kinetostat_machining::{FeatureResult, OfWhole, Run, Task, add_to_features};
use kinetostat_program::{Survey, WrittenSoFar};

use crate::job::setting::Setting;
use crate::long::checkpoint::{Checkpoint, State};
use crate::long::partial::Partial;
use crate::ui::failure::Answer;

/// Finished work of a run.
pub(crate) struct Work<'s> {
    pub(crate) state: State,
    /// Result and files are those of the same parts: not while a part is being taken into them, which a full disk may end.
    pub(crate) is_whole: bool,
    /// Files of the parts that were done at the start.
    pub(crate) so_far: WrittenSoFar<'s>,
    pub(crate) program: Partial,
    pub(crate) points: Partial,
}

impl<'s> Work<'s> {
    /// Continues from the last state that is whole with its files, or from nothing.
    pub(crate) fn go_on(
        kept: &Checkpoint,
        survey: &'s Survey,
        setting: &'s Setting,
    ) -> Answer<Self> {
        for state in kept.states() {
            let program = Partial::reopen(kept.path("program"), state.program);
            let points = Partial::reopen(kept.path("points"), state.points);
            let (Some(program), Some(points)) = (program, points) else {
                continue;
            };
            let mut so_far = WrittenSoFar::nothing(survey, &setting.reading);
            if let Some(writer) = &state.writer
                && so_far.go_on(program.reader()?, writer.clone()).is_err()
            {
                continue;
            }
            return Ok(Self {
                state,
                is_whole: true,
                so_far,
                program,
                points,
            });
        }
        Self::nothing(kept, survey, setting)
    }

    pub(crate) fn nothing(
        kept: &Checkpoint,
        survey: &'s Survey,
        setting: &'s Setting,
    ) -> Answer<Self> {
        Ok(Self {
            state: State {
                features: FeatureResult::without_points(&setting.features),
                ..State::default()
            },
            is_whole: true,
            so_far: WrittenSoFar::nothing(survey, &setting.reading),
            program: Partial::create(kept.path("program"))?,
            points: Partial::create(kept.path("points"))?,
        })
    }

    /// Once more, with the program left as it is.
    pub(crate) fn begin_anew(
        &mut self,
        kept: &Checkpoint,
        survey: &'s Survey,
        setting: &'s Setting,
        whole: &OfWhole,
    ) -> Answer<()> {
        *self = Self::nothing(kept, survey, setting)?;
        self.state.as_it_is = true;
        self.state.note(whole);
        self.keep(kept)
    }

    /// Takes the next part, with its rows of the table of points.
    pub(crate) fn take(&mut self, task: &Task<'_>, run: Run, rows: &[u8]) -> Answer<()> {
        self.is_whole = false;
        let state = &mut self.state;
        state.merged.add(task, &run);
        let is_written = run.written.is_some();
        let line = |point: &kinetostat_machining::PointResult| Some(point.line);
        add_to_features(&mut state.features, &run.points, line, is_written);
        if let Some(written) = run.written {
            self.program.append(&written.bytes)?;
            state.writer = written.writer.map(|writer| *writer);
        }
        self.points.append(rows)?;
        state.parts += 1;
        self.is_whole = true;
        Ok(())
    }

    /// Keeps how far it is, the files before the state that names their lengths.
    pub(crate) fn keep(&mut self, kept: &Checkpoint) -> Answer<()> {
        self.program.sync()?;
        self.points.sync()?;
        self.state.program = self.program.contents();
        self.state.points = self.points.contents();
        kept.keep(&self.state)
    }
}
