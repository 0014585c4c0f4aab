//! The report of a run as one self-contained HTML file, or as a PDF to be signed.
//!
//! [`html`] turns a [`RunResult`] into a page that opens from disk without any network, prints on A4
//! and can be filed with the part.
//! It is a pure function: the same result gives the same bytes, and nothing is read or written.
//!
//! # How it is made
//!
//! - `run`: what a report of a run shows. `meaning` says in plain words what the run means; `facts` collects figures,
//!   tables and what was requested; `along` draws what changes along the path, `plan` the path itself with
//!   the deviation
//!   magnified; `page` fills the template (minijinja with automatic escaping).
//! - `chart`: `plot` draws curves over any two quantities, `section` a quantity over a plane, `panel` values over the
//!   length of a path. They share axes, `outline` and `label`.
//! - `drawing`: a machine in space, as lines on paper.
//! - `vibration`: stability lobes and receptances.
//! - `turns`: the free turn of a round tool along a path, over all turns that were tried.
//! - `paper`: the report to be signed, as PDF or HTML, in three languages.
//! - `number` and `text` decide how numbers and names look, in one place.
//!
//! # Why the plots are drawn here and not by a plotting library
//!
//! `kuva` 0.6 and `plotters` 0.3 were tried. `plotters` has no axes of equal scale and writes colours
//! into every element, so that a page cannot follow dark mode or print. `kuva` has both equal scale and
//! few dependencies, but is 95 000 lines for the half dozen line plots needed (39 s of compilation on
//! one core), and labels at worst points that avoid each other, bands for rapids, a deviation with its
//! own scale bar, and one drawing at two widths would have to be made by hand on top of it. A small
//! writer of SVG with classes instead of colours does all of this and lets the style sheet decide.
//!
//! # Safety of the page
//!
//! Names and comments come from files that somebody else wrote. All text passes automatic escaping (page)
//! or `svg` (drawings); control characters and marks that reverse the direction of text are replaced. A
//! content security policy forbids scripts, network, frames and forms. The style sheet is inline and
//! constant.

mod chart;
mod drawing;
mod number;
mod paper;
mod run;
mod svg;
mod text;
mod turns;
mod vibration;

use kinetostat_chatter::LobeDiagram;
use kinetostat_machining::{ChatterResult, CuttingResult, Run, RunResult, TurnChoice};

use run::Shown;
use run::page;

pub use chart::bars::{Bar, Bars};
pub use chart::cell::Cell;
pub use chart::plot::{Plot, PlotLine, PlotMark};
pub use chart::section::Section;
pub use drawing::{Drawing, Magnified, Moved, Placed, Scene, ShownPose, View};
pub use paper::document::Document;
pub use paper::language::Language;
pub use paper::question::{Paper, VerifiedProgram};
pub use vibration::{DrawnMotion, ReceptanceCurve};

/// Reason why a report could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The page template failed; this is a fault of this crate, never of the data.
    #[error("the report page could not be filled: {0}")]
    Template(#[from] minijinja::Error),
    /// The PDF could not be made; this is a fault of this crate, never of the data.
    #[error("the report could not be set as PDF: {0}")]
    Pdf(String),
    /// This build makes no PDF.
    #[error(
        "this build makes no PDF: the command line does, kinetostat compensate job.toml --pdf report.pdf"
    )]
    NoPdf,
}

/// The report as one HTML page.
///
/// Every value of `result` is accepted: numbers that are not finite are shown as "not available", lists of
/// different lengths are read as far as they go.
///
/// # Errors
///
/// [`ReportError::Template`] if the page template cannot be filled.
pub fn html(result: &RunResult) -> Result<String, ReportError> {
    Ok(page::render(&Shown::of_result(result))?)
}

/// The machine of a run, for its report.
#[derive(Clone, Debug)]
pub struct MachineShown {
    /// A page in three dimensions with its results in it, HTML: it asks no server. Papers have none.
    pub page: String,
    /// The machine on paper, SVG.
    pub picture: String,
    /// Line of the program that the picture shows.
    pub line: usize,
}

/// The report of a run, drawn from all of its points: curves and paths hide nothing, however long the program is. Where the turn of a
/// round tool about its axis was chosen, with the picture of that turn ([`turns_svg`]) in it, and with what was chosen in words; with the
/// machine, where it is given, in a frame that may run its own script and nothing else.
///
/// # Errors
///
/// [`ReportError::Template`] if the page template cannot be filled.
pub fn html_of_run(
    run: &Run,
    turns: Option<(&TurnChoice, &str)>,
    machine: Option<&MachineShown>,
) -> Result<String, ReportError> {
    let shown = Shown {
        turns,
        machine,
        ..Shown::of_run(run)
    };
    Ok(page::render(&shown)?)
}

/// The cut of a program as one picture: the stock seen from above, where there is one, and below it force with its band,
/// parts of the force, depth, arc and torque along the path. `title` says what is shown to those who cannot see it.
///
/// ```
/// use kinetostat_machining::CuttingResult;
///
/// let svg = kinetostat_report::engagement_svg(&CuttingResult::default(), None, "nothing");
/// assert!(svg.contains("nothing is cut"));
/// ```
#[must_use]
pub fn engagement_svg(cutting: &CuttingResult, map: Option<&Section>, title: &str) -> String {
    run::cutting::engagement(cutting, map, title)
}

/// The turns of a round tool about its own axis that were chosen along a path, as one picture, 760 by 560: every turn of the band over the
/// length of the path, coloured by how far the joints are from their limits in the configuration that was chosen, and the chosen one as
/// a line. Turns that are not allowed (near a limit, near a singular posture, out of reach) are marked as such.
///
/// It is a complete SVG document with its own style.
#[must_use]
pub fn turns_svg(choice: &TurnChoice) -> String {
    turns::draw(choice)
}

/// Stability lobes as one picture, 760 by 480: depth of cut over the spindle speed, what is unstable shaded, islands included;
/// flip and Hopf have their own lines, the zeroth order is dashed under its name. A wide range of depths is drawn over
/// logarithms.
///
/// It is a complete SVG document with its own style.
#[must_use]
pub fn lobes_svg(diagram: &LobeDiagram, title: &str) -> String {
    vibration::lobes(diagram, title)
}

/// Chatter along a program as one picture: depth of cut and its limit over the path, what chatters, and below it the vibration that
/// the passing teeth force where it does not.
///
/// It is a complete SVG document with its own style.
///
/// ```
/// use kinetostat_machining::ChatterResult;
///
/// assert!(kinetostat_report::chatter_svg("part.ngc", &ChatterResult::default()).contains("part.ngc"));
/// ```
#[must_use]
pub fn chatter_svg(program: &str, chatter: &ChatterResult) -> String {
    run::chatter::draw(program, chatter)
}

/// Receptances, or mobilities or accelerances made of them, over the frequency as one picture: magnitude and, below it, phase, over
/// logarithms of the frequency.
///
/// It is a complete SVG document with its own style.
#[must_use]
pub fn receptance_svg(curves: &[ReceptanceCurve], motion: DrawnMotion, title: &str) -> String {
    vibration::receptance(curves, motion, title)
}
