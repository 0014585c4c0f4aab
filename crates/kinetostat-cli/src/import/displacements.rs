//! `kinetostat import link-displacements`: the stiffness of a link from displacements under loads.

use kinetostat_links::{
    DIRECTIONS, Identified, identify, read_displacements, read_loads, read_nodes, symmetrised,
    unit_loads,
};
use kinetostat_machining::number as formatter;
use nalgebra::Matrix6;

use crate::files::csv_text::text_or_table;
use crate::import::link::{Remarks, file_name, finish};
use crate::import::link_arguments::DisplacementsArgs;
use crate::import::mesh::{axes, metres, needed_units, units};
use crate::ui::failure::{Answer, Failure};

pub(crate) fn displacements(args: &DisplacementsArgs) -> Answer<()> {
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
            Failure::input(format!(
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
