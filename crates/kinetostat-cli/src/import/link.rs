//! `kinetostat import matrix` and `kinetostat import link-displacements`: the stiffness of a link from
//! another program as a table of a model file.

use std::path::{Path, PathBuf};

use kinetostat_links::{
    Condensed, DIRECTIONS, Error, FreeTest, Grade, Identified, Judgement, Nodes, Question,
    SYMMETRIC_TO, Superelement, Text, Tie, Units, axes_from, condense, free_test, identify,
    in_n_mm, judge, read_displacements, read_loads, read_matrix, read_nodes, read_superelement,
    stiffness_table, symmetrised, unit_loads,
};
use kinetostat_machining::number as formatter;
use kinetostat_model::doubts_of_link_matrix;
use nalgebra::{Matrix6, Rotation3, Vector3};
use serde::Serialize;

use crate::files::outputs::{self, Existing, Outputs};
use crate::import::link_arguments::{DisplacementsArgs, MatrixArgs, MeshArgs, TableArgs};
use crate::ui::failure::{Answer, Failure};
use crate::ui::layout::{item, listed, wrapped};
use crate::ui::screen::{self, Stream};
use crate::ui::{json, numbers};

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::input(error)
    }
}

/// The import, stable names with units.
#[derive(Serialize)]
struct Summary<'a> {
    schema: u32,
    kinetostat_version: &'static str,
    source: String,
    output: Option<String>,
    name: &'a str,
    /// Rows in N/mm, N/rad, N mm/mm, N mm/rad at the link's end in its axes.
    stiffness_n_mm_rad: [[f64; 6]; 6],
    /// Standard deviations of the same, where the figures are measured.
    deviation_n_mm_rad: Option<[[f64; 6]; 6]>,
    rank: usize,
    antisymmetric_share: f64,
    /// The share that the residuals explain, where the figures are measured.
    explained_share: Option<f64>,
    natural_length_mm: f64,
    zero_modes: Option<usize>,
    notices: &'a [String],
}

/// What is told of a link besides its matrix.
#[derive(Default)]
struct Remarks {
    rows: Vec<[String; 2]>,
    notices: Vec<String>,
    assumption: Vec<String>,
    deviation: Option<Matrix6<f64>>,
    asymmetry: Option<f64>,
    explained: Option<f64>,
    zero_modes: Option<usize>,
}

impl Remarks {
    fn row(&mut self, what: &str, value: impl Into<String>) {
        self.rows.push([what.to_owned(), value.into()]);
    }
}

pub(crate) fn matrix(args: &MatrixArgs) -> Answer<()> {
    let mut inputs = vec![args.file.clone()];
    inputs.extend(args.dofs.clone());
    inputs.extend(args.mesh.nodes.clone());
    let mut remarks = Remarks::default();
    let (stiffness, source) = match &args.interface {
        None => plain(args, &mut remarks)?,
        Some(interface) => reduced(args, interface, &mut remarks)?,
    };
    finish(
        &args.file,
        &args.table,
        inputs,
        &stiffness,
        &source,
        remarks,
    )
}

/// A 6 x 6 as the file has it.
fn plain(args: &MatrixArgs, remarks: &mut Remarks) -> Answer<(Matrix6<f64>, String)> {
    let text = Text::read(&args.file)?;
    if args.mesh.x_axis.is_some() || args.mesh.y_axis.is_some() || args.mesh.nodes.is_some() {
        return Err(Failure::input(
            "--nodes, --x-axis and --y-axis belong to a matrix of a mesh: say --interface too; a 6 x 6 has the lines reference_point_mm, x_axis and y_axis",
        ));
    }
    let read = match read_matrix(&text, units(&args.mesh)?) {
        Ok(read) => read,
        Err(error) => {
            // Somebody may have left the interfaces out.
            let many = args
                .dofs
                .is_none()
                .then(|| read_superelement(&text, None, None));
            if let Some(Ok(element)) = many {
                return Err(Failure::input(format!(
                    "{}: this is a matrix of {} degrees of freedom ({}); say --interface NODES, --fixed NODES and --units to condense it",
                    text.name(),
                    element.dofs.len(),
                    element.format
                )));
            }
            return Err(error.into());
        }
    };
    remarks.row(
        "read",
        if read.was_compliance {
            "6 x 6 compliance, inverted"
        } else {
            "6 x 6 stiffness"
        },
    );
    remarks.row("units", read.units.name);
    let raw = judge(&read.stiffness, f64::INFINITY).antisymmetric_share;
    let mut stiffness = read.at_link_end();
    if raw.is_finite() && (raw <= SYMMETRIC_TO || args.symmetrise) {
        stiffness = symmetrised(&stiffness);
        symmetry(raw, args.symmetrise, remarks);
    }
    let source = read.source.unwrap_or_else(|| file_name(&args.file));
    Ok((stiffness, source))
}

