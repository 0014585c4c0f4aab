//! Constant loads on the tool and on nodes.

use kinetostat::Wrench;
use kinetostat_analysis::serial_chain::SerialChain;
use kinetostat_diagnostic::ErrorCode;
use nalgebra::Vector3;

use crate::end_condition::arguments::EndArgs;
use crate::end_condition::chain::node_force;
use crate::options::vector;
use crate::ui::failure::{Answer, Failing, Failure};

/// The wrench of two options.
pub(crate) fn wrench(
    force_option: &str,
    force: Option<&[f64]>,
    moment_option: &str,
    moment: Option<&[f64]>,
) -> Answer<Wrench> {
    let part = |name: &str, values: Option<&[f64]>| {
        values.map_or_else(|| Ok(Vector3::zeros()), |v| vector(name, v))
    };
    Ok(Wrench::new(
        part(force_option, force)?,
        part(moment_option, moment)?,
    ))
}

/// The wrench that acts all the time.
pub(crate) fn constant(args: &EndArgs) -> Answer<Wrench> {
    wrench(
        "--constant-force",
        args.constant_force.as_deref(),
        "--constant-moment",
        args.constant_moment.as_deref(),
    )
}

/// A growing force on a node was requested of a machine.
pub(crate) fn no_growing_nodes(option: &str) -> Failure {
    ErrorCode::ModelUnsuited.failure(format!(
            "{option} lets a force on a node grow, and this model has several limbs. The curve of a machine has the motions of its tool and the load on its tool as unknowns, and everything else follows from them: only a load on the tool can grow there (--force, --moment). A force on a node that acts all the time is --load LIMB:NODE=FX,FY,FZ"
        ),
    )
}

/// Adds the forces on nodes that act all the time.
pub(crate) fn with_loads(mut chain: SerialChain, args: &EndArgs) -> Answer<SerialChain> {
    for text in &args.load {
        let load = node_force(&chain.chain, "--load", "", text)?;
        chain.loads.push(load);
    }
    Ok(chain)
}

/// Describes the constant loads; empty if there are none.
pub(crate) fn constant_loads_text(args: &EndArgs) -> String {
    let mut parts = Vec::new();
    if let Some(f) = &args.constant_force {
        parts.push(format!(
            "the force ({}, {}, {}) N on the tool",
            f[0], f[1], f[2]
        ));
    }
    if let Some(m) = &args.constant_moment {
        parts.push(format!(
            "the moment ({}, {}, {}) N m on the tool",
            m[0], m[1], m[2]
        ));
    }
    for text in &args.load {
        if let Some((node, force)) = text.split_once('=') {
            parts.push(format!("the force ({force}) N on '{}'", node.trim()));
        }
    }
    if parts.is_empty() {
        String::new()
    } else {
        format!(" All the time: {}.", parts.join(", "))
    }
}
