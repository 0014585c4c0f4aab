//! `kinetostat compare`: two designs side by side, at places and over a grid.
//!
//! It takes two models and places, and gives stiffness and shares of both, and the difference where both reach.

mod answer;
pub(crate) mod arguments;
mod grid;

use std::path::{Path, PathBuf};

use kinetostat::{Mechanism, Pose, Posture, PostureRequest, Wrench};
use kinetostat_analysis::shares::Shares;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Warning, straight_tool};
use kinetostat_model::Model;
use nalgebra::Vector3;

use crate::compare::answer::{AtPlace, Compared, Figures, Share, Summary};
use crate::compare::arguments::CompareArgs;
use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::machine::model_warnings::of_model;
use crate::options::vector;
use crate::ui::failure::{Answer, Failing};
use crate::ui::layout::{columns, wrapped};
use crate::ui::numbers::{fixed, number, short, triple};
use crate::ui::result_form::ResultForm;
use crate::ui::warnings;

/// Design that is compared with another one.
pub(crate) struct Design {
    pub(crate) model: Model,
    pub(crate) mechanism: Mechanism,
    path: Option<PathBuf>,
    pub(crate) named: String,
}

impl Design {
    fn read(named: &str, tool_length_mm: f64) -> Answer<Self> {
        let (model, path) = InputFiles::default().model(named, Path::new(""))?;
        model.require_stiffness()?;
        Ok(Self {
            mechanism: model
                .mechanism
                .with_tool(&straight_tool(1e-3 * tool_length_mm)),
            model,
            path,
            named: named.to_owned(),
        })
    }

    pub(crate) fn home(&self) -> Pose {
        self.mechanism.platforms()[self.mechanism.tool()].home
    }

    fn posture(&self, at: Option<Vector3<f64>>) -> kinetostat::Result<Posture> {
        let home = self.home();
        let position = at.unwrap_or(home.translation.vector);
        if self.mechanism.turns_as_it_moves() {
            let request = PostureRequest::position(&position, &home.rotation);
            return self.mechanism.posture(request);
        }
        self.mechanism
            .posture(&Pose::from_parts(position.into(), home.rotation))
    }

    /// Stiffness and shares at a place.
    fn figures(&self, at: Option<Vector3<f64>>) -> Answer<Figures> {
        let failed =
            |e: &kinetostat::Error| ErrorCode::NoAnswer.failure(format!("{}: {e}", self.named));
        let posture = self.posture(at).map_err(|e| failed(&e))?;
        let stiffness = posture.stiffness().map_err(|e| failed(&e))?;
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let mut along = [None; 3];
        let mut shares: [Vec<Share>; 3] = Default::default();
        for (k, axis) in axes.into_iter().enumerate() {
            let Ok(found) = Shares::unloaded(&posture, &Wrench::new(axis, Vector3::zeros())) else {
                continue;
            };
            along[k] = Some(1e-3 / found.compliance);
            shares[k] = found
                .elastic()
                .into_iter()
                .map(|part| Share {
                    limb: part.limb.clone(),
                    name: part.name.clone(),
                    share: part.share,
                })
                .collect();
        }
        Ok(Figures {
            position_mm: (posture.target().translation.vector * 1e3).into(),
            smallest_stiffness_n_per_mm: 1e-3 * stiffness.stiffness_against_force(),
            stiffness_n_per_mm: along,
            shares_x: std::mem::take(&mut shares[0]),
            shares_y: std::mem::take(&mut shares[1]),
            shares_z: std::mem::take(&mut shares[2]),
        })
    }
}

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<Compared>("two machines")];

pub(crate) fn run(args: &CompareArgs) -> Answer<()> {
    let length = args.tool_length_mm.unwrap_or(0.0);
    if length.abs() > 1e5 {
        return Err(ErrorCode::Value.failure(format!(
            "--tool-length-mm is {length}; tools are shorter than 100 m"
        )));
    }
    let (a, b) = (
        Design::read(&args.a, length)?,
        Design::read(&args.b, length)?,
    );
    let grid = grid::grid(args, (a.home().translation.vector * 1e3).into())?;
    if grid.is_none() && (args.outputs.csv.is_some() || args.outputs.plot.is_some()) {
        return Err(ErrorCode::Missing.failure("--csv and --plot show the difference over a grid; give at least one of --x, --y and --z",
        ));
    }
    let inputs: Vec<PathBuf> = a.path.iter().chain(&b.path).cloned().collect();
    let files = ClaimedFiles::claim(&args.outputs, &inputs)?;
    let mut places = Vec::new();
    if args.at.is_empty() {
        places.push(None);
    }
    for at in args.at.chunks(3) {
        places.push(Some(vector("--at", at)? * 1e-3));
    }
    let places = places.into_iter().map(|at| -> Answer<AtPlace> {
        Ok(AtPlace {
            a: a.figures(at)?,
            b: b.figures(at)?,
        })
    });
    let places = places.collect::<Answer<Vec<_>>>()?;
    let difference = match grid {
        Some(grid) => Some(grid::difference(&a.mechanism, &b.mechanism, grid)?),
        None => None,
    };
    let warnings: Vec<Warning> = of_model(&a.model).chain(of_model(&b.model)).collect();
    let answer = Compared {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        a: a.named.clone(),
        b: b.named.clone(),
        places,
        difference: difference.as_ref().map(|d| d.summary.clone()),
        warnings,
    };
    let shown = Shown {
        text: answer_text(&answer),
        csv: difference
            .as_ref()
            .map_or_else(|| Ok(Vec::new()), grid::Difference::csv)?,
        svg: difference
            .as_ref()
            .map_or_else(String::new, |d| d.svg(&answer)),
        failure: None,
    };
    files.finish(&shown, &answer)
}

