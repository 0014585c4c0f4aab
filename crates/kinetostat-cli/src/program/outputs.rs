//! Outputs of a run along a program: claimed before the work begins, filled after it.

use std::path::PathBuf;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{FileRead, Run};
use kinetostat_model::Model;
use kinetostat_report::{Language, MachineShown, Paper, html_of_run, turns_svg};

use crate::files::outputs::{Existing, Outputs};
use crate::job::free_turn::FreeTurn;
use crate::job::output_paths::{
    BESIDE, COMPENSATED_PROGRAM, FLAT_PROGRAM, OutputPaths, PATH_VTK, PDF, TURN_PLOT,
};
use crate::job::setting::Setting;
use crate::program::aim::Aim;
use crate::program::flat_lines::WithSources;
use crate::program::paper;
use crate::program::points_table::{self, Listing};
use crate::program::{path_vtk, points_parquet};
use crate::ui::failure::{Answer, Failing};
use crate::ui::json::json;
use crate::ui::language::LanguageWord;
use crate::ui::layout;

/// Claimed outputs of a run by what they hold.
pub(crate) struct RunOutputs {
    pub(crate) files: Outputs,
    pub(crate) program: Option<usize>,
    pub(crate) report: Option<usize>,
    pub(crate) pdf: Option<usize>,
    /// Language of the reports.
    pub(crate) language: Language,
    pub(crate) json: Option<usize>,
    pub(crate) points: Option<usize>,
    /// The table of points is a Parquet file.
    pub(crate) points_as_parquet: bool,
    pub(crate) vtk: Option<usize>,
    pub(crate) flat: Option<usize>,
    pub(crate) turn_plot: Option<usize>,
    /// Indices of the program's additional files.
    pub(crate) beside: Vec<usize>,
    pub(crate) listing: Listing,
    /// Written files of a long program, for the paper.
    pub(crate) made: Vec<FileRead>,
    /// Columns of a written table that have another type than before.
    widened: Vec<String>,
}

impl RunOutputs {
    /// Claims every target before the long work begins.
    pub(crate) fn claim(
        aim: Aim,
        targets: &OutputPaths,
        existing: Existing,
        inputs: &[PathBuf],
    ) -> Answer<Self> {
        Self::claim_in(aim, targets, Outputs::new(existing, inputs.to_vec()))
    }

    /// Claims every target among these outputs, which are none yet.
    pub(crate) fn claim_in(aim: Aim, targets: &OutputPaths, mut outputs: Outputs) -> Answer<Self> {
        let mut claim = |what, target: &Option<PathBuf>| {
            target
                .as_deref()
                .map(|path| outputs.claim(what, path))
                .transpose()
        };
        let program = match aim {
            Aim::Compensate => claim(COMPENSATED_PROGRAM, &targets.program)?,
            Aim::Analyse => None,
        };
        if targets.pdf.is_some() {
            paper::refuse_without_pdf()?;
        }
        points_parquet::refuse_without_parquet(targets.points.as_deref())?;
        Ok(Self {
            program,
            report: claim("report", &targets.report)?,
            pdf: claim(PDF, &targets.pdf)?,
            language: LanguageWord::language(targets.language),
            json: claim("result", &targets.json)?,
            points: claim("table of points", &targets.points)?,
            points_as_parquet: targets
                .points
                .as_deref()
                .is_some_and(points_parquet::is_named),
            vtk: claim(PATH_VTK, &targets.vtk)?,
            flat: claim(FLAT_PROGRAM, &targets.flat)?,
            turn_plot: claim(TURN_PLOT, &targets.turn_plot)?,
            beside: match aim {
                Aim::Compensate => {
                    let all = targets.beside.iter();
                    all.map(|path| outputs.claim(BESIDE, path))
                        .collect::<Answer<_>>()?
                }
                Aim::Analyse => Vec::new(),
            },
            listing: Listing::default(),
            made: Vec::new(),
            widened: Vec::new(),
            files: outputs,
        })
    }

