//! The files that `verify` writes.

use std::path::{Path, PathBuf};

use kinetostat_machining::Verified;
use kinetostat_model::Controller;
use kinetostat_report::Language;

use crate::files::outputs::{Existing, Outputs};
use crate::job::output_paths::{PATH_VTK, PDF};
use crate::program::points_table::{self, Listing};
use crate::program::{paper, path_vtk, points_parquet};
use crate::ui::failure::Answer;
use crate::ui::json;
use crate::verify::answer::VerifyAnswer;
use crate::verify::arguments::VerifyArgs;

/// Files that are known to be writable before anything is solved; none where none is asked for.
pub(crate) struct ClaimedFiles {
    all: Outputs,
    json: Option<usize>,
    pdf: Option<usize>,
    points: Option<usize>,
    vtk: Option<usize>,
}

impl ClaimedFiles {
    pub(crate) fn of(args: &VerifyArgs, inputs: Vec<PathBuf>) -> Answer<Self> {
        let given = &args.original;
        if given.pdf.is_some() {
            paper::refuse_without_pdf()?;
        }
        points_parquet::refuse_without_parquet(given.points.as_deref())?;
        let mut all = Outputs::new(Existing::forced(given.force_overwrite), inputs);
        let mut claim =
            |what, path: Option<&PathBuf>| path.map(|path| all.claim(what, path)).transpose();
        let json = args.json.as_ref().filter(|path| *path != Path::new("-"));
        let json = claim("result", json)?;
        let pdf = claim(PDF, given.pdf.as_ref())?;
        let points = claim("table of points", given.points.as_ref())?;
        let vtk = claim(PATH_VTK, given.vtk.as_ref())?;
        Ok(Self {
            all,
            json,
            pdf,
            points,
            vtk,
        })
    }

    /// Writes all of them, and tells their paths.
    pub(crate) fn write(
        mut self,
        args: &VerifyArgs,
        found: &Verified,
        answer: &VerifyAnswer,
        controller: Option<Controller>,
        language: Language,
    ) -> Answer<Vec<PathBuf>> {
        let all = &mut self.all;
        if let Some(index) = self.json {
            all.fill(index, json::json(answer)?.as_bytes())?;
        }
        if let Some(index) = self.pdf {
            let of_run = answer.as_run(found);
            let of = answer.paper(&of_run, language);
            all.fill(index, &paper::pdf(&of)?)?;
        }
        if let Some(index) = self.points {
            let listing = Listing {
                all: args.original.all_points,
                controller,
            };
            let (inputs, points) = (&found.run.result.run_inputs, &found.run.points);
            let named = args.original.points.as_deref();
            let put = |bytes: &[u8]| all.append(index, bytes);
            match named.is_some_and(points_parquet::is_named) {
                true => points_parquet::table(inputs, points, &listing, put)?,
                false => points_table::table(inputs, points, &listing, put)?,
            }
            all.complete(index)?;
        }
        if let Some(index) = self.vtk {
            all.fill(index, &path_vtk::vtk(&found.run))?;
        }
        self.all.commit()
    }
}
