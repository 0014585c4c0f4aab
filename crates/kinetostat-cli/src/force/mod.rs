//! `kinetostat force`: the force of one cut (milling; drilling and turning in short), for somebody who knows material, tool, depth and feed.
//!
//! It takes options and perhaps files of materials and tools, and gives mean, peak and the force that makes the wall, torque,
//! power and harmonics, as text, JSON, table and drawing. It knows no machine and no program.

mod answer;
mod answer_of;
pub(crate) mod arguments;
pub(crate) mod cut;
mod drilling;
mod findings;
pub(crate) mod fit;
pub(crate) mod fit_arguments;
pub(crate) mod material;
pub(crate) mod refusal;
mod text;
pub(crate) mod tool;
mod trust;
mod turning;

use std::path::PathBuf;

use kinetostat_cutting::{ForceLaw, Law, Material, Materials};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_report::{Plot, PlotLine};

use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::force::answer::{AtAngle, ForceAnswer, ListedMaterial, MaterialList};
use crate::force::answer_of::answer_of;
use crate::force::arguments::ForceArgs;
use crate::force::cut::cut_of;
use crate::force::material::{Made, applied, material, materials};
use crate::force::text::milling;
use crate::force::tool::tool_of;
use crate::ui::background::interruptible;
use crate::ui::csv_table::{cell, written};
use crate::ui::failure::{Answer, Failing};
use crate::ui::given::Given;
use crate::ui::layout::{listed, wrapped};
use crate::ui::numbers::{given, number};
use crate::ui::result_form::ResultForm;

/// Options of a dynamometer's log.
const OF_A_FIT: [&str; 4] = ["--acts-on", "--group", "--spread-percent", "--out-material"];

/// Options of a milling cut, and of its tool.
const OF_A_MILLING_CUT: [&str; 11] = [
    "--helix-deg",
    "--corner-radius-mm",
    "--lead-angle-deg",
    "--run-out-um",
    "--run-out-angle-deg",
    "--max-chip-mm",
    "--flute-length-mm",
    "--stick-out-mm",
    "--counter-clockwise",
    "--down-feed-per-tooth-mm",
    "--feed-per-tooth-mm",
];

/// Refuses options of another kind of cut than the one that is asked for.
fn refuse_unused(args: &ForceArgs, given: &Given) -> Answer<()> {
    let steady = &args.steady;
    if args.list_materials {
        let used = [
            "--list-materials",
            "--materials",
            "--json",
            "--force-overwrite",
        ];
        return given.refuse_but(
            &used,
            "is for a cut, and --list-materials lists materials: leave one of them out",
        );
    }
    if args.fit.fit.is_none() {
        given.refuse(
            &OF_A_FIT,
            "belongs to --fit FILE: add that, or leave it out",
        )?;
    }
    if steady.drill || steady.turning {
        given.refuse(
            &OF_A_MILLING_CUT,
            "is for a milling cut: leave it out with --drill and --turning",
        )?;
    }
    if steady.drill {
        let of_turning = ["--approach-angle-deg", "--speed-m-per-min"];
        given.refuse(
            &of_turning,
            "belongs to --turning: leave it out with --drill",
        )?;
    }
    if steady.turning {
        let of_drilling = [
            "--point-angle-deg",
            "--hole-mm",
            "--chisel-factor",
            "--lips",
        ];
        given.refuse(
            &of_drilling,
            "belongs to --drill: leave it out with --turning",
        )?;
    }
    Ok(())
}

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[
    ResultForm::of::<ForceAnswer>("forces of a milling cut"),
    ResultForm::of::<drilling::DrillAnswer>("forces of a drill"),
    ResultForm::of::<turning::TurningAnswer>("forces of a turning cut"),
    ResultForm::of::<fit::FitAnswer>("coefficients of a material, from measured forces"),
    ResultForm::of::<MaterialList>("the materials that are known"),
];