    /// Sets the listing of points: in a Parquet file every one.
    pub(crate) fn list(&mut self, all: bool, model: &Model) {
        self.listing = Listing {
            all: all || self.points_as_parquet,
            controller: model.controller.clone(),
        };
    }

    /// Notes for a person about the files.
    pub(crate) fn note(&self, run: &Run) -> String {
        let of_points = self
            .points
            .and_then(|_| points_table::note(&run.result.run_inputs, &run.points, &self.listing));
        let of_columns = (!self.widened.is_empty()).then(|| {
            format!(
                "The type of these columns could not hold the corrected numbers, and is double in the written table: {}.",
                self.widened.join(", ")
            )
        });
        let notes = of_points.into_iter().chain(of_columns);
        notes
            .map(|note| format!("\n{}", layout::wrapped(&note, 2)))
            .collect()
    }

    /// A paper is made, which states the hashes of what was written; the English page does not.
    fn has_paper(&self) -> bool {
        self.pdf.is_some() || (self.report.is_some() && self.language != Language::English)
    }

    /// Writes the result of a long program beside its targets: JSON and report.
    pub(crate) fn fill_result(&mut self, run: &Run, setting: &Setting) -> Answer<()> {
        let (program, points) = (self.program.take(), self.points.take());
        let filled = self.fill(run, setting, None, None);
        (self.program, self.points) = (program, points);
        filled
    }

    /// Writes a run beside its targets, with the turn that was chosen for it and the machine for its report; nothing is in place yet.
    pub(crate) fn fill(
        &mut self,
        run: &Run,
        setting: &Setting,
        turn: Option<&FreeTurn>,
        machine: Option<&MachineShown>,
    ) -> Answer<()> {
        if let (Some(index), Some(turn)) = (self.turn_plot, turn) {
            self.files.fill(index, turns_svg(&turn.choice).as_bytes())?;
        }
        if let Some(index) = self.flat {
            self.files.fill(index, &setting.program)?;
        }
        let mut made = std::mem::take(&mut self.made);
        if let (Some(index), Some(written)) = (self.program, &run.written) {
            let written = setting.as_files(written)?;
            if self.has_paper() {
                made = paper::written(&setting.targets, &written.program, &written.beside);
            }
            self.files.fill(index, &written.program)?;
            self.widened = written.widened;
            for (index, bytes) in self.beside.iter().zip(&written.beside) {
                self.files.fill(*index, bytes)?;
            }
        }
        if let Some(index) = self.json {
            let flat = setting.flat.as_ref();
            let text = json(&WithSources(&run.result, flat))?;
            self.files.fill(index, text.as_bytes())?;
        }
        if let Some(index) = self.points {
            let outputs = &mut self.files;
            let put = |bytes: &[u8]| outputs.append(index, bytes);
            let inputs = &run.result.run_inputs;
            match self.points_as_parquet {
                true => points_parquet::table(inputs, &run.points, &self.listing, put)?,
                false => points_table::table(inputs, &run.points, &self.listing, put)?,
            }
            outputs.complete(index)?;
        }
        if let Some(index) = self.vtk {
            let bytes = path_vtk::vtk(run);
            self.files.fill(index, &bytes)?;
        }
        let of = Paper::of(&run.result)
            .in_language(self.language)
            .with_written(made)
            .with_machine(machine);
        if let Some(index) = self.pdf {
            self.files.fill(index, &paper::pdf(&of)?)?;
        }
        if let Some(index) = self.report {
            let chosen = turn.map(|turn| (&turn.choice, turn.description.as_str()));
            let page = match self.language {
                Language::English => html_of_run(run, chosen, machine),
                Language::French | Language::German => Ok(of.html()),
            };
            let page = page.map_err(|error| {
                ErrorCode::Internal.failure(format!("the report cannot be made: {error}"))
            })?;
            self.files.fill(index, page.as_bytes())?;
        }
        Ok(())
    }
}