fn symmetry(share: f64, said: bool, remarks: &mut Remarks) {
    remarks.asymmetry = Some(share);
    if said && share > SYMMETRIC_TO {
        remarks.assumption.push(format!(
            "symmetric part of a matrix whose anti-symmetric share was {}",
            formatter::short(share)
        ));
    }
}

/// A matrix of many degrees of freedom, condensed to one interface.
fn reduced(
    args: &MatrixArgs,
    interface: &str,
    remarks: &mut Remarks,
) -> Answer<(Matrix6<f64>, String)> {
    let units = needed_units(&args.mesh)?;
    let text = Text::read(&args.file)?;
    let companion = args.dofs.as_deref().map(Text::read).transpose()?;
    let element = read_superelement(&text, companion.as_ref(), args.matrix.as_deref())?;
    let nodes = match &args.mesh.nodes {
        Some(path) => read_nodes(&Text::read(path)?, units)?,
        None => Nodes::default(),
    };
    let question = Question {
        units,
        interface: nodes.named(interface)?,
        fixed: match &args.fixed {
            Some(words) => nodes.named(words)?,
            None => Vec::new(),
        },
        end: args.end_mm.as_deref().map(metres),
        axes: axes(&args.mesh)?,
        tie: match args.averaged {
            true => Tie::Averaged,
            false => Tie::Rigid,
        },
    };
    let share = element.antisymmetric_share;
    if share > SYMMETRIC_TO && !args.symmetrise {
        return Err(Failure::input(format!(
            "{}: the matrix is not symmetric, its anti-symmetric share is {}; a body's stiffness is: if this is noise, say --symmetrise",
            text.name(),
            formatter::short(share)
        )));
    }
    symmetry(share, args.symmetrise, remarks);
    let free = free_test(&element, &nodes, units);
    if question.fixed.is_empty() && free.is_free() && free.resistance.iter().any(Option::is_some) {
        return Err(Failure::input(format!(
            "{}: the body is free: rigid motions meet no resistance, so its end has no stiffness; say which nodes are held at the other end: --fixed NODES",
            text.name()
        )));
    }
    let found = condense(&element, &nodes, &question)?;
    remark_reduction(&element, &found, &free, &question, remarks);
    let end = found.end * 1e3;
    let source = format!(
        "{} ({}), end at {:.3}, {:.3}, {:.3} mm of its mesh, interface {}",
        file_name(&args.file),
        element.format,
        end.x,
        end.y,
        end.z,
        match question.tie {
            Tie::Averaged => "averaged",
            Tie::Rigid => "rigid",
        }
    );
    Ok((found.stiffness, source))
}