pub(crate) fn run(args: &ForceArgs, given: &Given) -> Answer<()> {
    let files = InputFiles::default();
    refuse_unused(args, given)?;
    if let Some(means) = &args.fit.fit {
        return fit::run(&files, args, means);
    }
    let materials = materials(&files, args.material.materials.as_deref())?;
    let mut inputs: Vec<PathBuf> = args.material.materials.iter().cloned().collect();
    if args.list_materials {
        let claimed = ClaimedFiles::claim(&args.outputs, &inputs)?;
        let shown = Shown {
            text: list_text(&materials),
            csv: Vec::new(),
            svg: String::new(),
            failure: None,
        };
        return claimed.finish(&shown, &list(&materials));
    }
    let material = material(&materials, &args.material)?;
    if args.steady.drill || args.steady.turning {
        let claimed = ClaimedFiles::claim(&args.outputs, &inputs)?;
        return match args.steady.drill {
            true => drilling::run(args, &material, claimed),
            false => turning::run(args, &material, claimed),
        };
    }
    if args.steady.feed_per_turn_mm.is_some() {
        return Err(ErrorCode::Unused.failure("--feed-per-turn-mm is the feed of --drill and --turning; a milling cut has --feed-per-tooth-mm, or --feed-mm-per-min with --rpm",
        ));
    }
    let tool = tool_of(&files, &args.tool)?;
    inputs.extend(tool.table.clone());
    let cut = cut_of(&tool.tool, &args.cut, &args.spindle)?;
    let speed = match args.material.correct_speed {
        true => Some(cut.speed_m_per_min().ok_or_else(|| {
            ErrorCode::Missing
                .failure("--correct-speed needs --rpm: the cutting speed follows from it")
        })?),
        false => None,
    };
    let applied = applied(
        &material,
        &args.material,
        Made::Milled,
        tool.rake_deg,
        speed,
    )?;
    let claimed = ClaimedFiles::claim(&args.outputs, &inputs)?;
    let question = text::question(&material.name, &tool, &cut);
    // A cutter of two hundred teeth may take seconds.
    let answer = interruptible(move |_| answer_of(question, &material, &applied, &tool, &cut))?;
    let shown = Shown {
        text: text::answer_text(&answer),
        csv: of_force(&answer)?,
        svg: drawing(&answer),
        failure: None,
    };
    claimed.finish(&shown, &answer)
}

fn of_force(answer: &ForceAnswer) -> Answer<Vec<u8>> {
    let header = [
        "angle_deg",
        "fx_n",
        "fy_n",
        "fz_n",
        "across_tool_n",
        "torque_n_mm",
        "mx_n_mm",
        "my_n_mm",
        "mz_n_mm",
    ];
    let mut rows = vec![header.map(String::from).to_vec()];
    for at in &answer.revolution {
        let [x, y, z] = at.force_n;
        let mut row = vec![cell(at.angle_deg), cell(x), cell(y), cell(z)];
        row.push(cell(x.hypot(y)));
        row.push(cell(at.torque_n_mm));
        row.extend(at.moment_n_mm.iter().map(|m| cell(*m)));
        rows.push(row);
    }
    written(&rows)
}

/// Chip with which the materials are compared, mm.
const CHIP_MM: f64 = 0.1;

fn list(materials: &Materials) -> MaterialList {
    MaterialList {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        materials: materials.iter().map(ListedMaterial::from).collect(),
    }
}

