//! `kinetostat import matrix`: a stiffness or flexibility matrix, or a superelement, as the stiffness of a link.

use kinetostat_links::{
    CondensationRequest, Condensed, FreeTest, Nodes, SYMMETRIC_TO, Superelement, Text, Tie,
    check_stiffness, condense, free_test, read_matrix, read_nodes, read_superelement, symmetrised,
};
use kinetostat_machining::number as formatter;
use nalgebra::Matrix6;

use crate::files::csv_text::text_or_table;
use crate::import::link::{Remarks, file_name, finish};
use crate::import::link_arguments::MatrixArgs;
use crate::import::mesh::{axes, metres, needed_units, units};
use crate::ui::failure::{Answer, Failure};

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
    let text = text_or_table(&args.file)?;
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
        return Err(Failure::input(format!(
            "{}: the matrix is not symmetric, its anti-symmetric share is {}; a body's stiffness is: if this is noise, say --symmetrise",
            text.name(),
            formatter::short(share)
        )));
    }
    symmetry(share, args.symmetrise, remarks);
    let free = free_test(&element, &nodes, units);
    if request.fixed.is_empty() && free.is_free() && free.resistance.iter().any(Option::is_some) {
        return Err(Failure::input(format!(
            "{}: the body is free: rigid motions meet no resistance, so its end has no stiffness; say which nodes are held at the other end: --fixed NODES",
            text.name()
        )));
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
