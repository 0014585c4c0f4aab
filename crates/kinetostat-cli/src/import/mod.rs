//! `kinetostat import`: models and links from the files of other programs.
//!
//! It takes a robot description (URDF), or matrices, superelements and displacements of a link, and gives a model
//! file or a table of one, with everything that was assumed.

pub(crate) mod arguments;
mod link;
mod link_arguments;
mod mesh;
mod urdf;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_links::{
    CondensationRequest, Condensed, DIRECTIONS, FreeTest, Identified, Nodes, SYMMETRIC_TO,
    Superelement, Text, Tie, check_stiffness, condense, free_test, identify, read_displacements,
    read_loads, read_matrix, read_nodes, read_superelement, symmetrised, unit_loads,
};
use kinetostat_machining::number as formatter;
use nalgebra::Matrix6;

use crate::files::csv_text::text_or_table;
use crate::import::arguments::{ImportAction, ImportArgs};
use crate::import::link::{Remarks, file_name, finish};
use crate::import::link_arguments::{DisplacementsArgs, MatrixArgs};
use crate::import::mesh::{axes, metres, needed_units, units};
use crate::import::urdf::urdf;
use crate::ui::failure::{Answer, Failing};
use crate::ui::result_form::ResultForm;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[
    ResultForm::of::<link::LinkSummary<'static>>("stiffness of a link"),
    ResultForm::of::<urdf::ImportSummary<'static>>("a robot read from URDF"),
];

pub(crate) fn run(args: &ImportArgs) -> Answer<()> {
    match &args.action {
        ImportAction::Urdf(args) => urdf(args),
        ImportAction::Matrix(args) => matrix(args),
        ImportAction::LinkDisplacements(args) => displacements(args),
    }
}

fn displacements(args: &DisplacementsArgs) -> Answer<()> {
    let mut inputs = vec![args.file.clone()];
    inputs.extend(args.loads.clone());
    inputs.extend(args.mesh.nodes.clone());
    let text = text_or_table(&args.file)?;
    let loads = match &args.loads {
        Some(path) => read_loads(&text_or_table(path)?)?,
        None => unit_loads(args.force_n, args.moment_n_mm * 1e-3),
    };
    let nodes = match &args.mesh.nodes {
        Some(path) => Some(read_nodes(
            &text_or_table(path)?,
            needed_units(&args.mesh)?,
        )?),
        None => None,
    };
    let cases = read_displacements(&text, &loads, nodes.as_ref(), units(&args.mesh)?)?;
    let end = metres(&args.end_mm);
    let found = identify(text.name(), &cases, &end)?;
    let turn = kinetostat::spatial::turn_matrix(&axes(&args.mesh)?);
    let mut remarks = Remarks::default();
    remark_experiments(&found, &cases, &mut remarks);
    let stiffness = if args.filter {
        remarks.assumption.push(format!(
            "{} of 15 couplings of the compliance, less than twice their deviation, taken for zero",
            found.insignificant.len()
        ));
        found.filtered().ok_or_else(|| {
            ErrorCode::Unused.failure(format!(
                "{}: without the entries that the noise hides the compliance is not positive definite; leave --filter out",
                text.name()
            ))
        })?
    } else {
        found.stiffness
    };
    // Deviations do not turn like the matrix: they are reported in the mesh's axes only.
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

fn matrix(args: &MatrixArgs) -> Answer<()> {
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
    let text = text_or_table(&args.file)?;
    if args.mesh.x_axis.is_some() || args.mesh.y_axis.is_some() || args.mesh.nodes.is_some() {
        return Err(ErrorCode::Missing.failure("--nodes, --x-axis and --y-axis belong to a matrix of a mesh: say --interface too; a 6 x 6 has the lines reference_point_mm, x_axis and y_axis",
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
                return Err(ErrorCode::Missing.failure(format!(
                        "{}: this is a matrix of {} degrees of freedom ({}); say --interface NODES, --fixed NODES and --units to condense it",
                        text.name(),
                        element.dofs.len(),
                        element.format
                    ),
                ));
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
    let raw = check_stiffness(&read.stiffness, f64::INFINITY).antisymmetric_share;
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
    let text = text_or_table(&args.file)?;
    let companion = args.dofs.as_deref().map(Text::read).transpose()?;
    let element = read_superelement(&text, companion.as_ref(), args.matrix.as_deref())?;
    let nodes = match &args.mesh.nodes {
        Some(path) => read_nodes(&text_or_table(path)?, units)?,
        None => Nodes::default(),
    };
    let request = CondensationRequest {
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
        return Err(ErrorCode::FileForm.failure(format!(
                "{}: the matrix is not symmetric, its anti-symmetric share is {}; a body's stiffness is: if this is noise, say --symmetrise",
                text.name(),
                formatter::short(share)
            ),
        ));
    }
    symmetry(share, args.symmetrise, remarks);
    let free = free_test(&element, &nodes, units);
    if request.fixed.is_empty() && free.is_free() && free.resistance.iter().any(Option::is_some) {
        return Err(ErrorCode::Missing.failure(format!(
                "{}: the body is free: rigid motions meet no resistance, so its end has no stiffness; say which nodes are held at the other end: --fixed NODES",
                text.name()
            ),
        ));
    }
    let found = condense(&element, &nodes, &request)?;
    remark_reduction(&element, &found, &free, &request, remarks);
    let end = found.end * 1e3;
    let source = format!(
        "{} ({}), end at {:.3}, {:.3}, {:.3} mm of its mesh, interface {}",
        file_name(&args.file),
        element.format,
        end.x,
        end.y,
        end.z,
        match request.tie {
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
    request: &CondensationRequest,
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
        match request.tie {
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
    if !request.fixed.is_empty() && fixed > 0 && !free.is_free() {
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