fn list_text(materials: &Materials) -> String {
    let mut out = wrapped(
        "Materials for --material NAME, by their sources. Spread: how far the force of another batch or tool may lie from the law. k_c: force against the tooth's way per mm2 of a chip of 0.1 mm, N/mm2, before factors; with turning tests milling takes another 1.3 (--process-factor).",
        0,
    );
    let mut sources: Vec<&str> = Vec::new();
    for material in materials.iter() {
        if !sources.contains(&material.source.as_str()) {
            sources.push(&material.source);
        }
    }
    // One width of columns for all sources.
    let head = ["", "law", "spread", "k_c", "measured in"].map(String::from);
    let mut rows = vec![head.to_vec()];
    let mut begins = Vec::new();
    for source in &sources {
        begins.push(rows.len());
        rows.extend(materials.iter().filter(|m| m.source == *source).map(row));
    }
    let text = listed(&rows, 2);
    let mut lines = text.lines();
    let head = lines.next().unwrap_or_default().to_owned();
    for (k, line) in lines.enumerate() {
        if let Some(source) = begins.iter().position(|begin| *begin == k + 1) {
            out.push('\n');
            out.push_str(&wrapped(sources[source], 0));
            out.push_str(&head);
            out.push('\n');
        }
        out.push_str(line);
        out.push('\n');
    }
    out.push('\n');
    out.push_str(&wrapped(
        "Other designations, coefficients and assumptions: --json. A file of your own (--materials FILE.toml) has the form of the library, material/library.toml of kinetostat-cutting.",
        0,
    ));
    out
}

fn row(material: &Material) -> Vec<String> {
    let law = match material.law {
        Law::Linear(_) => "linear",
        Law::Kienzle(_) => "Kienzle",
        Law::Exponential(_) => "exponential",
        Law::Rational(_) => "rational",
    };
    let process = match material.measured_in.process {
        kinetostat_cutting::Process::Turning => "turning",
        kinetostat_cutting::Process::Milling => "milling",
    };
    vec![
        material.name.clone(),
        law.to_owned(),
        format!("{} %", given(100.0 * material.spread)),
        number(material.edge_force(CHIP_MM).tangential / CHIP_MM, 4),
        process.to_owned(),
    ]
}

fn drawing(a: &ForceAnswer) -> String {
    let names = [
        "Fx, along the feed",
        "Fy, to its left",
        "Fz, along the tool",
    ];
    let force = |k: usize| line(names[k], k, a, |at| at.force_n[k]);
    let mut lines: Vec<PlotLine> = (0..3).map(force).collect();
    let means = a.mean.force_n.iter().enumerate();
    lines.extend(means.map(|(k, mean)| level(["means", "", ""][k], k, *mean)));
    let over = "angle of the spindle, deg";
    let forces = Plot {
        title: title(a),
        x_label: over.into(),
        y_label: "force on the tool, N".into(),
        lines,
        marks: Vec::new(),
    };
    let torque = |at: &AtAngle| 1e-3 * at.torque_n_mm;
    let torques = Plot {
        title: "Torque of the spindle".into(),
        x_label: over.into(),
        y_label: "torque, N m".into(),
        lines: vec![
            line("torque", 3, a, torque),
            level("mean", 3, 1e-3 * a.mean.torque_n_mm),
        ],
        marks: Vec::new(),
    };
    forces.svg_above(&[torques])
}

fn title(a: &ForceAnswer) -> String {
    let c = &a.cut;
    format!(
        "{}: {} mm wide, {} mm deep, {} mm per tooth in {}",
        milling(c.milling),
        given(c.width_mm),
        given(c.depth_mm),
        given(c.feed_per_tooth_mm),
        a.material.name
    )
}

/// One quantity over the whole turn, its end being its beginning.
fn line(name: &str, colour: usize, a: &ForceAnswer, of: impl Fn(&AtAngle) -> f64) -> PlotLine {
    let mut points: Vec<(f64, f64)> = a.revolution.iter().map(|p| (p.angle_deg, of(p))).collect();
    if let Some(first) = a.revolution.first() {
        points.push((360.0, of(first)));
    }
    PlotLine::solid(name, colour, points)
}

fn level(name: &str, colour: usize, value: f64) -> PlotLine {
    PlotLine::dashed(name, colour, vec![(0.0, value), (360.0, value)])
}