fn remark_reduction(
    element: &Superelement,
    found: &Condensed,
    free: &FreeTest,
    question: &Question,
    remarks: &mut Remarks,
) {
    let [tied, fixed, inside] = found.counts;
    remarks.row(
        "read",
        format!(
            "{}, {} degrees of freedom",
            element.format,
            element.dofs.len()
        ),
    );
    remarks.row(
        "condensed",
        match question.tie {
            Tie::Rigid => format!("{tied} tied to the end, {fixed} fixed, {inside} inside"),
            Tie::Averaged => {
                format!("{tied} averaged at the end, {fixed} fixed, {inside} inside")
            }
        },
    );
    remarks.row("rigid body", free.words());
    let end = found.end * 1e3;
    remarks.row(
        "end, mm",
        format!("{:.3}, {:.3}, {:.3}", end.x, end.y, end.z),
    );
    if found.rank.rank == 6 {
        remarks.row(
            "interface",
            format!(
                "{:.1} mm in size, condition {:.1}",
                found.rank.size * 1e3,
                found.rank.condition
            ),
        );
    }
    remarks.zero_modes = free.zero_modes;
    if free.negative_modes.is_some_and(|n| n > 0) {
        remarks
            .notices
            .push("the whole matrix has negative modes: was it taken under a load?".into());
    }
    if !question.fixed.is_empty() && fixed > 0 && !free.is_free() {
        remarks.notices.push(
            "the body is held by more than the fixed interface: a support was left in the model, or the program did not condense (ccx 2.20 writes its *SUBSTRUCTURE like that: take the .sti of *FREQUENCY, SOLVER=MATRIXSTORAGE)"
                .into(),
        );
    }
    if found.least_pivot < 1e-9 {
        remarks.notices.push(format!(
            "a part inside is nearly free (pivot {}): look for loose parts and hinges",
            formatter::short(found.least_pivot)
        ));
    }
}

pub(crate) fn displacements(args: &DisplacementsArgs) -> Answer<()> {
    let mut inputs = vec![args.file.clone()];
    inputs.extend(args.loads.clone());
    inputs.extend(args.mesh.nodes.clone());
    let text = Text::read(&args.file)?;
    let loads = match &args.loads {
        Some(path) => read_loads(&Text::read(path)?)?,
        None => unit_loads(args.force_n, args.moment_n_mm * 1e-3),
    };
    let nodes = match &args.mesh.nodes {
        Some(path) => Some(read_nodes(&Text::read(path)?, needed_units(&args.mesh)?)?),
        None => None,
    };
    let cases = read_displacements(&text, &loads, nodes.as_ref(), units(&args.mesh)?)?;
    let end = metres(&args.end_mm);
    let found = identify(text.name(), &cases, &end)?;
    let turn = kinetostat::turn_matrix(&axes(&args.mesh)?);
    let mut remarks = Remarks::default();
    remark_experiments(&found, &cases, &mut remarks);
    let stiffness = if args.filter {
        remarks.assumption.push(format!(
            "{} of 15 couplings of the compliance, less than twice their deviation, taken for zero",
            found.insignificant.len()
        ));
        found.filtered().ok_or_else(|| {
            Failure::input(format!(
                "{}: without the entries that the noise hides the compliance is not positive definite; leave --filter out",
                text.name()
            ))
        })?
    } else {
        found.stiffness
    };
    // Deviations do not turn like the matrix: they are told in the mesh's axes only.
    let unturned = (turn - Matrix6::identity()).norm() < 1e-12;
    remarks.deviation = unturned.then_some(found.stiffness_deviation);
    let stiffness = symmetrised(&(turn.transpose() * stiffness * turn));
    let at = end * 1e3;
    let source = format!(
        "{}: displacements of {} in {}, loads at {:.3}, {:.3}, {:.3} mm of the mesh",
        file_name(&args.file),
        formatter::counted(cases.first().map_or(0, |c| c.places.len()), "node"),
        formatter::counted(cases.len(), "load case"),
        at.x,
        at.y,
        at.z
    );
    finish(
        &args.file,
        &args.table,
        inputs,
        &stiffness,
        &source,
        remarks,
    )
}