/// Parts shown for a direction.
const SHOWN: usize = 6;

fn answer_text(c: &Compared) -> String {
    let mut out = wrapped(
        &format!("A: {}, B: {}; both unloaded, as drawn", c.a, c.b),
        0,
    );
    for place in &c.places {
        out.push('\n');
        out.push_str(&wrapped(&at(&place.a, &place.b), 0));
        out.push_str(&stiffness(&place.a, &place.b));
        let shares = [
            ("x", &place.a.shares_x, &place.b.shares_x),
            ("y", &place.a.shares_y, &place.b.shares_y),
            ("z", &place.a.shares_z, &place.b.shares_z),
        ];
        for (axis, a, b) in shares {
            out.push_str(&format!(
                "\nShares of the deflection under a force along {axis}, %\n"
            ));
            out.push_str(&shares_text(a, b));
        }
    }
    if let Some(summary) = &c.difference {
        out.push('\n');
        out.push_str(&difference(summary));
    }
    out.push_str(&warnings::warnings(&c.warnings));
    out
}

fn at(a: &Figures, b: &Figures) -> String {
    match a.position_mm == b.position_mm {
        true => format!("At {} mm", triple(a.position_mm, short)),
        false => format!(
            "A at {} mm, B at {} mm",
            triple(a.position_mm, short),
            triple(b.position_mm, short)
        ),
    }
}

fn stiffness(a: &Figures, b: &Figures) -> String {
    let mut rows = vec![
        ["stiffness, N/mm", "A", "B", "B by A"]
            .map(str::to_owned)
            .to_vec(),
    ];
    let shown = |x: Option<f64>| x.map_or_else(|| "none".to_owned(), |x| number(x, 4));
    let mut row = |name: &str, a: Option<f64>, b: Option<f64>| {
        let ratio = a.zip(b).filter(|(a, _)| *a != 0.0).map(|(a, b)| b / a);
        rows.push(vec![name.to_owned(), shown(a), shown(b), shown(ratio)]);
    };
    let finite = |x: f64| Some(x).filter(|x| x.is_finite());
    row(
        "softest direction",
        finite(a.smallest_stiffness_n_per_mm),
        finite(b.smallest_stiffness_n_per_mm),
    );
    for (k, axis) in ["along x", "along y", "along z"].into_iter().enumerate() {
        row(axis, a.stiffness_n_per_mm[k], b.stiffness_n_per_mm[k]);
    }
    columns(&rows, 1)
}

fn shares_text(a: &[Share], b: &[Share]) -> String {
    let cells = |list: &[Share], k: usize| match list.get(k) {
        Some(s) => {
            let limb = s
                .limb
                .as_deref()
                .map(|l| format!("{l}: "))
                .unwrap_or_default();
            [format!("{limb}{}", s.name), fixed(100.0 * s.share, 1)]
        }
        None => [String::new(), String::new()],
    };
    let mut rows = vec![["A", "", "B", ""].map(str::to_owned).to_vec()];
    for k in 0..SHOWN.min(a.len().max(b.len())) {
        rows.push(cells(a, k).into_iter().chain(cells(b, k)).collect());
    }
    columns(&rows, 1)
}

fn difference(s: &Summary) -> String {
    let text = format!(
        "Over the grid of {} places, {} of them reached by both ({} by A alone, {} by B alone): B is the stiffer one in its softest direction at {} %. Its stiffness by that of A is {} on average, from {} at {} mm to {} at {} mm.",
        s.places,
        s.common,
        s.only_a,
        s.only_b,
        fixed(100.0 * s.b_stiffer_share, 1),
        number(s.mean_ratio, 4),
        number(s.least_ratio, 4),
        triple(s.least_at_mm, short),
        number(s.most_ratio, 4),
        triple(s.most_at_mm, short),
    );
    wrapped(&text, 0)
}
