//! `kinetostat force --fit`: from mean forces of a dynamometer to the coefficients of a material.
//!
//! It takes a table of mean forces over the feed, the tool and the cut in which they were measured, and gives the
//! coefficients of the linear law with their intervals, how well they fit, and the material as a file.

mod answer;
mod answer_of;
mod csv;
pub(crate) mod findings;
mod material_file;
mod plot;
mod text;

use std::path::Path;

use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::files::csv_text::with_decimal_points;
use crate::files::input_files::InputFiles;
use crate::force::arguments::ForceArgs;
use crate::force::fit::answer_of::answer_of;
use crate::force::tool::tool_of;
use crate::ui::failure::{Answer, Failure};

pub(crate) fn run(files: &InputFiles, args: &ForceArgs, means: &Path) -> Answer<()> {
    let tool = tool_of(files, &args.tool)?;
    let text = files.text("table of mean forces", means)?;
    let mut inputs = vec![means.to_owned()];
    inputs.extend(tool.table.clone());
    let mut claimed = ClaimedFiles::claim(&args.outputs, &inputs)?;
    let target = args.fit.out_material.as_deref();
    let material = target
        .map(|path| claimed.claim_also("material", path))
        .transpose()?;
    let mut answer = answer_of(args, &tool, (means, &with_decimal_points(&text)))?;
    if let Some(claim) = material {
        let toml = answer.material_toml.as_deref().ok_or_else(|| {
            Failure::input(format!(
                "--out-material: {}; leave the option out to see the whole fit",
                answer.no_material.as_deref().unwrap_or("there is none")
            ))
        })?;
        claimed.fill(claim, toml.as_bytes())?;
    }
    if answer.material_toml.is_none() {
        answer.spread_percent = None;
        answer.spread_from = None;
    }
    let shown = Shown {
        text: text::answer_text(&answer, target),
        csv: csv::of_fit(&answer)?,
        svg: plot::drawing(&answer),
        failure: None,
    };
    claimed.finish(&shown, &answer)
}