fn remark_experiments(
    found: &Identified,
    cases: &[kinetostat_links::LoadCase],
    remarks: &mut Remarks,
) {
    remarks.row(
        "load cases",
        cases
            .iter()
            .map(|c| c.name.as_str())
            .collect::<Vec<_>>()
            .join(", "),
    );
    remarks.row(
        "interface",
        format!(
            "{:.1} mm in size, rank {} of 6, condition {:.1}",
            found.rank.size * 1e3,
            found.rank.rank,
            found.rank.condition
        ),
    );
    let worst = found
        .fits
        .iter()
        .zip(cases)
        .max_by(|a, b| a.0.not_rigid.total_cmp(&b.0.not_rigid));
    if let Some((fit, case)) = worst {
        remarks.row(
            "no rigid motion",
            format!(
                "at most {} of the displacements (case {}, {} per component)",
                formatter::short(fit.not_rigid),
                case.name,
                formatter::largest_length(fit.deviation * 1e3)
            ),
        );
    }
    remarks.row(
        "anti-symmetric",
        format!(
            "{} of the compliance; the residuals explain {}",
            formatter::short(found.antisymmetric_share),
            formatter::short(found.explained_share)
        ),
    );
    let relative = (0..6)
        .map(|i| {
            (
                found.stiffness_deviation[(i, i)] / found.stiffness[(i, i)],
                i,
            )
        })
        .fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a });
    remarks.row(
        "least sure",
        format!(
            "{}: {:.2} % standard deviation",
            DIRECTIONS[relative.1],
            100.0 * relative.0
        ),
    );
    if found.insignificant.len() < 15 {
        let kept: Vec<String> = (0..6)
            .flat_map(|i| (0..i).map(move |j| (i, j)))
            .filter(|p| !found.insignificant.contains(p))
            .map(|(i, j)| format!("{}-{}", DIRECTIONS[j], DIRECTIONS[i]))
            .collect();
        remarks.row("couplings", kept.join(", "));
    }
    remarks.asymmetry = Some(found.antisymmetric_share);
    remarks.explained = Some(found.explained_share);
    remarks.notices.extend(found.notices.iter().cloned());
    remarks.assumption.push(format!(
        "symmetric part of the compliance taken, its anti-symmetric share was {}",
        formatter::short(found.antisymmetric_share)
    ));
}

/// Judges, writes, tells.
fn finish(
    file: &Path,
    table: &TableArgs,
    inputs: Vec<PathBuf>,
    stiffness: &Matrix6<f64>,
    source: &str,
    mut remarks: Remarks,
) -> Answer<()> {
    let judged = judge(stiffness, SYMMETRIC_TO);
    refuse_what_is_none(file, &judged)?;
    let doubts = doubts_of_link_matrix(stiffness, None);
    for finding in &judged.findings {
        remarks
            .notices
            .push(format!("{}; {}", finding.message, finding.help));
    }
    for (message, help) in doubts {
        remarks.notices.push(format!("{message}; {help}"));
    }
    let name = match &table.name {
        Some(name) => name.clone(),
        None => file
            .file_stem()
            .map_or_else(|| "link".into(), |s| s.to_string_lossy().into_owned()),
    };
    let assumption = (!remarks.assumption.is_empty()).then(|| remarks.assumption.join("; "));
    let toml = stiffness_table(&name, stiffness, source, assumption.as_deref());
    let existing = Existing::forced(table.force_overwrite);
    let mut outputs = Outputs::new(existing, inputs);
    if let Some(path) = &table.out {
        let index = outputs.claim("table", path)?;
        outputs.fill(index, toml.as_bytes())?;
        outputs.commit()?;
    }
    let share = remarks.asymmetry.unwrap_or(judged.antisymmetric_share);
    let text = in_words(
        &name,
        &judged,
        stiffness,
        share,
        &remarks,
        table.out.as_deref(),
    );
    if table.json {
        screen::print(Stream::Err, &text)?;
        let rows = |k: &Matrix6<f64>| {
            let k = in_n_mm(k);
            std::array::from_fn(|i| std::array::from_fn(|j| k[(i, j)]))
        };
        let summary = Summary {
            schema: 1,
            kinetostat_version: env!("CARGO_PKG_VERSION"),
            source: source.to_owned(),
            output: table.out.as_ref().map(|p| p.display().to_string()),
            name: &name,
            stiffness_n_mm_rad: rows(stiffness),
            deviation_n_mm_rad: remarks.deviation.as_ref().map(rows),
            rank: judged.rank,
            antisymmetric_share: share,
            explained_share: remarks.explained,
            natural_length_mm: judged.natural_length * 1e3,
            zero_modes: remarks.zero_modes,
            notices: &remarks.notices,
        };
        return screen::print_bytes(json::json(&summary)?.as_bytes());
    }
    if table.out.is_some() {
        return screen::print(Stream::Out, &text);
    }
    // The table itself is the result.
    screen::print(Stream::Err, &text)?;
    screen::print_bytes(toml.as_bytes())
}

