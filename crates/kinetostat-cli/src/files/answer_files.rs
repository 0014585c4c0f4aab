//! Files of an answer that is a table and a drawing besides: which are wanted, and how they are written.
//!
//! All of them are claimed before the long work begins, and put in place together.

use std::path::{Path, PathBuf};

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::files::outputs::{self, Existing, Outputs};
use crate::ui::failure::{Answer, Failure};
use crate::ui::json;

/// Where the answer goes besides the screen.
#[derive(Debug, Default, Args)]
pub(crate) struct AnswerFiles {
    /// Print the result as JSON (the text goes to the standard error), or write it to FILE
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-", help_heading = "Outputs")]
    pub(crate) json: Option<PathBuf>,
    /// All points as a table (CSV)
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) csv: Option<PathBuf>,
    /// The drawing (SVG)
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) plot: Option<PathBuf>,
    /// Overwrite outputs that exist (never an input)
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
}

/// An answer for a person and as files.
pub(crate) struct Shown {
    pub(crate) text: String,
    pub(crate) csv: Vec<u8>,
    pub(crate) svg: String,
    /// Failure if the question has no answer: reported after everything is written.
    pub(crate) failure: Option<Failure>,
}

/// Claimed files of an answer.
pub(crate) struct ClaimedFiles {
    outputs: Outputs,
    json: Option<usize>,
    csv: Option<usize>,
    plot: Option<usize>,
    to_screen: bool,
}

impl ClaimedFiles {
    /// Claims every target before the long work begins.
    pub(crate) fn claim(args: &AnswerFiles, inputs: &[PathBuf]) -> Answer<Self> {
        let existing = Existing::forced(args.force_overwrite);
        let mut outputs = Outputs::new(existing, inputs.to_vec());
        let to_screen = args.json.as_deref() == Some(Path::new("-"));
        let mut claim =
            |what, target: Option<&Path>| target.map(|path| outputs.claim(what, path)).transpose();
        let json = args.json.as_deref().filter(|_| !to_screen);
        Ok(Self {
            json: claim("result", json)?,
            csv: claim("table of points", args.csv.as_deref())?,
            plot: claim("drawing", args.plot.as_deref())?,
            to_screen,
            outputs,
        })
    }

    /// Claims one more target, put in place together with the others.
    pub(crate) fn claim_also(&mut self, what: &'static str, target: &Path) -> Answer<usize> {
        self.outputs.claim(what, target)
    }

    /// Writes the contents of a claimed file.
    pub(crate) fn fill(&mut self, claimed: usize, bytes: &[u8]) -> Answer<()> {
        self.outputs.fill(claimed, bytes)
    }

    /// Writes what was requested and says the rest.
    pub(crate) fn finish<T: Serialize + JsonSchema>(
        mut self,
        shown: &Shown,
        answer: &T,
    ) -> Answer<()> {
        if let Some(index) = self.json {
            self.outputs.fill(index, json::json(answer)?.as_bytes())?;
        }
        if let Some(index) = self.csv {
            self.outputs.fill(index, &shown.csv)?;
        }
        if let Some(index) = self.plot {
            self.outputs.fill(index, shown.svg.as_bytes())?;
        }
        let paths = self.outputs.commit()?;
        let text = format!("{}{}", shown.text, outputs::written(&paths));
        json::print_answer(&text, answer, self.to_screen)
    }
}