fn refuse_what_is_none(file: &Path, judged: &Judgement) -> Answer<()> {
    let refused = judged.findings.iter().find(|f| f.grade == Grade::Refused);
    let loose = (!judged.is_definite())
        .then(|| judged.findings.iter().find(|f| f.message.contains("rank")))
        .flatten();
    match refused.or(loose) {
        Some(finding) => Err(Failure::input(format!(
            "{}: this is no stiffness that a link can have: {}; {}",
            file.display(),
            finding.message,
            finding.help
        ))),
        None => Ok(()),
    }
}

fn in_words(
    name: &str,
    judged: &Judgement,
    stiffness: &Matrix6<f64>,
    share: f64,
    remarks: &Remarks,
    out: Option<&Path>,
) -> String {
    let mut text = wrapped(&format!("Stiffness of the link '{name}' at its end"), 0);
    let mut rows: Vec<Vec<String>> = remarks.rows.iter().map(|r| r.to_vec()).collect();
    let k = in_n_mm(stiffness);
    let three = |from: usize| {
        (from..from + 3)
            .map(|i| numbers::number(k[(i, i)], 5))
            .collect::<Vec<_>>()
            .join(", ")
    };
    rows.push(vec!["x, y, z".into(), format!("{} N/mm", three(0))]);
    rows.push(vec!["rx, ry, rz".into(), format!("{} N mm/rad", three(3))]);
    rows.push(vec![
        "rank".into(),
        format!(
            "{}; anti-symmetric share {}",
            judged.rank,
            formatter::short(share)
        ),
    ]);
    rows.push(vec![
        "natural length".into(),
        format!("{} mm", numbers::number(judged.natural_length * 1e3, 3)),
    ]);
    text.push_str(&listed(&rows, 2));
    if !remarks.notices.is_empty() {
        text.push_str("\nNotices\n");
        for notice in &remarks.notices {
            text.push_str(&item(notice));
        }
    }
    if let Some(path) = out {
        text.push_str(&outputs::written(&[path.to_owned()]));
    }
    text
}

fn metres(mm: &[f64]) -> Vector3<f64> {
    Vector3::from_fn(|i, _| mm.get(i).copied().unwrap_or(0.0) * 1e-3)
}

fn axes(mesh: &MeshArgs) -> Answer<Rotation3<f64>> {
    let vector = |written: &Option<Vec<f64>>, otherwise: Vector3<f64>| match written {
        Some(v) => Vector3::from_fn(|i, _| v.get(i).copied().unwrap_or(0.0)),
        None => otherwise,
    };
    let (x, y) = (
        vector(&mesh.x_axis, Vector3::x()),
        vector(&mesh.y_axis, Vector3::y()),
    );
    axes_from(&x, &y).ok_or_else(|| {
        Failure::input("--x-axis and --y-axis span no frame; give two directions that are not parallel and not zero")
    })
}

fn units(mesh: &MeshArgs) -> Answer<Option<Units>> {
    match &mesh.units {
        None => Ok(None),
        Some(word) => match Units::named(word) {
            Some(units) => Ok(Some(units)),
            None => Err(Failure::input(format!(
                "--units: '{word}' is not known; there are: {}",
                Units::names().replace('_', "-")
            ))),
        },
    }
}

fn needed_units(mesh: &MeshArgs) -> Answer<Units> {
    units(mesh)?.ok_or_else(|| {
        Failure::input(
            "the file does not say its units: say --units, as in --units n-mm (N, mm and N mm)",
        )
    })
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(
        || path.display().to_string(),
        |n| n.to_string_lossy().into_owned(),
    )
}
